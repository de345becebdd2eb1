#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input (tests/refusals.py): parameters, in files and by --set."""
import json
import sys

sys.path.insert(0, "tests")
from refusals import (BAD_DATA, IO, NO_INPUT, READER, USAGE, contents, done, refused, setting,
                      text_file)


def parameters(title, program, section, *lines, status=BAD_DATA):
    content = section if isinstance(section, (str, bytes)) else json.dumps(section)
    given = [name for name, reader in READER.items() if reader == program]
    refused(title, status, [program, "-p", text_file("p.json", content),
                            *(given or (["network"] if program == "dry" else []))],
            *[f"p.json: {line}" for line in lines])


refused("missing parameters are named", NO_INPUT, ["pack", "-p", "nowhere.json"],
        "nowhere.json: No such file or directory")
refused("a directory as parameters is refused", IO, ["pack", "-p", "/tmp"],
        "/tmp: Is a directory")
parameters("empty parameters are not JSON", "pack", "", "line 1, column 0: .*")
parameters("a missing brace is named by line and column", "pack", '{\n"radius": 1,\n',
           "line 3, column 0: .*")
parameters("a missing comma is named by line and column", "pack",
           '{"radius": 1 "bonds": "none"}', "line 1, column 20: .*")
parameters("a number too large for a double is refused", "pack", '{"radius": 1e999}',
           "line 1, column 16: real number overflow.*")
parameters("NaN is not JSON", "pack", '{"radius": NaN}', "line 1, column 14: .*")
parameters("text that is not UTF-8 is refused", "pack", b'{"comment": "\xff"}',
           "line 1, column 13: unable to decode byte 0xff.*")
parameters("a null byte is refused", "pack", b'{"radius": 1}\0', "line 1, column 1[34]: .*")
parameters("braces without end are refused", "pack", '{"comment":' * 100000, "line 1, .*")
parameters("a list is not a section", "pack", "[1]", "must be a JSON object")
parameters("a packing is not a parameter file", "pack", contents("packing"),
           "line 1, column 0: .*")
parameters("a duplicate key is refused", "pack", '{"radius": 1, "radius": 2}',
           'line 1, column 22: duplicate object key.*')
parameters("an unknown key comes with the nearest known one", "pack", {"radios": 1},
           "pack.radios: unknown key; the nearest known one is radius")
parameters("an unknown nested key comes with the nearest known one", "dry",
           {"boundary_layer": {"layer": 1}},
           "dry.boundary_layer.layer: unknown key; "
           "the nearest known one is boundary_layer.layers")
parameters("a key with a line break gives one line", "pack", {"radius\nx": 1},
           r"pack.radius\?x: unknown key; the nearest known one is radius")
parameters("a key put in another group comes with where it belongs", "dem-replay",
           {"volume": 1, "bond": {"friction": 1}},
           "dem-replay.volume: unknown key; the nearest known one is bridges.volume",
           "dem-replay.bond.friction: unknown key; the nearest known one is friction")
parameters("a key like no other comes with none", "dem-replay", {"foo": 1},
           "dem-replay.foo: unknown key; --help lists those there are")
parameters("unknown sections of a scene are named", "pack",
           {"pack": {}, "packs": {}, "dem-repaly": {}},
           "packs: unknown section; the nearest stage is pack",
           "dem-repaly: unknown section; the nearest stage is dem-replay")
parameters("a section that is no object is refused", "pack", {"pack": 3},
           "pack: must be an object")
parameters("a number where a group belongs is refused", "dem-replay", {"bond": 3},
           "dem-replay.bond: must be an object, got 3")
parameters("a key with a dot is refused, not ignored", "pack", {"sizes.by": "mass"},
           r'pack.sizes.by: must be nested, {"a": {"b": ...}}: dots are for --set')
parameters("text where a number belongs is refused", "pack", {"radius": "1"},
           'pack.radius: must be a number, got "1"')
parameters("null where a number belongs is refused", "pack", {"radius": None},
           "pack.radius: must be a number, got null")
parameters("a fraction where an integer belongs is refused", "force-protocol",
           {"steps": 5.5}, r"force-protocol.steps: must be an integer, got 5\.5")
parameters("an integer's range is said to its last digit", "pack", {"seed": 2**32},
           "pack.seed: must be from 1 to 4294967295, got 4294967296")
parameters("a number where true or false belongs is refused", "dem-replay",
           {"allow_unstable": 1}, "dem-replay.allow_unstable: must be true or false, got 1")
parameters("an unknown choice lists the known ones", "dry", {"liquid": "solid"},
           r'dry.liquid: must be one of inviscid\|immobile\|viscous, got "solid"')
parameters("a wall that is none lists the six", "dry", {"open": ["+w"]},
           r'dry.open: must be one of -x\|\+x\|-y\|\+y\|-z\|\+z, got "\+w"')
parameters("a text where a list belongs is refused", "dry", {"open": "+z"},
           r'dry.open: must be a list of .*\+z, got "\+z"')
parameters("two counts are refused", "pack", {"counts": [5, 5]},
           r"pack.counts: must be three integers, got \[5,5\]")
parameters("flags that are numbers are refused", "pack", {"periodic": [0, 0, 1]},
           r"pack.periodic: must be three of true or false, got \[0,0,1\]")
parameters("a point of words is refused", "pack", {"lower": ["a", "b", "c"]},
           r'pack.lower: must be three numbers, got \["a","b","c"\]')
parameters("too long a list is refused", "dem-replay", {"snapshots": [0] * 1025},
           r"dem-replay.snapshots: must be a list of at most 1024 numbers, got \[[0,]+")
parameters("a negative radius is refused", "pack", {"radius": -1},
           "pack.radius: must be > 0 m, got -1")
parameters("a number whose square overflows is refused among parameters", "pack",
           {"radius": 1e200}, r"pack.radius: must be at most 1e150 in size, got \S+")
parameters("a count of zero is refused", "pack", {"counts": [5, 0, 5]},
           r"pack.counts: must be from 1 to 1e\+06, got \[5,0,5\]")
parameters("a number is repeated as it was written", "pack", {"radius": -0.1},
           "pack.radius: must be > 0 m, got -0.1")
parameters("a negative temperature is refused", "dry", {"temperature": -1},
           "dry.temperature: must be > 0 K, got -1")
parameters("no slices are refused", "crackstats", {"slices": 0},
           r"crackstats.slices: must be from 1 to 100000, got 0")
parameters("a threshold below zero is refused", "merge-nodes", {"threshold": -1e-3},
           r"merge-nodes.threshold: must be >= 0, got -0\.001")
parameters("one step is too few for a protocol", "force-protocol", {"steps": 1},
           r"force-protocol.steps: must be from 2 to 1e\+07, got 1")
parameters("two errors in one file are both reported", "pack", {"radius": -1, "bnods": "none"},
           "pack.bnods: unknown key; the nearest known one is bonds",
           "pack.radius: must be > 0 m, got -1")
parameters("four errors in a scene are all reported", "dry",
           {"dry": {"liquid": 1, "temperature": 0, "opened": [], "gas_pressure": "high"}},
           "dry.opened: unknown key; the nearest known one is open",
           r"dry.liquid: must be one of inviscid\|immobile\|viscous, got 1",
           "dry.temperature: must be > 0 K, got 0",
           'dry.gas_pressure: must be a number, got "high"')

setting("--set needs an equals sign", USAGE, "radius", "--set radius: must be KEY=VALUE")
setting("--set needs a key", USAGE, "=1", "--set =1: must be KEY=VALUE")
setting("--set refuses a value that is not UTF-8", USAGE, b"radius=\xff", r"--set radius=\S+: is not UTF-8")
setting("--set refuses a key that is not UTF-8", USAGE, b"\xff=1", r"--set \S+=1: is not UTF-8")
setting("--set refuses half an object", USAGE, "sizes={", r"--set sizes=\{: is not JSON: .+")
setting("--set refuses half a list", USAGE, "counts=[1,2", r"--set counts=\[1,2: is not JSON: .+")
setting("--set refuses an unknown key", BAD_DATA, "radiuss=1",
        "pack.radiuss: unknown key; the nearest known one is radius")
setting("--set says that keys go without the section", USAGE, "pack.radius=1",
        "--set pack.radius=1: must go without the section, radius=1")
setting("--set refuses a wrong type", BAD_DATA, "radius=wide",
        'pack.radius: must be a number, got "wide"')
setting("--set refuses what is out of range", BAD_DATA, "touching_gap=2",
        "pack.touching_gap: must be from 0 to 1, got 2")
setting("--set refuses a key below a number", BAD_DATA, "radius.x=2",
        r"pack.radius: must be a number, got {\"x\":2}")
for pressure in ["1e-308", "1e-200"]:
    setting("vapour so thin that time overflows is refused", BAD_DATA,
            f"saturation_pressure={pressure}",
            rf"network: saturation_pressure = {pressure} Pa, diffusivity = \S+ m2/s: the time in "
            r"which a throat dries must be from 1e-150 to 1e150 s, is \S+ s",
            program=("dry", "--quiet", "network"))
setting("a conductance that vanishes is refused", BAD_DATA, "conductance_factor=1e-300",
        r"flow.conductance_factor: must be from 1e-100 to 1e\+100, got 1e-300",
        program=("flow", "packing"))
for model in ["exact", "table", "weigert", "willett-full", "willett-reduced", "rabinovich",
              "rabinovich-lambert", "soulie"]:
    for radius in ["1e-120", "1e130"]:
        setting(f"volumes that overflow or vanish are refused by {model}", BAD_DATA,
                f"radius={radius}",
                r"volume must be from 1e-60 to 1e\+100 times the cube of the effective radius "
                r"\(1e[-+]1\d0 m\), is 1e-12 m3",
                program=("bridge", "--set", "volume=1e-12", "--set", f"model={model}"))
setting("a square lattice is one layer", BAD_DATA, "method=square",
        "pack.counts: a square lattice is one layer: must be 1 along y, got 5")
setting("too many grains are refused", BAD_DATA, "counts=[1000000,1000000,1000000]",
        "pack.counts: must make at most 1e8 grains")

done()
