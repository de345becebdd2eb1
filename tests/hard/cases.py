# SPDX-License-Identifier: GPL-3.0-or-later
"""What the hard cases share: their names, and how one says that it fails."""
cases = {}


class Wrong(Exception):
    """What came out is not what must."""


def case(name):
    def register(function):
        cases[name] = function
        return function
    return register


def must(passes, what):
    if not passes:
        raise Wrong(what)
