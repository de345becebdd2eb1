# SPDX-License-Identifier: GPL-3.0-or-later
"""What others found for flow through packed spheres."""


def sauter_diameter(radius):
    return 2 * (radius**3).sum() / (radius**2).sum()


def permeability(porosity, diameter):
    """By the fit of van der Hoef, Beetstra & Kuipers (2005) to lattice Boltzmann flow through random
    packings; for unequal spheres with their Sauter mean DIAMETER."""
    solid = 1 - porosity
    drag = 10 * solid / porosity**2 + porosity**2 * (1 + 1.5 * solid**0.5)
    return porosity * diameter**2 / (18 * solid * drag)
