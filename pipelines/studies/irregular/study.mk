# SPDX-License-Identifier: GPL-3.0-or-later
# Cracks in irregular aggregates of 1000 grains, each with its own pore network: slow and fast
# drying, and viscous liquid with and without its pressure gradient, which K 5.7 leaves out:
#
#     make irregular                  ->  build/runs/irregular/irregular.md, irregular.svg
#     make irregular AGGREGATES=20

AGGREGATES ?= 6# packings, each in all arms
IRREGULAR_VISCOSITY ?= 1e-4# m2/s, of viscous liquid; water: 1e-6

irregular_scene := samples/irregular-1000.json
irregular_folder := $(RUNS)/irregular

# An arm: how the liquid flows, and its suction.
irregular_arms := inviscid-uniform immobile-uniform viscous-uniform viscous-field
irregular_liquid = $(firstword $(subst -, ,$1))
irregular_pressure = $(lastword $(subst -, ,$1))

# Packing $1 in arm $2.
define irregular_run
$(call force-protocol,$(irregular_folder)/$1/$2-forces.h5,$(irregular_scene),pressure=$(call irregular_pressure,$2),$(irregular_folder)/$1/$(call irregular_liquid,$2).h5)
$(call dem-replay,$(irregular_folder)/$1/$2.h5,$(irregular_scene),,$(irregular_folder)/$1/$2-forces.h5)
endef

# Packing $1, its network, and how it dries with each of the three liquids.
define irregular_aggregate
$(call crack_network,$(irregular_folder)/$1,$(irregular_scene),seed=$1)
$(foreach l,inviscid immobile viscous,$(call dry,$(irregular_folder)/$1/$l.h5,$(irregular_scene),liquid=$l viscosity=$(IRREGULAR_VISCOSITY),$(irregular_folder)/$1/network.h5))
$(foreach arm,$(irregular_arms),$(call irregular_run,$1,$(arm)))
endef

irregular: ## cracks in irregular aggregates of 1000 grains, pressure gradients on and off (minutes)

ifneq ($(call asked,irregular,$(irregular_folder)),)
$(call must,AGGREGATES,$(whole),a whole number)
$(call must,IRREGULAR_VISCOSITY,$(number),a number)
irregular_seeds := $(shell seq $(AGGREGATES))
$(foreach seed,$(irregular_seeds),$(call irregular_aggregate,$(seed)))
irregular_tables := $(irregular_arms:%=$(irregular_folder)/%.json)
# The aggregates in arm $1, each with its drying.
irregular_runs = $(foreach seed,$(irregular_seeds),$(irregular_folder)/$(seed)/$1.h5 $(irregular_folder)/$(seed)/$(call irregular_liquid,$1).h5)
$(foreach arm,$(irregular_arms),$(call crackstats,$(irregular_folder)/$(arm).json,$(irregular_scene),,$(call irregular_runs,$(arm))))
# Whether slow and fast drying differ, and whether the gradient does anything: aggregate by
# aggregate.
irregular_test = $(call crackstats,$(irregular_folder)/$1,$(irregular_scene),first_group=$(AGGREGATES) paired=true,$(foreach arm,$2,$(call irregular_runs,$(arm))))
$(call irregular_test,limits.json,inviscid-uniform immobile-uniform)
$(call irregular_test,gradient.json,viscous-uniform viscous-field)
irregular_tests := $(irregular_folder)/limits.json $(irregular_folder)/gradient.json
$(call report,$(irregular_folder)/irregular.md,studies/irregular/table,$(irregular_tables) $(irregular_tests),$(irregular_folder))
$(call report,$(irregular_folder)/irregular.svg,figures/cracks,$(irregular_tables),$(foreach arm,$(irregular_arms),$(arm)=$(irregular_folder)/$(arm).json))

$(call study,irregular,$(irregular_folder)/irregular.md $(irregular_folder)/irregular.svg)
endif
