# SPDX-License-Identifier: GPL-3.0-or-later
# At which strain do layers of different thickness crack, beside Griffith's criterion for a
# constrained film? At which does a slit in them grow? Each shrinks evenly:
#
#     make critical-thickness                     ->  build/runs/critical-thickness/table.md, strains.svg
#     make critical-thickness CRITICAL_SEEDS="1"  ->  the same of one packing
#
# Some with other bonds, and some that suction pulls together instead:
#
#     make critical-bonds                         ->  build/runs/critical-thickness/bonds.md, bonds.svg

CRITICAL_SEEDS ?= 1 2 3# of the packings

critical := $(RUNS)/critical-thickness
critical_scene := samples/craquelure-40.json
critical_thicknesses := 3 4 6 8 12
critical_bonds := 3 4 6# of layers with other bonds
critical_wet := 3 4 6 8# of layers under suction
critical_slit := 6 8 12# thinner ones crack elsewhere before the slit grows
# By thickness in mean diameters of 0.52 um: heights of the layer and of the packing it is cut from,
# and sides of the box, 5 and 4 thicknesses, in um.
critical/3 := 1.56 2.08 7.8 6.24
critical/4 := 2.08 2.6 10.4 8.32
critical/6 := 3.12 3.64 15.6 12.48
critical/8 := 4.16 4.68 20.8 16.64
critical/12 := 6.24 6.76 31.2 24.96

critical-thickness: ## at which strain layers crack, beside Griffith's criterion
critical-bonds: ## the same with other strengths, stiffnesses and adhesion, and under suction

ifneq ($(call asked,critical-thickness critical-bonds,$(critical)),)
critical_pack = slab.upper=$(word 1,$1)e-6 upper=[$(word 3,$1)e-6,$(word 4,$1)e-6,$(word 2,$1)e-6]
# Loading takes time in proportion to the thickness $1, as waves do. To the strain $2 in $3 steps.
critical_load = shrinkage.law=uniform shrinkage.strain=$2 shrinkage.steps=$3 snapshots=[0] \
	cycles=$(shell echo $$((16 * $1))) most_cycles=$(shell echo $$((64 * $1)))
# Of thickness $1 and seed $2, in folder $3.
define critical_layer
$(call pack,$3/packing.h5,$(critical_scene),seed=$2 $(call critical_pack,$(critical/$1)),)
$(call dem-replay,$3/response.h5,$(critical_scene),$(call critical_load,$1,$(critical_strain),40),$3/packing.h5)
endef
critical_import := method=import periodic=[true,true,false] upper=null slab.lower=null slab.upper=null
# The layer in folder $2, of thickness $1, with a slit: in folder $2-slit.
define critical_slit_layer
$(call report,$2-slit/grains.dump,studies/critical-thickness/slit,$2/packing.h5,$2/packing.h5 $1)
$(call pack,$2-slit/packing.h5,$(critical_scene),$(critical_import),$2-slit/grains.dump)
$(call dem-replay,$2-slit/response.h5,$(critical_scene),$(call critical_load,$1,0.0135,27),$2-slit/packing.h5)
endef
# Other bonds $3 by name, in the layer in folder $2, of thickness $1. To the strain at which they would break.
critical_strain := 0.02
critical_strain/strong := 0.04
critical_strain/stiff := 0.01
critical/strong := bond.normal_strength=4.6e6 bond.shear_strength=4.6e6
critical/stiff := bond.normal_stiffness=4.4e14 bond.shear_stiffness=1.76e14 normal_stiffness=40 shear_stiffness=20
critical/floor0.5 := bond.substrate_strength=0.5
critical/floor0.2 := bond.substrate_strength=0.2
critical_others := strong stiff floor0.5 floor0.2
critical_other = $(call dem-replay,$2-$3/response.h5,$(critical_scene),$(call \
	critical_load,$1,$(or $(critical_strain/$3),$(critical_strain)),40) $(critical/$3),$2/packing.h5)
# The layer in folder $1 under suction, and with weaker bonds.
critical_wet_scene := samples/craquelure-wet-40.json
define critical_wet_layers
$(call dem-replay,$1-suction/response.h5,$(critical_wet_scene),snapshots=[0.4],$1/packing.h5)
$(call dem-replay,$1-suction-weak/response.h5,$(critical_wet_scene),snapshots=[0.4] bond.normal_strength=1.2e6 \
	bond.shear_strength=1.2e6,$1/packing.h5)
endef
$(foreach h,$(critical_thicknesses),$(foreach s,$(CRITICAL_SEEDS),$(call critical_layer,$h,$s,$(critical)/$h-$s)))
$(foreach h,$(critical_bonds),$(foreach s,$(CRITICAL_SEEDS),$(foreach b,$(critical_others),$(call \
	critical_other,$h,$(critical)/$h-$s,$b))))
$(foreach h,$(critical_wet),$(foreach s,$(CRITICAL_SEEDS),$(call critical_wet_layers,$(critical)/$h-$s)))
$(foreach h,$(critical_slit),$(foreach s,$(CRITICAL_SEEDS),$(call critical_slit_layer,$h,$(critical)/$h-$s)))
critical_whole = $(foreach h,$1,$(CRITICAL_SEEDS:%=$(critical)/$h-%/response.h5))
critical_variant = $(foreach h,$1,$(CRITICAL_SEEDS:%=$(critical)/$h-%-$2/response.h5))
critical_responses := $(call critical_whole,$(critical_thicknesses)) $(call critical_variant,$(critical_slit),slit)
critical_bonds_responses := $(call critical_whole,$(sort $(critical_bonds) $(critical_wet))) \
	$(foreach b,$(critical_others),$(call critical_variant,$(critical_bonds),$b)) \
	$(foreach b,suction suction-weak,$(call critical_variant,$(critical_wet),$b))
$(call report,$(critical)/table.md,studies/critical-thickness/report,$(critical_responses),table $(critical_responses))
$(call report,$(critical)/strains.svg,studies/critical-thickness/report,$(critical_responses),figure $(critical_responses))
$(call report,$(critical)/bonds.md,studies/critical-thickness/bonds,$(critical_bonds_responses),table $(critical_bonds_responses))
$(call report,$(critical)/bonds.svg,studies/critical-thickness/bonds,$(critical_bonds_responses),figure $(critical_bonds_responses))

$(call study,critical-thickness,$(critical)/table.md $(critical)/strains.svg)
$(call study,critical-bonds,$(critical)/bonds.md $(critical)/bonds.svg)
endif
