# SPDX-License-Identifier: GPL-3.0-or-later
# Liquid that stays around the contacts of random packings, and how strongly it holds them:
#
#     make rings     ->  build/runs/rings/table.md, build/runs/rings/rings.svg

RINGS_SEEDS ?= 5# packings

.PHONY: rings
rings: all ## liquid that stays around contacts, and its pull, over suction (1.5 minutes of one core)
	@mkdir -p $(RUNS)/rings
	@pipelines/studies/rings/report $(RINGS_SEEDS) $(RUNS)/rings
	@gnuplot -e 'tables="$(RUNS)/rings"' pipelines/lib/style.gp pipelines/studies/rings/report.gp >$(RUNS)/rings/rings.svg
	@cat $(RUNS)/rings/table.md
