#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input (tests/refusals.py): scenes that simulate refuses, or ends with status 3."""
import json
import sys

sys.path.insert(0, "tests")
from refusals import BAD_DATA, UNSTABLE, done, refused, result, run, text_file

GLASS = {"density": 2500, "young_modulus": 1e7}


def scene(title, section, message, status=BAD_DATA, source="packing"):
    scene.number += 1
    name = text_file(f"scene{scene.number}", json.dumps({"simulate": {
        "duration": 1e-7, "gravity": [0, 0, 0], "materials": {"glass": GLASS}, **section}}))
    refused(title, status, ["simulate", "-q", "-p", name, source], message.replace("SCENE", name))


scene.number = 0
scene("no time is refused", {"duration": None}, r"SCENE: simulate\.duration: must be a number, got null")
scene("no material is refused", {"materials": {}}, r"simulate\.materials: none is given: .*")
scene("a material that Hertz cannot use", {"materials": {"glass": {}}},
      r"simulate\.materials\.glass\.young_modulus: must be given with law=hertz")
scene("a linear material without stiffness", {"law": "linear"},
      r"simulate\.materials\.glass\.normal_stiffness: must be given with law=linear")
scene("timed contacts without their time", {"law": "timed"},
      r"simulate\.contact_time: must be given with law=timed")
scene("exact bridges in every cycle are refused", {"bridges": {"volume": 1e-12, "model": "exact"}},
      r".*bridges\.model=exact is too slow for each bridge in each cycle: bridges\.model=table interpolates the same .*")
scene("adhesion with liquid is refused", {"adhesion": 0.1, "bridges": {"volume": 1e-12}},
      r"simulate\.adhesion: must be 0 with liquid bridges .*")
scene("adhesion of springs that are no Hertz contacts is refused", {
    "adhesion": 0.1, "law": "linear", "materials": {"glass": {"normal_stiffness": 100}}},
      r"simulate\.adhesion: must be 0 .*without law=hertz")
scene("an unknown key of a named object", {"walls": {"floor": {"point": [0, 0, 0], "frction": 1}}},
      r"SCENE: simulate\.walls\.floor\.frction: unknown key; the nearest known one is friction")
scene("a wall that is no object", {"walls": {"floor": 3}},
      r"SCENE: simulate\.walls\.floor: must be an object, got 3")
scene("walls that are a list", {"walls": [{"point": [0, 0, 0]}]},
      r"SCENE: simulate\.walls: must be an object of named objects, got \[.*")
scene("a wall without a place", {"walls": {"floor": {}}},
      r"SCENE: simulate\.walls\.floor\.point: must be given: it has no default")
scene("a cylinder without a radius", {"walls": {"drum": {"shape": "cylinder", "point": [0, 0, 0]}}},
      r"simulate\.walls\.drum\.radius: must be given")
scene("a servo without a speed", {"walls": {"lid": {"point": [0, 0, 1], "servo": {"force": 1}}}},
      r"simulate\.walls\.lid\.servo\.largest_speed: must be given: .*")
scene("a servo of force and pressure",
      {"walls": {"lid": {"point": [0, 0, 1], "servo": {"force": 1, "pressure": 1, "largest_speed": 1}}}},
      r"simulate\.walls\.lid\.servo: give force or pressure, not both")
scene("a servo of a sphere",
      {"walls": {"ball": {"shape": "sphere", "radius": 1, "point": [0, 0, 1],
                          "servo": {"force": 1, "largest_speed": 1}}}},
      r"simulate\.walls\.ball\.servo: only planes have one")
scene("times that fall", {"walls": {"lid": {"point": [0, 0, 0], "motion": {"times": [1, 0], "factors": [1, 1]}}}},
      r"simulate\.walls\.lid\.motion\.times: must rise, got 0 after 1")
scene("times without factors", {"walls": {"lid": {"point": [0, 0, 0], "motion": {"times": [1]}}}},
      r"simulate\.walls\.lid\.motion: needs as many factors as times, got 0 and 1")
scene("a material that is not there", {"walls": {"lid": {"point": [0, 0, 0], "material": "steel"}}},
      r"simulate\.walls\.lid\.material: there is no material steel")
scene("two materials and no choice", {"materials": {"a": GLASS, "b": GLASS}},
      r"simulate\.material: grain 0 has none: name one of the 2 materials, here or in its group")
scene("a pair of materials that are not there", {"pairs": {"both": {"first": "glass", "second": "ice"}}},
      r"simulate\.pairs\.both: there is no material ice")
scene("two groups that want one grain", {"groups": {"a": {"grains": [3]}, "b": {"grains": [3]}}},
      r"simulate\.groups\.b: grain 3 is in group a already")
scene("a group without grains", {"groups": {"a": {"lower": [1, 1, 1]}}},
      r"simulate\.groups\.a: no grain has its centre there")
scene("a grain that is not there", {"groups": {"a": {"grains": [1e6]}}},
      r"simulate\.groups\.a\.grains: there is no grain 1e\+06 among \d+")
scene("a velocity of a group that nothing drives", {"groups": {"a": {"grains": [3], "velocity": [0, 0, 1]}}},
      r"simulate\.groups\.a: velocity, spin and motion are for driven=true; .*")
scene("a driven group with an initial velocity", {"groups": {"a": {"grains": [3], "driven": True, "initial": {"velocity": [0, 0, 1]}}}},
      r"simulate\.groups\.a\.initial: must be null or 0 with driven=true, .*")
for title, section, message in [
        ("a stiffness beside Hertz contacts", {"materials": {"glass": {**GLASS, "normal_stiffness": 100}}},
         r"materials\.glass\.normal_stiffness: must be left out without law=linear, got 100\.0"),
        ("a modulus of linear contacts", {"law": "linear", "materials": {"glass": {**GLASS, "normal_stiffness": 100}}},
         r"materials\.glass\.young_modulus: must be left out without law=hertz, got 1e7"),
        ("a time of contacts that have none", {"contact_time": 1e-6},
         r"contact_time: must be left out without law=timed, got 1e-6"),
        ("a pair that rebounds by damping ratios",
         {"law": "linear", "materials": {"glass": {"normal_stiffness": 100}},
          "pairs": {"both": {"first": "glass", "second": "glass", "restitution": 0.5}}},
         r"pairs\.both\.restitution: must be left out with law=linear: .*, got 0\.5"),
        ("a row of forces without forces", {"forces": {"row": 3}},
         r"forces\.row: must be left out without a second input, of forces, got 3"),
        ("a strength of no bonds", {"bond": {"normal_strength": 1e5}},
         r"bond\.normal_strength: must be left out with bond\.kind=none, got 100000\.0"),
        ("a force on bonds that break by stress", {"bond": {"kind": "parallel", "contact_strength": 1}},
         r"bond\.contact_strength: must be left out with bond\.kind=parallel, got 1\.0"),
        ("a friction of no walls", {"box": {"friction": 0.1}},
         r"box\.friction: must be left out without box\.walls, got 0\.1"),
        ("a round plane", {"walls": {"floor": {"point": [0, 0, 0], "radius": 1}}},
         r"walls\.floor\.radius: must be left out with shape=plane or block, got 1\.0"),
        ("grains outside of a plane", {"walls": {"floor": {"point": [0, 0, 0], "outside": True}}},
         r"walls\.floor\.outside: must be left out with shape=plane or block, got true"),
        ("a speed of a wall without a servo", {"walls": {"floor": {"point": [0, 0, 0], "servo": {"largest_speed": 1}}}},
         r"walls\.floor\.servo\.largest_speed: must be left out without servo\.force or servo\.pressure, got 1\.0"),
        ("a block that is turned", {"walls": {"step": {"shape": "block", "half_edge": [1, 1, 1], "point": [0, 0, -2],
                                                       "normal": [0, 1, 1]}}},
         r"walls\.step\.normal: must be left out with shape=sphere or block, got \[0,1,1\]")]:
    scene(title, section, r"simulate\." + message)
unused = run(["simulate", "-q", "packing", "-o", "motion", *(word for setting in [
    "duration=1e-9", 'materials={"glass":{"young_modulus":1e7}}', "bond.normal_strength=16000", "forces.factor=1.0",
    'walls={"ball":{"shape":"sphere","radius":1,"point":[0,0,-2],"normal":[0,0,1.0],"outside":true}}',
] for word in ("--set", setting))])
result("what nothing uses may say its default", unused.stderr.decode().splitlines())
scene("a ring without a ring", {"box": {"walls": ["-z"]},
                                "walls": {"ring": {"shape": "ring", "point": [0, 0, 0], "radius": 1, "inner_radius": 2}}},
      r"packing: simulate\.walls\.ring: needs a radius > 0 and an inner one below it, got 1 and 2")
scene("a wall through grains", {"walls": {"floor": {"point": [0, 0, 1e-6]}}},
      r"packing: simulate\.walls\.floor: grain \d+ begins in it, by \S+ of its radius, at \(.*\) m")
scene("a box that is strained and does not repeat", {"box": {"strain_rate": [0, 0, 1]}},
      r"simulate\.box\.strain_rate: the box does not repeat along z: let walls move there")
scene("a time step past stability", {"time_step": 1e-3},
      r"packing: time step \S+ s is past the stability limit .*", UNSTABLE)
scene("a wall that crushes grains",
      {"duration": 2e-5, "walls": {"lid": {"point": [0, 0, 5.0e-6], "normal": [0, 0, -1],
                                           "velocity": [0, 0, -0.3]}},
       "box": {"walls": ["-z"]}},
      r"packing: at \S+ s two grains overlap by \S+ mean radii, above largest_overlap=0\.5, under a mean "
      r"pressure of \S+ Pa: stiffer grains, or walls that close in less", UNSTABLE)
scene("adhesion that crushes grains", {"adhesion": 1, "duration": 1e-5},
      r"packing: at \S+ s two grains overlap by .* Pa: stiffer grains, less adhesion, or walls that close in less", UNSTABLE)
done()
