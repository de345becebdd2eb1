# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion artifacts from arrays, for tests and pictures whose outcome has a closed form."""
import json

import h5py
import numpy as np

SCHEMA = json.load(open("schemas/motion.json")), json.load(open("schemas/packing.json"))
TYPES = {"float64": "<f8", "int32": "<i4", "int64": "<i8", "uint8": "u1"}


class Contacts:
    """Pairs, forces (on the second), places, overlaps; bridge volumes and pulls where wet."""

    def __init__(self, pair=(), force=(), point=(), overlap=None, volume=None, pull=None):
        self.pair = np.array(pair, "<i4").reshape(-1, 2)
        self.force = np.array(force, float).reshape(-1, 3)
        self.point = np.array(point, float).reshape(-1, 3)
        n = len(self.pair)
        self.overlap = np.zeros(n) if overlap is None else np.array(overlap, float)
        self.volume, self.pull = volume, pull


def put(file, name, value, extents):
    """One dataset by its schema; a missing one is zeros of its shape."""
    for schema in SCHEMA:
        for entry in schema["datasets"]:
            if entry["name"] == name:
                kind, units, shape = TYPES[entry["type"]], entry["units"], entry["shape"]
    if value is None:
        value = np.zeros([extents.get(s, 0) if isinstance(s, str) else s for s in shape])
    data = file.create_dataset(name, data=np.asarray(value).astype(kind))
    data.attrs["units"] = units


def write_motion(path, position, velocity, radius, mass, contacts=None, time=None, driven=None,
                 lower=(-1e3,) * 3, upper=(1e3,) * 3, periodic=(0, 0, 0), history=None, walls=(),
                 groups=0, scene=None):
    """POSITION and VELOCITY are (snapshots, grains, 3); CONTACTS one for each snapshot; HISTORY
    maps "wall_force" and the like to arrays, WALLS are points; SCENE the parameters."""
    position, velocity = np.array(position, float), np.array(velocity, float)
    n_snapshot, n = position.shape[:2]
    contacts = contacts or [Contacts()] * max(n_snapshot, 1)
    history = dict(history or {})
    rows = len(history.setdefault("time", np.arange(1.0)))
    own = {"/particles/position": position[0] if n_snapshot else np.zeros((n, 3)), "/particles/radius": np.broadcast_to(radius, n),
           "/particles/mass": np.broadcast_to(mass, n), "/particles/driven": driven,
           "/domain/lower": lower, "/domain/upper": upper, "/domain/periodic": periodic,
           "/walls/point": np.array(walls, float).reshape(-1, 3),
           "/snapshots/time": np.arange(n_snapshot) if time is None else time,
           "/snapshots/box_lower": np.tile(lower, (n_snapshot, 1)),
           "/snapshots/box_upper": np.tile(upper, (n_snapshot, 1)),
           "/snapshots/position": position, "/snapshots/velocity": velocity,
           "/snapshots/contacts": [len(c.pair) for c in contacts][:n_snapshot],
           "/contacts/particles": np.concatenate([c.pair for c in contacts]),
           "/contacts/force": np.concatenate([c.force for c in contacts]),
           "/contacts/position": np.concatenate([c.point for c in contacts]),
           "/contacts/overlap": np.concatenate([c.overlap for c in contacts])}
    if contacts[0].volume is not None:
        own["/contacts/bridge_volume"] = np.concatenate([c.volume for c in contacts])
        own["/contacts/bridge_force"] = np.concatenate([c.pull for c in contacts])
    own.update({f"/history/{name}": value for name, value in history.items()})
    extents = {"n_particle": n, "n_snapshot": n_snapshot, "n_time": rows, "n_wall": len(walls),
               "n_group": groups, "n_contact": len(own["/contacts/particles"])}
    with h5py.File(path, "w") as file:
        file.attrs["schema"] = "craquelure/motion/1"
        if scene is not None:
            file.attrs["parameters"] = json.dumps(scene)
        file.require_group("/summary")
        for schema in SCHEMA:
            for entry in schema["datasets"]:
                if entry["name"] in own or not entry.get("optional"):
                    value = own.get(entry["name"])
                    if entry["name"] == "/contacts/bond":
                        value = -np.ones(extents["n_contact"])
                    put(file, entry["name"], value, extents)
            for entry in schema["attributes"]:
                if not entry.get("optional"):
                    kind = TYPES[entry["type"]]
                    file[entry["name"].rsplit("/", 1)[0]].attrs.create(
                        entry["name"].rsplit("/", 1)[1], 0, dtype=kind)
    return path
