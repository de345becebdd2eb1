#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Programs of pipelines/ that are given a file and nothing else say how they are used (64), and
# the file, which might be taken for what they write, stays as it was.
import os
import subprocess
import sys

sys.path.insert(0, "tests")
from tap import done, ok, read, scratch

programs = sorted(path for folder, _, files in os.walk("pipelines") for path in
                  (os.path.join(folder, name) for name in files) if os.access(path, os.X_OK))
ok(len(programs) > 30, "there are programs", programs)
with scratch() as folder:
    kept = os.path.join(folder, "kept")
    for program in programs:
        with open(kept, "w", encoding="utf-8") as file:
            file.write("precious\n")
        said = subprocess.run([program, kept], stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, timeout=20)
        is_kept = read(kept) == b"precious\n" and os.listdir(folder) == ["kept"]
        ok(said.returncode == 64 and not said.stdout and "Traceback" not in said.stderr and is_kept,
           f"{program} with one argument", f"{said.returncode} {said.stderr}")
said = subprocess.run(["pipelines/run/picture", "a", "b", "c"], capture_output=True, text=True)
ok(said.returncode == 64 and said.stderr == "Usage: pipelines/run/picture RUNDIR OUT.svg\n",
   "or with one too many", f"{said.returncode} {said.stderr}")
done()
