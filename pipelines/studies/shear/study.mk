# SPDX-License-Identifier: GPL-3.0-or-later
# Dry and wet beads in a split-bottom ring shear cell [G 4]: each packing dry, and with each bridge
# volume by each model:
#
#     make shear                      ->  build/runs/shear/shear.md and pictures (an hour of one core)
#     make shear SHEAR_SEEDS="1 2 3"  ->  the same for three packings, with intervals
#     make shear SHEAR_MODELS=table   ->  with the exact bridge alone
#     make shear SHEAR_SCENE=samples/split-bottom-full.json   ->  the cell of [G], 193,000 beads (7 hours of one core)
#
# and the dry band over the depth of the filling, three packings each, against Fenistein et al. and
# Unger et al.:
#
#     make shear-depth                ->  build/runs/shear-depth/shear-depth.md, shear-depth.svg (half an hour of one core)

SHEAR_SCENE ?= samples/split-bottom.json
SHEAR_SEEDS ?= 1# packings
SHEAR_MODELS ?= table weigert willett-full willett-reduced rabinovich-lambert
SHEAR_VOLUMES ?= 13.6e-12 74.2e-12# m3, of each bridge
# Radius of the split in m, for the curve of Unger et al.; none if the scene has no outer-floor.
SHEAR_SPLIT = $(shell jq '.simulate.groups["outer-floor"].ring.inner // empty' $(SHEAR_SCENE))

shear_folder := $(RUNS)/shear

# In folder $1 the packing of draw $2, with settings $3 of pack: loose; settled, when beads have fallen
# between the smooth walls before any are glued; sheared dry.
define shear_dry
$(call pack,$1/loose.h5,$(SHEAR_SCENE),seed=$2 $3)
$(call simulate,$1/packing.h5,$(SHEAR_SCENE),duration=0.4 local_damping=0.2 groups={} write=packing,$1/loose.h5)
$(call simulate,$1/dry.h5,$(SHEAR_SCENE),bridges.volume=0,$1/packing.h5)
endef
# Packing $1, dry and wet.
define shear_packing
$(call shear_dry,$(shear_folder)/$1,$1)
$(foreach v,$(SHEAR_VOLUMES),$(foreach m,$(SHEAR_MODELS),$(call shear_wet,$1,$v,$m)))
endef
# Packing $1 with bridges of volume $2 by model $3.
shear_wet = $(call simulate,$(shear_folder)/$1/$3-$2.h5,$(SHEAR_SCENE),bridges.volume=$2 bridges.model=$3,$(shear_folder)/$1/packing.h5)
# The runs, by name, of all packings.
shear_arms = dry $(foreach v,$(SHEAR_VOLUMES),$(foreach m,$(SHEAR_MODELS),$m-$v))

# The statistics of arm $1 over all packings.
shear_statistics = $(call shearstats,$(shear_folder)/$1.h5,$(SHEAR_SCENE),,$(foreach seed,$(SHEAR_SEEDS),$(shear_folder)/$(seed)/$1.h5))
# A picture of kind $1 of the arms $2.
shear_picture = $(call artifact,$(shear_folder)/$1.svg,stage=studies/shear version=1,$(shear_programs) $(2:%=$(shear_folder)/%.h5),pipelines/studies/shear/figure $1 $(foreach arm,$2,$(arm)=$(shear_folder)/$(arm).h5) $(if $(filter bands,$1),$(SHEAR_SPLIT:%=unger=%)) $(shear_folder)/$1.svg)

shear: ## wet shear flow in a split-bottom cell, by five models of bridges (an hour of one core)

ifneq ($(call asked,shear,$(shear_folder)),)
$(foreach seed,$(SHEAR_SEEDS),$(call shear_packing,$(seed)))
shear_names := $(call shear_arms)
shear_programs := $(addprefix pipelines/studies/shear/,figure figure.gp table shear.py) $(pipeline_library)
$(foreach arm,$(shear_names),$(call shear_statistics,$(arm)))
# With the exact bridge; the models beside each other are in the table.
shear_drawn := $(filter dry table-%,$(shear_names))
shear_pictures := bands profiles rheology torque separations
$(foreach kind,$(shear_pictures),$(call shear_picture,$(kind),$(if $(filter torque,$(kind)),$(shear_names),$(shear_drawn))))
$(call artifact,$(shear_folder)/shear.md,stage=studies/shear version=1,$(shear_programs) $(shear_names:%=$(shear_folder)/%.h5),pipelines/studies/shear/table $(foreach arm,$(shear_names),$(arm)=$(shear_folder)/$(arm).h5) $(SHEAR_SPLIT:%=unger=%) $(shear_folder)/shear.md)
$(call study,shear,$(shear_folder)/shear.md $(shear_pictures:%=$(shear_folder)/%.svg))
endif

# ---- over the depth -----------------------------------------------------------------------------

SHEAR_BEADS ?= 9500 12500 16500 21000 27000# in the cell, from shallow to deep
SHEAR_DRAWS ?= 1 2 3# packings of each

shear_depth := $(RUNS)/shear-depth
# A loose packing that has room for the deepest.
shear_tall := domain.height=0.12 domain.centre=[0,0,0.06]

shear-depth: ## dry shear bands over the depth of a split-bottom cell (half an hour of one core)

ifneq ($(call asked,shear-depth,$(shear_depth)),)
$(foreach n,$(SHEAR_BEADS),$(foreach s,$(SHEAR_DRAWS),$(call shear_dry,$(shear_depth)/$n/$s,$s,count=$n $(shear_tall))))
shear_depths := $(SHEAR_BEADS:%=$(shear_depth)/%.h5)
$(foreach n,$(SHEAR_BEADS),$(call shearstats,$(shear_depth)/$n.h5,$(SHEAR_SCENE),,$(SHEAR_DRAWS:%=$(shear_depth)/$n/%/dry.h5)))
shear_depth_programs := $(addprefix pipelines/studies/shear/,depth depth.gp shear.py) pipelines/study/samples.py $(pipeline_library)
$(foreach kind,md svg,$(call artifact,$(shear_depth)/shear-depth.$(kind),stage=studies/shear version=1,$(shear_depth_programs) $(shear_depths),pipelines/studies/shear/depth $(SHEAR_SPLIT) $(shear_depths) $(shear_depth)/shear-depth.$(kind)))
$(call study,shear-depth,$(shear_depth)/shear-depth.md $(shear_depth)/shear-depth.svg)
endif
