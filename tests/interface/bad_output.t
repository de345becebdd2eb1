#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input (tests/refusals.py): where an output cannot go, and runs that a signal ends."""
import os
import resource
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, "tests")
from refusals import (BAD_DATA, BIN, CANNOT_CREATE, IO, USAGE, done, problems_of, refused,
                      refused_in_shell, result, run)

# ---- output -----------------------------------------------------------------------------

for program, source in [("pack", ""), ("tessellate", "packing"), ("merge-nodes", "network"),
                        ("dry", "network"), ("invade", "network"), ("force-protocol", "drying"),
                        ("crackstats", "response")]:
    refused_in_shell(f"{program} reports a full disk", IO,
                     f"$BIN/{program} {source} -o /dev/full",
                     f"{program}: /dev/full: No space left on device")
    refused_in_shell(f"{program} reports a full disk on standard output", IO,
                     f"$BIN/{program} {source} >/dev/full",
                     f"{program}: standard output: No space left on device")
for option in ["--help", "--version", "--schema", "--parameters"]:
    refused_in_shell(f"pack {option} reports a full disk", IO, f"$BIN/pack {option} >/dev/full",
                     "pack: standard output: No space left on device")
refused_in_shell("inspect reports a full disk", IO, "$BIN/inspect packing >/dev/full",
                 "inspect: standard output: No space left on device")
refused("a directory as output is refused", CANNOT_CREATE, ["pack"], "out: is a directory",
        output=("-o", "out"))
refused("an output below a file is refused", CANNOT_CREATE, ["pack"],
        "packing/x.h5: Not a directory", output=("-o", "packing/x.h5"))
refused("an output in no directory is refused", CANNOT_CREATE, ["pack"],
        "nowhere/x.h5: No such file or directory", output=("-o", "nowhere/x.h5"))
refused("an output where nobody can create is refused", CANNOT_CREATE, ["pack"],
        "/proc/x.h5: .*", output=("-o", "/proc/x.h5"))
refused("an output without a name is refused", CANNOT_CREATE, ["pack"],
        ": No such file or directory", output=("-o", ""))
os.symlink("nowhere/x.h5", "dangling")
refused("a link to nowhere as output is refused", CANNOT_CREATE, ["pack"],
        "dangling: No such file or directory", output=("-o", "dangling"))
refused("inspect cannot write its series below a file", CANNOT_CREATE,
        ["inspect", "--vtk=packing/x", "forces"], "packing/x-0000.vtu: Not a directory",
        output=())
for program, source in [("tessellate", "packing"), ("dry", "network"),
                        ("force-protocol", "drying"), ("dem-replay", "forces"),
                        ("crackstats", "response")]:
    before = open(source, "rb").read()
    refused(f"{program} over its own input is refused", USAGE, [program, source],
            f"{source}: is an input, and where the output goes: name another file",
            output=("-o", os.path.abspath(source)))
    result(f"{source} is what it was", [] if open(source, "rb").read() == before else ["changed"])
refused_in_shell("grains of one's own are not lost either", USAGE,
                 "echo 0 0 0 1 >grains.txt; $BIN/pack --set method=import grains.txt -o grains.txt",
                 "pack: grains.txt: is an input, and where the output goes: name another file")
before = open("network", "rb").read()
refused("a report over the input is refused", USAGE, ["merge-nodes", "network", "--report", "network"],
        "--report network: is an input: name another file")
result("the network is what it was", [] if open("network", "rb").read() == before else ["changed"])
with open("scene.json", "w") as file:
    file.write("{}")
refused("an output over the scene is refused", USAGE, ["pack", "-p", "scene.json"],
        "--params scene.json: is where the output goes: name another file", output=("-o", os.path.abspath("scene.json")))
result("the scene is what it was", [] if open("scene.json").read() == "{}" else ["changed"])
shutil.copy("network", "own")
same = run(["merge-nodes", "own", "-o", "own"])
result("a network may become another in its place", [same.stderr] if same.returncode else [])
refused("a limit on the file size leaves the earlier output", IO, ["pack"],
        "out/result: File too large",
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000)))
for length in [244, 255]:
    name = "n" * length
    made = run(["pack", "-o", f"out/{name}"])
    result(f"a name of {length} bytes is as good as any",
           [made.stderr.decode()] if made.returncode or sorted(os.listdir("out")) != [name, "result"]
           else [])
refused("a longer name is refused at once", CANNOT_CREATE, ["dry", "no-such-input"],
        f"out/{'n' * 256}: File name too long", output=("-o", "out/" + "n" * 256))
for kind, command in [("packing", ["pack"]), ("report", ["pack", "-o", "out/packing", "--report"])]:
    with open("rights", "w"):
        pass
    modes = []
    for mode in [0o600, 0o664]:
        os.chmod("rights", mode)
        run([*command, *(["-o"] if kind == "packing" else []), "rights"])
        modes.append(os.stat("rights").st_mode & 0o777 == mode and os.path.getsize("rights") > 0)
    result(f"a {kind} that is replaced keeps its rights", [] if all(modes) else [str(modes)])
small_disk = """mount -t tmpfs -o size=16k tmpfs out && head -c 9000 packing >out/other
    echo "the earlier output" >out/result
    $BIN/pack -o out/result; status=$?
    rm out/other; [[ $(ls out) == result ]] && exit $status"""
title = "a disk that fills up leaves the earlier output alone"
if subprocess.run(["unshare", "-m", "mount", "-t", "tmpfs", "tmpfs", "out"],
                  capture_output=True).returncode:
    result(title, [], "cannot mount a small disk")
else:
    ended = run(["unshare", "-m", "bash", "-c", small_disk + "\nexit 99"])
    result(title, problems_of(ended, IO, ["pack: out/result: No space left on device"]))
if os.getuid():
    os.mkdir("locked", 0o500)
    refused("a directory that cannot be written is refused", CANNOT_CREATE, ["pack"],
            "locked/x.h5: Permission denied", output=("-o", "locked/x.h5"))
else:
    result("a directory that cannot be written is refused", [], "root may write anywhere")
refused_in_shell("a closed standard output is reported", IO, "$BIN/pack >&-",
                 "pack: standard output: Bad file descriptor")
refused_in_shell("a closed pipe is reported", IO,
                 'set -o pipefail; $BIN/pack --set "counts=[20,20,20]" | true',
                 "pack: standard output: Broken pipe")
refused_in_shell("an error in the first program of a pipe is the only whole story", BAD_DATA,
                 "$BIN/pack --set radius=0 | $BIN/tessellate -o out/result",
                 "pack: pack.radius: must be > 0 m, got 0",
                 "tessellate: standard input: is empty")
def has_terminals():
    try:
        for end in os.openpty():
            os.close(end)
        return bool(shutil.which("script"))
    except OSError:
        return False


if has_terminals():
    ended = run(["script", "-qec", f"{BIN}/pack", "/dev/null"])
    shown = ended.stdout.decode().split("\r\n")
    result("binary output is not written to a terminal",
           [] if ended.returncode == USAGE and shown ==
           ["pack: standard output is a terminal: name a file with -o, or pipe it", ""]
           else [f"status {ended.returncode}, shown {shown}"])
    ended = run(["script", "-qec", f"{BIN}/dry -o out/drying", "/dev/null"])
    shown = ended.stdout.decode().split("\r\n")
    result("binary input is not read from a terminal",
           [] if ended.returncode == USAGE and shown ==
           ["dry: standard input is a terminal: name a file, or pipe it", ""]
           else [f"status {ended.returncode}, shown {shown}"])
else:
    result("binary output is not written to a terminal", [], "no terminal to be had, or no program `script`")

# Hours before it is written.
os.symlink("nowhere/x", "astray")
for place, line in [("", ": No such file or directory"), ("astray", "astray: No such file or .*"),
                    ("out", "out: is a directory")]:
    for option in ["-o", "--checkpoint"]:
        refused(f"{option} '{place}' is refused at once", CANNOT_CREATE,
                ["dry", "no-such-input", option, place], line,
                output=("-o", "out/result") if option == "--checkpoint" else ())

# ---- killed while the output is on its way to the disk ----------------------------------

with open("kill.c", "w") as file:
    file.write("#include <signal.h>\n"
               "int fsync(int file) { return raise(SIGKILL) + file; }\n")
subprocess.run(["gcc", "-shared", "-fPIC", "-o", "kill.so", "kill.c"], check=True)
for kind, command in [("an artifact", ["pack"]), ("JSON", ["bridge", "--set", "radius=1e-3", "--set",
                                                            "volume=1e-12"])]:
    for there in [True, False]:
        where = "out/result" if there else "out/new"
        ended = run([*command, "-o", where], env=os.environ | {"LD_PRELOAD": "./kill.so"})
        result(f"killed while {kind} is synced: {'what was there' if there else 'nothing'} is left",
               problems_of(ended, -signal.SIGKILL, []))

# ---- signals ----------------------------------------------------------------------------

def interrupted(name):
    """Sends the signal while dem-replay computes, which it would for hours."""
    command = [f"{BIN}/dem-replay", "forces", "-o", "out/result", "--set", "cycles=1000000000",
               "--set", "time_step_safety=0.02"]
    run(["true"])
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    time.sleep(0.5)
    process.send_signal(getattr(signal, name))
    out, error = process.communicate(timeout=10)
    ended = subprocess.CompletedProcess(command, process.returncode, out, error)
    result(f"{name} ends a run by the signal and leaves no half file",
           problems_of(ended, -getattr(signal, name), []))


for name in ["SIGINT", "SIGTERM", "SIGHUP"]:
    signal.signal(getattr(signal, name), signal.SIG_DFL)  # ignored in the background of a shell
    interrupted(name)

done()
