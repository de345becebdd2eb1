#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Lattices with the bonds their geometry demands, and grains that come from elsewhere.
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch_paths, sets

with scratch_paths() as at:
    def pack(name, *settings, **more):
        run("pack", *sets(*settings), *more.get("inputs", []), "-o", at(name))
        return h5py.File(at(name))

    cubic = pack("cubic", "counts=[3,4,5]", "radius=1e-3")
    ok(len(cubic["bonds/particles"]) == 2 * 4 * 5 + 3 * 3 * 5 + 3 * 4 * 4,
       "a cubic lattice is bonded along its edges")
    ok(abs(cubic["summary"].attrs["max_overlap"]) < 1e-14, "its grains touch without overlap")
    periodic = pack("periodic", "counts=[3,4,5]", "periodic=[true,true,false]")
    ok(len(periodic["bonds/particles"]) == 2 * 3 * 4 * 5 + 3 * 4 * 4
       and list(periodic["domain/periodic"]) == [1, 1, 0],
       "a laterally periodic one is bonded across its sides as well")
    square = pack("square", "method=square", "counts=[6,1,7]")
    ok(len(square["bonds/particles"]) == 5 * 7 + 6 * 6
       and np.ptp(square["particles/position"][:, 1]) == 0, "a square lattice is one layer")
    ok(len(pack("none", "bonds=none")["bonds/particles"]) == 0, "bonds may be left out")

    with open(at("grains.txt"), "w") as text:
        print("# x y z r", file=text)
        for x, r in zip(cubic["particles/position"], cubic["particles/radius"]):
            print(*(repr(float(v)) for v in (*x, r)), file=text)
    text = pack("text", "method=import", inputs=[at("grains.txt")])
    same = lambda other, names: all(np.array_equal(cubic[n], other[n]) for n in names)
    ok(same(text, ["particles/position", "particles/radius", "bonds/particles"]),
       "grains imported from text are the same, and so are their bonds")
    ok(np.allclose(text["domain/upper"][:], cubic["domain/upper"][:], rtol=1e-14, atol=0),
       "their box is around them")
    weak = pack("fewer", "bonds=none", "counts=[3,4,5]", "radius=1e-3")
    kept = pack("kept", "method=import", "bonds=keep", inputs=[at("fewer")])
    ok(same(kept, ["particles/position"]) and len(kept["bonds/particles"]) == 0,
       "an imported packing keeps its bonds when asked to")

    # What goes along with grains that are imported.
    pack("tube", "method=random_sequential", "count=40", "radius=1e-3", "domain.shape=cylinder", "domain.radius=5e-3",
         "domain.height=1e-2", "bonds=none")
    tube, wide = h5py.File(at("tube")), pack("wide", "method=import", "import.scale=2", "bonds=none", inputs=[at("tube")])
    ok(all(np.allclose(wide[f"domain/bodies/{n}"][:], 2 * tube[f"domain/bodies/{n}"][:], rtol=1e-14, atol=0) for n in ("lower", "upper")),
       "the wall around them is scaled with them")
    pack("layered", "counts=[3,3,4]", "extra_layer=true")
    layered = h5py.File(at("layered"))
    height = layered["particles/position"][:, 2]
    cut = pack("cut", "method=import", f"slab.lower={np.unique(height)[1] * 0.999}", inputs=[at("layered")])
    left = height > np.unique(height)[1] * 0.999
    ok(0 < left.sum() < len(height) and (cut["particles/kind"][:] == layered["particles/kind"][:][left]).all(),
       "those of a slab are what they were, solid or of the extra layer")
    more = pack("more", "method=import", "extra_layer=true", "extra_side=-z", inputs=[at("layered")])
    ok((more["particles/kind"][:] == 1).sum() > (layered["particles/kind"][:] == 1).sum(), "a second extra layer leaves the first what it is")

    # Bonds of random spheres against every pair, one by one.
    random = np.random.default_rng(7)
    position, radius = random.uniform(0, 1, (300, 3)), random.uniform(0.02, 0.06, 300)
    np.savetxt(at("random.txt"), np.column_stack([position, radius]), fmt="%.17g")
    made = pack("random", "method=import", inputs=[at("random.txt")])
    apart = np.linalg.norm(position[:, None] - position[None], axis=2)
    touching = apart <= (radius[:, None] + radius[None]) * (1 + 1e-6)
    expected = [(i, j) for i in range(300) for j in range(i + 1, 300) if touching[i, j]]
    ok([tuple(b) for b in made["bonds/particles"]] == expected,
       "touching neighbours are those that a search of all pairs finds")
    solid = (4 / 3 * np.pi * radius**3).sum()
    box = np.prod(made["domain/upper"][:] - made["domain/lower"][:])
    ok(abs(made["summary"].attrs["porosity"] - (1 - solid / box)) < 1e-12, "porosity")
done()
