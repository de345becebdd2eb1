# SPDX-License-Identifier: GPL-3.0-or-later
# Forces with liquid pressure gradients on and off:
#
#     make gradients    ->  build/runs/gradients/gradients.svg

gradients_folder := $(RUNS)/gradients
gradients_scene := samples/gradient-2d.json
gradients_pressures := uniform clusters field

gradients: ## forces with liquid pressure gradients on and off, and their picture (seconds)

ifneq ($(call asked,gradients,$(gradients_folder)),)
$(call crack_network,$(gradients_folder),$(gradients_scene))
$(call dry,$(gradients_folder)/drying.h5,$(gradients_scene),,$(gradients_folder)/network.h5)
$(foreach p,$(gradients_pressures),$(call force-protocol,$(gradients_folder)/$p.h5,$(gradients_scene),pressure=$p,$(gradients_folder)/drying.h5))
gradients_drawn := $(gradients_folder)/drying.h5 $(gradients_pressures:%=$(gradients_folder)/%.h5)
$(call report,$(gradients_folder)/gradients.svg,studies/gradients/figure,$(gradients_drawn))

$(call study,gradients,$(gradients_folder)/gradients.svg)
endif
