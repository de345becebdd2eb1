#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Out of memory: whichever allocation fails, of ours or of a library, a program writes the bytes of
the good run, or ends with status 70 and one line that says so. MEMORY=1000 tries more of them.
"""
import os
import random
import re
import resource
import subprocess
import sys

sys.path.insert(0, "tests")
from tap import BIN, done, ok, run, scratch

COUNT = int(os.environ.get("MEMORY", 40))

# Counts allocations from the reading of the command line on, and refuses the one numbered FAIL_AT,
# or with FAIL_ON all from there on. COUNT_TO gets their number.
FAIL_C = r"""
#include <argp.h>
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t),
    *__libc_memalign(size_t, size_t);

static atomic_long calls;
static long first, last;
static int armed;

static int refused(void)
{
    if (!armed) return 0;
    const long number = ++calls;
    if (number < first || number > last) return 0;
    errno = ENOMEM;
    return 1;
}

static void tell(void)
{
    armed = 0;
    FILE *file = getenv("COUNT_TO") ? fopen(getenv("COUNT_TO"), "w") : NULL;
    if (!file) return;
    fprintf(file, "%ld", (long)calls);
    fclose(file);
}

error_t argp_parse(const struct argp *argp, int count, char **words, unsigned flags, int *index,
                   void *input)
{
    error_t (*next)(const struct argp *, int, char **, unsigned, int *, void *) =
        dlsym(RTLD_NEXT, "argp_parse");
    const char *at = getenv("FAIL_AT");
    atexit(tell);
    first = at ? atol(at) : -1;
    last = getenv("FAIL_ON") ? 1L << 60 : first;
    armed = 1;
    return next(argp, count, words, flags, index, input);
}

void *malloc(size_t size) { return refused() ? NULL : __libc_malloc(size); }
void *calloc(size_t count, size_t size) { return refused() ? NULL : __libc_calloc(count, size); }
void *realloc(void *old, size_t size) { return refused() ? NULL : __libc_realloc(old, size); }
void *memalign(size_t to, size_t size) { return refused() ? NULL : __libc_memalign(to, size); }
void *aligned_alloc(size_t to, size_t size) { return memalign(to, size); }
int posix_memalign(void **memory, size_t to, size_t size)
{
    *memory = memalign(to, size);
    return *memory ? 0 : ENOMEM;
}
"""


def call(command, **environment):
    return subprocess.run([f"{BIN}/{command[0]}", *command[1:]], stdin=subprocess.DEVNULL,
                          capture_output=True, timeout=60,
                          env=os.environ | {"LD_PRELOAD": os.path.abspath("fail.so")} | environment)


def verdict(end, good):
    """What is wrong with how a run ended; None: nothing."""
    said = end.stderr.decode(errors="replace")
    if end.returncode == 0:
        return None if end.stdout == good.stdout else f"other bytes: {said}"
    one_line = re.fullmatch(r"[a-z-]+: (out of memory: .*|cannot start another thread: .*)\n", said)
    return None if end.returncode == 70 and one_line else f"status {end.returncode}: {said}"


def failing(command):
    """Runs it to the end, and then with one allocation that fails, or all from there on."""
    good = call(command, COUNT_TO="count")
    with open("count") as file:
        count = int(file.read())
    chance = random.Random(str(command))
    wrong, ended = [], 0
    for k in range(COUNT):
        at = chance.randint(1, count)
        end = call(command, FAIL_AT=str(at), **({"FAIL_ON": "yes"} if k % 2 else {}))
        problem = verdict(end, good)
        wrong += [f"allocation {at} of {count}: {problem}"] if problem else []
        ended += end.returncode == 70
    name = command[0]
    ok(good.returncode == 0 and count > 100 and ended, f"{name}: allocations fail",
       f"{ended} of {COUNT} runs")
    ok(not wrong, f"{name}: and it says so, or does without", "\n".join(wrong))


def short(command, threads):
    """Ever less memory for all of the program."""
    good = call([*command, "--threads", "1"])
    wrong, ended = [], 0
    for size in range(30, 62, 2):
        limit = (size << 20, size << 20)
        end = subprocess.run(
            [f"{BIN}/{command[0]}", *command[1:], "--threads", threads], stdin=subprocess.DEVNULL,
            capture_output=True, timeout=60,
            preexec_fn=lambda limit=limit: resource.setrlimit(resource.RLIMIT_AS, limit))
        if end.returncode == 127:  # not even the libraries
            continue
        problem = verdict(end, good)
        wrong += [f"{size} MB: {problem}"] if problem else []
        ended += end.returncode == 70
    ok(ended, f"{command[0]}, {threads} threads: memory is short", f"{ended} runs")
    ok(not wrong, f"{command[0]}, {threads} threads: and it says so", "\n".join(wrong))


with scratch() as folder:
    os.chdir(folder)
    with open("fail.c", "w") as file:
        file.write(FAIL_C)
    subprocess.run(["gcc", "-O1", "-shared", "-fPIC", "-o", "fail.so", "fail.c"], check=True)
    replay = ["dem-replay", "forces", "--quiet", "--set", "time_step_safety=0.02", "--set", "cycles=20"]
    made = b""
    for step in [["pack", "--set", "counts=[2,2,3]"], ["tessellate"], ["merge-nodes"], ["dry"],
                 ["force-protocol", "--set", "steps=5"]]:
        made = run(*step, input=made)
        with open({"pack": "packing", "force-protocol": "forces"}.get(step[0], step[0]), "wb") as file:
            file.write(made)
    failing(["pack", "--set", "counts=[2,2,3]"])
    failing(["tessellate", "packing"])
    failing(["dry", "merge-nodes", "--set", "liquid=viscous"])
    failing(replay)
    failing(["flow", "packing"])
    failing(["bridge", "--set", "radius=1e-3", "--set", "volume=1e-12"])
    short(replay, "4")
done()
