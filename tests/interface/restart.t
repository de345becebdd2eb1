#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# A run that was stopped and gone on with writes the bytes of one that never was, and a
# checkpoint that is damaged or of another run is refused and left where it is.
import os
import random
import shutil
import signal
import subprocess
import sys
import time

import h5py

sys.path.insert(0, "tests")
from tap import BIN, SCENE, done, ok, read, run, scratch

MOST_STOPS = 60
ENOUGH_STOPS = 4  # that kept a state; then the run may end

# Where a shell without job control put the tests behind, SIGINT is ignored, here and by
# what is started here.
signal.signal(signal.SIGINT, signal.SIG_DFL)


def call(stage, *arguments):
    return subprocess.run([f"{BIN}/{stage}", *map(str, arguments)], capture_output=True)


def stopped_after(seconds, name, command):
    """Starts the command, sends the signal (never where SECONDS is None), gives its status and what it said."""
    process = subprocess.Popen([f"{BIN}/{command[0]}", *map(str, command[1:])],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        _, said = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        process.send_signal(getattr(signal, name))
        _, said = process.communicate(timeout=30)
    return process.returncode, said.decode()


def in_pieces(title, command):
    """Runs to the end in pieces of a third of the time; compares with one piece."""
    with scratch() as folder:
        stop_and_go_on(title, command, folder)


def stop_and_go_on(title, command, folder):
    whole, cut, kept = (os.path.join(folder, name) for name in ("whole", "cut", "kept"))
    began = time.monotonic()
    run(*command, "-o", whole)
    piece = (time.monotonic() - began) / 3
    names = ["SIGTERM", "SIGINT", "SIGHUP"]
    stops, states = 0, 0
    for number in range(MOST_STOPS):
        name = names[number % 3]
        status, said = stopped_after(piece if states < ENOUGH_STOPS else None, name, [
            *command, "--checkpoint", kept, "-o", cut, "--threads", 1 + number % 2])
        if status == 0 and not states and piece > 0.01:
            piece /= 2  # faster than in one piece: done before it could be stopped
            os.remove(cut)
            continue
        if status == 0:
            break
        stops += 1
        states += os.path.exists(kept)
        piece *= 1.1  # a signal may come before the work began
        if status != -getattr(signal, name) or os.path.exists(cut):
            ok(False, f"{title}: stopped by {name}", f"status {status}: {said}")
            return
    ok(states and status == 0, f"{title}: stopped and gone on with", f"{stops} stops")
    ok(read(whole) == read(cut), f"{title}: the same bytes as in one piece")
    ok(not os.path.exists(kept), f"{title}: and no checkpoint is left")


def stopped_once_kept_again(kept, command):
    """Stops the command when it has gone on from what is kept and kept that anew; its status and what it said."""
    before = time_of(kept)
    process = subprocess.Popen([f"{BIN}/{command[0]}", *map(str, command[1:]), "--checkpoint-every", "0"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    while process.poll() is None and time_of(kept) == before:
        time.sleep(0.005)
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=30)
    return process.returncode, said.decode()


def make_forces(folder, steps, counts="[5,5,10]"):
    made = b""
    sets = {"pack": [f"counts={counts}"], "force-protocol": ["force_scale=1", f"steps={steps}"]}
    for stage in ["pack", "tessellate", "merge-nodes", "dry", "force-protocol"]:
        words = [word for setting in sets.get(stage, []) for word in ("--set", setting)]
        made = run(stage, "-p", SCENE, *words, input=made)
    path = os.path.join(folder, f"forces-{counts}-{steps}")
    with open(path, "wb") as file:
        file.write(made)
    return path


def time_of(path):
    """Of its last change; None where there is none."""
    try:
        return os.stat(path).st_mtime_ns
    except FileNotFoundError:
        return None


def killed(title, command):
    """Kills without a warning, at any time after a state was kept; what was kept last is gone on from."""
    with scratch() as folder:
        whole, cut, kept = (os.path.join(folder, name) for name in ("whole", "cut", "kept"))
        run(*command, "-o", whole)
        any_time = random.Random(1)
        kills = 0
        for _ in range(MOST_STOPS):
            before = time_of(kept)
            process = subprocess.Popen([f"{BIN}/{command[0]}", *map(str, command[1:]), "--checkpoint", kept,
                                        "--checkpoint-every", "0.02", "-o", cut])
            while process.poll() is None and (time_of(kept) or before) == before:
                time.sleep(0.001)
            time.sleep(any_time.uniform(0, 0.06))
            process.kill()
            kills += process.wait() != 0
            if kills == ENOUGH_STOPS:
                break
        ended = call(*command, "--checkpoint", kept, "-o", cut)
        ok(kills and ended.returncode == 0 and read(whole) == read(cut),
           f"{title}: killed without a warning, the same bytes", f"{kills} kills: {ended.stderr.decode()}")


def without_a_place(title, command):
    """The folder of the checkpoint goes while the run is on its way."""
    with scratch() as folder:
        whole, cut, shelf = (os.path.join(folder, name) for name in ("whole", "cut", "shelf"))
        run(*command, "-o", whole)
        for name, status in [(None, 0), ("SIGTERM", 73)]:
            os.mkdir(shelf)
            kept = os.path.join(shelf, "kept")
            process = subprocess.Popen(
                [f"{BIN}/{command[0]}", *map(str, command[1:]), "-o", cut, "--checkpoint", kept,
                 "--checkpoint-every", "0.02"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            while not os.path.exists(kept) and process.poll() is None:
                time.sleep(0.005)
            shutil.rmtree(shelf)
            if name:
                process.send_signal(getattr(signal, name))
            said = process.communicate(timeout=60)[1].decode()
            ok(process.returncode == status and "kept: No such file or directory\n" in said
               and (name or said.count("the state was not kept this time; the run continues\n") == 1)
               and (name or said.count("No such file") == 1)
               and (name or read(whole) == read(cut)),
               f"{title}: a checkpoint that cannot be written is said, "
               + (f"with status {status} on {name}" if name else "and the run continues"),
               f"status {process.returncode}: {said}")


def make_network(folder, name, count):
    made = run("pack", "-p", SCENE, "--set", f"counts=[{count},{count},{count}]")
    for stage in ["tessellate", "merge-nodes"]:
        made = run(stage, "-p", SCENE, input=made)
    path = os.path.join(folder, name)
    with open(path, "wb") as file:
        file.write(made)
    return path


def make_irregular(folder, name, count, upper, method="random_sequential"):
    """Random grains: each has other throats, so that gas comes to them at other times."""
    made = run("pack", "--quiet", "--set", f"method={method}", "--set", f"count={count}", "--set", f"upper={upper}")
    for stage in ["tessellate", "merge-nodes"]:
        made = run(stage, input=made)
    path = os.path.join(folder, name)
    with open(path, "wb") as file:
        file.write(made)
    return path


def refused(title, kept, command, status, says):
    before = read(kept) if os.path.exists(kept) else None
    end = call(*command, "--checkpoint", kept, "-o", kept + ".out")
    lines = end.stderr.decode().splitlines()
    after = read(kept) if os.path.exists(kept) else None
    ok(end.returncode == status and len(lines) == 1 and says in lines[0] and before == after
       and not os.path.exists(kept + ".out"), title,
       f"status {end.returncode}: {end.stderr.decode()}")


def keep_one(command, kept):
    """A checkpoint on the way, from a run that is stopped."""
    for seconds in (0.5, 1, 2, 4):
        stopped_after(seconds, "SIGTERM", [*command, "--checkpoint", kept, "-o", kept + ".out"])
        if os.path.exists(kept):
            return


def flip(path, at):
    with open(path, "r+b") as file:
        file.seek(at)
        byte = file.read(1)[0]
        file.seek(at)
        file.write(bytes([byte ^ 0x10]))


with scratch() as folder:
    forces = make_forces(folder, 250)
    short = ["dem-replay", forces, "-p", SCENE]
    few = ["dem-replay", make_forces(folder, 250, "[4,5,6]"), *short[2:]]
    in_pieces("dem-replay", short)
    in_pieces("dem-replay to a tolerance",
              [*short, "--set", "cycles=100", "--set", "tolerance=0.02", "--set",
               "bond.normal_strength=1.2e4"])
    in_pieces("dem-replay with liquid bridges and contact bonds",
              [*few, "--set", "cycles=100", "--set", "bridges.volume=1e-22", "--set",
               "bridges.shared=true", "--set", "bond.kind=contact"])

    equilibria = [*few, "--set", 'engine="quasi-static"', "--set", "support=fixed"]
    in_pieces("dem-replay by equilibria with friction", equilibria)
    in_pieces("dem-replay by equilibria with large displacements",
              [*equilibria, "--set", "quasi_static.large_displacements=true"])

    in_pieces("dem-replay by equilibria with contact bonds",
              ["dem-replay", make_forces(folder, 1500), *equilibria[2:], "--set", "bond.kind=contact"])

    in_pieces("dem-replay of a body that nothing holds",
              [*short, "--set", "cycles=100", "--set", "support=free", "--set",
               "bond.strength.distribution=weibull"])

    pack = ["pack", "--quiet", "--set", "radius=1e-3", "--set"]
    in_pieces("pack by deposition", [*pack, "count=250", "--set", "method=deposition"])
    grow = [*pack, "method=radius_expansion", "--set"]
    in_pieces("pack by growing grains to a porosity",
              [*grow, "count=500", "--set", "target=porosity", "--set", "target_value=0.45"])
    in_pieces("pack by growing grains to a coordination",
              [*grow, "count=120", "--set", "target=coordination", "--set", "target_value=5"])
    in_pieces("pack by growing discs to a pressure",
              [*grow, "count=400", "--set", "target=pressure", "--set", "target_value=1e4",
               "--set", "dimensions=2"])
    in_pieces("pack in a box that closes in",
              [*pack, "method=domain_contraction", "--set", "count=250", "--set",
               "periodic=[true,true,true]", "--set", "dynamics.friction=0"])

    beads = os.path.join(folder, "beads")
    scene = ["-q", "-p", "samples/slump.json", "--set"]
    run("pack", *scene, "count=800", "-o", beads)
    # From loose to dense: the time step is shortened on the way, which the state must say.
    in_pieces("simulate: moist beads that fall between walls that move",
              ["simulate", *scene, "duration=0.1", "--set", "expected_overlap=1e-6", "--set",
               "bridges.volume=2e-12", beads])
    groups = ('{"paddle": {"grains": [3, 4], "driven": true, "spin": [0, 0, 9], "point": [0.002, 0, 0]},'
              ' "stamp": {"grains": [7], "driven": true, "velocity": [0, 0, -0.01]}}')
    in_pieces("simulate: two groups that are driven",
              ["simulate", *scene, "duration=0.1", "--set", f"groups={groups}", beads])

    dry = ["dry", "-p", SCENE, "--set", "step_interval=0.01"]
    large, small = make_network(folder, "large", 18), make_network(folder, "small", 10)
    for liquid, network in [("inviscid", large), ("immobile", large), ("viscous", small)]:
        this = [*dry, "--set", f"liquid={liquid}", network]
        in_pieces(f"dry, {liquid} liquid", this)
        killed(f"dry, {liquid} liquid", this)
    for liquid, network in [("inviscid", small),
                            ("immobile", make_network(folder, "middle", 11)),
                            ("viscous", make_network(folder, "few", 6))]:
        killed(f"dry, curved menisci, {liquid} liquid",
               ["dry", "-p", SCENE, "--set", f"liquid={liquid}", "--set", "kelvin=true", network])
    in_pieces("dry, viscous liquid with snapshots",
              [*dry, "--set", "liquid=viscous", "--set", "snapshots=[0.9,0.6,0.3]", small])

    # So many nodes come to have a conductance to the air that room for them is made while a state is read.
    irregular = make_irregular(folder, "irregular", 4000, "[14e-6,14e-6,16e-6]")
    for liquid in "inviscid", "immobile":
        in_pieces(f"dry, {liquid} liquid, irregular body", [*dry, "--set", f"liquid={liquid}", irregular])
    in_pieces("dry with a tolerance", [*dry, "--set", "vapour_tolerance=1e-6", irregular])
    in_pieces("dry, vapour that is kept", [*dry, "--set", "vapour_step=0.1", irregular])
    viscous = [*dry, "--set", "liquid=viscous", "--set", "viscosity=1e-3", irregular]
    in_pieces("dry, viscous liquid whose flow is kept", viscous)
    in_pieces("dry, viscous liquid, flow and vapour that are kept", [*viscous, "--set", "vapour_step=0.1"])
    beads = make_irregular(folder, "beads", 1500, "[11e-6,11e-6,11e-6]", "soft_spheres")
    for rings, liquid in ("isolated", "inviscid"), ("isolated", "immobile"), ("joined", "inviscid"), ("films", "inviscid"):
        in_pieces(f"dry, {rings} rings, {liquid} liquid", [*dry, "--set", f"rings={rings}", "--set", f"liquid={liquid}", beads])
    in_pieces("dry, films and vapour that is kept", [*dry, "--set", "rings=films", "--set", "vapour_step=0.1", beads])

    without_a_place("dry", [*dry, "--set", "liquid=viscous", small])

    # By the clock as often as can be.
    kept = os.path.join(folder, "kept")
    brief = ["dem-replay", make_forces(folder, 40, "[4,5,6]"), *short[2:], "--set", "cycles=10"]
    often = run(*brief, "--checkpoint", kept, "--checkpoint-every", 0)
    ok(often == run(*brief), "checkpoints at every step change no byte")

    long = [*few, "--set", "cycles=1000000000"]
    keep_one(long, kept)
    with h5py.File(kept) as file:
        ok(file.attrs["schema"] in ("craquelure/restart/1", b"craquelure/restart/1")
           and file["engine/velocity"].shape == (120, 3) and file["stage/step"][0] == 0,
           "a checkpoint is an artifact")
    ok(call("inspect", kept).returncode == 0, "that inspect shows")
    good = os.path.join(folder, "good")
    shutil.copy(kept, good)
    refused("another parameter is another run", kept, [*long, "--set", "friction=0.4"], 65,
            "its parameters differ")
    other = os.path.join(folder, "other")
    shutil.copy(few[1], other)
    with h5py.File(other, "a") as file:
        file["force"][...] *= 1.5
    refused("another input is another run", kept,
            ["dem-replay", other, *long[2:]], 65, "its inputs differ")
    shutil.copy(few[1], kept)
    refused("another artifact is no checkpoint", kept, long, 65, "must be a restart, is a forces")
    for share in (0, 0.1, 0.5, 0.99):
        with open(kept, "wb") as file:
            file.write(read(good)[:int(share * len(read(good)))])
        refused(f"cut off after {share:.0%}", kept, long, 65, "kept: ")
    # Into the numbers of each array, and anywhere.
    with h5py.File(good) as file:
        places = []
        file.visititems(lambda name, item: places.append((name, item.id.get_offset()))
                        if isinstance(item, h5py.Dataset) and item.id.get_offset() else None)
    survived = []
    for name, at in places:
        shutil.copy(good, kept)
        flip(kept, at + 1)
        end = call(*long, "--checkpoint", kept, "-o", kept + ".out")
        if end.returncode != 65 or len(end.stderr.splitlines()) != 1:
            survived.append(f"{name}: {end.returncode}: {end.stderr.decode()}")
    ok(len(places) > 40 and not survived, "a flipped bit in any array", "\n".join(survived))
    wrong = []
    size = len(read(good))
    for k in range(40):
        shutil.copy(good, kept)
        at = (k * 7919 * 131) % size
        flip(kept, at)
        status, said = stopped_once_kept_again(kept, [*long, "--checkpoint", kept, "-o", kept + ".out"])
        if not (status == -signal.SIGTERM or (status == 65 and said.count("\n") == 1)):
            wrong.append(f"byte {at}: status {status}: {said}")
    ok(not wrong, "a flipped bit anywhere is refused, or does no harm", "\n".join(wrong))

    for title, arguments, status, says in [
            ("standard output is no place for it", ["--checkpoint", "-"], 64, "standard output"),
            ("nor a device", ["--checkpoint", "/dev/full", "-o", "x"], 64, "must be a file"),
            ("nor is the output", ["--checkpoint", "x", "-o", "x"], 64, "another file"),
            ("nor a folder that is not there", ["--checkpoint", "/no/such/x"], 73, "/no/such/x"),
            ("the time between must be a number", ["--checkpoint-every", "soon"], 64, "soon")]:
        end = call(*short, "-o", os.path.join(folder, "out"), *arguments)
        ok(end.returncode == status and says in end.stderr.decode(), title, end.stderr.decode())
    made = call("pack", "--checkpoint", kept, "-o", kept + ".out")
    ok(made.returncode == 0 and b"none is kept" in made.stderr,
       "a method without dynamics says that it keeps none", made.stderr.decode())
    ok(call("merge-nodes", "--checkpoint", "x").returncode == 64, "a stage without checkpoints says so")
done()
