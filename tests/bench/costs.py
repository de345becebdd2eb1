# SPDX-License-Identifier: GPL-3.0-or-later
"""What the measuring scripts in Python share: where the programs are, and what a run costs."""
import os
import sys
import tempfile

bin_folder = os.environ.get("BIN", "build/bin")
bench_folder = os.path.join(os.path.dirname(bin_folder), "tests/bench")
folder = tempfile.TemporaryDirectory(prefix="craquelure-bench-")
environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def at(name):
    return os.path.join(folder.name, name)


def cost(*command):
    """CPU seconds of user and system, and MiB at most; what it prints is lost.

    The peak is that which `time` sees: a child of this program begins with the peak of its parent."""
    silent = [(os.POSIX_SPAWN_OPEN, stream, os.devnull, os.O_WRONLY, 0) for stream in (1, 2)]
    timed = ("/usr/bin/time", "-q", "-f", "%M", "-o", at("peak"), *command)
    process = os.posix_spawn(timed[0], timed, environment, file_actions=silent)
    _, status, usage = os.wait4(process, 0)
    if status:
        sys.exit(f"{command[0]} failed: {os.waitstatus_to_exitcode(status)}")
    with open(at("peak"), encoding="utf-8") as file:
        return usage.ru_utime + usage.ru_stime, float(file.read()) / 1024
