#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# The network of grains that have moved (deform), beside a fresh tessellation of them; and what
# becomes of the liquid in it.
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, refused, run, scratch_paths, sets

DATASETS = ["nodes/position", "nodes/kind", "throats/nodes", "throats/radius", "throats/length",
            "throats/volume", "faces/offset", "faces/nodes", "faces/particles", "domain/lower",
            "domain/upper", "particles/position", "throats/image", "faces/node_image",
            "throats/diffusive_conductance", "throats/hydraulic_conductance", "throats/hydraulic_radius"]
BODIES = ["domain/bodies/lower", "domain/bodies/upper"]

with scratch_paths() as at:
    def make(name, pack, tessellate=(), merge=None):
        """A packing, its network, and a response to lay displacements into."""
        run("pack", "--quiet", *sets(*pack), "-o", at("packing"))
        run("tessellate", *sets(*tessellate), at("packing"), "-o", at(name))
        if merge is not None:
            run("merge-nodes", *sets(*merge), at(name), "-o", at(name))
        plain = run("merge-nodes", input=run("tessellate", at("packing")))
        forces = run("force-protocol", "--set", "steps=2", input=run("dry", "--quiet", input=plain))
        run("dem-replay", "--quiet", *sets("cycles=1", "snapshots=[1]", "bond.by=none"), "-o", at("response"), input=forces)
        return h5py.File(at("packing"))

    def lay(displacement):
        with h5py.File(at("response"), "r+") as response:
            response["snapshots/displacement"][-1] = displacement

    def deform(name, *words):
        end = subprocess.run([f"{BIN}/deform", at(name), at("response"), "-o", at("moved"), *words],
                             stderr=subprocess.PIPE)
        return end.returncode, h5py.File(at("moved")) if end.returncode == 0 else end.stderr.decode()

    def fresh(moved, *words):
        """A tessellation of the moved grains in their moved box."""
        with h5py.File(at("packing"), "r+") as packing:
            for entry in "particles/position", "domain/lower", "domain/upper", "domain/bodies/lower", "domain/bodies/upper":
                if entry in packing:
                    packing[entry][...] = moved[entry][:]
        run("tessellate", *words, at("packing"), "-o", at("fresh"))
        return h5py.File(at("fresh"))

    def same(a, b, entry, unit, most):
        return a[entry].shape == b[entry].shape and np.abs(a[entry][:] - b[entry][:]).max() <= most * unit

    def conduct_alike(a, b):
        """As the same sections. Short throats conduct by rounding of their lengths, and nearly closed
        ones, to flow as their area cubed, by that of places, 1e-10."""
        long = b["throats/length"][:] > 1e-3 * b["throats/length"][:].mean()
        return all(np.allclose(a[f"throats/{e}"][:][long], b[f"throats/{e}"][:][long], rtol=1e-7, atol=0)
                   for e in ["diffusive_conductance", "hydraulic_conductance", "hydraulic_radius"])

    def same_diagram(a, b):
        return all(a[e].shape == b[e].shape and (a[e][:] == b[e][:]).all()
                   for e in ["throats/nodes", "faces/offset", "faces/nodes", "faces/particles"])

    # Nothing moves: nothing changes.
    random = ["method=random_sequential", "count=120", "upper=[4e-6,4e-6,4e-6]",
              "sizes.distribution=lognormal", "sizes.spread=0.2"]
    void = ["throat_volume=void"]
    for title, pack, tessellate, merge in [
            ("lattice", ["method=cubic", "counts=[4,3,3]"], [], []),
            ("random grains", random, void, None),
            ("merged", random, void, ["measure=fraction", "threshold=0.2"]),
            ("in a box that repeats", random + ["periodic=[true,true,false]"], void, None),
            ("cut cells left out", random, ["boundary=eliminate"], None)]:
        make("network", pack, tessellate, merge)
        lay(0)
        status, moved = deform("network")
        network = h5py.File(at("network"))
        ok(status == 0 and all((e in network) == (e in moved) and
                               (e not in network or network[e][:].tobytes() == moved[e][:].tobytes())
                               for e in DATASETS),
           f"nothing moves, nothing changes: {title}", moved if status else "")
        # A turned body: its network turns. (A box does not; its walls are not looked at.)
        if title == "cut cells left out":
            angle = 0.3
            turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
            place = network["particles/position"][:]
            lay(place @ turn.T - place)
            status, moved = deform("network", "--set", "on_change=keep")
            unit = network["throats/length"][:].mean()
            ok(np.abs(moved["nodes/position"][:] - network["nodes/position"][:] @ turn.T).max() < 1e-10 * unit
               and same(moved, network, "throats/length", unit, 1e-10)
               and same(moved, network, "throats/radius", unit, 1e-10), "turned: only places change")

    # Drawn radii on a lattice of touching grains drawn together, in closed form.
    make("network", ["method=cubic", "counts=[5,4,4]", "radius=250e-9"])
    run("dry", "--quiet", "--set", "throat_radius.distribution=normal", "--set",
        "throat_radius.standard_deviation=2e-8", "-o", at("drawn"), input=run("merge-nodes", at("network")))
    drawn, share = h5py.File(at("drawn")), 0.97
    lay((share - 1) * drawn["particles/position"][:])
    status, moved = deform("drawn")
    before, after = (250e-9 * (np.sqrt(2) * s - 1) for s in (1, share))
    inner = (drawn["nodes/kind"][:] == 0)[drawn["throats/nodes"][:]].all(axis=1)
    radius = drawn["throats/radius"][:][inner]
    expected = radius + (after - before) * np.minimum(1, radius / before)
    ok(status == 0 and inner.sum() == 75 and (radius < before).any() and (radius > before).any()
       and np.allclose(moved["throats/radius"][:][inner], expected, rtol=1e-12, atol=0)
       and np.allclose(moved["throats/length"][:], share * drawn["throats/length"][:], rtol=1e-12, atol=0),
       "drawn radii go with the clearance", (status, inner.sum()))

    # Carried off; drawn together: beside a fresh tessellation.
    packing = make("network", random, void)
    network = h5py.File(at("network"))
    place = packing["particles/position"][:]
    unit = network["throats/length"][:].mean()
    lay([1e-6, -2e-6, 3e-6])
    status, moved = deform("network")
    ok(status == 0 and np.abs(moved["nodes/position"][:] - network["nodes/position"][:]
                              - [1e-6, -2e-6, 3e-6]).max() < 1e-12 * unit
       and all(same(moved, network, e, u, 1e-10) for e, u in [
           ("throats/length", unit), ("throats/radius", unit), ("throats/volume", unit**3)])
       and conduct_alike(moved, network), "carried off: only places change")
    shrunk = 0.999
    lay((shrunk - 1) * place)
    packing.close()
    status, moved = deform("network", "--set", "on_change=keep")
    anew = fresh(moved, "--set", "throat_volume=void")
    ok(np.allclose(moved["domain/upper"][:], shrunk * network["domain/upper"][:], rtol=1e-14, atol=0), "drawn together: so is the box")
    as_anew = lambda: all(same(moved, anew, e, u, 1e-10) for e, u in [
        ("nodes/position", unit), ("throats/length", unit), ("throats/radius", unit),
        ("throats/volume", unit**3)])
    ok(same_diagram(moved, anew) and as_anew() and conduct_alike(moved, anew), "drawn together: as tessellated anew")
    box = np.prod(moved["domain/upper"][:] - moved["domain/lower"][:])
    solid = 4 / 3 * np.pi * (moved["particles/radius"][:]**3).sum()
    ok(abs(moved["throats/volume"][:].sum() / (box - solid) - 1) < 1e-12, "and volumes sum to the void",
       moved["throats/volume"][:].sum() / (box - solid) - 1)

    # All shrinks alike, grains too: so do radii, also those above the clearance.
    for radius in "entry", "segment":
        make("network", random, [f"throat_radius={radius}"]).close()
        network = h5py.File(at("network"))
        lay((0.95 - 1) * place)
        with h5py.File(at("response"), "r+") as response:
            response["snapshots/shrinkage"] = np.full(response["snapshots/displacement"].shape[:2], 0.05)
        status, moved = deform("network")
        ok(status == 0 and np.allclose(moved["throats/radius"][:], 0.95 * network["throats/radius"][:], rtol=1e-11, atol=0),
           f"all shrinks alike: so do radii, {radius}",
           status or np.ptp(moved["throats/radius"][:] / network["throats/radius"][:]))
    make("network", random, void).close()
    network = h5py.File(at("network"))

    # The top below the bottom.
    at_start = h5py.File(at("packing"))["particles/position"][:]
    lay(at_start * [0, 0, -2])
    for words in [], ["--set", "write=packing"]:
        status, says = deform("network", *words)
        ok(status == 65 and "walls z" in says, "a body turned inside out is refused", says)

    # Each grain moved its own way: as tessellated anew, unless it is found that the grains
    # have another diagram by now.
    held, lost, wrong = 0, 0, []
    for seed in (0, 4, 8, 12, 14, 16, *range(18, 24)):
        size = 10 ** (-6 + seed / 6)
        lay(size * unit * np.random.default_rng(seed).normal(size=place.shape))
        status, moved = deform("network", "--set", "on_change=keep")
        status, says = deform("network")
        anew = fresh(moved, "--set", "throat_volume=void")
        changed = moved["summary"].attrs["changed_nodes"]
        held += changed == 0
        lost += changed > 0
        if (changed == 0) != same_diagram(moved, anew) or status != (changed > 0):
            wrong.append((seed, changed, status))
        elif changed == 0 and not (as_anew() and conduct_alike(moved, anew)):
            wrong.append((seed, "differs"))
    ok(held > 3 and lost > 3 and not wrong, "moved at random: as anew, or said to be another diagram",
       (held, lost, wrong))

    # A scene 2^40 times as large: the same digits.
    lay(1e-3 * unit * np.random.default_rng(0).normal(size=place.shape))
    _, small = deform("network", "--set", "on_change=keep")
    small = {entry: small[entry][:] for entry in DATASETS if entry in small}
    power = {"throats/volume": 3, "throats/hydraulic_conductance": 3}
    lengths = ["throats/diffusive_conductance", "throats/hydraulic_conductance", "throats/hydraulic_radius",
               "nodes/position", "throats/radius", "throats/length", "throats/volume", "domain/lower",
               "domain/upper", "particles/position", "particles/radius", "snapshots/displacement"]
    network.close()
    for name in "network", "response":
        with h5py.File(at(name), "r+") as file:
            for entry in lengths:
                if entry in file:
                    file[entry][...] = file[entry][:] * 2.0**(40 * power.get(entry, 1))
    _, large = deform("network", "--set", "on_change=keep")
    ok(all((large[e][:] == small[e] * (2.0**(40 * power.get(e, 1)) if e in lengths else 1)).all()
           for e in small), "as large as you like: the same digits")

    # Onto another network of the same moved grains: the liquid comes whole, and to where it was.
    scene = ["-p", "samples/soft-300.json"]
    run("pack", "-q", *scene, "--set", "count=120", "-o", at("packing"))
    run("merge-nodes", *scene, "-o", at("network"), input=run("tessellate", *scene, at("packing")))
    drying = run("dry", *scene, "--set", "stop_saturation=0.6", at("network"), "-o", at("drying"))
    forces = run("force-protocol", *scene, "--set", "steps=2", at("drying"))
    run("dem-replay", "-q", *scene, "--set", "cycles=1", "-o", at("response"), input=forces)
    drying = h5py.File(at("drying"))
    volume = np.where(drying["throats/kind"][:] == 0, drying["throats/volume"][:], 0)
    saturation = (drying["throats/kind"][:] == 0).astype(float)
    for t, s in zip(drying["changes/throat"][:], drying["changes/saturation"][:]):
        saturation[t] = s
    liquid = np.dot(saturation, volume)
    place = drying["particles/position"][:]
    for title, size in ("a little", 1e-4), ("much", 0.05):
        lay(size * 2.5e-7 * np.random.default_rng(1).normal(size=place.shape))
        packing = run("deform", "--set", "write=packing", at("drying"), at("response"))
        run("merge-nodes", *scene, "-o", at("anew"), input=run("tessellate", *scene, input=packing))
        run("deform", at("drying"), at("response"), at("anew"), "-o", at("carried"))
        carried = h5py.File(at("carried"))
        said = carried["summary"].attrs
        on = lambda n: n["nodes/position"][:][n["throats/nodes"][:]].mean(axis=1)
        centre = lambda n, w: (w[:, None] * on(n)).sum(axis=0) / w.sum()
        moved = np.where(carried["throats/kind"][:] == 0, carried["throats/volume"][:], 0) \
            * carried["throats/saturation"][:]
        off = np.linalg.norm(centre(carried, moved) - centre(drying, saturation * volume))
        ok(abs((moved.sum() + said["expelled_volume"]) / liquid - 1) < 1e-14 and off < 0.2 * drying["throats/length"][:].mean(),
           f"carried to a network tessellated anew, {title} moved", (off, said["expelled_volume"] / liquid))
    refused("a network of other places is refused", "is not where the response has the grains now",
            "deform", at("drying"), at("response"), at("network"))

    # Liquid that would be lost without a word.
    saturation_of = lambda name: f"{at(name)}: /throats/saturation: "
    refused("nodes of a network with liquid are not merged", saturation_of("carried"), "merge-nodes", at("carried"))
    refused("nor those of a drying", "must be a network, is a drying", "merge-nodes", at("drying"))
    refused("a network with liquid is not moved", saturation_of("carried"), "deform", at("carried"), at("response"))
    refused("nor does it take the liquid of another one", saturation_of("carried"),
            "deform", at("drying"), at("response"), at("carried"))
    run("dry", *scene, "--set", "stop_saturation=0.9", at("anew"), "-o", at("dried"))
    refused("nor does a drying", "must be a network, is a drying", "deform", at("drying"), at("response"), at("dried"))
    refused("gas is not pressed into it", saturation_of("carried"), "invade", "--set", "surface_tension=0.07", at("carried"))
    ok(run("deform", "--set", "write=packing", at("carried"), at("response")), "its grains alone are moved")
    ok(run("dry", *scene, at("carried")), "and it dries on")

    # Drawn radii go along, liquid too: as they were where nothing moves, and spread as they were.
    run("dry", *scene, *"--set throat_radius.distribution=lognormal --set throat_radius.mean=1e-7 --set".split(),
        "throat_radius.standard_deviation=3e-8", "--set", "stop_saturation=0.6", at("network"), "-o", at("drying"))
    drying = h5py.File(at("drying"))
    drawn = drying["throats/radius"][:]
    on = lambda n: n["throats/kind"][:] == 0
    cylinders = lambda n: np.where(on(n), np.pi * n["throats/radius"][:]**2 * n["throats/length"][:], 0)
    saturation = on(drying).astype(float)
    for t, s in zip(drying["changes/throat"][:], drying["changes/saturation"][:]):
        saturation[t] = s
    for title, size in ("nothing moved", 0), ("much", 0.05):
        lay(size * 2.5e-7 * np.random.default_rng(1).normal(size=place.shape))
        packing = run("deform", "--set", "write=packing", at("drying"), at("response"))
        run("merge-nodes", *scene, "-o", at("anew"), input=run("tessellate", *scene, input=packing))
        run("deform", "--set", "radii=carried", at("drying"), at("response"), at("anew"), "-o", at("carried"))
        carried = h5py.File(at("carried"))
        radius = carried["throats/radius"][:]
        had, has = drawn[on(drying)], radius[on(carried)]
        kept = np.dot(carried["throats/saturation"][:], cylinders(carried)) + carried["summary"].attrs["expelled_volume"]
        ok((size or np.allclose(has, had, rtol=1e-9, atol=0)) and (has > 0).all()
           and "throats/volume" not in carried and "throats/diffusive_conductance" not in carried and abs(kept / np.dot(saturation, cylinders(drying)) - 1) < 1e-14
           and abs(has.mean() / had.mean() - 1) < 0.02 and abs(has.std() / had.std() - 1) < 0.05,
           f"drawn radii go along, {title}", (has.mean() / had.mean(), has.std() / had.std(), len(had), len(has)))

    def as_anew_but_for_numbers(moved, anew, most):
        place, other = moved["nodes/position"][:], anew["nodes/position"][:]
        if place.shape != other.shape or moved["throats/nodes"].shape != anew["throats/nodes"].shape:
            return False
        number = np.linalg.norm(place[:, None] - other, axis=2).argmin(axis=1)
        rows = lambda n, ends: np.column_stack([np.sort(ends, axis=1), n["throats/length"][:], n["throats/radius"][:]])
        ours, theirs = rows(moved, number[moved["throats/nodes"][:]]), rows(anew, anew["throats/nodes"][:])
        ours, theirs = (r[np.lexsort((np.round(r[:, 2] / most / 100), r[:, 1], r[:, 0]))] for r in (ours, theirs))
        return len(set(number)) == len(other) and np.abs(place - other[number]).max() < most \
            and (ours[:, :2] == theirs[:, :2]).all() and np.abs(ours - theirs).max() < most

    def moved_at_random(title, sizes, *words, way=(1, 1, 1)):
        """Each grain its own way: as tessellated anew (by WORDS), while that holds."""
        with h5py.File(at("network")) as network:
            place, unit = network["particles/position"][:], network["throats/length"][:].mean()
        held, lost, wrong = 0, 0, []
        for seed, size in enumerate(sizes):
            lay(size * unit * np.random.default_rng(seed).normal(size=place.shape) * way)
            _, moved = deform("network", "--set", "on_change=keep")
            anew = fresh(moved, *words)
            changed = moved["summary"].attrs["changed_nodes"]
            held += changed == 0
            lost += changed > 0
            if (changed == 0) != as_anew_but_for_numbers(moved, anew, 1e-10 * unit):
                wrong.append((seed, changed))
        ok(held > 2 and lost > 2 and not wrong, f"{title} moved at random: as anew, or said to be another diagram",
           (held, lost, wrong))

    def answer(*settings):
        """A response of the grains of the packing to lay displacements into."""
        forces = run("force-protocol", "--set", "steps=2", input=run("dry", "-q", input=run("tessellate", *settings, at("packing"))))
        run("dem-replay", "-q", *"--set cycles=1 --set snapshots=[1] --set support=free --set bond.by=none".split(), "-o", at("response"),
            input=forces)

    # A layer of discs, in their plane; grains in round walls, which go along.
    sizes = ["--set", "radius=2.5e-7", "--set", "sizes.spread=0.2", "--set", "sizes.distribution=lognormal"]
    layer = ["--set", "dimensions=2"]
    run("pack", "-q", *"--set method=random_sequential --set count=80 --set upper=[6e-6,0,6e-6]".split(), *layer,
        *sizes, "-o", at("packing"))
    answer(*layer)
    run("tessellate", *layer, at("packing"), "-o", at("network"))
    moved_at_random("a layer", 10 ** np.linspace(-4.5, -0.7, 9), *layer, way=(1, 0, 1))
    cylinder = ["--set", "domain.shape=cylinder", "--set", "domain.height=5e-6"]
    sphere = ["--set", "domain.shape=sphere"]
    wide, cube = ["--set", "domain.radius=2.5e-6"], "upper=[5e-6,5e-6,5e-6]"
    words = lambda text: sets(*text.split())
    bodies = [
        ("a cylinder", wide + cylinder, []), ("a sphere", wide + sphere, []), ("a disc", wide + sphere, layer),
        ("a ring", words("domain.shape=ring domain.radius=3e-6 domain.inner_radius=1.2e-6 domain.height=4e-6"), []),
        ("a hollow sphere", words("domain.shape=sphere domain.radius=3e-6 domain.cut.shape=sphere domain.cut.radius=1.3e-6"), []),
        ("a disc with a hole", words("domain.shape=sphere domain.radius=4e-6 domain.cut.shape=sphere domain.cut.radius=1.5e-6"), layer),
        ("a box with a corner cut out", words(f"{cube} domain.cut.shape=box domain.cut.lower=[2e-6,0,0] domain.cut.upper=[5e-6,3.2e-6,2.3e-6]"), []),
        ("a box with a hole from the top", words(f"{cube} domain.cut.shape=cylinder domain.cut.radius=1.3e-6 domain.cut.lower=[0,0,1.5e-6]"), []),
        ("a box that repeats with a hole", words(f"{cube} periodic=[true,true,false] domain.cut.shape=sphere domain.cut.radius=1.3e-6"), [])]
    turn_z = lambda a: np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    turn_x = lambda a: np.roll(turn_z(a), (1, 1), (0, 1))
    turns = {"a ring": turn_z(0.7), "a hollow sphere": turn_z(0.7) @ turn_x(-1.1)}
    for title, shape, plane in bodies:
        run("pack", "-q", *"--set method=random_sequential --set count=60".split(), *shape, *plane, *sizes, "-o", at("packing"))
        run("tessellate", *plane, at("packing"), "-o", at("network"))
        with h5py.File(at("packing"), "r+") as packing:
            packing.copy("domain/bodies", "kept")
            del packing["domain/bodies"]
        answer(*plane)
        with h5py.File(at("packing"), "r+") as packing:
            packing.move("kept", "domain/bodies")
        with h5py.File(at("network")) as network:
            began = {entry: network[entry][:] for entry in DATASETS + BODIES if entry in network}
        place, way = began["particles/position"], np.array((1, 0, 1) if plane else (1, 1, 1))
        lay(0)
        _, moved = deform("network")
        ok(all(moved[entry][:].tobytes() == began[entry].tobytes() for entry in began), f"{title}: nothing moves, nothing changes")
        if "repeats" not in title:
            centre = began["domain/bodies/lower"][0]
            lay((0.99 - 1) * (place - centre) * way)
            _, moved = deform("network", "--set", "on_change=keep")
            ok(all(np.abs(way * (moved[entry][:] - centre - 0.99 * (began[entry] - centre))).max() < 1e-12 * 5e-6
                   for entry in BODIES + ["domain/lower", "domain/upper"]), f"{title} drawn together: so are its surfaces")
        if title in turns: # about its centre: the network turns
            turn, centre = turns[title], (began["domain/bodies/lower"][0] + began["domain/bodies/upper"][0]) / 2
            lay((place - centre) @ turn.T + centre - place)
            status, moved = deform("network")
            unit = began["throats/length"].mean()
            ok(status == 0 and np.abs(moved["nodes/position"][:] - centre - (began["nodes/position"] - centre) @ turn.T).max() < 1e-10 * unit
               and all(np.abs(moved[entry][:] - began[entry]).max() < 1e-10 * unit for entry in BODIES + ["throats/length", "throats/radius"]),
               f"{title} turned: only places change", moved if status else "")
        moved_at_random(title, 10 ** np.array([-5, -4.2, -3.4, -2, -1.4, -1.2, -1, -0.8]), *plane, way=way)

    # Grains that shrink with the distances between them: all of the network does.
    for title, pack, tessellate, merge in [("lattice", ["method=cubic", "counts=[4,3,3]"], [], []),
                                           ("random grains", random, void, None)]:
        shrink = 0.02
        packing = make("network", pack, tessellate, merge)
        place, radius = packing["particles/position"][:], packing["particles/radius"][:]
        packing.close()
        lay(-shrink * place)
        with h5py.File(at("response"), "r+") as response:
            rows = np.full((1, len(place)), shrink)
            response.create_dataset("snapshots/shrinkage", data=rows).attrs.update(
                response["snapshots/bond_intact"].attrs)
        status, moved = deform("network")
        began = h5py.File(at("network"))
        lengths = {"throats/radius": 1, "throats/length": 1, "particles/radius": 1, "throats/volume": 3,
                   "throats/hydraulic_radius": 1, "throats/diffusive_conductance": 1}
        ok(status == 0 and all(np.allclose(moved[e], (1 - shrink) ** power * began[e][:], rtol=1e-7, atol=0)
                               for e, power in lengths.items() if e in began),
           f"{title} that shrink: so do their pores", moved if status else "")
        if "throats/volume" in began:
            lay(0) # grains that are held in their places
            _, moved = deform("network", *sets("on_change=keep"))
            void = moved["throats/volume"][:].sum() - began["throats/volume"][:].sum()
            lost = 4 * np.pi / 3 * (radius**3 - moved["particles/radius"][:]**3).sum()
            ok(abs(void / lost - 1) < 1e-9, f"{title} that shrink in their places: the void grows by what they lose", void / lost)

    # Shifted along axes that repeat: volumes change by rounding, the liquid stays where it is.
    run("pack", "-q", *sets("method=soft_spheres", "count=100", "periodic=[true,true,false]"), "-o", at("packing"))
    run("tessellate", *sets("throat_volume=void"), at("packing"), "-o", at("network"))
    run("dry", "-q", *sets("stop_saturation=0.6"), at("network"), "-o", at("drying"))
    run("dem-replay", "-q", *sets("cycles=1", "engine=explicit"), "-o", at("response"),
        input=run("force-protocol", *sets("steps=2"), at("drying")))
    with h5py.File(at("drying")) as drying:
        saturation = (drying["throats/kind"][:] == 0).astype(float)
        for t, s in zip(drying["changes/throat"][:], drying["changes/saturation"][:]):
            saturation[t] = s
        edge = drying["domain/upper"][:] - drying["domain/lower"][:]
    lay([0.3, 0.45, 0] * edge)
    _, moved = deform("drying")
    ok((moved["throats/saturation"][:] == saturation).all() and moved["throats/volume"][:].sum() > 0,
       "shifted along axes that repeat: the liquid stays in its throats", (moved["throats/saturation"][:] != saturation).sum())

    # Grains that cross such a side: tessellate puts them back into the box, where the next step finds them.
    u = [0.3, 0.45, 0] * edge + 0.03 * 2.5e-7 * np.random.default_rng(1).uniform(-1, 1, h5py.File(at("packing"))["particles/position"].shape)
    def anew(name, moved):
        lay(moved)
        run("tessellate", *sets("throat_volume=void"), "-o", at("anew"),
            input=run("deform", *sets("write=packing"), at(name), at("response")))
    anew("drying", u)
    run("deform", at("drying"), at("response"), at("anew"), "-o", at("carried"))
    run("dry", "-q", *sets("stop_saturation=0.4"), at("carried"), "-o", at("dried"))
    anew("dried", u + 1e-12 * np.random.default_rng(2).normal(size=u.shape))
    status, moved = deform("dried")
    with h5py.File(at("anew")) as renewed, h5py.File(at("carried")) as carried:
        sizes = lambda network: np.sort(network["throats/volume"][:])
        held = np.dot(carried["throats/saturation"][:], carried["throats/volume"][:]) + carried["summary"].attrs["expelled_volume"]
        with h5py.File(at("drying")) as drying:
            was = np.dot(saturation, drying["throats/volume"][:])
        ok(abs(held / was - 1) < 1e-12 and status == 0
           and np.allclose(sizes(moved), sizes(renewed), rtol=0, atol=1e-9 * sizes(renewed).mean()),
           "grains that cross a side of a box that repeats", moved if status else held / was)

    # Throats that have closed in the network anew: dry shuts them, so what they would hold goes to others.
    scene = sets("throat_volume=void")
    dries = sets('imposed_empty=["-x","+x","-y","+y","-z"]')
    run("pack", "-q", *sets("method=soft_spheres", "count=150", "sizes.distribution=two_mode", "sizes.second_radius=1e-7",
                            "sizes.second_share=0.6"), "-o", at("packing"))
    with h5py.File(at("packing"), "r+") as packing:
        packing["particles/radius"][...] *= 1.12
        place = packing["particles/position"][:]
    run("tessellate", *scene, at("packing"), "-o", at("network"))
    run("dry", "-q", *dries, *sets("stop_saturation=0.6"), at("network"), "-o", at("drying"))
    run("dem-replay", "-q", *sets("cycles=1", "engine=explicit"), "-o", at("response"),
        input=run("force-protocol", *sets("steps=2"), at("drying")))
    lay(0.05 * 2e-7 * np.random.default_rng(1).uniform(-1, 1, place.shape))
    packing = run("deform", *sets("write=packing"), at("drying"), at("response"))
    run("tessellate", *scene, "-o", at("anew"), input=packing)
    run("deform", at("drying"), at("response"), at("anew"), "-o", at("carried"))
    run("dry", "-q", *dries, at("carried"), "-o", at("dried"))
    with h5py.File(at("carried")) as carried, h5py.File(at("dried")) as after:
        held = carried["throats/saturation"][:] * carried["throats/volume"][:]
        shut = (carried["throats/kind"][:] == 0) & (after["throats/kind"][:] != 0)
        ok(shut.any() and not held[shut].any(), "no liquid in throats that have closed", (shut.sum(), held[shut].sum() / held.sum()))
done()
