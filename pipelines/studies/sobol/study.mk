# SPDX-License-Identifier: GPL-3.0-or-later
# What the number of cracks depends on: Sobol indices over five parameters of a small stiff aggregate.
#
#     make sobol     ->  build/runs/sobol/indices.md, indices.svg

SOBOL_COUNT ?= 64# 7 runs each
sobol_folder := $(RUNS)/sobol
sobol_ranges := dem-replay.bond.normal_strength=1e4,3e4 dem-replay.bond.shear_strength=1e4,3e4 \
	dem-replay.bond.radius_fraction=0.4,0.7 conditions.surface_tension=0.05,0.08 \
	dry.throat_radius.standard_deviation=1e-9,20e-9
sobol_scene := pack.counts=[4,4,6] force-protocol.steps=100
# Under `make -n` there is no table of runs yet, so what makes them is shown, not asked.
sobol_study = $(MAKE) --no-print-directory study STUDY=$(sobol_folder)/design.tsv NAME=sobol \
	SCENE=samples/stiff-5x5x10.json SET='$(sobol_scene)'

.PHONY: sobol
sobol: all ## what cracks depend on: Sobol indices over five parameters (80 s)
	@mkdir -p $(sobol_folder)
	@pipelines/studies/sobol/design $(SOBOL_COUNT) $(sobol_folder)/design.tsv $(sobol_ranges)
	$(if $(really),@+)$(sobol_study) >$(sobol_folder)/said 2>&1 || { tail -3 $(sobol_folder)/said >&2; exit 1; }
	@pipelines/studies/sobol/indices $(sobol_folder)/design.tsv $(sobol_folder)/runs.tsv cracks.total $(sobol_folder)
	@gnuplot -e 'table="$(sobol_folder)/indices.tsv"' pipelines/lib/style.gp pipelines/studies/sobol/indices.gp >$(sobol_folder)/indices.svg
	@cat $(sobol_folder)/indices.md
