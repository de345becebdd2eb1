#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input (tests/refusals.py): motions and parameters that shearstats refuses."""
import sys

import numpy as np

sys.path.insert(0, "tests")
from motions import Contacts, write_motion
from refusals import BAD_DATA, done, refused
from tap import sets

GRAINS = np.array([[0.0, 0, 0], [1, 0, 0], [2, 1, 0.5]])


def motion(name, snapshots=2, **more):
    return write_motion(name, np.tile(GRAINS, (snapshots, 1, 1)), np.tile(GRAINS, (snapshots, 1, 1)), 0.5, 1.0,
                        **more)


def refuse(title, message, *settings, source="good", status=BAD_DATA):
    refused(title, status, ["shearstats", "-q", *sets(*settings), source], message)


motion("good", lower=(-9,) * 3, upper=(9,) * 3, walls=[(0, 0, 0)])
refuse("a packing is no motion", "packing: must be a motion, is a packing.*", source="packing")
refuse("no snapshot in the window",
       "good: /snapshots/time: none of 2 snapshots is in the window: time.from and time.to choose it",
       "time.from=5")
refuse("a window that ends before it begins",
       "shearstats.time.to: must not be before time.from, 1 s, got 0", "time.from=1", "time.to=0")
refuse("an axis without direction", r"shearstats.axis.direction: must not be \[0,0,0\]",
       "axis.direction=[0,0,0]")
refuse("a grid upside down", "shearstats.grid.upper: must be above grid.lower, got 1 not above 2",
       "grid.lower=[0,0,2]", "grid.upper=[1,0,1]")
refuse("cells far finer than the smoothing length",
       "good: shearstats.grid.spacing: must be at least a twentieth of the smoothing length, 0.5 m, "
       "got 0.01", "grid.spacing=0.01")
refuse("too many cells",
       r"good: shearstats.grid.spacing: gives 8e\+09 cells, 2e\+06 at most: make it larger, or divide "
       "fewer axes .grid.along.", "smoothing_length=0", "grid.spacing=0.001", "coordinates=cartesian",
       "grid.lower=[-1,-1,-1]", "grid.upper=[1,1,1]")
refuse("a cell that does not turn", "shearstats.cell.rate: must not be 0: nothing turns", "cell.rate=0")
refuse("a cell without an axis",
       "shearstats.cell.rate: a cell has an axis: coordinates must be cylindrical", "cell.rate=1",
       "coordinates=cartesian")
refuse("levels upside down", "shearstats.cell.upper: must be above cell.lower, 2 m, got 1", "cell.rate=1",
       "cell.lower=2", "cell.upper=1")
refuse("a bed lower than two diameters",
       "good: shearstats.cell.upper: the levels end at .* m, below their start at 1: the bed is too low, "
       "give cell.lower and cell.upper", "cell.rate=1")
refuse("a wall that is not there",
       "good: shearstats.cell.walls: 'lid' is not there, or there are too many: names are those of the "
       "motion's scene, or numbers from 0", "cell.rate=1", "cell.lower=0", "cell.upper=1",
       "cell.walls=lid")
refuse("a group that is not there", "good: shearstats.cell.groups: '3' is not there, .*", "cell.rate=1",
       "cell.lower=0", "cell.upper=1", 'cell.groups="3"')
refuse("an unknown key", "shearstats.cell.rte: unknown key; the nearest known one is cell.rate.*",
       "cell.rte=1")
motion("still", driven=[1, 1, 1])
refuse("grains that are all driven", "still: /particles/driven: no grain moves freely", source="still")
motion("wall", contacts=[Contacts([(0, -2)], [(0, 0, 1)], [(0, 0, 0)]), Contacts()], walls=[(0, 0, 0)])
refuse("a wall beyond the last",
       "wall: /contacts/particles: row 0: must be a grain and another, or -1-w for one of 1 walls, got 0 "
       "and -2", source="wall")
motion("twice", contacts=[Contacts([(1, 1)], [(0, 0, 1)], [(0, 0, 0)]), Contacts()])
refuse("a grain that touches itself", "twice: /contacts/particles: row 0: .* got 1 and 1", source="twice")
motion("none", snapshots=0)
refuse("no snapshots at all", "none: /snapshots/time: none of 0 snapshots is in the window.*",
       source="none")
motion("round", periodic=(1, 0, 0), lower=(-1, -1, -1), upper=(3, 3, 3))
refuse("a cylinder in a box that repeats",
       "round: /domain/periodic: the box repeats: coordinates must be cartesian", source="round")
done()
