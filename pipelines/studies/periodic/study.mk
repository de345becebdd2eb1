# SPDX-License-Identifier: GPL-3.0-or-later
# The stiff aggregate in a box that repeats sideways [K 5.9, Table 5.3, Fig. 5.24], in both
# drying limits:
#
#     make periodic                                ->  build/runs/periodic/periodic.svg, periodic.md
#     make periodic PERIODIC_SEEDS="1 2 3" PERIODIC_SCALES=0.25

PERIODIC_SEEDS ?= $(shell seq 10)
PERIODIC_SCALES ?= 0.25 9.6# of the physical force: fitted to K's total in each of the two limits

periodic_scene := samples/periodic-5x5x10.json
periodic_folder := $(RUNS)/periodic
periodic_limits := inviscid immobile

# Seed $1 dries in limit $2; its forces are replayed at every scale.
define periodic_history
$(call dry,$(periodic_folder)/$2/$1/drying.h5,$(periodic_scene),liquid=$2 throat_radius.seed=$1,$(periodic_folder)/network.h5)
$(foreach f,$(PERIODIC_SCALES),$(call force-protocol,$(periodic_folder)/$2/$1/forces-$f.h5,$(periodic_scene),force_scale=$f,$(periodic_folder)/$2/$1/drying.h5)\
$(call dem-replay,$(periodic_folder)/$2/$1/response-$f.h5,$(periodic_scene),,$(periodic_folder)/$2/$1/forces-$f.h5))
endef

# Counts of all seeds in limit $1 at scale $2.
periodic_counts = $(call crackstats,$(periodic_folder)/$1-$2.json,$(periodic_scene),,$(foreach \
	seed,$(PERIODIC_SEEDS),$(periodic_folder)/$1/$(seed)/response-$2.h5 $(periodic_folder)/$1/$(seed)/drying.h5))

periodic: ## cracks in a box that repeats sideways, K's Table 5.3 and Fig. 5.24 (about two minutes)

ifneq ($(call asked,periodic,$(periodic_folder)),)
$(call must,PERIODIC_SEEDS,$(whole),whole numbers)
$(call must,PERIODIC_SCALES,$(number),numbers)
$(call crack_network,$(periodic_folder),$(periodic_scene))
$(foreach limit,$(periodic_limits),$(foreach seed,$(PERIODIC_SEEDS),$(call periodic_history,$(seed),$(limit))))
$(foreach limit,$(periodic_limits),$(foreach f,$(PERIODIC_SCALES),$(call periodic_counts,$(limit),$f)))

# "limit-scale": the counts, and the response of the first seed.
periodic_arms := $(foreach f,$(PERIODIC_SCALES),$(periodic_limits:%=%-$f))
periodic_tables := $(periodic_arms:%=$(periodic_folder)/%.json)
periodic_drawn := $(foreach f,$(PERIODIC_SCALES),$(periodic_limits:%=$(periodic_folder)/%/$(firstword $(PERIODIC_SEEDS))/response-$f.h5))
inviscid_published := 5,91
immobile_published := 5,82
periodic_rows := $(foreach f,$(PERIODIC_SCALES),$(foreach l,$(periodic_limits),'$l, force × $f=$(periodic_folder)/$l-$f.json=$($l_published)'))
periodic_titles := $(foreach f,$(PERIODIC_SCALES),$(foreach l,$(periodic_limits),'$l, force × $f=$(periodic_folder)/$l/$(firstword $(PERIODIC_SEEDS))/response-$f.h5'))
$(call report,$(periodic_folder)/periodic.md,studies/periodic/table,$(periodic_tables),$(periodic_rows))
$(call report,$(periodic_folder)/periodic.svg,figures/crack-patterns,$(periodic_drawn),$(periodic_titles))

$(call study,periodic,$(periodic_folder)/periodic.md $(periodic_folder)/periodic.svg)
endif
