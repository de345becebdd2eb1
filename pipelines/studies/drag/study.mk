# SPDX-License-Identifier: GPL-3.0-or-later
# Flow through a few spheres, lattices and random packings [C 3]:
#
#     make drag      ->  build/runs/drag/table.md, build/runs/drag/drag.svg

.PHONY: drag
drag: all ## flow through few spheres, lattices and random packings next to [C] and Stokes
	@mkdir -p $(RUNS)/drag
	@pipelines/studies/drag/report tests/physics/flow/reference $(RUNS)/drag
	@gnuplot -e 'tables="$(RUNS)/drag"' pipelines/lib/style.gp pipelines/studies/drag/report.gp >$(RUNS)/drag/drag.svg
	@cat $(RUNS)/drag/table.md
