# SPDX-License-Identifier: GPL-3.0-or-later
# A layer that shrinks as it dries and parts into polygons:
#
#     make craquelure                          ->  build/runs/craquelure-40/polygons.png, drying.png,
#                                                  film.gif, tension.png, table.md
#     make craquelure CRAQUELURE_SEEDS="1 2 3" ->  the same of the first, the table over all packings
#     make craquelure SCENE=samples/x.json     ->  the same for another scene
#     make craquelure SET="pack.upper=..." NAME=wide ->  with other values, in build/runs/wide

CRAQUELURE_SEEDS ?=# of the packing [that of the scene]

craquelure_scene := $(or $(SCENE),samples/craquelure-40.json)
craquelure := $(RUNS)/$(or $(strip $(NAME)),$(basename $(notdir $(craquelure_scene))))

craquelure: ## a layer that cracks into polygons as it shrinks (a minute of one core)

ifneq ($(call asked,craquelure,$(craquelure)),)
$(if $(wildcard $(craquelure_scene)),,$(error $(craquelure_scene): no such file))
craquelure_seeds := $(or $(call once_each,$(CRAQUELURE_SEEDS)),$(shell jq -r '.pack.seed // 1 | floor' $(craquelure_scene)))
# What SET sets of stage $1.
craquelure_set = $(patsubst $1.%,%,$(filter $1.%,$(SET)))
# Only explosive_repulsion moves grains of a file by its seed.
ifneq ($(and $(IMPORT),$(word 2,$(craquelure_seeds))),)
craquelure_method := $(lastword $(shell jq -r '.pack.method // "cubic"' $(craquelure_scene)) $(patsubst method=%,%,$(filter \
	method=%,$(call craquelure_set,pack))))
$(if $(filter explosive_repulsion,$(craquelure_method)),,$(error CRAQUELURE_SEEDS: one only, since grains of a file are the same \
	for each (but by pack.method=explosive_repulsion)))
endif
$(if $(filter-out pack.% dem-replay.% crackstats.%,$(SET)),$(error SET: must be pack.KEY, dem-replay.KEY or crackstats.KEY))
# The layer of seed $1, in a folder of its own.
define craquelure_layer
$(call pack,$(craquelure)/seed-$1/packing.h5,$(craquelure_scene),seed=$1 $(call craquelure_set,pack),$(IMPORT))
$(call dem-replay,$(craquelure)/seed-$1/response.h5,$(craquelure_scene),$(call craquelure_set,dem-replay),$(craquelure)/seed-$1/packing.h5)
endef
$(foreach seed,$(craquelure_seeds),$(call craquelure_layer,$(seed)))
craquelure_responses := $(craquelure_seeds:%=$(craquelure)/seed-%/response.h5)
# Not crackstats.json, which is what `make run` makes of the same scene by drying it.
$(call crackstats,$(craquelure)/polygons.json,$(craquelure_scene),polygons=true same_bonds=false $(call craquelure_set,crackstats),$(craquelure_responses))
craquelure_files := $(firstword $(craquelure_responses)) $(craquelure)/polygons.json
$(call report,$(craquelure)/polygons.png,studies/craquelure/report,$(craquelure_files),polygons $(craquelure_files))
$(call report,$(craquelure)/drying.png,studies/craquelure/report,$(craquelure_files),drying $(craquelure_files))
$(call report,$(craquelure)/film.gif,studies/craquelure/report,$(craquelure_files),film $(craquelure_files))
$(call report,$(craquelure)/table.md,studies/craquelure/report,$(craquelure_files),table $(craquelure_files))
$(call report,$(craquelure)/tension.png,studies/craquelure/report,$(craquelure_files),tension $(craquelure_files))

$(call study,craquelure,$(addprefix $(craquelure)/,table.md polygons.png drying.png film.gif tension.png))
endif
