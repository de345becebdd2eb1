# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures of boundary layers, on all nodes of the surface and on an auxiliary layer of grains:
#
#     make boundary-layers  ->  build/runs/boundary-layers/picture.svg [K Figs. 3.17, 3.18, 3.44]
#     make boundary-study       what the number of layers changes, and no lattice at all

boundary_folder := $(RUNS)/boundary-layers
boundary_dryings := 2d-surface 2d-auxiliary 3d-surface 3d-auxiliary
boundary_drawn := $(boundary_dryings:%=$(boundary_folder)/%/drying.h5)

# Drying of sample $1 ($2: surface, auxiliary) with the overrides $3 of its packing, $4 of
# its tessellation.
define boundary_drying
$(call crack_network,$(boundary_folder)/$1-$2,samples/boundary-$1.json,$3,$4)
$(call dry,$(boundary_folder)/$1-$2/drying.h5,samples/boundary-$1.json,boundary_layer.columns=$2 throat_radius.distribution=normal,$(boundary_folder)/$1-$2/network.h5)
endef

boundary_counts := 1 2 5 10 20 40 80 160
boundary_3d := $(boundary_folder)/3d-surface
boundary_studied := $(boundary_counts:%=$(boundary_3d)/layers-%.h5) $(boundary_3d)/lumped.h5
boundary_law := throat_radius.distribution=normal boundary_layer.columns=surface

boundary-layers: ## pictures of boundary layers, and of their exchange areas

boundary-study: ## what the number of layers of a boundary layer changes

ifneq ($(filter boundary-layers boundary-study $(boundary_folder)/%,$(MAKECMDGOALS)),)
$(foreach n,2d 3d,$(call boundary_drying,$n,surface,extra_layer=false,))
$(call boundary_drying,2d,auxiliary,,boundary=eliminate)
$(call boundary_drying,3d,auxiliary,,)
$(call report,$(boundary_folder)/picture.svg,figures/boundary-layer,$(boundary_drawn))

$(foreach n,$(boundary_counts),$(call dry,$(boundary_3d)/layers-$n.h5,samples/boundary-3d.json,$(boundary_law) boundary_layer.layers=$n,$(boundary_3d)/network.h5))
$(call dry,$(boundary_3d)/lumped.h5,samples/boundary-3d.json,$(boundary_law) boundary_layer.exchange=lumped,$(boundary_3d)/network.h5)

$(call report,$(boundary_3d)/layers.md,studies/boundary-layers/table,$(boundary_studied))
$(call study,boundary-study,$(boundary_3d)/layers.md)
$(call study,boundary-layers,$(boundary_folder)/picture.svg)
endif
