#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input: the right exit status, and one line that names the file, the dataset or key,
the row, the rule and the value. Nothing goes to standard output, and what stood at the
output before is still there, alone, byte for byte.

One call of refused() is one row of the table.
"""
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy

BIN = os.environ["BIN"]
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


# ---- good artifacts, and what is done to them -------------------------------------------


def make(name, *command):
    subprocess.run([f"{BIN}/{command[0]}", *command[1:], "-o", name], check=True)


make("packing", "pack", "--set", "counts=[2,2,3]")
make("degenerate", "tessellate", "packing")
make("network", "merge-nodes", "degenerate")
make("drying", "dry", "network")
make("forces", "force-protocol", "drying", "--set", "steps=5")
make("response", "dem-replay", "forces", "--set", "time_step_safety=0.02", "--set", "cycles=100",
     "--set", "bond.normal_strength=1e3")
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


# ---- not an artifact --------------------------------------------------------------------

refused("text is not an artifact", BAD_DATA,
        ["tessellate", text_file("text", "1 2 3 4\n")], "text: is not an HDF5 file")
refused("an empty file is not an artifact", BAD_DATA,
        ["tessellate", text_file("empty", "")], "empty: is empty")
refused("three bytes are not an artifact", BAD_DATA,
        ["tessellate", text_file("short", b"\x89HD")], "short: is not an HDF5 file")
refused("an input without end is refused", BAD_DATA, ["crackstats", "/dev/zero"],
        "/dev/zero: is not an HDF5 file")
refused("a signature alone is not an artifact", BAD_DATA,
        ["tessellate", text_file("signature", b"\x89HDF\r\n\x1a\n")],
        "signature: is a truncated or damaged HDF5 file")
noise = numpy.random.default_rng(1).bytes(5000)
refused("random bytes behind a signature are not an artifact", BAD_DATA,
        ["tessellate", text_file("noise", b"\x89HDF\r\n\x1a\n" + noise)],
        "noise: is a truncated or damaged HDF5 file")
broken = bytearray(contents("packing"))
at = broken.rindex(broken.index(b"HEAP").to_bytes(8, "little"))  # where the names are
broken[at : at + 8] = b"\xff" * 8
refused("an address that makes the HDF5 library crash is refused", BAD_DATA,
        ["tessellate", text_file("broken", bytes(broken))], "broken: .*",
        env=os.environ | {"ASAN_OPTIONS": "handle_segv=0"})  # the crash is not ours
for kind, reader in READER.items():
    whole = contents(kind)
    for cut in (60, 800, len(whole) // 2, len(whole) - 1):
        refused(f"{reader} refuses its input cut to {cut} of {len(whole)} bytes", BAD_DATA,
                [reader, text_file("cut", whole[:cut])],
                "cut: is a truncated or damaged HDF5 file")
refused("inspect refuses a truncated artifact", BAD_DATA,
        ["inspect", text_file("cut", contents("drying")[:-9])],
        "cut: is a truncated or damaged HDF5 file", output=())
refused("pack refuses to import a truncated artifact", BAD_DATA,
        ["pack", "--set", "method=import", text_file("cut", contents("packing")[:-9])],
        "cut: is a truncated or damaged HDF5 file")
refused("truncated input is refused from a pipe as well", BAD_DATA, ["merge-nodes"],
        "standard input: is a truncated or damaged HDF5 file",
        input=contents("network")[:-9])
refused("an empty pipe is refused", BAD_DATA, ["merge-nodes", "-"],
        "standard input: is empty", input=b"")
refused("a missing input is named", NO_INPUT, ["tessellate", "nowhere.h5"],
        "nowhere.h5: No such file or directory")
refused("an input below a file is named", NO_INPUT, ["tessellate", "packing/inner.h5"],
        "packing/inner.h5: Not a directory")
refused("a directory as input is refused", IO, ["tessellate", "/tmp"],
        "/tmp: Is a directory")
refused("inspect names a missing input", NO_INPUT, ["inspect", "nowhere.h5"],
        "nowhere.h5: No such file or directory", output=())
refused_in_shell("a closed standard input is refused", IO, "$BIN/tessellate -o out/result <&-",
                 "tessellate: standard input: Bad file descriptor")

# ---- another artifact -------------------------------------------------------------------

for reader, given in [("tessellate", "network"), ("merge-nodes", "packing"),
                      ("dry", "packing"), ("force-protocol", "forces"),
                      ("dem-replay", "drying"), ("crackstats", "forces"),
                      ("invade", "drying")]:
    wanted = {"dry": "network", "invade": "network"} | {r: name for name, r in READER.items()}
    refused(f"{reader} refuses a {given}", BAD_DATA, [reader, given],
            f"{given}: must be a {wanted[reader]}, is a {given}")
refused("a JSON artifact is not an HDF5 file", BAD_DATA, ["crackstats", "crackstats"],
        "crackstats: is not an HDF5 file; parameters, in JSON, go by -p")
damage("an unknown schema is named", "packing",
       attribute("/", "schema", "craquelure/soup/1"), "schema craquelure/soup/1 is unknown")
damage("a later version of a schema is refused", "packing",
       attribute("/", "schema", "craquelure/packing/2"),
       "schema craquelure/packing/2 is unknown; this program knows craquelure/packing/1")
damage("a file without a schema is not an artifact", "packing",
       attribute("/", "schema", None), "is not an artifact: it has no schema attribute")
damage("a schema that is a number is none", "packing", attribute("/", "schema", 7),
       "is not an artifact: it has no schema attribute")
damage("a schema with a line break gives one line", "packing",
       attribute("/", "schema", "a\nb"), r"schema a\?b is unknown")

# ---- numbers that are none --------------------------------------------------------------

damage("NaN in a position is named by its row", "packing",
       value("particles/position", (3, 1), numpy.nan),
       "/particles/position: row 3: must be finite, got -?nan")
damage("an infinite radius is named by its row", "packing",
       value("particles/radius", 5, numpy.inf),
       "/particles/radius: row 5: must be finite, got inf")
damage("an infinite length is named by its row", "network",
       value("throats/length", 74, -numpy.inf),
       "/throats/length: row 74: must be finite, got -inf")
damage("NaN in a force is named by its time", "forces",
       value("force", (2, 7, 0), numpy.nan), "/force: row 2: must be finite, got -?nan")
damage("NaN in the summary is named", "response",
       attribute("summary", "first_period_end_time", numpy.nan),
       "/summary/first_period_end_time: .*must be finite, got -?nan")

damage("a number whose square overflows is refused", "network",
       value("nodes/position", (9, 2), -1e200),
       r"/nodes/position: row 9: must be at most 1e150 in size, got -1e\+200")

# ---- values out of range ----------------------------------------------------------------

damage("a negative radius is refused", "packing", value("particles/radius", 4, -1e-9),
       r"/particles/radius: row 4: must be > 0, got -1\.0\d*e-09")
damage("a radius of zero is refused", "packing", value("particles/radius", 11, 0),
       "/particles/radius: row 11: must be > 0, got 0")
damage("a bond to a grain that is not there is refused", "packing",
       value("bonds/particles", (6, 1), 12),
       r"/bonds/particles: row 6: must be < 12 \(n_particle\), got 12")
damage("a negative index is refused", "packing", value("bonds/particles", (0, 0), -1),
       "/bonds/particles: row 0: must be >= 0, got -1")
damage("the largest index is refused", "packing",
       value("bonds/particles", (19, 1), 2**31 - 1),
       r"/bonds/particles: row 19: must be < 12 \(n_particle\), got 2147483647")
damage("an index too large for its type is refused, not wrapped", "packing",
       replaced("bonds/particles", lambda old: old.astype("i8") + 2**32),
       r"/bonds/particles: row 0: must be < 12 \(n_particle\), got 42949672\d\d")
damage("a bond with the higher grain first is refused", "packing",
       value("bonds/particles", 2, [5, 4]),
       "/bonds/particles: row 2: the lower index must come first, got 5, 4")
damage("a bond of a grain with itself is refused", "packing",
       value("bonds/particles", 2, [5, 5]),
       "/bonds/particles: row 2: the lower index must come first, got 5, 5")
damage("a box upside down is refused", "packing",
       value("domain/lower", 2, 1),
       r"/domain/lower: row 2: must be < /domain/upper = 1\.\d+e-06, got 1")
damage("a box too thin for its area to be a number is refused", "packing",
       lambda file: [value("domain/lower", 0, 0)(file), value("domain/upper", 0, 5e-324)(file)],
       "/domain/lower: row 0: must be 1e-150 or more below /domain/upper")
damage("a flag that is neither 0 nor 1 is refused", "packing", value("domain/periodic", 1, 2),
       "/domain/periodic: row 1: must be <= 1, got 2")
damage("a negative overlap in the summary is refused", "packing",
       attribute("summary", "max_overlap", -1.0),
       "/summary/max_overlap: .*must be >= 0, got -1")
damage("a throat to a node that is not there is refused", "network",
       value("throats/nodes", (10, 1), 36),
       r"/throats/nodes: row 10: must be < 36 \(n_node\), got 36")
damage("a throat from a node to itself is refused", "network",
       value("throats/nodes", 10, (5, 5)),
       "/throats/nodes: row 10: the lower index must come first, got 5, 5")
damage("a negative throat radius is refused", "network", value("throats/radius", 3, -1),
       "/throats/radius: row 3: must be >= 0, got -1")
damage("an unknown kind of throat is refused", "network", value("throats/kind", 9, 3),
       "/throats/kind: row 9: must be <= 2, got 3")
damage("an unknown wall is refused", "network", value("nodes/kind", 1, 64),
       "/nodes/kind: row 1: is on the wall of no body of /domain/bodies, got 64")
damage("a face of a seventh wall is refused", "network",
       value("faces/particles", (8, 1), -7),
       "/faces/particles: row 8: is on the wall of no body of /domain/bodies, got -7")
damage("a face of a ninth wall is refused", "network", value("faces/particles", (8, 1), -9),
       "/faces/particles: row 8: must be >= -8, got -9")
damage("a face of a grain that is not there is refused", "network",
       value("faces/particles", (8, 1), 12),
       r"/faces/particles: row 8: must be < 12 \(n_particle\), got 12")
damage("a face around a node that is not there is refused", "network",
       value("faces/nodes", 100, 99), r"/faces/nodes: row 100: must be < 36 \(n_node\), got 99")
damage("offsets that do not begin at zero are refused", "network",
       value("faces/offset", 0, 1), "/faces/offset: row 0: must be = 0, got 1")
damage("offsets that fall are refused", "network", value("faces/offset", 7, 0),
       r"/faces/offset: row 7: must be >= \d+, got 0")
damage("offsets that run past their target are refused", "network",
       value("faces/offset", 52, 300), "/faces/nodes: extent 0 must be n_face_node = 300, got 208")
damage("a time that runs backwards is refused", "drying", value("history/time", 9, 0),
       r"/history/time: row 9: must be >= [\d.e-]+, got 0")
damage("a saturation above one is refused", "drying", value("history/saturation", 2, 1.5),
       r"/history/saturation: row 2: must be <= 1, got 1\.5")
damage("a change in a throat that is not there is refused", "drying",
       value("changes/throat", 561, 75),
       r"/changes/throat: row 561: must be < 75 \(n_throat\), got 75")
damage("an event in a negative throat is refused", "drying", value("events/throat", 3, -1),
       "/events/throat: row 3: must be >= 0, got -1")
damage("two equal times of a protocol are refused", "forces", value("time", 1, 0),
       "/time: row 1: must be > 0, got 0")
damage("an unknown mode of failure is refused", "response", value("cracks/mode", 0, 2),
       "/cracks/mode: row 0: must be <= 1, got 2")
damage("a crack in a bond that is not there is refused", "response",
       value("cracks/bond", 0, 20), r"/cracks/bond: row 0: must be < 20 \(n_bond\), got 20")

# ---- shapes, counts, types --------------------------------------------------------------

damage("positions in the plane are refused", "packing",
       replaced("particles/position", lambda old: old[:, :2]),
       "/particles/position: extent 1 must be 3, got 2")
damage("a radius in a table is refused", "packing",
       replaced("particles/radius", lambda old: old[:, None]),
       "/particles/radius: must have rank 1, got 2")
damage("a single number where a list belongs is refused", "packing",
       replaced("particles/radius", 1e-6), "/particles/radius: must have rank 1, got 0")
damage("a box of four extents is refused", "packing",
       replaced("domain/upper", numpy.ones(4)),
       "(/domain/upper: must have 3 values|/domain/upper: extent 0 must be 3, got 4)")
damage("fewer radii than positions are refused", "packing",
       replaced("particles/radius", lambda old: old[:-1]),
       "/particles/radius: extent 0 must be n_particle = 12, got 11")
damage("more lengths than throats are refused", "network",
       replaced("throats/length", lambda old: numpy.append(old, 1)),
       "/throats/length: extent 0 must be n_throat = 75, got 76")
damage("offsets of one face too few are refused", "network",
       replaced("faces/offset", lambda old: numpy.append(old[:-2], old[-1])),
       "/faces/particles: extent 0 must be n_face = 51, got 52")
damage("no offsets at all are refused", "network",
       replaced("faces/offset", numpy.zeros(0, "i8")),
       "/faces/offset: must have at least one row")
damage("forces on more grains than there are are refused", "forces",
       replaced("force", lambda old: numpy.append(old, old[:, :1], axis=1)),
       "/force: extent 1 must be n_particle = 12, got 13")
damage("cracks without their modes are refused", "response",
       replaced("cracks/mode", lambda old: old[1:]),
       r"/cracks/mode: extent 0 must be n_crack = \d+, got \d+")
damage("a missing dataset is named", "packing", removed("particles/radius"),
       "/particles/radius: is missing")
damage("a missing group is named by its first dataset", "network", removed("faces"),
       "/faces/offset: is missing")
damage("a link to nowhere counts as missing", "packing",
       lambda file: (file.__delitem__("particles/radius"),
                     file.__setitem__("particles/radius", h5py.SoftLink("/nowhere"))),
       "/particles/radius: is missing")


def borrowed(how):
    """The radii stand in another file."""

    def change(file):
        shape = file["particles/radius"].shape
        del file["particles/radius"]
        how(file, shape)

    return change


def virtual(file, shape):
    layout = h5py.VirtualLayout(shape, "f8")
    layout[:] = h5py.VirtualSource("packing", "particles/radius", shape=shape)
    file.create_virtual_dataset("particles/radius", layout)


for way, how in {
        "an external link": lambda file, shape: file.__setitem__(
            "particles/radius", h5py.ExternalLink("packing", "/particles/radius")),
        "external storage": lambda file, shape: file.create_dataset(
            "particles/radius", shape, "f8", external=[("packing", 0, h5py.h5f.UNLIMITED)]),
        "a virtual dataset": virtual}.items():
    damage(f"{way} is refused", "packing", borrowed(how),
           "/particles/radius: lies in another file")
damage("a group where a dataset belongs counts as missing", "packing",
       lambda file: (file.__delitem__("particles/radius"),
                     file.create_group("particles/radius")),
       "/particles/radius: is missing")
damage("a missing attribute is named", "packing", attribute("summary", "porosity", None),
       "/summary/porosity: is missing")
damage("text where a number belongs is refused", "packing",
       attribute("summary", "porosity", "half"), "/summary/porosity: must be one number")
damage("two numbers where one belongs are refused", "packing",
       attribute("summary", "porosity", [0.4, 0.5]), "/summary/porosity: must be one number")
damage("integers where lengths belong are refused", "packing",
       replaced("particles/radius", lambda old: numpy.ones(12, "i4")),
       "/particles/radius: must hold floating-point numbers")
damage("floating-point indices are refused", "packing",
       replaced("bonds/particles", lambda old: old.astype("f8")),
       "/bonds/particles: must hold integers")
damage("text in a dataset of numbers is refused", "packing",
       replaced("particles/radius", numpy.array([b"1"] * 12)),
       "/particles/radius: must hold floating-point numbers")


def enormous(file):
    del file["particles/position"], file["particles/radius"]
    file.create_dataset("particles/position", (10**9, 3), "f8", chunks=(1000, 3))
    file.create_dataset("particles/radius", (10**9,), "f8", chunks=(1000,))


damage("a dataset larger than its file can hold is refused", "packing", enormous,
       r"/particles/position: claims 3e\+09 values in a file of \d+ bytes")

# ---- grains and networks that cannot be -------------------------------------------------

damage("a packing without grains is refused", "packing",
       lambda file: [replaced(name, lambda old: old[:0])(file) for name in
                     ("particles/position", "particles/radius", "bonds/particles")],
       "/particles/position: no grains")
damage("a grain outside the box is refused", "packing",
       value("particles/position", (4, 2), 7e-6),
       "/particles/position: row 4: the centre must be inside the box along z, from 0 to 3, "
       r"got 14, in units of 5e-07 m")
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
make("periodic", "pack", "--set", "method=poisson", "--set", "count=60", "--set", "bonds=none",
     "--set", "upper=[4e-6,4e-6,4e-6]", "--set", "periodic=[true,true,true]")
make("periodic-network", "tessellate", "periodic")
refused("a box that repeats has no open wall", BAD_DATA,
        ["dry", "--set", "throat_radius.distribution=normal", "periodic-network"],
        r"periodic-network: /domain/periodic: the open wall cannot be on an axis .*")
for program in "dry", "invade":
    refused(f"{program} refuses a mean of radii that are not drawn", BAD_DATA,
            [program, "--set", "throat_radius.mean=2e-7", "network"],
            rf"{program}\.throat_radius\.mean: must be left out with "
            r"throat_radius\.distribution=network, got 2e-07")
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
refused("dry refuses throats of no radius", BAD_DATA,
        ["dry", damaged("network", value("throats/radius", 7, 0))],
        r"damaged: /throats/radius: row 7: must be above 0, is 0 .*")
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
        ["pack", "--set", "method=import",
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
                               ("d", "e", ["dem-replay", "--set", "time_step_safety=0.02",
                                           "--set", "cycles=5"])]:
    make(after, *command, before)
refused("responses of two studies are not counted together", BAD_DATA,
        ["crackstats", "response", "e"],
        "e: has 12 bonds, the runs before have 20: not one study "
        r"\(same_bonds=false takes runs of other packings\)")
refused("the same artifact twice from one pipe is refused", BAD_DATA,
        ["crackstats", "-", "-"], "standard input: is empty", input=contents("response"))

# ---- imported text ----------------------------------------------------------------------


def imported(title, content, line, *settings):
    refused(title, BAD_DATA,
            ["pack", "--set", "method=import", *settings, text_file("grains", content)],
            f"grains: {line}" if not settings else line)


imported("a line of three numbers is named", "0 0 0 1\n3 0 0\n",
         "line 2: must be four numbers, x y z r, or a comment, #")
imported("a line of five numbers is named", "# grains\n\n0 0 0 1 1\n",
         "line 3: must be four numbers, x y z r, or a comment, #")
imported("letters among the grains are refused", "0 0 0 1\n0 0 zero 1\n",
         "line 2: must be four numbers, x y z r, or a comment, #")
imported("the names of columns want a #", "x,y,z,r\n0,0,0,1\n",
         "line 1: must be four numbers, x y z r, or a comment, #")
imported("a negative radius in a text is refused", "0 0 0 -1\n",
         "line 1: the radius must be > 0 m, got -1")
imported("a radius of zero in a text is refused", "0 0 0 0\n",
         "line 1: the radius must be > 0 m, got 0")
imported("NaN in a text is refused", "0 nan 0 1\n", "line 1: must be finite, got -?nan")
imported("a number too large is refused", "1e999 0 0 1\n", "line 1: must be finite, got inf")
imported("null bytes in a text are refused", b"0 0 0 1\n\0\0\0",
         "holds null bytes: neither text nor HDF5")
imported("a text of comments holds no grains", "# x y z r\n\n", "no grains")
imported("an empty text holds no grains", "", "no grains")
refused("an import without an input says where grains come from", BAD_DATA,
        ["pack", "--set", "method=import"],
        "standard input: no grains: method=import takes them from an input, make run from "
        "IMPORT=FILE")
imported("a box upside down is refused at import", "0 0 0 1\n",
         "pack.upper: must be above pack.lower = -1 m along z, got -2",
         "--set", "upper=[1,1,-2]")
refused("an import of a network is refused", BAD_DATA,
        ["pack", "--set", "method=import", "network"],
        "network: must be a packing, is a network")

# ---- imported dumps ---------------------------------------------------------------------


def dump(*rows, columns="id x y z radius", box="BOX BOUNDS pp ff ff", bounds=("0 9",) * 3,
         count=2):
    lines = ["ITEM: TIMESTEP", "0", "ITEM: NUMBER OF ATOMS", count, f"ITEM: {box}", *bounds,
             f"ITEM: ATOMS {columns}", *rows, ""]
    return "\n".join(map(str, lines))


good = dump("1 1 1 1 1", "2 4 4 4 1")
imported("a dump without radii is refused", dump("1 1 1 1", "2 4 4 4", columns="id x y z"),
         "line 9: must be ITEM: ATOMS with a column radius or diameter")
imported("a dump without places is refused",
         dump("1 1 1", "2 4 4", columns="id x radius"),
         r"line 9: must be ITEM: ATOMS with columns x, y and z \(or xu, xs, xsu\)")
imported("a dump with places scaled in part is refused",
         dump("1 1 1 1 1", "2 4 4 4 1", columns="id xs y z radius"),
         "line 9: must be ITEM: ATOMS with all places scaled, or none")
imported("a dump of a tilted box is refused",
         dump("1 1 1 1 1", box="BOX BOUNDS xy xz yz pp pp pp", bounds=("0 9 1",) * 3),
         "line 5: must be a straight box, .*")
imported("a dump with a box upside down is refused", dump(bounds=("0 9", "9 0", "0 9")),
         "line 7: must be the box, a lower and an upper bound")
imported("a dump that ends too early is refused", dump("1 1 1 1 1"),
         "line 11: must be a grain: fewer than ITEM: NUMBER OF ATOMS says")
imported("a dump that ends before its grains is refused", "ITEM: TIMESTEP\n0\n",
         "ends before the grains of the frame")
imported("a dump without a frame is refused", "ITEM: UNITS\nsi\n",
         'no "ITEM: TIMESTEP" line')
imported("a row of a dump that is too short is refused", dump("1 1 1 1 1", "2 4 4"),
         "line 11: must be a value for each column")
imported("a word for a number in a dump is refused", dump("1 1 1 1 1", "2 4 four 4 1"),
         "line 11: must be finite numbers")
imported("a radius of zero in a dump is refused", dump("1 1 1 1 1", "2 4 4 4 0"),
         "line 11: the radius must be > 0 m, got 0")
imported("an id twice in a dump is refused", dump("7 1 1 1 1", "7 4 4 4 1"),
         "two grains have the same id")
imported("a count of atoms that is none is refused", dump(count="many"),
         "line 4: must be the number of atoms, from 1 to 1e8")
imported("a count of atoms that lies is refused", dump("1 1 1 1 1", count=99999999),
         "line 11: must be a grain: fewer than .*")
for settings, line in [
        (["frame=1"], "grains: pack.frame: must be below 1, the frames there are, got 1"),
        (["frame=-2"], r"pack.frame: must be from -1 to 1e\+12, got -2"),
        (["domain.cut.shape=box"],
         "pack.domain.shape: must be box, and nothing cut out, for import")]:
    imported(f"a dump with {settings[0]} is refused", good, line, "--set", *settings)

# ---- parameters -------------------------------------------------------------------------


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


def setting(title, status, assignment, *lines, program=("pack",)):
    refused(title, status, [program[0], "--set", assignment, *program[1:]], *lines)


setting("--set needs an equals sign", USAGE, "radius", "--set radius: must be KEY=VALUE")
setting("--set needs a key", USAGE, "=1", "--set =1: must be KEY=VALUE")
setting("--set refuses a value that is not UTF-8", USAGE, b"radius=\xff", r"--set radius=\S+: is not UTF-8")
setting("--set refuses a key that is not UTF-8", USAGE, b"\xff=1", r"--set \S+=1: is not UTF-8")
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
setting("a square lattice is one layer", BAD_DATA, "method=square",
        "pack.counts: a square lattice is one layer: must be 1 along y, got 5")
setting("too many grains are refused", BAD_DATA, "counts=[1000000,1000000,1000000]",
        "pack.counts: must make at most 1e8 grains")


def scene(title, words, *lines, status=BAD_DATA):
    """pack with WORDS, assignments between blanks."""
    refused(title, status, ["pack", *(w for word in words.split() for w in ("--set", word))],
            *lines)


drawn, ring = "method=random_sequential", "method=poisson count=9 domain.shape=ring"
scene("a lattice of unequal grains is refused", "sizes.distribution=normal",
      "pack.sizes.distribution: must be one for a lattice")
scene("a lattice in space has no plane", "method=bcc dimensions=2",
      r"pack.dimensions: must be 3 for this lattice \(two dimensions: square, hexagonal, honeycomb\)")
scene("a triangular lattice of several layers is refused", "method=hexagonal dimensions=2",
      "pack.counts: a triangular lattice is one layer: must be 1 along y, got 5")
scene("a lattice that does not fit its periodic box is refused",
      "method=fcc radius=1 upper=[9,9,9] periodic=[true,false,false]",
      r"pack.upper: must leave a whole number of lattice cells of \S+ m along x, which "
      r"repeats, leaves 3.18\d+")
scene("a lattice of too many grains for its box is refused", "upper=[1,1,1]",
      "pack.radius: must make at most 1e8 grains")
scene("a lattice that is all cut away is refused",
      "radius=1 counts=[2,2,2] domain.cut.shape=sphere domain.cut.radius=2",
      "pack.domain.shape: must leave room for at least one grain of the lattice")
scene("a box must be given to fill", drawn, "pack.upper: must be given: the box to fill")
scene("a box upside down cannot be filled", f"{drawn} upper=[1,-1,1]",
      "pack.upper: must be above pack.lower = 0 m along y, got -1")
scene("a box too narrow for a grain is refused", f"{drawn} radius=1 upper=[9,1.9,9]",
      "pack.upper: must leave room for a grain of radius 1 m, is 1.9 m wide along y")
scene("a box too narrow for its largest grain is refused",
      f"{drawn} upper=[1,1,1] sizes.distribution=uniform sizes.smallest=0.1 "
      "sizes.largest=0.6",
      "pack.upper: must leave room for a grain of radius 0.6 m, is 1 m wide along x")
scene("more grains than the box has room for are refused at once",
      f"{drawn} radius=1 upper=[9,9,9] count=1000",
      "pack.count: must be fewer: 1000 grains would fill 5.75 of the domain, at most 1 can be")
scene("grains that find no place are counted",
      f"{drawn} radius=1 upper=[9,9,9] count=150 most_trials=100",
      r"only \d+ of 150 grains fit, a solid share of 0\.\d+: 100 trials in a row found no "
      r"place \(pack.most_trials\)", status=UNSTABLE)
scene("random points need their count", "method=poisson upper=[1,1,1]",
      "pack.count: must be given for poisson")
scene("a ring without a radius is refused", ring,
      "pack.domain.radius: must be given, for this shape")
scene("a ring without a height is refused", f"{ring} domain.radius=1",
      "pack.domain.height: must be given, for this shape")
scene("a ring inside out is refused",
      f"{ring} domain.radius=1 domain.height=1 domain.inner_radius=1",
      "pack.domain.inner_radius: must be given and below pack.domain.radius = 1 m, for a ring")
scene("a ring too narrow for a grain is refused",
      f"{ring} domain.radius=1 domain.height=1 domain.inner_radius=0.5 radius=0.3",
      "pack.domain.inner_radius: must leave room for a grain of radius 0.3 m, leaves 0.5 m")
scene("a cylinder too low for a grain is refused",
      "method=fcc radius=1 domain.shape=cylinder domain.radius=9 domain.height=1",
      "pack.domain.height: must leave room for a grain of radius 1 m, is 1 m wide along z")
scene("a cylinder in the plane is refused",
      f"{drawn} dimensions=2 domain.shape=cylinder",
      r"pack.domain.shape: must be box or sphere \(a disc\) in two dimensions")
scene("a round wall does not repeat",
      f"{drawn} domain.shape=sphere domain.radius=1 periodic=[false,false,true]",
      "pack.periodic: must be false where the wall is round")
scene("a cut that sticks out is refused",
      f"{drawn} upper=[1,1,1] domain.cut.shape=sphere domain.cut.radius=0.51",
      r"pack.domain.cut.shape: must lie wholly inside the domain \(a cylinder may go from "
      r"bottom to top\)")
scene("a cut without a radius is refused", f"{drawn} upper=[1,1,1] domain.cut.shape=cylinder",
      "pack.domain.cut.radius: must be given, for this cut")
scene("a box cut out needs its corners", f"{drawn} upper=[1,1,1] domain.cut.shape=box",
      "pack.domain.cut.upper: must be given and above pack.domain.cut.lower along x")
scene("a cylinder is not cut out of a plane",
      f"{drawn} upper=[1,1,1] dimensions=2 domain.cut.shape=cylinder domain.cut.radius=0.1",
      r"pack.domain.cut.shape: must be none, box or sphere \(a disc\) in two dimensions")
scene("a cut that leaves no room is refused",
      "method=poisson count=9 upper=[1,1,1] radius=0.4 domain.cut.shape=sphere "
      "domain.cut.radius=0.5",
      "pack.domain.cut.shape: must leave room for the grains")
scene("a spiral starts at walls",
      "method=inward_spiral upper=[1,1,1] periodic=[true,false,false]",
      "pack.periodic: must be false for inward_spiral: it starts at the walls")
scene("a spiral has no hole",
      "method=inward_spiral upper=[1,1,1] radius=0.1 domain.cut.shape=sphere "
      "domain.cut.radius=0.1",
      "pack.domain.cut.shape: must be none for inward_spiral")
few = "method=deposition count=100"
dense = "method=radius_expansion count=100 periodic=[true,true,true]"
scene("grains that fall need a count or a box", "method=deposition",
      "pack.count: must be given, or pack.upper: the box to fill")
scene("they need a floor", f"{few} periodic=[true,true,true]",
      "pack.periodic: must be false along z for deposition: grains need a floor")
scene("they settle and nothing else", f"{few} target=porosity target_value=0.4",
      "pack.target: must be settled for this method, or, for explosive_repulsion, porosity")
scene("gravity upwards is refused", f"{few} dynamics.gravity=-9.81",
      r"pack.dynamics.gravity: must be > 0 m/s2, got -9.81\d*")
scene("grains too stiff to fall in time are refused at once", f"{few} dynamics.stiffness=1e150",
      r"falling \S+ m takes \S+ cycles of \S+ s, and pack.dynamics.most_cycles = 3000000 "
      r"\(.stiffness, .overlap, .gravity\)", status=UNSTABLE)
scene("a time step past stability is refused at once", f"{few} dynamics.time_step_safety=1",
      r"time step \S+ s is past the stability limit of \S+ s: time_step_safety must be below "
      r"\S+, got 1", status=UNSTABLE)
for words in [f"{few} dynamics.most_cycles=4000", f"{dense} dynamics.most_cycles=1",
              "method=explosive_repulsion count=100 dynamics.most_cycles=1"]:
    scene(f"giving up is said: {words}", words,
          r".*unbalanced ratio .*", status=UNSTABLE)
scene("a step too long for the speed of grains of 1:20, if stable, is not called unstable",
      "method=explosive_repulsion count=500 radius=1 sizes.distribution=two_mode "
      "sizes.second_radius=0.05 sizes.second_share=0.95",
      r"diverged in cycle \d+: a grain or its surface would move more than 0\.1 mean radii in "
      r"one time step of \S+ s, within the stability limit of \S+ s: too long for such a "
      "speed, try a smaller time_step_safety", status=UNSTABLE)
scene("an extra layer above no top is refused before grains move",
      f"{dense} extra_layer=true",
      r"pack.extra_layer: must be false where there is no flat side \+z")
for words, line in [
        ("target=porosity", "must be given, for this target"),
        ("target=porosity target_value=1", "must be below 1 for a porosity, got 1"),
        ("target_value=0.3", "must be null where pack.target is settled"),
        ("target=coordination target_value=20",
         "must be below 14.9 contacts a grain, got 20"),
        ("target=coordination target_value=6 dimensions=2",
         "must be below 6 contacts a grain, got 6"),
        ("target=pressure target_value=1e6 dynamics.stiffness=1e-3",
         "must be at most 100 Pa for pack.dynamics.stiffness: grains would overlap by a "
         r"tenth, got 1e\+06")]:
    scene(f"a target out of reach is refused: {words}", f"{dense} {words}",
          f"pack.target_value: {line}")
scene("a box that repeats too soon is refused", f"{dense} upper=[1.1e-6,1e-3,1e-3]",
      r"pack.upper: must make a box of at least 1.2e-06 m along x, which repeats: 2.4 of the "
      r"largest diameter, got 1.1e-06")
scene("a box with walls does not close in", "method=domain_contraction count=100",
      r"pack.method: domain_contraction closes in a box that repeats along all axes "
      r"\(pack.periodic\); between walls use radius_expansion")
scene("an extra layer beside needs flat sides",
      "extra_layer=true extra_side=-x domain.shape=cylinder domain.radius=5 domain.height=9 "
      "method=random_sequential count=9 bonds=none",
      "pack.extra_layer: must be false where there is no flat side -x")
scene("an extra layer needs a top", "extra_layer=true periodic=[false,false,true]",
      r"pack.extra_layer: must be false where there is no flat side \+z")
for words, line in [
        ("uniform", "smallest: must be given, for this distribution"),
        ("power sizes.smallest=0.1", "largest: must be given, for this distribution"),
        ("uniform sizes.smallest=0.1 sizes.largest=0.1",
         "largest: must be above the smallest radius, 0.1 m, got 0.1"),
        ("normal sizes.smallest=1",
         "largest: must be above the smallest radius, 1 m, got 3.75e-07"),
        ("lognormal sizes.smallest=1 sizes.largest=2",
         "smallest: must leave something of the distribution"),
        ("two_mode", "second_radius: must be given, for two_mode"),
        ("sieve", "sieve.passing: must be as many shares as pack.sizes.sieve.radii, two or "
         "more, got 0 of 0"),
        ("sieve sizes.sieve.radii=[2,1] sizes.sieve.passing=[0,1]",
         "sieve.radii: must rise from one to the next, got 1 after 2"),
        ("sieve sizes.sieve.radii=[1,2,3] sizes.sieve.passing=[0,1,0.5]",
         "sieve.passing: must not fall from one to the next, got 0.5 after 1"),
        ("sieve sizes.sieve.radii=[1,2] sizes.sieve.passing=[0,0.9]",
         "sieve.passing: must go from 0 to 1, got 0 to 0.9"),
        ("sieve sizes.sieve.radii=[0,2] sizes.sieve.passing=[0,1]",
         r"sieve.radii: must be > 0 m, got \[0,2\]")]:
    scene(f"sizes: {words} is refused", f"{drawn} upper=[9,9,9] sizes.distribution={words}",
          f"pack.sizes.{line}")

# ---- scenes that cannot be --------------------------------------------------------------

DRY, REPLAY = ("dry", "network"), ("dem-replay", "forces")
setting("air wetter than saturated is refused", BAD_DATA, "air_vapour_pressure=3000",
        r"network: air_vapour_pressure: must be below saturation_pressure \(2339 Pa\), "
        "is 3000 Pa: nothing would dry", program=DRY)
setting("a boiling liquid is refused", BAD_DATA, "saturation_pressure=2e5",
        r"network: saturation_pressure: must be below gas_pressure \(100000 Pa\), "
        "is 200000 Pa: the liquid would boil", program=DRY)
setting("a draught beyond laminar flow is refused", BAD_DATA,
        'boundary_layer={"from":"plate","flow_length":10,"air_velocity":1}',
        r"dry.boundary_layer.air_velocity: must keep Re = u L / nu at or below 500000, .*, "
        "got Re = 653595", program=DRY)
setting("a boundary layer without end is refused", BAD_DATA,
        'boundary_layer={"from":"plate","air_velocity":0}',
        "dry.boundary_layer: must come to a thickness that numbers hold, got inf m",
        program=DRY)
setting("columns on an auxiliary layer need one", BAD_DATA, "boundary_layer.columns=auxiliary",
        "network: /throats/kind: no throat of the boundary layer begins at the network .*",
        program=DRY)
setting("an unknown way to find the boundary layer is refused", BAD_DATA,
        "boundary_layer.from=wind", r"dry.boundary_layer.from: .*", program=DRY)
setting("no open wall is refused", BAD_DATA, "open=[]",
        "network: open walls: must be one at least, or nothing would dry", program=DRY)
refused("a network without liquid is refused", BAD_DATA,
        ["dry", damaged("network", value("throats/kind", slice(None), 2))],
        "damaged: /throats/kind: no throat holds liquid, there is nothing to dry")
setting("a share of throats above one is refused", BAD_DATA, "threshold=2",
        "merge-nodes.threshold: must be from 0 to 1 where it is a fraction, got 2",
        program=("merge-nodes", "--set", "measure=fraction", "network"))
setting("snapshots that rise are refused", BAD_DATA, "snapshots=[0.5,0.9]",
        "dem-replay.snapshots: must fall from one to the next, got 0.9 after 0.5",
        program=REPLAY)
for size in 1e140, 1e-100:
    refused(f"grains of {size} m are refused", BAD_DATA,
            [*REPLAY[:1], damaged("forces", value("particles/radius", 3, size))],
            rf"damaged: grain 3: radii must be from 1e-60 to 1e60 m, .* got {size:g}, .*"
            .replace("e+", r"e\+"))
# Bridges much larger than their bodies; those of the volume it names work.
ONE_BRIDGE = ("bridge", "--set", "radius=1e-6", "--set", "points=2")
setting("a bridge without rupture says what volumes have one", UNSTABLE, "volume=4e-17",
        r"no rupture found for 4e-17 m3, 40 times the cube of the effective radius: between "
        r"these bodies it is up to 24\.\d times \(2\.4\d*e-17 m3\)", program=ONE_BRIDGE)
make("bridge", *ONE_BRIDGE, "--set", "volume=2.4e-17")
setting("a time step past the stability limit is refused", UNSTABLE, "time_step_safety=10",
        r"forces: time step \S+ s is past the stability limit of \S+ s: .*must be below .*"
        "got 10", program=REPLAY)
setting("grains without mass to speak of are refused", BAD_DATA, "density=5e-324",
        "forces: density and stiffness must leave a time step that numbers hold, got 0 s",
        program=REPLAY)
setting("a tolerance that is not met is reported", UNSTABLE, "tolerance=1e-12",
        r"forces: step \d of the load .*: unbalanced ratio \S+ is not below 1e-12 after 9 "
        "cycles", program=(*REPLAY, "--set", "time_step_safety=0.02", "--set", "cycles=9",
                             "--set", "most_cycles=9"))

setting("a table of too many slices and intervals is refused", BAD_DATA, "slices=100000",
        "crackstats.slices: times intervals must be at most 1000000, got 100000 times 11",
        program=("crackstats", "response", "--set", "intervals=11"))
refused("a drying that holds nothing any more does not go on", BAD_DATA,
        ["dry", "--set", "start_saturation=0.5",
         damaged("drying", value("history/saturation", slice(None), 1))],
        "damaged: /changes/saturation: no throat holds liquid any more at "
        "dry.start_saturation 0.5")
refused("a drying whose last liquid is in throats imposed empty does not go on", BAD_DATA,
        ["dry", "--set", "start_saturation=1e-9", "--set", 'imposed_empty=["+x"]', "drying"],
        "drying: /changes/saturation: no throat holds liquid any more at "
        "dry.start_saturation 1e-09")
make("viscous", "dry", "network", "--set", "liquid=viscous", "--set", "snapshots=[0.5]")
for name in ["liquid_pressure", "time"]:
    refused(f"pressures of viscous liquid need /snapshots/{name}", BAD_DATA,
            ["force-protocol", "--set", "pressure=field",
             damaged("viscous", removed(f"snapshots/{name}"))],
            f"damaged: /snapshots/{name}: pressure=field needs it: .*")
setting("stiffnesses too far apart for equilibria are reported", UNSTABLE,
        "bond.radius_fraction=1e-6", r"forces: step \d .*: no equilibrium of grain \d+ that "
        "numbers hold: stiffnesses lie too far apart .*",
        program=(*REPLAY, "--set", "engine=quasi-static"))

# Sizes that are allowed one by one, and what comes of them is too large to write.
for program, name, changes in [
        ("dry", "history/rate", ["boundary_layer.from=thickness",
                                 "boundary_layer.thickness=1e-300"]),
        ("invade", "events/pressure", ["surface_tension=1e150"]),
        ("flow", "throats/conductance", ["viscosity=1e-300"]),
        ("flow", "particles/buoyancy", ["gravity=[0,0,1e150]", "density=1e150"])]:
    refused(f"{program} refuses results that overflow: {name}", BAD_DATA,
            [program, *(word for change in changes for word in ("--set", change)),
             "packing" if program == "flow" else "network"],
            f"the results are out of range: /{name}: row 0: must be at most 1e150 in size, got .*")

# ---- the command line -------------------------------------------------------------------

os.symlink("out", "beside")
for place in ["out/result", "./out/result", "out/../out/result", "beside/result",
              os.path.abspath("out/result")]:
    refused(f"a checkpoint at the output is refused however spelt", USAGE,
            ["dry", "network", "--checkpoint", place],
            f"--checkpoint {place}: is where the output goes: name another file")
for program in ["pack", "tessellate", "merge-nodes", "dry", "force-protocol", "dem-replay",
                "deform", "crackstats", "bridge", "flow", "invade", "inspect"]:
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
        "drying: must be a response, is a drying")
refused("a lattice takes no input", USAGE, ["pack", "packing"],
        "packing: only method=import and explosive_repulsion take an input")
refused("inspect takes one input", USAGE, ["inspect", "packing", "packing"],
        "packing: one input only", output=())
refused("inspect refuses --frames 0", USAGE, ["inspect", "--frames=0", "packing"],
        "--frames: must be from 1 to 10000, got 0", output=())
refused("inspect names a dataset that is not there", BAD_DATA,
        ["inspect", "--data=/force", "packing"],
        r"packing: has no dataset /force \(a packing has none\)", output=())
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

# ---- output -----------------------------------------------------------------------------

for program, source in [("pack", ""), ("tessellate", "packing"), ("merge-nodes", "network"),
                        ("dry", "network"), ("invade", "network"), ("force-protocol", "drying"),
                        ("crackstats", "response")]:
    refused_in_shell(f"{program} reports a full disk", IO,
                     f"$BIN/{program} {source} -o /dev/full",
                     f"{program}: /dev/full: No space left on device")
    refused_in_shell(f"{program} reports a full disk on standard output", IO,
                     f"$BIN/{program} {source} >/dev/full",
                     f"{program}: standard output: No space left on device")
for option in ["--help", "--version", "--schema", "--parameters"]:
    refused_in_shell(f"pack {option} reports a full disk", IO, f"$BIN/pack {option} >/dev/full",
                     "pack: standard output: No space left on device")
refused_in_shell("inspect reports a full disk", IO, "$BIN/inspect packing >/dev/full",
                 "inspect: standard output: No space left on device")
refused("a directory as output is refused", CANNOT_CREATE, ["pack"], "out: is a directory",
        output=("-o", "out"))
refused("an output below a file is refused", CANNOT_CREATE, ["pack"],
        "packing/x.h5: Not a directory", output=("-o", "packing/x.h5"))
refused("an output in no directory is refused", CANNOT_CREATE, ["pack"],
        "nowhere/x.h5: No such file or directory", output=("-o", "nowhere/x.h5"))
refused("an output where nobody can create is refused", CANNOT_CREATE, ["pack"],
        "/proc/x.h5: .*", output=("-o", "/proc/x.h5"))
refused("an output without a name is refused", CANNOT_CREATE, ["pack"],
        ": No such file or directory", output=("-o", ""))
os.symlink("nowhere/x.h5", "dangling")
refused("a link to nowhere as output is refused", CANNOT_CREATE, ["pack"],
        "dangling: No such file or directory", output=("-o", "dangling"))
refused("inspect cannot write its series below a file", CANNOT_CREATE,
        ["inspect", "--vtk=packing/x", "forces"], "packing/x-0000.vtu: Not a directory",
        output=())
refused("a limit on the file size leaves the earlier output", IO, ["pack"],
        "out/result: File too large",
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000)))
small_disk = """mount -t tmpfs -o size=16k tmpfs out && head -c 9000 packing >out/other
    echo "the earlier output" >out/result
    $BIN/pack -o out/result; status=$?
    rm out/other; [[ $(ls out) == result ]] && exit $status"""
title = "a disk that fills up leaves the earlier output alone"
if subprocess.run(["unshare", "-m", "mount", "-t", "tmpfs", "tmpfs", "out"],
                  capture_output=True).returncode:
    result(title, [], "cannot mount a small disk")
else:
    done = run(["unshare", "-m", "bash", "-c", small_disk + "\nexit 99"])
    result(title, problems_of(done, IO, ["pack: out/result: No space left on device"]))
if os.getuid():
    os.mkdir("locked", 0o500)
    refused("a directory that cannot be written is refused", CANNOT_CREATE, ["pack"],
            "locked/x.h5: Permission denied", output=("-o", "locked/x.h5"))
else:
    result("a directory that cannot be written is refused", [], "root may write anywhere")
refused_in_shell("a closed standard output is reported", IO, "$BIN/pack >&-",
                 "pack: standard output: Bad file descriptor")
refused_in_shell("a closed pipe is reported", IO,
                 'set -o pipefail; $BIN/pack --set "counts=[20,20,20]" | true',
                 "pack: standard output: Broken pipe")
refused_in_shell("an error in the first program of a pipe is the only whole story", BAD_DATA,
                 "$BIN/pack --set radius=0 | $BIN/tessellate -o out/result",
                 "pack: pack.radius: must be > 0 m, got 0",
                 "tessellate: standard input: is empty")
def has_terminals():
    try:
        for end in os.openpty():
            os.close(end)
        return bool(shutil.which("script"))
    except OSError:
        return False


if has_terminals():
    done = run(["script", "-qec", f"{BIN}/pack", "/dev/null"])
    shown = done.stdout.decode().split("\r\n")
    result("binary output is not written to a terminal",
           [] if done.returncode == USAGE and shown ==
           ["pack: standard output is a terminal: name a file with -o, or pipe it", ""]
           else [f"status {done.returncode}, shown {shown}"])
    done = run(["script", "-qec", f"{BIN}/dry -o out/drying", "/dev/null"])
    shown = done.stdout.decode().split("\r\n")
    result("binary input is not read from a terminal",
           [] if done.returncode == USAGE and shown ==
           ["dry: standard input is a terminal: name a file, or pipe it", ""]
           else [f"status {done.returncode}, shown {shown}"])
else:
    result("binary output is not written to a terminal", [], "no terminal to be had, or no program `script`")

# Hours before it is written.
os.symlink("nowhere/x", "astray")
for place, line in [("", ": No such file or directory"), ("astray", "astray: No such file or .*"),
                    ("out", "out: is a directory")]:
    for option in ["-o", "--checkpoint"]:
        refused(f"{option} '{place}' is refused at once", CANNOT_CREATE,
                ["dry", "no-such-input", option, place], line,
                output=("-o", "out/result") if option == "--checkpoint" else ())

# ---- signals ----------------------------------------------------------------------------


def interrupted(name):
    """Sends the signal while dem-replay computes, which it would for hours."""
    command = [f"{BIN}/dem-replay", "forces", "-o", "out/result", "--set", "cycles=1000000000",
               "--set", "time_step_safety=0.02"]
    run(["true"])
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    time.sleep(0.5)
    process.send_signal(getattr(signal, name))
    out, error = process.communicate(timeout=10)
    done = subprocess.CompletedProcess(command, process.returncode, out, error)
    result(f"{name} ends a run by the signal and leaves no half file",
           problems_of(done, -getattr(signal, name), []))


for name in ["SIGINT", "SIGTERM", "SIGHUP"]:
    signal.signal(getattr(signal, name), signal.SIG_DFL)  # ignored in the background of a shell
    interrupted(name)

print(f"1..{number}")
