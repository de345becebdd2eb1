# SPDX-License-Identifier: GPL-3.0-or-later
# The load that the soft aggregate bears as its throats narrow, in steps of the load:
#
#     make collapse                ->  build/runs/collapse/collapse.md

COLLAPSE_PORTIONS ?= 340# in which the load rises to 1.02 of the whole

# Short portions and grains that come to rest at once, so that forces follow the body.
collapse_scene := samples/soft-10x5x5.json
collapse_settings := dem-replay.local_damping=0.7 dem-replay.time_step_safety=0.025 dem-replay.cycles=100
collapse_folder := $(RUNS)/collapse

collapse: ## the load that the soft aggregate bears as its throats narrow (minutes)

ifneq ($(call asked,collapse,$(collapse_folder)),)
$(call must,COLLAPSE_PORTIONS,$(whole),a whole number)
$(call artifact,$(collapse_folder)/collapse.md,stage=collapse version=$(coupled_version) $(collapse_settings:%=set='%') set='portions=$(COLLAPSE_PORTIONS)',pipelines/studies/collapse/table pipelines/studies/coupled/run pipelines/studies/coupled/course.py pipelines/lib/common.py $(collapse_scene),pipelines/studies/collapse/table $(collapse_scene) $(COLLAPSE_PORTIONS) 1.02 $(collapse_folder)/collapse.md $(collapse_settings),$(coupled_stages:%=$(BUILD)/bin/%))
$(call study,collapse,$(collapse_folder)/collapse.md)
endif
