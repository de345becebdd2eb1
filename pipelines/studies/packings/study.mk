# SPDX-License-Identifier: GPL-3.0-or-later
# Random close packing of 10,000 equal spheres, what friction does to 2,000, and the
# aggregates that K lets settle:
#
#     make packings                          ->  build/runs/packings/table.md

packings_folder := $(RUNS)/packings
frictions := 0 0.1 0.3 0.5 1

# Packing $1 with the settings $2, and what is said of it.
packing = $(call artifact,$(packings_folder)/$1.json,stage=pack version=$(call version_of,pack) $(2:%=set='%'),pipelines/studies/packings/run pipelines/lib/common.py,pipelines/studies/packings/run $(packings_folder)/$1.h5 $(2:%='%') $(packings_folder)/$1.json,$(BUILD)/bin/pack)
# $1 grains with friction $2.
close_packing = $(call packing,close-$1-$2,method=radius_expansion count=$1 periodic=[true$(,)true$(,)true] dynamics.overlap=1e-4 dynamics.friction=$2 dynamics.time_step_safety=0.1)
# $2 grains in $1 dimensions, with friction $3.
settled_packing = $(call packing,settled-$1d-$2-$3,method=deposition dimensions=$1 count=$2 dynamics.friction=$3 dynamics.time_step_safety=0.1)

packings: ## random close packing, and grains that settle (about ten minutes of one core)

ifneq ($(call asked,packings,$(packings_folder)),)
$(foreach f,0 0.5,$(foreach n,267 1000 4161,$(call settled_packing,2,$n,$f)))
$(foreach f,0 0.5,$(foreach n,223 1220,$(call settled_packing,3,$n,$f)))
$(foreach f,$(frictions),$(call close_packing,2000,$f))
$(call close_packing,10000,0)
packings_said := $(packings_folder)/close-10000-0.json $(frictions:%=$(packings_folder)/close-2000-%.json) \
	$(foreach n,2d-267 2d-1000 2d-4161 3d-223 3d-1220,$(foreach f,0 0.5,$(packings_folder)/settled-$n-$f.json))
$(call report,$(packings_folder)/table.md,studies/packings/table,$(packings_said),$(packings_folder))

$(call study,packings,$(packings_folder)/table.md)
endif
