#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Packings and networks open in ParaView as they are (read here by VTK's own readers), and
# `inspect --vtk` writes what changes over time.
import glob
import os
import subprocess
import sys
import xml.etree.ElementTree as xml

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, run, scratch_paths

def grid_of(reader, path):
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()

def points(grid):
    return vtk_to_numpy(grid.GetPoints().GetData())

with scratch_paths() as at:
    chain = [("pack", "packing"), ("tessellate", "tessellation"), ("merge-nodes", "network"),
             ("dry", "drying"), ("force-protocol", "forces"), ("dem-replay", "response")]
    before = []
    for stage, name in chain:
        short = ["--set", "cycles=20"] if stage == "dem-replay" else []
        run(stage, "-p", SCENE, *short, *before, "-o", at(name + ".hdf"))
        before = [at(name + ".hdf")]

    packing, network = h5py.File(at("packing.hdf")), h5py.File(at("network.hdf"))
    grid = grid_of(vtkHDFReader(), at("packing.hdf"))
    ok(np.array_equal(points(grid), packing["particles/position"]),
       "a packing opens: grain centres are its points")
    ok(np.array_equal(vtk_to_numpy(grid.GetPointData().GetArray("radius")),
                      packing["particles/radius"]), "with their radii")
    grid = grid_of(vtkHDFReader(), at("network.hdf"))
    ok(np.array_equal(points(grid), network["nodes/position"])
       and grid.GetNumberOfCells() == 1020, "a network opens: nodes and throats")
    ends = [grid.GetCell(7).GetPointId(k) for k in range(2)]
    ok(ends == list(network["throats/nodes"][7]), "its cells are the throats")
    ok(np.array_equal(vtk_to_numpy(grid.GetCellData().GetArray("radius")),
                      network["throats/radius"]), "with their radii")

    scene = ["method=poisson", "count=50", "radius=0.01", "upper=[1,1,1]", "bonds=none",
             "periodic=[true,true,false]"]
    run("pack", *[f"--set={entry}" for entry in scene], "-o", at("periodic.hdf"))
    run("tessellate", at("periodic.hdf"), "-o", at("repeats.hdf"))
    run("dry", "--quiet", "--set=throat_radius.distribution=normal", at("repeats.hdf"), "-o",
        at("dried.hdf"))
    run("inspect", "--vtk", at("dried"), at("dried.hdf"))
    with h5py.File(at("repeats.hdf")) as repeats:
        inside = ~repeats["throats/image"][:].any(axis=1)
        length = np.where(inside, repeats["throats/length"], 0)
    for reader, name in [(vtkHDFReader(), "repeats.hdf"),
                         (vtkXMLUnstructuredGridReader(), "dried-0000.vtu")]:
        grid = grid_of(reader, at(name))
        ends = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 2)
        drawn = np.linalg.norm(np.diff(points(grid)[ends], axis=1), axis=2).ravel()
        ok(not inside.all() and np.allclose(drawn, length, rtol=1e-5, atol=1e-6),
           f"{name}: throats around a box that repeats are not drawn across it", (drawn, length))

    expected = {"drying": (11, 396, 1020, "saturation"), "forces": (11, 250, 250, None),
                "response": (6, 250, None, "crack")}
    for name, (frames, n_point, n_cell, array) in expected.items():
        run("inspect", "--vtk", at(name), at(name + ".hdf"))
        listed = [d.get("file") for d in xml.parse(at(name + ".pvd")).iter("DataSet")]
        made = sorted(os.path.basename(f) for f in glob.glob(at(name + "-*.vtu")))
        ok(listed == made and len(made) == frames, f"{name}: a series of {frames} frames", made)
        first = grid_of(vtkXMLUnstructuredGridReader(), at(made[0]))
        ok(first.GetNumberOfPoints() == n_point
           and (n_cell is None or first.GetNumberOfCells() == n_cell),
           f"{name}: VTK reads them")
        active = [data.GetScalars() and data.GetScalars().GetName() for data in (first.GetPointData(), first.GetCellData())]
        ok(active == ([None, array] if array else ["force", None]), f"{name}: it opens coloured by {array or 'force'}", active)
        if array:
            ok(first.GetCellData().GetArray(array) is not None, f"{name}: {array} on the lines")
        if array == "crack":
            ok("1 broken in tension, 2 in shear" in first.GetCellData().GetArray(array).GetComponentName(0),
               f"{name}: the legend says what the numbers of {array} mean")
    full = grid_of(vtkXMLUnstructuredGridReader(), at("drying-0000.vtu"))
    dry = grid_of(vtkXMLUnstructuredGridReader(), at("drying-0010.vtu"))
    total = lambda grid: vtk_to_numpy(grid.GetCellData().GetArray("saturation")).sum()
    ok(total(full) == 560 and total(dry) == 0, "drying: from 560 full throats to none")

    # A layer that shrinks, in a box that repeats.
    run("pack", "-q", "--set=counts=[4,5,3]", "--set=periodic=[true,true,false]", "-o", at("layer.hdf"))
    run("dem-replay", "-q", *[f"--set={entry}" for entry in (
        "shrinkage.strain=0.05", "shrinkage.steps=4", "snapshots=[0.5,0]", "cycles=50", "most_cycles=50")],
        at("layer.hdf"), "-o", at("shrunk.hdf"))
    run("inspect", "--vtk", at("shrunk"), at("shrunk.hdf"))
    run("inspect", "--xyz", at("shrunk.xyz"), at("shrunk.hdf"))
    with h5py.File(at("shrunk.hdf")) as file:
        pair, place = file["contacts/particles"][:], file["particles/position"][:]
        inside = np.linalg.norm(np.diff(place[pair], axis=1), axis=2).ravel() < 1.01 * 2 * 250e-9
        radii = file["particles/radius"][:] * (1 - file["snapshots/shrinkage"][:])
        moved = place + file["snapshots/displacement"][:]
    last = grid_of(vtkXMLUnstructuredGridReader(), at("shrunk-0001.vtu"))
    ends = vtk_to_numpy(last.GetCells().GetConnectivityArray()).reshape(-1, 2)
    ok(not inside.all() and np.array_equal(ends[inside], pair[inside]) and np.array_equal(ends[~inside], pair[~inside][:, [0, 0]])
       and np.allclose(points(last), moved[-1], rtol=1e-8, atol=1e-15),
       "response: contacts across a side that repeats are not drawn across the box", ends[~inside])
    with open(at("shrunk.xyz"), encoding="utf-8") as file:
        rows = [line.split() for line in file if len(line.split()) > 10 and not line.startswith("Lattice")]
    written = np.array(rows, float)[:, 4].reshape(2, -1)
    ok(radii[-1].min() < 0.96 * 250e-9
       and np.allclose(vtk_to_numpy(last.GetPointData().GetArray("radius")), radii[-1], rtol=1e-8, atol=0)
       and np.allclose(written, radii, rtol=1e-8, atol=0), "and grains have the radii to which they have shrunk", written)

    # Rings around contacts of irregular grains: with what is in throats they make the saturation.
    scene = ["method=radius_expansion", "count=60", "sizes.distribution=normal", "sizes.spread=0.2"]
    run("pack", "-q", *[f"--set={entry}" for entry in scene], "-o", at("grains.hdf"))
    run("tessellate", "-q", "--set=throat_volume=void", "--set=throat_radius=entry", at("grains.hdf"), "-o", at("pores.hdf"))
    run("dry", "-q", "--set=rings=isolated", at("pores.hdf"), "-o", at("ringed.hdf"))
    run("inspect", "--vtk", at("ringed"), "--frames=4", at("ringed.hdf"))
    times = [float(d.get("timestep")) for d in xml.parse(at("ringed-rings.pvd")).iter("DataSet")]
    with h5py.File(at("ringed.hdf")) as ringed:
        step = [np.abs(ringed["history/time"][:] - time).argmin() for time in times]
        all_throats = ringed["throats/volume"][:][ringed["throats/kind"][:] == 0].sum()
        wanted = ringed["history/ring_saturation"][:][step] * all_throats
        pairs = {tuple(pair) for pair in ringed["faces/particles"][:][ringed["rings/face"][:]]}
    grids = [grid_of(vtkXMLUnstructuredGridReader(), at(f"ringed-rings-000{k}.vtu")) for k in range(4)]
    sums = [vtk_to_numpy(grid.GetCellData().GetArray("volume")).sum() for grid in grids]
    ok(wanted.max() > 0 and np.allclose(sums, wanted, rtol=1e-5, atol=1e-9 * all_throats),
       "rings: their volumes are those of the drying's history", (sums, wanted))
    drawn = vtk_to_numpy(grids[0].GetCells().GetConnectivityArray()).reshape(-1, 2)
    ok({tuple(pair) for pair in drawn} == pairs, "rings: lines between the grains of each ring")

    # Of each artifact without a series `inspect` says whether it opens as it is.
    run("pack", "-q", "--set", "counts=[3,3,3]", "--set", "radius=1e-3", "-o", at("small.hdf"))
    run("simulate", "-q", *(word for key in ("duration=1e-4", 'materials={"glass":{"density":2500,"young_modulus":1e6,"friction":0.5,"restitution":0.5}}',
                                             "record.every=5e-5") for word in ("--set", key)), at("small.hdf"), "-o", at("motion.hdf"))
    run("shearstats", "-q", at("motion.hdf"), "-o", at("shearstats.hdf"))
    run("invade", "-q", at("network.hdf"), "-o", at("invasion.hdf"))
    run("flow", "-q", at("packing.hdf"), "-o", at("flow.hdf"))
    told = {}
    for name in "packing", "network", "invasion", "flow", "shearstats":
        said = subprocess.run([f"{BIN}/inspect", f"--vtk={at('none')}", at(name + ".hdf")], capture_output=True, text=True)
        told[name] = (said.returncode, "ParaView opens it as it is" in said.stderr) == (65, bool(vtkHDFReader().CanReadFile(at(name + ".hdf")))), said.stderr
    ok(all(right for right, _ in told.values()) and not vtkHDFReader().CanReadFile(at("shearstats.hdf")),
       "what has no series opens as it is where inspect says so", told)

done()
