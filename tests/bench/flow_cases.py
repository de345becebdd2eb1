# SPDX-License-Identifier: GPL-3.0-or-later
"""Spheres to let flow between, and Yade's FlowEngine on them."""
import random
import subprocess

from costs import at, bin_folder, cost

YADE = """
from yade import *
grains = [[float(x) for x in line.split()] for line in open('{spheres}')]
O.bodies.append(utils.aabbWalls([(0, 0, 0), (1, 1, 1)], thickness=0))
O.bodies.append([utils.sphere(g[:3], g[3]) for g in grains])
flow = FlowEngine(useSolver=3, bndCondIsPressure=[0, 0, 1, 1, 0, 0],
                  bndCondValue=[0, 0, 1, 0, 0, 0], boundaryUseMaxMin=[0] * 6, viscosity=1,
                  meshUpdateInterval=100000, permeabilityFactor=1, dead=not grains)
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()]), flow]
O.dt = 1e-9
if grains: flow.emulateAction()
import os; os._exit(0)
"""


def spheres(along):
    random.seed(1)
    step = 1 / along
    jitter = lambda: random.uniform(-.14, .14) * step
    with open(at("spheres"), "w") as file:
        for i in range(along ** 3):
            centre = [(k + .5) * step + jitter()
                      for k in (i // along ** 2, i // along % along, i % along)]
            print(*(f"{x:.17g}" for x in centre), random.uniform(.32, .36) * step, file=file)
    subprocess.run([f"{bin_folder}/pack", "-q", "--set=method=import", "--set=lower=[0,0,0]",
                    "--set=upper=[1,1,1]", "--set=bonds=none", "-o", at("packing")],
                   stdin=open(at("spheres")), check=True)


def yade(spheres_file):
    with open(at("script.py"), "w") as file:
        file.write(YADE.format(spheres=spheres_file))
    return cost("yade", "-n", "-x", at("script.py"))
