# SPDX-License-Identifier: GPL-3.0-or-later
# Drying and shrinking in turns: the network moves with the grains after each portion of the
# drying, beside the drying of a network that does not move (one portion).
#
#     make coupled                              ->  build/runs/coupled/coupled.svg, coupled.md
#     make coupled COUPLED_PORTIONS="1 10"

COUPLED_PORTIONS ?= 1 5 10 20# how often; 1 is one way; the last one is drawn

coupled_folder := $(RUNS)/coupled
coupled_samples := soft weak irregular stiff
# Scenes, and what they change. Under its whole load the soft aggregate collapses (docs/coupling.md).
coupled_scene_soft := samples/soft-10x5x5.json force-protocol.force_scale=0.3
coupled_scene_weak := $(coupled_scene_soft) dem-replay.bond.contact_strength=3e-8
coupled_scene_irregular := samples/soft-300.json
# The lowest layer is held: on a wall alone the aggregate may come apart between two portions.
coupled_scene_stiff := samples/stiff-5x5x10.json force-protocol.force_scale=1 dem-replay.support=fixed dem-replay.damping_ratio=0.7 dem-replay.local_damping=0 dem-replay.time_step_safety=0.045
coupled_stages := pack tessellate merge-nodes dry force-protocol dem-replay deform crackstats
coupled_version = $(call once,coupled_version,printf '%s\n' $(foreach s,$(coupled_stages),$(call version_of,$s)) | paste -sd.)

# Sample $1 in $2 portions.
define coupled_run
$(call artifact,$(coupled_folder)/$1/$2/course.tsv,stage=coupled version=$(coupled_version) $(coupled_scene_$1:%=set='%'),pipelines/studies/coupled/run pipelines/studies/coupled/course.py pipelines/lib/common.py $(firstword $(coupled_scene_$1)),pipelines/studies/coupled/run $(firstword $(coupled_scene_$1)) $2 $(wordlist 2,99,$(coupled_scene_$1)) $(coupled_folder)/$1/$2/course.tsv,$(coupled_stages:%=$(BUILD)/bin/%))
endef

coupled: ## drying and shrinking in turns, beside one way, and their picture (minutes)

ifneq ($(call asked,coupled,$(coupled_folder)),)
$(call must,COUPLED_PORTIONS,[0-9]+(\+[0-9]+)?,numbers N or N+M)
coupled_courses := $(foreach s,$(coupled_samples),$(foreach n,$(COUPLED_PORTIONS),$(coupled_folder)/$s/$n/course.tsv))
coupled_drawn := $(foreach s,$(coupled_samples),$(foreach n,$(firstword $(COUPLED_PORTIONS)) $(lastword $(COUPLED_PORTIONS)),$(coupled_folder)/$s/$n/course.tsv))
$(foreach s,$(coupled_samples),$(foreach n,$(COUPLED_PORTIONS),$(call coupled_run,$s,$n)))
$(call report,$(coupled_folder)/coupled.md,studies/coupled/table,$(coupled_courses))
$(call report,$(coupled_folder)/coupled.svg,studies/coupled/figure,$(coupled_drawn))
$(call study,coupled,$(coupled_folder)/coupled.md $(coupled_folder)/coupled.svg)
endif
