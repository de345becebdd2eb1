# SPDX-License-Identifier: GPL-3.0-or-later
# Equal spheres with linear springs, dashpots and friction in a box of planes under Yade. SCENE
# in the environment names a file of JSON with all there is; run by yade.
import json
import math
import os

with open(os.environ["SCENE"]) as file:
    s = json.load(file)
# Yade adds the springs of two bodies in series, and dashpots likewise: twice the pair's each.
angle = math.atan(s["friction"])
mat = lambda cn, cs: ViscElMat(kn=2 * s["kn"], ks=2 * s["kt"], cn=cn, cs=cs, frictionAngle=angle,
                               density=s["density"])
grain = O.materials.append(mat(2 * s["cn"], 2 * s["ct"]))
# in series with the grain's, what a wall's pair has
series = lambda pair, one: 1 / (1 / pair - 1 / one)
side = O.materials.append(mat(series(s["wn"], 2 * s["cn"]), series(s["wt"], 2 * s["ct"])))
ids = [O.bodies.append(sphere(p, s["radius"], material=grain)) for p in s["positions"]]
for i, v in zip(ids, s["velocities"]):
    # half a step before the start
    O.bodies[i].state.vel = Vector3(v[0], v[1], v[2] + 0.5 * 9.81 * s["dt"])
for axis, place, sense in s["planes"]:
    O.bodies.append(wall(place, axis, sense=sense, material=side))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=s["skin"]),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
                    [Ip2_ViscElMat_ViscElMat_ViscElPhys()], [Law2_ScGeom_ViscElPhys_Basic()]),
    NewtonIntegrator(damping=0, gravity=(0, 0, -9.81)),
]
O.dt = s["dt"]
frames = []
for _ in range(s["frames"]):
    O.run(s["every"], True)
    frames.append([[list(O.bodies[i].state.pos), list(O.bodies[i].state.vel)] for i in ids])
with open(s["out"], "w") as file:
    json.dump(frames, file)
os._exit(0)  # Yade's own way out waits for its threads.
