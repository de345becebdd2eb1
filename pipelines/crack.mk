# SPDX-License-Identifier: GPL-3.0-or-later
# From a scene to its cracks:
#
#     make run SCENE=samples/x.json    ->  build/runs/x/crackstats.json
#     make demo                        ->  the sample in both drying limits, and its pictures
#     make demo SCENE=samples/x.json   ->  the same for another scene

SCENE ?=
IMPORT ?=# what `pack` reads, for a scene that imports its grains

# Each stage may be replaced: DRY=mydry. It is asked for its --version to know it by.
PACK ?= $(BUILD)/bin/pack
TESSELLATE ?= $(BUILD)/bin/tessellate
MERGE_NODES ?= $(BUILD)/bin/merge-nodes
DRY ?= $(BUILD)/bin/dry
FORCE_PROTOCOL ?= $(BUILD)/bin/force-protocol
DEM_REPLAY ?= $(BUILD)/bin/dem-replay
CRACKSTATS ?= $(BUILD)/bin/crackstats

# $1 is made by the stage of that name from scene $2, with the overrides $3, and the files $4.
pack = $(call step,$1,pack,$(PACK),$2,$3,$4)
tessellate = $(call step,$1,tessellate,$(TESSELLATE),$2,$3,$4)
merge-nodes = $(call step,$1,merge-nodes,$(MERGE_NODES),$2,$3,$4)
dry = $(call step,$1,dry,$(DRY),$2,$3,$4)
force-protocol = $(call step,$1,force-protocol,$(FORCE_PROTOCOL),$2,$3,$4)
dem-replay = $(call step,$1,dem-replay,$(DEM_REPLAY),$2,$3,$4)
crackstats = $(call step,$1,crackstats,$(CRACKSTATS),$2,$3,$4)

pipeline_goals += demo run

# packing, tessellation and network of scene $2 in folder $1, with the overrides $3 of the packing
# and $4 of the tessellation.
define crack_network
$(call pack,$1/packing.h5,$2,$3,$(IMPORT))
$(call tessellate,$1/tessellation.h5,$2,$4,$1/packing.h5)
$(call merge-nodes,$1/network.h5,$2,,$1/tessellation.h5)
endef

# The rest, in folder $1, from network $3, with the overrides $4 of the drying.
define crack_history
$(call dry,$1/drying.h5,$2,$4,$3)
$(call force-protocol,$1/forces.h5,$2,,$1/drying.h5)
$(call dem-replay,$1/response.h5,$2,,$1/forces.h5)
$(call crackstats,$1/crackstats.json,$2,,$1/response.h5 $1/drying.h5)
endef

crack_words := "\(.cracks.total) of \(.bonds) bonds broke," + \
	" \(.cracks.normal) in tension, \(.cracks.shear) in shear"

# --- one scene ------------------------------------------------------------------------

.PHONY: run
ifneq ($(SCENE),)
run_folder := $(RUNS)/$(basename $(notdir $(SCENE)))
$(call crack_network,$(run_folder),$(SCENE))
$(call crack_history,$(run_folder),$(SCENE),$(run_folder)/network.h5,)
# A wrong key of the last stage is not to be found after the others have run.
run_stages := pack tessellate merge-nodes dry force-protocol dem-replay crackstats
ifdef really
.PHONY: sections
$(run_folder)/packing.h5: | sections
sections: | $(run_stages:%=$(BUILD)/bin/%)
	@for stage in $(run_stages); do \
		$(BUILD)/bin/$$stage -p $(SCENE) --parameters >/dev/null || exit; done
endif
run: $(run_folder)/crackstats.json ## run the pipeline: make run SCENE=samples/x.json
ifdef really
	@jq -r '$(crack_words)' $(run_folder)/crackstats.json 2>/dev/null || true
	@echo 'artifacts: $(run_folder)'
endif
else
run:
	@echo 'Which scene? make run SCENE=samples/x.json' >&2; exit 64
endif

# --- the demonstration ----------------------------------------------------------------

demo_scene := $(or $(SCENE),samples/stiff-5x5x10.json)
demo_folder := $(RUNS)/$(basename $(notdir $(demo_scene)))
demo_limits := inviscid immobile
demo_picture := $(if $(wildcard pipelines/picture),$(demo_folder)/picture.svg)

.PHONY: demo
demo: ## from the stiff aggregate of the samples to its cracks and a picture, in both limits

ifneq ($(filter demo $(demo_folder)/%,$(MAKECMDGOALS)),)
$(call crack_network,$(demo_folder),$(demo_scene))
$(foreach limit,$(demo_limits),$(call \
	crack_history,$(demo_folder)/$(limit),$(demo_scene),$(demo_folder)/network.h5,liquid=$(limit)))

demo_counts := $(demo_limits:%=$(demo_folder)/%/crackstats.json)
demo_drawn := $(foreach limit,$(demo_limits),$(addprefix \
	$(demo_folder)/$(limit)/,drying.h5 forces.h5 response.h5 crackstats.json))
ifneq ($(demo_picture),)
$(call report,$(demo_picture),picture,$(demo_drawn),$(demo_folder))
endif

# What has broken at four saturations [K Figs. 5.14, 5.16].
demo_patterns := $(demo_folder)/patterns.svg
demo_moments := $(foreach limit,$(demo_limits),$(foreach s,0.9 0.6 0.3 \
	0,'$(limit), saturation $s=$(demo_folder)/$(limit)/response.h5@$s'))
$(call report,$(demo_patterns),crack-patterns,$(demo_limits:%=$(demo_folder)/%/response.h5),$(demo_moments))

demo: $(demo_counts) $(demo_picture) $(demo_patterns)
ifdef really
	@for limit in $(demo_limits); do \
		jq -r --arg limit $$limit '"\($$limit): " + $(crack_words)' $(demo_folder)/$$limit/crackstats.json; done
	@echo 'artifacts: $(demo_folder)'
	@echo 'pictures:  $(demo_picture) $(demo_patterns)'
endif
endif
