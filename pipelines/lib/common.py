# SPDX-License-Identifier: GPL-3.0-or-later
"""What the programs of pipelines/ share: the words they are called with, the artifacts they read
(with h5py; documents as JSON), tables in Markdown, and pictures that gnuplot draws."""
import json
import math
import os
import re
import subprocess
import sys
import tempfile

# h5py and numpy take longer to load than all else: only what uses them does that.

LIBRARY = os.path.dirname(os.path.realpath(__file__))
BIN = os.environ.get("BIN") or os.path.realpath(f"{LIBRARY}/../../build/bin")
PROGRAM = os.path.realpath(sys.argv[0])


def refuse(status, message):
    """Ends the program with a line."""
    print(f"{'/'.join(PROGRAM.split('/')[-2:])}: {message}", file=sys.stderr)
    raise SystemExit(status)


def arguments(said, most=None):
    """The words the program was called with. SAID, its description, begins with how it is used,
    up to a colon: `...` stands for more words, [brackets] hold what may be left out. Called with
    fewer words, or more (or more than MOST), the program says so and ends (64)."""
    usage = said.partition(":")[0]
    wanted, given = usage.split()[1:], sys.argv[1:]
    least = sum(not re.fullmatch(r"\[[^]]*\](\.\.\.)?", word) for word in wanted)
    most = most or (len(given) if "..." in usage else len(wanted))
    if not least <= len(given) <= most:
        print(f"Usage: {sys.argv[0]} {usage.split(maxsplit=1)[1]}", file=sys.stderr)
        raise SystemExit(64)
    return given


# ---- artifacts --------------------------------------------------------------------------

def artifact(path, kind=None):
    """The artifact at PATH, an open h5py.File; ends (66, 65) where there is none of this KIND."""
    if not os.path.exists(path):
        refuse(66, f"{path}: no such file")
    import h5py
    try:
        file = h5py.File(path)
        schema = bytes(file.attrs["schema"]).decode()
    except (OSError, KeyError):
        refuse(65, f"{path}: is not an artifact")
    if kind and not schema.startswith(f"craquelure/{kind}/"):
        refuse(65, f"{path}: is not a {kind}")
    return file


def copy_groups(source, target, without=()):
    """All of the artifact SOURCE but its attributes and the groups WITHOUT, into the file TARGET; not /VTKHDF
    either, whose links would bring the old arrays along."""
    for name in source:
        if name not in ("VTKHDF", *without):
            source.copy(name, target)


def parameters(file):
    """Of the stage that made FILE."""
    return json.loads(file.attrs["parameters"])


def summary(file):
    """The numbers that FILE comes down to, by name."""
    return file["summary"].attrs


def document(path):
    """What the JSON document at PATH holds."""
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def titled(word):
    """TITLE and FILE of a word [TITLE=]FILE."""
    title, _, file = word.partition("=") if "=" in word else ("", "", word)
    return title, file


# ---- tables -----------------------------------------------------------------------------

def number(x):
    """X with as many digits as it takes."""
    return f"{x:.17g}" if x == int(x) else repr(float(x))


def rounded(x, digits=0):
    """X to so many digits behind the point, halves away from zero, without zeros at the end."""
    scale = 10.0 ** digits
    return number(math.copysign(math.floor(abs(x) * scale + 0.5), x) / scale)


def with_unit(x, unit):
    """5e-7 m -> 500 nm"""
    k = 0 if x else 6
    while k < 8 and x >= 0.9995 * 10.0 ** (3 * k - 15):
        k += 1
    return f"{x / 10.0 ** (3 * k - 18):.3g} {['a', 'f', 'p', 'n', 'µ', 'm', '', 'k', 'M'][k]}{unit}"


def spread(values, digits=4):
    """Mean and, of several values, standard deviation."""
    import numpy as np
    said = f"{np.mean(values):.{digits}f}"
    return f"{said} ± {np.std(values, ddof=1):.{digits}f}" if len(values) > 1 else said


def row(*cells):
    """A line of a Markdown table."""
    return f"| {' | '.join(map(str, cells))} |"


def write(out, *lines):
    """The LINES to the file OUT."""
    with open(out, "w", encoding="utf-8") as file:
        file.write("".join(f"{line}\n" for line in lines))


# ---- pictures ---------------------------------------------------------------------------

def colour(name):
    """As style.gp has it: "#rrggbb"."""
    with open(f"{LIBRARY}/style.gp", encoding="utf-8") as file:
        return next(line.split('"')[1] for line in file if line.startswith(f'{name} = "'))


def text_of(table):
    """Rows of numbers, one a line; None is a blank line, a string a line as it is."""
    def line(cells):
        if cells is None or isinstance(cells, str):
            return cells or ""
        return " ".join(f"{x:.9g}" for x in cells)
    return "".join(f"{line(cells)}\n" for cells in table)


def segments(first, last):
    """The lines between rows of FIRST and of LAST, for text_of."""
    for a, b in zip(first, last):
        yield from (a, b, None)


def circle(x, y, radius):
    """A polygon of 24 sides, for text_of."""
    import numpy as np
    turn = 2 * np.pi * np.arange(25) / 24
    return [*np.column_stack([x + radius * np.cos(turn), y + radius * np.sin(turn)]), None]


def literal(value):
    """As gnuplot reads it."""
    return repr(float(value)).replace("nan", "NaN") if isinstance(value, float) else repr(value)


def plot(tables, script=None, **variables):
    """What gnuplot makes of TABLES, rows by name, with the SCRIPT (PROGRAM.gp), where they are
    files of the folder `tables`; VARIABLES are numbers or strings of the script."""
    with tempfile.TemporaryDirectory() as folder:
        for name, table in tables.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text_of(table))
        settings = "".join(f"{name} = {literal(value)};" for name, value in {"tables": ".", **variables}.items())
        drawn = subprocess.run(["gnuplot", "-e", settings, f"{LIBRARY}/style.gp", script or f"{PROGRAM}.gp"],
                               cwd=folder, stdout=subprocess.PIPE, env={**os.environ, "LC_ALL": "C"})
    if drawn.returncode:
        refuse(70, f"gnuplot failed ({drawn.returncode})")
    return drawn.stdout


def draw(out, tables, script=None, **variables):
    """The picture of `plot` to the file OUT."""
    picture = plot(tables, script, **variables)
    with open(out, "wb") as file:
        file.write(picture)
