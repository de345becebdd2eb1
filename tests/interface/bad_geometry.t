#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input (tests/refusals.py): grains, bodies and networks that cannot be."""
import sys

import numpy

sys.path.insert(0, "tests")
from refusals import (BAD_DATA, contents, damage, damaged, done, make, refused, removed, replaced,
                      value)

damage("a packing without grains is refused", "packing",
       lambda file: [replaced(name, lambda old: old[:0])(file) for name in
                     ("particles/position", "particles/radius", "bonds/particles")],
       "/particles/position: no grains")
damage("a grain outside the box is refused", "packing",
       value("particles/position", (4, 2), 7e-6),
       "/particles/position: row 4: the centre must be inside the box along z, between 0 "
       "and 1.5e-06 m from its lower side, is 7e-06 m from there")
damage("two grains in one place are refused", "packing",
       lambda file: value("particles/position", 4, file["particles/position"][3])(file),
       "/particles/position: row 4: has the same centre as row 3")
make("round", "pack", "--set", "method=poisson", "--set", "count=60", "--set", "bonds=none",
     *(word for key in ("shape=ring", "radius=1e-5", "inner_radius=4e-6", "height=2e-5")
       for word in ("--set", f"domain.{key}")))
for title, change, line in [
        ("a body of no shape that is known", value("domain/bodies/shape", 0, 4),
         "/domain/bodies/shape: row 0: must be <= 3, got 4"),
        ("a body of which grains are half within", value("domain/bodies/within", 1, 2),
         "/domain/bodies/within: row 1: must be <= 1, got 2"),
        ("a body without an upper corner", removed("domain/bodies/upper"),
         "/domain/bodies/upper: is missing"),
        ("a body upside down", value("domain/bodies/lower", (1, 2), 1),
         "/domain/bodies/lower: row 1: must be < /domain/bodies/upper"),
        ("a corner that is no number", value("domain/bodies/lower", (0, 1), numpy.nan),
         "/domain/bodies/lower: row 0: must be finite, got -?nan"),
        ("more bodies than are known",
         lambda file: [replaced(f"domain/bodies/{name}", lambda old: numpy.repeat(old, 2, 0))(file)
                       for name in ("shape", "within", "lower", "upper")],
         "/domain/bodies/shape: must have at most 3 rows, got 4"),
        ("one more shape than bodies", replaced("domain/bodies/shape", numpy.ones(3, "u1")),
         r"/domain/bodies/within: extent 0 must be n_body = 3, got 2"),
        ("a body far from its grains", value("domain/bodies/upper", 0, 1e-6),
         "/particles/position: row 0: the centre must be in the cylinder of /domain/bodies: "
         "row 0, is at .* m"),
        ("a round wall where the box repeats", value("domain/periodic", 0, 1),
         "/domain/periodic: row 0: must be 0 where the wall around the grains is round")]:
    refused(f"{title} is refused", BAD_DATA, ["tessellate", damaged("round", change)],
            f"damaged: {line}")
refused("void volumes within a round wall", BAD_DATA,
        ["tessellate", "--set", "throat_volume=void", "round"],
        r"round: tessellate\.throat_volume: void must go with flat walls, .* \(pack\.domain\): leave it "
        "out, or say cylinder")
make("periodic", "pack", "--set", "method=poisson", "--set", "count=60", "--set", "bonds=none",
     "--set", "upper=[4e-6,4e-6,4e-6]", "--set", "periodic=[true,true,true]")
make("periodic-network", "tessellate", "periodic")
refused("a box that repeats has no open wall", BAD_DATA,
        ["dry", "--set", "throat_radius.distribution=normal", "periodic-network"],
        r"periodic-network: /domain/periodic: the open wall cannot be on an axis .*, z: open another "
        r"side, or cut the body across z by pack\.slab\.lower and pack\.slab\.upper")
for program in "dry", "invade":
    refused(f"{program} refuses a mean of radii that are not drawn", BAD_DATA,
            [program, "--set", "throat_radius.mean=2e-7", "network"],
            rf"{program}\.throat_radius\.mean: must be left out with "
            r"throat_radius\.distribution=network, got 2e-7")
make("of-default-radii", "dry", "network", "--set", "throat_radius.mean=103e-9",
     "--set", "throat_radius.seed=1.0")
make("one-cell", "pack", "--set", "method=cubic", "--set", "counts=[1,1,3]",
     "--set", "periodic=[true,true,false]")
make("one-cell-network", "tessellate", "one-cell")
make("one-cell-merged", "merge-nodes", "one-cell-network")
refused("dry refuses boxes that repeat after one node", BAD_DATA, ["dry", "one-cell-merged"],
        r"one-cell-merged: /throats/nodes: row \d+: both ends are node 0")
refused("a box too narrow to be merged away", BAD_DATA,
        ["merge-nodes", "--set", "measure=absolute", "--set", "threshold=1",
         damaged("periodic-network", value("throats/image", slice(None), 3))],
        r"damaged: /domain/upper: the box is too narrow for merging so much.*")
refused("dry sends throats of no length to merge-nodes", BAD_DATA, ["dry", "degenerate"],
        r"degenerate: /throats/length: row \d+: must be above 0, is [\de.-]+ "
        r"\(merge-nodes removes short throats\)")
refused("dry refuses networks with all throats closed", BAD_DATA,
        ["dry", damaged("network", value("throats/radius", slice(None), 0))],
        r"damaged: /throats/kind: no throat holds liquid, there is nothing to dry.*")
damage("a face without throats along it is refused", "drying",
       lambda file: value("faces/nodes", 1, (file["faces/nodes"][1] + 17) % 36)(file),
       r"/faces/nodes: face 0: no throat between nodes \d+ and \d+")
damage("a wall as the first side of a face is refused", "drying",
       value("faces/particles", (5, 0), -3),
       "/faces/particles: row 5: the first side must be a grain, got -3")
damage("a drying that takes no time is refused", "drying",
       value("history/time", slice(None), 0), "/history/time: must end above 0, got 0")
damage("a node in the centre of a grain is refused", "drying",
       lambda file: value("particles/position", file["faces/particles"][0, 0],
                          file["nodes/position"][file["faces/nodes"][0]])(file),
       r"/throats/nodes: throat \d+ meets the centre of grain \d+")
refused("forces that overflow are refused", BAD_DATA,
        ["force-protocol", "drying", "--set", "surface_tension=1e150"],
        r"drying: the forces overflow at a capillary pressure of \S+ Pa and force_scale = 1")
refused("a box far too small for its grains is refused", BAD_DATA,
        ["pack", "--set", "method=import", "--set", "check=none",
         damaged("packing", value("domain/upper", 0, 1e-100))],
        r"the box is too small for its grains: the porosity is -\S+")
damage("a drying without steps is refused", "drying",
       lambda file: [replaced(f"history/{name}", lambda old: old[:0])(file) for name in
                     ("time", "saturation", "rate", "normalised_rate", "clusters")] +
       [replaced("changes/offset", numpy.zeros(1, "i8"))(file)] +
       [replaced(f"changes/{name}", lambda old: old[:0])(file)
        for name in ("throat", "saturation")],
       "/history/time: must have at least one row")
make("smaller", "pack", "--set", "counts=[2,2,2]")
for before, after, command in [("smaller", "a", ["tessellate"]), ("a", "b", ["merge-nodes"]),
                               ("b", "c", ["dry"]),
                               ("c", "d", ["force-protocol", "--set", "steps=5"]),
                               ("d", "e", ["dem-replay", "-q", "--set", "time_step_safety=0.02",
                                           "--set", "cycles=5"])]:
    make(after, *command, before)
refused("responses of two studies are not counted together", BAD_DATA,
        ["crackstats", "response", "e"],
        "e: has 12 bonds, the runs before have 20: not one study "
        r"\(same_bonds=false takes runs of other packings\)")
refused("the same artifact twice from one pipe is refused", BAD_DATA,
        ["crackstats", "-", "-"], "standard input: is empty", input=contents("response"))

done()
