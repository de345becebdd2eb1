# SPDX-License-Identifier: GPL-3.0-or-later
# Every bridge model beside the exact solution: the 13 cases of [G Table 1], and errors
# over all volumes, contact angles, separations and ratios of radii:
#
#     make bridges                           ->  build/runs/bridges/ratios.md, ranges.md, pictures

bridges_folder := $(RUNS)/bridges
bridges_program := pipelines/studies/bridges/report
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

bridges: ## every capillary bridge model against the exact solution (two minutes of one core)

ifneq ($(call asked,bridges,$(bridges_folder)),)
$(foreach c,$(bridges_cases),$(call artifact,$(bridges_folder)/$(firstword $(subst :, ,$c)).json,$(bridges_key) set=case=$c,$(bridges_program),$(bridges_program) case $c $(bridges_folder)/$(firstword $(subst :, ,$c)).json,$(BUILD)/bin/bridge))
$(call report,$(bridges_folder)/cases.svg,studies/bridges/report,$(bridges_json),curves $(bridges_json))
$(call report,$(bridges_folder)/ratios.md,studies/bridges/report,$(bridges_json),ratios $(bridges_json))
$(call report,$(bridges_folder)/ratios.svg,studies/bridges/report,$(bridges_json),ratios-picture $(bridges_json))
$(call artifact,$(bridges_folder)/errors.txt,$(bridges_key),$(bridges_program),$(bridges_program) errors $(bridges_errors) $(bridges_folder)/errors.txt,)
$(call report,$(bridges_folder)/ranges.md,studies/bridges/report,$(bridges_folder)/errors.txt,ranges $(bridges_folder)/errors.txt)
$(call report,$(bridges_folder)/maps.png,studies/bridges/report,$(bridges_folder)/errors.txt,maps $(bridges_folder)/errors.txt)

$(bridges_folder)/errors.txt: | $(bridges_errors)
$(call study,bridges,$(addprefix $(bridges_folder)/,ratios.md ranges.md cases.svg ratios.svg maps.png))
endif
