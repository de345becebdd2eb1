# SPDX-License-Identifier: GPL-3.0-or-later
# The networks of K 3.5 and 3.7 between grains that settled, by what he says of them, and
# merged as his Figs. 3.23-3.25:
#
#     make networks-k    ->  build/runs/networks-k/table.md, layer.svg, grains.svg

k_folder := $(RUNS)/networks-k
k_shares := 0.06 0.13 0.28
k_frictions := 0 0.5

# How many grains settle so that as many keep a cell as K has: of dimensions-cells-bounding,
# without friction and with friction 0.5. Cells are cut by the box, left out where the box cuts
# them, or left out where they are unbounded ("open": the walls stand 1000 boxes away).
k_counts/2-267-truncate := 267 267
k_counts/2-4161-eliminate := 4387 4370
k_counts/2-4161-open := 4265 4211
k_counts/3-223-eliminate := 470 466
k_counts/3-223-open := 322 301
k_counts/3-1220-eliminate := 1912 1890
k_counts/3-1220-open := 1413 1397
k_names := 2-267-truncate 2-4161-eliminate 2-4161-open 3-223-eliminate 3-223-open 3-1220-eliminate 3-1220-open
k_networks := $(foreach f,$(k_frictions),$(k_names:%=%-$f))

# Network $1, of $2 grains with friction $3, from scene $4: in folder $5.
define k_network
$(call pack,$5/packing.h5,$4,count=$2 dynamics.friction=$3,)
$(if $(findstring open,$1),$(call artifact,$5/open.h5,stage=networks-k version=1,pipelines/studies/networks-k/open pipelines/lib/common.py $5/packing.h5,pipelines/studies/networks-k/open $5/packing.h5 $5/open.h5,$(BUILD)/bin/pack))
$(call tessellate,$5/network.h5,$4,boundary=$(if $(findstring truncate,$1),truncate,eliminate),$5/$(if $(findstring open,$1),open,packing).h5)
$(foreach s,$(k_shares),$(call merge-nodes,$5/merged-$s.h5,$4,threshold=$s,$5/network.h5))
endef
k_files = $(k_folder)/$1/network.h5 $(k_shares:%=$(k_folder)/$1/merged-%.h5)

networks-k: ## the networks of K 3.5 and 3.7: counts, merging, distributions (about two minutes)

ifneq ($(call asked,networks-k,$(k_folder)),)
$(foreach n,$(k_names),$(call k_network,$n,$(word 1,$(k_counts/$n)),0,samples/networks-k-$(firstword $(subst -, ,$n))d.json,$(k_folder)/$n-0))
$(foreach n,$(k_names),$(call k_network,$n,$(word 2,$(k_counts/$n)),0.5,samples/networks-k-$(firstword $(subst -, ,$n))d.json,$(k_folder)/$n-0.5))
$(call report,$(k_folder)/table.md,studies/networks-k/table,$(foreach n,$(k_networks),$(call k_files,$n)),$(k_folder))
$(call report,$(k_folder)/layer.svg,figures/network,$(call k_files,2-267-truncate-0))
$(call report,$(k_folder)/grains.svg,figures/network,$(wordlist 1,2,$(call k_files,3-1220-eliminate-0.5)))

$(call study,networks-k,$(addprefix $(k_folder)/,table.md layer.svg grains.svg))
endif
