# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures of pore networks:
#
#     make networks    ->  build/runs/networks/merging.svg   [K Figs. 3.23-3.25, 3.49]
#                          build/runs/networks/regular.svg   [K Fig. 2.3]

networks_folder := $(RUNS)/networks
merging_scene := samples/random-1000.json
merging_shares := 0 0.06 0.13 0.28
regular_names := 2d-3 2d-4 2d-6 3d-4 3d-6 3d-8

networks: ## pictures of pore networks, merged ever more, and regular ones

ifneq ($(call asked,networks,$(networks_folder)),)
$(call pack,$(networks_folder)/packing.h5,$(merging_scene),,)
$(call tessellate,$(networks_folder)/tessellation.h5,$(merging_scene),,$(networks_folder)/packing.h5)
$(foreach s,$(merging_shares),$(call merge-nodes,$(networks_folder)/merged-$s.h5,$(merging_scene),threshold=$s,$(networks_folder)/tessellation.h5))
$(foreach n,$(regular_names),$(call crack_network,$(networks_folder)/regular-$n,samples/regular-$n.json))
$(call report,$(networks_folder)/merging.svg,figures/network,$(merging_shares:%=$(networks_folder)/merged-%.h5))
$(call report,$(networks_folder)/regular.svg,figures/network,$(regular_names:%=$(networks_folder)/regular-%/network.h5))

$(call study,networks,$(networks_folder)/merging.svg $(networks_folder)/regular.svg)
endif
