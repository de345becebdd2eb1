#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Grains that are not what their maker thinks: `check` says so with the numbers that a search of
all pairs and places finds, `pack` refuses what cannot be and says what can hardly be meant, and a
replay without bonds ends at once."""
import json
import os
import re
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, run, scratch_paths, sets

at = scratch_paths()


def text(name, position, radius):
    np.savetxt(at(name), np.column_stack([position, radius]), fmt="%.17g")
    return at(name)


def call(stage, *words):
    ended = subprocess.run([f"{BIN}/{stage}", *words], capture_output=True, text=True, timeout=60)
    return ended.returncode, ended.stdout, ended.stderr


def check(path, *words):
    """Status and report, and whether text and report say the same."""
    told, lines, said = call("check", *words, path)
    status, document, error = call("check", *words, path, "-o", "-")
    report = json.loads(document)
    beginnings = [f"{f['severity']}: {f['name']}: {f['text']}" for f in report["findings"]]
    agree = (told, said, error) == (status, "", "") and \
        lines.splitlines()[:len(beginnings)] == beginnings
    return status, report, agree


def names(report):
    return [f["name"] for f in report["findings"] if f["severity"] != "note"]


# 150 grains that grew until they jammed, as text.
run("pack", "-q", *sets("method=radius_expansion", "count=150", "radius=50e-6", "seed=2",
                        "dynamics.friction=0", "touching_gap=0.01"), "-o", at("own"))
with h5py.File(at("own")) as file:
    x, r = file["particles/position"][:], file["particles/radius"][:]
    low, high = file["domain/lower"][:], file["domain/upper"][:]
near = sets("touching_gap=0.01")
n = len(r)
distance = lambda p: np.linalg.norm(p[:, None] - p[None], axis=2)
first, second = np.triu_indices(n, 1)


def overlap_of(position, radius):
    apart = distance(position)[first, second]
    return ((radius[first] + radius[second] - apart)
            / np.minimum(radius[first], radius[second])).max()


# ---- good grains ------------------------------------------------------------------------

good = text("good", x, r)
status, report, agree = check(good, *near)
ok(status == 0 and report["wrong"] == 0 and agree, "good grains pass", report["findings"])
ok(np.isclose(report["contacts"]["max_overlap"], overlap_of(x, r)), "their largest overlap")
sums = (r[first] + r[second])
ok(report["contacts"]["pairs"] == (distance(x)[first, second] <= 1.01 * sums).sum()
   == report["bonds"]["count"], "their contacts, which pack would bond")
quantiles = np.sort(r)[[0, n // 10, n // 2, n - 1 - n // 10, n - 1]]
ok(np.array_equal([report["radius"][k] for k in
                   ("smallest", "tenth", "median", "ninetieth", "largest")], quantiles),
   "their sizes")
suggested = report["suggested"]["dem-replay"]
# Grains of glass count as 50 times as stiff as a bond; softer ones as they are.
ok(np.isclose(suggested["normal_stiffness"], 50 * 4e8 / 2 * np.pi * 0.25 * quantiles[2], rtol=0.05)
   and np.isclose(suggested["bond"]["normal_stiffness"], 4e8 / 2 / quantiles[2], rtol=0.05),
   "stiffnesses follow from moduli and size", suggested)
soft = check(good, *near, *sets("grain_modulus=1e9"))[1]["suggested"]["dem-replay"]
ok(np.isclose(soft["normal_stiffness"], 2 * 1e9 * quantiles[2], rtol=0.05), "soft grains", soft)
with open(at("scene.json"), "w") as file:
    json.dump(report["suggested"], file)
ok(call("dem-replay", "-p", at("scene.json"), "--parameters")[0] == 0,
   "what is suggested is a section of a scene")
status, _, said = call("pack", *sets("method=import"), *near, good, "-o", at("packed"))
ok(status == 0 and said == "", "and pack has nothing to say", said)
status, report, _ = check(at("packed"))
ok(status == 0 and report["inputs"][0]["schema"] == "craquelure/packing/1", "a packing passes")
ok(call("check", "-q", good)[1] == "", "-q says it by the status alone")
ok(call("check", at("scene.json"))[0] == 65, "what holds no grains is bad input")
ok(call("check", at("nothing"))[0] == 66, "no such input")

# A body far from the origin: places that are told still say where its lowest grains are.
for origin in 0, 0.01, 3, 1000:
    far = text("far", x + origin, r)
    told = call("check", *near, far)[1]
    box = {key: float(z) for key, z in re.findall(r"held\.(\w+)=\[\S+,(\S+)\]", told)}
    below = float(re.search("centres below (\\S+) m", told)[1])
    want = check(far, *near)[1]["suggested"]["dem-replay"]["held"]
    z = x[:, 2] + origin
    held = (z < want["upper"][2]).sum()
    ok(held > 3 and (z < below).sum() == held == ((z > box["lower"]) & (z < box["upper"])).sum(),
       f"grains to hold, {origin} m from the origin", (held, below, box))

with open(good, "rb") as file:
    lines = file.read()
with open(at("windows"), "wb") as file:
    file.write(b"\xef\xbb\xbf" + lines.replace(b"\n", b"\r\n"))
told = check(at("windows"), *near)[1]
ok({**told, "inputs": []} == {**check(good, *near)[1], "inputs": []}, "as Windows writes them", told)
tables = {
    "columns by name, in CSV": ['Label,"Z [µm]",x,R,y,note'] + [
        f"{k},{c!r},{a!r},{radius!r},{b!r}," for k, ((a, b, c), radius) in enumerate(zip(x.tolist(), r.tolist()))],
    "columns by name, between blanks": ["# tomogram 3", "", " id radius  x y z"] + [
        f"g{k}  {radius!r} {a!r} {b!r}  {c!r}" for k, ((a, b, c), radius) in enumerate(zip(x.tolist(), r.tolist()))]}
for title, table in tables.items():
    with open(at("table"), "w") as file:
        file.write("\n".join(table) + "\n")
    told = check(at("table"), *near)[1]
    ok({**told, "inputs": []} == {**check(good, *near)[1], "inputs": []}, title, told["findings"])
# Units that a heading names for all four columns are told, and no others guessed; pack reads the numbers as they stand.
told = {}
for case, heading, scale in (("mm", "X (mm),Y (mm),Z (mm),R (mm)", 1e-3), ("µm", "x [µm];y [µm];z [µm];radius [µm]", 1e-6),
                             ("cm", 'x ( cm ),"y (cm)",z (cm),r (cm)', 1e-2), ("m", "x (m),y (m),z (m),r (m)", 1),
                             ("mixed", "x (mm),y (mm),z (mm),r (um)", 1), ("one", "x (mm),y,z,r", 1)):
    with open(at("table"), "w", encoding="utf-8") as file:
        file.write("\n".join([heading] + [";,"["," in heading].join(repr(v / scale) for v in (*p, a)) for p, a in zip(x.tolist(), r.tolist())]) + "\n")
    named = [f["text"] for f in check(at("table"), *near)[1]["findings"] if f["name"] == "units"]
    warned = call("pack", *sets("method=import"), *near, at("table"), "-o", at("packed"))[2]
    told[case] = [re.findall("heading.*import.scale=([0-9.e-]+)$", text.strip()) for text in (*named, warned)]
    if scale < 1:
        mended = check(at("table"), *near, *sets(f"import.scale={scale:g}"))[1]
        ok("units" not in names(mended) and np.isclose(mended["radius"]["median"], quantiles[2]), f"{case}: right with its scale", mended["findings"])
ok(told == {"mm": [["0.001"], ["0.001"]], "µm": [["1e-06"], ["1e-06"]], "cm": [["0.01"], ["0.01"]], "m": [[]], "mixed": [[]], "one": [[]]},
   "units that a heading names are told", told)
long = b"".join(b"%d 0 0 0.5\n" % k for k in range(20000))
for title, heading in ("with the mark of Windows", b"\xef\xbb\xbf"), ("with names of columns", b"x y z r\n"):
    said = subprocess.run([f"{BIN}/check", "-o", "-"], input=heading + long, capture_output=True).stdout
    ok(said and json.loads(said)["grains"] == 20000, f"all grains of a pipe {title}", said[:99])

# ---- bad ones: what they are called, what pack makes of them, and what mends them ---------

random = np.random.default_rng(1)
gas = x * 1.5
shuffled = np.concatenate([x, x[3:4] + [1e-7, 0, 0]])
with_twin = np.append(r, r[3])
tall = sets("lower=[0,0,0]", f"upper=[{high[0]},{high[1]},{8 * high[2]}]")
small = sets("lower=[0,0,0]", f"upper=[{high[0]},{high[1]},{0.5 * high[2]}]")
BAD = [
    # title, position, radius, settings of pack, findings, status of pack, what mends it
    ("millimetres", 1e3 * x, 1e3 * r, [], ["units"], 0, ["import.scale=1e-3"]),
    ("micrometres", 1e6 * x, 1e6 * r, [], ["units"], 0, ["import.scale=1e-6"]),
    ("nanometres twice", 1e-9 * x, 1e-9 * r, [], ["units"], 0, ["import.scale=1e9"]),
    ("diameters", x, 2 * r, [], ["porosity", "diameters"], 65, ["import.diameters=true"]),
    ("two grains nearly in one place", shuffled, with_twin, [], ["overlaps"], 0, None),
    ("a body squashed flat", x * [1, 1, 0], r, [], ["porosity", "squashed"], 65, None),
    ("duplicates", np.concatenate([x, x[:5]]), np.append(r, r[:5]), [],
     ["coincident", "overlaps"], 65, None),
    ("a box far above the bed", x, r, tall, ["empty"], 0, ["upper=null", "lower=null"]),
    ("a box that leaves grains outside", x, r, small, ["outside", "porosity"], 65,
     ["upper=null", "lower=null"]),
]
for title, position, radius, box, wrong, packed, mends in BAD:
    path = text("bad", position, radius)
    command = ["pack", *sets("method=import"), *near, *box]
    status, _, said = call(*command, path, "-o", at("bad.h5"))
    words = said.splitlines()
    ok(status == packed and len(words) == (1 if packed else len(wrong))
       and all(line.startswith(f"pack: {path}: ") for line in words),
       f"{title}: pack {'refuses' if packed else 'warns'}", (status, said))
    if packed:
        ok(call(*command, *sets("check=warn"), path, "-o", at("bad.h5"))[0] == 0,
           f"{title}: packed all the same where asked for")
    status, report, agree = check(at("bad.h5"), *near)
    ok(status == 1 and names(report) == wrong and agree, f"{title}: check says so",
       (status, report["findings"]))
    ok((report["suggested"] is None) == (report["cost"] is None) == (wrong != ["overlaps"]),
       f"{title}: {'suggestions all the same' if wrong == ['overlaps'] else 'nothing is suggested for it'}",
       report["suggested"])
    told = {f["name"]: f["text"] for f in report["findings"]}
    if "units" in wrong:
        ok(not {"defaults", "weight"} & set(told) and (not mends[0].startswith("import.scale=1e-") or f"pack.{mends[0]}" in told["units"]),
           f"{title}: what to set, and nothing of defaults and weight", told)
    if not box:
        ok(names(check(path, *near)[1]) == wrong, f"{title}: and of the text")
    if mends:
        status, _, said = call(*command, *sets(*mends), path, "-o", at("bad.h5"))
        ok((status, said) == (0, "") and check(at("bad.h5"), *near)[0] == 0,
           f"{title}: {' '.join(mends)} mends it", said)
        with h5py.File(at("bad.h5")) as file:
            ok(np.allclose(file["particles/position"], x, rtol=1e-12, atol=0)
               and np.allclose(file["particles/radius"], r, rtol=1e-12, atol=0),
               f"{title}: to the grains themselves")

# A column in another unit than the others: too small radii are said, too large ones refused at once,
# for each would have all others as neighbours.
with_gas = np.concatenate([x, 20 * gas]), np.append(r, r)
for unit in 1e-3, 1e-6:
    status, report, agree = check(text("bad", x, unit * r))
    told = {f["name"]: f["text"] for f in report["findings"]}
    ok(status == 1 and agree and f"Times {1 / unit:g} they" in told.get("radii", "") and "defaults" not in told,
       f"radii times {unit:g}", report["findings"])
    many = 30 * np.indices((27, 27, 27)).reshape(3, -1).T * np.median(r)
    big = text("big", many, np.full(len(many), 10 * np.median(r) / unit))
    for stage in ("check",), ("pack", *sets("method=import")):
        status, _, said = call(*stage, big)
        ok(status == 65 and len(said.splitlines()) == 1 and f"Times {unit:g} they" in said, f"{stage[0]}: radii times {1 / unit:g}", said)
for title, position, radius in [("grains", x, r), ("diameters", x, 2 * r), ("grains far apart", 30 * x, r),
                                ("some far away", *with_gas)]:
    ok("radii" not in [f["name"] for f in check(text("bad", position, radius))[1]["findings"]], f"{title} are in one unit")

# One grain stands out of the top; docs/your-grains.md leaves it out and lowers the box.
top = text("top", np.vstack([x, [high[0] / 2, high[1] / 2, 2 * high[2]]]), np.append(r, r[0]))
status, report, _ = check(top, *near)
ok(status == 1 and names(report) == ["empty"] and "a few grains stand out" in report["findings"][0]["text"], "a grain above the bed", report["findings"])
call("pack", "-q", *sets("method=import", f"slab.upper={0.9 * high[2]}"), *near, top, "-o", at("slab.h5"))
call("pack", "-q", *sets("method=import", f"upper=[{high[0]},{high[1]},{0.95 * high[2]}]"), *near, at("slab.h5"), "-o", at("lower.h5"))
status, report, _ = check(at("lower.h5"), *near)
ok(status == 0 and report["suggested"], "is left out, and the box lowered", report["findings"])
quiet = call("pack", "-q", *sets("method=import"), text("bad", 1e3 * x, 1e3 * r), "-o",
             at("bad.h5"))
ok(quiet == (0, "", ""), "-q keeps warnings back", quiet)

# ---- numbers, against places and pairs one by one -----------------------------------------

run("pack", "-q", *sets("method=import"), *near, *tall, good, "-o", at("tall.h5"))
box = check(at("tall.h5"))[1]["box"]
places = random.uniform(0, 1, (40000, 3)) * [high[0], high[1], 8 * high[2]]
far = np.ones(len(places), bool)
for p, s in zip(x, r):
    far &= np.linalg.norm(places - p, axis=1) > s + box["far"]
ok(abs(far.mean() - box["empty"]) < 0.02, "the share of the box far from grains",
   (far.mean(), box["empty"]))

loose = text("gas", gas, r)
status, report, _ = check(loose)
ok(status == 1 and "bonds" in names(report), "grains that do not touch have no bonds")
gaps = distance(gas)[first, second] / sums - 1
order = np.argsort(gaps)
piece = np.arange(n)
for k in order:
    a, b = piece[first[k]], piece[second[k]]
    piece[piece == a] = b
    if np.bincount(piece).max() >= np.ceil(0.95 * n):
        break
ok(np.isclose(report["bonds"]["joining_gap"], gaps[k], rtol=1e-9),
   "the gap that joins them to one piece", (report["bonds"], gaps[k]))

# ---- a replay without bonds ---------------------------------------------------------------

run("pack", "-q", *sets("method=import"), loose, "-o", at("loose.h5"))
with h5py.File(at("loose.h5"), "r+") as file:
    file.attrs["schema"] = "craquelure/forces/1"
    file["time"], file["saturation"] = [0.0, 1.0], [1.0, 0.0]
    file["force"] = np.zeros((2, n, 3))
    for name in ("capillary_pressure", "force_scale", "largest_force", "first_period_end_time"):
        file["summary"].attrs[name] = 0.0
few = sets("cycles=10", "time_step_safety=null")
for by, why in [("packing", "the packing lists no bond between its"),
                ("touching", "no two touch of"), ("distance", "no two are within bond.gap of")]:
    status, _, said = call("dem-replay", *few, *sets(f"bond.by={by}"), at("loose.h5"), "-o",
                           at("response.h5"))
    ok(status == 65 and len(said.splitlines()) == 1
       and f"dem-replay.bond.by: {why} {n} grains, so that none can break" in said
       and not os.path.exists(at("response.h5")), f"bonds by {by}: none, and the replay ends", said)
for words, title in [(["bond.by=none"], "contacts alone, as asked for"),
                     (["bridges.volume=1e-18"], "bridges alone"),
                     (["bond.by=distance", f"bond.gap={1.01 * gaps[k]}"], "bonds over the gap")]:
    status, _, said = call("dem-replay", *few, *sets(*words), at("loose.h5"), "-o",
                           at("response.h5"))
    ok(status == 0 and os.path.exists(at("response.h5")), title, said)

# Held grains that nothing is bonded to.
status, _, said = call("dem-replay", *few,
                       *sets("bond.by=distance", f"bond.gap={np.sort(gaps)[20]}",
                             "held.grains=[0]"), at("loose.h5"), "-o", at("response.h5"))
ok(status == 0 and f"of {n} grains to those that are held" in said,
   "that hardly a grain hangs on those held is said", said)

# ---- narrow boxes that repeat -----------------------------------------------------------------

# Two grains may touch across both sides of a box narrower than two diameters.
for width, narrow in (3e-6, True), (4e-6, False):
    row = text("row", np.array([[0.2e-6, 1e-6, 1e-6], [1.3e-6, 1e-6, 1e-6]]), np.array([0.5e-6, 0.5e-6]))
    run("pack", "-q", *sets("method=import", "check=none", "bonds=none", "periodic=[true,false,false]", "lower=[0,0,0]",
                            f"upper=[{0.5 * width},2e-6,2e-6]"), row, "-o", at("row.h5"))
    report = check(at("row.h5"))[1]
    ok(("narrow" in [f["name"] for f in report["findings"]]) == narrow,
       f"a box {0.5 * width:g} m wide {'may hide' if narrow else 'shows'} contacts across both sides", report["findings"])

# ---- places with too few digits ------------------------------------------------------------

for step in 1e-6, 1e-7, 5e-8:
    coarse = np.rint(x / step) * step
    apart = distance(coarse)[first, second] - sums
    lost = ((apart < step) & (apart > 1e-6 * sums)).sum()
    path = text("coarse", coarse, r)
    status, report, agree = check(path)
    told = {f["name"]: f for f in report["findings"]}.get("rounded", {"severity": "", "text": ""})
    ok(agree and told["severity"] == "note" and f"multiples of {step:g} m, and {lost} pairs" in told["text"],
       f"places rounded to {step:g} m", (lost, report["findings"]))
    wide = told["text"].rpartition("pack.")[2]
    status, report, _ = check(path, *sets(wide))
    ok("rounded" not in [f["name"] for f in report["findings"]], f"{wide} bonds all that may touch", report["findings"])
cube = 1e-4 * np.indices((6, 6, 6)).reshape(3, -1).T
for title, position, radius in [("all digits", x, r), ("a lattice of unequal grains", cube, random.uniform(45e-6, 50e-6, 216)),
                                ("a lattice whose grains are apart", cube, np.full(216, 49.9e-6)),
                                ("grains far apart", np.rint(30 * x / 1e-7) * 1e-7, r)]:
    ok("rounded" not in [f["name"] for f in check(text("fine", position, radius))[1]["findings"]], f"{title}: no note")

for scale, named in (1e2, False), (1e4, True), (1e6, False):
    said = {f["name"]: f["text"] for f in check(text("units", scale * x, scale * r))[1]["findings"]}.get("units", "")
    ok(("centimetres (1e-2: " in said) == named, f"grains of {scale * 5e-5:g}: centimetres are named where they make grains", said)

# ---- round bodies --------------------------------------------------------------------------

# Cut out of a lattice wider than they: what their box leaves empty is not a tenth far from grains.
wide = 1e-4 * (np.indices((14, 14, 14)).reshape(3, -1).T - 6.5)
for title, seen, inside in [("a cylinder along x", "x", np.hypot(wide[:, 1], wide[:, 2])),
                            ("a cylinder along z", "z", np.hypot(wide[:, 0], wide[:, 1])),
                            ("a sphere", "sphere", np.linalg.norm(wide, axis=1)), ("a cube", None, np.zeros(len(wide)))]:
    kept = wide[inside < 6.2e-4] + [3, -2, 7]
    path = text("shape", kept, np.full(len(kept), 5e-5))
    status, report, agree = check(path)
    told = {f["name"]: f["text"] for f in report["findings"] if f["severity"] == "wrong"}.get("round", "")
    reach = inside[inside < 6.2e-4].max() + 5e-5
    ok(agree and (f"end at a {'sphere' if seen == 'sphere' else f'cylinder along {seen}'}" in told if seen else not told),
       f"{title} in a box of flat walls", report["findings"])
    ok(("exchange x and z" in told) == (seen == "x"), "which stands along z")
    if seen in ("z", "sphere"):
        words = ["pack.method=import", *told[told.index("pack.domain"):].split()]
        run("pack", "-q", *sets(*(w[5:] for w in words)), path, "-o", at("shaped"))
        with h5py.File(at("shaped")) as file:
            size = (file["domain/upper"][0] - file["domain/lower"][0]) / 2
        ok(abs(size / reach - 1) < 1e-5 and "round" not in names(check(at("shaped"))[1]), "what it names makes the body", size)

# In a cylinder a body stands on pi/4 of the floor of its box.
pillar = text("pillar", wide[np.hypot(wide[:, 0], wide[:, 1]) < 6.2e-4], np.full((np.hypot(wide[:, 0], wide[:, 1]) < 6.2e-4).sum(), 5e-5))
heavy = []
for shape in ["lower=[-7e-4,-7e-4,-7e-4]", "upper=[7e-4,7e-4,7e-4]"], ["domain.shape=cylinder", "domain.radius=7e-4", "domain.height=14e-4"]:
    run("pack", "-q", *sets("method=import", "check=none", *shape), pillar, "-o", at("pillar.h5"))
    heavy.append(check(at("pillar.h5"))[1]["weight"])
ok(abs(heavy[1]["body"] / heavy[0]["body"] * np.pi / 4 - 1) < 1e-9 and heavy[0]["grain"] == heavy[1]["grain"],
   "a cylinder weighs on its own area", heavy)

# ---- weight -------------------------------------------------------------------------------

# Beads of a millimetre that settled, given in millimetres: the whole chain says what they weigh.
beads = ["count=300", "radius=5e-4", "method=deposition", "lower=[0,0,0]",
         "upper=[6.3e-3,6.3e-3,2.5e-2]"]
made = run("pack", "-q", *sets(*beads))
open(at("beads.h5"), "wb").write(made)
with h5py.File(at("beads.h5")) as file:
    beads_mm = text("beads-mm", 1e3 * file["particles/position"][:], 1e3 * file["particles/radius"][:])
for stage, words in [("tessellate", []), ("merge-nodes", []), ("dry", ["step_interval=0.1"]),
                     ("force-protocol", ["force_scale=1"])]:
    made = run(stage, "-q", *sets(*words), input=made)
made = run("dem-replay", "-q", *sets("cycles=1", "most_cycles=1", "ramp=0"), input=made)
open(at("beads-response.h5"), "wb").write(made)
with h5py.File(at("beads-response.h5")) as file:
    measured = file["summary"].attrs["bond_number_grain"], file["summary"].attrs["bond_number_body"]
status, report, _ = check(beads_mm, "--set", "import.scale=1e-3")
expected = report["weight"]["grain"], report["weight"]["body"]
# The chain's box is higher than the grains, which changes neither number.
ok("weight" in [f["name"] for f in report["findings"]] and all(0.5 < e / m < 2 for e, m in zip(expected, measured)),
   "the weight to expect, beside what the whole chain measures", (expected, measured))
# A column five times as high weighs five times as much: the note says so, and what its bonds need.
tall = np.concatenate([[[0, 0, k * np.ptp(np.loadtxt(beads_mm)[:, 2])]] * 300 for k in range(5)])
tall = text("beads-tall", np.tile(np.loadtxt(beads_mm)[:, :3], (5, 1)) + 1.1 * tall, np.tile(np.loadtxt(beads_mm)[:, 3], 5))
heavy = check(tall, "--set", "import.scale=1e-3")[1]
said = {name: {f["name"]: f["text"] for f in found["findings"]}["weight"] for name, found in (("low", report), ("tall", heavy))}
ok("gravity=9.81 in dry" in said["low"] and "strengths" not in said["low"] and 4 * expected[1] < 1
   and f"up to {4 * heavy['weight']['body']:.2g} times the strengths suggested" in said["tall"],
   "a body that is heavy needs stronger bonds than suggested", said)
twice = text("beads-twice", 1e3 * h5py.File(at("beads.h5"))["particles/position"][:],
             2e3 * h5py.File(at("beads.h5"))["particles/radius"][:])
ok(check(twice, "--set", "import.scale=1e-3", "--set", "import.diameters=true")[1]["radius"]
   == report["radius"], "diameters for radii")
gravel = {f["name"]: f["text"] for f in check(beads_mm, "--set", "import.scale=1e-2")[1]["findings"]}
ok("units" not in gravel and "millimetres (import.scale=1e-3)?" in gravel["weight"],
   "grains too heavy for the liquid, though below the limit: perhaps millimetres", gravel)
ethanol = check(beads_mm, "--set", "import.scale=1e-3", "--set", "fluid=ethanol")[1]
ok(2 < ethanol["weight"]["grain"] / report["weight"]["grain"] < 4,
   "ethanol pulls a third as hard as water", (ethanol["weight"], report["weight"]))
status, _, said = call("check", "--set", "fluid=other", beads_mm)
ok(status == 65 and "check.surface_tension" in said, "another liquid has to say how it pulls", said)
# A scene says to pack what its grains are in: check takes it from there, for what pack reads, not for what it wrote.
with open(at("beads.json"), "w") as file:
    json.dump({"pack": {"method": "import", "import": {"scale": 1e-3, "diameters": True}, "touching_gap": 0.05}}, file)
by_hand = check(beads_mm, *sets("import.scale=1e-3", "import.diameters=true", "touching_gap=0.05"))[1]
by_scene = check(beads_mm, "-p", at("beads.json"))[1]
ok(by_scene == by_hand and by_hand["radius"]["median"] < 1e-3, "a scene says units, diameters and gap to pack and check",
   (by_scene["radius"], by_hand["radius"]))
own = check(beads_mm, "-p", at("beads.json"), *sets("import.diameters=false", "touching_gap=1e-6"))[1]
ok({**own, "parameters": 0} == {**report, "parameters": 0}, "--set is stronger", own["contacts"])
run("pack", "-q", "-p", at("beads.json"), beads_mm, "-o", at("beads-packed"))
packed = check(at("beads-packed"), "-p", at("beads.json"))[1]
ok(packed["radius"] == by_hand["radius"] and packed["contacts"] == by_hand["contacts"] and packed == check(
    at("beads-packed"), *sets("touching_gap=0.05"))[1], "what pack wrote is in metres already", packed["radius"])
for says, noted in [({}, {"support", "defaults"}), ({"held": {"upper": [1, 1, 1e-3]}}, {"defaults"}), ({"support": "free"}, {"defaults"}),
                    ({"normal_stiffness": 1e5}, {"support"})]:
    with open(at("replay.json"), "w") as file:
        json.dump({"dem-replay": says}, file)
    found = {f["name"] for f in check(beads_mm, "-p", at("replay.json"), *sets("import.scale=1e-3"))[1]["findings"]}
    ok(found & {"support", "defaults"} == noted, f"dem-replay says {says}: nothing else is noted as lacking", found)
with open(at("beads.json"), "w") as file:
    json.dump({"pack": {"import": {"scale": -1}}}, file)
status, _, said = call("check", "-p", at("beads.json"), beads_mm)
ok(status == 65 and said == f"check: {at('beads.json')}: pack.import.scale: must be > 0 m, got -1\n", "in the words of pack", said)
ok(call("check", "--set", "pack.import.scale=1e-3", beads_mm) == (64, "", "check: --set pack.import.scale=1e-3: must go "
   "without the section, import.scale=1e-3\n"), "keys of pack that check has, too, go without the section")

# ---- floors cut from a thicker packing ------------------------------------------------------

# What a box that ends on the outermost surfaces gains in void is told, and what check advises takes it away.
bed = sets("method=soft_spheres", "radius=5e-7", "sizes.distribution=uniform", "sizes.smallest=3e-7", "sizes.largest=7e-7",
           "target=porosity", "target_value=0.4", "upper=[8e-6,8e-6,1.2e-5]")
cut = sets("slab.lower=2e-6", "slab.upper=1e-5")
status, _, said = call("pack", *bed, *sets("periodic=[true,true,true]"), *cut, "-o", at("cut.h5"))
with h5py.File(at("cut.h5")) as file:
    solid = (4 / 3 * np.pi * file["particles/radius"][:] ** 3).sum()
    height = np.ptp([file["domain/lower"][2], file["domain/upper"][2]])
here, between = 1 - solid / (64e-12 * height), 1 - solid / (64e-12 * 8e-6)
ok(status == 0 and len(said.splitlines()) == 1 and f"porosity is {here:.3g}, {between:.3g} between" in said, "pack tells the void of a slab", said)
ok(call("pack", "-q", *bed, *sets("periodic=[true,true,true]"), *cut, "-o", at("cut.h5"))[2] == "", "but not with -q")
status, report, agree = check(at("cut.h5"))
told = {f["name"]: f for f in report["findings"]}.get("rough", {"severity": "", "text": ""})
stated = re.search("porosity is ([0-9.]+), ([0-9.]+) between", told["text"])
ok(status == 0 and agree and told["severity"] == "note" and stated and stated[1] == f"{here:.3g}"
   and abs(float(stated[2]) - between) < 0.02, "and check", told)
call("pack", "-q", *sets(*re.findall(r"pack\.(\S+=\S+)", told["text"])), at("cut.h5"), "-o", at("even.h5"))
status, even, _ = check(at("even.h5"))
ok(status == 0 and abs(even["box"]["porosity"] - float((stated or [0] * 3)[2])) < 6e-4 and "rough" not in [f["name"] for f in even["findings"]],
   "whose box has the porosity within", even["box"])
for title, words in (("repeats", ["periodic=[true,true,true]"]), ("has flat walls", [])):
    _, _, said = call("pack", *bed, *sets(*words), "-o", at("uncut.h5"))
    ok(said == "" and "rough" not in [f["name"] for f in check(at("uncut.h5"))[1]["findings"]], f"nothing where the box {title}", said)
_, _, said = call("pack", *sets("counts=[4,4,8]", "slab.lower=1e-6"), "-o", at("even.h5"))
ok("pack.slab" not in said and "rough" not in [f["name"] for f in check(at("even.h5"))[1]["findings"]], "nor of a lattice", said)

# ---- input without end --------------------------------------------------------------------

for words in (["pack", "-q", "--set", "method=import", "-o", at("endless.h5")], ["check"]):
    endless = subprocess.Popen(["yes"], stdout=subprocess.PIPE)
    ended = subprocess.run([f"{BIN}/{words[0]}", *words[1:]], stdin=endless.stdout,
                           capture_output=True, text=True, timeout=20)
    endless.kill()
    ok(ended.returncode == 65 and "line 1: must be four numbers" in ended.stderr,
       f"{words[0]} of text without end, and without grains", ended.stderr)

# Below an extra layer: the same facts as without it, in its box; rows are those of the input.
run("pack", "-q", *sets("counts=[6,6,6]"), "-o", at("bare"))
run("pack", "-q", *sets("counts=[6,6,6]", "extra_layer=true", "extra_side=+x"), "-o", at("layered"))
with h5py.File(at("layered"), "r+") as file:  # the layer first, and bonds to it
    for name in "position", "radius", "kind":
        file[f"particles/{name}"][...] = np.roll(file[f"particles/{name}"][:], 36, axis=0)
    bonds = np.vstack([[[0, 36]], file["bonds/particles"][:] + 36])
    del file["bonds/particles"]
    file["bonds/particles"] = bonds.astype("<i4")
facts = lambda report: {k: v for k, v in report.items() if k not in ("inputs", "sha256")}
bare, layered = check(at("bare")), check(at("layered"))
ok(facts(layered[1]) == facts(bare[1]) and layered[2] and bare[1]["box"]["upper"] != [0, 0, 0],
   "an extra layer does not count", (layered[1]["box"], bare[1]["box"], layered[1]["bonds"]))
with h5py.File(at("layered"), "r+") as file:
    file["particles/position"][40] = file["particles/position"][41]
_, report, _ = check(at("layered"))
ok("row 41: has the same centre as row 40 (1 such pair)" in report["findings"][0]["text"],
   "rows are those of the input", report["findings"])
# A dump that names its units has its lengths in those, whatever would be plausible.
rows = "".join(f"{i + 1} {a:.9g} {b:.9g} {c:.9g} {d:.9g}\n" for i, ((a, b, c), d) in enumerate(zip(x / 1e-2, r / 1e-2)))
sides = "".join(f"{a / 1e-2:.9g} {b / 1e-2:.9g}\n" for a, b in zip(low, high))
frame = f"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{n}\nITEM: BOX BOUNDS ff ff ff\n{sides}ITEM: ATOMS id x y z radius\n{rows}"
told = {}
for units in ("cgs", "micro", "si", "lj", ""):
    with open(at("dump"), "w", encoding="utf-8") as file:
        file.write((f"ITEM: UNITS\n{units}\n" if units else "") + frame)
    report = check(at("dump"), *near)[1]
    warned = call("pack", *sets("method=import"), at("dump"), "-o", at("from-dump"))[2]
    told[units] = [re.findall("import.scale=([0-9.e-]+)", f["text"]) for f in report["findings"] if f["name"] == "units"] \
        + re.findall("UNITS.*import.scale=([0-9.e-]+)", warned)
ok(told == {"cgs": [["0.01"], "0.01"], "micro": [["1e-06"], "1e-06"], "si": [], "lj": [], "": []}, "units that a dump names are told", told)
with open(at("dump"), "w", encoding="utf-8") as file:
    file.write("ITEM: UNITS\ncgs\n" + frame)
status, report, agree = check(at("dump"), *near, "-s", "import.scale=0.01")
ok(agree and "units" not in names(report) and np.isclose(report["radius"]["median"], np.sort(r)[n // 2]), "and are right with their scale", report)
with open(at("dump"), "w", encoding="utf-8") as file:
    file.write(frame + frame.replace(f"ATOMS\n{n}\n", "ATOMS\n1\n").replace(rows, rows[:rows.index("\n") + 1]))
counts = []
for first in 0, 1, -1:
    with open(at("frames.json"), "w", encoding="utf-8") as file:
        json.dump({"pack": {"frame": first, "import": {"scale": 0.01}}}, file)
    counts.append(check(at("dump"), "-p", at("frames.json"))[1]["grains"])
ok(counts == [n, 1, 1], "the frame that a scene says", counts)

done()
