# SPDX-License-Identifier: GPL-3.0-or-later
# Studies as data: runs of a scene with other values, measured and compared (docs/studies.md).
#
#     make study STUDY=mine.json          ->  build/runs/mine/summary.md, runs.tsv, figure.svg, study.html
#     make study STUDY=runs.tsv SCENE=mine.json IMPORT=grains.txt
#     make study-table STUDY=mine.json    ->  tables of what is there, while another make is at it
#     make strength SEEDS="1 2 3"         ->  a study of pipelines/studies, with other seeds
#     make strength SET="force-protocol.force_scale=1 dem-replay.engine=quasi-static"

STUDY ?=
SEEDS ?=# in place of the study's own
SET ?=# STAGE.KEY=VALUE, for all runs
MOST_RUNS ?=

study_words = --runs=$(call quoted,$(RUNS)) $(if $(strip $(SEEDS)),--seeds=$(call quoted,$(strip $(SEEDS)))) $(foreach \
	s,$(SET),--set=$(call quoted,$s)) $(NAME:%=--name=$(call quoted,%)) $(MOST_RUNS:%=--most-runs=%) $(if $(strip $(SCENE)),--scene=$(SCENE)) \
	$(IMPORT:%=--import=%)
study_program = THREADS=$(call quoted,$(THREADS)) RUN=$(call quoted,$(RUN)) pipelines/study/study
known_studies := $(basename $(notdir $(wildcard pipelines/studies/*.json)))

.PHONY: study study-plan study-table $(known_studies)
study: ## runs of a scene with other values: make study STUDY=mine.json
study-plan: ## how many runs a study has, what they take, and what is missing
study-table: ## tables of a study's runs so far
study study-plan study-table: $(PROGRAMS) $(SAMPLES)
	@+[[ -n $(call quoted,$(STUDY)) ]] || { echo 'Which study? make $@ STUDY=mine.json' >&2; exit 64; }; \
		$(study_program) $(or $(patsubst study-%,%,$(filter study-%,$@)),make) $(call quoted,$(STUDY)) $(study_words)
$(known_studies): $(PROGRAMS) $(SAMPLES)
	@+$(study_program) make pipelines/studies/$@.json $(study_words)
# Those that come with us, for `make help`.
strength: ## K's Table 5.2 over 20 seeds (about three minutes)
weibull: ## cracks against the scatter of strengths, 10 seeds (about ten minutes of one core)
periodic: ## cracks in a box that repeats sideways, K's Table 5.3 and Fig. 5.24 (about two minutes)
irregular: ## cracks in irregular aggregates of 1000 grains, pressure gradients on and off (minutes)
monte-carlo: ## cracks over 10 realisations in both drying limits, tested against each other (minutes)
soft: ## shrinkage and spring-back of the soft aggregate, and their picture
force-history: ## the force of one contact over the drying, K's Fig. 5.12
fronts: ## pictures of drying fronts in inviscid, viscous and immobile liquid (a minute)
films: ## how long films keep a column of beads wet, with and without gravity (two minutes)
gradients: ## forces with liquid pressure gradients on and off, and their picture (seconds)
