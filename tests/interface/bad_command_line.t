#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input (tests/refusals.py): the command line."""
import os
import sys

sys.path.insert(0, "tests")
from refusals import BAD_DATA, USAGE, done, refused, refused_in_shell, text_file

os.symlink("out", "beside")
for place in ["out/result", "./out/result", "out/../out/result", "beside/result",
              os.path.abspath("out/result")]:
    refused(f"a checkpoint at the output is refused however spelt", USAGE,
            ["dry", "network", "--checkpoint", place],
            f"--checkpoint {place}: is where the output goes: name another file")
for program in ["pack", "tessellate", "merge-nodes", "dry", "force-protocol", "dem-replay",
                "deform", "crackstats", "report", "bridge", "flow", "invade", "inspect", "simulate",
                "shearstats", "rings"]:
    refused_in_shell(f"{program} refuses an unknown option", USAGE,
                     f"$BIN/{program} --nonsense", ".*: unrecognized option '--nonsense'")
refused_in_shell("an option without its argument is refused", USAGE, "$BIN/pack --set",
                 ".*: option '--set' requires an argument")
for threads in ["0", "-1", "two", "1e3", "5000", ""]:
    refused(f"--threads '{threads}' is refused", USAGE, ["pack", f"--threads={threads}"],
            f"--threads: must be from 1 to 1024, got {threads}")
refused("an unknown --progress is refused", USAGE, ["pack", "--progress=maybe"],
        "--progress: must be auto, always or never, got maybe")
refused("a second input is refused", USAGE, ["tessellate", "packing", "packing"],
        "packing: too many inputs, takes at most 1")
refused("deform wants two inputs", USAGE, ["deform", "drying"],
        "two inputs: a drying or network, and a response")
refused("deform refuses a packing", BAD_DATA, ["deform", "packing", "response"],
        "packing: must be a drying or a network, is a packing")
refused("deform refuses a drying in place of a response", BAD_DATA, ["deform", "drying", "drying"],
        "drying: must be a response, is a drying: first run force-protocol, then dem-replay")
refused("a lattice takes no input", USAGE, ["pack", "packing"],
        r"packing: this pack.method \(by default cubic\) takes no input: import, deposition, "
        "radius_expansion, domain_contraction and explosive_repulsion do")
refused("inspect takes one input", USAGE, ["inspect", "packing", "packing"],
        "packing: one input only", output=())
refused("inspect refuses --frames 0", USAGE, ["inspect", "--frames=0", "packing"],
        "--frames: must be from 1 to 10000, got 0", output=())
refused("inspect names a dataset that is not there", BAD_DATA,
        ["inspect", "--data=/force", "packing"],
        r"packing: has no dataset /force \(a packing has none; without --data inspect lists those it has\)", output=())
refused("inspect has no series of what does not change", BAD_DATA,
        ["inspect", "--vtk=out/x", "packing"],
        "packing: nothing changes over time in a packing; .*", output=())
refused("inspect cannot take a dataset from JSON", USAGE,
        ["inspect", "--data=/force", "crackstats"], "crackstats: is JSON: read it with jq",
        output=())
refused("inspect refuses broken JSON", BAD_DATA,
        ["inspect", text_file("broken", '{"schema": ')], "broken: line 1: .*", output=())
refused("inspect refuses JSON without a schema", BAD_DATA,
        ["inspect", text_file("other", '{"a": 1}')],
        "other: is not an artifact: it has no schema", output=())

done()
