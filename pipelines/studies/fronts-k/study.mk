# SPDX-License-Identifier: GPL-3.0-or-later
# Drying fronts of water in networks as K's (networks-k.mk makes them): five layers
# whose radii are drawn as narrow as his [K Figs. 3.30, 3.31], and
# 1220 grains of his count and about as many throats [K Fig. 3.48]:
#
#     make fronts-k  ->  build/runs/fronts-k/fronts-k.svg, table.md

fronts_k := $(RUNS)/fronts-k
fronts_k_seeds := 1 2 3 4 5
fronts_k_layers := $(fronts_k_seeds:%=$(fronts_k)/layer-%/drying.h5)
fronts_k_grains := $(foreach f,$(k_frictions),$(fronts_k)/grains-$f/viscous.h5)
fronts_k_inviscid := $(fronts_k)/grains-$(lastword $(k_frictions))/inviscid.h5
fronts_k_drawn := $(fronts_k_layers) $(fronts_k_grains) $(fronts_k_inviscid)
fronts_k_narrow := throat_radius.distribution=normal throat_radius.mean=100e-9 throat_radius.standard_deviation=14e-9

fronts-k: ## drying fronts of water in networks as Kharaghani's (minutes)

ifneq ($(call asked,fronts-k,$(fronts_k)),)
define fronts_k_layer
$(call crack_network,$1,samples/fronts-2d.json,seed=$2)
$(call dry,$1/drying.h5,samples/fronts-2d.json,liquid=viscous $(fronts_k_narrow) throat_radius.seed=$2,$1/network.h5)
endef
$(foreach s,$(fronts_k_seeds),$(call fronts_k_layer,$(fronts_k)/layer-$s,$s))
$(call k_network,3-1220-eliminate,$(word 1,$(k_counts/3-1220-eliminate)),0,samples/networks-k-3d.json,$(fronts_k)/grains-0)
$(call k_network,3-1220-eliminate,$(word 2,$(k_counts/3-1220-eliminate)),0.5,samples/networks-k-3d.json,$(fronts_k)/grains-0.5)
$(foreach f,$(k_frictions),$(foreach l,viscous inviscid,$(call dry,$(fronts_k)/grains-$f/$l.h5,samples/fronts-3d.json,liquid=$l boundary_layer.layers=10,$(fronts_k)/grains-$f/merged-0.06.h5)))
$(call report,$(fronts_k)/fronts-k.svg,studies/fronts-k/report,$(fronts_k_drawn),figure $(fronts_k_drawn))
$(call report,$(fronts_k)/table.md,studies/fronts-k/report,$(fronts_k_drawn),table $(fronts_k_drawn))

$(call study,fronts-k,$(fronts_k)/table.md $(fronts_k)/fronts-k.svg)
endif
