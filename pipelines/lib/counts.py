# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers as tables of statistics show them."""
import math

from common import number, rounded


def three(x):
    """X to three digits."""
    if x is None:
        return "-"
    if x == 0:
        return "0"
    power = math.floor(math.log10(abs(x)))
    if power < -4:
        return f"{rounded(x * 1e200 * 10.0 ** (-200 - power), 2)}e{power}"
    scale = 10.0 ** (2 - power)
    return number(math.copysign(math.floor(abs(x) * scale + 0.5), x) / scale)


def probability(x):
    return "< 1e-300" if x == 0 else three(x)  # too small for a number
