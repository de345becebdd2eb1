#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input (tests/refusals.py): what `pack` is asked to make and cannot."""
import sys

sys.path.insert(0, "tests")
from refusals import BAD_DATA, UNSTABLE, done, refused
from tap import sets


def scene(title, words, *lines, status=BAD_DATA):
    """pack with WORDS, assignments between blanks."""
    refused(title, status, ["pack", *sets(*words.split())],
            *lines)


drawn, ring = "method=random_sequential", "method=poisson count=9 domain.shape=ring"
scene("a lattice of unequal grains is refused", "sizes.distribution=normal",
      "pack.sizes.distribution: must be one for a lattice")
scene("a lattice in space has no plane", "method=bcc dimensions=2",
      r"pack.dimensions: must be 3 for this lattice \(two dimensions: square, hexagonal, honeycomb\)")
scene("a triangular lattice of several layers is refused", "method=hexagonal dimensions=2",
      "pack.counts: a triangular lattice is one layer: must be 1 along y, got 5")
scene("a lattice that does not fit its periodic box is refused",
      "method=fcc radius=1 upper=[9,9,9] periodic=[true,false,false]",
      r"pack.upper: must leave a whole number of lattice cells of \S+ m along x, which "
      r"repeats, leaves 3.18\d+")
scene("a lattice of too many grains for its box is refused", "upper=[1,1,1]",
      "pack.radius: must make at most 1e8 grains")
scene("a lattice that is all cut away is refused",
      "radius=1 counts=[2,2,2] domain.cut.shape=sphere domain.cut.radius=2",
      "pack.domain.shape: must leave room for at least one grain of the lattice")
scene("a box must be given to fill", drawn, "pack.upper: must be given: the box to fill")
scene("a box upside down cannot be filled", f"{drawn} upper=[1,-1,1]",
      "pack.upper: must be above pack.lower = 0 m along y, got -1")
scene("a box too narrow for a grain is refused", f"{drawn} radius=1 upper=[9,1.9,9]",
      "pack.upper: must leave room for a grain of radius 1 m, is 1.9 m wide along y")
scene("a box too narrow for its largest grain is refused",
      f"{drawn} upper=[1,1,1] sizes.distribution=uniform sizes.smallest=0.1 "
      "sizes.largest=0.6",
      "pack.upper: must leave room for a grain of radius 0.6 m, is 1 m wide along x")
scene("more grains than the box has room for are refused at once",
      f"{drawn} radius=1 upper=[9,9,9] count=1000",
      "pack.count: must be fewer: 1000 grains would fill 5.75 of the domain, at most 1 can be")
scene("grains that find no place are counted",
      f"{drawn} radius=1 upper=[9,9,9] count=150 most_trials=100",
      r"only \d+ of 150 grains fit, a solid share of 0\.\d+: 100 trials in a row found no "
      r"place \(pack.most_trials\)", status=UNSTABLE)
scene("random points need their count", "method=poisson upper=[1,1,1]",
      "pack.count: must be given for poisson")
scene("a ring without a radius is refused", ring,
      "pack.domain.radius: must be given, for this shape")
scene("a ring without a height is refused", f"{ring} domain.radius=1",
      "pack.domain.height: must be given, for this shape")
scene("a ring inside out is refused",
      f"{ring} domain.radius=1 domain.height=1 domain.inner_radius=1",
      "pack.domain.inner_radius: must be given and below pack.domain.radius = 1 m, for a ring")
scene("a ring too narrow for a grain is refused",
      f"{ring} domain.radius=1 domain.height=1 domain.inner_radius=0.5 radius=0.3",
      "pack.domain.inner_radius: must leave room for a grain of radius 0.3 m, leaves 0.5 m")
scene("a cylinder too low for a grain is refused",
      "method=fcc radius=1 domain.shape=cylinder domain.radius=9 domain.height=1",
      "pack.domain.height: must leave room for a grain of radius 1 m, is 1 m wide along z")
scene("a cylinder in the plane is refused",
      f"{drawn} dimensions=2 domain.shape=cylinder",
      r"pack.domain.shape: must be box or sphere \(a disc\) in two dimensions")
scene("a round wall does not repeat",
      f"{drawn} domain.shape=sphere domain.radius=1 periodic=[false,false,true]",
      "pack.periodic: must be false where the wall is round")
scene("a cut that sticks out is refused",
      f"{drawn} upper=[1,1,1] domain.cut.shape=sphere domain.cut.radius=0.51",
      r"pack.domain.cut.shape: must lie wholly inside the domain \(a cylinder may go from "
      r"bottom to top\)")
scene("a cut without a radius is refused", f"{drawn} upper=[1,1,1] domain.cut.shape=cylinder",
      "pack.domain.cut.radius: must be given, for this cut")
scene("a box cut out needs its corners", f"{drawn} upper=[1,1,1] domain.cut.shape=box",
      "pack.domain.cut.upper: must be given and above pack.domain.cut.lower along x")
scene("a cylinder is not cut out of a plane",
      f"{drawn} upper=[1,1,1] dimensions=2 domain.cut.shape=cylinder domain.cut.radius=0.1",
      r"pack.domain.cut.shape: must be none, box or sphere \(a disc\) in two dimensions")
scene("a cut that leaves no room is refused",
      "method=poisson count=9 upper=[1,1,1] radius=0.4 domain.cut.shape=sphere "
      "domain.cut.radius=0.5",
      "pack.domain.cut.shape: must leave room for the grains")
scene("a spiral starts at walls",
      "method=inward_spiral upper=[1,1,1] periodic=[true,false,false]",
      "pack.periodic: must be false for inward_spiral: it starts at the walls")
scene("a spiral has no hole",
      "method=inward_spiral upper=[1,1,1] radius=0.1 domain.cut.shape=sphere "
      "domain.cut.radius=0.1",
      "pack.domain.cut.shape: must be none for inward_spiral")
few = "method=deposition count=100"
dense = "method=radius_expansion count=100 periodic=[true,true,true]"
scene("grains that fall need a count or a box", "method=deposition",
      r"pack.count: must be given, or pack.upper: the box to fill, or grains as an input \(make run IMPORT=FILE\)")
scene("they need a floor", f"{few} periodic=[true,true,true]",
      "pack.periodic: must be false along z for deposition: grains need a floor")
scene("they settle and nothing else", f"{few} target=porosity target_value=0.4",
      "pack.target: must be settled for this method, or, for explosive_repulsion, porosity")
scene("gravity upwards is refused", f"{few} dynamics.gravity=-9.81",
      r"pack.dynamics.gravity: must be > 0 m/s2, got -9.81\d*")
scene("grains too stiff to fall in time are refused at once", f"{few} dynamics.stiffness=1e150",
      r"falling \S+ m takes \S+ cycles of \S+ s, and pack.dynamics.most_cycles = 3000000 "
      r"\(.stiffness, .overlap, .gravity\)", status=UNSTABLE)
scene("a time step past stability is refused at once", f"{few} dynamics.time_step_safety=1",
      r"time step \S+ s is past the stability limit of \S+ s: time_step_safety must be below "
      r"\S+, got 1", status=UNSTABLE)
for words in [f"{few} dynamics.most_cycles=4000", f"{dense} dynamics.most_cycles=1",
              "method=explosive_repulsion count=100 dynamics.most_cycles=1"]:
    scene(f"giving up is said: {words}", words,
          r".*unbalanced ratio .*", status=UNSTABLE)
scene("a step too long for the speed of grains of 1:20, if stable, is not called unstable",
      "method=explosive_repulsion count=500 radius=1 sizes.distribution=two_mode "
      "sizes.second_radius=0.05 sizes.second_share=0.95",
      r"diverged in cycle \d+: a grain or its surface would move more than 0\.1 mean radii in "
      r"one time step of \S+ s, within the stability limit of \S+ s: too long for such a "
      r"speed: try pack.dynamics.time_step_safety=\S+", status=UNSTABLE)
scene("an extra layer above no top is refused before grains move",
      f"{dense} extra_layer=true",
      r"pack.extra_layer: must be false where there is no flat side \+z")
for words, line in [
        ("target=porosity", "must be given, for this target"),
        ("target=porosity target_value=1", "must be below 1 for a porosity, got 1"),
        ("target_value=0.3", "must be null where pack.target is settled"),
        ("target=coordination target_value=20",
         "must be below 14.9 contacts a grain, got 20"),
        ("target=coordination target_value=6 dimensions=2",
         "must be below 6 contacts a grain, got 6"),
        ("target=pressure target_value=1e6 dynamics.stiffness=1e-3",
         "must be at most 100 Pa for pack.dynamics.stiffness: grains would overlap by a "
         r"tenth, got 1e\+06")]:
    scene(f"a target out of reach is refused: {words}", f"{dense} {words}",
          f"pack.target_value: {line}")
scene("a box that repeats too soon is refused", f"{dense} upper=[1.1e-6,1e-3,1e-3]",
      r"pack.upper: must make a box of at least 1.2e-06 m along x, which repeats: 2.4 of the "
      r"largest diameter that pack.sizes allows, 5e-07 m, got 1.1e-06")
scene("as one of few grains with rare large ones", f"{dense} count=150 sizes.distribution=lognormal sizes.spread=0.6",
      r"pack.upper: must make a box of at least 1.64635e-05 m along x, .*; pack.sizes.largest cuts off larger grains")
scene("a box with walls does not close in", "method=domain_contraction count=100",
      r"pack.method: domain_contraction closes in a box that repeats along all axes "
      r"\(pack.periodic\); between walls use radius_expansion")
scene("an extra layer beside needs flat sides",
      "extra_layer=true extra_side=-x domain.shape=cylinder domain.radius=5 domain.height=9 "
      "method=random_sequential count=9 bonds=none",
      "pack.extra_layer: must be false where there is no flat side -x")
scene("an extra layer needs a top", "extra_layer=true periodic=[false,false,true]",
      r"pack.extra_layer: must be false where there is no flat side \+z")
for words, line in [
        ("uniform", "smallest: must be given, for this distribution"),
        ("power sizes.smallest=0.1", "largest: must be given, for this distribution"),
        ("uniform sizes.smallest=0.1 sizes.largest=0.1",
         "largest: must be above the smallest radius, 0.1 m, got 0.1"),
        ("normal sizes.smallest=1",
         "largest: must be above the smallest radius, 1 m, got 3.75e-07"),
        ("lognormal sizes.smallest=1 sizes.largest=2",
         "smallest: must leave something of the distribution"),
        ("two_mode", "second_radius: must be given, for two_mode"),
        ("sieve", "sieve.passing: must be as many shares as pack.sizes.sieve.radii, two or "
         "more, got 0 of 0"),
        ("sieve sizes.sieve.radii=[2,1] sizes.sieve.passing=[0,1]",
         "sieve.radii: must rise from one to the next, got 1 after 2"),
        ("sieve sizes.sieve.radii=[1,2,3] sizes.sieve.passing=[0,1,0.5]",
         "sieve.passing: must not fall from one to the next, got 0.5 after 1"),
        ("sieve sizes.sieve.radii=[1,2] sizes.sieve.passing=[0,0.9]",
         "sieve.passing: must go from 0 to 1, got 0 to 0.9"),
        ("sieve sizes.sieve.radii=[0,2] sizes.sieve.passing=[0,1]",
         r"sieve.radii: must be > 0 m, got \[0,2\]")]:
    scene(f"sizes: {words} is refused", f"{drawn} upper=[9,9,9] sizes.distribution={words}",
          f"pack.sizes.{line}")

done()
