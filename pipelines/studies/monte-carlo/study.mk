# SPDX-License-Identifier: GPL-3.0-or-later
# Monte Carlo over throat radii in both drying limits [K 5.7, 5.8, Figs. 5.18, 5.19, 5.20]:
#
#     make monte-carlo                      ->  build/runs/monte-carlo/stiff-10x10x20/explicit/
#     make monte-carlo REALISATIONS=1000 ENGINE=quasi-static
#     make monte-carlo REALISATIONS=1000 DRYING_INTERVAL=0.001
#     make monte-carlo MONTE_CARLO_SCENE=samples/stiff-5x5x10.json
#
# More realisations keep those that are there: some 11 MB each, nearly all of it the drying with
# a step at each event. Recorded at each fall of the saturation by 0.001 they are 3 MB each.

REALISATIONS ?= 10# in each limit; K: 10
ENGINE ?= explicit
DRYING_INTERVAL ?=# of saturation, between recorded steps of the drying; none: each event
MONTE_CARLO_SCENE ?= samples/stiff-10x10x20.json

monte_carlo_top := $(RUNS)/monte-carlo/$(basename $(notdir $(MONTE_CARLO_SCENE)))$(DRYING_INTERVAL:%=-%)
monte_carlo_folder := $(monte_carlo_top)/$(ENGINE)
monte_carlo_limits := inviscid immobile

# Response $1 to the drying $2 of scene $3.
realisation = $(call artifact,$1,stage=realisation version=$(call version_of,force-protocol).$(call \
	version_of,dem-replay) set=$(ENGINE),pipelines/studies/monte-carlo/realisation $3 $2,$(RUN) pipelines/studies/monte-carlo/realisation \
	'$(FORCE_PROTOCOL)' '$(DEM_REPLAY)' $3 $(ENGINE) $2 $1,$(FORCE_PROTOCOL) $(DEM_REPLAY))

# Realisation $1 in limit $2.
define monte_carlo_run
$(call dry,$(monte_carlo_top)/drying/$2-$1.h5,$(MONTE_CARLO_SCENE),liquid=$2 throat_radius.seed=$1 $(DRYING_INTERVAL:%=step_interval=%),$(monte_carlo_top)/network.h5)
$(call realisation,$(monte_carlo_folder)/$2-$1.h5,$(monte_carlo_top)/drying/$2-$1.h5,$(MONTE_CARLO_SCENE))
endef

monte-carlo: ## cracks over 10 realisations in both drying limits, tested against each other (minutes)

ifneq ($(call asked,monte-carlo,$(monte_carlo_folder)),)
$(call must,REALISATIONS,$(whole),a whole number)
$(call must,ENGINE,explicit|quasi-static,explicit or quasi-static)
$(if $(DRYING_INTERVAL),$(call must,DRYING_INTERVAL,0?\.[0-9]+|[0-9](\.[0-9]+)?[eE]-[0-9]+|[01],a number from 0 to 1))
$(call crack_network,$(monte_carlo_top),$(MONTE_CARLO_SCENE))
monte_carlo_seeds := $(shell seq $(REALISATIONS))
$(foreach limit,$(monte_carlo_limits),$(foreach seed,$(monte_carlo_seeds),$(call monte_carlo_run,$(seed),$(limit))))
# The realisations of limit $1, each with its drying.
monte_carlo_runs = $(foreach seed,$(monte_carlo_seeds),$(monte_carlo_folder)/$1-$(seed).h5 $(monte_carlo_top)/drying/$1-$(seed).h5)
$(foreach limit,$(monte_carlo_limits),$(call crackstats,$(monte_carlo_folder)/$(limit).json,$(MONTE_CARLO_SCENE),,$(call monte_carlo_runs,$(limit))))
$(call crackstats,$(monte_carlo_folder)/test.json,$(MONTE_CARLO_SCENE),first_group=$(REALISATIONS),$(foreach \
	limit,$(monte_carlo_limits),$(call monte_carlo_runs,$(limit))))
monte_carlo_counts := $(monte_carlo_limits:%=$(monte_carlo_folder)/%.json) $(monte_carlo_folder)/test.json
$(call report,$(monte_carlo_folder)/table.md,studies/monte-carlo/table,$(monte_carlo_counts))
$(call report,$(monte_carlo_folder)/counts.svg,studies/monte-carlo/figure,$(monte_carlo_counts))
$(call report,$(monte_carlo_folder)/patterns.svg,figures/crack-patterns,$(monte_carlo_limits:%=$(monte_carlo_folder)/%-1.h5),$(foreach limit,$(monte_carlo_limits),$(limit)=$(monte_carlo_folder)/$(limit)-1.h5))

$(call study,monte-carlo,$(addprefix $(monte_carlo_folder)/,table.md counts.svg patterns.svg))
endif
