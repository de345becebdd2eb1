# SPDX-License-Identifier: GPL-3.0-or-later
"""simulate, LIGGGHTS and Yade on the same scene of equal grains: what each gives.

All three take linear springs with history and dashpots; the normal force never pulls; friction is limited by
the whole normal force (friction_limit=total, tensile_damping=false). Grains are equal, as the programs mix
dashpots of unequal ones differently. Planes and the drum stand or move as the scene says; a plane that
moves and the drum are meshes under LIGGGHTS, and all walls are triangles under Yade.
"""
import dataclasses
import json
import math
import os
import resource
import shutil
import subprocess
import sys

import h5py
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../.."))
from tap import BIN, scratch

RADIUS, DENSITY, STIFFNESS, FRICTION, RATIO = 1e-3, 2500, 1000.0, 0.5, 0.2
MASS = DENSITY * 4 / 3 * math.pi * RADIUS**3
SHEAR = STIFFNESS * 2 / 7
STEP = 0.1 * math.sqrt(MASS / STIFFNESS)
STRIPS = 180  # of the drum
folder = scratch()
at = lambda name: os.path.join(folder.name, name)
dashpot = lambda stiffness, mass: 2 * RATIO * math.sqrt(stiffness * mass)
COEFFICIENTS = {"kn": STIFFNESS, "kt": SHEAR, "cn": dashpot(STIFFNESS, MASS / 2), "ct": dashpot(SHEAR, MASS / 2),
                "wn": dashpot(STIFFNESS, MASS), "wt": dashpot(SHEAR, MASS), "friction": FRICTION}


@dataclasses.dataclass
class Plane:
    """Across AXIS at PLACE; grains stay on the side of SENSE; it moves along the axis with SPEED."""
    axis: int
    place: float
    sense: int
    speed: float = 0


@dataclasses.dataclass
class Scene:
    """Grains at POSITIONS, FRAMES of EVERY steps. The DRUM (radius, spin) turns about the axis y.
    LIQUID is the volume of a bridge, with TENSION."""
    positions: np.ndarray
    every: int
    frames: int
    planes: list = ()
    velocities: np.ndarray = None
    drum: tuple = None
    gravity: tuple = (0, 0, -9.81)
    liquid: float = 0
    tension: float = 0.0728
    model: str = "table"
    skin: float = 0.3 * RADIUS
    cores: int = 1
    quiet: bool = False  # no output but the end

    def __post_init__(self):
        self.positions = np.array(self.positions, float)
        moving = self.velocities is not None
        self.velocities = np.array(self.velocities, float) if moving else np.zeros_like(self.positions)

    @property
    def steps(self):
        return self.every * self.frames

    def driven(self):
        """Number of the wall that moves, drum last; None: none does."""
        moving = [k for k, plane in enumerate(self.planes) if plane.speed]
        return len(self.planes) if self.drum else moving[0] if moving else None


@dataclasses.dataclass
class Outcome:
    """(frames, n, 3) each, after EVERY steps and so on; LOAD (frames, 6) force and moment of the grains
    on the wall that moves; CPU seconds, wall clock SECONDS of the steps alone where the program says."""
    position: np.ndarray
    velocity: np.ndarray
    load: np.ndarray
    cpu: float
    loop: float = math.nan


def command(arguments, **more):
    """CPU seconds of the command, and what it printed."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    got = subprocess.run(arguments, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **more)
    if got.returncode:
        sys.exit(f"{arguments[0]} failed:\n" + got.stdout[-2000:])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, got.stdout


def write(name, text):
    with open(at(name), "w") as file:
        file.write(text if isinstance(text, str) else json.dumps(text))
    return at(name)


# --- simulate ----------------------------------------------------------------------------------------
def our_walls(scene):
    walls = {}
    for k, plane in enumerate(scene.planes):
        point, normal, velocity = [0, 0, 0], [0, 0, 0], [0, 0, 0]
        point[plane.axis], normal[plane.axis], velocity[plane.axis] = plane.place, plane.sense, plane.speed
        walls[f"plane {k}"] = {"point": point, "normal": normal, "velocity": velocity, "material": "glass"}
    if scene.drum:
        walls["the drum"] = {"shape": "cylinder", "point": [0, 0, 0], "normal": [0, 1, 0], "radius": scene.drum[0],
                             "spin": [0, scene.drum[1], 0], "material": "glass"}
    return walls


def our_scene(scene, **more):
    duration = scene.steps * STEP
    rows = duration if scene.quiet else scene.every * STEP
    what = {"duration": duration, "law": "linear", "time_step": STEP, "friction_limit": "total",
            "tensile_damping": False, "gravity": list(scene.gravity), "walls": our_walls(scene), "allow_unstable": True,
            "materials": {"glass": {"density": DENSITY, "friction": FRICTION, "normal_stiffness": 2 * STIFFNESS,
                                    "shear_stiffness": 2 * SHEAR, "damping_ratio": RATIO}},
            "record": {"every": rows, "energy": False, "contacts": False, "snapshots_every": rows}}
    if scene.liquid:
        what["bridges"] = {"volume": scene.liquid, "surface_tension": scene.tension, "model": scene.model,
                           "pull_in_contact": False}
    return {**what, **more}


def our_packing(scene):
    grains = np.column_stack([scene.positions, np.full(len(scene.positions), RADIUS)])
    np.savetxt(at("grains"), grains, fmt="%.17g")
    pack = {"method": "import", "check": "none", "lower": [-1] * 3, "upper": [1] * 3, "bonds": "none"}
    command([f"{BIN}/pack", "-q", "-p", write("pack.json", pack), at("grains"), "-o", at("packing")])
    with h5py.File(at("packing"), "r+") as packing:
        packing["particles/velocity"] = scene.velocities
        packing["particles/velocity"].attrs["units"] = np.bytes_("m s-1")


def simulate(scene, **more):
    our_packing(scene)
    cpu, _ = command([f"{BIN}/simulate", "-q", "--threads", f"{scene.cores}", "-p",
                      write("scene.json", our_scene(scene, **more)), at("packing"), "-o", at("motion")])
    with h5py.File(at("motion")) as motion:
        wall = scene.driven()
        load = None if wall is None else np.hstack([motion[f"history/wall_{name}"][1:, wall]
                                                    for name in ("force", "moment")])
        return Outcome(motion["snapshots/position"][1:], motion["snapshots/velocity"][1:], load, cpu)


def settled(scene, time, **more):
    """The scene with its grains where they are after TIME, s; nothing is known of how they came there."""
    our_packing(scene)
    rest = dataclasses.replace(scene, every=1, frames=1)
    command([f"{BIN}/simulate", "-q", "--threads", "1", "-p",
             write("scene.json", our_scene(rest, **{"duration": time, "record": {}, "write": "packing", **more})),
             at("packing"), "-o", at("settled")])
    with h5py.File(at("settled")) as packing:
        return packing["particles/position"][()]


# --- triangles ---------------------------------------------------------------------------------------
def triangle(plane, reach):
    """A plane as one triangle with legs of REACH, m, whose right angle is below all grains."""
    corners = np.full((3, 3), -0.3 * reach)
    others = [a for a in range(3) if a != plane.axis]
    corners[1, others[0]] += reach
    corners[2, others[1]] += reach
    corners[:, plane.axis] = plane.place
    return corners


def drum_triangles(radius):
    half = 0.05
    angle = 2 * np.pi * np.arange(STRIPS + 1) / STRIPS
    ring = np.column_stack([radius * np.sin(angle), 0 * angle, radius * np.cos(angle)])
    got = []
    for a, b in zip(ring[:-1], ring[1:]):
        low, high = np.array([0, -half, 0]), np.array([0, half, 0])
        got += [[a + low, b + low, a + high], [b + low, b + high, a + high]]
    return np.array(got)


def stl(name, triangles):
    text = "solid wall\n"
    for t in triangles:
        n = np.cross(t[1] - t[0], t[2] - t[0])
        n /= np.linalg.norm(n)
        text += "facet normal {} {} {}\nouter loop\n".format(*n)
        text += "".join("vertex {:.17g} {:.17g} {:.17g}\n".format(*corner) for corner in t)
        text += "endloop\nendfacet\n"
    return write(name, text + "endsolid wall\n")


# --- LIGGGHTS ----------------------------------------------------------------------------------------
def liggghts_walls(scene):
    model = "gran model hooke/stiffness tangential history primitive type 2"
    settings = "absolute_damping on limitForce on tangential_damping on"
    text = ""
    for k, plane in enumerate(scene.planes):
        if not plane.speed:
            text += f"fix plane{k} all wall/{model} {'xyz'[plane.axis]}plane {plane.place} {settings}\n"
    mesh, move = None, None
    if scene.drum:
        mesh = stl("drum.stl", drum_triangles(scene.drum[0]))
        move = f"rotate origin 0. 0. 0. axis 0. 1. 0. period {2 * math.pi / scene.drum[1]:.17g}"
    elif scene.driven() is not None:
        plane = scene.planes[scene.driven()]
        mesh = stl("plane.stl", [triangle(plane, 0.1)])
        move = "linear " + " ".join(f"{plane.speed if a == plane.axis else 0.:.17g}" for a in range(3))
    if mesh:
        text += (f"fix driven all mesh/surface/stress file {mesh} type 2 reference_point 0. 0. 0.\n"
                 f"fix walls all wall/gran model hooke/stiffness tangential history mesh n_meshes 1 meshes driven "
                 f"{settings}\nfix move2 all move/mesh mesh driven {move}\n")
        if not scene.quiet:
            names = " ".join(f"$(f_driven[{k}])" for k in range(1, 7))
            text += f"fix load all print {scene.every} \"{names}\" file {at('load')} screen no title \"\"\n"
    if not scene.quiet:
        text += (f"dump d all custom {scene.every} {at('dump')} id x y z vx vy vz\n"
                 'dump_modify d sort id format "%d %.17g %.17g %.17g %.17g %.17g %.17g"\n')
    return text + "\n"


def liggghts_data(scene):
    middle = (scene.positions.min(0) + scene.positions.max(0)) / 2  # where two processes share the grains
    text = f"grains\n\n{len(scene.positions)} atoms\n2 atom types\n\n"
    text += "".join(f"{x - 0.175} {x + 0.175} {a}lo {a}hi\n" for x, a in zip(middle, "xyz")) + "\nAtoms\n\n"
    text += "".join(f"{k} 1 {2 * RADIUS} {DENSITY} {p[0]:.17g} {p[1]:.17g} {p[2]:.17g}\n"
                    for k, p in enumerate(scene.positions, 1))
    if scene.velocities.any():
        text += "\nVelocities\n\n" + "".join(f"{k} {v[0]:.17g} {v[1]:.17g} {v[2]:.17g} 0 0 0\n"
                                             for k, v in enumerate(scene.velocities, 1))
    return text


def frames_of(path, n):
    with open(path) as file:
        lines = file.read().splitlines()
    return np.array([[line.split() for line in lines[k + 9:k + 9 + n]] for k in range(0, len(lines), n + 9)], float)[1:]


def liggghts(scene):
    strength = math.dist(scene.gravity, (0, 0, 0))
    downwards = [g / strength for g in scene.gravity]
    # Its bridges hold a twentieth of the liquid of both grains, given in per cent of their volumes.
    content = 100 * scene.liquid / (0.1 * MASS / DENSITY)
    names = {**COEFFICIENTS, "data": write("data", liggghts_data(scene)), "walls": write("walls", liggghts_walls(scene)),
             "skin": scene.skin, "cores": scene.cores, "dt": STEP, "steps": scene.steps, "g": strength, "content": content,
             "tension": scene.tension, "gx": downwards[0], "gy": downwards[1], "gz": downwards[2],
             "cohesion": "easo/capillary/viscous" if scene.liquid else "off"}
    launch = ["mpirun", "--allow-run-as-root", "-np", f"{scene.cores}"] if scene.cores > 1 else []
    cpu, said = command(launch + ["liggghts", "-in", os.path.join(HERE, "scene.liggghts"), "-log", "none"] +
                        [word for name, value in names.items() for word in ("-var", name, f"{value}")],
                        cwd=folder.name)
    loop = float(said.split("Loop time of ")[-1].split()[0])
    if scene.quiet:
        return Outcome(None, None, None, cpu, loop)
    rows = frames_of(at("dump"), len(scene.positions))
    load = None if scene.driven() is None else np.loadtxt(at("load"))[-scene.frames:]
    return Outcome(rows[:, :, 1:4], rows[:, :, 4:7], load, cpu, loop)


# --- Yade --------------------------------------------------------------------------------------------
def yade(scene, own_walls=False):
    """OWN_WALLS: planes are Yade's walls, not triangles."""
    frames, every = (1, scene.steps) if scene.quiet else (scene.frames, scene.every)
    walls = [{"triangles": [triangle(p, 2.0).tolist()], "velocity": [p.speed * (a == p.axis) for a in range(3)], "spin": 0,
              "plane": [p.place, p.axis, p.sense] if own_walls else None} for p in scene.planes]
    if scene.drum:
        walls.append({"triangles": drum_triangles(scene.drum[0]).tolist(), "velocity": [0, 0, 0],
                      "spin": scene.drum[1], "plane": None})
    what = {**COEFFICIENTS, "radius": RADIUS, "density": DENSITY, "dt": STEP, "skin": scene.skin, "frames": frames,
            "every": every, "positions": scene.positions.tolist(), "velocities": scene.velocities.tolist(),
            "walls": walls, "driven": scene.driven(), "gravity": scene.gravity, "liquid": scene.liquid,
            "tension": scene.tension, "out": at("yade.json")}
    cpu, _ = command(["yade", "-x", "-n", f"-j{scene.cores}", os.path.join(HERE, "scene_yade.py")],
                     env={**os.environ, "OMP_NUM_THREADS": f"{scene.cores}", "SCENE": write("yade-scene.json", what)})
    with open(at("yade.json")) as file:
        got = json.load(file)
    motion = np.array(got["frames"])
    return Outcome(motion[:, :, 0], motion[:, :, 1], np.array(got["load"]) if got["load"] else None, cpu, got["loop"])


PEERS = [p for p in (liggghts, yade) if shutil.which(p.__name__)]
