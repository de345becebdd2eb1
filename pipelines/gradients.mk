# SPDX-License-Identifier: GPL-3.0-or-later
# Forces with liquid pressure gradients on and off:
#
#     make gradients    ->  build/runs/gradients/gradients.svg

pipeline_goals += gradients
gradients_folder := $(RUNS)/gradients
gradients_scene := samples/gradient-2d.json
gradients_pressures := uniform clusters field

.PHONY: gradients
gradients: ## forces with liquid pressure gradients on and off, and their picture (a minute)

ifneq ($(filter gradients $(gradients_folder)/%,$(MAKECMDGOALS)),)
$(call crack_network,$(gradients_folder),$(gradients_scene))
$(call step,$(gradients_folder)/drying.h5,dry,$(DRY),$(gradients_scene),,$(gradients_folder)/network.h5)
$(foreach p,$(gradients_pressures),$(call \
	step,$(gradients_folder)/$p.h5,force-protocol,$(FORCE_PROTOCOL),$(gradients_scene),pressure=$p,$(gradients_folder)/drying.h5))
gradients_drawn := $(gradients_folder)/drying.h5 $(gradients_pressures:%=$(gradients_folder)/%.h5)
$(call artifact,$(gradients_folder)/gradients.svg,stage=gradients-figure version=1,$(wildcard \
	pipelines/gradients-figure*) $(gradients_drawn),pipelines/gradients-figure \
	$(gradients_drawn) $(gradients_folder)/gradients.svg,$(BUILD)/bin/inspect)

gradients: $(gradients_folder)/gradients.svg
ifdef really
	@echo 'picture: $(gradients_folder)/gradients.svg'
endif
endif
