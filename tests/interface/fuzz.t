#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged at random: no program may crash, hang, blame itself, or write what it would not
read. The damage is the same in every run. FUZZ=5000 tries more of it; FUZZ_KEEP=FOLDER
keeps what failed there.
"""
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy

BIN = os.environ["BIN"]
COUNT = int(os.environ.get("FUZZ", 100))
KEEP = os.environ.get("FUZZ_KEEP")
MOST_SECONDS = 10
# Done, unstable, bad data; never an internal error, and nothing else can be wrong here.
ALLOWED = {0, 3, 65}

# With sanitizers in the programs (make SANITIZE=1): what they find ends a program by a
# signal. In the child that looks at a file first it is the fault of the HDF5 library.
os.environ.setdefault("ASAN_OPTIONS", "abort_on_error=1:handle_segv=0:detect_leaks=0:"
                      "allocator_may_return_null=1:log_path=/dev/null")
os.environ.setdefault("UBSAN_OPTIONS", "halt_on_error=1:abort_on_error=1:log_path=/dev/null")

scratch = tempfile.TemporaryDirectory()
os.chdir(scratch.name)


def make(name, *command):
    subprocess.run([f"{BIN}/{command[0]}", *command[1:], "-o", name], check=True)


REPLAY = ["-q", "--set", "time_step_safety=0.02", "--set", "cycles=20"]
make("packing", "pack", "--set", "counts=[2,2,3]")
make("degenerate", "tessellate", "packing")
make("network", "merge-nodes", "degenerate")
make("drying", "dry", "network", "--set", "liquid=viscous", "--set", "snapshots=[0.9,0.5]")
make("invasion", "invade", "network")
make("flow", "flow", "packing")
make("forces", "force-protocol", "drying", "--set", "steps=5")
make("response", "dem-replay", "forces", *REPLAY, "--set", "bond.normal_strength=1e3",
     "--set", "keep_state=true")

READERS = {
    "packing": [["tessellate"], ["pack", "--set", "method=import"], ["flow"],
                ["flow", "--set", "write=forces", "--set", "solver=iteration"]],
    "degenerate": [["merge-nodes"]],
    "network": [["merge-nodes", "--set", "measure=mean_length", "--set", "threshold=1"], ["dry"],
                ["dry", "--set", "liquid=immobile", "--set", "kelvin=true"],
                ["dry", "--set", "liquid=viscous", "--set", "start_saturation=0.7",
                 "--set", "start_trapping=true", "--set", 'open=["+z","-x"]'],
                ["invade", "--set", "transport=true"],
                ["invade", "--set", "rule=nodes", "--set", "gravity=9.81"]],
    "drying": [["force-protocol", "--set", "steps=5"],
               ["force-protocol", "--set", "pressure=clusters", "--set", "largest_change=0.2",
                "--set", "form=faces", "--set", "rings.left=volume"],
               ["force-protocol", "-q", "--set", "pressure=field", "--set", "form=centres",
                "--set", "contact_angle=30", "--set", "rings.left=suction", "--set", "steps=5"],
               ["dry", "--set", "start_saturation=0.5"], ["crackstats", "response"],
               ["deform", "--set", "on_change=keep", "damaged", "response"]],
    "forces": [["dem-replay", *REPLAY], ["dem-replay", "-q", "--set", "engine=quasi-static"],
               ["dem-replay", *REPLAY, "--set", "bond.kind=contact",
                "--set", "bridges.volume=1e-22", "--set", "bridges.shared=true"]],
    "response": [["crackstats"], ["deform", "--set", "on_change=keep", "drying"],
                 ["dem-replay", *REPLAY, "forces"]],
    "invasion": [],
    "flow": [],
}
GOOD = {name: open(name, "rb").read() for name in READERS}


# ---- damage -----------------------------------------------------------------------------


def flip_bits(data, chance):
    for _ in range(chance.randint(1, 8)):
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)


def overwrite_block(data, chance):
    size = min(chance.choice([1, 2, 4, 8, 64, 512]), len(data) - 1)
    at = chance.randrange(len(data) - size)
    start = chance.randrange(len(data) - size)
    data[at : at + size] = chance.choice(
        [bytes(size), b"\xff" * size, chance.randbytes(size), data[start : start + size]]
    )


def cut_short(data, chance):
    del data[chance.randrange(len(data)) :]


def cut_out(data, chance):
    at = chance.randrange(len(data))
    del data[at : at + chance.choice([1, 8, 100])]


def damage_bytes(name, chance):
    data = bytearray(GOOD[name])
    how = chance.choice([flip_bits, overwrite_block] * 2 + [cut_short, cut_out])
    how(data, chance)
    with open("damaged", "wb") as file:
        file.write(data)
    return how.__name__


FLOATS = [0, -0.0, 1, -1, 1e-9, 1e9, 1e-150, 1e150, 1e-300, 1e300, 5e-324, 1.7e308, -1e300]
MODERATE = [x for x in FLOATS if x == 0 or 1e-150 <= abs(x) <= 1e150]
INTEGERS = [0, 1, 2, 3, 5, -1, -6, 255, 2**31 - 1, -(2**31)]


def damage_values(name, chance):
    """Values that a schema may allow and physics may not."""
    shutil.copy(name, "damaged")
    with h5py.File("damaged", "r+") as file:
        names = []
        file.visititems(
            lambda path, item: names.append(path)
            if isinstance(item, h5py.Dataset) and item.size and "VTK" not in path else None)
        said = []
        for _ in range(chance.randint(1, 3)):
            dataset = file[chance.choice(names)]
            where = tuple(chance.randrange(extent) for extent in dataset.shape)
            if chance.random() < 0.2:
                where = ...
            floating = dataset.dtype.kind == "f"
            old = dataset[...].flat[chance.randrange(dataset.size)]
            new = chance.choice([*(FLOATS if floating else INTEGERS), old, old])
            if not floating:
                limits = numpy.iinfo(dataset.dtype)
                new = min(max(int(new), limits.min), limits.max)
            dataset[where] = new
            said.append(f"{dataset.name}[{where}] = {new}")
    return "; ".join(said)


SCENE = {
    program: json.loads(subprocess.run([f"{BIN}/{program}", "--parameters"], check=True,
                                       stdout=subprocess.PIPE).stdout)
    for program in ["pack", "tessellate", "merge-nodes", "dry", "force-protocol", "dem-replay",
                    "crackstats", "invade", "flow"]
}
SCENE["pack"]["counts"] = [2, 2, 3]
SCENE["dry"]["boundary_layer"]["layers"] = 2
SCENE["force-protocol"]["steps"] = 5
SCENE["dem-replay"]["cycles"] = 20
ODD = [None, True, [], {}, "", "x", [1, 2, 3], [True, False, True], [-1, 0, 2], ["-z"],
       "fixed", "wall", "import", "immobile", "normal"]


def damage_parameters(program, chance):
    """Odd values for the keys of a section, or damage to its text."""
    section = json.loads(json.dumps(SCENE[program]))
    for _ in range(chance.randint(1, 3)):
        inner, key = section, chance.choice(list(section))
        if isinstance(inner[key], dict) and inner[key] and chance.random() < 0.9:
            inner = inner[key]
            key = chance.choice(list(inner))
        # integers stay small: a long run is not a hang
        integer = isinstance(inner[key], int)
        inner[key] = chance.choice(
            [chance.choice(MODERATE), *([chance.choice(range(-2, 9))] * (3 if integer else 1)),
             chance.choice(ODD)])
    text = bytearray(json.dumps(section).encode())
    if chance.random() < 0.3:
        chance.choice([flip_bits, overwrite_block, cut_short, cut_out])(text, chance)
    with open("p.json", "wb") as file:
        file.write(text)
    return bytes(text).decode(errors="replace")


# ---- what must hold ---------------------------------------------------------------------


def run(command):
    return subprocess.run([f"{BIN}/{command[0]}", *command[1:]], stdin=subprocess.DEVNULL,
                          capture_output=True, timeout=MOST_SECONDS)


def problems_of(command, output):
    try:
        done = run([*command, *(["-o", output] if output else [])])
    except subprocess.TimeoutExpired:
        return [f"{command}: still running after {MOST_SECONDS} s"]
    error = done.stderr.decode(errors="replace")
    found = []
    if done.returncode not in ALLOWED:
        found.append(f"{command}: exit status {done.returncode}: {error}")
    lines = len(error.splitlines())
    if (lines < 1) if "-p" in command and done.returncode else lines != bool(done.returncode):
        found.append(f"{command}: status {done.returncode} with {lines} lines: {error}")
    if done.returncode == 0 and output:
        read = run(["inspect", output])
        if read.returncode:
            found.append(f"{command}: wrote what cannot be read: {read.stderr.decode()}")
    return found


def try_all(kind, commands, how, k):
    """What went wrong, and how it was reached."""
    found = []
    for command in commands:
        if os.path.exists("written"):
            os.remove("written")
        found += problems_of(command, None if command[0] == "inspect" else "written")
    if found and KEEP:
        for name in ("damaged", "p.json"):
            if os.path.exists(name):
                shutil.copy(name, f"{KEEP}/{kind}-{k}-{name}")
    return [f"{k}: {how}: {problem}" for problem in found]


def damaged_files(damage, name):
    found = []
    for k in range(COUNT // 15):
        how = damage(name, random.Random(f"{damage.__name__} {name} {k}"))
        commands = [reader if "damaged" in reader else [*reader, "damaged"] for reader in READERS[name]]
        commands.append(["inspect", "damaged"])
        found += try_all(f"{damage.__name__}-{name}", commands, how, k)
    return found


def damaged_parameters(program):
    given = [name for name, readers in READERS.items() for reader in readers
             if reader[0] == program and program != "pack"]
    found = []
    for k in range(COUNT // 15):
        how = damage_parameters(program, random.Random(f"{program} {k}"))
        found += try_all(f"parameters-{program}", [[program, "-q", "-p", "p.json", *given[:1]]], how, k)
    return found


rows = [(f"{what} of {name} damaged at random are read or refused",
         lambda damage=damage, name=name: damaged_files(damage, name))
        for damage, what in ((damage_bytes, "bytes"), (damage_values, "values"))
        for name in READERS]
rows += [(f"odd parameters of {program} are taken or refused",
          lambda program=program: damaged_parameters(program)) for program in SCENE]
only = os.environ.get("FUZZ_ROWS", "")
print(f"1..{len(rows)}")
for number, (title, row) in enumerate(rows, 1):
    found = row() if only in title else []
    print(f"{'not ' if found else ''}ok {number} - {title}")
    for problem in found:
        print("#   " + problem.rstrip().replace("\n", "\n#   "))
    sys.stdout.flush()
