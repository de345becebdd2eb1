#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# crackstats on responses made by hand: counts, borders of classes, many runs, tests of two
# groups against published outcomes, and the liquid of slices against sums over the throats.
import json
import shutil
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, run, scratch_paths, sets


def crackstats(*arguments):
    return json.loads(run("crackstats", *arguments))


def refused(says, *arguments):
    tried = subprocess.run([f"{BIN}/crackstats", *arguments], stdout=subprocess.PIPE,
                           stderr=subprocess.PIPE)
    return tried.returncode == 65 and says in tried.stderr.decode() and not tried.stdout


def by_hand(path, bond, time, saturation, mode, first_period_end=None):
    """Replaces the cracks of the response at PATH."""
    with h5py.File(path, "r+") as file:
        position = file["particles/position"][:][file["bonds/particles"][:][bond]].mean(axis=1)
        for name, value in [("bond", bond), ("time", time), ("saturation", saturation),
                            ("mode", mode), ("position", position.reshape(-1, 3))]:
            old = file[f"cracks/{name}"]
            kind, units = old.dtype, dict(old.attrs)
            del file[f"cracks/{name}"]
            new = file.create_dataset(f"cracks/{name}", data=np.asarray(value, kind))
            for key, unit in units.items():
                new.attrs[key] = unit
        if first_period_end is not None:
            file["summary"].attrs["first_period_end_time"] = first_period_end


def modes(entry):
    return entry["normal"], entry["shear"], entry["total"]


with scratch_paths() as at:
    run("pack", "--set", "counts=[3,3,5]", "-o", at("packing"))
    run("tessellate", at("packing"), "-o", at("tessellation"))
    run("merge-nodes", at("tessellation"), "-o", at("network"))
    run("dry", "-p", SCENE, at("network"), "-o", at("drying"))
    run("force-protocol", "-p", SCENE, "--set", "steps=5", at("drying"), "-o", at("forces"))
    run("dem-replay", "-p", SCENE, "--set", "cycles=1", at("forces"), "-o", at("response"))
    with h5py.File(at("response")) as file:
        bonds = file["bonds/particles"][:]
        position = file["particles/position"][:]
        end = file["history/time"][-1]
        first_end = file["summary"].attrs["first_period_end_time"]
        d = 2 * file["particles/radius"][0]
    upright = np.abs(np.diff(position[bonds][..., 2])[:, 0]) > 0.5 * d
    layer = np.rint(position[bonds].min(axis=1)[:, 2] / d - 0.5).astype(int)

    # ---- counts ---------------------------------------------------------------------
    # Between layers 0 and 1, in layer 4, in layer 2, between 2 and 3, in layer 0.
    chosen = [np.flatnonzero(upright & (layer == 0))[0], np.flatnonzero(~upright & (layer == 4))[0],
              np.flatnonzero(~upright & (layer == 2))[0], np.flatnonzero(upright & (layer == 2))[0],
              np.flatnonzero(~upright & (layer == 0))[0]]
    shutil.copy(at("response"), at("hand"))
    by_hand(at("hand"), chosen, np.array([0, 0.25, 0.25, 0.5, 1]) * end,
            [1, 0.8, 0.75, 0.5, 0], [1, 0, 1, 1, 0], 0.25 * end)
    stats = crackstats("--set", "slices=5", "--set", "intervals=5", at("hand"))
    ok(modes(stats["cracks"]) == (2, 3, 5) and abs(stats["mean"]["cracks"]["share"]
       - 5 / len(bonds)) < 1e-15, "cracks by mode, and their share of the bonds", stats["mean"])
    ok([modes(p) for p in stats["periods"]] == [(1, 2, 3), (1, 1, 2)],
       "periods: the very end of the first counts there", stats["periods"])
    ok([s["total"] for s in stats["profile"]] == [1.5, 0.5, 1.5, 0.5, 1],
       "slices: a bond on the border of two counts half in each", stats["profile"])
    ok([s["total"] for s in stats["by_saturation"]] == [2, 1, 1, 0, 1]
       and [(s["from"], s["to"]) for s in stats["by_saturation"]][1] == (0.8, 0.6),
       "intervals of saturation: 0.8 is the end of the first of five", stats["by_saturation"])
    ok([s["total"] for s in stats["by_time"]] == [1, 2, 1, 0, 1], "intervals of time",
       stats["by_time"])
    ok(stats["profiles"][0]["cracks"] == [0.5, 0.5, 0, 0, 1]
       and stats["profiles"][-1]["cracks"] == [1.5, 0.5, 1.5, 0.5, 1]
       and stats["profiles"][0]["liquid"] is None and stats["front"] is None,
       "profiles: cracks so far; no liquid without the drying", stats["profiles"])
    ok(sum(s["size"] * s["count"] for s in stats["clusters"]) == 5
       and sum(s["size"] * s["count"] for s in stats["fragments"]) == len(position),
       "clusters hold all cracks, fragments all grains", stats["clusters"])
    ok(stats["sd"] is None and stats["confidence_interval"] is None and stats["test"] is None
       and all(row["sd"] is None and row["confidence_interval"] is None
               for row in [stats["profile"][0], stats["cracks"], *stats["periods"],
                           *stats["orientation"]["inclination"]]), "one run has no scatter")
    ok(stats["interval_of"] == "one run: no interval; repeat over seeds", "which is said",
       stats["interval_of"])

    # ---- a box that repeats along z -------------------------------------------------
    # Where it begins is of no consequence: the profile goes around with the grains.
    run("pack", "-q", *sets("method=soft_spheres", "upper=[2e-6,2e-6,3e-6]", "periodic=[true,true,true]", "bonds=touching"),
        "-o", at("around"))
    run("dem-replay", "-q", *sets("shrinkage.strain=1e-6", "shrinkage.steps=1", "held.walls=[]", "held.grains=[0]", "cycles=1",
                                  "most_cycles=1", "unsettled=count"), at("around"), "-o", at("turned"))
    with h5py.File(at("turned"), "r+") as file:
        pairs, z = file["bonds/particles"][:], file["particles/position"][:, 2]
        low, high = file["domain/lower"][2], file["domain/upper"][2]
        across = np.flatnonzero(np.abs(np.diff(z[pairs])[:, 0]) > (high - low) / 2)
    by_hand(at("turned"), across, np.ones(len(across)), [0] * len(across), [0] * len(across))
    profiles = []
    for turn in range(5):
        with h5py.File(at("turned"), "r+") as file:
            file["particles/position"][:, 2] = low + (z - low + turn * (high - low) / 5) % (high - low)
        profiles.append([s["total"] for s in crackstats("--set", "slices=5", at("turned"))["profile"]])
    ok(len(across) > 10 and profiles[2][1] > 0 and profiles[2][2] > 0
       and all(np.array_equal(np.roll(p, -k), profiles[0]) for k, p in enumerate(profiles)),
       "slices: the same wherever a box that repeats along z begins", profiles)

    # ---- loads that did not come to rest --------------------------------------------
    def unsettled(settled, cracks):
        """Loads and cracks under them, by crackstats, of a response with CRACKS under each load."""
        shutil.copy(at("response"), at("restless"))
        with h5py.File(at("restless"), "r+") as file:
            times = file["history/time"][:]
            file["history/settled"][...] = settled
        by_hand(at("restless"), list(range(sum(cracks))), np.repeat(times, cracks),
                [0] * sum(cracks), [0] * sum(cracks))
        of = crackstats(at("restless"))["each"][0]["unsettled"]
        return of["loads"], of["cracks"]

    steps = h5py.File(at("response"))["history/time"].shape[0]
    settled, cracks = np.ones(steps, int), np.arange(steps)
    ok(unsettled(settled, cracks) == (0, 0), "all loads came to rest")
    settled[[1, 3]] = 0
    ok(unsettled(settled, cracks) == (2, 1 + 3), "cracks under the two loads that did not")
    ok(unsettled(0 * settled, cracks) == (steps, sum(cracks)), "none came to rest")
    with h5py.File(at("restless"), "r+") as file:
        del file["history/settled"]
        file["summary"].attrs["steps_unsettled"] = 0
    ok(crackstats(at("restless"))["each"][0]["unsettled"] == {"loads": 0, "cracks": 0},
       "an old response that came to rest")
    with h5py.File(at("restless"), "r+") as file:
        file["summary"].attrs["steps_unsettled"] = 1
    ok(refused("/history/settled: is not there, and some loads", at("restless")),
       "an old one that did not is refused")
    # By cycles, a real one: those above the tolerance, which lies amid its ratios.
    def in_haste(tolerance):
        words = ["engine=explicit", "cycles=100", "most_cycles=1", "unsettled=count", "ramp=0",
                 "density_scaling=false", "bond.normal_strength=3e3", f"tolerance={tolerance}"]
        run("dem-replay", "-q", "-p", SCENE, *sets(*words), at("forces"),
            "-o", at("hurried"))
        with h5py.File(at("hurried")) as file:
            loaded = file["history/saturation"][:] > 0
            return (file["history/unbalanced_ratio"][:], loaded, np.diff(file["history/cracks"][:], prepend=0),
                    file["summary"].attrs["steps_unsettled"])

    ratio, loaded, opened, _ = in_haste("null")
    tolerance = np.sqrt(np.prod(np.sort(ratio[loaded])[1:3]))
    again, loaded, opened, count = in_haste(tolerance)
    above = loaded & (again >= tolerance)
    counted = crackstats(at("hurried"))["mean"]["unsettled"]
    ok(0 < above.sum() < loaded.sum() and above.sum() == count == counted["loads"] and counted["cracks"] == opened[above].sum()
       and 0 < opened[above].sum() < opened.sum(), "a replay in haste: loads above the tolerance, and cracks "
       "under them", (again, tolerance, opened, count, counted))

    # ---- none, one, all -------------------------------------------------------------
    everything = list(range(len(bonds)))
    for title, broken, share, clusters, fragments in [
            ("no crack", [], 0, (0, 0), 1), ("one crack", chosen[:1], 1 / len(bonds), (1, 1), 1),
            ("every bond at once", everything, 1, (1, len(bonds)), len(position))]:
        shutil.copy(at("response"), at("odd"))
        by_hand(at("odd"), broken, [end] * len(broken), [0] * len(broken), [0] * len(broken))
        mean = crackstats(at("odd"), at("drying"))["mean"]
        ok(mean["cracks"]["share"] == share and (mean["clusters"]["count"], mean["clusters"]["largest"]) == clusters
           and mean["fragments"]["count"] == fragments and mean["cracks"]["total"] == len(broken)
           and (mean["front"]["saturation"] is None) == (not broken), f"{title} of {len(bonds)}", mean)

    # ---- many runs ------------------------------------------------------------------
    # Hours of sleep (Student 1908), ten times as many and 20 more, as numbers of cracks: t
    # and the ranks are those of R's sleep data.
    first = [27, 4, 18, 8, 19, 54, 57, 28, 20, 40]
    second = [39, 28, 31, 21, 19, 64, 75, 36, 66, 54]
    paths = []
    for n in first + second:
        paths.append(at(f"run-{len(paths)}"))
        shutil.copy(at("response"), paths[-1])
        by_hand(paths[-1], list(range(n)), [end] * n, [0.5] * n, [0] * n)
    stats = crackstats("--set", "first_group=10", "--set", "paired=true", *paths)
    test = stats["test"]["cracks"]["total"]
    ok(stats["test"]["groups"] == [10, 10] and test["mean"] == [np.mean(first), np.mean(second)],
       "two groups of ten runs", test)
    ok(round(test["welch"]["t"], 4) == -1.8608
       and round(test["welch"]["degrees_of_freedom"], 3) == 17.776
       and round(test["welch"]["p"], 5) == 0.07939, "Welch's t test, as published", test)
    ok(test["mann_whitney"]["u"] == 25.5 and round(test["mann_whitney"]["p"], 5) == 0.06933
       and not test["mann_whitney"]["exact"], "Mann and Whitney's test, as published", test)
    ok(round(test["paired_t"]["t"], 4) == -4.0621 and round(test["paired_t"]["p"], 6) == 0.002833
       and abs(test["paired_t"]["mean"] + 15.8) < 1e-12 and test["wilcoxon"]["v"] == 0
       and round(test["wilcoxon"]["p"], 6) == 0.009091, "and both tests of pairs", test)
    ok(stats["test"]["cracks"]["shear"]["welch"]["p"] == 1
       and stats["test"]["cracks"]["shear"]["mann_whitney"]["p"] == 1,
       "what is the same in all runs does not differ")
    ok(stats["test"]["front"]["correlation"] is None and stats["mean"]["front"]["correlation"]
       is None, "what no run tells is null")
    interval = crackstats(*paths[:10])["confidence_interval"]["cracks"]["total"]
    ok(np.allclose(interval, 20 + 10 * np.array([-0.5297804, 2.0297804]), atol=1e-6),
       "the interval of the mean, as published", interval)
    # Student's t of one and two degrees of freedom at 95 % has a closed form.
    for n, t in (2, np.tan(0.95 * np.pi / 2)), (3, 0.95 * np.sqrt(2 / (1 - 0.95 ** 2))):
        few = crackstats(*paths[:n])
        half = t * np.std(first[:n], ddof=1) / np.sqrt(n)
        wanted = [np.mean(first[:n]) - half, np.mean(first[:n]) + half]
        rows = [few["cracks"], few["periods"][1]]
        ok(all(np.allclose(row["confidence_interval"]["total"], wanted, rtol=1e-12)
               and row["confidence_interval"]["normal"] == row["confidence_interval"]["total"]
               and np.isclose(row["sd"]["total"], np.std(first[:n], ddof=1), rtol=1e-14) for row in rows)
           and few["periods"][0]["confidence_interval"]["total"] == [0, 0],
           f"{n} runs: all cracks and those of each period have the closed form's interval", rows)
        ok(few["interval_of"] == f"95 % confidence interval of the mean over {n} runs, by Student's t",
           "and it is said of what", few["interval_of"])
    ok(crackstats("--set", "confidence=0.9", *paths[:2])["interval_of"].startswith("90 % "),
       "with the confidence asked for")
    tilted = [[sum(upright[:n]), n - sum(upright[:n])] for n in first[:3]]
    inclination = few["orientation"]["inclination"]
    ok(all(np.allclose(row["confidence_interval"]["normal"], np.mean(counts) + t * np.std(counts, ddof=1)
                       / np.sqrt(3) * np.array([-1, 1]), rtol=1e-12)
           for row, counts in zip([inclination[0], inclination[-1]], np.transpose(tilted))),
       "and classes of inclination", inclination)
    ok(np.isclose(stats["sd"]["cracks"]["total"], np.std(first + second, ddof=1))
       and [e["cracks"]["total"] for e in stats["each"]] == first + second,
       "standard deviation, and each run's own")
    top = crackstats("--set", "slices=1", "--set", "intervals=1", *paths[:10])
    rows = [top["profile"][0], top["by_saturation"][0], top["by_time"][0]]
    ok(all(np.allclose(row["confidence_interval"]["total"], interval, rtol=1e-14)
           and np.isclose(row["sd"]["normal"], np.std(first, ddof=1), rtol=1e-14)
           and row["confidence_interval"]["shear"] == [0, 0] for row in rows),
       "one class of height, saturation or time scatters as all cracks do", rows)
    few = crackstats("--set", "slices=5", *paths[:10])["profile"]
    own = np.array([[s["total"] for s in crackstats("--set", "slices=5", p)["profile"]]
                    for p in paths[:10]])
    ok(np.allclose([s["sd"]["total"] for s in few], np.std(own, axis=0, ddof=1), rtol=1e-14),
       "each slice as its counts run by run", few)
    ok(crackstats(*paths[::-1])["mean"]["cracks"] == stats["mean"]["cracks"],
       "the order of the runs does not matter to the means")

    # ---- liquid ---------------------------------------------------------------------
    slices, intervals = 5, 10
    run("dry", "-p", SCENE, "--set", "start_saturation=0.6", at("network"), "-o", at("half-full"))
    run("force-protocol", "-p", SCENE, "--set", "steps=5", at("half-full"), "-o", at("half-forces"))
    run("dem-replay", "-p", SCENE, "--set", "cycles=1", at("half-forces"), "-o", at("half-response"))
    for what, drying, response, wet in [
            ("full at first", at("drying"), at("response"), at("wet")),
            ("partly empty at first", at("half-full"), at("half-response"), at("half-wet"))]:
        shutil.copy(response, wet)
        with h5py.File(response) as file:
            end = file["history/time"][-1]
        with h5py.File(drying) as file:
            step_time, step_saturation = file["history/time"][:], file["history/saturation"][:]
            kind = file["throats/kind"][:]
            offset, throat = file["changes/offset"][:], file["changes/throat"][:]
            to = file["changes/saturation"][:]
            ends = file["nodes/position"][:][file["throats/nodes"][:]]
            volume = np.pi * file["throats/radius"][:] ** 2 * file["throats/length"][:]
        states = [np.where(kind == 0, 1.0, 0.0)]
        for k in range(len(offset) - 1):
            state = states[-1].copy()
            state[throat[offset[k]:offset[k + 1]]] = to[offset[k]:offset[k + 1]]
            states.append(state)
        states = np.array(states[1:])
        height = 5 * d
        middle = ends[..., 2].mean(axis=1) / height * slices
        halves = [np.clip(np.floor(middle + shift), 0, slices - 1).astype(int)
                  for shift in (-1e-6, 1e-6)]
        share = np.array([sum(half == s for half in halves) / 2 for s in range(slices)])

        def liquid(time):
            state = np.array([np.interp(time, step_time, states[:, t]) for t in range(len(kind))])
            full = share * volume * (kind == 0)
            return full @ state / full.sum(axis=1)

        times = np.array([0.1, 0.3, 0.3, 0.5, 0.7]) * end
        reached = np.interp(times, step_time, step_saturation)
        by_hand(wet, chosen, times, reached, [0, 0, 1, 1, 0])
        stats = crackstats("--set", f"slices={slices}", wet, drying)
        levels = [np.interp(-(1 - (k + 1) / intervals), -step_saturation, step_time)
                  for k in range(intervals)]
        wanted = np.array([liquid(time) for time in levels])
        got = np.array([p["liquid"] for p in stats["profiles"]])
        ok(np.allclose(got, wanted, atol=1e-9), f"the saturation of the slices, {what}",
           np.abs(got - wanted).max())
        local = [liquid(t)[s].mean() for t, s in zip(times, [[0, 1], [4], [2], [2, 3], [0]])]
        ok(abs(stats["mean"]["front"]["saturation"] - np.mean(local)) < 1e-9,
           f"how wet the slices are in which cracks open, {what}", local)
        cracks = np.diff([[0] * slices] + [p["cracks"] for p in stats["profiles"]], axis=0)
        lost = -np.diff(np.vstack([liquid(step_time[0]), wanted]), axis=0)
        ok(abs(stats["front"]["correlation"] - np.corrcoef(cracks.ravel(), lost.ravel())[0, 1]) < 1e-9
           and stats["front"]["correlation"] == stats["mean"]["front"]["correlation"],
           f"the correlation of cracks with the liquid that leaves, {what}", stats["front"])
    with h5py.File(at("response")) as file:
        end = file["history/time"][-1]
    ok(crackstats(at("wet"), at("drying"), at("wet"))["front"] is None
       and crackstats(at("wet"), at("drying"), at("wet"), at("drying"))["runs"] == 2,
       "the drying may be left out of some runs")

    # ---- what is no study -----------------------------------------------------------
    for title, says, broken, times in [
            ("a bond that breaks twice", "/cracks/bond: row 1: bond 3 has broken before", [3, 3], [end, end]),
            ("a crack after the end", "/cracks/time: row 0: must not be after the end", [3], [1.01 * end])]:
        shutil.copy(at("response"), at("odd"))
        by_hand(at("odd"), broken, times, [0] * len(broken), [0] * len(broken))
        ok(refused(says, at("odd")), f"{title} is refused")
    shutil.copy(at("wet"), at("again"))
    tried = subprocess.run([f"{BIN}/crackstats", at("hand"), at("wet"), at("again")], capture_output=True)
    ok(tried.returncode == 0 and json.loads(tried.stdout)["runs"] == 3 and tried.stderr.decode().count("\n") == 1
       and f"again: is the same run as {at('wet')}; both count" in tried.stderr.decode(), "a run given twice is said", tried.stderr)
    shutil.copy(at("hand"), at("odd"))
    with h5py.File(at("odd"), "r+") as file:
        levels = file["snapshots/saturation"][:]
        file["snapshots/saturation"][...] = levels / 2
    ok(np.allclose([s["saturation"] for s in crackstats(at("hand"), at("odd"))["deformation"]], 0.75 * levels),
       "snapshots are at the mean saturation of the runs")

    # ---- refusals -------------------------------------------------------------------
    ok(refused("drying: is not the drying of the response before it: /summary/first_period_end_time is ",
               at("hand"), at("drying")), "the drying of another response is refused")
    ok(refused("drying: must be a response, is a drying", at("drying")), "and one alone")
    ok(refused("drying: must be a response, is a drying", at("wet"), at("drying"), at("drying")),
       "and a second one")
    ok(refused("first_group: must leave runs to test against, got 2 of 2", "--set",
               "first_group=2", at("hand"), at("hand")), "a group must leave another")
    run("dem-replay", "-p", SCENE, "--set", "cycles=1", "--set", "snapshots=[1]", at("forces"),
        "-o", at("one"))
    ok(refused("one: has 1 snapshots, the runs before have 6: not one study", at("wet"), at("one")),
       "runs with other snapshots are refused")
    run("pack", "--set", "counts=[2,2,3]", "-o", at("packing"))
    run("tessellate", at("packing"), "-o", at("tessellation"))
    run("merge-nodes", at("tessellation"), "-o", at("network"))
    run("dry", "-p", SCENE, at("network"), "-o", at("drying"))
    run("force-protocol", "-p", SCENE, "--set", "steps=5", at("drying"), "-o", at("forces"))
    run("dem-replay", "-p", SCENE, "--set", "cycles=1", at("forces"), "-o", at("smaller"))
    ok(refused("drying: is not the drying of the response before it: has 12 grains, not 45",
               at("wet"), at("drying")), "and that of another packing")
    both = crackstats("--set", "same_bonds=false", at("wet"), at("smaller"))
    ok(both["bonds"] == (len(bonds) + 20) / 2, "runs of other packings, when asked for",
       both["bonds"])
done()
