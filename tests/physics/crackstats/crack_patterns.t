#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Crack patterns of layers that were cut by hand: a square grid, bricks, stripes, random
# damage and cuts that do not reach the floor. What comes out is known beforehand.
import json
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import done, ok, run, scratch_paths

SIDE, HEIGHT, RADIUS = 48, 6, 0.3e-6  # of which multiples round: bonds lie on the borders of columns
D = 2 * RADIUS
SCENE = {"pack": {"method": "cubic", "radius": RADIUS, "counts": [SIDE, SIDE, HEIGHT],
                  "periodic": [True, True, False]},
         "dem-replay": {"bond": {"normal_strength": 1e12, "shear_strength": 1e12},
                        "shrinkage": {"strain": 1e-9, "steps": 2}, "cycles": 1, "ramp": 0,
                        "tolerance": None, "snapshots": [0]}}


def near(got, wanted, tolerance=1e-9):
    return abs(got - wanted) <= tolerance * abs(wanted)


with scratch_paths() as at:
    with open(at("scene.json"), "w") as file:
        json.dump(SCENE, file)
    run("pack", "-q", "-p", at("scene.json"), "-o", at("p.h5"))
    run("dem-replay", "-q", "-p", at("scene.json"), at("p.h5"), "-o", at("whole.h5"))
    with h5py.File(at("whole.h5")) as file:
        bonds, place = file["bonds/particles"][:], file["particles/position"][:]
        held = file["particles/held"][:]
        n_history = file["history/cracks"].shape
    cell = np.floor(place / D).astype(int)
    along = cell[bonds[:, 1]] - cell[bonds[:, 0]]
    along -= SIDE * np.rint(along / [SIDE, SIDE, 1e9]).astype(int)
    axis = np.abs(along).argmax(axis=1)
    first = np.where((along.sum(axis=1) > 0)[:, None], cell[bonds[:, 0]], cell[bonds[:, 1]])
    lateral = (held[bonds] == 0).all(axis=1)

    def look(broken, opening=None, saturation=None):
        """Crackstats of the layer with these bonds broken."""
        which = np.flatnonzero(broken)
        with open(at("whole.h5"), "rb") as source, open(at("cut.h5"), "wb") as target:
            target.write(source.read())
        with h5py.File(at("cut.h5"), "r+") as file:
            left = np.full(len(which), 0.0) if saturation is None else saturation[which]
            order = np.argsort(-left, kind="stable")
            columns = {"bond": which.astype("i4"), "saturation": left, "time": 2 - left,
                       "mode": np.zeros(len(which), "u1"),
                       "position": place[bonds[which, 0]]}
            for name, value in columns.items():
                old = file[f"cracks/{name}"]
                kept = dict(old.attrs)
                del file[f"cracks/{name}"]
                file[f"cracks/{name}"] = value[order]
                for key, text in kept.items():
                    file[f"cracks/{name}"].attrs[key] = text
            if opening is not None:
                file["snapshots/displacement"][-1] = opening
        found = json.loads(run("crackstats", "-q", "-s", "polygons=true", at("cut.h5")))
        return found["mean"]["polygons"], found["mean"]["junctions"], found["patterns"][0]

    cut_x = lateral & (axis == 0) & (first[:, 0] % 12 == 11)
    cut_y = lateral & (axis == 1) & (first[:, 1] % 12 == 11)

    # 16 squares of 12 x 12, which part: each grain goes a hundredth to its own centre.
    middle = (cell[:, :2] // 12 * 12 + 6) * D
    opening = np.zeros_like(place)
    opening[:, :2] = 0.01 * (middle - place[:, :2])
    shape, joints, pattern = look(cut_x | cut_y, opening)
    ok(shape["found"] == 1 and shape["count"] == 16 and shape["islands"] == 16,
       "a square grid: 16 polygons, 16 islands", shape)
    ok(all(abs(area ** 0.5 - 12 * D) < 0.51 * D for area in pattern["areas"])
       and near(sum(pattern["areas"]), (SIDE * D) ** 2),
       "squares, to a column's width, and together the box", pattern["areas"])
    ok(near(shape["area_over_h2"], (12 / HEIGHT) ** 2) and near(shape["length_over_h"], 2),
       "over the height squared")
    ok(shape["in_cracks"] == 1 and shape["through"] == 1 and shape["floor_broken"] == 0,
       "all cracks go through, and the floor holds", shape)
    ok(near(shape["width"], 0.01 * 11 * D, 1e-6), "as wide as they were opened", shape["width"])
    ok(joints["count"] == 16 and near(joints["largest_angle"], 90, 0.02)
       and joints["y_share"] == 1 and joints["t_share"] == 0,
       "16 junctions with right angles", joints)
    lengths = 2 * 4 * SIDE * D
    border = shape["opened"] / shape["width"] * (SIDE * D) ** 2
    ok(near(border, np.pi / 4 * lengths, 1e-6), "borders as long as those of cells, times pi/4")

    # Neither a box with room above the layer changes that, nor are cracks said to end where
    # the sides of the layer are held too, so that it has no floor to reach.
    with open(at("whole.h5"), "rb") as file:
        kept = file.read()
    with h5py.File(at("whole.h5"), "r+") as file:
        upper = file["domain/upper"][:]
        file["domain/upper"][2] = upper[2] + 4 * D
    shape, _, _ = look(cut_x | cut_y)
    ok(shape["count"] == 16 and shape["through"] == 1, "a box higher than the layer: the same", shape)
    with h5py.File(at("whole.h5"), "r+") as file:
        file["domain/upper"][2] = upper[2]
        file["particles/held"][:] = held | (cell[:, 0] == 3)
    shape, _, _ = look(cut_x | cut_y)
    ok(shape["count"] == 16 and shape["through"] is None, "held up to its top: through nothing", shape)
    with open(at("whole.h5"), "wb") as file:
        file.write(kept)

    # Bricks: every second row is shifted by half a brick.
    row = first[:, 1] // 12
    bricks = lateral & (axis == 0) & ((first[:, 0] + 6 * (row % 2)) % 12 == 11)
    shape, joints, _ = look(bricks | cut_y)
    ok(shape["count"] == 16 and joints["count"] == 32, "bricks: twice as many junctions",
       [shape, joints])
    ok(joints["t_share"] == 1 and joints["largest_angle"] > 165, "all of them T", joints)

    def between(label):
        """Lateral bonds between grains whose LABEL on the map differs."""
        ends = [label[tuple(cell[bonds[:, k], :2].T)] for k in (0, 1)]
        return lateral & (ends[0] != ends[1])

    # Three junctions in a row, 2.2 diameters from each to the next and 4 from end to end: they
    # are one, whichever comes first on the map.
    x, y = np.indices((SIDE, SIDE))
    above = y >= np.where((x >= 11) & (x < 13), 24, 25)
    label = np.where(above, np.searchsorted([10, 14, 30], x, "right") % 3, 5 + (x >= 12) - (x >= 36))
    counts = [look(between(map_))[1]["count"] for map_ in (label, label[:, ::-1])]
    ok(counts[0] == counts[1], "a row of junctions, and the same upside down: as many", counts)

    # When they came: cracks across x first.
    saturation = np.where(axis == 0, 0.75, 0.25)
    shape, _, pattern = look(cut_x | cut_y, saturation=saturation)
    opened = np.array(pattern["opened"], dtype=float).reshape(pattern["columns"][1], -1)
    ok([stage["polygons"] for stage in pattern["stages"]] == [0, 0, 4, 4, 4, 4, 4, 16, 16, 16],
       "four stripes, then 16 squares", pattern["stages"])
    ok(near(np.nanmax(opened), 0.7) and near(np.nanmin(opened), 0.2),
       "each crack at its saturation")

    # Cracks that end half way down do not go through.
    shape, _, _ = look((cut_x | cut_y) & (first[:, 2] >= 1 + (HEIGHT - 1) // 2))
    ok(shape["found"] == 0 or shape["through"] == 0, "cut half way: not through", shape)

    rng = np.random.default_rng(1)
    for share in 0.02, 0.1, 0.3, 0.6:
        broken = lateral & (rng.random(len(bonds)) < share)
        shape, joints, pattern = look(broken)
        ok(shape["found"] == 0 and pattern["none"] and shape["count"] is None,
           f"random damage of {share}: none ({pattern['none']})", shape)
    shape, _, pattern = look(np.zeros(len(bonds), bool))
    ok(shape["found"] == 0 and shape["crack_area"] == 0, "no crack: none")

    # The damage itself, of a random packing, by the Fourier transform.
    scene = {"pack": {"method": "soft_spheres", "radius": RADIUS, "periodic": [True] * 3,
                      "sizes": {"distribution": "uniform", "smallest": 0.8 * RADIUS,
                                "largest": 1.2 * RADIUS},
                      "upper": [12 * D, 10 * D, 7 * D], "target": "porosity",
                      "target_value": 0.36, "slab": {"lower": D, "upper": 6 * D}},
             "dem-replay": dict(SCENE["dem-replay"], held={"upper": [1, 1, 1.8 * D],
                                                           "lower": [-1, -1, -1]})}
    scene["dem-replay"]["bond"] = {"by": "distance", "gap": 0.2, "normal_strength": 1e12,
                                   "shear_strength": 1e12}
    with open(at("random.json"), "w") as file:
        json.dump(scene, file)
    run("pack", "-q", "-p", at("random.json"), "-o", at("p.h5"))
    run("dem-replay", "-q", "-p", at("random.json"), at("p.h5"), "-o", at("whole.h5"))
    with h5py.File(at("whole.h5")) as file:
        bonds, place = file["bonds/particles"][:], file["particles/position"][:]
        held = file["particles/held"][:]
    edge = np.array([12 * D, 10 * D])
    lateral = (held[bonds] == 0).all(axis=1)
    broken = lateral & (rng.random(len(bonds)) < 0.3)
    _, _, pattern = look(broken)
    step = place[bonds[:, 1], :2] - place[bonds[:, 0], :2]
    step -= edge * np.rint(step / edge)
    columns = np.array(pattern["columns"])
    at_column = ((place[bonds[:, 0], :2] + step / 2) % edge / (edge / columns)).astype(int)
    waves = [2 * np.pi * np.fft.fftfreq(n, size / n) for n, size in zip(columns, edge)]
    kernel = np.exp(-0.5 * (0.8 * pattern["diameter"]) ** 2
                    * (waves[1][:, None] ** 2 + waves[0][None] ** 2))
    smooth = []
    for which in broken, lateral:
        grid = np.zeros(columns[::-1])
        np.add.at(grid, (at_column[which, 1], at_column[which, 0]),
                  np.hypot(*step[which].T))
        smooth.append(np.fft.ifft2(np.fft.fft2(grid) * kernel).real)
    damage = np.array(pattern["damage"]).reshape(columns[::-1])
    ok(np.abs(smooth[0] / smooth[1] - damage).max() < 1e-3,
       "damage, as by the Fourier transform", np.abs(smooth[0] / smooth[1] - damage).max())

    # Columns equally near to two polygons: rounding does not decide which of them they join.
    label = np.floor(2 * (place[:, :2] % edge / edge).sum(axis=1)).astype(int) % 2  # slanting stripes
    areas = []
    for digits in 0, -1, 1:
        with h5py.File(at("whole.h5"), "r+") as file:
            file["domain/upper"][0] = edge[0] * (1 + digits * 1e-14)
        areas.append(look(lateral & (label[bonds[:, 0]] != label[bonds[:, 1]]))[2]["areas"])
    ok(len(areas[0]) == 2 and all(np.allclose(one, areas[0], rtol=1e-9, atol=0) for one in areas),
       "a box wider by rounding: the same areas", areas)
done()
