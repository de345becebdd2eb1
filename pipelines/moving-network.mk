# SPDX-License-Identifier: GPL-3.0-or-later
# Drying and shrinking in turns: the network moves with the grains after each portion of the
# drying, beside the drying of a network that does not move (one portion).
#
#     make coupled                              ->  build/runs/coupled/coupled.svg, coupled.md
#     make coupled COUPLED_PORTIONS="1 10 20"

COUPLED_PORTIONS ?= 1 5 10 20 40# how often; 1 is one way; the last one is drawn

DEFORM ?= $(BUILD)/bin/deform
pipeline_goals += coupled
coupled_folder := $(RUNS)/coupled
coupled_samples := soft weak stiff
coupled_scene_soft := samples/soft-10x5x5.json
coupled_scene_weak := samples/soft-10x5x5.json
coupled_scene_stiff := samples/stiff-5x5x10.json
# Under its whole load the soft aggregate buckles once throats have narrowed (docs/coupling.md).
coupled_load_soft := 0.3
coupled_load_weak := 0.3
coupled_load_stiff := 1
coupled_bonds_weak := bond.contact_strength=3e-8
coupled_moments := [1,0.95,0.9,0.85,0.8,0.75,0.7,0.65,0.6,0.55,0.5,0.45,0.4,0.35,0.3,0.25,0.2,0.15,0.1,0.05,0]

# 1, 2 ... $1
count_to = $(shell seq 1 $1)
before = $(shell expr $1 - 1)
share = $(shell awk 'BEGIN { printf "%.12g", 1 - $1 / $2 }')
steps_of = $(shell awk 'BEGIN { n = int(550 / $1); print n < 2 ? 2 : n }')

# Portion $4 of $3 of sample $1 in folder $2: from the saturation at which the one before has
# ended, or what has become of it as the body moved, down to 1 - $4/$3.
define coupled_portion
$(call step,$2/$4/drying.h5,dry,$(DRY),$(coupled_scene_$1),stop_saturation=$(call share,$4,$3) $(if $(filter 1,$4),,throat_radius.distribution=network),$(if $(filter 1,$4),$(coupled_folder)/$1/network.h5,$2/$(call before,$4)/network.h5))
$(call step,$2/$4/forces.h5,force-protocol,$(FORCE_PROTOCOL),$(coupled_scene_$1),steps=$(call steps_of,$3) force_scale=$(coupled_load_$1),$2/$4/drying.h5)
$(call step,$2/$4/response.h5,dem-replay,$(DEM_REPLAY),$(coupled_scene_$1),keep_state=true snapshots=$(coupled_moments) $(call default,coupled_bonds_$1,),$2/$4/forces.h5 $(if $(filter 1,$4),,$2/$(call before,$4)/response.h5))
$(call step,$2/$4/network.h5,deform,$(DEFORM),$(coupled_scene_$1),,$2/$4/drying.h5 $2/$4/response.h5)
$(call step,$2/$4/crackstats.json,crackstats,$(CRACKSTATS),$(coupled_scene_$1),,$2/$4/response.h5)
endef

# All portions, and their course as a table.
define coupled_run
$(foreach k,$(call count_to,$2),$(call coupled_portion,$1,$(coupled_folder)/$1/$2,$2,$k))
$(call artifact,$(coupled_folder)/$1/$2/course.tsv,stage=coupled-course version=1,pipelines/coupled-course $(foreach k,$(call count_to,$2),$(addprefix $(coupled_folder)/$1/$2/$k/,drying.h5 response.h5 network.h5 crackstats.json)),pipelines/coupled-course $(coupled_folder)/$1/$2 $2 $(coupled_folder)/$1/$2/course.tsv,)
endef

.PHONY: coupled
coupled: ## drying and shrinking in turns, beside one way, and their picture (minutes)

ifneq ($(filter coupled $(coupled_folder)/%,$(MAKECMDGOALS)),)
$(foreach s,$(coupled_samples),$(call crack_network,$(coupled_folder)/$s,$(coupled_scene_$s)))
$(foreach s,$(coupled_samples),$(foreach n,$(COUPLED_PORTIONS),$(call coupled_run,$s,$n)))
coupled_courses := $(foreach s,$(coupled_samples),$(foreach n,$(COUPLED_PORTIONS),$(coupled_folder)/$s/$n/course.tsv))
coupled_drawn := $(foreach s,$(coupled_samples),$(foreach n,$(firstword $(COUPLED_PORTIONS)) $(lastword $(COUPLED_PORTIONS)),$(coupled_folder)/$s/$n/course.tsv))
$(call artifact,$(coupled_folder)/coupled.md,stage=coupled version=1,pipelines/coupled $(coupled_courses),pipelines/coupled $(coupled_courses) $(coupled_folder)/coupled.md,)
$(call artifact,$(coupled_folder)/coupled.svg,stage=coupled-figure version=1,pipelines/coupled-figure.gp $(coupled_drawn),gnuplot -c pipelines/coupled-figure.gp $(coupled_drawn) $(coupled_folder)/coupled.svg,)

coupled: $(coupled_folder)/coupled.md $(coupled_folder)/coupled.svg
ifdef really
	@cat $(coupled_folder)/coupled.md
	@echo 'picture: $(coupled_folder)/coupled.svg'
endif
endif
