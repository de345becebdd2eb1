#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# The flow through packings against an independent evaluation of Chareyre's equations and
# Yade's FlowEngine (reference/), and what must hold of any flow: what flows in flows
# out, forces sum to the pressure drop times the section, the tensor is symmetric.
import csv
import shutil
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, run, scratch_paths, sets

REFERENCE = "tests/physics/flow/reference/"


def table(name):
    with open(REFERENCE + name) as file:
        rows = [row for row in csv.reader(file) if not row[0].startswith("#")]
    return rows[0], rows[1:]


def numbers(name):
    return np.array(table(name)[1], float)


def pack(grains, path, periodic="[false,false,false]", upper="[1,1,1]"):
    text = "\n".join(" ".join(f"{x:.17g}" for x in grain) for grain in grains)
    run("pack", "-q", "--set", "method=import", "--set", "lower=[0,0,0]", "--set",
        f"upper={upper}", "--set", "bonds=none", "--set", f"periodic={periodic}", "-o", path,
        input=text.encode())
    return path


def flow(path, **settings):
    """Of the fluid of viscosity 1 along y; pressure 1 on the upper wall, as in the tables."""
    settings = {"along": "none", "pressure.y_lower": 0, "pressure.y_upper": 1,
                "viscosity": 1, **settings}
    options = [f"--set={key}={value}" for key, value in settings.items()]
    run("flow", "-q", *options, path, "-o", path + ".flow")
    return h5py.File(path + ".flow", "r")


def permeability(result):
    return -result["walls/inflow"][2]


def total(result):
    """Every force on the solid, walls included."""
    return sum(result[name][:].sum(axis=0) for name in
               ("particles/viscous_force", "particles/pressure_force",
                "walls/viscous_force", "walls/pressure_force"))


def conserves(result, title):
    inflow = result["walls/inflow"][:]
    force = (result["particles/viscous_force"][:] + result["particles/pressure_force"][:])
    drag = force.sum(axis=0)[1] + result["walls/viscous_force"][:, 1].sum()
    ok(abs(inflow.sum()) < 1e-12 * np.abs(inflow).max(), f"{title}: in = out", inflow)
    ok(abs(drag + 1) < 1e-12 and np.abs(total(result)).max() < 1e-12,
       f"{title}: the forces sum to the drop times the section", (drag, total(result)))


def cells_by_corners(result):
    """Pressure of each cell by its corners, as the tables number them: six walls first."""
    corners = result["pores/particles"][:]
    corners = np.where(corners < 0, -1 - corners, corners + 6)
    return {tuple(sorted(c)): p for c, p in zip(corners, result["pores/pressure"][:])}


with scratch_paths() as at:
    header, rows = table("summary.csv")
    expected = {(r[0], r[1], r[2]): float(r[header.index("K_ref")]) for r in rows}
    for name in ("packing_200_r0.9", "packing_2000_r0.9"):
        grains = numbers(name + ".csv")
        path = pack(grains, at(name))
        for sides, lateral, variant, short in (
                ("no-slip", "no-slip", "paper-literal", "noslip"),
                ("symmetric", "symmetry", "paper-literal", None),
                ("symmetric-yade", "symmetry", "yade-like", "sym")):
            title = f"{len(grains)} grains, {sides}"
            result = flow(path, sides=sides, pieces="unsigned")
            conserves(result, title)
            reference = expected[name, lateral, variant]
            error = permeability(result) / reference - 1
            # Printed to 9 digits; the variant like Yade has its limits on conductances too,
            # which cut a few throats: also in the forces and pressures below.
            ok(abs(error) < (1e-6 if variant == "yade-like" else 2e-9),
               f"{title}: permeability {permeability(result):.9g}", error)
            if not short:
                continue
            forces = numbers(f"forces_{name}_{short}.csv")
            who = forces[:, 0].astype(int)
            ours = np.hstack([-result[f"particles/{kind}_force"][:][who]
                              for kind in ("viscous", "pressure")])
            error = np.abs(ours - forces[:, 1:7]).max()
            ok(error < 1e-6, f"{title}: forces", error)
            cells = numbers(f"cells_{name}_{short}.csv")
            pressure = cells_by_corners(result)
            error = np.array([pressure.get(tuple(sorted(c[:4].astype(int))), np.nan) - c[8]
                              for c in cells])
            ok(np.isfinite(error).all() and np.abs(error).max() < 1e-4,
               f"{title}: cells and their pressures", np.abs(error).max())

    # Drag on spheres in lattices that repeat, over 6 pi mu a U, against Stokes flow (Zick and
    # Homsy 1982): the model is to be within a tenth at contact, and the same along each axis.
    sites = {"sc": ([(0, 0, 0)], 1, 42.1),
             "bcc": ([(0, 0, 0), (.5, .5, .5)], 3 ** .5 / 2, 162.9),
             "fcc": ([(0, 0, 0), (0, .5, .5), (.5, 0, .5), (.5, .5, 0)], .5 ** .5, 435)}
    for name, (places, distance, stokes) in sites.items():
        path = pack([(*(x + .25 for x in p), distance / 2) for p in places], at(name),
                    "[true,true,true]")
        result = flow(path, along="x", permeability_tensor="true", **{
            "pressure.y_lower": "null", "pressure.y_upper": "null"})
        tensor = result["permeability"][:]
        drag = 1 / (6 * np.pi * distance / 2 * len(places) * tensor[0, 0])
        ok(abs(drag / stokes - 1) < .1, f"{name}: drag {drag:.4g}, Stokes {stokes}")
        ok(np.abs(tensor / tensor[0, 0] - np.eye(3)).max() < 1e-9, f"{name}: isotropic", tensor)
        force = total(result)
        ok(np.abs(force - [1, 0, 0]).max() < 1e-12, f"{name}: drag is drop times section", force)

    # Small grains with Stokes' drag. Between eight spheres the fluid is 4.62 times as fast in the
    # middle as in the mean (docs/flow.md). The forces still sum up, and in a packing they hardly
    # change.
    corners = [(x, y, z, .25) for x in (.25, .75) for y in (.25, .75) for z in (.25, .75)]
    for radius in (1e-3, 1e-5):
        path = pack(corners + [(.5, .5, .5, radius)], at("small"))
        result = flow(path, sides="symmetric", stokes_drag="true")
        conserves(result, f"Stokes drag on {radius:g}")
        force = -(result["particles/viscous_force"][8] + result["particles/pressure_force"][8])[1]
        ratio = force / (6 * np.pi * radius * 4.62 * permeability(result))
        ok(abs(ratio - 1) < .1, f"Stokes drag on {radius:g}: {ratio:.3f} of that in the middle")
    forces = []
    for with_it in ("false", "true"):
        result = flow(at("packing_200_r0.9"), stokes_drag=with_it)
        forces.append(result["particles/viscous_force"][:] + result["particles/pressure_force"][:])
    change = np.linalg.norm(forces[1] - forces[0], axis=1).max() / np.abs(forces[0]).max()
    ok(change < .02, f"Stokes drag in a packing changes forces by {change:.4f} of the largest")

    # The stress of the fluid: pores sum to the mean, and the mean of the viscous part is what
    # enters through the walls, by Gauss.
    for imposed in ({"flux.x_lower": 1, "pressure.y_upper": 0}, {"along": "z"}):
        result = flow(at("packing_200_r0.9"), pore_stress="true", **{
            "along": "none", "pressure.y_lower": "null", "pressure.y_upper": "null", **imposed})
        volume, stress = result["pores/volume"][:], result["pores/stress"][:]
        mean, inflow = result["stress"][:], result["walls/inflow"][:]
        void = 1 - 4 / 3 * np.pi * (numbers("packing_200_r0.9.csv")[:, 3] ** 3).sum()
        ok(abs(volume.sum() / void - 1) < 1e-12, "pores fill the void", (volume.sum(), void))
        difference = np.einsum("i,ijk->jk", volume, stress) / volume.sum() - mean
        ok(np.abs(difference).max() < 1e-12 * np.abs(mean).max(), "stresses of pores: their mean",
           difference)
        viscous = stress + result["pores/pressure"][:][:, None, None] * np.eye(3)
        trace = np.einsum("ijj->i", viscous) * volume
        ok(np.abs(trace).max() < 1e-10 * np.abs(viscous * volume[:, None, None]).max(),
           "stresses of pores: the viscous part has no trace", np.abs(trace).max())
        through = -2 * np.diag(inflow.reshape(3, 2).sum(axis=1)) / volume.sum()
        error = mean + result["summary"].attrs["mean_pressure"] * np.eye(3) - through
        ok(np.abs(error).max() < 1e-12 * np.abs(mean).max(), "stress of the fluid, by Gauss", error)

    # Both solvers, any number of threads, any scale.
    path = at("packing_200_r0.9")
    both = [permeability(flow(path, solver=solver)) for solver in ("cholesky", "iteration")]
    ok(abs(both[0] / both[1] - 1) < 1e-11, "both solvers agree", both)
    one, two = (run("flow", "--threads", n, "--set=solver=iteration", path) for n in (1, 2))
    ok(one == two, "the same bytes on two threads")
    small = pack(numbers("packing_200_r0.9.csv") * 1e-9, at("small"), upper="[1e-9,1e-9,1e-9]")
    ratio = permeability(flow(small, solver="cholesky")) / both[0]
    ok(abs(ratio / 1e-27 - 1) < 1e-9, "a scene of a nanometre", ratio)

    # What flows in through one wall at a given rate.
    imposed = flow(path, **{"pressure.y_upper": "null", "flux.y_upper": both[0]})
    ok(abs(imposed["walls/pressure_force"][3, 1] - 1) < 1e-9, "a flux that is imposed",
       imposed["walls/pressure_force"][:])

    # Where the pressure is the same everywhere, nothing flows.
    for solver in ("cholesky", "iteration"):
        still = flow(path, **{"pressure.y_upper": 3, "pressure.y_lower": "null",
                              "pressure.x_lower": 3, "solver": solver})
        ok(np.all(still["pores/pressure"][:] == 3) and np.all(still["throats/flux"][:] == 0),
           f"one pressure, and no flow ({solver})", np.ptp(still["pores/pressure"][:]))

    # A box that is squeezed along x pushes out just its volume.
    squeezed = flow(path, **{"pressure.y_upper": 0, "strain_rate": "[-0.01,0,0]"})
    ok(abs(squeezed["walls/inflow"][:].sum() + 0.01) < 1e-13, "squeezed: what is lost flows out",
       squeezed["walls/inflow"][:])

    # In a box that repeats the strain moves whole boxes: where it begins does not matter, eight
    # boxes are as one, and what the box gains flows in.
    generator = np.random.default_rng(7)
    grains = np.column_stack([generator.uniform(0, 1, (25, 3)), generator.uniform(.05, .15, 25)])
    corners = np.stack(np.meshgrid(*[[0, 1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    drags = lambda of: of["particles/viscous_force"][:] + of["particles/pressure_force"][:]
    for repeats, strain in ("[true,true,true]", "[0.01,-0.03,0.02]"), ("[true,true,false]", "[0.01,-0.03,0.04]"):
        above = {"pressure.y_lower": "null", "pressure.y_upper": "null", "strain_rate": strain,
                 "pressure.z_upper": 0 if "false" in repeats else "null"}
        def strained(rows, name, upper):
            np.savetxt(at(name + ".txt"), rows, fmt="%.17g")
            run("pack", "-q", *sets("method=import", "bonds=none", "check=none", "lower=[0,0,0]", f"upper={upper}", f"periodic={repeats}"),
                at(name + ".txt"), "-o", at(name))
            return flow(at(name), **above)
        as_is = strained(grains, "strained", [1, 1, 1])
        moved = strained(np.column_stack([(grains[:, :2] + [.37, .21]) % 1, grains[:, 2:]]), "moved", [1, 1, 1])
        largest = np.abs(drags(as_is)).max()
        ok(largest > 0 and np.abs(drags(as_is) - drags(moved)).max() < 1e-8 * largest, f"strained, {repeats}: from another corner the same",
           np.abs(drags(as_is) - drags(moved)).max() / largest)
        ok(abs(as_is["walls/inflow"][:].sum() - (0.02 if "false" in repeats else 0)) < 1e-12, "  what the box gains flows in",
           as_is["walls/inflow"][:])
        if "false" in repeats:
            continue
        # The mean pressure too, whatever the grains' numbers; 0 where no wall has one.
        for wall in {}, {"flux.z_lower": 1, "flux.z_upper": -1}:
            above_now = {"along": "none" if wall else "y", "pressure.y_lower": "null", "pressure.y_upper": "null", **wall}
            means = []
            for order, by in (np.arange(25), 0), (generator.permutation(25), 0), (np.arange(25), .37):
                rows = np.column_stack([(grains[order][:, :2] + by) % 1, grains[order][:, 2:]])
                numbered = pack(rows, at("gauge"), periodic="[true,true,false]" if wall else repeats)
                result = flow(numbered, **above_now)
                means.append(result["summary"].attrs["mean_pressure"])
                spread = np.ptp(result["pores/pressure"][:])
            ok(spread > 0 and np.abs(means).max() < 1e-12 * spread, f"the mean pressure is 0 ({wall or 'a gradient'})", (means, spread))
        boxes = generator.integers(-1, 2, (25, 3))
        strained(grains, "far", [1, 1, 1])
        with h5py.File(at("far"), "r+") as far:  # places boxes away, and velocities there
            far["particles/position"][:] = grains[:, :3] + boxes
            far["particles"].create_dataset("velocity", data=(grains[:, :3] + boxes) * [0.01, -0.03, 0.02] + 5)
            far["particles/velocity"].attrs["units"] = "m s-1"
        ok(np.abs(drags(as_is) - drags(flow(at("far"), **above))).max() < 1e-8 * largest,
           "  velocities are those at the places given, and a common one is none")
        with h5py.File(at("far"), "r+") as far:
            far["particles/velocity"][:] = [1, 2, 3]
        at_rest = flow(at("far"), **{**above, "strain_rate": "[0,0,0]"})
        ok((drags(at_rest) == 0).all() and (at_rest["throats/flux"][:] == 0).all(), "  grains that move all alike drive no fluid")
        eight = strained(np.vstack([grains + [*corner, 0] for corner in corners]), "eight", [2, 2, 2])
        ok(np.abs(np.tile(drags(as_is), (8, 1)) - drags(eight)).max() < 1e-8 * largest, "  eight boxes are as one")

    # Between walls along which the pressure falls: what presses on them depends neither on the
    # numbers of grains nor on where the box begins, and balances that on the grains.
    for repeats in "[true,false,false]", "[true,true,false]":
        pressed = []
        for order, by in (np.arange(25), 0), (generator.permutation(25), 0), (np.arange(25), .37):
            rows = np.column_stack([(grains[order][:, 0] + by) % 1, grains[order][:, 1:]])
            result = flow(pack(rows, at("between"), periodic=repeats), along="x",
                          **{"pressure.y_lower": "null", "pressure.y_upper": "null"})
            pressed.append(result["walls/pressure_force"][:])
            ok(np.abs(total(result) - [1, 0, 0]).max() < 1e-12, f"between walls, {repeats}: forces are the drop times the section",
               total(result))
        ok(np.abs(pressed[0]).max() > 1e-4 and np.ptp(pressed, axis=0).max() < 1e-9 * np.abs(pressed[0]).max(),
           "  those on the walls are the same of other numbers and from another corner", np.ptp(pressed, axis=0).max())

        # Walls open to fluid whose pressure falls alike: each has the pressure given, by its area 1, and
        # what they add to the flow is that of the walls alone, as the balances are linear.
        parts = [flow(at("between"), along=along, pressure_drop=drop, **{"pressure.y_lower": "null", "pressure.y_upper": "null",
                      "pressure.z_lower": low, "pressure.z_upper": high})
                 for along, drop, low, high in (("x", 1, 2, 3), ("x", 1, 0, 0), ("none", 1, 2, 3))]
        press = [part["walls/pressure_force"][4:, 2] for part in parts]
        ok(np.abs(press[0] - [-2, 3]).max() < 1e-12 and np.abs(press[1]).max() < 1e-12, "  open walls have the pressures given", press)
        inflow = [part["walls/inflow"][:] for part in parts]
        ok(np.abs(inflow[0] - inflow[1] - inflow[2]).max() < 1e-12 * np.abs(inflow[2]).max(), "  and their flows add up", inflow)

    # Archimedes: grains weigh less by the fluid that they take the place of, and the piezometric
    # pressure knows nothing of it.
    wet = flow(path, density=1000, gravity="[1,0,-9.81]")
    volume = 4 / 3 * np.pi * wet["particles/radius"][:] ** 3
    lift = -1000 * volume[:, None] * [1, 0, -9.81]
    ok(np.allclose(wet["particles/buoyancy"][:], lift, rtol=1e-13, atol=0), "buoyancy")
    ok(permeability(wet) == both[0], "and the flow is the same", permeability(wet) / both[0] - 1)

    # Hard cases: one sphere, small ones in a void, overlap that closes throats.
    one = pack([(.5, .5, .5, .5)], at("one"))
    conserves(flow(one), "one sphere")
    generator = np.random.default_rng(1)
    floating = [(*generator.uniform(.4, .6, 3), .0025) for _ in range(30)]
    lattice = [(x, y, z, .25) for x in (.25, .75) for y in (.25, .75) for z in (.25, .75)]
    conserves(flow(pack(lattice + floating, at("floating"))), "a hundred times smaller grains")
    overlapping = pack([(x, y, z, .3) for x, y, z, _ in lattice], at("overlapping"))
    result = flow(overlapping)
    ok(result["summary"].attrs["closed_throats"] > 0 and np.abs(total(result)).max() < 1e-12,
       "overlap closes throats, and the forces still sum up", total(result))

    # A wall beside the drop that lets fluid through: what flows is no measure of the permeability.
    has_one = ["permeability" in flow(pack(lattice, at(f"beside_{upper}")), along="x", **{
        "pressure.y_lower": "null", "pressure.y_upper": "null", "pressure.z_upper": upper})["summary"].attrs
        for upper in ("null", 0.5)]
    ok(has_one == [True, False],
       "no permeability where fluid passes a wall beside the drop", has_one)

    # Empty space above a bed: the permeability of the bed is that of a box that ends where it
    # ends, and a line says which is which.
    run("pack", "-q", "--set", "method=deposition", "--set", "count=400", "--set", "radius=5e-4",
        "--set", "seed=2", "--set", "dynamics.time_step_safety=0.1", "-o", at("bed"))
    with h5py.File(at("bed")) as bed:
        top = (bed["particles/position"][:, 2] + bed["particles/radius"][:]).max()
    found = {}
    for height in 1, 1.3, 4:
        shutil.copy(at("bed"), at("tall"))
        with h5py.File(at("tall"), "r+") as bed:
            bed["domain/upper"][2] = height * top
        for along in "zx":
            said = subprocess.run([f"{BIN}/flow", "--set", f"along={along}", at("tall"), "-o", at("through")],
                                  capture_output=True, text=True).stderr
            found[height, along] = h5py.File(at("through"))["summary"].attrs["bed_permeability"], said
    tight = found[1, "z"][0]
    ok(all(abs(found[height, "z"][0] / tight - 1) < 0.01 for height in (1.3, 4)),
       "a bed is as permeable with empty space above it", found)
    ok(found[1, "z"][1] == found[1, "x"][1] == "" and "bed_permeability that of the bed" in found[4, "z"][1]
       and "fluid passes beside them" in found[4, "x"][1], "and the space is said", found)

    # What dem-replay takes.
    run("pack", "-q", "--set=method=cubic", "--set=counts=[3,3,4]", "-o", at("lattice"))
    run("flow", "-q", "--set=write=forces", at("lattice"), "-o", at("forces"))
    run("dem-replay", "-q", "--set=cycles=20", at("forces"), "-o", at("response"))
    with h5py.File(at("forces")) as forces:
        edge = forces["domain/upper"][:] - forces["domain/lower"][:]
        last = forces["force"][-1].sum(axis=0)
        ok(0 < last[2] < edge[0] * edge[1], "the forces are replayed", last)
done()
