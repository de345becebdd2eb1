# SPDX-License-Identifier: GPL-3.0-or-later
# Every bridge model beside the exact solution: the 13 cases of [G Table 1], and errors
# over all volumes, contact angles, separations and ratios of radii:
#
#     make bridges                           ->  build/runs/bridges/ratios.md, ranges.md, pictures

pipeline_goals += bridges
bridges_folder := $(RUNS)/bridges
# Code, radii in m, surface tension in N/m, contact angle in degrees, volume in m3.
bridges_cases := \
	W11:2.381e-3:2.381e-3:20.6e-3:0:13.6e-12 W12:2.381e-3:2.381e-3:20.6e-3:0:31.3e-12 \
	W13:2.381e-3:2.381e-3:20.6e-3:0:74.2e-12 W21:2.381e-3:1.588e-3:20.6e-3:0:9.6e-12 \
	W22:2.381e-3:1.588e-3:20.6e-3:0:13.2e-12 W23:2.381e-3:1.588e-3:20.6e-3:0:24.7e-12 \
	W24:2.381e-3:1.588e-3:20.6e-3:0:59.3e-12 W31:2.381e-3:1.191e-3:20.6e-3:0:25.3e-12 \
	W32:2.381e-3:1.191e-3:20.6e-3:0:61.8e-12 W33:2.381e-3:1.191e-3:20.6e-3:0:127.8e-12 \
	R1:19e-6:35e-6:27e-3:10:2e-19 R2:19e-6:32.5e-6:24e-3:10:12e-19 R3:19e-6:27.5e-6:28e-3:10:36e-19

bridges_json := $(foreach c,$(bridges_cases),$(bridges_folder)/$(firstword $(subst :, ,$c)).json)
bridges_key = stage=bridge version=$(call version_of,bridge) set=pipeline=1
bridges_errors := $(BUILD)/tests/bench/bridge_errors

.PHONY: bridges
bridges: ## every capillary bridge model against the exact solution (two minutes of one core)

ifneq ($(filter bridges,$(MAKECMDGOALS)),)
$(foreach c,$(bridges_cases),$(call artifact,$(bridges_folder)/$(firstword $(subst :, ,$c)).json,$(bridges_key) set=case=$c,pipelines/bridges,pipelines/bridges case $c $(bridges_folder)/$(firstword $(subst :, ,$c)).json,$(BUILD)/bin/bridge))
$(call artifact,$(bridges_folder)/cases.svg,$(bridges_key),pipelines/bridges $(bridges_json),pipelines/bridges curves $(bridges_json) $(bridges_folder)/cases.svg,)
$(call artifact,$(bridges_folder)/ratios.md,$(bridges_key),pipelines/bridges $(bridges_json),pipelines/bridges ratios $(bridges_json) $(bridges_folder)/ratios.md,)
$(call artifact,$(bridges_folder)/ratios.svg,$(bridges_key),pipelines/bridges $(bridges_json),pipelines/bridges ratios-picture $(bridges_json) $(bridges_folder)/ratios.svg,)
$(call artifact,$(bridges_folder)/errors.txt,$(bridges_key),pipelines/bridges,pipelines/bridges errors $(bridges_errors) $(bridges_folder)/errors.txt,)
$(call artifact,$(bridges_folder)/ranges.md,$(bridges_key),pipelines/bridges $(bridges_folder)/errors.txt,pipelines/bridges ranges $(bridges_folder)/errors.txt $(bridges_folder)/ranges.md,)
$(call artifact,$(bridges_folder)/maps.png,$(bridges_key),pipelines/bridges $(bridges_folder)/errors.txt,pipelines/bridges maps $(bridges_folder)/errors.txt $(bridges_folder)/maps.png,)

$(bridges_folder)/errors.txt: | $(bridges_errors)
bridges: $(bridges_folder)/cases.svg $(bridges_folder)/ratios.md $(bridges_folder)/ratios.svg \
		$(bridges_folder)/ranges.md $(bridges_folder)/maps.png
ifdef really
	@cat $(bridges_folder)/ratios.md $(bridges_folder)/ranges.md
endif
endif
