# SPDX-License-Identifier: GPL-3.0-or-later
"""The stages as a study sees them: what each makes of what, its parameters and their ranges, and the
sections of scenes."""
import functools
import json
import os
import subprocess

from common import BIN, refuse
from schema import nearest, wrong

# Kind of artifact: stage, kinds it is made from, end of its name.
MADE = {"packing": ("pack", [], "h5"), "check": ("check", ["packing"], "json"),
        "tessellation": ("tessellate", ["packing"], "h5"), "network": ("merge-nodes", ["tessellation"], "h5"),
        "flow": ("flow", ["packing"], "h5"), "invasion": ("invade", ["network"], "h5"),
        "drying": ("dry", ["network"], "h5"), "forces": ("force-protocol", ["drying"], "h5"),
        "response": ("dem-replay", ["forces"], "h5"), "crackstats": ("crackstats", ["response", "drying"], "json"),
        "motion": ("simulate", ["packing"], "h5"), "shearstats": ("shearstats", ["motion"], "h5"),
        "rings": ("rings", ["packing"], "json")}
# What a study without liquid makes of other kinds: grains that shrink are replayed as they are packed.
WITHOUT_LIQUID = {"response": ["packing"], "crackstats": ["response"]}
STAGES = {stage: kind for kind, (stage, _, _) in MADE.items()}
# Stages that take what they lack from the section conditions.
SHARING = ("dry", "invade", "force-protocol", "dem-replay", "bridge", "rings")


def packs_at_random(section, grains):
    """Whether pack.seed changes the packing; GRAINS: the file that they come from, if there is one."""
    method = section.get("method", "cubic")
    return method == "explosive_repulsion" or not grains and method not in (
        "square", "cubic", "bcc", "fcc", "hexagonal", "honeycomb", "import")


# What draws random numbers: the seed, and whether it is used by a section where grains come from a file.
DRAWN = {"dry.throat_radius.seed": lambda s, _: s.get("throat_radius", {}).get("distribution", "network") != "network",
         "pack.seed": packs_at_random,
         "dem-replay.bond.strength.seed": lambda s, _: s.get("bond", {}).get("strength", {}).get("distribution", "one") != "one"}


def made_from(kind, liquid):
    """The kinds that KIND is made from."""
    return MADE[kind][1] if liquid else WITHOUT_LIQUID.get(kind, MADE[kind][1])


# Stages whose programs may be replaced, by the variables of make, as DRY.
REPLACED = ("pack", "tessellate", "merge-nodes", "dry", "force-protocol", "dem-replay", "crackstats", "simulate", "shearstats")


def own_program(stage):
    """The command that the user has in place of a stage, or ""."""
    return os.environ.get(stage.upper().replace("-", "_"), "") if stage in REPLACED else ""


def program(stage):
    return own_program(stage) or os.path.join(BIN, stage)


def ask(stage, *words):
    """What the stage that comes with us says."""
    said = subprocess.run([os.path.join(BIN, stage), *words], capture_output=True, text=True)
    if said.returncode:
        refuse(70, f"{stage}: {said.stderr.strip() or 'does not run: make all'}")
    return said.stdout


@functools.cache
def parameters_of(stage):
    return json.loads(ask(stage, "--schema"))


def property_of(schema, names):
    """The schema of a parameter; None: there is none, then the names there are."""
    for name in names:
        known = schema.get("properties", {})
        if name not in known or name == "comment":
            return None, known
        schema = known[name]
    return schema, schema.get("properties", {})


@functools.cache
def resolved(key):
    """The stages whose parameter KEY is, its name there, and its schema; or what is wrong, in words."""
    first, *rest = key.split(".")
    if first != "conditions" and first not in STAGES:
        return None, None, f"no such stage{nearest(first, [*STAGES, 'conditions'])}"
    if not rest:
        return None, None, "must be STAGE.KEY, as dry.liquid"
    found, known = [], {}
    for stage in SHARING if first == "conditions" else [first]:
        schema, names = property_of(parameters_of(stage), rest)
        known.update(names)
        if schema and "properties" not in schema:
            found.append((stage, schema))
    if not found:
        return None, None, f"{first} has no such parameter{nearest(rest[-1], known)}"
    return [stage for stage, _ in found], ".".join(rest), found[0][1]


def wrong_key(key):
    """What is wrong with KEY; None: nothing."""
    stages, _, said = resolved(key)
    return None if stages else said


def wrong_value(key, value):
    """What is wrong with a VALUE of KEY; None: nothing."""
    said = wrong(value, resolved(key)[2], "")
    return said and said.removeprefix(": ")


def uncommented(value):
    if isinstance(value, dict):
        return {name: uncommented(member) for name, member in value.items() if name != "comment"}
    return [uncommented(item) for item in value] if isinstance(value, list) else value


@functools.cache
def sections(path):
    """The sections of the scene at PATH, without its comments."""
    try:
        with open(path, encoding="utf-8") as file:
            scene = json.load(file)
    except OSError as error:
        refuse(66, f"{path}: {error.strerror}")
    except ValueError as error:
        refuse(65, f"{path}: is not JSON: {error}")
    if not isinstance(scene, dict):
        refuse(65, f"{path}: is not a scene, an object with a section for each stage")
    return uncommented(scene)


def own(section, name):
    """Whether the SECTION of a stage says parameter NAME itself."""
    for part in name.split("."):
        if not isinstance(section, dict) or part not in section:
            return False
        section = section[part]
    return True


def sets_of(stage, scene, values):
    """What VALUES, by key, set of a STAGE of SCENE, in the words of --set."""
    words = []
    for key, value in values.items():
        stages, name, _ = resolved(key)
        shared = key.startswith("conditions.") and own(sections(scene).get(stage), name)
        if stage in stages and not shared:
            words.append(f"{name}={value if isinstance(value, str) else json.dumps(value)}")
    return tuple(words)
