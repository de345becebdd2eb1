# SPDX-License-Identifier: GPL-3.0-or-later
# How far the drying rate of 1220 grains falls at first, and when gas reaches their bottom, by
# what one assumes of the boundary layer, the network and the liquid [K Fig. 3.48]:
#
#     make rate-drop  ->  build/runs/rate-drop/rate-drop.svg, table.md

rate_drop := $(RUNS)/rate-drop
rate_drop_seeds := 1 2 3 4 5
rate_drop_water := liquid=viscous step_interval=0
rate_drop_drawn := throat_radius.distribution=normal throat_radius.mean=92e-9 throat_radius.standard_deviation=40e-9

# For each run its network, then what differs from samples/fronts-3d.json. Beta of 5.1 m/s is a
# layer of ten grains; beta 5.1e9, without exchange sideways, gives the wet share of the surface.
rate_drop/ten := rough/merged
rate_drop/layers-1 := rough/merged boundary_layer.layers=1
rate_drop/layers-40 := rough/merged boundary_layer.layers=40
rate_drop/lumped := rough/merged boundary_layer.exchange=lumped
rate_drop/two := rough/merged boundary_layer.mass_transfer=25.5
rate_drop/one := rough/merged boundary_layer.mass_transfer=51
rate_drop/half := rough/merged boundary_layer.mass_transfer=102
rate_drop/fifth := rough/merged boundary_layer.mass_transfer=255
rate_drop/tenth := rough/merged boundary_layer.mass_transfer=510
rate_drop/wet := rough/merged boundary_layer.mass_transfer=5.1e9 boundary_layer.exchange=lumped
rate_drop/squares := rough/merged boundary_layer.mass_transfer=18.3
rate_drop/one-squares := rough/merged boundary_layer.mass_transfer=183
rate_drop/knudsen := rough/merged knudsen=true
rate_drop/auxiliary := auxiliary/merged boundary_layer.columns=auxiliary
rate_drop/unmerged := rough/network
rate_drop/smooth := smooth/merged
rate_drop/drawn := rough/merged $(rate_drop_drawn)
rate_drop/drawn-lumped := rough/merged boundary_layer.exchange=lumped $(rate_drop_drawn)
rate_drop/cut := cut/merged
rate_drop/gas-at-first := rough/merged start_saturation=0.95
rate_drop/water := rough/merged $(rate_drop_water)
rate_drop/water-without-8 := rough/merged viscosity=1.25e-7 $(rate_drop_water)
rate_drop/water-thick := rough/merged viscosity=8e-6 $(rate_drop_water)
rate_drop/water-one := rough/merged boundary_layer.mass_transfer=51 $(rate_drop_water)
rate_drop/water-one-without-8 := rough/merged boundary_layer.mass_transfer=51 viscosity=1.25e-7 $(rate_drop_water)
rate_drop_names := ten layers-1 layers-40 two one half fifth tenth lumped squares one-squares wet knudsen auxiliary \
	unmerged smooth drawn drawn-lumped cut gas-at-first water water-without-8 water-thick water-one water-one-without-8
rate_drop_seeded := $(foreach f,0 0.5,$(rate_drop_seeds:%=$f-%))
rate_drop_files := $(rate_drop_names:%=$(rate_drop)/%.h5) $(rate_drop_seeded:%=$(rate_drop)/seed-%.h5)

rate-drop: ## what the first fall of the drying rate depends on (minutes)

ifneq ($(call asked,rate-drop,$(rate_drop)),)
# Folder $1: grains with overrides $2, their network with overrides $3.
define rate_drop_network
$(call pack,$1/packing.h5,samples/networks-k-3d.json,$2,)
$(call tessellate,$1/network.h5,samples/networks-k-3d.json,$3,$1/packing.h5)
$(call merge-nodes,$1/merged.h5,samples/networks-k-3d.json,threshold=0.06,$1/network.h5)
endef
rate_drop_rough := count=$(word 2,$(k_counts/3-1220-eliminate)) dynamics.friction=0.5
rate_drop_smooth := count=$(word 1,$(k_counts/3-1220-eliminate)) dynamics.friction=0
$(call rate_drop_network,$(rate_drop)/rough,$(rate_drop_rough),boundary=eliminate)
$(call rate_drop_network,$(rate_drop)/smooth,$(rate_drop_smooth),boundary=eliminate)
$(call rate_drop_network,$(rate_drop)/auxiliary,$(rate_drop_rough) extra_layer=true,boundary=eliminate)
$(call rate_drop_network,$(rate_drop)/cut,count=1220 dynamics.friction=0.5,boundary=truncate)
$(foreach s,$(rate_drop_seeds),$(call rate_drop_network,$(rate_drop)/0.5-$s,$(rate_drop_rough) seed=$s,boundary=eliminate)\
$(call rate_drop_network,$(rate_drop)/0-$s,$(rate_drop_smooth) seed=$s,boundary=eliminate))
rate_drop_run = $(call dry,$(rate_drop)/$1.h5,samples/fronts-3d.json,liquid=inviscid \
	boundary_layer.layers=10 step_interval=0.002 $2,$(rate_drop)/$3.h5)
$(foreach n,$(rate_drop_names),$(call rate_drop_run,$n,$(wordlist 2,99,$(rate_drop/$n)),$(firstword $(rate_drop/$n))))
$(foreach n,$(rate_drop_seeded),$(call rate_drop_run,seed-$n,,$n/merged))
$(call report,$(rate_drop)/table.md,studies/rate-drop/report,$(rate_drop_files),table $(rate_drop))
$(call report,$(rate_drop)/rate-drop.svg,studies/rate-drop/report,$(rate_drop_files),figure $(rate_drop))

$(call study,rate-drop,$(rate_drop)/table.md $(rate_drop)/rate-drop.svg)
endif
