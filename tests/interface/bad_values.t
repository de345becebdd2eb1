#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input (tests/refusals.py): values of artifacts, one by one: numbers that are none, out of
range, of another shape or type."""
import os
import sys

import h5py
import numpy

sys.path.insert(0, "tests")
from refusals import (BAD_DATA, attribute, damage, damaged, done, refused, removed, replaced,
                      result, run, value)

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


def packed(row, grain):
    """The forces in deflated chunks, of which a value in one of the last is no number."""
    def change(file):
        data = file["force"][...]
        data[row, grain, 1] = numpy.nan
        del file["force"]
        file.create_dataset("force", data=data, chunks=(2, 5, 2), compression="gzip")

    return change


damage("NaN in packed forces is named by its time", "forces", packed(3, 11),
       "/force: row 3: must be finite, got -?nan")
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


def borrowed(how, name, source):
    """What NAME leads to stands in the file SOURCE."""

    def change(file):
        shape = getattr(file[name], "shape", None)
        del file[name]
        how(file, name, shape, source)

    return change


def link(file, name, shape, source):
    file[name] = h5py.ExternalLink(source, f"/{name}")


def storage(file, name, shape, source):
    file.create_dataset(name, shape, "f8", external=[(source, 0, h5py.h5f.UNLIMITED)])


def virtual(file, name, shape, source):
    layout = h5py.VirtualLayout(shape, "f8")
    layout[:] = h5py.VirtualSource(source, name, shape=shape)
    file.create_virtual_dataset(name, layout)


os.mkfifo("fifo")  # who opens it waits for ever
for source in "packing", "fifo":
    for way, how, name in [("an external link", link, "particles/radius"),
                           ("external storage", storage, "particles/radius"),
                           ("a virtual dataset", virtual, "particles/radius"),
                           ("a group elsewhere", link, "particles")]:
        damage(f"{way}, in a {source}, is refused", "packing", borrowed(how, name, source),
               f"/{name}: lies in another file: copy it into this one")
        refused(f"so it is by inspect: {way}, in a {source}", BAD_DATA, ["inspect", "damaged"],
                f"damaged: /{name}: lies in another file: copy it into this one", output=())


def aside(file):
    file["aside"] = h5py.ExternalLink("fifo", "/aside")


damage("a link that no one needs is refused as well", "packing", aside,
       "/aside: lies in another file: copy it into this one")


def within(file):
    file.move("particles/radius", "spare")
    file["particles/radius"] = h5py.SoftLink("/spare")
    file["itself"] = file["/"]


own = run(["tessellate", damaged("packing", within), "-o", "out/result"])
result("links within the file are followed", [own.stderr.decode()] if own.returncode else [])
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

done()
