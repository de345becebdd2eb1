# SPDX-License-Identifier: GPL-3.0-or-later
"""What the test scripts in Python share: TAP lines, the programs, artifacts."""
import os
import re
import subprocess
import sys
import tempfile

BIN = os.environ.get("BIN") or os.path.abspath("build/bin")
SCENE = "samples/stiff-5x5x10.json"
# Water and its vapour as [K Table 3.1] has them, where a closed form needs their numbers.
WATER = ["saturation_pressure=2339", "diffusivity=2.5685e-5", "molar_mass=0.01802",
         "liquid_density=998.2", "surface_tension=0.07274"]

# K's protocol of cycles [K 4, 5.2], for dem-replay --set: so many time steps a load, at rest or not.
CYCLES = ("engine=explicit", "damping_ratio=0.7", "local_damping=0", "time_step_safety=0.045",
          "cycles=500", "ramp=0", "tolerance=null", "most_cycles=1000000", "unsettled=stop",
          "density_scaling=false", "loose_grains=keep")

count = 0
failed = 0


def ok(passes, title, detail=""):
    """One TAP line; if it fails, DETAIL on standard error, which harnesses let through."""
    global count, failed
    count += 1
    failed += not passes
    print(f"{'ok' if passes else 'not ok'} {count} - {title}")
    if not passes and str(detail):
        print(f"# {title}: {detail}".replace("\n", "\n# "), file=sys.stderr)


def done():
    """The plan, and the exit status."""
    print(f"1..{count}")
    raise SystemExit(1 if failed else 0)


def run(stage, *arguments, input=None):
    """Runs a stage; gives what it wrote to standard output, as bytes."""
    return subprocess.run([f"{BIN}/{stage}", *map(str, arguments)], input=input,
                          stdout=subprocess.PIPE, check=True).stdout


def refused(title, says, stage, *words, input=None):
    """STAGE ends with 65 and one line, which SAYS why; it writes nothing, and not what follows -o in WORDS."""
    ended = subprocess.run([f"{BIN}/{stage}", *words], input=input or b"", capture_output=True)
    said = ended.stderr.decode()
    left = ended.stdout or ("-o" in words and os.path.exists(words[words.index("-o") + 1]))
    ok(ended.returncode == 65 and says in said and said.count("\n") == 1 and not left, title, f"{ended.returncode}: {said}")


def sets(*settings):
    """The words that --set them."""
    return [word for setting in settings for word in ("--set", setting)]


def scratch():
    """A folder that goes when the test ends."""
    return tempfile.TemporaryDirectory(prefix="craquelure-test-")


class scratch_paths(tempfile.TemporaryDirectory):
    """The same; called with a name it gives the path of that in it."""

    def __init__(self):
        super().__init__(prefix="craquelure-test-")

    def __enter__(self):
        return self

    def __call__(self, name):
        return os.path.join(self.name, name)


def code_blocks(text):
    """The indented blocks of a page, in their order, without the indent."""
    for block in re.finditer(r"(?:^    .*\n|^\n(?=    ))+", text, re.M):
        yield re.sub(r"^    ", "", block[0], flags=re.M).strip("\n")


def read(path):
    with open(path, "rb") as file:
        return file.read()
