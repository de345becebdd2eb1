# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard cases of packings by moving grains."""
import json
import os
import re

import numpy as np

from cases import case, must


def words(**settings):
    """As arguments; __ stands for a dot in the names."""
    return [word for key, value in settings.items()
            for word in ("--set", f"{key.replace('__', '.')}={json.dumps(value)}")]


def moved_packing(scene, *arguments, **more):
    """Places and radii that a run of pack leaves, which must be finite and in their box."""
    scene.stage("pack", "-q", *arguments, **more)
    place, radius = scene.get("pack", "particles/position"), scene.get("pack", "particles/radius")
    must(np.isfinite(place).all() and np.isfinite(radius).all(), "numbers that are not finite")
    lower, upper = scene.get("pack", "domain/lower"), scene.get("pack", "domain/upper")
    slack = 1e-2 * radius.max()  # contacts with walls overlap
    must((place >= lower - slack).all() and (place <= upper + slack).all(), "a grain got lost")
    return place, radius


@case("pack-ratio-50")
def pack_ratio_50(scene):
    _, radius = moved_packing(scene)
    must(len(radius) == scene.json["pack"]["count"], f"{len(radius)} grains")
    ratio = radius.max() / radius.min()
    must(abs(ratio / 50 - 1) < 1e-12, f"radii 1:{ratio}")
    ends = scene.summary("pack", "unbalanced_ratio")
    must(ends < 1e-4, f"unbalanced ratio {ends:.1e}")
    most, porosity = scene.summary("pack", "max_overlap"), scene.summary("pack", "porosity")
    must(most < 0.01, f"overlap {most}")
    must(0.3 < porosity < 0.5, f"porosity {porosity}")
    return f"porosity {porosity:.3f}, largest overlap {most:.4f}, unbalanced {ends:.1e}"


@case("pack-scale")
def pack_scale(scene):
    given = scene.json["pack"]
    methods = ["deposition", "radius_expansion", "explosive_repulsion"]
    for method in methods:
        seen = []
        for factor, gravity in ((1, 9.81), (2.0**-8, 9.81), (2.0**32, 9.81), (1, 4 * 9.81)):
            sizes = {f"sizes__{end}": given["sizes"][end] * factor
                     for end in ("smallest", "largest")}
            place, radius = moved_packing(scene, *words(
                method=method, radius=given["radius"] * factor, dynamics__gravity=gravity,
                upper=[x * factor for x in given["upper"]], **sizes))
            bonds = scene.get("pack", "bonds/particles")
            ratio = scene.summary("pack", "unbalanced_ratio")
            seen.append(b"".join(np.ascontiguousarray(part).tobytes() for part in (
                place / factor, radius / factor, bonds, np.float64(ratio))))
        same = [k for k, bytes_ in enumerate(seen) if bytes_ == seen[0]]
        must(len(same) == len(seen), f"{method}: only runs {same} are the same")
    return f"{given['count']} grains by {', '.join(methods)}: the same bytes"


@case("pack-one-place")
def pack_one_place(scene):
    place, radius = moved_packing(scene, input=scene.grains)
    must(len(radius) == 10 and np.abs(radius / 0.1 - 1).max() < 1e-15,
         f"{len(radius)} grains of {radius.min()} to {radius.max()} m")
    apart = np.linalg.norm(place[:, None] - place[None], axis=2)[np.triu_indices(10, 1)]
    must(apart.min() > 0.2 * (1 - 1e-2), f"centres {apart.min() / 0.2:.3f} diameters apart")
    must(len({tuple(x) for x in place}) == 10, "grains still in one place")
    return f"nearest centres {apart.min() / 0.2:.3f} diameters apart"


@case("pack-few")
def pack_few(scene):
    radius = scene.json["pack"]["radius"]
    place, size = moved_packing(scene, *words(method="deposition", upper=[3, 3, 3]))
    overlap = 1 - place[0, 2] / radius  # of the floor
    must(len(place) == 1 and 0 < overlap < 0.01, f"dropped it lies at {place[0, 2]} m")
    place, size = moved_packing(scene, *words(method="radius_expansion", upper=[3, 3, 3]))
    fills = size[0] / 1.5
    must(len(size) == 1 and 1 <= fills < 1.01 and np.abs(place - 1.5).max() < 0.02,
         f"expanded in a box of half width 1.5 m: radius {size[0]} m at {place[0]}")
    place, _ = moved_packing(scene, *words(method="explosive_repulsion", upper=[3, 3, 3]))
    must(len(place) == 1, "lost")
    for method in ("deposition", "radius_expansion", "domain_contraction",
                   "explosive_repulsion"):
        reason = scene.refused("pack", 65, "pack.count: must be from 1",
                               *words(method=method, count=0))
    return f"floor pressed by {overlap:.1e} radii, box filled to {fills:.4f}; none: {reason}"


@case("pack-too-small")
def pack_too_small(scene):
    moves = "deposition", "radius_expansion", "domain_contraction", "explosive_repulsion"
    all_sides = dict(periodic=[True] * 3)
    for method in moves:
        more = all_sides if method == "domain_contraction" else {}
        scene.refused("pack", 65, "must leave room for a grain of radius 1 m",
                      *words(method=method, upper=[3, 3, 1.9], **more))
    for method in ("explosive_repulsion", "random_sequential"):
        reason = scene.refused("pack", 65, "30 grains would fill 4.65 of the domain",
                               *words(method=method))
    for method in moves:  # an image of a grain would touch the grain
        sides = [True, True, method != "deposition"]
        scene.refused("pack", 65, "box of at least .* repeats|periodic box is .* at least",
                      *words(method=method, count=1, upper=[2.1] * 3, periodic=sides))
    return reason


@case("pack-step-limit")
def pack_step_limit(scene):
    limits = []
    for method in ("deposition", "radius_expansion"):
        past = words(method=method, dynamics__time_step_safety=1)
        reason = scene.refused("pack", 3, "past the stability limit of .* must be below", *past)
        limit = float(re.search(r"must be below ([0-9.e-]+)", reason)[1])
        limits.append(limit)
        for part in (0.5, 0.98):  # the limit is rounded as printed
            status, message = scene.try_stage("pack", "-q", *words(
                method=method, dynamics__time_step_safety=part * limit))
            left = os.path.exists(scene.at("pack"))
            must(left == (status == 0), f"{method}, {part}: exit {status}: {message}")
            must(status == 0 or (part > 0.5 and status == 3 and "diverged" in message),
                 f"{method}, {part} of the limit: exit {status}: {message}")
            if left:
                must(np.isfinite(scene.get("pack", "particles/position")).all(),
                     "numbers that are not finite")
                os.remove(scene.at("pack"))
    return f"limits at safety {limits[0]:.3g} and {limits[1]:.3g}"
