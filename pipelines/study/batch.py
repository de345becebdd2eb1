# SPDX-License-Identifier: GPL-3.0-or-later
"""A study on a cluster that Slurm runs: one file for sbatch, an array of a few jobs, each of which works
through its share of the runs with make."""
import hashlib
import math
import os
import re
import shlex
import subprocess
import sys

import cost
from common import refuse

SCRIPT = """#!/bin/bash
# {name}: {runs} runs. Each job makes its share. Submitted again, it makes what is missing.
#SBATCH --job-name={name}
#SBATCH --array=1-{tasks}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task={cpus}
#SBATCH --mem-per-cpu={memory}M
#SBATCH --time={minutes}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={folder}/.study/job-%A-%a.out
{settings}cd {here} && exec {program} part {words} --part="$SLURM_ARRAY_TASK_ID/{tasks}:{listed}" --jobs="${{SLURM_CPUS_PER_TASK:-1}}"
"""
LEAST_MINUTES = 30  # of a job: centres want no thousands of short ones
MOST_TASKS = 200


def write_list(plan, stale, folder):
    """The runs that something is missing of, those beside each other that have most in common, in a file of
    the folder; gives its name."""
    stale = set(stale)
    left = [k for k, made in enumerate(plan.runs) if any(a.path in stale for a in made.values())]
    left.sort(key=lambda k: [plan.runs[k][kind].path for kind in plan.kinds])
    text = " ".join(map(str, left))
    name = f"batch-{hashlib.sha256(text.encode()).hexdigest()[:8]}"
    with open(os.path.join(folder, ".study", name), "w", encoding="utf-8") as file:
        file.write(text)
    return name


def share(plan, stale, folder, part):
    """Of the STALE paths those of a PART, "NUMBER/COUNT:NAME" of a list of runs. What parts have in common
    is in each, and whoever comes first makes it."""
    found = re.fullmatch(r"(\d+)/(\d+):(batch-\w+)", part)
    path = found and os.path.join(folder, ".study", found[3])
    if not found or not os.path.exists(path) or not 1 <= int(found[1]) <= int(found[2]):
        refuse(64, f"--part={part}: is no part of a batch")
    with open(path, encoding="utf-8") as file:
        left = [int(word) for word in file.read().split()]
    first, last = ((len(left) * k) // int(found[2]) for k in (int(found[1]) - 1, int(found[1])))
    mine = {a.path for k in left[first:last] for a in plan.runs[k].values()}
    return [path for path in plan.parts if path in mine & set(stale)]


def needs(plan, stale, folder, said):
    """Jobs, processors of each, MiB of a processor and minutes: as the user says, else by what was measured
    of this study so far, or what its stages foresee."""
    expected = cost.estimate(plan, stale, folder)
    cpus = said.get("cpus", 1)
    most = max(1, min(MOST_TASKS, len(plan.runs)))
    tasks = said.get("tasks") or max(1, min(most, math.ceil(expected.seconds / cpus / 60 / LEAST_MINUTES)))
    if expected.silent and "time" not in said:
        refuse(65, f"{plan.study.name}: {', '.join(sorted(expected.silent))}: nothing says what this takes: make some runs first "
               "(study make --seeds=1), or say --time=MINUTES")
    minutes = said.get("time") or math.ceil(2 * expected.seconds / cpus / tasks / 60) + 5
    memory = said.get("mem") or math.ceil(1.5 * expected.mebibytes) + 100
    return min(tasks, most), cpus, memory, minutes


def write_script(plan, stale, folder, said, words):
    """FOLDER/study.sbatch; gives its name and what to say of it."""
    tasks, cpus, memory, minutes = needs(plan, stale, folder, said)
    names = ("RUN", "THREADS", "BIN", "PACK", "TESSELLATE", "MERGE_NODES", "DRY", "FORCE_PROTOCOL", "DEM_REPLAY", "CRACKSTATS")
    settings = "".join(f"export {name}={shlex.quote(os.environ[name])}\n" for name in names if os.environ.get(name))
    text = SCRIPT.format(listed=write_list(plan, stale, folder), name=plan.study.name, runs=len(plan.runs), tasks=tasks, cpus=cpus, memory=memory, minutes=minutes,
                         folder=os.path.realpath(folder), settings=settings, here=shlex.quote(os.getcwd()),
                         program=shlex.quote(os.path.realpath(sys.argv[0])), words=" ".join(map(shlex.quote, words)))
    path = os.path.join(folder, "study.sbatch")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    print(f"{tasks} job{'s' * (tasks > 1)} of {cpus} processor{'s' * (cpus > 1)}, {memory} MiB each and {minutes} minutes: {path}", flush=True)
    return path


def submit(path):
    """Gives the file to sbatch."""
    try:
        said = subprocess.run(["sbatch", path], stdin=subprocess.DEVNULL)
    except FileNotFoundError:
        refuse(70, f"sbatch is not installed here; on a machine that has it: sbatch {path}")
    if said.returncode:
        raise SystemExit(said.returncode)
