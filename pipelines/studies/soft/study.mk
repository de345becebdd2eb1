# SPDX-License-Identifier: GPL-3.0-or-later
# Shrinkage and spring-back of the soft aggregate [K 5.10, Table 5.4, Fig. 5.26], also under
# weaker forces:
#
#     make soft                       ->  build/runs/soft/soft.svg, soft.md
#     make soft SOFT_SCALES="0.1 1"
#     make soft SOFT_SET='engine="quasi-static" quasi_static.large_displacements=true'

SOFT_SCALES ?= 0.01 0.03 0.1 0.3 1# of the physical force; the last one is drawn
SOFT_SET ?=# more parameters of dem-replay

soft_scene := samples/soft-10x5x5.json
soft_folder := $(RUNS)/soft

# The aggregate under $1 times the force; its strength is twice the force too.
define soft_arm
$(call force-protocol,$(soft_folder)/$1/forces.h5,$(soft_scene),force_scale=$1,$(soft_folder)/drying.h5)
$(call dem-replay,$(soft_folder)/$1/response.h5,$(soft_scene),bond.contact_strength=$(shell awk 'BEGIN { print 5.3e-7 * $1 }') $(SOFT_SET),$(soft_folder)/$1/forces.h5)
$(call crackstats,$(soft_folder)/$1/crackstats.json,$(soft_scene),,$(soft_folder)/$1/response.h5 $(soft_folder)/drying.h5)
endef

soft: ## shrinkage and spring-back of the soft aggregate, and their picture

ifneq ($(call asked,soft,$(soft_folder)),)
$(call must,SOFT_SCALES,$(number),numbers)
$(call crack_network,$(soft_folder),$(soft_scene))
$(call dry,$(soft_folder)/drying.h5,$(soft_scene),,$(soft_folder)/network.h5)
$(foreach scale,$(SOFT_SCALES),$(call soft_arm,$(scale)))
soft_counts := $(SOFT_SCALES:%=$(soft_folder)/%/crackstats.json)
soft_drawn := $(soft_folder)/$(lastword $(SOFT_SCALES))/response.h5
$(call report,$(soft_folder)/soft.svg,studies/soft/figure,$(soft_drawn) $(soft_counts))
$(call report,$(soft_folder)/soft.md,studies/soft/table,$(soft_counts))

$(call study,soft,$(soft_folder)/soft.md $(soft_folder)/soft.svg)
endif
