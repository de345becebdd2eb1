# SPDX-License-Identifier: GPL-3.0-or-later
"""Random packings that studies have in common: 1000 grains, normal radii +- 20 %, friction 0.5."""
import os
import subprocess

from common import BIN

RADIUS = 250e-9  # m, mean


def stage(name, *words, **settings):
    """What the stage NAME writes to standard output, with WORDS and, dots spelled __, SETTINGS."""
    options = [f"--set={key.replace('__', '.')}={value}" for key, value in settings.items()]
    return subprocess.run([f"{BIN}/{name}", "-q", *options, *words], stdout=subprocess.PIPE, check=True).stdout


def make(count, folder, periodic):
    """COUNT of them in FOLDER: their paths."""
    paths = [os.path.join(folder, f"packing-{seed}.h5") for seed in range(1, count + 1)]
    for seed, path in enumerate(paths, 1):
        stage("pack", "-o", path, method="radius_expansion", count=1000, radius=RADIUS, seed=seed, bonds="none",
              periodic=periodic, sizes__distribution="normal", sizes__spread=0.2,
              sizes__smallest=RADIUS / 2, sizes__largest=1.5 * RADIUS)
    return paths
