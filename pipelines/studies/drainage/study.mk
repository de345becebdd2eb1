# SPDX-License-Identifier: GPL-3.0-or-later
# How much liquid stays in random packings that suction drains, in throats and in rings:
#
#     make drainage  ->  build/runs/drainage/table.md, build/runs/drainage/drainage.svg

DRAINAGE_SEEDS ?= 3# packings

.PHONY: drainage
drainage: all ## liquid that stays in throats and rings as suction drains random packings (a minute)
	@mkdir -p $(RUNS)/drainage
	@pipelines/studies/drainage/report $(DRAINAGE_SEEDS) $(RUNS)/drainage
	@gnuplot -e 'tables="$(RUNS)/drainage"' pipelines/lib/style.gp pipelines/studies/drainage/report.gp >$(RUNS)/drainage/drainage.svg
	@cat $(RUNS)/drainage/table.md
