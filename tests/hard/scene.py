# SPDX-License-Identifier: GPL-3.0-or-later
"""A hard case's scene, the stages that run on it, and forces made by hand."""
import json
import os
import re
import shutil
import subprocess

import h5py
import numpy as np

from cases import must
from tap import BIN

HERE = os.path.dirname(os.path.abspath(__file__))
CHAIN = ["pack", "tessellate", "merge-nodes", "dry", "force-protocol", "dem-replay",
         "crackstats"]
LIMITS = ["inviscid", "immobile"]
LIQUIDS = [*LIMITS, "viscous"]
QUASI_STATIC = ["--set", "engine=quasi-static", "--set", "quasi_static.tolerance=1e-12"]


class Scene:
    """A scene, and a folder where its artifacts go by the names of their stages."""

    def __init__(self, name, folder):
        self.name = name
        self.folder = folder
        self.path = os.path.join(HERE, name + ".json")
        with open(self.path) as file:
            self.json = json.load(file)
        self.grains = os.path.join(HERE, name + ".txt")

    def at(self, name):
        return os.path.join(self.folder, name + ".h5")

    def copy(self, name, path=None):
        """The same scene in a folder of its own."""
        other = Scene(self.name, os.path.join(self.folder, name))
        os.mkdir(other.folder)
        other.path = path or self.path
        return other

    def try_stage(self, stage, *arguments, input=None, output=None):
        """Runs a stage on what its forerunner left; gives the exit status and the message."""
        if input is None:
            k = CHAIN.index(stage)
            imports = self.json.get("pack", {}).get("method") == "import"
            input = self.at(CHAIN[k - 1]) if k else self.grains if imports else None
        command = [f"{BIN}/{stage}", "-p", self.path, *map(str, arguments),
                   *([input] if input else []), "-o", output or self.at(stage)]
        ended = subprocess.run(command, capture_output=True, text=True)
        return ended.returncode, ended.stderr.strip()

    def stage(self, stage, *arguments, **more):
        status, message = self.try_stage(stage, *arguments, **more)
        must(status == 0, f"{stage}: exit {status}: {message}")

    def stages(self, *names):
        for name in names:
            self.stage(name)

    def refused(self, stage, status, pattern, *arguments, **more):
        """STAGE must refuse with STATUS in one line like PATTERN, and leave no file."""
        output = more.setdefault("output", self.at("refused"))
        got, message = self.try_stage(stage, *arguments, **more)
        must(got == status, f"{stage}: exit {got}, not {status}: {message}")
        must(re.search(pattern, message), f"{stage}: {message}")
        must("\n" not in message, f"{stage}: more than one line: {message}")
        must(not os.path.exists(output), f"{stage}: left a file behind")
        return message.split(": ", 2)[-1]

    def get(self, stage, name):
        with h5py.File(self.at(stage), "r") as file:
            return file[name][()]

    def summary(self, stage, name):
        with h5py.File(self.at(stage), "r") as file:
            return float(file["summary"].attrs[name])

    def model(self, stage):
        with h5py.File(self.at(stage), "r") as file:
            model = file.attrs["model"]
            return model.decode() if isinstance(model, bytes) else model


def rewrite(source, target, **datasets):
    """SOURCE copied to TARGET with other values; __ stands for / in the names."""
    shutil.copyfile(source, target)
    with h5py.File(target, "r+") as file:
        for name, value in datasets.items():
            file[name.replace("__", "/")][...] = value


def write_forces(scene, time, force):
    """Forces made by hand on the packing, FORCE (n_time, n_particle, 3); the saturation
    falls from 1 to 0."""
    target = scene.at("force-protocol")
    shutil.copyfile(scene.at("pack"), target)
    with h5py.File(target, "r+") as file:
        file.attrs["schema"] = "craquelure/forces/1"
        file["time"] = np.asarray(time, float)
        file["saturation"] = np.linspace(1, 0, len(time))
        file["force"] = np.asarray(force, float)
        for name in ("capillary_pressure", "force_scale", "largest_force",
                     "first_period_end_time"):
            file["summary"].attrs[name] = 0.0


def pull(scene, force):
    """The last grain pulled along z with FORCE, in one step of the protocol after none."""
    n = len(scene.get("pack", "particles/radius"))
    table = np.zeros((2, n, 3))
    table[1, -1, 2] = force
    write_forces(scene, [0, 1], table)
