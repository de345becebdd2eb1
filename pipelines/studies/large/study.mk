# SPDX-License-Identifier: GPL-3.0-or-later
# One irregular aggregate of many grains of unlike sizes, from its packing to its cracks:
#
#     make large                  ->  build/runs/large/large.md, large.png
#     make large GRAINS=5000
#     make large LARGE_SCENE=mine.json IMPORT=grains.txt  ->  build/runs/large-mine/
#     make large LARGE_SCENE=samples/column-1000000.json  ->  build/runs/large-column-1000000/ (an hour of one core, 6 GiB)

LARGE_SCENE ?= samples/irregular-50000.json
GRAINS ?=# instead of as many as the scene says

large_folder := $(RUNS)/large$(if $(filter-out %/irregular-50000.json,$(LARGE_SCENE)),-$(basename $(notdir $(LARGE_SCENE))))

# Stage $2, program $3, of the scene, with overrides $4 and inputs $5; its cost is kept.
large_step = $(call step,$(large_folder)/$1,$2,pipelines/studies/large/timed $3,$(LARGE_SCENE),$4,$(5:%=$(large_folder)/%))

large: ## cracks in an irregular aggregate of 50,000 grains, and what each stage takes (five minutes of two cores with THREADS=2)

ifneq ($(call asked,large,$(large_folder)),)
$(if $(GRAINS),$(call must,GRAINS,$(whole),a whole number))
$(call step,$(large_folder)/packing.h5,pack,pipelines/studies/large/timed $(PACK),$(LARGE_SCENE),$(GRAINS:%=count=%),$(IMPORT))
$(call large_step,tessellation.h5,tessellate,$(TESSELLATE),,packing.h5)
$(call large_step,network.h5,merge-nodes,$(MERGE_NODES),,tessellation.h5)
$(call large_step,drying.h5,dry,$(DRY),,network.h5)
$(call large_step,forces.h5,force-protocol,$(FORCE_PROTOCOL),,drying.h5)
$(call large_step,response.h5,dem-replay,$(DEM_REPLAY),,forces.h5)
$(call large_step,crackstats.json,crackstats,$(CRACKSTATS),,response.h5 drying.h5)
large_results := $(addprefix $(large_folder)/,network.h5 drying.h5 response.h5 crackstats.json)
$(call report,$(large_folder)/large.md,studies/large/table,$(large_results),$(large_folder))
$(call report,$(large_folder)/large.png,studies/large/figure,$(large_folder)/response.h5)

$(call study,large,$(large_folder)/large.md $(large_folder)/large.png)
endif
