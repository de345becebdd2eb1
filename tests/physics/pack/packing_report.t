#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# pack says of a packing what another program finds in it, in the artifact, as JSON and as a
# picture.
import json
import os
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, run, scratch_paths, sets


def left_firm(touch, walls, least):
    """Grains that keep LEAST contacts, with grains or WALLS, when all others are taken away."""
    firm = np.ones(len(walls), bool)
    while True:
        still = firm & ((touch & firm).sum(axis=1) + walls >= least)
        if still.sum() == firm.sum():
            return firm
        firm = still


with scratch_paths() as at:
    def pack(name, *settings, inputs=()):
        run("pack", *sets(*settings), *inputs, "-o", at(name), "--report", at(name + ".json"))
        with open(at(name + ".json")) as file:
            return json.load(file), h5py.File(at(name))

    # Unequal grains here and there that overlap a little, between walls.
    edge = 7.6
    random = np.random.default_rng(3)
    position, radius = random.uniform(1, 6.6, (260, 3)), random.uniform(0.4, 0.8, 260)
    for step in range(200):
        apart = position[:, None] - position[None]
        distance = np.linalg.norm(apart, axis=2) + np.eye(260)
        overlap = np.maximum(radius[:, None] + radius[None] - distance, 0) * (1 - np.eye(260))
        position += 0.2 * (apart / distance[..., None] * overlap[..., None]).sum(axis=1)
        position = np.clip(position, radius[:, None], edge - radius[:, None])
    np.savetxt(at("grains.txt"), np.column_stack([position, radius]), fmt="%.17g")
    box = ["method=import", "lower=[0,0,0]", f"upper=[{edge},{edge},{edge}]", "touching_gap=0.05"]
    said, file = pack("grains", *box, inputs=[at("grains.txt")])
    summary, attributes = said["summary"], file["summary"].attrs
    ok(all(summary[k] == attributes[k] for k in attributes) and len(summary) == len(attributes),
       "the report has the summary of the artifact")

    curves = []
    file["structure"].visititems(lambda name, item: curves.append(name)
                                 if isinstance(item, h5py.Dataset) else None)
    walk = lambda name: [part := said["structure"]] and \
        [part := part[key] for key in name.split("/")][-1]
    ok(len(curves) == 10 and all(np.array_equal(walk(c), file["structure"][c]) for c in curves),
       "and its curves", curves)
    ok(said["reached"] is None, "a method without an aim reaches nothing")

    distance = np.linalg.norm(position[:, None] - position[None], axis=2)
    sums = radius[:, None] + radius[None]
    touch = (distance <= sums * 1.05) & ~np.eye(260, dtype=bool)
    contacts = touch.sum(axis=1)
    ok(np.array_equal(np.bincount(contacts), file["structure/coordination"])
       and summary["contacts"] == touch.sum() // 2, "contacts of every grain")
    walls = sum((position[:, k] <= radius * 1.05).astype(int)
                + (edge - position[:, k] <= radius * 1.05) for k in range(3))
    ok(summary["wall_contacts"] == walls.sum(), "and with walls")
    firm = left_firm(touch, walls, 4)
    ok(summary["rattlers"] == 260 - firm.sum() > 0, "rattlers", summary["rattlers"])
    ok(np.isclose(summary["coordination_without_rattlers"],
                  touch[firm][:, firm].sum() / firm.sum(), rtol=1e-14),
       "coordination without them")
    i, j = np.nonzero(np.triu(touch))
    n = (position[j] - position[i]) / distance[i, j][:, None]
    fabric = n.T @ n / len(n)
    ok(np.allclose(fabric, file["structure/fabric"], atol=1e-14), "fabric")
    overlap = np.maximum(sums - distance, 0)[i, j] / np.minimum(radius[i], radius[j])
    ok(np.isclose(overlap.mean(), summary["mean_overlap"], rtol=1e-10, atol=0)
       and np.isclose(overlap.max(), summary["max_overlap"], rtol=1e-10, atol=0), "overlaps")
    ok(np.isclose(radius.mean(), summary["mean_radius"], rtol=1e-14, atol=0)
       and file["structure/radius/count"][:].sum() == 260, "sizes")

    # Porosity by points on a fine grid; they see what three grains share only once.
    margin = 2 * radius.mean()
    points = np.linspace(margin, edge - margin, 71)
    points = (points[1:] + points[:-1]) / 2
    x, y, z = np.meshgrid(points, points, points, indexing="ij")
    solid = np.zeros(x.shape, bool)
    for p, r in zip(position, radius):
        solid |= (x - p[0]) ** 2 + (y - p[1]) ** 2 + (z - p[2]) ** 2 <= r * r
    ok(abs(1 - solid.mean() - summary["bulk_porosity"]) < 1e-3, "bulk porosity",
       (1 - solid.mean(), summary["bulk_porosity"]))
    layers = 1 - file["structure/slice/porosity"][:]
    ok(np.isclose(layers.mean() * edge**3, summary["solid_volume"], rtol=1e-10, atol=0),
       "slices hold the solid volume, walls cutting nothing")

    # Nanometres and kilometres.
    for name, factor in ("nano", 1e-9), ("kilo", 1e3):
        np.savetxt(at(name + ".txt"), factor * np.column_stack([position, radius]), fmt="%.17g")
        side = edge * factor
        other, _ = pack(name, "method=import", "lower=[0,0,0]", f"upper=[{side},{side},{side}]",
                        "touching_gap=0.05", inputs=[at(name + ".txt")])
        pure = [k for k in summary if not k.endswith(("radius", "volume"))]
        same = all(np.isclose(summary[k], other["summary"][k], rtol=1e-9, atol=1e-15)
                   for k in pure)
        g = [d["structure"]["radial_distribution"]["value"] for d in (said, other)]
        ok(same and np.allclose(*g, rtol=1e-9), f"the same at a scale of {factor:g}",
           [(k, summary[k], other["summary"][k]) for k in pure])

    # Where the report may go.
    to = lambda *words: subprocess.run([f"{BIN}/pack", *words], capture_output=True)
    shown = to("-o", at("x"), "--report", "-")
    ok(shown.returncode == 0 and not shown.stderr
       and json.loads(shown.stdout)["summary"]["coordination"] > 0,
       "the report may go to standard output when the packing does not")
    ok(to("--report", "-").returncode == 64
       and to("-o", at("y"), "--report", at("y")).returncode == 64 and not os.path.exists(at("y")),
       "two outputs in one place are refused")

    # What makes no sense is left out, and may be missing.
    one, file = pack("one", "counts=[1,1,1]")
    ok("bulk_porosity" not in one["summary"] and "fabric" not in one["structure"]
       and one["summary"]["rattlers"] == 0, "a single grain, held by six walls")
    shown = json.loads(run("inspect", at("one")))
    ok(shown["summary"] == one["summary"], "inspect shows just what is there")
    left_out = subprocess.run([f"{BIN}/inspect", "--data", "/structure/fabric", at("one")],
                              capture_output=True)
    ok(left_out.returncode == 65 and b"left out" in left_out.stderr,
       "and says what was left out")

    # Below an extra layer, which is not part of the body: on a lattice, where the box of the body is that
    # without a layer, the same report; else by numpy, in the box that ends with the grains.
    for shape in ["counts=[4,3,5]"], ["counts=[5,1,4]", "dimensions=2", "method=square"], \
            ["counts=[4,3,5]", "periodic=[true,true,false]"]:
        shape = ["radius=0.5", "check=none", *shape]
        bare, _ = pack("bare", *shape)
        for side in ["-z", "+z"] if "periodic" in shape[-1] else ["-x", "+x", "-z", "+z"]:
            layered, file = pack("layered", *shape, "extra_layer=true", f"extra_side={side}")
            again, other = pack("again", "method=import", "check=none", inputs=[at("layered")])
            ok(layered == bare and again == bare and (file["particles/kind"][:] == 1).any()
               and np.array_equal(other["bonds/particles"], file["bonds/particles"]),
               f"{' '.join(shape[2:])}: a layer at {side} is not measured, nor bonded on import")
        if "periodic" not in shape[-1]:
            both, file = pack("both", "method=import", "check=none", "extra_layer=true", "extra_side=-x", inputs=[at("layered")])
            ok(both == bare, f"{' '.join(shape[2:])}: nor are two", (both["summary"], bare["summary"]))
    inner = random.uniform(4, 6, (30, 3))
    np.savetxt(at("inner.txt"), np.column_stack([inner, np.full(30, 0.1)]), fmt="%.17g")
    for title, words, inputs, edge in [
            ("unequal grains", ["method=random_sequential", "upper=[4e-6,4e-6,4e-6]", "count=90", "sizes.distribution=uniform",
                                "sizes.smallest=1e-7", "sizes.largest=4e-7"], [], 4e-6),
            ("grains far from all sides", ["method=import", "lower=[0,0,0]", "upper=[10,10,10]"], [at("inner.txt")], 10)]:
        said, file = pack("uneven", *words, "touching_gap=0.3", "check=none", "extra_layer=true", inputs=inputs)
        solid = file["particles/kind"][:] == 0
        x, r = file["particles/position"][:][solid], file["particles/radius"][:][solid]
        volume = 4 / 3 * np.pi * (r**3).sum()
        touch = np.linalg.norm(x[:, None] - x, axis=2) <= 1.3 * (r[:, None] + r)
        contacts, summary = (touch.sum() - len(r)) / 2, said["summary"]
        ok(not solid.all() and np.isclose(summary["porosity"], 1 - volume / (edge**2 * (x[:, 2] + r).max()), rtol=1e-12)
           and np.isclose(summary["mean_radius"], r.mean(), atol=0) and summary["contacts"] == contacts > 0
           and np.isclose(summary["coordination"], 2 * contacts / len(r)), f"{title} below a layer", summary)

    # Each wall of a round body counts: a grain in the corner of floor and side touches two.
    out = lambda x: np.hypot(x[:, 0] - 4, x[:, 1] - 4)
    side, ends = (lambda x: [4 - out(x)]), (lambda x: [x[:, 2], 8 - x[:, 2]])
    hole = lambda x: [np.linalg.norm(x - 4, axis=1) - 2, *(at for k in range(3) for at in (x[:, k], 8 - x[:, k]))]
    cylinder = ["domain.shape=cylinder", "domain.radius=4", "domain.height=8"]
    for shape, words, depths in [
            ("cylinder", cylinder, lambda x: side(x) + ends(x)),
            ("ring", ["domain.inner_radius=1.5", *cylinder, "domain.shape=ring"], lambda x: side(x) + ends(x) + [out(x) - 1.5]),
            ("sphere", ["domain.shape=sphere", "domain.radius=4"], lambda x: [4 - np.linalg.norm(x - 4, axis=1)]),
            ("box with a hole", ["upper=[8,8,8]", "domain.cut.shape=sphere", "domain.cut.radius=2"], hole)]:
        said, file = pack("round", "check=none", "method=random_sequential", "radius=0.6", "most_trials=3000", "touching_gap=0.2", *words)
        x, summary = file["particles/position"][:], said["summary"]
        walls = sum((depth <= 0.6 * 1.2).astype(int) for depth in depths(x))
        touch = (np.linalg.norm(x[:, None] - x, axis=2) <= 1.2 * 1.2) & ~np.eye(len(x), dtype=bool)
        firm = left_firm(touch, walls, 4)
        ok(summary["wall_contacts"] == walls.sum() and summary["rattlers"] == len(x) - firm.sum() and (shape == "sphere" or walls.max() > 1),
           f"walls that grains touch in a {shape}, and rattlers", (summary, walls.sum(), len(x) - firm.sum()))
        free = sum(not touch[i].any() and not walls[i] for i in range(len(x)))
        found = json.loads(subprocess.run([f"{BIN}/check", "-s", "touching_gap=0.2", at("round"), "-o", "-"], capture_output=True).stdout)
        said = [int(word) for finding in found["findings"] if finding["name"] == "free" for word in finding["text"].split() if word.isdigit()]
        ok(said[:1] == ([free] if free else []), f"check counts those that touch nothing in a {shape}", (said, free))

    # Grains that are parted have no friction: two contacts do not hold one.
    said, file = pack("parted", "method=explosive_repulsion", "check=none", "touching_gap=0.02", "radius=0.5", "count=180", "upper=[6,6,6]")
    x, summary = file["particles/position"][:], said["summary"]
    walls = sum((at <= 0.5 * 1.02).astype(int) for k in range(3) for at in (x[:, k], 6 - x[:, k]))
    touch = (np.linalg.norm(x[:, None] - x, axis=2) <= 1.02) & ~np.eye(len(x), dtype=bool)
    rattlers = [len(x) - left_firm(touch, walls, least).sum() for least in (4, 2)]
    ok(summary["rattlers"] == rattlers[0] > rattlers[1], "grains that are parted rattle with three contacts", (summary["rattlers"], rattlers))
    model = file.attrs["model"].decode()
    ok("without friction" in model and "Coulomb" not in model, "and the model says that they have no friction", model)

    for name in "grains", "one":
        drawn = subprocess.run(["pipelines/figures/packing", at(name), at("figure.svg")],
                               capture_output=True)
        ok(drawn.returncode == 0 and not drawn.stderr and open(at("figure.svg")).read()
           .rstrip().endswith("</svg>"), f"a figure of {name}", drawn.stderr.decode())
done()
