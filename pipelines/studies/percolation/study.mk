# SPDX-License-Identifier: GPL-3.0-or-later
# Invasion percolation beside published thresholds and exponents:
#
#     make percolation  ->  build/runs/percolation/table.md, build/runs/percolation/percolation.svg
#
# SHARE=0.1 takes a tenth of the realisations.

SHARE ?= 1
percolation_study := $(BUILD)/tests/bench/percolation_study

ifneq ($(filter percolation,$(MAKECMDGOALS)),)
$(call must,SHARE,$(number),a number)
endif
.PHONY: percolation
percolation: $(percolation_study) ## thresholds and exponents of invasion percolation (minutes)
	@mkdir -p $(RUNS)/percolation
	@pipelines/studies/percolation/report $(percolation_study) $(RUNS)/percolation $(SHARE)
	@gnuplot -e 'tables="$(RUNS)/percolation"' pipelines/lib/style.gp pipelines/studies/percolation/report.gp \
		>$(RUNS)/percolation/percolation.svg
	@cat $(RUNS)/percolation/table.md
