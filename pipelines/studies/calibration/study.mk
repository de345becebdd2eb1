# SPDX-License-Identifier: GPL-3.0-or-later
# Bonds from a material's modulus, Poisson ratio and strength [K 4.3]:
#
#     make calibrate SCENE=mine.json YOUNG_MODULUS=1e9 POISSON_RATIO=0.1 TENSILE_STRENGTH=1e6
#                          ->  build/runs/mine/calibrated.json
#     make calibration     ->  build/runs/calibration/table.md: how far the results scatter

YOUNG_MODULUS ?=# Pa
POISSON_RATIO ?= none
TENSILE_STRENGTH ?=# Pa
AXES ?= xyz

.PHONY: calibrate calibration
calibrate: all ## bonds for a material's modulus and strength: make calibrate SCENE=mine.json YOUNG_MODULUS=1e9 TENSILE_STRENGTH=1e6
	@$(if $(and $(SCENE),$(YOUNG_MODULUS),$(TENSILE_STRENGTH)),,echo 'Which scene, what material? make calibrate SCENE=mine.json YOUNG_MODULUS=1e9 TENSILE_STRENGTH=1e6 [POISSON_RATIO=0.1] (Pa)' >&2; exit 64;) \
	mkdir -p $(RUNS)/$(basename $(notdir $(SCENE))) && AXES=$(call quoted,$(AXES)) pipelines/calibrate/calibrate $(SCENE) \
		$(RUNS)/$(basename $(notdir $(SCENE)))/calibrated.json $(call quoted,$(YOUNG_MODULUS)) $(call quoted,$(POISSON_RATIO)) \
		$(call quoted,$(TENSILE_STRENGTH)) $(IMPORT)

calibration: all ## calibrated packings tested again by time steps, and scatter over packings and sizes (minutes)
	@mkdir -p $(RUNS)/calibration
	@pipelines/studies/calibration/report 5 $(RUNS)/calibration
	@cat $(RUNS)/calibration/table.md
