#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of a run: the same bytes for the same input, no markup from names, mixed runs refused;
and in a headless Chromium, what it draws is what a search of the artifacts finds at the same point
and moment, the slider, keys, pick, cut and fallback work, and nothing leaves the page."""
import base64
import glob
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
import time
import zlib

import h5py
import numpy as np

sys.path.insert(0, "tests")
from browser import MISSING, Browser
from tap import BIN, SCENE, done, ok, read, run, scratch

folder = scratch()
at = lambda name: os.path.join(folder.name, name)


def report(*words):
    ended = subprocess.run([f"{BIN}/report", *words], capture_output=True, timeout=60)
    return ended.returncode, ended.stdout, ended.stderr.decode()


# ---- a run: 3 x 4 x 5 grains, pulled hard enough to break ---------------------------------

with open(SCENE) as file:
    scene = json.load(file)
scene["pack"]["counts"] = [3, 4, 5]
scene["force-protocol"].update(steps=40, force_scale=2)
scene["dem-replay"]["cycles"] = 200
with open(at("scene.json"), "w") as file:
    json.dump(scene, file)
for stage, source, name in [("pack", "", "packing"), ("tessellate", "packing", "tessellation"),
                            ("merge-nodes", "tessellation", "network"), ("dry", "network", "drying"),
                            ("force-protocol", "drying", "forces"), ("dem-replay", "forces", "response")]:
    run(stage, "-q", "-p", at("scene.json"), *([at(source + ".h5")] if source else []), "-o", at(name + ".h5"))
run("crackstats", "-p", at("scene.json"), at("response.h5"), at("drying.h5"), "-o", at("crackstats.json"))
page = run("report", folder.name, "-o", "-")
with open(at("run.html"), "wb") as file:
    file.write(page)
text = page.decode()

# ---- the bytes ----------------------------------------------------------------------------

NAMES = ["packing.h5", "tessellation.h5", "network.h5", "drying.h5", "forces.h5", "response.h5", "crackstats.json"]
ok(run("report", "--threads", "3", *map(at, NAMES)) == page, "a folder and its artifacts by name give the same bytes")
os.makedirs(at("elsewhere"))
for name in NAMES:
    shutil.copy(at(name), at("elsewhere"))
ok(run("report", at("elsewhere")) == page, "wherever they lie")
policy_of = lambda of: re.search(r"script-src ('[^']*'); style-src ('[^']*')", of).groups()
stale = [path for path in glob.glob("docs/pages/*.html") if policy_of(read(path).decode()) != policy_of(text)]
ok(not stale, "the pages of the docs have its scripts and style (docs/gallery.md has the commands)", stale)
ok(len(page) < 150e3, "a small run is a small page", len(page))
with h5py.File(at("packing.h5")) as file, h5py.File(at("forces.h5")) as forces:
    radii, suction = file["particles/radius"][:], forces["summary"].attrs["capillary_pressure"]
said = dict(re.findall(r"<dt>([^<]*)</dt><dd>([^<]*)", text))
ok(said["Grains"].startswith(f"{len(radii)}, {2e9 * radii[0]:.3g} nm in diameter") and
   said["Suction"].strip() == f"{suction / 1e6:.3g} MPa in a throat of mean radius", "sizes are named diameters, and whose suction it is", said)
os.makedirs(at("shrunk"))
run("dem-replay", "-q", "--set", "shrinkage.strain=0.01", "--set", "shrinkage.steps=5", "--set", "cycles=20", at("packing.h5"), "-o", at("shrunk/response.h5"))
notice = "a second stands for a step of the load"
ok(notice in run("report", at("shrunk")).decode() and notice not in text, "times that are steps are said to be so")
ok("drawn full to the end" in run("report", at("shrunk/response.h5"), at("packing.h5"), at("tessellation.h5"), at("network.h5")).decode() and
   "drawn full to the end" not in text, "and throats that nothing empties")
with h5py.File(at("response.h5")) as file:
    modes, breaks, bonds = file["cracks/mode"][:], file["cracks/time"][:], file["bonds/particles"][:]
    crack_bonds, crack_saturation = file["cracks/bond"][:], file["cracks/saturation"][:]
first = bonds[crack_bonds[0]]
ok(len(modes) > 3 and len(set(modes)) == 2, "the run breaks bonds in both modes", np.bincount(modes))
ok(f"{len(modes)} of {len(bonds)} bonds broke" in text, "the first sentence counts them")
ok(f"between grains {first[0]} and {first[1]}" in text, "where the first one is")
shutil.copy(at("response.h5"), at("around.h5"))
with h5py.File(at("around.h5"), "r+") as file:
    file["domain/periodic"][:] = [True, True, False]
    low, high = file["domain/lower"][:], file["domain/upper"][:]
    file["cracks/position"][0] = low + np.array([1.15, -0.25, 0.5]) * (high - low)
ok("at 50 % of the height of the box (z), 15 % along x and 75 % along y" in run("report", at("around.h5")).decode(),
   "and beyond a side that repeats where its image is")
with h5py.File(at("forces.h5")) as file:
    strength = np.linalg.norm(file["force"][:], axis=2)
heaviest = int(re.search(r"grain (\d+): the liquid pulls it", text)[1])
ok(np.isclose(strength[:, heaviest].max(), strength.max(), rtol=1e-12, atol=0), "which grain carries most")
with h5py.File(at("drying.h5")) as file:
    half = np.argmax(file["history/rate"][:] <= file["history/rate"][0] / 2)
    ok(f"at saturation {file['history/saturation'][half]:.3g} ("
       in text, "at which saturation the rate is half its first")
ok("<b>dry</b>: gravity, Knudsen effect" in text, "what was left out")


def arrays_of(text):
    """What the page says of its numbers, and these, read without its script."""
    meta = json.loads(re.search(r'id="meta">(.*?)</script>', text, re.S)[1])
    data = zlib.decompress(base64.b64decode(re.search(r'id="data">(.*?)</script>', text, re.S)[1]))
    arrays, begin = {}, 0
    for entry in meta["arrays"]:
        n = entry["count"]
        planes = np.frombuffer(data, "u1", n * entry["planes"], begin).reshape(entry["planes"], n)
        arrays[entry["name"]] = sum(plane.astype("u4") << np.uint32(8 * k) for k, plane in enumerate(planes))
        begin += planes.size
    return meta, arrays


def places_of(text):
    """Centres and radii of grains as the page has them, m."""
    meta, arrays = arrays_of(text)
    step, origin = meta["scales"]["step"], np.array(meta["scales"]["origin"])
    return origin + step * np.array([arrays[f"grain.{x}"] for x in "xyz"]).T, step * arrays["grain.radius"]


with h5py.File(at("packing.h5")) as file:
    position, radius = file["particles/position"][:], file["particles/radius"][:]
shown, shown_radius = places_of(text)
error = max(np.abs(shown - position).max(), np.abs(shown_radius - radius).max()) / radius.min()
ok(error < 1e-3, "places are within a thousandth of a grain", error)

# ---- a replay that goes on from another, with weight ---------------------------------------

shutil.copy(at("response.h5"), at("goes-on.h5"))
with h5py.File(at("goes-on.h5"), "r+") as file:
    whole = np.setdiff1d(np.arange(len(file["bonds/particles"])), file["cracks/bond"])
    before = {"earlier_cracks": (whole[[3, 9, 20]], [0, 1, 1]), "weight_cracks": (whole[[5]], [0])}
    for group, (bond, mode) in before.items():
        file[f"{group}/bond"], file[f"{group}/mode"] = bond.astype("<i4"), np.array(mode, "u1")
    of_contact = {tuple(pair): k for k, pair in enumerate(file["contacts/particles"][:])}
    contact = [of_contact[tuple(pair)] for pair in file["bonds/particles"][:]]
    last = len(file["snapshots/time"]) - 1
run("inspect", "--vtk", at("goes-on"), at("goes-on.h5"))
with open(at("goes-on.html"), "wb") as file:
    file.write(run("report", at("goes-on.h5"), "-o", "-"))
goes_on = read(at("goes-on.html")).decode()
meta, arrays = arrays_of(goes_on)
key = arrays["bond.breaks"]
for frame, now in (0, key == 0), (last, key < 65535):
    drawn = np.array(re.search(r'Name="crack".*?>\n(.*?)</', read(at(f"goes-on-{frame:04}.vtu")).decode(), re.S)[1].split(), float)
    ok(np.array_equal(np.where(now, 1 + arrays["bond.mode"], 0), drawn[contact]),
       f"bonds that had broken before are drawn as inspect draws them, frame {frame}")
ok(np.array_equal(np.flatnonzero(arrays.get("bond.earlier", [])), np.sort(np.concatenate([bond for bond, _ in before.values()])))
   and "4 bonds, in replays that this one goes on from or under the weight" in goes_on, "and said to be no cracks of this replay")
ok("bond.earlier" not in arrays_of(text)[1] and "Broken before" not in text, "where there are none nothing is said of them")

# ---- what it refuses ----------------------------------------------------------------------

run("dry", "-q", "-p", at("scene.json"), "--set", "throat_radius.seed=7", at("network.h5"), "-o", at("other.h5"))
os.makedirs(at("empty"))
for title, words, status, said in [
        ("a drying of another run", [at("other.h5"), at("forces.h5")], 65, "was not made from .*other.h5"),
        ("two dryings", [at("drying.h5"), at("other.h5")], 64, "is a second drying"),
        ("a folder without a run", [at("empty")], 66, "holds no artifact of a run"),
        ("nothing there", [at("nowhere")], 66, "No such file"),
        ("a scene", [at("scene.json")], 65, "is not an artifact")]:
    ended, _, error = report(*words)
    ok(ended == status and re.search(said, error) and error.count("\n") == 1, f"{title} is refused", (ended, error))

# ---- names that are not what they seem ----------------------------------------------------

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'><!-- {{data}} ]]>"


class Tags(html.parser.HTMLParser):
    """How often each element begins."""

    def __init__(self, text):
        super().__init__()
        self.count = {}
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.count[tag] = self.count.get(tag, 0) + 1


os.makedirs(at("hostile"))
for name in NAMES:
    shutil.copy(at(name), at("hostile"))
for name in ["packing", "tessellation", "network", "drying", "forces", "response"]:
    with h5py.File(at(f"hostile/{name}.h5"), "r+") as file:
        file.attrs["program"] = HOSTILE
        file.attrs["model"] = "left out: " + HOSTILE + "\n" + HOSTILE
        file.attrs["parameters"] = json.dumps({HOSTILE: HOSTILE})
        file.attrs["inputs"] = "[]"
counted = json.loads(read(at("crackstats.json")))
counted["program"] = HOSTILE
with open(at("hostile/crackstats.json"), "w") as file:
    json.dump(counted, file)
hostile = run("report", "--set", "title=" + json.dumps(HOSTILE), at("hostile")).decode()
with open(at("hostile.html"), "w") as file:
    file.write(hostile)
before, after = Tags(text).count, Tags(hostile).count
ok({**before, "li": 0, "b": 0} == {**after, "li": 0, "b": 0}, "hostile texts add no elements", (before, after))
ok("&lt;/script&gt;" in hostile and HOSTILE not in hostile, "they stand there as text")

# ---- in a browser -------------------------------------------------------------------------

if MISSING:
    ok(True, f"the page in a browser # SKIP {MISSING}")
    done()


def grains_seen():
    """Centres of the grains to the right, up and near, and the radii that are shown."""
    view = browser.evaluate("({turn: viewOf(page, 1, 1).turn, grow: viewOf(page, 1, 1).grow,"
                            " unit: page.body.unit, middle: page.body.middle})")
    turn = np.array(view["turn"]).reshape(3, 3)
    eye = (position - view["middle"]) @ turn.T / view["unit"]
    return eye, radius * view["grow"] / view["unit"]


def agree_on_picks(title):
    """Points of the picture, whose grain a search over all grains finds as well."""
    eye, size = grains_seen()
    frame = browser.evaluate("viewOf(page, page.canvas.width, page.canvas.height).frame")
    wide, high = browser.evaluate("[page.canvas.width, page.canvas.height]")
    clip = browser.evaluate("viewOf(page, 1, 1).clip")
    view = browser.evaluate("({unit: page.body.unit, middle: page.body.middle})")
    kept = ((position - view["middle"]) / view["unit"]) @ np.array(clip[:3]) <= clip[3]
    random, points, fronts = np.random.default_rng(3), [], []
    for px, py in random.integers([0, 0], [wide, high], (150, 2)).tolist():
        x, y = frame[0] - frame[2] + 2 * frame[2] * (px + 0.5) / wide, frame[1] - frame[3] + 2 * frame[3] * (py + 0.5) / high
        far = np.hypot(eye[:, 0] - x, eye[:, 1] - y)
        if np.any(np.abs(far - size) < 3 * frame[2] / wide):  # at a rim either is right
            continue
        over = np.flatnonzero((far < size) & kept)
        points.append((px, py))
        fronts.append(int(over[np.argmax(eye[over, 2] + np.sqrt(size[over] ** 2 - far[over] ** 2))]) if len(over) else None)
    found = browser.evaluate(f"(() => {{ const view = viewOf(page, {wide}, {high}); return {json.dumps(points)}.map(([x, y]) => {{"
                             " const found = pickAt(page.scene, view, x, y); return found ? found.index : null; }); })()")
    wrong = [each for each in zip(points, found, fronts) if each[1] != each[2]]
    hits = len(fronts) - fronts.count(None)
    ok(not wrong and hits > 10 and len(points) > hits, f"{title}: what is drawn at {len(points)} points", wrong)


browser = Browser()
browser.open(at("run.html"))
ok(browser.evaluate("page.scene !== null"), "WebGL draws it")
only = lambda *names: browser.evaluate(
    "for (const box of element('shown').querySelectorAll('input')) box.checked = %s.includes(box.name);"
    " page.stale = true; draw(page)" % json.dumps(names))
only("grains")
agree_on_picks("grains")
browser.evaluate("element('size').value = 100; page.stale = true; draw(page)")
agree_on_picks("grains of full size")
browser.evaluate("element('clip-axis').value = 0; element('clip').value = 600; page.stale = true; draw(page)")
agree_on_picks("a cut")
browser.evaluate("element('clip-axis').value = -1; page.camera.yaw += 1; page.camera.pitch = -0.3; draw(page)")
agree_on_picks("from elsewhere")

# what a large body leaves out of the picture
SEEN = """(async () => { const { gl } = page.scene, { width, height } = page.canvas, view = viewOf(page, width, height), shots = [];
    const seen = seenOf(page.body, view, width, height);
    for (const shown of [allOf(page.body), seen]) {
      page.seen = shown; putBody(page.scene, shown); page.tinted = null; updateMoment(page, view); drawScene(page.scene, view);
      const shot = new Uint8Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, shot);
      shots.push(shot);
    }
    let differ = 0;
    for (let k = 0; k < shots[0].length; k += 4) differ += [0, 1, 2].some((c) => shots[0][k + c] !== shots[1][k + c]);
    page.stale = true;
    return [seen.grains.all.length, seen.throats.all.length, seen.throats.bold, differ / width / height]; })()"""
only("grains", "liquid", "empty")
browser.evaluate("page.course.set(page.course.last / 3)")
grains_drawn, throats_drawn, bold, differ = browser.evaluate(SEEN)
ok(grains_drawn < len(radius) and throats_drawn < browser.evaluate("page.body.throat.n") and differ < 2e-3,  # slivers between the fifteen points of a throat
   "without what grains hide the picture is the same, but for slivers of throats", (grains_drawn, throats_drawn, differ))
few = browser.evaluate("(() => { MOVING.throats = 50; const { throats: { all, bold } } = seenOf(page.body, viewOf(page, 300, 300), 300, 300);"
                       " const ends = all.map((t) => page.body.throat.ends[t]), falls = (list) => list.every((e, k) => !k || list[k - 1] >= e);"
                       " return [bold, new Set(all).size === all.length, falls(ends.slice(0, bold)) && falls(ends.slice(bold))]; })()")
ok(0 < few[0] <= 50 and few[1:] == [True, True], "of these the boldest come first, and those that empty last before others", few)

LISTS = """(() => { ALWAYS_ALL.things = 0; page.lateFrames = 9; const made = [];
    for (const [yaw, moving] of [[0, true], [0.02, true], [0.04, true], [0.02, false]]) {
      const before = page.seen;
      page.camera.yaw += yaw; page.moving = moving; page.stale = true; draw(page); made.push(page.seen !== before);
    }
    ALWAYS_ALL.things = 20000; page.lateFrames = 0; page.stale = true; draw(page);
    return made; })()"""
browser.evaluate("page.moving = false; page.stale = true; draw(page)")
renewed = browser.evaluate(LISTS)
ok(renewed == [True, False, True, True], "while a body turns, what can be seen is found anew every three degrees, and at rest always", renewed)

# the moment: liquid and cracks against a replay of the drying
with h5py.File(at("drying.h5")) as file:
    times, offset = file["history/time"][:], file["changes/offset"][:]
    throat, now_holds = file["changes/throat"][:], file["changes/saturation"][:]
    kinds = file["throats/kind"][:]
    saturation = file["history/saturation"][:]
for share in [0.1, 0.5, 0.9]:
    browser.evaluate(f"page.course.set({share} * page.course.last)")
    moment = browser.evaluate("page.course.at(page.course.time, page.course.key)")
    holds = (kinds == 0).astype(float)
    last = np.searchsorted(times, moment * (1 + 1e-6), "right") - 1
    holds[throat[:offset[last + 1]]] = now_holds[:offset[last + 1]]
    wet = browser.evaluate("Array.from(page.body.throat.id).filter((_, k) => page.body.throat.ends[k] > page.course.key)")
    differ = set(wet) ^ set(np.flatnonzero(holds > 0).tolist())
    at_once = set(throat[offset[max(last - 1, 0)]:offset[min(last + 3, len(offset) - 1)]].tolist())
    ok(differ <= at_once, f"the wet throats at {share} of the slider", differ - at_once)
    broken = [int((breaks[modes == m] <= moment * (1 + 1e-6)).sum()) for m in (0, 1)]
    said = browser.evaluate("element('now').textContent")
    ok(said.endswith(f"broken: {broken[0]} in tension, {broken[1]} in shear"), "and the cracks", (said, broken))
    ok(abs(float(re.search(r"saturation ([\d.]+)", said)[1]) - np.interp(moment, times, saturation)) < 2e-3, "and the saturation", said)

# a crack under the pointer
only("cracks")
browser.evaluate("page.course.set(page.course.last)")
browser.evaluate("draw(page)")
spot = browser.evaluate("""(() => { const v = viewOf(page, page.canvas.width, page.canvas.height);
    const front = page.cracks.map((c, k) => [k, applyTurn(v.turn, ...c.at)]).sort((a, b) => b[1][2] - a[1][2])[0];
    const box = page.canvas.getBoundingClientRect();
    return [front[0], box.left + box.width * (1 + (front[1][0] - v.frame[0]) / v.frame[2]) / 2,
            box.top + box.height * (1 - (front[1][1] - v.frame[1]) / v.frame[3]) / 2]; })()""")
browser.click(spot[1], spot[2])
picked = browser.evaluate("element('picked').textContent")
bond = browser.evaluate(f"page.cracks[{spot[0]}].bond")
ok(f"Bond {bond}" in picked and f"grains{bonds[bond][0]} and {bonds[bond][1]}" in picked, "a click shows the bond under it", picked)
command = re.search(r"craquelure (inspect .*) \| jq '(.*)'", picked)
printed = subprocess.run(["jq", "-c", command[2]], input=run(*command[1].replace("response.h5", at("response.h5")).replace(
    "packing.h5", at("packing.h5")).split()), stdout=subprocess.PIPE, check=True).stdout
ok(json.loads(printed) == bonds[bond].tolist(), "and the command that prints it", (command[0], printed))

# slider, keys, play, curves
browser.evaluate("page.course.set(0); element('moment').focus()")
browser.call("Input.dispatchKeyEvent", type="keyDown", key="End", code="End", windowsVirtualKeyCode=35)
ok(browser.evaluate("page.course.key === page.course.last"), "End on the slider leads to the end")
browser.evaluate("page.course.set(0); document.activeElement.blur()")
browser.key(".")
ok(browser.evaluate("page.course.key > 0"), "a full stop steps")
browser.key(" ")
time.sleep(0.5)
browser.key(" ")
ok(browser.evaluate("page.course.key > page.course.last / 100 && !page.course.playing"), "Space plays and stops")
browser.evaluate("element('view').focus()")
yaw = browser.evaluate("page.camera.yaw")
browser.key("ArrowLeft")
ok(browser.evaluate("page.camera.yaw") != yaw, "arrows turn the body")
browser.key("z")
ok(browser.evaluate("Math.abs(page.camera.pitch - Math.PI / 2) < 1e-9"), "z looks down")
for along in ["saturation", "time"]:
    browser.evaluate(f"element('along').value = '{along}'; element('along').dispatchEvent(new Event('change'))")
    box = browser.evaluate("(() => { const c = document.querySelector('.chart'); c.scrollIntoView({block: 'center'});"
                           " const b = c.getBoundingClientRect(); return [b.left, b.top, b.width, b.height] })()")
    browser.click(box[0] + box[2] * (62 + 0.25 * (480 - 76)) / 480, box[1] + box[3] / 2)
    value = browser.evaluate(f"page.course.at(page.course.{along}, page.course.key)")
    wanted = 0.75 * saturation.max() if along == "saturation" else 0.25 * times[-1]
    ok(abs(value - wanted) < 0.02 * max(wanted, value), f"a click on a curve along {along} sets the moment", (value, wanted))
browser.evaluate("element('along').value = 'time'; element('along').dispatchEvent(new Event('change'));"
                 "document.querySelector('#curves details').open = true")
time.sleep(0.2)
table = [line.split("\t") for line in browser.evaluate("document.querySelector('#curves textarea').value").splitlines()]
ok(table[0][0] == "time (s)" and [int(v) for v in table[-1][1:]] == np.bincount(modes, minlength=2).tolist(),
   "a curve gives its numbers", (table[0], table[-1]))

# ---- nothing leaves the page --------------------------------------------------------------

ok(not browser.errors, "no error and no warning on the console", browser.errors)
ok([u for u in browser.requests if not u.startswith(("file:", "blob:"))] == [] and len(browser.requests) < 3,
   "no request leaves the page", browser.requests)
blocked = browser.evaluate("""(async () => { const s = document.createElement('script'); s.textContent = 'window.got = 1';
    document.body.append(s); const i = new Image(); i.src = 'http://127.0.0.1:9/x.png';
    const f = await fetch('http://127.0.0.1:9/').then(() => 'went', () => 'stopped');
    const e = (() => { try { return eval('1') } catch (e) { return 'stopped' } })();
    return [window.got || 'stopped', f, e]; })()""")
ok(blocked[:2] == ["stopped", "stopped"], "the policy stops scripts and requests that were not there", blocked)

# ---- for everyone -------------------------------------------------------------------------

LUMINANCE = """const lum = (c) => { const [r, g, b] = c.match(/[\\d.]+/g).map(Number).map((v) => v / 255)
    .map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
    const behind = (e) => { for (; e; e = e.parentElement) { const c = getComputedStyle(e).backgroundColor; if (!/, 0\\)/.test(c)) return c; } return 'rgb(255,255,255)'; };"""
CONTRAST = "(() => {" + LUMINANCE + """ let least = 99, where = '';
    for (const e of document.querySelectorAll('body *')) { if (![...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim()) || !e.getClientRects().length
        || e.closest('script, style, svg') || e.disabled || e.tagName === 'OPTION') continue;
      const a = lum(getComputedStyle(e).color) + 0.05, b = lum(behind(e)) + 0.05, ratio = Math.max(a, b) / Math.min(a, b);
      if (ratio < least) { least = ratio; where = e.outerHTML.slice(0, 80); } } return [least, where]; })()"""
NAMELESS = """[...document.querySelectorAll('canvas, svg, button, input, select, textarea')].filter((e) => !e.closest('#strip') &&
    !(e.getAttribute('aria-label') || e.ariaLabel || e.textContent.trim() || (e.labels && e.labels.length))).map((e) => e.outerHTML.slice(0, 80))"""
ok(browser.evaluate(NAMELESS) == [], "pictures and controls have words for those who do not see them", browser.evaluate(NAMELESS))
contrast = browser.evaluate(CONTRAST)
ok(contrast[0] >= 4.5, "text stands out from what is behind it", contrast)
browser.open(at("goes-on.html"))
browser.evaluate("page.course.set(0)")
said = browser.evaluate("[element('now').textContent, page.cracks.filter((c) => c.earlier).map((c) => describeCrack(page.body, page.course, c).history[0]),"
                        f" describeGrain(page.body, page.course, page.body.bond.first[{whole[9]}]).history]")
ok(said[0].endswith("in shear, 4 before") and sorted(said[1]) == 2 * ["had broken before, in shear"] + 2 * ["had broken before, in tension"]
   and any("had broken before, in shear" in line for line in said[2]), "bonds that had broken before, in words", said)
browser.open(at("hostile.html"))
ok(browser.evaluate("document.querySelectorAll('script').length") == 3 and browser.evaluate("document.title") == HOSTILE,
   "the hostile page shows its title as it is")
browser.close()

browser = Browser(width=360, height=700, dark=True)
browser.open(at("run.html"))
ok(browser.evaluate("document.documentElement.scrollWidth <= 360"), "a narrow screen needs no scrolling sideways",
   browser.evaluate("document.documentElement.scrollWidth"))
contrast = browser.evaluate(CONTRAST)
ok(contrast[0] >= 4.5, "in the dark too", contrast)
ok(browser.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(22, 24, 27)", "and it is dark")
printed = base64.b64decode(browser.call("Page.printToPDF")["data"])
ok(printed.startswith(b"%PDF") and browser.evaluate("document.querySelectorAll('#strip canvas').length") == 5,
   "it prints, with five moments side by side")
browser.close()

browser = Browser(webgl=False)
browser.open(at("run.html"))
ok(browser.evaluate("page.scene === null && !element('missing').hidden") and "WebGL is missing" in
   browser.evaluate("element('missing').textContent"), "without WebGL it says so")
browser.evaluate("page.course.set(page.course.last)")
browser.evaluate("draw(page)")
drawn = browser.evaluate("(() => { const kinds = {}; for (const t of page.things) kinds[t.kind] = (kinds[t.kind] || 0) + 1; return kinds; })()")
ok(drawn.get("grain") == len(radius) and drawn.get("crack") == len(modes), "and draws the same body plainly", drawn)
ok(not [e for e in browser.errors if "WebGL" not in e and "GPU" not in e], "without an error", browser.errors)
browser.close()
done()
