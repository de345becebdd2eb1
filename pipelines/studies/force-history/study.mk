# SPDX-License-Identifier: GPL-3.0-or-later
# The normal force of one contact over the drying, in both limits [K Fig. 5.12]:
#
#     make force-history    ->  build/runs/force-history/force-history.svg

force_history_scene := samples/stiff-5x5x10.json
force_history_folder := $(RUNS)/force-history
force_history_limits := inviscid immobile
force_history_snapshots := snapshots=[1$(shell seq -s '' -f ',%.2f' 0.98 -0.02 0.02),0]

force-history: ## the force of one contact over the drying, K's Fig. 5.12

ifneq ($(call asked,force-history,$(force_history_folder)),)
$(call crack_network,$(force_history_folder),$(force_history_scene))
define force_history_limit
$(call dry,$(force_history_folder)/$1/drying.h5,$(force_history_scene),liquid=$1,$(force_history_folder)/network.h5)
$(call force-protocol,$(force_history_folder)/$1/forces.h5,$(force_history_scene),,$(force_history_folder)/$1/drying.h5)
$(call dem-replay,$(force_history_folder)/$1/response.h5,$(force_history_scene),$(force_history_snapshots),$(force_history_folder)/$1/forces.h5)
endef
$(foreach limit,$(force_history_limits),$(call force_history_limit,$(limit)))
force_history_responses := $(force_history_limits:%=$(force_history_folder)/%/response.h5)
$(call report,$(force_history_folder)/force-history.svg,studies/force-history/figure,$(force_history_responses))

$(call study,force-history,$(force_history_folder)/force-history.svg)
endif
