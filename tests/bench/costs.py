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
    """CPU seconds of user and system, and MiB at most; what it prints is lost."""
    silent = [(os.POSIX_SPAWN_OPEN, stream, os.devnull, os.O_WRONLY, 0) for stream in (1, 2)]
    process = os.posix_spawnp(command[0], command, environment, file_actions=silent)
    _, status, usage = os.wait4(process, 0)
    if status:
        sys.exit(f"{command[0]} failed: {os.waitstatus_to_exitcode(status)}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024
