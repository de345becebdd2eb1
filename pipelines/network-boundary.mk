# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures of boundary layers, on all nodes of the surface and on an auxiliary layer of grains:
#
#     make boundary-layers  ->  build/runs/boundary-layers/picture.svg [K Figs. 3.17, 3.18, 3.44]

pipeline_goals += boundary-layers
boundary_folder := $(RUNS)/boundary-layers
boundary_dryings := 2d-surface 2d-auxiliary 3d-surface 3d-auxiliary
boundary_drawn := $(boundary_dryings:%=$(boundary_folder)/%/drying.h5)

# Drying of sample $1 ($2: surface, auxiliary) with the overrides $3 of its packing, $4 of
# its tessellation.
define boundary_drying
$(call step,$(boundary_folder)/$1-$2/packing.h5,pack,$(PACK),samples/boundary-$1.json,$3,)
$(call step,$(boundary_folder)/$1-$2/tessellation.h5,tessellate,$(TESSELLATE),samples/boundary-$1.json,$4,$(boundary_folder)/$1-$2/packing.h5)
$(call step,$(boundary_folder)/$1-$2/network.h5,merge-nodes,$(MERGE_NODES),samples/boundary-$1.json,,$(boundary_folder)/$1-$2/tessellation.h5)
$(call step,$(boundary_folder)/$1-$2/drying.h5,dry,$(DRY),samples/boundary-$1.json,boundary_layer.columns=$2 throat_radius.distribution=normal,$(boundary_folder)/$1-$2/network.h5)
endef

.PHONY: boundary-layers
boundary-layers: ## pictures of boundary layers, and of their exchange areas

ifneq ($(filter boundary-layers $(boundary_folder)/%,$(MAKECMDGOALS)),)
$(foreach n,2d 3d,$(call boundary_drying,$n,surface,extra_layer=false,))
$(call boundary_drying,2d,auxiliary,,boundary=eliminate)
$(call boundary_drying,3d,auxiliary,,)
$(call artifact,$(boundary_folder)/picture.svg,stage=boundary-figure version=1,$(wildcard \
	pipelines/boundary-figure*) $(boundary_drawn),pipelines/boundary-figure $(boundary_drawn) \
	$(boundary_folder)/picture.svg,$(BUILD)/bin/inspect)

boundary-layers: $(boundary_folder)/picture.svg
ifdef really
	@echo 'picture: $(boundary_folder)/picture.svg'
endif
endif
