#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Liquid and air are said once: what the drying was told goes along to the forces, and what a
# temperature, a pressure or a humidity changes is changed with it.
import json
import os
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, "tests")
from tap import BIN, done, ok, run, scratch_paths, sets

# IAPWS-95, Wagner and Pruss (2002), table 13.1, at 20 and 60 degrees Celsius.
ROOM, WARM = 293.15, 333.15
PRESSURE = {ROOM: 2339.3, WARM: 19946.0}


def says(*command):
    """Exit status, and what went to standard error."""
    result = subprocess.run([f"{BIN}/{command[0]}", *map(str, command[1:])], capture_output=True,
                            text=True)
    return result.returncode, result.stderr


with scratch_paths() as at:
    run("pack", *sets("counts=[4,4,4]", "radius=2.5e-7"), "-o", at("p"))
    run("tessellate", at("p"), "-o", at("t"))
    run("merge-nodes", at("t"), "-o", at("n"))

    def dry(name, *how, quiet=True):
        run("dry", *sets("liquid=immobile", *how), *["--quiet"] * quiet, at("n"), "-o", at(name))
        with h5py.File(at(name)) as file:
            return file["history/rate"][0], dict(file["liquid"].attrs), dict(file["gas"].attrs)

    def forces(drying, *how):
        run("force-protocol", "--quiet", *sets(*how), at(drying), "-o", at("f"))
        with h5py.File(at("f")) as file:
            return (file["summary"].attrs["capillary_pressure"], dict(file["liquid"].attrs),
                    file.attrs["model"].decode())

    # ---- said once -------------------------------------------------------------------
    dry("water")
    other = "surface_tension=0.0223", "contact_angle=30"
    _, told, _ = dry("other", *other)
    ok(told["surface_tension"] == 0.0223 and told["contact_angle"] == 30,
       "the drying tells what it was told of its liquid")
    water, has, _ = forces("water")
    ratio = 0.0223 * np.cos(np.pi / 6) / has["surface_tension"]
    pulled, got, model = forces("other")
    ok(abs(pulled / water / ratio - 1) < 1e-14, "forces take the drying's liquid: suction is as its "
       "tension times the cosine of its angle", pulled / water / ratio - 1)
    ok(got == told and "surface tension 0.0223 N/m, contact angle 30 degrees" in model
       and "given" not in model, "and hand it on")
    status, said = says("force-protocol", "--set", "surface_tension=0.07274", at("other"), "-o", at("x"))
    ok(status == 0 and "surface_tension = 0.07274 N/m, but that of the drying is 0.0223" in said
       and "contact_angle" not in said, "who is told another tension than the drying says so", said)
    again = forces("other", "surface_tension=0.07274")
    ok("given: surface_tension = 0.07274 N/m, but that of the drying is 0.0223" in again[2], "in the model as well")
    status, said = says("force-protocol", *sets(*other), at("other"), "-o", at("x"))
    ok(status == 0 and said == "", "who is told the same says nothing", said)
    with h5py.File(at("water"), "a") as file:
        del file["liquid"]
    status, said = says("force-protocol", at("water"), "-o", at("y"))
    ok(status == 65 and "surface_tension: must be given in N/m" in said and not os.path.exists(at("y")),
       "a drying of another program may tell none: then it must be given", said)

    # ---- a scene's conditions ----------------------------------------------------------
    scene = {"conditions": {"fluid": "ethanol", "temperature": 313.15, "contact_angle": 20},
             "dry": {"liquid": "immobile"}, "dem-replay": {"cycles": 20}}
    with open(at("scene.json"), "w", encoding="utf-8") as file:
        json.dump(scene, file)
    run("dry", "-p", at("scene.json"), at("n"), "-o", at("d"))
    run("force-protocol", "-p", at("scene.json"), "--set", "steps=5", at("d"), "-o", at("f"))
    with h5py.File(at("d")) as dried, h5py.File(at("f")) as file:
        ok(dict(dried["liquid"].attrs) == dict(file["liquid"].attrs)
           and dried["liquid"].attrs["contact_angle"] == 20
           and abs(dried["liquid"].attrs["surface_tension"] / 20.72e-3 - 1) < 0.01  # Jasper (1972)
           and abs(dried["gas"].attrs["saturation_pressure"] / 17.9e3 - 1) < 0.01,  # CRC Handbook
           "ethanol at 40 degrees Celsius, by its name")
        ok("fluid: ethanol at 313.15 K" in dried.attrs["model"].decode(), "the model says so")
    effective = json.loads(run("dry", "-p", at("scene.json"), "--parameters"))
    ok(effective["fluid"] == "ethanol" and effective["contact_angle"] == 20,
       "a stage takes what all share")
    own = json.loads(run("dry", "-p", at("scene.json"), "--set", "contact_angle=10", "--parameters"))
    ok(own["contact_angle"] == 10, "and its own before that")
    bridges = sets("bridges.volume=1e-22", "bridges.contact_angle=0")
    status, said = says("dem-replay", "-p", at("scene.json"), *bridges, at("f"), "-o", at("r"))
    with h5py.File(at("r")) as file:
        model = file.attrs["model"].decode()
    ok(status == 0 and "bridges: contact_angle = 0 degrees, but that of the forces is 20" in said
       and "surface tension 0.0207" in model, "bridges are of the liquid of the forces", said + model)
    for wrong, rule in [({"surface_tensoin": 1}, "unknown key; the nearest known one is surface_tension"),
                        ({"temperature": "warm"}, 'must be a number, got "warm"'),
                        ({"relative_humidity": 40}, "must be from 0 to 1, got 40")]:
        with open(at("wrong.json"), "w", encoding="utf-8") as file:
            json.dump({"conditions": wrong}, file)
        for stage in "dry", "pack":
            status, said = says(stage, "-p", at("wrong.json"), "--parameters")
            ok(status == 65 and f"conditions.{next(iter(wrong))}: {rule}" in said,
               f"{stage} refuses {wrong} among the conditions", said)

    # ---- the first rate is D p_g M/(R T) ln((p_g - p_v)/(p_g - p_sat)) A/eps [K 3.9] -------
    fall = lambda p, gas=1e5, air=0.0: np.log((gas - air) / (gas - p))
    room, warm = dry("d")[0], dry("d", f"temperature={WARM}")[0]
    wanted = (WARM / ROOM)**0.75 * fall(PRESSURE[WARM]) / fall(PRESSURE[ROOM])
    ok(abs(warm / room / wanted - 1) < 2e-4, "60 degrees Celsius dry as much faster as D p_sat/T says",
       (warm / room, wanted))
    low = dry("d", "gas_pressure=5e3")[0]
    wanted = fall(PRESSURE[ROOM], 5e3) / fall(PRESSURE[ROOM])
    ok(abs(low / room / wanted - 1) < 2e-4 and low > 25 * room,
       "and 50 mbar, where vapour diffuses 20 times as fast", (low / room, wanted))
    humid, _, gas = dry("d", "relative_humidity=0.6")
    wanted = fall(PRESSURE[ROOM], 1e5, 0.6 * PRESSURE[ROOM]) / fall(PRESSURE[ROOM])
    ok(abs(humid / room / wanted - 1) < 1e-6 and abs(gas["vapour_pressure"] / (0.6 * PRESSURE[ROOM]) - 1) < 1e-4,
       "and air of 60 % humidity", (humid / room, wanted))
    toluene, _, gas = dry("d", "fluid=toluene", "temperature=298.15", "boundary_layer.thickness=1e-5")
    with h5py.File(at("n")) as file:
        size = file["domain/upper"][:] - file["domain/lower"][:]
    # p_sat: Lemmon and Span (2006); D p: Welty et al. (1984).
    wanted = 0.855 * 0.09214 / (8.314462618 * 298.15) * fall(3799) * size[0] * size[1] / 1e-5
    ok(abs(toluene / wanted - 1) < 0.05, "toluene evaporates as measured diffusivities have it, within 5 %",
       toluene / wanted - 1)

    # ---- what is asked about, and refused -------------------------------------------------
    def refused(title, line, *how):
        status, said = says("dry", *sets(*how), at("n"), "-o", at("z"))
        ok(status == 65 and said.count("\n") == 1 and f"dry: dry.{line}" in said
           and not os.path.exists(at("z")), title, said)

    refused("20 K is asked about", "temperature: 20 K? temperatures are in kelvin: 293.15 is 20 degrees "
            "Celsius", "temperature=20")
    refused("water at 500 K is refused, with the range", "temperature: must be from 273.15 to 383.15 K, where "
            "the saturation pressure of water is known, is 500; or give saturation_pressure in Pa",
            "temperature=500")
    refused("NMP whose density is not known", "liquid_density: must be given in kg/m3: that of nmp is not known "
            "here (docs/fluids.md)", "fluid=nmp", "temperature=353.15")
    refused("another liquid has to be described", "saturation_pressure: must be given in Pa: with fluid=other",
            "fluid=other")
    refused("humidity is that of water", "relative_humidity: is that of water vapour, but the liquid is ethanol: give the "
            "pressure of its vapour in the air, air_vapour_pressure, or leave both out for air without any",
            "fluid=ethanol", "relative_humidity=0.4")
    refused("humidity beside a vapour pressure", "relative_humidity: must be null where air_vapour_pressure is",
            "relative_humidity=0.4", "air_vapour_pressure=900")
    status, said = says("invade", "--set", "temperature=25", at("n"), "-o", at("z"))
    ok(status == 65 and "invade.temperature: 25 K?" in said, "invade asks too", said)
    status, said = says("bridge", *sets("radius=1e-3", "volume=1e-12", "temperature=25"))
    ok(status == 65 and "bridge.temperature: 25 K?" in said, "and bridge", said)
    all_given = ["fluid=other", "saturation_pressure=1e3", "diffusivity=1e-5", "molar_mass=0.1",
                 "liquid_density=1e3"]
    status, said = says("dry", *sets(*all_given), at("n"), "-o", at("z"))
    ok(status == 0 and said == "", "another liquid that is described dries, without a word", said)
    status, said = says("dry", *sets("fluid=nmp", "temperature=353.15", "liquid_density=975"),
                        at("n"), "-o", at("z"))
    ok(status == 0 and said == "", "and NMP, once its density is given", said)

    # ---- what is given for another temperature ---------------------------------------------
    status, said = says("dry", *sets("temperature=353.15", "saturation_pressure=2339"), at("n"),
                        "-o", at("z"))
    ok(status == 0 and "saturation_pressure = 2339 Pa was given, but water at 353.15 K has 4741" in said,
       "a saturation pressure that stays when it gets warm is told", said)
    status, said = says("dry", "--set", "fluid=ethanol", "--set", "start_saturation=0.6", at("d"), "-o", at("z"))
    ok(status == 0 and f"but that of {at('d')} is 0.0279" in said,
       "a drying that goes on with another liquid says so", said)
done()
