#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# docs/tutorial.md, typed: what its commands print is what the page says they print. Bytes do not
# depend on the machine, so neither do these lines.
import os
import re
import subprocess
import sys

sys.path.insert(0, "tests")
from tap import BIN, code_blocks, done, ok, read, scratch

folder = scratch()
blocks = list(code_blocks(read("docs/tutorial.md").decode()))


def following(start):
    """The block that begins with START, and the one after it."""
    at = next(k for k, block in enumerate(blocks) if block.startswith(start))
    return blocks[at], blocks[at + 1]


def typed(command, where=folder.name):
    """What it prints, in the reader's folder."""
    call = subprocess.run(["bash", "-c", command], cwd=where, text=True, check=False, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, env={**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}"})
    return call.stdout


def shows(start):
    """Whether the last command of the block prints what the page says."""
    command, expected = following(start)
    printed = typed(command).strip("\n")
    ok(printed == expected, f"{start}: prints what the tutorial says", printed)


typed(following("python3 > grains.txt")[0])
shows("check grains.txt")
shows("pack -s method=deposition")
typed(following("check -o - settled.h5 | jq")[0])

command, expected = following("make demo")
command = command.replace("mine.json", f"{folder.name}/mine.json").replace("grains.txt", f"{folder.name}/grains.txt")
printed = typed(f"{command} RUNS={folder.name}/build/runs BUILD={os.path.dirname(BIN)}", ".")
told = re.compile(r"(?m)^(?:dem-replay|inviscid|immobile): .*")
ok(sorted(told.findall(printed)) == sorted(told.findall(expected)), "make demo: breaks the bonds that the tutorial says",
   printed)
shows("for s in 3e4")
done()
