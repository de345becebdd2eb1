# SPDX-License-Identifier: GPL-3.0-or-later
"""What the programs of pipelines/ in Python share."""
import sys


def arguments(said):
    """The words the program was called with. SAID, its description, begins with how it is used,
    up to a colon: `...` stands for more words, [brackets] hold what may be left out. Called with
    fewer words, or more, the program says so and ends (64)."""
    usage = said.partition(":")[0]
    wanted, given = usage.split()[1:], sys.argv[1:]
    least = sum(not word.startswith("[") for word in wanted)
    most = len(given) if "..." in usage else len(wanted)
    if not least <= len(given) <= most:
        print(f"Usage: {sys.argv[0]} {usage.split(maxsplit=1)[1]}", file=sys.stderr)
        raise SystemExit(64)
    return given
