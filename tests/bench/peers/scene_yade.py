# SPDX-License-Identifier: GPL-3.0-or-later
# Equal spheres with linear springs, dashpots and friction between walls of triangles under Yade.
# SCENE in the environment names a file of JSON with all there is; run by yade.
import json
import math
import os
import time

with open(os.environ["SCENE"]) as file:
    s = json.load(file)
wet = s["liquid"] > 0
# Yade adds the springs of two bodies in series, and dashpots likewise: twice the pair's each.
angle = math.atan(s["friction"])
liquid = {"Capillar": True, "Vb": s["liquid"], "gamma": s["tension"], "theta": 0, "CapillarType": "Willett_numeric"}
material = lambda cn, cs, **more: (ViscElCapMat if wet else ViscElMat)(
    kn=2 * s["kn"], ks=2 * s["kt"], cn=cn, cs=cs, frictionAngle=angle, density=s["density"], **more)
grain = O.materials.append(material(2 * s["cn"], 2 * s["ct"], **(liquid if wet else {})))
# in series with the grain's, what a wall's pair has
series = lambda pair, one: 1 / (1 / pair - 1 / one)
side = O.materials.append(material(series(s["wn"], 2 * s["cn"]), series(s["wt"], 2 * s["ct"])))
ids = [O.bodies.append(sphere(p, s["radius"], material=grain)) for p in s["positions"]]
for i, v in zip(ids, s["velocities"]):
    # half a step before the start
    O.bodies[i].state.vel = Vector3(v) - 0.5 * s["dt"] * Vector3(s["gravity"])
walls = [[O.bodies.append(facet(t, material=side)) for t in w["triangles"]] if not w["plane"] else
         [O.bodies.append(wall(*w["plane"], material=side))] for w in s["walls"]]
turning = []
for w, bodies in zip(s["walls"], walls):
    for i in bodies:
        O.bodies[i].state.vel = Vector3(w["velocity"])
    if w["spin"]:
        turning.append(RotationEngine(ids=bodies, rotationAxis=(0, 1, 0), angularVelocity=w["spin"],
                                      rotateAroundZero=True, zeroPoint=(0, 0, 0)))
reach = 1.06 if wet else 1  # a bridge of a thousandth of R^3 ruptures at 0.1 R
shapes = [Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=reach), Ig2_Facet_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()]
laws = ([Ip2_ViscElCapMat_ViscElCapMat_ViscElCapPhys()], [Law2_ScGeom_ViscElCapPhys_Basic()]) if wet else \
       ([Ip2_ViscElMat_ViscElMat_ViscElPhys()], [Law2_ScGeom_ViscElPhys_Basic()])
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=reach), Bo1_Facet_Aabb(), Bo1_Wall_Aabb()], verletDist=s["skin"]),
    InteractionLoop(shapes, *laws),
    *turning,
    NewtonIntegrator(damping=0, gravity=s["gravity"]),
]
O.dt = s["dt"]
frames, load = [], []
before = time.process_time(), time.time()
for _ in range(s["frames"]):
    O.run(s["every"], True)
    frames.append([[list(O.bodies[i].state.pos), list(O.bodies[i].state.vel)] for i in ids])
    if s["driven"] is not None:
        bodies = walls[s["driven"]]
        force = sum((O.forces.f(i) for i in bodies), Vector3(0, 0, 0))
        moment = sum((O.forces.t(i) + O.bodies[i].state.pos.cross(O.forces.f(i)) for i in bodies), Vector3(0, 0, 0))
        load.append(list(force) + list(moment))
with open(s["out"], "w") as file:
    json.dump({"frames": frames, "load": load, "loop": time.time() - before[1]}, file)
os._exit(0)  # Yade's own way out waits for its threads.
