# SPDX-License-Identifier: GPL-3.0-or-later
# From a scene to its cracks:
#
#     make run SCENE=samples/x.json    ->  build/runs/x/crackstats.json
#     make report SCENE=samples/x.json ->  build/runs/x/report.html, a page that shows the run
#     make run SCENE=samples/x.json NAME=y  ->  the same in build/runs/y
#     make simulate SCENE=samples/drum.json  ->  build/runs/drum/motion.h5
#     make demo                        ->  the sample in both drying limits, for several draws of
#                                          the throat radii, pages and pictures of the first, and
#                                          a page of all
#     make demo PAGES=no               ->  the same without pages
#     make demo SCENE=samples/x.json   ->  the same for another scene
#     make demo DEMO_SEEDS="3 4 5"     ->  the same for these draws

SCENE ?=
IMPORT ?=# what `pack` reads, for a scene that imports its grains
$(if $(IMPORT),$(if $(wildcard $(IMPORT)),,$(error IMPORT=$(IMPORT): no such file)))

# Each stage may be replaced: DRY=mydry. It is asked for its --version to know it by.
PACK ?= $(BUILD)/bin/pack
TESSELLATE ?= $(BUILD)/bin/tessellate
MERGE_NODES ?= $(BUILD)/bin/merge-nodes
DRY ?= $(BUILD)/bin/dry
FORCE_PROTOCOL ?= $(BUILD)/bin/force-protocol
DEM_REPLAY ?= $(BUILD)/bin/dem-replay
CRACKSTATS ?= $(BUILD)/bin/crackstats
REPORT ?= $(BUILD)/bin/report
SIMULATE ?= $(BUILD)/bin/simulate
SHEARSTATS ?= $(BUILD)/bin/shearstats

# $1 is made by the stage of that name from scene $2, with the overrides $3, and the files $4.
pack = $(call step,$1,pack,$(PACK),$2,$3,$4)
tessellate = $(call step,$1,tessellate,$(TESSELLATE),$2,$3,$4)
merge-nodes = $(call step,$1,merge-nodes,$(MERGE_NODES),$2,$3,$4)
dry = $(call step,$1,dry,$(DRY),$2,$3,$4)
force-protocol = $(call step,$1,force-protocol,$(FORCE_PROTOCOL),$2,$3,$4)
dem-replay = $(call step,$1,dem-replay,$(DEM_REPLAY),$2,$3,$4)
shearstats = $(call step,$1,shearstats,$(SHEARSTATS),$2,$3,$4)
simulate = $(call step,$1,simulate,$(SIMULATE),$2,$3,$4)
crackstats = $(call step,$1,crackstats,$(CRACKSTATS),$2,$3,$4)

# A page, with title $3, which leads to page $5.
page = $(call step,$1,report,$(REPORT),$2,title="$3" $(5:%=study="%"),$4)

pipeline_goals += demo run report simulate

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

# What a page shows: the artifacts of folder $1 up to the network, and those after it.
network_artifacts = $(addprefix $1/,packing.h5 tessellation.h5 network.h5)
history_artifacts = $(addprefix $1/,drying.h5 forces.h5 response.h5 crackstats.json)

# Prints what $1, a crackstats.json, comes down to; $2: a word before it.
headline = printf '%s' '$2' && jq -rf pipelines/run/headline.jq --arg draws 'draws of the throat radii' $1

# --- one scene ------------------------------------------------------------------------

.PHONY: run report simulate
ifneq ($(SCENE),)
run_folder := $(RUNS)/$(or $(strip $(NAME)),$(basename $(notdir $(SCENE))))
$(call crack_network,$(run_folder),$(SCENE))
$(call crack_history,$(run_folder),$(SCENE),$(run_folder)/network.h5,)
run_page := $(run_folder)/report.html
define refuse_drains
if $(DEM_REPLAY) -p $(SCENE) --parameters | jq -e '.capillary.suction > 0' >/dev/null; then \
		echo '$(SCENE): dem-replay.capillary drains the packing itself, so there is no drying to run:' \
			'make craquelure SCENE=$(SCENE)$(IMPORT:%= IMPORT=%)' >&2; exit 65; fi
endef
ifneq ($(filter report $(run_page),$(MAKECMDGOALS)),)
$(call page,$(run_page),$(SCENE),$(notdir $(run_folder)),$(call network_artifacts,$(run_folder)) $(call \
	history_artifacts,$(run_folder)))
endif
ifneq ($(filter simulate $(run_folder)/motion.h5,$(MAKECMDGOALS)),)
$(call simulate,$(run_folder)/motion.h5,$(SCENE),,$(run_folder)/packing.h5)
endif
# What the last stage would refuse is not to be found after the others have run: a wrong key, or a
# layer whose liquid dem-replay itself drains, which takes no drying.
run_stages := $(if $(filter simulate,$(MAKECMDGOALS)),pack simulate,pack tessellate merge-nodes dry force-protocol \
	dem-replay crackstats $(filter report,$(MAKECMDGOALS)))
# A folder holds one scene: another file of the same name in another folder would take its place.
define keep_to_scene
of=$$(cat $(run_folder)/scene.path 2>/dev/null || true); if [[ -e $$of && ! $$of -ef $(SCENE) ]]; then \
		echo "$(run_folder): holds the run of $$of: NAME= gives that of $(SCENE) another folder" >&2; exit 73; fi; \
		mkdir -p $(run_folder) && realpath $(SCENE) >$(run_folder)/scene.path
endef
ifdef really
.PHONY: sections
$(run_folder)/packing.h5: | sections
sections: | $(run_stages:%=$(BUILD)/bin/%)
	@for stage in $(run_stages); do \
		$(BUILD)/bin/$$stage -p $(SCENE) --parameters >/dev/null || exit; done
	$(if $(filter dem-replay,$(run_stages)),$(if $(filter $(BUILD)/bin/dem-replay,$(DEM_REPLAY)),@$(refuse_drains)))
	@$(keep_to_scene)
endif
run: $(run_folder)/crackstats.json ## run the pipeline: make run SCENE=samples/x.json
ifdef really
	@$(call headline,$(run_folder)/crackstats.json,) 2>/dev/null || true
	@echo 'artifacts: $(run_folder)'
endif
simulate: $(run_folder)/motion.h5 ## discrete elements for a scene: make simulate SCENE=samples/drum.json
ifdef really
	@echo 'motion: $<'
endif
report: $(run_page) ## a page that shows a run: make report SCENE=samples/x.json
ifdef really
	@echo 'page: $(run_page)'
endif
else
run report simulate:
	@echo 'Which scene? make $@ SCENE=samples/x.json' >&2; exit 64
endif

# --- the demonstration ----------------------------------------------------------------

DEMO_SEEDS ?=# of the throat radii; pictures show the first [eight from the scene's own on]

demo_scene := $(or $(SCENE),samples/stiff-5x5x10.json)
demo_folder := $(RUNS)/$(or $(strip $(NAME)),$(basename $(notdir $(demo_scene))))
demo_limits := inviscid immobile
demo_picture := $(if $(wildcard pipelines/run/picture),$(demo_folder)/picture.svg)

.PHONY: demo
demo: ## from the stiff aggregate of the samples to its cracks, pages and pictures, in both limits

ifneq ($(filter demo $(demo_folder)/%,$(MAKECMDGOALS)),)
# The scene's own seed; none where it takes the network's radii and draws none.
demo_own := $(shell jq -r '.dry.throat_radius | select((.distribution // "network") != "network") \
	| .seed // 1 | floor' $(demo_scene) 2>/dev/null)
ifneq ($(strip $(DEMO_SEEDS)),)
$(call must,DEMO_SEEDS,$(natural),whole numbers)
$(if $(or $(demo_own),$(if $(word 2,$(DEMO_SEEDS)),,one)),,$(error DEMO_SEEDS: $(demo_scene) draws no throat radii, so all \
	seeds are alike: dry.throat_radius.distribution draws them))
endif
demo_seeds := $(if $(demo_own),$(or $(call once_each,$(DEMO_SEEDS)),$(shell seq $(demo_own) $$(($(demo_own) + 7)))))
demo_first := $(firstword $(demo_seeds))
demo_others := $(wordlist 2,$(words $(demo_seeds)),$(demo_seeds))

# The runs of limit $1: the first in its folder, as `make run` has it, the others in one each.
demo_run_folders = $(demo_folder)/$1 $(demo_others:%=$(demo_folder)/$1/seed-%)
# What sets seed $1 where it is not that of the scene.
demo_set = $(addprefix throat_radius.seed=,$(filter-out $(demo_own),$1))
define demo_limit
$(call crack_history,$(demo_folder)/$1,$(demo_scene),$(demo_folder)/network.h5,liquid=$1 $(call demo_set,$(demo_first)))
$(foreach seed,$(demo_others),$(call \
	crack_history,$(demo_folder)/$1/seed-$(seed),$(demo_scene),$(demo_folder)/network.h5,liquid=$1 $(call demo_set,$(seed))))
$(call crackstats,$(demo_folder)/$1/seeds.json,$(demo_scene),,$(foreach \
	folder,$(call demo_run_folders,$1),$(folder)/response.h5 $(folder)/drying.h5))
endef
$(call crack_network,$(demo_folder),$(demo_scene))
$(foreach limit,$(demo_limits),$(call demo_limit,$(limit)))

demo_counts := $(demo_limits:%=$(demo_folder)/%/crackstats.json)
demo_means := $(if $(demo_others),$(demo_limits:%=$(demo_folder)/%/seeds.json),$(demo_counts))
demo_drawn := $(foreach limit,$(demo_limits),$(addprefix \
	$(demo_folder)/$(limit)/,drying.h5 forces.h5 response.h5 crackstats.json))
ifneq ($(demo_picture),)
$(call report,$(demo_picture),run/picture,$(demo_drawn),$(demo_folder))
endif

# What has broken at four saturations [K Figs. 5.14, 5.16].
demo_patterns := $(demo_folder)/patterns.svg
demo_moments := $(foreach limit,$(demo_limits),$(foreach s,0.9 0.6 0.3 \
	0,'$(limit), saturation $s=$(demo_folder)/$(limit)/response.h5@$s'))
$(call report,$(demo_patterns),figures/crack-patterns,$(demo_limits:%=$(demo_folder)/%/response.h5),$(demo_moments))

# A page of the first run of each limit, with the intervals over all; and one of all runs.
PAGES ?=# no: none
ifneq ($(PAGES),no)
demo_pages := $(demo_limits:%=$(demo_folder)/%/report.html)
$(foreach limit,$(demo_limits),$(call page,$(demo_folder)/$(limit)/report.html,$(demo_scene),$(notdir \
	$(demo_folder))/$(limit),$(call network_artifacts,$(demo_folder)) $(call \
	history_artifacts,$(demo_folder)/$(limit)) $(filter $(demo_folder)/$(limit)/seeds.json,$(demo_means)),../study.html))
demo_study := $(demo_folder)/study.html
demo_all := $(foreach limit,$(demo_limits),$(call demo_run_folders,$(limit)))
$(call artifact,$(demo_study),scene=$(demo_scene) stage=report version=$(call version_of,report),$(call \
	network_artifacts,$(demo_folder)) $(foreach folder,$(demo_all),$(call \
	history_artifacts,$(folder))) $(demo_pages),$(RUN) $(REPORT) -p $(demo_scene) --set $(call \
	quoted,title="$(notdir $(demo_folder))") $(demo_all) -o $(demo_study),$(REPORT))
endif

demo: $(demo_pages) $(demo_study) $(demo_counts) $(demo_means) $(demo_picture) $(demo_patterns)
ifdef really
	@$(foreach limit,$(demo_limits),$(call headline,$(filter $(demo_folder)/$(limit)/%,$(demo_means)),$(limit): );)
	@echo 'artifacts: $(demo_folder)'
	@echo 'pictures:  $(demo_picture) $(demo_patterns)'
	$(if $(demo_pages),@echo 'pages:     $(demo_study) $(demo_pages)')
endif
endif
