# SPDX-License-Identifier: GPL-3.0-or-later
# The one entry point. `make help` lists what it can do.

mode := $(firstword -$(MAKEFLAGS))
really := $(if $(findstring n,$(mode))$(findstring q,$(mode)),,yes)# not -n, not -q
MAKEFLAGS += --no-builtin-rules --no-builtin-variables --warn-undefined-variables
SHELL := /bin/bash
.SHELLFLAGS := -o pipefail -euc
.DELETE_ON_ERROR:
.SUFFIXES:
.DEFAULT_GOAL := all
MAKECMDGOALS ?=

# What the machine is and how many cores it has, asked for once.
machine := $(shell echo $$HOSTTYPE; exec nproc)

# Every core, unless -j on the command line or the make above says otherwise.
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(lastword $(machine))
endif

# --- settings -------------------------------------------------------------------------
# Each may be set on the command line or in the environment.

V ?= 0# V=1 shows the commands
BUILD ?= build
PREFIX ?= /usr/local
DESTDIR ?=
RUNS ?= $(BUILD)/runs

# Of a folder in RUNS: only what stands on the command line. The environment may have a NAME of its
# own; in the Windows Subsystem for Linux it is that of the machine.
ifeq ($(origin NAME),environment)
NAME :=
endif
NAME ?=

# Names of files go to make's rules and its shell as they are: one that either would take apart or
# run is refused before it is used.
hash := \#
signs := ' " ` ; & < > | * ? [ ] { } ( ) ! $$ \ : = % $(hash)
unfit = $(strip $(word 2,$(value $1)) $(foreach sign,$(signs),$(findstring $(sign),$(value $1))))
set_by_user = $(filter command environment,$(origin $1))
check_name = $(if $(and $(set_by_user),$(unfit)),$(error $1=$(strip $(value $1)): make takes no blanks or signs \
	in names of files; a link by another name will do))
$(foreach name,BUILD RUNS NAME SCENE IMPORT MONTE_CARLO_SCENE,$(call check_name,$(name)))
$(foreach name,BUILD RUNS,$(if $(strip $(value $(name))),,$(error $(name)=: must be the name of a folder)))
$(if $(and $(call set_by_user,NAME),$(or $(findstring /,$(value NAME)),$(filter . ..,$(value NAME)))),$(error \
	NAME=$(value NAME): must be the name of a folder, without /; RUNS says where it lies))
# A word for the shell.
quoted = '$(subst ','\'',$1)'

default = $(if $(filter default undefined,$(origin $1)),$2,$($1))# make has its own CC
CC := $(call default,CC,gcc)
CXX := $(call default,CXX,g++)
AR := $(call default,AR,ar)
SANITIZE ?=# 1 builds with the address and undefined-behaviour sanitizers
ARCH ?= $(if $(filter x86_64,$(machine)),-march=x86-64-v3)
OPTIMISE ?= $(if $(SANITIZE),-O1 -fno-omit-frame-pointer,-O3)
EXTRA_CFLAGS ?=

, := ,
sanitizers := -fsanitize=address$(,)undefined -fno-sanitize-recover=undefined
# -ffp-contract=off: the same digits whether or not the machine fuses multiply and add.
both_languages = $(OPTIMISE) $(ARCH) -ffp-contract=off -fopenmp -g -Wall -Wextra -Wshadow \
	$(if $(SANITIZE),$(sanitizers)) -MMD -MP $(EXTRA_CFLAGS)
CFLAGS = -std=c17 -D_GNU_SOURCE $(both_languages) \
	-Wconversion -Wstrict-prototypes -Wmissing-prototypes
# CGAL's filtered predicates change the rounding mode: -frounding-math is not optional.
CXXFLAGS = -std=c++17 -frounding-math $(both_languages)
LDFLAGS = -fopenmp -Wl,--as-needed $(if $(SANITIZE),$(sanitizers))

# Asked for at the first use, not while parsing: `make deps all` starts without pkg-config.
once = $(eval $1 := $(shell $2))$($1)
HDF5_CPPFLAGS = $(call once,HDF5_CPPFLAGS,pkg-config --cflags hdf5-serial 2>/dev/null \
	|| pkg-config --cflags hdf5 2>/dev/null || echo -I/usr/include/hdf5/serial)
HDF5_LIBS = $(call once,HDF5_LIBS,pkg-config --libs-only-L hdf5-serial 2>/dev/null \
	|| pkg-config --libs-only-L hdf5 2>/dev/null \
	|| echo -L/usr/lib/$$($(CC) -print-multiarch)/hdf5/serial)
CPPFLAGS = -Istages/lib -Istages $(HDF5_CPPFLAGS) -I/usr/include/suitesparse
STATIC_LIBS = $(call once,STATIC_LIBS,tools/static-libraries '$(CC)' $(HDF5_LIBS))
SHARED_LIBS = $(HDF5_LIBS) -lhdf5_hl -lhdf5 -lcholmod -lsuitesparseconfig
LIBS = $(or $(STATIC_LIBS),$(SHARED_LIBS)) -lgsl -lgslcblas -ljansson -lcrypto -lstdc++ -lmpfr \
	-lgmp -lz -lm

PACKAGES := gcc g++ pkg-config libhdf5-dev libcgal-dev libsuitesparse-dev libgsl-dev \
	libjansson-dev libssl-dev zlib1g-dev libgmp-dev libmpfr-dev jq gnuplot-nox librsvg2-bin \
	libcmocka-dev perl python3-h5py python3-scipy python3-pil python3-vtk9 hdf5-tools voro++ qhull-bin \
	time chromium python3-websockets coop-computing-tools

# --- `make deps demo`: first things first ---------------------------------------------
# What is stale is decided while parsing, with jq and the compiler at hand. So when `deps` or
# `clean` comes with other goals, they wait for it and go to a make that starts after it.

first_goals := $(filter clean deps,$(MAKECMDGOALS))
other_goals := $(filter-out $(first_goals),$(MAKECMDGOALS))
ifneq ($(and $(first_goals),$(other_goals)),)

.PHONY: $(other_goals) others
$(other_goals): others ;
others: $(first_goals)
	@+$(MAKE) --no-print-directory $(foreach goal,$(other_goals),$(call quoted,$(goal)))

else

# --- sources and what becomes of them -------------------------------------------------

STAGES := $(filter-out lib,$(patsubst stages/%/main.c,%,$(wildcard stages/*/main.c)))
PROGRAMS := $(STAGES:%=$(BUILD)/bin/%)
export BIN := $(abspath $(BUILD)/bin)# where tests and pictures find the programs
LIBRARY := $(BUILD)/libcraquelure.a
CORES := $(BUILD)/libstages.a# all stages without their mains, for the tests

object = $(addprefix $(BUILD)/obj/,$(addsuffix .o,$(basename $1)))
# A stage and a library may have folders of its own, one deep.
library_sources := $(wildcard $(foreach d,* */*,$(addprefix stages/lib/$d/*.,c cpp S)))
library_objects := $(call object,$(library_sources))
stage_sources = $(wildcard stages/$1/*.c stages/$1/*.S stages/$1/*/*.c)
core_sources := $(filter-out %/main.c,$(foreach s,$(STAGES),$(call stage_sources,$s)))

# A test is a C program; test.c, its main program, and support_*.c beside it or one folder up are
# linked into each.
test_folders := $(patsubst tests/%/,%,$(sort $(dir $(wildcard tests/unit/*.c tests/physics/*.c tests/physics/*/*.c))))
tests_in = $(filter-out tests/$1/support_%,$(wildcard tests/$1/*.c))
support_for = $(call object,$(wildcard tests/$1/support_*.c $(dir tests/$1)support_*.c $(if $(filter bench%,$1),,tests/test.c)))
test_programs = $(patsubst tests/%.c,$(BUILD)/tests/%,$(call tests_in,$1))
C_TESTS := $(foreach d,$(test_folders),$(call test_programs,$d))
VOID := $(call test_programs,bench/void)
BENCHES := $(call test_programs,bench) $(VOID)
SCRIPT_TESTS := $(filter-out tests/hard/%,$(wildcard tests/*/*.t tests/*/*/*.t))

quiet = $(if $(filter 0yes,$(V)$(really)),@printf '  %-5s %s\n' '$1' '$2' && ,)

# The statistics of crackstats, for the programs of pipelines/.
samples_sources := $(wildcard $(addprefix stages/lib/,statistics/sample.c statistics/paired.c basics/memory.c basics/status.c))
SAMPLES := $(if $(samples_sources),$(BUILD)/lib/samples.so)

.PHONY: all
all: $(PROGRAMS) $(SAMPLES) ## build every program (the default)

# --- compile --------------------------------------------------------------------------

version_of = $(strip $(if $(wildcard stages/$1/version),$(file <stages/$1/version),1))
VERSION := $(file <VERSION)

# Two notes, rewritten only when they differ from what is on disk: other flags recompile
# everything, an added or removed source relinks. `strip`: make 4.3 may leave the newline that
# ends a file of more than 200 bytes.
flags := $(strip $(CC) $(CXX) $(CFLAGS) $(CXXFLAGS) $(LDFLAGS) $(VERSION))
sources := $(sort $(wildcard stages/*/main.c) $(core_sources) $(library_sources) \
	$(wildcard tests/*/support_*.c tests/*/*/support_*.c))
define note
$(BUILD)/$1: $(if $(findstring |$($1)|,|$(strip $(file <$(BUILD)/$1))|),,FORCE)
	@mkdir -p $$(@D) && printf '%s\n' '$($1)' >$$@
endef
$(foreach n,flags sources,$(eval $(call note,$n)))

$(BUILD)/obj/%.o: %.c $(BUILD)/flags
	$(call quiet,CC,$<)mkdir -p $(@D) && $(CC) $(CPPFLAGS) $(own_flags) $(CFLAGS) -c $< -o $@
$(BUILD)/obj/%.o: %.cpp $(BUILD)/flags
	$(call quiet,CXX,$<)mkdir -p $(@D) && $(CXX) $(CPPFLAGS) $(own_flags) $(CXXFLAGS) -c $< -o $@
$(BUILD)/obj/%.o: %.S $(BUILD)/flags
	$(call quiet,AS,$<)mkdir -p $(@D) && $(CC) -Wa,-I. $(CPPFLAGS) -MMD -MP -c $< -o $@

own_flags =
$(BUILD)/obj/stages/lib/%.o: own_flags = -DCRAQUELURE_VERSION='"$(VERSION)"'
$(call object,stages/lib/artifacts/schemas.S): $(wildcard schemas/*.json)
$(call object,stages/report/embedded.S): $(wildcard stages/report/page/*)

# A stage: its objects, with its version compiled in, and its program.
define stage_rules
$1_objects := $(call object,$(call stage_sources,$1))
$(BUILD)/obj/stages/$1/%.o: own_flags = \
	-DSTAGE_VERSION=$(call version_of,$1) -DCRAQUELURE_VERSION='"$(VERSION)"'
$$($1_objects): $(wildcard stages/$1/version)
$(BUILD)/bin/$1: $$($1_objects) $(LIBRARY) $(BUILD)/sources
	$$(call quiet,LINK,$1)mkdir -p $$(@D) \
	&& $(CC) $$(LDFLAGS) $$(filter %.o %.a,$$^) $$(LIBS) -o $$@
endef
$(foreach stage,$(STAGES),$(eval $(call stage_rules,$(stage))))

# Removed first: `ar` would keep members whose source is gone. `q`: two stages may use the
# same file name.
archive = $(call quiet,AR,$@)rm -f $@ && $(AR) qcsD $@ $(filter %.o,$^)
$(LIBRARY): $(library_objects) $(BUILD)/sources
	$(archive)
$(CORES): $(call object,$(core_sources)) $(BUILD)/sources
	$(archive)

$(SAMPLES): $(samples_sources) $(wildcard stages/lib/statistics/*.h) $(BUILD)/flags
	$(call quiet,LINK,$(@F))mkdir -p $(@D) && $(CC) $(CPPFLAGS) $(filter-out -MMD -MP,$(CFLAGS)) -fPIC -shared \
		$(filter %.c,$^) -lgsl -lgslcblas -lm -o $@

# A hundred programs with libraries inside: gold, where it is, links them in half the time.
fast_linker := $(if $(shell command -v ld.gold),-fuse-ld=gold)
define test_rules
$(call test_programs,$1): $(BUILD)/tests/$1/%: $(BUILD)/obj/tests/$1/%.o $(call support_for,$1) \
		$(CORES) $(LIBRARY) $(BUILD)/sources
	$$(call quiet,LINK,tests/$1/$$*)mkdir -p $$(@D) \
	&& $(CC) $$(LDFLAGS) $(fast_linker) $$(filter %.o %.a,$$^) $$(LIBS) -lcmocka -o $$@
endef
$(foreach d,$(test_folders) bench bench/void,$(eval $(call test_rules,$d)))

.SECONDARY:
include $(wildcard $(addsuffix /*.d,$(addprefix $(BUILD)/obj/,* */* */*/* */*/*/*)))

# --- pipelines: re-run by content -----------------------------------------------------
# tools/memo decides what is stale from what files hold, never from their times. It is
# asked while parsing, so that `make -n` and `make -q` tell the truth: an artifact is forced
# when it, or what it is made from, is stale, and every prerequisite is order-only. It is
# asked again in the recipe, when all inputs are there: if those came out as they were,
# nothing runs.
#
# pipelines/run has the product's own `run` and `demo`. A study is a folder of pipelines/studies;
# in its study.mk each `step` is an artifact that a stage makes (pipelines/run/run.mk has one for
# each stage), each `report` a table or picture that a program makes, and `study` the goal.

RUN ?=# a launcher for the stages: RUN='srun -n1'
THREADS ?=# of each stage

# Stops at once where a word of the variable $1, or no word, is not $2 (whole): it must be $3.
must = $(if $(shell printf '%s\n' $(foreach w,$($1),$(call quoted,$w)) | grep -qvxE '$2' && echo so),$(error $1 must be $3, got '$($1)'))
whole := [1-9][0-9]{0,6}
natural := 0|[1-9][0-9]{0,9}
number := ([0-9]+\.?|[0-9]*\.[0-9]+)([eE][-+]?[0-9]+)?
$(if $(THREADS),$(call must,THREADS,$(whole),a whole number))

artifacts :=
pipeline_goals := $(RUNS)/%

# $1 is made from the files $3 by command $4, in which program $5 runs. $2: what else its key
# holds, in the words of tools/memo.
artifact = $(if $(filter $1,$(artifacts)),,$(eval artifacts += $1)$(eval \
	recipe/$1 := $2 $(3:%=input=%) output=$1)$(eval inputs/$1 := $3)$(eval \
	command/$1 := $4)$(eval programs/$1 := $(filter $(PROGRAMS),$5)))

# $1 is made by stage $2, program $3, from scene $4 with overrides $5 and the files $6.
step = $(call artifact,$1,scene=$4 stage=$2 $(if $(filter $(BUILD)/bin/$2,$3),version=$(call \
	version_of,$2),program=$(call quoted,$3)) $(foreach s,$5,set=$(call quoted,$s)),$6,$(RUN) $3 \
	-p $4 $(foreach s,$5,--set $(call quoted,$s)) \
	$(THREADS:%=--threads %) $6 -o $1,$3)

pipeline_library := $(filter-out %.pyc,$(wildcard pipelines/lib/*.*))
# $1 is a table or a picture that pipelines/$2 makes of the files $3. It is called with these, or
# with the words $4 where they are given, and with $1.
report = $(call artifact,$1,stage=$2 version=1,$(wildcard pipelines/$2 pipelines/$2.gp \
	pipelines/$2-*.gp pipelines/$2-*.awk pipelines/$2.awk $(pipeline_library)) $3,pipelines/$2 \
	$(or $4,$3) $1,$(BUILD)/bin/inspect)

# The words $1 in their order, each once.
once_each = $(if $1,$(firstword $1) $(call once_each,$(filter-out $(firstword $1),$1)))

# Whether goal $1, or a file in its folder $2, is asked for.
asked = $(filter $1 $2/%,$(MAKECMDGOALS))

# Goal $1 makes the tables and pictures $2, shows the tables and says where the pictures are.
study = $(eval .PHONY: $1)$(eval pipeline_goals += $1)$(eval $1: $2 ; \
	$(if $(really),$(call shown,$(filter %.md,$2),$(filter %.svg %.png %.gif,$2))))
shown = @$(if $1,cat $1;) $(if $2,echo 'picture$(if $(word 2,$2),s): $2')

# Others use what these two define.
first_pipelines := $(wildcard pipelines/run/run.mk pipelines/study/study.mk $(addprefix pipelines/studies/,networks-k/study.mk coupled/study.mk))
include $(first_pipelines) $(filter-out $(first_pipelines),$(wildcard pipelines/studies/*/study.mk))

# Studies with scenes of their own, and so with grains of their own: others would go unheard.
own_scenes := boundary-layers boundary-study bridges calibration collapse coupled critical-bonds critical-thickness curves drag drainage \
	fronts-k networks networks-k packings percolation rate-drop rings shear shear-depth sobol wet-dry
$(foreach name,SCENE IMPORT,$(if $(filter command,$(origin $(name))),$(foreach goal,$(filter $(own_scenes),$(MAKECMDGOALS)),$(error \
	$(name): make $(goal) takes none, it has scenes of its own (make run, demo, study, craquelure, large take grains)))))
$(if $(and $(filter command,$(origin SCENE)),$(filter large,$(MAKECMDGOALS))),$(error SCENE: make large takes LARGE_SCENE in its place))

ifneq ($(filter $(pipeline_goals),$(MAKECMDGOALS)),)
# A file, for there may be more recipes than a command line holds; this make's own, for there may
# be several at work.
recipes := $(shell $(if $(wildcard $(BUILD)),,mkdir -p $(BUILD) &&) mktemp $(BUILD)/recipes.XXXXXX)
$(if $(recipes),,$(error $(BUILD): cannot be written))
$(file >$(recipes),$(foreach a,$(artifacts),$(recipe/$a)))
stale := $(shell tools/memo check $(recipes) $(BUILD)/digests)
ifneq ($(.SHELLSTATUS),0)
$(error tools/memo could not tell what is stale)
endif

# What memo is told of $1: by a file where there are so many inputs that a shell's line may not
# hold them.
told = $(recipe/$1) -- $(command/$1)
told_file = $(recipes)-$(subst /,-,$1)
told_by_file = $(if $(really),$$(file >$(told_file),$(told)))@$(told_file)
define artifact_rule
$1: $(if $(filter $1,$(stale)),FORCE) | $(inputs/$1) $(programs/$1)
	$(if $(filter 0,$(V)),@)tools/memo run $(if $(word 500,$(inputs/$1)),$(told_by_file),$(told))
endef
$(foreach a,$(artifacts),$(eval $(call artifact_rule,$a)))
endif

# --- install --------------------------------------------------------------------------

MAN := $(BUILD)/man/craquelure.1 $(BUILD)/man/craquelure-run.1 $(STAGES:%=$(BUILD)/man/craquelure-%.1)
COMPLETION := $(BUILD)/completion/craquelure
FRONT := $(BUILD)/front/craquelure

$(BUILD)/front/craquelure: tools/craquelure VERSION
	@mkdir -p $(@D) && sed 's/@VERSION@/$(VERSION)/' $< >$@ && chmod +x $@
# The front command finds its stages beside it, as it will when installed.
$(BUILD)/man/craquelure.1: $(FRONT) tools/man-page $(PROGRAMS)
	@mkdir -p $(@D) $(BUILD)/libexec && ln -sfn ../bin $(BUILD)/libexec/craquelure \
		&& tools/man-page '' $(VERSION) $< >$@
$(BUILD)/man/craquelure-run.1: tools/run tools/man-page VERSION
	@mkdir -p $(@D) && tools/man-page run $(VERSION) $< >$@
$(BUILD)/man/craquelure-%.1: $(BUILD)/bin/% tools/man-page VERSION
	$(call quiet,MAN,$*)mkdir -p $(@D) && tools/man-page $* $(VERSION) $< >$@
$(COMPLETION): tools/completion tools/run $(PROGRAMS)
	@mkdir -p $(@D) && tools/completion $(PROGRAMS) tools/run >$@

# What `craquelure run`, `demo` and `study` need, as it lies in the tree: all pipelines but studies that
# are rules; samples and documents.
pipeline_files := $(filter-out %__pycache__,$(wildcard $(addprefix pipelines/,run/* figures/* lib/* study/* calibrate/* studies/*.json)))
shared_scripts := tools/memo $(foreach f,$(pipeline_files),$(if $(suffix $f),,$f))
shared := tools/memo $(pipeline_files) Makefile VERSION $(wildcard *.md docs/*.md docs/pages/* docs/pictures/* \
	samples/*.json schemas/*.json stages/*/version)
shared_mode = $(if $(filter $(shared_scripts),$1),755,644)

# Under DESTDIR: the file to put there, where (by its own name), and with what mode.
installed := $(SAMPLES:%=%:lib/craquelure/samples.so:644) $(foreach s,$(STAGES),$(BUILD)/bin/$s:libexec/craquelure/$s:755) \
	$(FRONT):bin/craquelure:755 $(foreach m,$(MAN),$m:share/man/man1/$(notdir $m):644) \
	$(COMPLETION):share/bash-completion/completions/craquelure:644 \
	tools/run:share/craquelure/run:755 \
	$(foreach f,$(shared),$f:share/craquelure/$f:$(call shared_mode,$f))

.PHONY: install uninstall
install: all $(FRONT) $(MAN) $(COMPLETION) ## install under PREFIX (and DESTDIR)
	@declare -A files=(); for item in $(installed); do IFS=: read -r from to mode <<<$$item; \
		files[$$mode:$${to%/*}]+=" $$from"; done; \
	for group in "$${!files[@]}"; do \
		install -D -m $${group%%:*} -t '$(DESTDIR)$(PREFIX)'/$${group#*:} $${files[$$group]}; done
uninstall: ## remove what install put there
	@files=(); for item in $(installed); do IFS=: read -r from to mode <<<$$item; \
		files+=('$(DESTDIR)$(PREFIX)'/$$to); done; rm -f "$${files[@]}"
	@for folder in lib libexec share; do if [[ -d '$(DESTDIR)$(PREFIX)'/$$folder/craquelure ]]; then \
		find '$(DESTDIR)$(PREFIX)'/$$folder/craquelure -depth -type d -empty -delete; fi; done

# --- check ----------------------------------------------------------------------------

BENCH_STUDIES := $(addprefix bench-,packings dem impact simulate simulate-speed walls bridge viscous replay dry network flow report scale estimates studies)
.PHONY: check check-c sanitize hard bench $(BENCH_STUDIES) bench-void speed-vs-error
check: all $(C_TESTS) $(VOID) ## run all tests, the hard cases last
	@tests/run $(C_TESTS) $(SCRIPT_TESTS)
	@tests/hard/run
check-c: $(C_TESTS) ## run the tests written in C only
	@tests/run $(C_TESTS)
sanitized := BUILD=$(BUILD)/sanitize SANITIZE=1 \
	LSAN_OPTIONS=suppressions=tests/leaks.supp:print_suppressions=0
small_scene := $(BUILD)/sanitize/small.json
sanitize: ## the tests in C and a small run under address and undefined-behaviour sanitizers
	@+$(MAKE) --no-print-directory $(sanitized) check-c
	@rm -rf $(BUILD)/sanitize/runs
	@jq '.pack.counts = [3, 3, 4]' samples/stiff-5x5x10.json \
		| jq '.["force-protocol"].steps = 20 | .["dem-replay"].cycles = 50' >$(small_scene)
	@+$(MAKE) --no-print-directory $(sanitized) SCENE=$(small_scene) run
	@at=$(BUILD)/sanitize; for call in pack tessellate:packing merge-nodes:tessellation dry:network \
		force-protocol:drying dem-replay:forces; do IFS=: read -r stage input <<<$$call; \
		env $(sanitized) $$at/bin/$$stage -p $(small_scene) --estimate \
			$${input:+$$at/runs/small/$$input.h5} >/dev/null || exit; done
.PHONY: check-slurm
check-slurm: all ## a study as Slurm's jobs on two nodes of its own, killed and gone on with (five minutes)
	@apt-get install -y -q slurmctld slurmd slurm-client munge bc time >/dev/null
	@BIN=$(abspath $(BUILD)/bin) tests/slurm/run
hard: all ## run the hard cases and print a table
	@tests/hard/run
bench: all $(BENCHES) ## measure speeds, as ratios within one run
	@tests/bench/run
$(BENCH_STUDIES): bench-%: all $(BENCHES)
	@tests/bench/$*
bench-packings: ## packings with an adapted time step beside those of plain dynamics (ten minutes)
bench-dem: ## the discrete elements beside LAMMPS, LIGGGHTS and Yade (an hour)
bench-impact: ## error of the contact laws against cost, over time steps
bench-simulate: ## the program simulate beside LIGGGHTS and Yade: trajectories and averages
bench-simulate-speed: ## its speed beside LIGGGHTS and Yade, dry and wet, and in the shear cell
bench-walls: ## the tessellation in a cylinder and of grains on a sphere, next to voro++
bench-bridge: ## error of the capillary bridge models against cost
bench-viscous: ## time to dryness with viscous liquid, next to none
bench-replay: ## error of both engines of the replay against time, and time against time
bench-dry: ## time of drying and of invasion percolation against size (ten minutes)
bench-network: ## measure time and memory of the tessellation, next to voro++
bench-flow: ## measure time and memory of the flow, next to Yade
bench-scale: ## each stage on irregular grains: time, growth, memory, files at three sizes (ten minutes)
bench-estimates: ## what --estimate of each stage says, over what it takes (three minutes)
bench-studies: ## what a study costs beside its stages, next to the shell and snakemake (two minutes)
bench-report: ## the page of 50,000 grains in a headless Chromium: first picture, slider, turning
bench-void: all $(VOID) ## networks of packings beside their void solved directly (a minute)
	@tests/bench/void/compare $(BUILD)/void
	@tests/bench/void/compare --flow $(BUILD)/void
speed-vs-error: all $(BENCHES) ## error against time, one plot a stage (two minutes)
	@tests/bench/speed-vs-error

# --- house ----------------------------------------------------------------------------

C_SOURCES := $(wildcard $(foreach d,* */* lib/*/*,stages/$d/*.[ch] stages/$d/*.cpp) tests/*.[ch] \
	tests/*/*.[ch] tests/*/*/*.[ch])

.PHONY: format tidy help
format: ## format the C and C++ sources
	clang-format -i $(C_SOURCES)
tidy: ## look for mistakes with clang-tidy; fails where there are any
	@clang-tidy --quiet $(filter stages/%.c,$(C_SOURCES)) -- \
		$(CPPFLAGS) -std=c17 -D_GNU_SOURCE -fopenmp \
		-DSTAGE_VERSION=1 -DCRAQUELURE_VERSION='"$(VERSION)"' \
		2> >(grep -v ' generated\.$$' >&2)
print-%: ## show a make variable: make print-CFLAGS
	@echo '$($*)'
help: ## list the targets
	@awk -F ':.*## ' '/^[a-z%-]+:.*## / { printf "  %-16s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

endif

.PHONY: clean
clean: ## remove everything made
	rm -rf $(BUILD)

# --- tools and libraries --------------------------------------------------------------
# Does and prints nothing when nothing is missing. What apt says shows only where it fails.

.PHONY: deps FORCE
deps: ## install what is missing (Debian; as root or through sudo)
	@missing=; for package in $(PACKAGES); do \
		[[ $$(dpkg-query -W -f '$${Status}' $$package 2>/dev/null) == *' installed' ]] \
			|| missing+=" $$package"; done; \
	[[ -z $$missing ]] && exit; \
	as_root=; (( EUID )) && as_root=sudo; \
	printf '  %-5s %s\n' APT "$$missing"; \
	said=$$(mktemp); trap 'rm -f "$$said"' EXIT; \
	{ $$as_root apt-get update && $$as_root env DEBIAN_FRONTEND=noninteractive \
		apt-get install -y --no-install-recommends $$missing; } >"$$said" 2>&1 \
		|| { status=$$?; tail -n 20 "$$said" >&2; exit $$status; }
