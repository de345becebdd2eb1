#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# The boundary layer on networks of all kinds [K 3.3.5, 3.7]: regular and irregular, of layers
# and in space, truncated and with cut cells left out, open on any side, on nodes of the
# surface or of an auxiliary layer. While all of the surface is wet the rate is that of
# diffusion in one dimension, whatever the network: D M p_g/(R T eps) A ln(p_g/(p_g - p_v)).
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, WATER, done, ok, run, scratch_paths, sets

DIFFUSIVITY, GAS, FALL = 2.5685e-5, 8.31446261815324, -np.log1p(-2339 / 1e5)
DENSITY = 1e5 * 0.01802 / (GAS * 293.15)
WALLS = "-x", "+x", "-y", "+y", "-z", "+z"


def one_dimension(area, thickness):
    return DIFFUSIVITY * DENSITY * FALL * area / thickness


class Network:
    def __init__(self, path):
        with h5py.File(path) as file:
            get = lambda name: file[name][()]
            self.node, self.walls = get("nodes/position"), get("nodes/kind")
            self.ends, self.kind = get("throats/nodes"), get("throats/kind")
            self.sides = get("faces/particles")
            self.loops = np.split(get("faces/nodes"), get("faces/offset")[1:-1])
            self.lower, self.upper = get("domain/lower"), get("domain/upper")
            self.grain = get("particles/position")
            self.auxiliary = get("particles/kind") == 1 if "particles/kind" in file \
                else np.zeros(len(self.grain), bool)
        self.wet = np.unique(self.ends[self.kind == 0])

    def face(self, axis):
        """Area of the rectangle that the liquid spans across AXIS."""
        span, box = np.ptp(self.node[self.wet], axis=0), self.upper - self.lower
        edge = np.where(span > 1e-9 * box, span, box)
        return np.prod(np.delete(edge, axis))

    def feet(self):
        """Nodes where throats of the boundary layer begin."""
        return np.intersect1d(self.wet, self.ends[self.kind == 1])


with scratch_paths() as at:
    def make(name, pack, *tessellate, threshold=0.1, grains=None):
        """What the stages make, and the network as it is."""
        run("pack", "--quiet", *sets("bonds=none", *pack), *(grains or []), "-o", at("p"))
        run("tessellate", *sets(*tessellate), at("p"), "-o", at("t"))
        run("merge-nodes", *sets("measure=mean_length", f"threshold={threshold}"), at("t"),
            "-o", at(name))
        return Network(at(name))

    def dry(name, *how):
        run("dry", "--quiet", *sets("throat_radius.distribution=normal",
                                    "boundary_layer.mass_transfer=5.1",
                                    "boundary_layer.layers=4", *WATER, *how), at(name),
            "-o", at("d"))
        file = h5py.File(at("d"))
        return {key: file[f"history/{key}"][:] for key in ("time", "saturation", "rate")} \
            | {"events": file["events/throat"][:], "kind": file["throats/kind"][:],
               "end": file["summary"].attrs["first_period_end_saturation"],
               "areas": file["boundary_layer/area"][:].sum(),
               "model": file.attrs["model"].decode()}

    # ---- the first rate, whatever the network -----------------------------------------
    regular = ["method=cubic", "counts=[5,5,5]", "radius=2.5e-7"]
    triangular = ["method=hexagonal", "dimensions=2", "counts=[6,1,4]", "radius=2.5e-7"]
    settled = ["method=deposition", "count=150", "radius=2.5e-7"]
    flat = ["method=random_sequential", "dimensions=2", "count=60", "radius=2.5e-7",
            "upper=[5e-6,0,5e-6]"]
    for label, pack, dimensions in [("regular", regular, 3), ("irregular", settled, 3),
                                    ("regular layer", triangular, 2),
                                    ("irregular layer", flat, 2)]:
        for boundary in "truncate", "eliminate":
            network = make("n", pack, f"dimensions={dimensions}", f"boundary={boundary}",
                           threshold=1e-6 if "regular" == label else 0.1)
            error = []
            for k, wall in enumerate(WALLS):
                if dimensions == 2 and k // 2 == 1:
                    continue
                dried, face = dry("n", f'open=["{wall}"]'), network.face(k // 2)
                error += [abs(dried["rate"][0] / one_dimension(face, DIFFUSIVITY / 5.1) - 1),
                          abs(dried["areas"] / face - 1)]
            ok(max(error) < 1e-12, f"{label}, {boundary}: on {len(error) // 2} sides areas sum to the "
               "face, and the first rate is its", error)
            if boundary == "truncate":
                box = network.upper - network.lower
                ok(abs(network.face(2) / (box[0] * box[1]) - 1) < 1e-14,
                   f"{label}: which is the side of the box")

    # ---- bodies that are not boxes: what the faces in the wall cover ---------------------
    hole = ["domain.cut.shape=box", "domain.cut.lower=[1e-6,1e-6,0]",
            "domain.cut.upper=[2.5e-6,2e-6,4e-6]",
            "upper=[4e-6,4e-6,4e-6]"]
    round = ["domain.height=4e-6", "domain.radius=2.5e-6"]
    for label, shape in [("a cylinder", ["domain.shape=cylinder", *round]),
                         ("a ring", ["domain.shape=ring", *round, "domain.inner_radius=1e-6"]),
                         ("a box with a hole", hole)]:
        network = make("n", ["method=random_sequential", "count=200", "radius=2e-7", *shape])
        area = 0
        for k in np.flatnonzero(network.sides[:, 1] == -6):
            x = network.node[network.loops[k]]
            area += np.cross(x - x[0], np.roll(x - x[0], -1, 0)).sum(0)[2] / 2
        rate = dry("n")["rate"][0] / one_dimension(area, DIFFUSIVITY / 5.1)
        ok(abs(rate - 1) < 1e-12 and area < 0.98 * network.face(2),
           f"{label}: the first rate is that of its open face",
           (rate - 1, area / network.face(2)))

    run("pack", "-q", *sets("method=random_sequential", "count=60", "radius=2e-7", "domain.shape=sphere", "domain.radius=1.5e-6"), "-o", at("ball"))
    run("tessellate", "-q", at("ball"), "-o", at("t"))
    said = subprocess.run([f"{BIN}/dry", at("t"), "-o", at("d")], capture_output=True, text=True)
    ok(said.returncode == 65 and said.stderr.endswith("no throat reaches the open wall +z: the body is round there, and "
       "dries through flat sides of the box alone\n"), "a sphere has no side that dries, and is told so", said.stderr)

    # ---- cut cells left out: nodes know the walls they face ----------------------------
    cut = make("n", settled, threshold=0)
    cuts = np.zeros((len(cut.grain), 6), bool)
    for first, second in cut.sides[cut.sides[:, 1] < 0]:
        cuts[first, -1 - second] = True
    network = make("n", settled, "boundary=eliminate", threshold=0)
    outer, total = [], np.zeros(cut.grain.shape)
    for side, loop in zip(network.sides, network.loops):
        beyond = cuts[side].any(axis=1)
        if beyond.all() or not beyond.any():
            continue
        x = network.node[loop] - network.node[loop[0]]
        grain = side[beyond][0]
        total[grain] += np.cross(x, np.roll(x, -1, 0)).sum(0) * (1 if beyond[1] else -1)
        outer.append((grain, loop))
    along = np.where(cuts, np.stack([-total, total], 2).reshape(-1, 6), -np.inf)
    faces = np.zeros(len(network.node), int)
    for grain, loop in outer:
        faces[loop] |= 1 << int(along[grain].argmax())
    ok(len(outer) > 50 and (network.walls == faces).all(),
       "with cut cells left out, nodes face the walls that cut the cells beyond", len(outer))
    make("n", settled, "boundary=eliminate")
    sides = dry("n", 'imposed_empty=["-x","+x","-y","+y","-z"]')
    closed = dry("n")
    ok((sides["kind"] == 2).any() and not (closed["kind"] == 2).any()
       and sides["saturation"][-1] == 0,
       "their sides can be imposed empty, or closed", np.bincount(sides["kind"]))

    # ---- an auxiliary layer of grains [K Fig. 3.17, 3.43] -------------------------------
    for label, pack, dimensions in [("in space", settled, 3), ("in a layer", flat, 2)]:
        for boundary in "truncate", "eliminate":
            network = make("n", [*pack, "extra_layer=true"], f"dimensions={dimensions}",
                           f"boundary={boundary}")
            feet = network.node[network.feet()]
            extra = network.grain[network.auxiliary]
            beside = dict.fromkeys(map(tuple, np.sort(network.ends[network.kind == 1])), False)
            for side, loop in zip(network.sides, network.loops):
                if not any(s >= 0 and not network.auxiliary[s] for s in side):
                    continue
                for pair in zip(loop, np.roll(loop, -1)):
                    beside[tuple(sorted(pair))] = True
            layer = list(map(tuple, np.sort(network.ends[network.kind == 1])))
            ok(layer and not any(beside[pair] for pair in layer),
               f"auxiliary layer {label}, {boundary}: its throats have no grain beside them")
            shape = [len(np.unique(extra[:, axis])) for axis in (0, 1)]
            step = (network.upper - network.lower)[:2] / shape
            place = (feet[:, :2] - network.lower[:2]) / step
            axes = [0, 1] if dimensions == 3 else [0]
            uneven = np.abs(place - np.rint(place))[:, axes].max()
            most = np.prod([n + 1 for n in shape[:len(axes)]])
            ok(uneven < 0.1 and (len(feet) == most if boundary == "truncate"
                                  else 0 < len(feet) < most),
               f"auxiliary layer {label}, {boundary}: columns on the corners of its grains",
               (uneven, len(feet), most))
            face = one_dimension(network.face(2), DIFFUSIVITY / 5.1)
            for columns in "auxiliary", "surface":
                rate = dry("n", f"boundary_layer.columns={columns}")["rate"][0]
                ok(abs(rate / face - 1) < 1e-12, f"{columns} columns {label}, {boundary}: the "
                   "first rate is that of the open face", rate / face - 1)
    for k, wall in enumerate(WALLS):
        network = make("n", [*settled, "extra_layer=true", f"extra_side={wall}"])
        rate = dry("n", f'open=["{wall}"]', "boundary_layer.columns=auxiliary")["rate"][0]
        face = one_dimension(network.face(k // 2), DIFFUSIVITY / 5.1)
        ok(abs(rate / face - 1) < 1e-12 and len(network.feet()) > 10,
           f"an auxiliary layer at {wall}: the first rate is that of the open face",
           (rate / face - 1, len(network.feet())))
    ok("columns on the nodes of the auxiliary layer"
       in dry("n", "boundary_layer.columns=auxiliary")["model"], "the model says so")

    # On a lattice the auxiliary layer goes on with it, so nothing may change but its being there.
    same = {}
    for extra, columns in ("false", "surface"), ("true", "surface"), ("true", "auxiliary"):
        make("n", [*regular, f"extra_layer={extra}"], threshold=1e-6)
        same[extra, columns] = dry("n", "throat_radius.distribution=network", "liquid=immobile",
                                   f"boundary_layer.columns={columns}",
                                   'imposed_empty=["-x","+x","-y","+y","-z"]')
        run("force-protocol", "--quiet", *sets("steps=20"), at("d"), "-o", at("f"))
        with h5py.File(at("f")) as file:
            same[extra, columns]["force"] = file["force"][:]
            same[extra, columns]["auxiliary"] = "kind" in file["particles"]
    bare, *others = same.values()
    for other, label in zip(others, ("surface", "auxiliary")):
        size = np.abs(bare["force"]).max()
        ok(len(other["time"]) == len(bare["time"])
           and np.abs(other["rate"] / bare["rate"][0] - bare["rate"] / bare["rate"][0]).max() < 1e-11
           and np.abs(other["time"] / bare["time"][-1] - bare["time"] / bare["time"][-1]).max()
           < 1e-11, f"a lattice dries alike with an auxiliary layer, columns on its {label}")
        ok(other["force"].shape == bare["force"].shape and not other["auxiliary"]
           and np.abs(other["force"] - bare["force"]).max() < 1e-10 * size,
           "and its grains feel the same forces; those of the layer are gone",
           np.abs(other["force"] - bare["force"]).max() / size)

    # ---- thickness ----------------------------------------------------------------------
    network = make("n", settled)
    box = network.upper - network.lower
    area = box[0] * box[1]
    given = lambda law, *how: dry("n", f"boundary_layer.from={law}", *how)["rate"][0]
    Re, Sc = 3 * 2e-3 / 1.53e-5, 1.53e-5 / DIFFUSIVITY
    flow = ["boundary_layer.flow_length=2e-3", "boundary_layer.air_velocity=3",
            "boundary_layer.kinematic_viscosity=1.53e-5"]
    slow = [flow[0], "boundary_layer.air_velocity=0"]
    for label, rate, thickness in [
            ("given", given("thickness", "boundary_layer.thickness=7e-6"), 7e-6),
            ("from Sh", given("sherwood", "boundary_layer.sherwood=4", flow[0]), 5e-4),
            ("from Sh over the open side", given("sherwood", "boundary_layer.sherwood=4"),
             max(box[:2]) / 4),
            ("of laminar flow along a plate [K 3.6]", given("plate", *flow),
             2e-3 / (0.664 * Re**0.5 * Sc**(1 / 3))),
            ("around a sphere in air at rest: its radius", given("sphere", *slow), 1e-3)]:
        ok(abs(rate / one_dimension(area, thickness) - 1) < 1e-12, f"thickness {label}", rate)
    said = subprocess.run([f"{BIN}/dry", "--set", "boundary_layer.thickness=7e-6", "--set",
                           "boundary_layer.mass_transfer=5.1", at("n"), "-o", at("d")], stderr=subprocess.PIPE, text=True).stderr
    ok("thickness = 7e-06 m does not count without boundary_layer.from=thickness" in said,
       "a thickness that does not count is said", said)
    Re = 0.3 * 2e-3 / 1.53e-5
    rate = given("sphere", flow[0], flow[2], "boundary_layer.air_velocity=0.3")
    ok(abs(rate / one_dimension(area, 2e-3 / (2 + 0.6 * Re**0.5 * Sc**(1 / 3))) - 1) < 1e-12,
       "thickness around a sphere in a draught")

    # ---- lattice and lumped, and scales ------------------------------------------------
    lattice = dry("n", "boundary_layer.layers=10")
    lumped = dry("n", "boundary_layer.exchange=lumped")
    ok(abs(lumped["rate"][0] / lattice["rate"][0] - 1) < 1e-12 and "lumped" in lumped["model"],
       "lumped transfer begins at the same rate")
    later = lambda history: np.interp(-0.8, -history["saturation"], history["rate"])
    ok(later(lattice) > 1.02 * later(lumped),
       "lateral diffusion keeps the rate up as the surface dries [K 3.3.5]",
       later(lattice) / later(lumped))
    with h5py.File(at("p")) as file:
        grains = np.column_stack([file["particles/position"], file["particles/radius"]])
        corner = file["domain/upper"][:]
    scaled = {}
    for size in 1e-9, 1e3:
        factor = size / 2.5e-7
        np.savetxt(at("grains"), grains * factor, fmt="%.17g")
        upper = "upper=" + str(list(map(float, corner * factor))).replace(" ", "")
        make("n", ["method=import", "lower=[0,0,0]", upper], grains=[at("grains")])
        scaled[size] = dry("n", "boundary_layer.from=thickness",
                           f"boundary_layer.thickness={10 * size!r}",
                           f"throat_radius.mean={0.4 * size!r}",
                           f"throat_radius.standard_deviation={0.01 * size!r}")
    small, large = scaled.values()
    ok((small["events"] == large["events"]).all()
       and np.abs(small["saturation"] - large["saturation"]).max() < 1e-12
       and np.abs(small["rate"][:-1] / large["rate"][:-1] * 1e12 - 1).max() < 1e-9,
       "grains of a nanometre and of a kilometre dry alike")
done()
