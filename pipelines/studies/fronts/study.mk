# SPDX-License-Identifier: GPL-3.0-or-later
# Drying fronts in inviscid, viscous and immobile liquid:
#
#     make fronts    ->  build/runs/fronts/fronts.svg       [K Figs. 3.29, 3.30, 3.31, 3.38]

fronts_folder := $(RUNS)/fronts
fronts_liquids := inviscid viscous immobile

fronts: ## pictures of drying fronts in inviscid, viscous and immobile liquid (minutes)

ifneq ($(call asked,fronts,$(fronts_folder)),)
$(foreach d,2d 3d,$(call crack_network,$(fronts_folder)/$d,samples/fronts-$d.json)\
$(foreach l,$(fronts_liquids),$(call dry,$(fronts_folder)/$d-$l.h5,samples/fronts-$d.json,liquid=$l,$(fronts_folder)/$d/network.h5)))
$(call report,$(fronts_folder)/fronts.svg,studies/fronts/figure,$(foreach d,2d 3d,$(fronts_liquids:%=$(fronts_folder)/$d-%.h5)))

$(call study,fronts,$(fronts_folder)/fronts.svg)
endif
