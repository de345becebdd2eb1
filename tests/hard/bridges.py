# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard cases of capillary bridges."""
import json
import subprocess

import numpy as np

from cases import case, must
from tap import BIN


def bridge(scene, **settings):
    command = [f"{BIN}/bridge", "-p", scene.path]
    for key, value in settings.items():
        command += ["--set", f"{key}={json.dumps(value)}"]
    ended = subprocess.run(command, capture_output=True, text=True)
    must(ended.returncode == 0, f"{settings}: exit {ended.returncode}: {ended.stderr}")
    return json.loads(ended.stdout)


@case("bridge-range")
def bridge_range(scene):
    count, worst = 0, 0
    for ratio in (1, 1e4, np.inf):
        body = {"plane": True} if ratio == np.inf else {"other_radius": 1e-3 * ratio}
        effective = 2e-3 / (1 + 1 / ratio)
        for angle in (0, 60, 120):
            for volume in (1e-9, 1e-5, 1e-2, 1):
                got = bridge(scene, volume=volume * effective**3, contact_angle=angle, surface_tension=0.0728,
                             **body)
                force, neck = np.array(got["force"]), np.array(got["neck_radius"])
                must(np.isfinite(force).all() and not any(got["flags"]),
                     f"{ratio} {angle} {volume}: {force}")
                if angle == 0 and volume < 0.1:  # thinnest inside, not at a contact line
                    balance = 2 * np.pi * 0.0728 * neck + np.pi * neck**2 * got["suction"]
                    worst = max(worst, np.abs(balance / force - 1).max())
                count += 1
    must(worst < 1e-9, f"forces miss the balance at the neck by {worst:.1e}")
    small = bridge(scene, radius=1e-9, volume=1e-31, contact_angle=30)["force"]
    large = bridge(scene, radius=1e3, volume=1e5, contact_angle=30)["force"]
    off = np.abs(np.array(large) / np.array(small) / 1e12 - 1).max()
    must(off < 1e-10, f"1 nm and 1 km differ by {off:.1e}")
    return f"{count} curves; balance at the neck to {worst:.0e}, scales to {off:.0e}"


@case("bridge-ends")
def bridge_ends(scene):
    widest = bridge(scene, points=2)["rupture_distance"]
    h = 1e-3 * widest
    places = [-0.2 * widest, 0.2 * widest]
    worst = 0
    for a in places:
        got = bridge(scene, separations=[a - 2 * h, a - h, a, a + h, a + 2 * h])
        e = got["energy"]
        slope = (e[0] - 8 * e[1] + 8 * e[3] - e[4]) / (12 * h)
        worst = max(worst, abs(slope / got["force"][2] - 1))
    must(worst < 1e-7, f"force and slope of the energy differ by {worst:.1e}")
    contact = bridge(scene, separations=[-1e-12, 0, 1e-12])["force"]
    must(abs(contact[2] / contact[0] - 1) < 1e-6, f"a step at contact: {contact}")
    share = [1 - 4.0**-k for k in range(4, 11)]
    last = bridge(scene, separations=[s * widest for s in share] + [widest, 1.001 * widest])
    falls = np.array(last["force"][:-2]) - last["force"][-2]
    must((falls > 0).all() and np.abs(falls[:-1] / falls[1:] - 2).max() < 0.2,
         f"no root before rupture: {falls}")
    must(last["force"][-1] == 0 and last["flags"][-1] == ["ruptured"], "pulls beyond rupture")
    for model in ("weigert", "willett-full", "soulie"):
        wild = bridge(scene, model=model, contact_angle=120, other_contact_angle=120,
                      volume=1e-20, separations=[-1e-6, 0, 1e3])
        must(np.isfinite(wild["force"]).all() and all(wild["flags"]), f"{model}: {wild}")
    return f"force and slope of the energy agree to {worst:.0e}; last forces fall as the root"
