# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures of pore networks:
#
#     make networks    ->  build/runs/networks/merging.svg   [K Figs. 3.23-3.25, 3.49]
#                          build/runs/networks/regular.svg   [K Fig. 2.3]

pipeline_goals += networks
networks_folder := $(RUNS)/networks
merging_scene := samples/random-1000.json
merging_shares := 0 0.06 0.13 0.28
regular_names := 2d-3 2d-4 2d-6 3d-4 3d-6 3d-8

# Picture $1 of the networks $2, side by side.
network_picture = $(call artifact,$1,stage=network-figure version=1,$(wildcard \
	pipelines/network-figure*) $2,pipelines/network-figure $2 $1,$(BUILD)/bin/inspect)

.PHONY: networks
networks: ## pictures of pore networks, merged ever more, and regular ones

ifneq ($(filter networks $(networks_folder)/%,$(MAKECMDGOALS)),)
$(call step,$(networks_folder)/packing.h5,pack,$(PACK),$(merging_scene),,)
$(call step,$(networks_folder)/tessellation.h5,tessellate,$(TESSELLATE),$(merging_scene),,$(networks_folder)/packing.h5)
$(foreach s,$(merging_shares),$(call step,$(networks_folder)/merged-$s.h5,merge-nodes,$(MERGE_NODES),$(merging_scene),threshold=$s,$(networks_folder)/tessellation.h5))
$(foreach n,$(regular_names),$(call crack_network,$(networks_folder)/regular-$n,samples/regular-$n.json))
$(call network_picture,$(networks_folder)/merging.svg,$(merging_shares:%=$(networks_folder)/merged-%.h5))
$(call network_picture,$(networks_folder)/regular.svg,$(regular_names:%=$(networks_folder)/regular-%/network.h5))

networks: $(networks_folder)/merging.svg $(networks_folder)/regular.svg
ifdef really
	@echo 'pictures: $(networks_folder)/merging.svg $(networks_folder)/regular.svg'
endif
endif
