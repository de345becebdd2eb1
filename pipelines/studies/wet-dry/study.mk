# SPDX-License-Identifier: GPL-3.0-or-later
# A layer that dries again and again: as it is wetted it swells back to where it was, and its cracks heal, but
# weaker than before. Do they come back, and do their junctions change?
#
#     make wet-dry                  ->  build/runs/wet-dry/table.md
#     make wet-dry WET_DRY_CYCLES=25 WET_DRY_SEEDS=1

WET_DRY_CYCLES ?= 6# of layers whose strengths are drawn anew; others repeat their cracks
WET_DRY_SEEDS ?= 1 2 3# of the packings

wet_dry := $(RUNS)/wet-dry
wet_dry_scene := samples/craquelure-40.json

wet-dry: ## cracks that heal and open again over wet and dry cycles (twenty minutes of one core)

ifneq ($(call asked,wet-dry,$(wet_dry)),)
$(call must,WET_DRY_CYCLES,[1-9][0-9]?,a whole number below 100)
wet_dry_seeds := $(call once_each,$(WET_DRY_SEEDS))
# The ways to heal: strength of what has healed over what it was; whether strengths are drawn anew as well.
wet_dry_ways := half redrawn
wet_dry_healed/half := 0.5
wet_dry_healed/redrawn := 0.9
wet_dry_draw/redrawn = bond.strength.seed=$1
wet_dry_cycles/half := 1 2 3
wet_dry_cycles/redrawn := $(shell seq $(WET_DRY_CYCLES))
# The drying $3 of the layer in folder $1, whose bonds heal in way $2: from the packing, or from what has healed.
define wet_dry_drying
$(if $(filter 1,$3),,$(call report,$1/$2-$3/packing.h5,studies/wet-dry/heal,$1/packing.h5 $(call wet_dry_last,$1,$2,$3),$1/packing.h5 $(call \
	wet_dry_last,$1,$2,$3) $(wet_dry_healed/$2)))
$(call dem-replay,$1/$2-$3/response.h5,$(wet_dry_scene),snapshots=[0] $(call wet_dry_draw/$2,$3) $(if $(filter \
	1,$3),,bond.by=packing),$(if $(filter 1,$3),$1/packing.h5,$1/$2-$3/packing.h5))
$(call crackstats,$1/$2-$3/crackstats.json,$(wet_dry_scene),polygons=true,$1/$2-$3/response.h5)
endef
wet_dry_last = $1/$2-$(shell echo $$(($3 - 1)))/response.h5
define wet_dry_layer
$(call pack,$1/packing.h5,$(wet_dry_scene),seed=$2,)
$(foreach way,$(wet_dry_ways),$(foreach cycle,$(wet_dry_cycles/$(way)),$(call wet_dry_drying,$1,$(way),$(cycle))))
endef
$(foreach s,$(wet_dry_seeds),$(call wet_dry_layer,$(wet_dry)/seed-$s,$s))
wet_dry_dryings := $(foreach way,$(wet_dry_ways),$(foreach c,$(wet_dry_cycles/$(way)),$(foreach s,$(wet_dry_seeds),$(wet_dry)/seed-$s/$(way)-$c)))
$(call report,$(wet_dry)/table.md,studies/wet-dry/table,$(wet_dry_dryings:%=%/response.h5) $(wet_dry_dryings:%=%/crackstats.json),$(wet_dry_dryings))

$(call study,wet-dry,$(wet_dry)/table.md)
endif
