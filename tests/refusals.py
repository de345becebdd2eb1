# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of bad input share: a refusal has the right exit status and one line that names
the file, the dataset or key, the row, the rule and the value. Nothing goes to standard output,
and what stood at the output before is still there, alone, byte for byte.

One call of refused() is one row of their tables. Importing this makes good artifacts in a folder
that goes when the test ends, and goes there.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

import h5py

BIN = os.environ.setdefault("BIN", os.path.abspath("build/bin"))
USAGE, BAD_DATA, NO_INPUT, CANNOT_CREATE, IO = 64, 65, 66, 73, 74
UNSTABLE = 3
EARLIER = b"the earlier output\n"

scratch = tempfile.TemporaryDirectory()
os.chdir(scratch.name)
os.mkdir("out")
number = 0


# ---- what a row does --------------------------------------------------------------------

def result(title, problems, skip=None):
    global number
    number += 1
    print("not " * bool(problems) + f"ok {number} - {title}" + f" # skip {skip}" * bool(skip))
    for problem in problems:
        print("#   " + problem.replace("\n", "\n#   "))
    sys.stdout.flush()


def run(command, **options):
    """Runs a program of ours, or any other; what it must not touch is put back first."""
    command = [word if isinstance(word, bytes) else str(word) for word in command]
    if os.path.exists(f"{BIN}/{command[0]}"):
        command[0] = f"{BIN}/{command[0]}"
    shutil.rmtree("out")
    os.mkdir("out")
    with open("out/result", "wb") as file:
        file.write(EARLIER)
    if "input" not in options:
        options["stdin"] = subprocess.DEVNULL
    return subprocess.run(command, capture_output=True, timeout=30, **options)


def problems_of(done, status, lines):
    """What differs from what a refusal must be."""
    found = []
    error = done.stderr.decode(errors="replace")
    got = error.splitlines()
    if done.returncode != status:
        found.append(f"exit status: expected {status}, got {done.returncode}")
    if len(got) != len(lines):
        found.append(f"lines on stderr: expected {len(lines)}, got {len(got)}")
    for pattern, line in zip(lines, got):
        if not re.fullmatch(pattern, line):
            found.append(f"expected the line to match: {pattern}")
    if done.stdout:
        found.append(f"standard output is not empty: {done.stdout[:60]!r}")
    with open("out/result", "rb") as file:
        if file.read() != EARLIER:
            found.append("the earlier output changed")
    if os.listdir("out") != ["result"]:
        found.append(f"left behind: {os.listdir('out')}")
    if found:
        found.append(f"stderr was:\n{error}")
    return found


def refused(title, status, command, *lines, output=("-o", "out/result"), **options):
    """COMMAND ends with STATUS and says just LINES, regular expressions without the
    program's name in front."""
    said = [f"{command[0]}: {line}" for line in lines]
    result(title, problems_of(run([*command, *output], **options), status, said))


def refused_in_shell(title, status, script, *lines):
    """The same for a line of shell, where $BIN/… is a program."""
    result(title, problems_of(run(["bash", "-c", script]), status, lines))


def setting(title, status, assignment, *lines, program=("pack",)):
    refused(title, status, [program[0], "--set", assignment, *program[1:]], *lines)


# ---- good artifacts, and what is done to them -------------------------------------------

def make(name, *command):
    subprocess.run([f"{BIN}/{command[0]}", *command[1:], "-o", name], check=True)


make("packing", "pack", "--set", "counts=[2,2,3]")
make("degenerate", "tessellate", "packing")
make("network", "merge-nodes", "degenerate")
make("drying", "dry", "network")
make("forces", "force-protocol", "drying", "--set", "steps=5")
make("response", "dem-replay", "-q", "forces", "--set", "time_step_safety=0.02",
     "--set", "cycles=100", "--set", "bond.normal_strength=1e3")
make("crackstats", "crackstats", "response")

READER = {
    "packing": "tessellate",
    "network": "merge-nodes",
    "drying": "force-protocol",
    "forces": "dem-replay",
    "response": "crackstats",
}


def text_file(name, content):
    with open(name, "wb" if isinstance(content, bytes) else "w") as file:
        file.write(content)
    return name


def contents(name):
    with open(name, "rb") as file:
        return file.read()


def damaged(name, *changes):
    """A copy of a good artifact with CHANGES made to it."""
    shutil.copy(name, "damaged")
    with h5py.File("damaged", "r+") as file:
        for change in changes:
            change(file)
    return "damaged"


def value(dataset, where, what):
    def change(file):
        file[dataset][where] = what

    return change


def replaced(dataset, new):
    """NEW is an array, or makes one of the old."""

    def change(file):
        data = new(file[dataset][...]) if callable(new) else new
        del file[dataset]
        file[dataset] = data

    return change


def removed(name):
    def change(file):
        del file[name]

    return change


def attribute(group, name, new):
    def change(file):
        del file[group].attrs[name]
        if new is not None:
            file[group].attrs[name] = new

    return change


def damage(title, name, change, line):
    """The stage that reads artifacts of this kind refuses one that was changed so."""
    refused(title, BAD_DATA, [READER[name], damaged(name, change)], f"damaged: {line}")


def done():
    """The plan."""
    print(f"1..{number}")
