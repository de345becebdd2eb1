# SPDX-License-Identifier: GPL-3.0-or-later
# What scatter of the strengths of bonds does to the cracks of the stiff aggregate: normal and
# Weibull strengths of one mean, over seeds that draw throat radii and strengths.
#
#     make weibull                          ->  build/runs/weibull/table.md, cracks.svg
#     make weibull WEIBULL_SEEDS="1 2 3"

WEIBULL_SEEDS ?= $(shell seq 10)

weibull_scene := samples/stiff-5x5x10.json
weibull_folder := $(RUNS)/weibull
# Standard deviation over mean, and the modulus of a Weibull distribution that has it.
scatters := 0.1 0.2 0.3 0.5
modulus/0.1 := 12.153
modulus/0.2 := 5.797
modulus/0.3 := 3.714
modulus/0.5 := 2.101
weibull_rows := inviscid-one-0 $(scatters:%=inviscid-normal-%) $(scatters:%=inviscid-weibull-%) \
	immobile-one-0 $(scatters:%=immobile-weibull-%)

# The parts of a row: liquid, distribution, scatter.
weibull_part = $(word $1,$(subst -, ,$2))
weibull_forces = $(weibull_folder)/forces/$(call weibull_part,1,$1)-$2.h5
weibull_response = $(weibull_folder)/$1/$2.h5
weibull_settings = bond.strength.distribution=$(call weibull_part,2,$1) bond.strength.seed=$2 \
	bond.strength.variation=$(call weibull_part,3,$1) $(foreach \
	m,$(modulus/$(call weibull_part,3,$1)),bond.strength.modulus=$m)

# The forces of seed $2 in liquid $1, replayed with the strengths of row $1.
define weibull_drying
$(call dry,$(weibull_folder)/drying/$1-$2.h5,$(weibull_scene),liquid=$1 throat_radius.seed=$2,$(weibull_folder)/network.h5)
$(call force-protocol,$(call weibull_forces,$1,$2),$(weibull_scene),,$(weibull_folder)/drying/$1-$2.h5)
endef
define weibull_row
$(foreach seed,$(WEIBULL_SEEDS),$(call dem-replay,$(call weibull_response,$1,$(seed)),$(weibull_scene),$(call weibull_settings,$1,$(seed)),$(call weibull_forces,$1,$(seed))))
$(call crackstats,$(weibull_folder)/$1.json,$(weibull_scene),,$(foreach seed,$(WEIBULL_SEEDS),$(call weibull_response,$1,$(seed))))
endef

weibull: ## cracks against the scatter of strengths, 10 seeds (about ten minutes of one core)

ifneq ($(call asked,weibull,$(weibull_folder)),)
$(call must,WEIBULL_SEEDS,$(whole),whole numbers)
$(call crack_network,$(weibull_folder),$(weibull_scene))
$(foreach liquid,inviscid immobile,$(foreach seed,$(WEIBULL_SEEDS),$(call weibull_drying,$(liquid),$(seed))))
$(foreach row,$(weibull_rows),$(call weibull_row,$(row)))
weibull_counts := $(weibull_rows:%=$(weibull_folder)/%.json)
$(call report,$(weibull_folder)/table.md,studies/weibull/report,$(weibull_counts),table $(weibull_counts))
$(call report,$(weibull_folder)/cracks.svg,studies/weibull/report,$(weibull_counts),figure $(weibull_counts))

$(call study,weibull,$(weibull_folder)/table.md $(weibull_folder)/cracks.svg)
endif
