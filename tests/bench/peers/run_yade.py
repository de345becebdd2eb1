# SPDX-License-Identifier: GPL-3.0-or-later
# The settled packing under Yade, linear springs with friction; prints particle-steps a
# second. Run by yade, with these in the environment: PACKING, SKIN (m), STIFFNESS (N/m),
# DENSITY, FRICTION, DT (s), STEPS.
import math
import os
import time

skin, stiffness, density, friction, dt = (
    float(os.environ[name]) for name in ("SKIN", "STIFFNESS", "DENSITY", "FRICTION", "DT")
)
steps = int(os.environ["STEPS"])
with open(os.environ["PACKING"]) as file:
    box = [float(side) for side in file.readline().split()[2:5]]
    grains = [[float(word) for word in line.split()] for line in file]

# Two grains in series: k = E r.
material = FrictMat(
    young=stiffness / grains[0][3],
    poisson=2 / 7,
    frictionAngle=math.atan(friction),
    density=density,
)
O.materials.append(material)
O.periodic = True
O.cell.setBox(*box)
O.bodies.append([sphere(grain[:3], grain[3], material=material) for grain in grains])
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=skin, allowBiggerThanPeriod=True),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_FrictPhys()],
        [Law2_ScGeom_FrictPhys_CundallStrack()],
    ),
    NewtonIntegrator(damping=0.2),
]
O.dt = dt
O.run(max(steps // 10, 1), True)
start = time.perf_counter()
O.run(steps, True)
print("particle-steps", len(grains) * steps / (time.perf_counter() - start), flush=True)
os._exit(0)  # Yade's own way out waits for its threads.
