# SPDX-License-Identifier: GPL-3.0-or-later
# Capillary pressure, relative permeabilities and diffusivities of packed spheres:
#
#     make curves    ->  build/runs/curves/curves.svg, table.md

pipeline_goals += curves
curves := $(RUNS)/curves
curves_scene := samples/curves.json
curves_files := $(addprefix $(curves)/,trapping.h5 free.h5 flow.h5 packing.h5)

.PHONY: curves
curves: ## capillary pressure, permeability and diffusivity of two phases

ifneq ($(filter curves $(curves)/%,$(MAKECMDGOALS)),)
$(call crack_network,$(curves),$(curves_scene))
$(call step,$(curves)/trapping.h5,invade,$(BUILD)/bin/invade,$(curves_scene),trapping=true,$(curves)/network.h5)
$(call step,$(curves)/free.h5,invade,$(BUILD)/bin/invade,$(curves_scene),trapping=false,$(curves)/network.h5)
$(call step,$(curves)/flow.h5,flow,$(BUILD)/bin/flow,$(curves_scene),,$(curves)/packing.h5)
$(call artifact,$(curves)/curves.svg,stage=curves version=1,$(wildcard pipelines/curves pipelines/curves.gp) \
	$(curves_files),pipelines/curves figure $(curves_files) $(curves)/curves.svg,$(BUILD)/bin/inspect)
$(call artifact,$(curves)/table.md,stage=curves version=1,pipelines/curves $(curves_files),pipelines/curves \
	table $(curves_files) $(curves)/table.md,$(BUILD)/bin/inspect)

curves: $(curves)/curves.svg $(curves)/table.md
ifdef really
	@cat $(curves)/table.md
	@echo 'picture: $(curves)/curves.svg'
endif
endif
