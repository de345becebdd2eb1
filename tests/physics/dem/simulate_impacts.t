#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""simulate against the closed forms of Chung & Ooi's eight impacts, as docs/contacts.md has them."""
import math
import sys

sys.path.insert(0, "tests")
from impacts import *
from tap import done, ok

STEPS = 2000  # a contact


def near(got, wanted, tolerance, title):
    ok(abs(got - wanted) <= tolerance, title, f"{got} for {wanted} within {tolerance}")


for name, impact in (("1: two of glass", two_spheres(GLASS)), ("1: two of limestone", two_spheres(LIMESTONE)),
                     ("2: Al on a rigid plane", onto_plane(ALUMINIUM, False)),
                     ("2: Al on Al", onto_plane(ALUMINIUM, True)),
                     ("2: Mg on a rigid plane", onto_plane(MAGNESIUM, False)),
                     ("2: Mg on Mg", onto_plane(MAGNESIUM, True))):
    got = Outcome(impact, STEPS)
    off = max(abs(got.force / impact.force - 1), abs(got.overlap / impact.overlap - 1),
              abs(got.time / impact.time - 1))
    ok(off < 1e-6, f"{name}: force, overlap and time as Hertz says, within 1e-6", off)

for e in (0.2, 0.5, 0.8, 1):
    for name, stuff in (("Al oxide", OXIDE), ("cast iron", IRON)):
        got = Outcome(rebound(stuff, e), STEPS).velocity[0, 2] / 3.9
        near(got / e, 1, 1e-5 if e > 0.7 else 1e-3, f"3: {name} rebounds with e = {e}")

# Where a contact slides throughout, friction takes mu (1 + e) of the normal speed. A spin is less
# by the arm's share, half the overlap over the radius, at most.
for angle in (40, 60, 80):
    impact = oblique(math.radians(angle))
    got, t = Outcome(impact, STEPS), math.tan(math.radians(angle))
    change, arm = 0.092 * 1.98, impact.overlap / (2 * impact.radius)
    near(got.velocity[0, 0] / impact.velocity[0], 1 - change / t, 1e-4,
         f"4: at {angle} degrees it keeps the tangential speed that sliding leaves")
    spin = 2.5 * change * -impact.velocity[1] / impact.radius
    ok(spin * (1 - arm - 1e-4) < got.spin[0] < spin * (1 + 1e-4), f"4: at {angle} degrees it spins as sliding makes it",
       (got.spin[0], spin, arm))
grips = [Outcome(oblique(math.radians(angle)), STEPS).velocity[0, 0] / oblique(math.radians(angle)).velocity[0]
         for angle in (10, 20)]
ok(all(1 - 0.092 * 1.98 / math.tan(math.radians(a)) < g < 1 for a, g in zip((10, 20), grips)),
   "4: below 32.5 degrees it sticks and loses less than by sliding", grips)

for psi in (7.124, 9.118):
    impact = at_one_normal_velocity(psi)
    got = Outcome(impact, STEPS)
    arm = impact.overlap / (2 * impact.radius)
    near(got.surface / 0.3 / got.velocity[0, 2], psi - 7, 5 * arm + 1e-3,
         f"5: at psi = {psi} the surface leaves with psi - 7, less the arm's share")

for x in (0.969, 0.551, 0.176):
    impact = spinning(2.1 / x)
    near(beta_of(impact, Outcome(impact, STEPS)), x - 1, 5e-4, f"6: at tan {2.1 / x:.3f} beta is that of sliding")

for angle in (5, 85):
    impact = opposite_spins(math.radians(angle))
    got = Outcome(impact, STEPS)
    ok(abs(got.spin[0] / impact.spin - 1) < 1e-12 and abs(got.spin[1] / -impact.spin - 1) < 1e-12 and
       abs(got.velocity[:, 0]).max() < 1e-12, f"7: spins of {impact.spin:.3g} rad/s against each other are kept",
       (got.spin, got.velocity))
    near(got.velocity[0, 2] / 0.2, 0.5, 1e-3, "7: and e = 0.5 counts along the normal")

for degrees in (65, 85):
    t = math.tan(math.radians(degrees))
    for name, heavy in (("a heavy, stiff sphere", True), ("one of the same stuff", False)):
        impact = onto_large(t, heavy)
        near(beta_of(impact, Outcome(impact, STEPS)), 2.1 / t - 1, 1e-3,
             f"8: onto {name} of five times the radius, at tan {t:.3g}, beta is that of sliding")
done()
