# SPDX-License-Identifier: GPL-3.0-or-later
"""Artifacts of a large body without an hour of computing: those of a small one, side by side.
What the schema calls n_particle, n_throat, ... is repeated, and numbers of such things go on."""
import json

import h5py
import numpy as np

REPEATED = ["n_event", "n_particle", "n_node", "n_throat", "n_bond", "n_crack", "n_contact"]
SHIFTED = ["/particles/position", "/nodes/position", "/cracks/position"]
SCATTERED = ["/force", "/throats/radius"]  # copies that are not quite alike compress no better than a body


def datasets(schema):
    """Name to entry, of a schema and those that it extends."""
    with open(f"schemas/{schema}.json") as file:
        found = json.load(file)
    entries = {entry["name"]: entry for entry in found["datasets"]}
    for below in found.get("extends", []):
        entries = {**datasets(below), **entries}
    return entries


def tiled(values, entry, sizes, shifts):
    """VALUES beside each other, one copy for each of SHIFTS (m)."""
    for axis, name in enumerate(entry["shape"]):
        if name in REPEATED:
            values = np.concatenate([values] * len(shifts), axis)
    if entry["name"] in SHIFTED:
        values += np.repeat(shifts, len(values) // len(shifts), 0)
        values += np.random.default_rng(1).uniform(-1, 1, values.shape) * np.ptp(shifts) * 2e-5
    if entry["name"] in SCATTERED:
        values *= np.random.default_rng(2).uniform(0.98, 1, values.shape)
    if entry.get("below") in REPEATED and entry["shape"][0] in REPEATED:
        copy = np.repeat(np.arange(len(shifts)), len(values) // len(shifts)).reshape([-1] + [1] * (values.ndim - 1))
        values = np.where(values >= 0, values + copy * sizes[entry["below"]], values).astype(values.dtype)
    return values


def tile_changes(file, sizes, copies):
    """At the steps at which a throat is empty it is so in every copy; what is between is left out."""
    offset, throat, held = (file[f"changes/{name}"][:] for name in ["offset", "throat", "saturation"])
    step = np.repeat(np.arange(len(offset) - 1), np.diff(offset))
    whole = (held <= 0) | (step == 0)
    step, throat, held = step[whole], throat[whole], held[whole]
    order = np.argsort(np.tile(step, copies), kind="stable")
    copy = np.repeat(np.arange(copies), len(throat))
    count = np.bincount(step, minlength=len(offset) - 1)
    return {"changes/offset": np.append(0, np.cumsum(count)) * copies, "changes/saturation": np.tile(held, copies)[order],
            "changes/throat": (np.tile(throat, copies) + copy * sizes["n_throat"]).astype("i4")[order]}


def tile(source, target, counts):
    """Writes TARGET: SOURCE, COUNTS times along x, y, z."""
    with h5py.File(source) as old, h5py.File(target, "w") as new:
        schema = old.attrs["schema"].decode().split("/")[1]
        entries = {name: entry for name, entry in datasets(schema).items()
                   if name in old and not name.startswith(("/boundary", "/faces", "/snapshots/liquid"))}
        sizes = {name: old[path].shape[axis] for path, entry in entries.items()
                 for axis, name in enumerate(entry["shape"]) if isinstance(name, str)}
        box = old["domain/upper"][:] - old["domain/lower"][:]
        shifts = np.array([box * [i, j, k] for k in range(counts[2]) for j in range(counts[1]) for i in range(counts[0])])
        made = {name: tiled(old[name][:], entry, sizes, shifts) for name, entry in entries.items()}
        if schema == "drying":
            made.update({f"/{name}": values for name, values in tile_changes(old, sizes, len(shifts)).items()})
        if schema != "forces":
            ordered = "/cracks/" if schema == "response" else "/events/"
            order = np.argsort(made[ordered + "time"], kind="stable")
            made.update({name: values[order] for name, values in made.items() if name.startswith(ordered)})
        made["/domain/upper"] = old["domain/lower"][:] + box * counts
        for name, values in made.items():
            new[name] = values
        for name in old.get("faces", []):  # a page shows none
            new[f"faces/{name}"] = old[f"faces/{name}"][:name == "offset"]
        for place in [""] + [name for name in old if isinstance(old[name], h5py.Group)]:
            for key, value in old[f"/{place}"].attrs.items():
                new.require_group(f"/{place}").attrs[key] = value
        new.attrs["inputs"] = np.bytes_("[]")
