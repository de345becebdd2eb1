#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Networks in cylinders, rings and spheres, and around what is cut out: face by face beside voro++,
# whose walls are planes tangent to the round one, each for one cell; nodes on the wall, cells
# closed, volumes ever nearer to the domain's, whatever the scale.
import os
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from diagram import Diagram, has_voro, of_packing, voro
from tap import done, ok, refused, run, scratch, sets

OUTER, INNER = 64, 128
CYLINDER = ["domain.shape=cylinder", "domain.radius=0.5", "domain.height=1"]
SPHERE = ["domain.shape=sphere", "domain.radius=0.5"]
RING = [*CYLINDER[1:], "domain.shape=ring", "domain.inner_radius=0.25"]
BOX = ["upper=[1,1,1]"]
SIZES = ["sizes.distribution=lognormal", "sizes.spread=0.4"]
ARGUMENTS = {"cylinder": ["-wc", .5, .5, 0, 0, 0, 1, .5], "sphere": ["-ws", .5, .5, .5, .5]}


def loose(count, *shape):
    return ["method=random_sequential", f"radius={0.16 * count**(-1 / 3)}", f"count={count}", *shape]


def off_wall(cells, bit, radius, flat):
    """How far nodes of a wall are from it, of its radius; FLAT is the axis that does not count."""
    at = (cells.node - (cells.lower + cells.upper) / 2)[cells.walls & bit > 0]
    if flat is not None:
        at[:, flat] = 0
    return np.abs(np.linalg.norm(at, axis=1) / radius - 1).max()


def throats_around(cells):
    return np.bincount(cells.ends.ravel(), minlength=len(cells.node))


def sound(title, cells, volume, miss, walls=(), euler={2}):
    """MISS: what chords in place of the wall may leave out, of the domain. WALLS: for each its
    bit, radius, and axis."""
    sums, leak = cells.volumes()
    off = max((off_wall(cells, *wall) for wall in walls), default=0)
    error = sums.sum() / volume - 1
    around = throats_around(cells)
    corners = np.isin(cells.walls, [x + y + z for x in (1, 2) for y in (4, 8) for z in (16, 32)])
    # where a throat is in the wall from end to end it is one with a chord
    threes = (around == 3) & ((cells.walls >= OUTER) | corners)
    ok(leak.max() < 1e-11 and cells.euler() <= euler and cells.equidistance() < 1e-12
       and off < 1e-12 and (around[~threes] == 4).all() and threes.mean() < 0.005
       and sums.min() > 0 and abs(error) < miss,
       f"{title}: {len(cells.radius)} closed cells, nodes on the wall, 4 throats each",
       (leak.max(), cells.euler(), cells.equidistance(), off, np.unique(around), error))
    return error


# ---- beside voro++ -----------------------------------------------------------------------

def polygons(at, lower, upper, folder, radius):
    """Faces between grains in a box by voro++, which knows of no wall: grains and corners."""
    path = os.path.join(folder, "polygons")
    columns = [np.arange(len(at))[:, None], at] + ([] if radius is None else [radius[:, None]])
    np.savetxt(path, np.hstack(columns), fmt=["%d"] + ["%.17g"] * (len(columns) + 1))
    box = [str(x) for pair in zip(lower, upper) for x in pair]
    subprocess.run(["voro++", *([] if radius is None else ["-r"]), "-c", "%i|%n|%t|%P", *box, path],
                   check=True, stdout=subprocess.DEVNULL)
    with open(path + ".vol") as file:
        for line in file:
            i, others, loops, corners = line.split("|")
            place = np.array([c.strip("()").split(",") for c in corners.split()], float)
            for j, loop in zip(map(int, others.split()), loops.split()):
                if j > int(i):
                    yield (int(i), j), place[list(map(int, loop.strip("()").split(",")))]


def cut_polygon(polygon, flat):
    """What of a polygon lies within 1/2 of the centre 1/2, chords in place of the wall."""
    out, kept = polygon - 0.5, []
    if flat is not None:
        out[:, flat] = 0
    for k in range(len(polygon)):
        a, b = out[k - 1], out[k]
        along = b - a
        square = along @ along
        root = (a @ along)**2 - square * (a @ a - 0.25)
        for sign in (-1, 1):
            t = (-(a @ along) + sign * root**0.5) / square if root > 0 and square else 2
            if 0 < t < 1:
                kept.append(polygon[k - 1] + t * (polygon[k] - polygon[k - 1]))
        if b @ b <= 0.25:
            kept.append(polygon[k])
    if len(kept) < 3:
        return 0
    rays = np.array(kept[1:]) - kept[0]
    return np.linalg.norm(np.cross(rays[:-1], rays[1:]).sum(0)) / 2


def compare_cut(title, cells, flat, folder, radius):
    """Face by face as voro++ has them without the wall, cut here."""
    lower, upper = np.full(3, -0.5), np.full(3, 1.5)
    if flat is not None:
        lower[flat], upper[flat] = 0, cells.edge[flat]
    areas = np.linalg.norm(cells.areas(), axis=1)
    ours = {pair: a for pair, a in zip(map(tuple, cells.sides.tolist()), areas) if pair[1] >= 0}
    theirs = {pair: cut_polygon(polygon, flat) for pair, polygon in polygons(
        cells.centre - cells.lower, lower, upper, folder, radius)}
    spacing2 = len(cells.radius)**(-2 / 3)
    off = max(abs(ours.get(pair, 0) - theirs.get(pair, 0)) for pair in ours.keys() | theirs.keys())
    ok(off < 1e-4 * spacing2, f"{title}: {len(ours)} faces between grains as voro++'s, cut",
       off / spacing2)


def compare_clear(title, cells, wall, folder, radius):
    """Faces clear of the wall as beside voro++'s own wall; gives the sum of its cells."""
    volume, faces = voro(cells.centre - cells.lower, cells.edge, folder, radius=radius, wall=wall)
    clear = np.ones(len(cells.size), bool)
    np.logical_and.at(clear, cells.face, cells.walls[cells.corner] & OUTER == 0)
    clear &= cells.inner
    areas, theirs = np.linalg.norm(cells.areas(), axis=1), [dict(f) for f in faces]
    off = np.array([abs(a - theirs[i].get(j, 0)) - 1e-5 * a
                    for (i, j), a in zip(cells.sides[clear].tolist(), areas[clear])])
    ok(clear.sum() > 2 * len(faces) and off.max() < 1e-5 * len(faces)**(-2 / 3),
       f"{title}: {clear.sum()} faces clear of the wall as by voro++", off.max())
    return volume.sum()


def check_peer(folder):
    for name, shape, volume, flat in (("cylinder", CYLINDER, np.pi / 4, 2),
                                      ("sphere", SPHERE, np.pi / 6, None)):
        off = []
        for count in (250, 2000):
            cells = of_packing(folder, *loose(count, *shape))
            off.append(sound(f"a {name}", cells, volume, 0.1, [(OUTER, 0.5, flat)]))
            theirs = compare_clear(f"  {name}", cells, ARGUMENTS[name], folder, None)
            ok(cells.volumes()[0].sum() < volume < theirs,
               "  the true volume lies between chords and tangent planes")
        # twice as many grains across: chords miss a quarter
        ok(3 < off[0] / off[1] < 5.5, f"  what is missed falls from {-off[0]:.4f} to {-off[1]:.4f}")
        for sizes, power in (((), False), (SIZES, True)):
            cells = of_packing(folder, *loose(500, *shape), *sizes)
            radius = cells.radius if power else None
            sound(f"a {name}, {'many sizes' if power else 'one size'}", cells, volume, 0.05,
                  [(OUTER, 0.5, flat)])
            compare_clear(f"  {name}", cells, ARGUMENTS[name], folder, radius)
            compare_cut(f"  {name}", cells, flat, folder, radius)


def check_settled(folder):
    cells = of_packing(folder, "method=deposition", "radius=0.07", *SIZES, *CYLINDER)
    sound("settled in a cylinder", cells, np.pi / 4 * cells.edge[2], 0.05, [(OUTER, 0.5, 2)])
    compare_clear("  settled", cells, ARGUMENTS["cylinder"], folder, cells.radius)
    compare_cut("  settled", cells, 2, folder, cells.radius)


# ---- what no peer has --------------------------------------------------------------------

def check_shapes(folder):
    outer, inner = (OUTER, 0.5, 2), (INNER, 0.25, 2)
    many = loose(1500)
    sound("a ring", of_packing(folder, *many, *RING), np.pi * 3 / 16, 0.01, [outer, inner])
    sound("a cylinder that repeats", of_packing(
        folder, *many, *CYLINDER, "periodic=[false,false,true]"), np.pi / 4, 0.02, [outer])
    sound("a ring that repeats", of_packing(
        folder, *many, *RING, "periodic=[false,false,true]"), np.pi * 3 / 16, 0.01, [outer, inner])
    hole = ["domain.cut.radius=0.25"]
    sound("around a sphere", of_packing(folder, *many, *BOX, "domain.cut.shape=sphere", *hole),
          1 - np.pi / 48, 0.01, [(INNER, 0.25, None)])
    low = ["domain.cut.shape=sphere", "domain.cut.centre=[0.26,0.5,0.26]", *hole]
    sound("around a sphere where the box repeats", of_packing(
        folder, *many, *BOX, *low, "periodic=[true,false,true]"), 1 - np.pi / 48, 0.01)
    sound("around a cylinder where the box repeats", of_packing(
        folder, *many, *BOX, "domain.cut.shape=cylinder", *hole, "periodic=[true,true,true]"),
        1 - np.pi / 16, 0.01, [inner])
    sound("around a cylinder through the box", of_packing(
        folder, *many, *BOX, "domain.cut.shape=cylinder", *hole), 1 - np.pi / 16, 0.01, [inner])
    sound("around a sphere in a sphere", of_packing(
        folder, *many, *SPHERE, "domain.cut.shape=sphere", *hole), np.pi * 7 / 48, 0.02,
        [(OUTER, 0.5, None), (INNER, 0.25, None)])
    cut = of_packing(folder, *many, *BOX, "domain.cut.shape=box", "domain.cut.lower=[0.3,0.3,0.3]",
                     "domain.cut.upper=[0.7,0.7,0.7]")
    sound("around a box", cut, 1 - 0.4**3, 0.02, euler={2, 4})  # one grain may be on two sides
    rim = (cut.node - 0.5)[cut.walls & INNER > 0]
    ok(np.abs(np.abs(rim).max(1) - 0.2).max() < 1e-15, "  nodes on the sides of the box")
    disc = of_packing(folder, "method=random_sequential", "dimensions=2", "radius=0.01", *SPHERE,
                      "count=800", options=("--set", "dimensions=2"))
    area, around = np.abs(disc.areas()[:, 1]).sum() / (np.pi / 4), throats_around(disc)
    ok(off_wall(disc, OUTER, 0.5, 1) < 1e-12 and (around == 3).all() and 0.99 < area < 1
       and len(disc.node) - len(disc.ends) + len(disc.sides) == 1, "a layer in a disc", area)


def check_right_angles(folder):
    """Where the three grains beside a throat are equally far from a sphere."""
    random = np.random.default_rng(3)
    at = random.normal(size=(400, 3))
    at *= np.repeat([0.45, 0.3], 200)[:, None] / np.linalg.norm(at, axis=1)[:, None]
    path = os.path.join(folder, "shells")
    cells = of_packing(folder, *loose(400, *SPHERE))
    with h5py.File(os.path.join(folder, "own-packing.h5"), "r+") as file:
        file["particles/position"][...] = at + 0.5
        file["particles/radius"][...] = 1e-3
    run("tessellate", "-q", os.path.join(folder, "own-packing.h5"), "-o", path)
    cells = Diagram(path)
    walls = cells.walls[cells.ends] & OUTER > 0
    meets = cells.ends[walls[:, 0] != walls[:, 1]]
    on = np.where(cells.walls[meets[:, 1]] & OUTER, 1, 0)
    foot = cells.node[meets[np.arange(len(meets)), on]]
    along = foot - cells.node[meets[np.arange(len(meets)), 1 - on]]
    sine = np.linalg.norm(np.cross(along, foot - 0.5), axis=1)
    sine /= np.linalg.norm(along, axis=1) * 0.5
    ok(len(meets) == 2 * 200 - 4 and sine.max() < 1e-9,
       f"{len(meets)} throats meet a sphere at right angles", sine.max())


def check_scales(folder):
    one = of_packing(folder, *loose(400, *RING))
    for scale, last in ((2.0**-30, True), (1e-9, False), (1e3, False)):
        many = [f"radius={0.16 * 400**(-1 / 3) * scale!r}", "count=400",
                "method=random_sequential", "domain.shape=ring", f"domain.radius={0.5 * scale!r}",
                f"domain.inner_radius={0.25 * scale!r}", f"domain.height={scale!r}"]
        cells = of_packing(folder, *many)
        sound(f"a ring of {scale:g} m", cells, np.pi * 3 / 16 * scale**3, 0.02,
              [(OUTER, 0.5 * scale, 2), (INNER, 0.25 * scale, 2)])
        same = np.array_equal(cells.ends, one.ends) and np.array_equal(cells.corner, one.corner)
        off = np.abs(cells.node / scale - one.node).max()
        ok(same and (off == 0 if last else off < 1e-12), "  the same network", (same, off))


def check_elimination(folder):
    for name, shape in (("cylinder", CYLINDER), ("ring", RING)):
        whole = of_packing(folder, *loose(800, *shape))
        run("tessellate", "-q", "--set", "boundary=eliminate", os.path.join(
            folder, "own-packing.h5"), "-o", os.path.join(folder, "some.h5"))
        some = Diagram(os.path.join(folder, "some.h5"))
        cut = np.unique(whole.sides[whole.sides[:, 1] < 0, 0])
        stays = np.setdiff1d(np.arange(800), cut)
        wanted = np.isin(whole.sides, stays).any(1)
        ok(len(stays) > 100 and np.array_equal(some.sides, whole.sides[wanted])
           and np.array_equal(some.place, whole.place[wanted[whole.face]])
           and some.volumes()[1][stays].max() < 1e-12
           and set(some.walls[some.corner[~np.isin(some.sides, stays).all(1)[some.face]]] > 0)
           == {True},
           f"{len(stays)} of 800 cells clear of a {name}'s walls stay, whole")


def check_chain(folder):
    """Merged nodes stay on their walls, the rest of the chain takes such networks, and they come
    back from the JSON graph as they were."""
    at = lambda name: os.path.join(folder, name + ".h5")
    of_packing(folder, *loose(200, *RING), "bonds=touching", "touching_gap=0.5")
    for stage, source, target in (("merge-nodes", "own", "merged"), ("dry", "merged", "dried"),
                                  ("force-protocol", "dried", "forces")):
        run(stage, "-q", at(source), "-o", at(target))
    merged = Diagram(at("merged"))
    off = max(off_wall(merged, OUTER, 0.5, 2), off_wall(merged, INNER, 0.25, 2))
    ok(off < 1e-12 and merged.volumes()[1].max() < 1e-11, "merged nodes on their walls", off)
    run("inspect", "--openpnm", os.path.join(folder, "graph.json"), at("merged"))
    run("import-network", os.path.join(folder, "graph.json"), "-o", at("back"))
    with h5py.File(at("merged")) as one, h5py.File(at("back")) as other:
        names = ["domain/bodies/shape", "domain/bodies/within", "domain/bodies/lower",
                 "domain/bodies/upper", "nodes/kind", "faces/particles", "throats/nodes"]
        ok(all(np.array_equal(one[n][()], other[n][()]) for n in names), "exported and imported")


def check_far(folder):
    """A thousand of its sizes from the origin a body has the same throats, and dries in the same order: throats
    that are narrowest at one node on the wall are equally wide there, too."""
    here, far = os.path.join(folder, "here.h5"), os.path.join(folder, "far.h5")
    for title, shape in (("a cylinder", CYLINDER), ("a ring", RING)):
        run("pack", "-q", *sets("method=radius_expansion", "count=200", "radius=0.05", "dynamics.friction=0", "seed=3", *shape), "-o", here)
        run("pack", "-q", *sets("method=import"), here, "-o", far)
        with h5py.File(far, "r+") as file:
            for name in ("particles/position", "domain/lower", "domain/upper", "domain/bodies/lower", "domain/bodies/upper"):
                file[name][...] += [1000, -700, 400]
        orders = []
        for packing in (here, far):
            run("tessellate", "-q", packing, "-o", packing + ".net")
            run("dry", "-q", packing + ".net", "-o", packing + ".dry")
            with h5py.File(packing + ".dry") as file:
                orders.append((file["events/throat"][:], file["throats/radius"][:], file["throats/nodes"][:]))
        (one, radius, nodes), (other, far_radius, far_nodes) = orders
        alike = np.array_equal(nodes, far_nodes) and np.allclose(radius, far_radius, rtol=1e-9, atol=1e-12)
        ok(alike and np.array_equal(one, other), f"{title}: far from the origin as at it",
           (alike, np.count_nonzero(one != other), len(one)) if alike else alike)


def tessellate_refuses(title, pattern, folder, *settings, grains=None):
    path = os.path.join(folder, "refused.h5")
    run("pack", "-q", *sets(*settings), "-o", path)
    if grains is not None:
        with h5py.File(path, "r+") as file:
            file["particles/position"][: len(grains)] = grains
    refused(title, pattern, "tessellate", path, "-o", path + "-")


with scratch() as folder:
    if has_voro():
        check_peer(folder)
        check_settled(folder)
    check_shapes(folder)
    check_right_angles(folder)
    check_scales(folder)
    check_elimination(folder)
    check_chain(folder)
    check_far(folder)
    tessellate_refuses("a grain outside the cylinder", "row 0: the centre must be in the cylinder", folder,
                       *loose(20, *CYLINDER), grains=[[0.05, 0.05, 0.5]])
    tessellate_refuses("a grain in the core of a ring", "row 0: the centre must be outside the cylinder",
                       folder, *loose(20, *RING), grains=[[0.5, 0.5, 0.5]])
    tessellate_refuses("one grain in a sphere", "do not span three dimensions", folder, *loose(1, *SPHERE))
    tessellate_refuses("a hole smaller than the cells", "no throat meets", folder, *loose(20, *BOX),
                       "domain.cut.shape=sphere", "domain.cut.radius=1e-3")
done()
