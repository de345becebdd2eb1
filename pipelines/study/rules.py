# SPDX-License-Identifier: GPL-3.0-or-later
"""Rules of make for what is stale of a plan; tools/memo says what is, by contents."""
import os
import shlex
import subprocess

from common import refuse
from plan import TREE, Artifact, recipe_of

MEMO = os.path.join(TREE, "tools/memo")
# More words than this go to memo by a file: a line of a shell holds 128 kB.
LONGEST = 60000
TIME = "PEAK = /usr/bin/time -q -f %M -o $@.peak\n"  # kB, the largest program
HEAD = r"""# Made by pipelines/study: what is stale of this study. tools/memo makes it.
MAKEFLAGS += --no-builtin-rules --no-builtin-variables
SHELL := /bin/bash
.SUFFIXES:
.PHONY: all $(TARGETS)
all: $(TARGETS)
# $1: a stage, $2: what memo is told. What a stage says that fails stays beside; else it is noted, as are times.
# Each program that a recipe starts costs as much as 1 % of a small run: what bash can do, it does.
make_it = @start=$$EPOCHREALTIME; status=0; $(PEAK) $(MEMO) run $2 2>$@.said || status=$$?; \
	if (( status )); then cat $@.said >&2; else \
	peak=0; [[ ! -s $@.peak ]] || peak=$$(<$@.peak); \
	while IFS= read -r line; do echo "$@ $$line"; done <$@.said >>.study/notes; rm -f $@.said $@.peak; \
	echo "$1 $$start $$EPOCHREALTIME $@ $$peak" >>.study/times; fi; exit $$status
"""


def launcher():
    return shlex.split(os.environ.get("RUN", ""))


def recipes(plan):
    """By path: the words of memo, its key and its command."""
    threads = os.environ.get("THREADS", "")
    return {path: recipe_of(parts, launcher(), threads) for path, parts in plan.parts.items()}


def quoted(words):
    return " ".join(map(shlex.quote, words))


def stale_paths(made, folder):
    """Of the artifacts MADE, recipes by path, those that are stale, in their order."""
    note = f".study/recipes-{os.getpid()}"
    with open(os.path.join(folder, note), "w", encoding="utf-8") as file:
        file.writelines(f"{quoted(key)}\n" for key, _ in made.values())
    said = subprocess.run([MEMO, "check", note, ".study/digests"], cwd=folder, stdout=subprocess.PIPE, text=True,
                          env={**os.environ, "LC_ALL": "C"})
    if said.returncode:
        refuse(70, "tools/memo could not tell what is stale")
    return said.stdout.split()


def label(plan, path):
    """By what the time of an artifact is known: its stages."""
    return "+".join(part.stage() for part in plan.parts[path])


def in_make(text):
    return text.replace("$", "$$")


def told(path, key, command, folder):
    """What memo is told of PATH: on the line, or by a file where that is too long."""
    words = quoted([*key, "--", *command])
    if len(words) < LONGEST:
        return in_make(words).replace(",", "$(comma)")
    note = f".study/words-{path.replace('/', '-')}"
    with open(os.path.join(folder, note), "w", encoding="utf-8") as file:
        file.write(words)
    return f"@{note}"


def write_rules(plan, made, wanted, stale, folder, name):
    """The file NAME of rules for the paths WANTED, of those that are STALE."""
    stale = set(stale)
    inputs = {path: [each.path for part in parts for each in part.inputs if isinstance(each, Artifact) and each.path in made]
              for path, parts in plan.parts.items()}
    for place in {os.path.dirname(path) for path in wanted}:
        os.makedirs(os.path.join(folder, place), exist_ok=True)
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(f"TARGETS := {' '.join(wanted)}\ncomma := ,\nMEMO := {in_make(shlex.quote(MEMO))}\n"
                   f"{TIME if os.path.exists('/usr/bin/time') else ''}{HEAD}")
        for path in wanted:
            needs = dict.fromkeys(each for each in inputs[path] if each in stale)
            file.write(f"{path}:{' | ' if needs else ''}{' '.join(needs)}\n"
                       f"\t$(call make_it,{label(plan, path)},{told(path, *made[path], folder)})\n")
