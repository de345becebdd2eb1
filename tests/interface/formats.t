#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Networks in the formats of OpenPNM and Statoil: what is written is what those programs read,
# and read back it is the same network.
import json
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, read, run, scratch_paths

GROUPS = "particles", "domain", "bonds", "nodes", "throats", "faces"


SHAPES = {"throats/diffusive_conductance", "throats/hydraulic_conductance",
          "throats/hydraulic_radius"}


def same(one, other, groups=GROUPS, but=()):
    names = {f"{g}/{n}" for g in groups for file in (one, other) for n in file[g]} - set(but)
    return all(n in one and n in other and one[n][()].tobytes() == other[n][()].tobytes()
               and one[n].shape == other[n].shape for n in names)


with scratch_paths() as at:
    packing = run("pack", "--quiet", "--set", "method=random_sequential", "--set", "count=80",
                  "--set", "upper=[4e-6,4e-6,3e-6]")
    tessellation = run("tessellate", "--set", "throat_volume=void", input=packing)
    run("merge-nodes", "-o", at("void.h5"), "--set", "measure=fraction", "--set", "threshold=0.1",
        input=tessellation)
    run("merge-nodes", "-p", SCENE, "-o", at("cylinder.h5"),
        input=run("tessellate", "-p", SCENE, input=run("pack", "-p", SCENE)))
    for name in "void", "cylinder":
        network = h5py.File(at(f"{name}.h5"))
        ends, radius = network["throats/nodes"][:], network["throats/radius"][:]
        length, position = network["throats/length"][:], network["nodes/position"][:]
        n_node, n_throat = len(position), len(ends)
        volume = network["throats/volume"][:] if name == "void" else np.pi * radius**2 * length
        kind = network["nodes/kind"][:]
        run("inspect", "--openpnm", at("graph.json"), "--statoil", at("x"), at(f"{name}.h5"))

        # OpenPNM's reader takes these members, sorts by id, and takes roots of squares.
        graph = json.loads(read(at("graph.json")))["graph"]
        ok(graph["metadata"]["number_of_nodes"] == n_node
           and graph["metadata"]["number_of_links"] == n_throat, f"{name}: counts for OpenPNM")
        points = sorted(graph["nodes"], key=lambda node: int(node["id"]))
        edges = sorted(graph["edges"], key=lambda edge: int(edge["id"]))
        place = [[node["metadata"]["node_coordinates"][c] for c in "xyz"] for node in points]
        ok(np.array_equal(place, position)
           and np.array_equal([[int(e["source"]), int(e["target"])] for e in edges], ends)
           and np.array_equal([e["metadata"]["link_length"] for e in edges], length)
           and np.allclose(np.sqrt([e["metadata"]["link_squared_radius"] for e in edges]),
                           radius, rtol=1e-15, atol=0), f"{name}: places, ends, sizes for OpenPNM")
        run("import-network", at("graph.json"), "-o", at("back.h5"))
        back = h5py.File(at("back.h5"))
        ok(same(network, back) and dict(network["summary"].attrs) == dict(back["summary"].attrs),
           f"{name}: read back, the same network")
        ok(run("merge-nodes", at("back.h5")) != b"" and
           run("import-network", input=read(at("graph.json"))) == read(at("back.h5")),
           f"{name}: through a pipe as well")

        # Columns as OpenPNM reads them; links to the reservoirs -1 and 0 are its inlet, outlet.
        rows = lambda part: [line.split() for line in open(at(f"x_{part}.dat"))]
        node1, node2, link1, link2 = map(rows, ("node1", "node2", "link1", "link2"))
        edge = network["domain/upper"][:] - network["domain/lower"][:]
        ok(int(node1[0][0]) == n_node == len(node1) - 1 == len(node2)
           and np.array_equal([float(x) for x in node1[0][1:]], edge), f"{name}: node1 begins so")
        inlet, outlet = (kind & 1) > 0, (kind & 2) > 0
        n_link = n_throat + inlet.sum() + outlet.sum()
        ok(int(link1[0][0]) == n_link == len(link1) - 1 == len(link2), f"{name}: link1 begins so")
        inner = np.array([[float(x) for x in row] for row in link1[1:n_throat + 1]])
        ok(np.array_equal(inner[:, 1:3] - 1, ends) and np.array_equal(inner[:, 3], radius)
           and np.array_equal(inner[:, 5], length), f"{name}: link1")
        # Programs that read it take triangles for G up to sqrt(3)/36, squares, and circles.
        shape, section = inner[:, 4], radius**2 / (4 * inner[:, 4])
        factor = np.select([shape <= 3**.5 / 36, shape <= .07], [.6, .5623], .5)
        flow = factor * section**2 * shape / length
        if name == "void":
            said = network["throats/hydraulic_conductance"][:]
            wide = said > .6 * radius**4 / (16 * 3**.5 / 36 * length)  # than any triangle's
            ok(np.allclose(flow[wide], said[wide], rtol=1e-6, atol=0) and wide.sum() > 100
               and (flow[~wide] > .88 * said[~wide]).all(),
               f"{name}: shape factors conduct as the throats do", (wide.sum(), len(wide)))
        else:
            ok(np.allclose(flow, np.pi * radius**4 / (8 * length), atol=0),
               f"{name}: throats are cylinders")
        ok(np.array_equal([float(row[6]) for row in link2[:n_throat]], volume)
           and [row[:3] for row in link2] == [row[:3] for row in link1[1:]], f"{name}: link2")
        outer = [[int(x) for x in row[1:3]] for row in link1[n_throat + 1:]]
        ok({b - 1 for a, b in outer if a == -1} == set(np.flatnonzero(inlet))
           and {b - 1 for a, b in outer if a == 0} == set(np.flatnonzero(outlet)),
           f"{name}: reservoirs")
        joined = {i + 1: [] for i in range(n_node)}
        for row in link1[1:]:
            for a, b in ((1, 2), (2, 1)):
                if int(row[a]) > 0:
                    joined[int(row[a])].append((int(row[0]), int(row[b])))
        good = True
        for row in node1[1:]:
            number, count = int(row[0]), int(row[4])
            numbers = [int(x) for x in row[5:]]
            good &= (sorted(zip(numbers[count + 2:], numbers[:count])) == sorted(joined[number])
                     and numbers[count:count + 2] == [inlet[number - 1], outlet[number - 1]])
        ok(good, f"{name}: node1 lists the throats of each node, and their other ends")
        run("import-network", "--set", "format=statoil", at("x"), "-o", at("back.h5"))
        back = h5py.File(at("back.h5"))
        ok(same(network, back, ("nodes", "throats"), SHAPES),
           f"{name}: read back, the same nodes and throats")
        ok(len(back["faces/particles"]) == 0 and len(back["particles/radius"]) == 0,
           f"{name}: which is all that the format holds")

    # A layer of auxiliary grains, and bonds of different strengths.
    made = run("pack", "--quiet", "--set", "counts=[4,4,4]", "--set", "extra_layer=true")
    with open(at("layer.h5"), "wb") as file:
        file.write(made)
    with h5py.File(at("layer.h5"), "r+") as file:
        file["bonds/relative_strength"] = np.linspace(0, 2, len(file["bonds/particles"]))
    run("merge-nodes", "-o", at("layered.h5"), input=run("tessellate", at("layer.h5")))
    run("inspect", "--openpnm", at("layered.json"), at("layered.h5"))
    run("import-network", at("layered.json"), "-o", at("back.h5"))
    network, back = h5py.File(at("layered.h5")), h5py.File(at("back.h5"))
    ok(same(network, back) and network["particles/kind"][:].tolist().count(1) == 16
       and np.ptp(network["bonds/relative_strength"][:]) == 2,
       "read back, the same auxiliary grains and strengths of bonds")

    # A graph by others: no additions.
    bare = {"graph": {"metadata": {"number_of_nodes": 2, "number_of_links": 1}, "nodes": [
        {"id": "1", "metadata": {"node_coordinates": {"x": 3, "y": 4, "z": 0}}},
        {"id": "0", "metadata": {"node_coordinates": {"x": 0, "y": 0, "z": 0}}}], "edges": [
        {"id": "0", "source": "1", "target": "0",
         "metadata": {"link_length": 5, "link_squared_radius": 0.25}}]}}
    run("import-network", "-o", at("bare.h5"), input=json.dumps(bare).encode())
    file = h5py.File(at("bare.h5"))
    ok(file["throats/nodes"][:].tolist() == [[0, 1]] and file["throats/radius"][0] == 0.5
       and file["domain/upper"][:].tolist() == [3, 4, 2.5] and file["nodes/kind"][1] == 2 | 8,
       "a graph without what we add becomes a network in the box around it")

    def refused(title, says, *arguments, document=None, status=65):
        done = subprocess.run([f"{BIN}/import-network", *arguments], capture_output=True,
                              input=json.dumps(document).encode() if document else b"")
        ok(done.returncode == status and says in done.stderr.decode(), title,
           f"{done.returncode} {done.stderr.decode()}")

    def changed(change):
        document = json.loads(json.dumps(bare))
        change(document["graph"])
        return document

    refused("nothing is refused", "line", document=None)
    refused("another JSON is refused", "graph: must have", document={"a": 1})
    refused("too few edges are refused", "graph: must have",
            document=changed(lambda graph: graph["edges"].clear()))
    refused("a throat to nowhere is refused", "throat 0: must join nodes from 0 to 1",
            document=changed(lambda graph: graph["edges"][0].update(target="7")))
    refused("a throat from a node to itself is refused", "both ends are node 1",
            document=changed(lambda graph: graph["edges"][0].update(target="1")))
    refused("a negative length is refused", "its length must be from 0 to 1e150, is -5",
            document=changed(lambda graph: graph["edges"][0]["metadata"].update(link_length=-5)))
    refused("a node that is there twice is refused", "node 1: must have a place",
            document=changed(lambda graph: graph["nodes"][0].update(id="0")))

    def flatten(axis, value):
        return changed(lambda graph: [node["metadata"]["node_coordinates"].update({axis: value})
                                      for node in graph["nodes"]])

    refused("a plane too far away for its throats is refused, as bad input",
            "standard input: gives no network: /domain/lower: row 2", document=flatten("z", 1e30))
    thin = flatten("x", 0)
    thin["graph"]["nodes"][0]["metadata"]["node_coordinates"]["x"] = 5e-324
    refused("a box too thin for an area is refused", "must be 1e-150 or more below", document=thin)
    refused("nodes all in one place are refused", "graph.nodes: all lie in one place",
            document=changed(lambda graph: graph["nodes"][0]["metadata"]["node_coordinates"].update(x=0, y=0)))
    refused("a place that is no number is refused", "graph.nodes[0].metadata",
            document=changed(lambda graph: graph["nodes"][0]["metadata"].clear()))
    full = json.loads(read(at("graph.json")))
    full["graph"]["metadata"]["craquelure"]["faces"]["nodes"][3][0] = 10**6
    refused("a face around no node is refused", "faces.nodes[3]", document=full)
    layered = json.loads(read(at("layered.json")))
    rest = layered["graph"]["metadata"]["craquelure"]
    for wrong in 2, -1, 0.5, None:
        rest["particles"]["kind"][5] = wrong
        refused(f"grains of kind {wrong} are refused", "particles.kind: must be 0 or 1", document=layered)
    rest["particles"]["kind"].pop()
    refused("a grain without a kind is refused", "particles.kind: must be 0 or 1", document=layered)
    del rest["particles"]["kind"]
    for wrong in -1, "strong":
        rest["relative_strength"][7] = wrong
        refused(f"a strength of {wrong} is refused", "relative_strength: must be a number of 0 or more", document=layered)
    rest["relative_strength"].pop(7)
    refused("a bond without a strength is refused", "relative_strength: must be a number", document=layered)
    refused("no such files are refused", "No such file", "--set", "format=statoil", at("none"), status=66)
    refused("standard input is refused for four files", "prefix", "--set", "format=statoil", status=64)
    with open(at("x_link1.dat"), "a+") as file:
        file.truncate(200)
    refused("a file cut off is refused", "_link1.dat: line", "--set", "format=statoil", at("x"))
    done_ = subprocess.run([f"{BIN}/inspect", "--openpnm", at("y")], input=packing, capture_output=True)
    ok(done_.returncode == 65 and b"has no network" in done_.stderr, "a packing has no network to export")
done()
