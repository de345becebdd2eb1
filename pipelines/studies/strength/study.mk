# SPDX-License-Identifier: GPL-3.0-or-later
# K's Table 5.2 over many realisations: the stiff aggregate with four bond strengths in
# inviscid drying, and with one in immobile drying.
#
#     make strength                          ->  build/runs/strength/1.3333/table.md, cracks.svg,
#                                                patterns.svg [K Fig. 5.17]
#     make strength SEEDS="1 2 3" FORCE_SCALE=1

SEEDS ?= $(shell seq 20)
FORCE_SCALE ?= 1.3333# chosen once, for the totals of all strengths

strength_scene := samples/stiff-5x5x10.json
strength_folder := $(RUNS)/strength/$(FORCE_SCALE)
strengths := 0.4e4 0.8e4 1.6e4 2e4

# Seed $1 dries in limit $2; its forces are replayed with each of the strengths $3.
define strength_history
$(call dry,$(strength_folder)/$2/$1/drying.h5,$(strength_scene),liquid=$2 throat_radius.seed=$1,$(strength_folder)/network.h5)
$(call force-protocol,$(strength_folder)/$2/$1/forces.h5,$(strength_scene),force_scale=$(FORCE_SCALE),$(strength_folder)/$2/$1/drying.h5)
$(foreach s,$3,$(call dem-replay,$(strength_folder)/$2/$1/response-$s.h5,$(strength_scene),bond.normal_strength=$s bond.shear_strength=$s,$(strength_folder)/$2/$1/forces.h5))
endef

strength_responses = $(foreach seed,$(SEEDS),$(strength_folder)/$1/$(seed)/response-$2.h5)
strength_counts = $(call crackstats,$(strength_folder)/$1-$2.json,$(strength_scene),,$(call strength_responses,$1,$2))

strength: ## K's Table 5.2 over 20 seeds (about three minutes)

ifneq ($(call asked,strength,$(strength_folder)),)
$(call must,SEEDS,$(whole),whole numbers)
$(call must,FORCE_SCALE,$(number),a number)
$(call crack_network,$(strength_folder),$(strength_scene))
$(foreach seed,$(SEEDS),$(call strength_history,$(seed),inviscid,$(strengths)))
$(foreach seed,$(SEEDS),$(call strength_history,$(seed),immobile,1.6e4))
$(foreach s,$(strengths),$(call strength_counts,inviscid,$s))
$(call strength_counts,immobile,1.6e4)
strength_tables := $(strengths:%=$(strength_folder)/inviscid-%.json) $(strength_folder)/immobile-1.6e4.json
$(call report,$(strength_folder)/table.md,studies/strength/table,$(strength_tables),$(strength_folder))

$(call report,$(strength_folder)/cracks.svg,studies/strength/figure,$(strength_folder)/table.md)

# Where bonds of each strength broke, in the first of the seeds.
strength_drawn := $(foreach s,$(strengths),$(strength_folder)/inviscid/$(firstword $(SEEDS))/response-$s.h5)
strength_titles := $(foreach s,$(strengths),'$s N/m²=$(strength_folder)/inviscid/$(firstword $(SEEDS))/response-$s.h5')
$(call report,$(strength_folder)/patterns.svg,figures/crack-patterns,$(strength_drawn),$(strength_titles))

$(call study,strength,$(addprefix $(strength_folder)/,table.md cracks.svg patterns.svg))
endif
