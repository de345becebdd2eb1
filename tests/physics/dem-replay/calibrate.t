#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Bonds from a material: a lattice in closed form, and an irregular packing tested again by the other
# engine, with friction.
import itertools
import json
import os
import subprocess
import sys
from math import pi

sys.path.insert(0, "tests")
from tap import BIN, done, ok, scratch_paths

at = scratch_paths()


def calibrate(scene, *wanted, program="calibrate", axes="z", programs=BIN):
    with open(at("scene.json"), "w", encoding="utf-8") as file:
        json.dump(scene, file)
    words = [at("calibrated.json"), *wanted] if program == "calibrate" else wanted
    return subprocess.run([f"pipelines/calibrate/{program}", at("scene.json"), *words], text=True, capture_output=True,
                          env={**os.environ, "BIN": programs, "AXES": axes}, check=False)


def numbers(said):
    """The means of the table."""
    return [float(line.split("|")[3].split("±")[0]) for line in said.stdout.splitlines()[2:5]]


def bond():
    with open(at("calibrated.json"), encoding="utf-8") as file:
        return json.load(file)["dem-replay"]["bond"]


# ---- a lattice: each column is a chain of bonds -------------------------------------------

R, FRACTION = 1e-6, 0.5
LATTICE = {"pack": {"method": "cubic", "counts": [4, 4, 8], "radius": R, "bonds": "touching"}, "conditions": {"fluid": "water"},
           "dem-replay": {"bond": {"normal_stiffness": 1e12, "shear_stiffness": 2e12, "normal_strength": 3e5,
                                   "shear_strength": 5e5, "radius_fraction": FRACTION}}}
said = calibrate(LATTICE, "2e9", "none", "1e6")
lines = said.stderr.splitlines()
ok(len(lines) > 3 and all(line.startswith(f"test {k}, along z: ") for k, line in enumerate(lines, 1)), "a line for each test", lines)
area, distance = pi * (FRACTION * R)**2, 2 * R
modulus = bond()["normal_stiffness"] * area / distance if said.returncode == 0 else 0
strength = bond()["normal_strength"] * area / distance**2 if said.returncode == 0 else 0
ok(said.returncode == 0 and abs(modulus / 2e9 - 1) < 1e-3, "a lattice has the modulus of its chains of bonds", (said.stderr, modulus))
ok(abs(strength / 1e6 - 1) < 0.01, "and their strength", strength)
ok(abs(bond()["shear_stiffness"] / bond()["normal_stiffness"] - 2) < 1e-5 and abs(
    bond()["shear_strength"] / bond()["normal_strength"] * 3 / 5 - 1) < 1e-5, "ratios stay where no Poisson ratio is asked for", bond())
first = bond()
quiet = calibrate(LATTICE, "2e9", "none", "1e6", "-q")
ok((quiet.returncode, quiet.stderr, quiet.stdout, bond()) == (0, "", said.stdout, first), "none with -q", quiet.stderr)
ok("mean radii long" not in said.stderr, "16 mean radii are long enough", said.stderr)
short = calibrate({**LATTICE, "pack": {**LATTICE["pack"], "counts": [4, 4, 5]}}, "2e9", "none", "1e6")
ok(short.returncode == 0 and "the packing is 10 mean radii long along z" in short.stderr, "and 10 are not, which is told", short.stderr)
said = calibrate({**LATTICE, "dem-replay": {"bond": {**LATTICE["dem-replay"]["bond"], "shear_strength": 1e20}}}, "2e9", "none", "1e6")
strength = bond()["normal_strength"] * area / distance**2 if said.returncode == 0 else 0
ok(abs(strength / 1e6 - 1) < 0.01, "bonds that do not shear off: the same strength", (said.stderr, strength))

# Columns in a cylinder, and around a hole: those farthest from the axis and nearest to it bound the section.
ROUND = {"shape": "cylinder", "radius": 5 * R, "height": 16 * R}
for domain, columns, section in [(ROUND, 13, pi * (5 * R)**2),
                                 ({**ROUND, "shape": "ring", "radius": 8 * R, "inner_radius": 3 * R}, 20,
                                  pi * ((34**0.5 + 1)**2 - (18**0.5 - 1)**2) * R**2)]:
    said = calibrate({**LATTICE, "pack": {"method": "cubic", "radius": R, "bonds": "touching", "domain": domain}}, "2e9", "none", "1e6")
    modulus = bond()["normal_stiffness"] * area * distance * columns / section if said.returncode == 0 else 0
    strength = bond()["normal_strength"] * area * columns / section if said.returncode == 0 else 0
    ok(abs(modulus / 2e9 - 1) < 1e-3 and abs(strength / 1e6 - 1) < 0.01, f"the section of a {domain['shape']} is round",
       (said.stderr, modulus, strength))

# Beside 16 columns, as many ends of columns that nothing joins to them: the columns bear all force.
with open(at("grains.txt"), "w", encoding="utf-8") as file:
    for i, j, k in itertools.product((*range(4), *range(6, 10)), range(4), range(8)):
        if i < 4 or k in (0, 7):
            file.write(f"{(2 * i + 1) * R} {(2 * j + 1) * R} {(2 * k + 1) * R} {R}\n")
said = calibrate({**LATTICE, "pack": {"method": "import", "bonds": "touching"}}, "2e9", "none", "1e6", at("grains.txt"))
modulus = bond()["normal_stiffness"] * area * distance * 16 / (20 * R * 8 * R) if said.returncode == 0 else 0
strength = bond()["normal_strength"] * area * 16 / (20 * R * 8 * R) if said.returncode == 0 else 0
ok(abs(modulus / 2e9 - 1) < 1e-3 and abs(strength / 1e6 - 1) < 0.01, "grains that are not joined to the body bear no force",
   (said.stderr, modulus, strength))

# A column beside 16 others, which a grain joins to them at half their height. Its larger ends take a greater force, and it
# breaks first; what the others bear then is less than the stress.
with open(at("grains.txt"), "w", encoding="utf-8") as file:
    for i, j, k in itertools.product(range(4), range(4), range(9)):
        file.write(f"{(2 * i + 1) * R} {(2 * j + 1) * R} {(2 * k + 1) * R} {R}\n")
    for x, z, r in [(9, 9, 1), (11, 0.5, 1.5), (11, 17.5, 1.5), *((11, 2 * k + 1, 1) for k in range(1, 8))]:
        file.write(f"{x * R} {3 * R} {z * R} {r * R}\n")
said = calibrate({**LATTICE, "pack": {"method": "import", "bonds": "touching"}}, "2e9", "none", "1e6", at("grains.txt"))
strength = bond()["normal_strength"] * area * 16 / (12.5 * R * 8 * R) if said.returncode == 0 else 0
ok(abs(strength / 1e6 - 1) < 0.01, "a body bears more after a part of it has torn off", (said.stderr, strength))
ok(calibrate(LATTICE, "2e9", "0.2", "1e6").returncode == 65, "a cubic lattice has no Poisson ratio but 0")

# ---- grains that settled ------------------------------------------------------------------

SETTLED = {"pack": {"method": "deposition", "count": 60, "radius": 50e-6, "seed": 2, "touching_gap": 0.05, "bonds": "touching",
                    "sizes": {"distribution": "normal", "spread": 0.2, "smallest": 25e-6, "largest": 75e-6}},
           "dem-replay": {"bond": {"normal_stiffness": 8e13, "shear_stiffness": 8e13, "normal_strength": 4e5, "shear_strength": 4e5}}}
said = calibrate(SETTLED, "1e9", "0.15", "1e5")
found = numbers(said) if said.returncode == 0 else [0] * 3
ok(abs(found[0] / 1e9 - 1) < 1e-3 and abs(found[1] - 0.15) < 1e-3 and abs(found[2] / 1e5 - 1) < 1e-3,
   "a packing gets what was asked for", (said.stdout, said.stderr))
with open(at("calibrated.json"), encoding="utf-8") as file:
    scene = json.load(file)
slow = numbers(calibrate(scene, "slow", program="measure"))
ok(abs(slow[0] / 1e9 - 1) < 0.02 and abs(slow[1] - 0.15) < 0.02 and abs(slow[2] / 1e5 - 1) < 0.02,
   "and has it by time steps with friction", slow)

# A tenth as wide, a hundredth as strong, but for bending.
borne = []
for fraction in 0.5, 0.05:
    scene = {**SETTLED, "dem-replay": {"bond": {**SETTLED["dem-replay"]["bond"], "radius_fraction": fraction}}}
    borne += numbers(calibrate(scene, "fast", program="measure"))[2:]
ok(0.5e-2 < borne[1] / borne[0] < 2e-2, "thin bonds bear in proportion to their sections, or nearly so", borne)
scene["dem-replay"]["bond"]["radius_fraction"] = 0.01
said = calibrate(scene, "1e6", "none", "1e2")
ok(said.returncode == 0 and abs(numbers(said)[0] / 1e6 - 1) < 1e-3, "bonds so thin that they hardly bend have a modulus", said.stderr)

# Unequal grains, one of which keeps a residual force of a few 1e-8 of the load.
UNEQUAL = {"pack": {"method": "deposition", "count": 60, "radius": 12e-6, "seed": 3, "sizes": {"distribution": "lognormal", "spread": 0.35}},
           "dem-replay": {"normal_stiffness": 1.4e6, "shear_stiffness": 1.4e6,
                          "bond": {"normal_stiffness": 1.7e13, "shear_stiffness": 1.7e13, "normal_strength": 1.6e5, "shear_strength": 1.6e5}}}
said = calibrate(UNEQUAL, "1e9", "none", "1e5", axes="x")
ok(said.returncode == 0, "a residual force of a few 1e-8 is rest enough for moduli", said.stderr)

# Layers that crack by suction, or by shrinkage, are tested without either.
plain, drained = (calibrate({**SETTLED, "dem-replay": {**SETTLED["dem-replay"], **more}}, "1e9", "none", "1e5")
                  for more in ({}, {"capillary": {"suction": 1e5, "control": "evaporation"}, "shrinkage": {"strain": 0.1}}))
ok(drained.returncode == 0 and drained.stdout == plain.stdout, "suction and shrinkage of the scene change no test", drained.stderr)

# ---- what cannot be -----------------------------------------------------------------------

for what, scene, wanted, status, line in [
        ("no bonds", {**SETTLED, "pack": {**SETTLED["pack"], "bonds": "none"}}, ("1e9", "none", "1e5"), 65, "lists no bond"),
        ("a Poisson ratio of 0.9", SETTLED, ("1e9", "0.9", "1e5"), 65, "POISSON_RATIO: bonds of this packing give"),
        ("a modulus in words", SETTLED, ("stiff", "none", "1e5"), 64, "YOUNG_MODULUS: must be a number above 0, got stiff"),
        ("a strength below 0", SETTLED, ("1e9", "none", "-1"), 64, "TENSILE_STRENGTH: must be a number above 0, got -1"),
        ("bonds without strength", {**SETTLED, "dem-replay": {"bond": {"normal_strength": 0}}}, ("1e9", "none", "1e5"), 65,
         "must be above 0"),
        ("contact bonds", {**SETTLED, "dem-replay": {"bond": {"kind": "contact"}}}, ("1e9", "none", "1e5"), 65, "must be parallel"),
        ("overlaps that push", {**SETTLED, "dem-replay": {**SETTLED["dem-replay"], "prestress": True}}, ("1e9", "none", "1e5"), 65,
         "prestress: must be false"),
        ("a sphere", {**LATTICE, "pack": {"method": "cubic", "radius": R, "bonds": "touching",
                                          "domain": {"shape": "sphere", "radius": 8 * R}}}, ("1e9", "none", "1e5"), 65, "pack.domain"),
        ("a periodic box", {"pack": {**LATTICE["pack"], "periodic": [True, True, True]}}, ("1e9", "none", "1e5"), 65, "pack.periodic"),
        ("an unknown key", {"pack": {"metod": "cubic"}}, ("1e9", "none", "1e5"), 65, "pack.metod: unknown key")]:
    said = calibrate(scene, *wanted, "-q")
    ok(said.returncode == status and line in said.stderr and said.stderr.count("\n") == 1, f"{what} is refused",
       (said.returncode, said.stderr))
ok(calibrate(SETTLED, "1e9", "none", "1e5", axes="q").returncode == 64, "and axes that there are not")

# Bonds that hardly shear make bodies whose equilibrium may not be found: this dem-replay finds none below a tenth.
os.mkdir(at("bin"))
for name in os.listdir(BIN):
    os.symlink(f"{BIN}/{name}", at(f"bin/{name}"))
os.remove(at("bin/dem-replay"))
os.symlink(f"{os.path.dirname(BIN)}/lib", at("lib"))
with open(at("bin/dem-replay"), "w", encoding="utf-8") as file:
    file.write(f"""#!/usr/bin/python3
import subprocess, sys
import h5py
subprocess.run(["{BIN}/dem-replay", *sys.argv[1:]], check=True)
said = dict(word.split("=") for word in sys.argv if word.startswith("bond."))
if said and float(said["bond.shear_stiffness"]) < 0.0999 * float(said["bond.normal_stiffness"]):
    with h5py.File(sys.argv[-1], "r+") as response:
        response["summary"].attrs["steps_unsettled"] = 1
        response["snapshots/displacement"][:] = 0
""")
os.chmod(at("bin/dem-replay"), 0o755)
said = calibrate(SETTLED, "1e9", "0.15", "1e5", programs=at("bin"))
ok(said.returncode == 0 and abs(numbers(said)[1] - 0.15) < 1e-3, "a Poisson ratio is found without such bodies", said.stderr)
said = calibrate(SETTLED, "1e9", "0.9", "1e5", "-q", programs=at("bin"))
ok(said.returncode == 3 and "no equilibrium found along z with shear over normal stiffness 0.01" in said.stderr
   and said.stderr.count("\n") == 1, "and where there is no other, this is said", (said.returncode, said.stderr))
done()
