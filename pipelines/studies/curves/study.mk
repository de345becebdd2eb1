# SPDX-License-Identifier: GPL-3.0-or-later
# Capillary pressure, relative permeabilities and diffusivities of packed spheres:
#
#     make curves    ->  build/runs/curves/curves.svg, table.md

curves := $(RUNS)/curves
curves_scene := samples/curves.json
curves_files := $(addprefix $(curves)/,trapping.h5 free.h5 flow.h5 packing.h5)

curves: ## capillary pressure, permeability and diffusivity of two phases

ifneq ($(call asked,curves,$(curves)),)
$(call crack_network,$(curves),$(curves_scene))
$(call step,$(curves)/trapping.h5,invade,$(BUILD)/bin/invade,$(curves_scene),trapping=true,$(curves)/network.h5)
$(call step,$(curves)/free.h5,invade,$(BUILD)/bin/invade,$(curves_scene),trapping=false,$(curves)/network.h5)
$(call step,$(curves)/flow.h5,flow,$(BUILD)/bin/flow,$(curves_scene),,$(curves)/packing.h5)
$(call report,$(curves)/curves.svg,studies/curves/report,$(curves_files),figure $(curves_files))
$(call report,$(curves)/table.md,studies/curves/report,$(curves_files),table $(curves_files))

$(call study,curves,$(curves)/table.md $(curves)/curves.svg)
endif
