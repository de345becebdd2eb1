#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input (tests/refusals.py): grains that `pack` imports, from text and dumps."""
import sys

sys.path.insert(0, "tests")
from refusals import BAD_DATA, done, refused, text_file
from tap import sets

# ---- imported text ----------------------------------------------------------------------

def imported(title, content, line, *settings):
    refused(title, BAD_DATA,
            ["pack", "--set", "method=import", *settings, text_file("grains", content)],
            f"grains: {line}" if not settings else line)


imported("a line of three numbers is named", "0 0 0 1\n3 0 0\n",
         "line 2: must be four numbers, x y z r, or a comment, #; has 3 numbers")
imported("a line of five numbers is named", "# grains\n\n0 0 0 1 1\n",
         "line 3: must be four numbers, x y z r, or a comment, #; has 5 numbers; keep the columns x y z r alone, or name them in a line above")
imported("decimal commas are named", "1,5;2,5;0,25;0,5\n",
         "line 1: must be four numbers, x y z r, or a comment, #; has 8 numbers; commas are no decimal points here")
imported("not where commas part columns", "1.5,2.5;0.25,0.5,1\n",
         "line 1: must be four numbers, x y z r, or a comment, #; has 5 numbers; keep the columns x y z r alone, or name them in a line above")
imported("letters among the grains are refused", "0 0 0 1\n0 0 zero 1\n",
         "line 2: must be four numbers, x y z r, or a comment, #")
for heading in "x,y,z,d", "x,y,z,x,r", "x_um,y_um,z_um,r_um":
    imported(f"names of columns that are not those of grains: {heading}", f"{heading}\n0,0,0,1,1\n",
             "line 1: must be four numbers, x y z r, or a comment, #; names of columns must have x, y, z and r "
             r"\(or radius\) among them, each once \(call diameters r, and give import.diameters=true\)")
imported("an empty field in a named column is refused", "x,y,z,r\n0,0,,1\n",
         "line 2: must have a number in column z$")
imported("a line shorter than its heading is refused", "label x y z r\n1 0 0 0\n",
         "line 2: must have a number in column r$")
imported("decimal commas in named columns are named", "x;y;z;r\n1,5;0;0;1\n",
         "line 2: must have a number in column x; commas are no decimal points here")
imported("a heading alone holds no grains", "x,y,z,r\n", "no grains")
imported("a second heading is refused", "x y z r\n0 0 0 1\nx y z r\n",
         "line 3: must have a number in column x$")
imported("a negative radius in a text is refused", "0 0 0 -1\n",
         "line 1: the radius must be > 0 m, got -1")
imported("a radius of zero in a text is refused", "0 0 0 0\n",
         "line 1: the radius must be > 0 m, got 0")
imported("NaN in a text is refused", "0 nan 0 1\n", "line 1: must be finite, got -?nan")
imported("a number too large is refused", "1e999 0 0 1\n", "line 1: must be finite, got inf")
imported("null bytes in a text are refused", b"0 0 0 1\n\0\0\0",
         "holds null bytes: neither text nor HDF5")
imported("a compressed text is refused", b"\x1f\x8b\x08\0\0", "is compressed: unpack it by gunzip")
imported("a text of comments holds no grains", "# x y z r\n\n", "no grains")
imported("an empty text holds no grains", "", "no grains")
refused("an import without an input says where grains come from", BAD_DATA,
        ["pack", "--set", "method=import"],
        "standard input: no grains: method=import takes them from an input, make run from "
        "IMPORT=FILE")
imported("a box upside down is refused at import", "0 0 0 1\n",
         "pack.upper: must be above pack.lower = -1 m along z, got -2",
         "--set", "upper=[1,1,-2]")
refused("an import of a network is refused", BAD_DATA,
        ["pack", "--set", "method=import", "network"],
        "network: must be a packing, is a network")

# ---- what grains cannot be ----------------------------------------------------------------

imported("two grains in one place are refused", "0 0 0 1e-3\n1 0 0 1e-3\n0 0 0 2e-3\n",
         r"/particles/position: row 2: has the same centre as row 0 \(1 such pair\): leave "
         "duplicates out")
imported("a grain wholly outside the box is refused", "1 1 1 0.005\n1 1 2.5 0.005\n",
         r"grains: /particles/position: row 1: the grain is wholly outside the box, as 1 of 2 are: "
         "leave them out, or let pack.lower and pack.upper take them in",
         "--set", "lower=[0,0,0]", "--set", "upper=[2,2,2]")
imported("grains with more volume than their box are refused", "1 1 1 0.005\n1 1 1.01 0.005\n",
         r"grains: the porosity is -20.8: the grains have 21.8 of the volume of the box: "
         "pack.lower and pack.upper leave them no room",
         "--set", "lower=[0.999,0.999,0.999]", "--set", "upper=[1.001,1.001,1.011]")

# ---- own grains to move -------------------------------------------------------------------

for method, line in [
        ("deposition", "grains: grains overlap each other or the walls so much that they "
                       r"would fly apart .*: without overlaps they would be 0.5 of their size "
                       r"\(diameters for radii\? pack.import.diameters=true halves them; "
                       r"otherwise separate them first by pack.method=explosive_repulsion\)"),
        ("radius_expansion target=pressure target_value=1",
         r"pack.target: must not be pressure for radius_expansion of grains, .*"),
        ("domain_contraction", r"pack.method: domain_contraction closes in a box that repeats .*")]:
    refused(f"own grains by {method}: refused", BAD_DATA,
            ["pack", *sets(*f"method={method}".split()), text_file("grains", "0 0 0 1e-3\n0 0 1e-3 1e-3\n0 0 4e-3 1e-3\n")],
            line)

refused("grains that overlap less are not taken for diameters", BAD_DATA,
        ["pack", *sets("method=deposition"), text_file("grains", "0 0 0 1e-3\n0 0 1.6e-3 1e-3\n0 0 4e-3 1e-3\n")],
        r"grains: .*: without overlaps they would be 0.8 of their size \(separate them first by .*\)")

# ---- imported dumps ---------------------------------------------------------------------

def dump(*rows, columns="id x y z radius", box="BOX BOUNDS pp ff ff", bounds=("0 9",) * 3,
         count=2):
    lines = ["ITEM: TIMESTEP", "0", "ITEM: NUMBER OF ATOMS", count, f"ITEM: {box}", *bounds,
             f"ITEM: ATOMS {columns}", *rows, ""]
    return "\n".join(map(str, lines))


good = dump("1 1 1 1 1", "2 4 4 4 1")
imported("a dump without radii is refused", dump("1 1 1 1", "2 4 4 4", columns="id x y z"),
         "line 9: must be ITEM: ATOMS with a column radius or diameter")
imported("a dump without places is refused",
         dump("1 1 1", "2 4 4", columns="id x radius"),
         r"line 9: must be ITEM: ATOMS with columns x, y and z \(or xu, xs, xsu\)")
imported("a dump with places scaled in part is refused",
         dump("1 1 1 1 1", "2 4 4 4 1", columns="id xs y z radius"),
         "line 9: must be ITEM: ATOMS with all places scaled, or none")
imported("a dump of a tilted box is refused",
         dump("1 1 1 1 1", box="BOX BOUNDS xy xz yz pp pp pp", bounds=("0 9 1",) * 3),
         "line 5: must be a straight box, .*")
imported("a dump with a box upside down is refused", dump(bounds=("0 9", "9 0", "0 9")),
         "line 7: must be the box, a lower and an upper bound")
imported("a dump that ends too early is refused", dump("1 1 1 1 1"),
         "line 11: must be a grain: fewer than ITEM: NUMBER OF ATOMS says")
imported("a dump that ends before its grains is refused", "ITEM: TIMESTEP\n0\n",
         "ends before the grains of the frame")
imported("a dump without a frame is refused", "ITEM: UNITS\nsi\n",
         'no "ITEM: TIMESTEP" line')
imported("a row of a dump that is too short is refused", dump("1 1 1 1 1", "2 4 4"),
         "line 11: must be a value for each column")
imported("a word for a number in a dump is refused", dump("1 1 1 1 1", "2 4 four 4 1"),
         "line 11: must be finite numbers")
imported("a radius of zero in a dump is refused", dump("1 1 1 1 1", "2 4 4 4 0"),
         "line 11: the radius must be > 0 m, got 0")
imported("an id twice in a dump is refused", dump("7 1 1 1 1", "7 4 4 4 1"),
         "two grains have the same id")
imported("a count of atoms that is none is refused", dump(count="many"),
         "line 4: must be the number of atoms, from 1 to 1e8")
imported("a count of atoms that lies is refused", dump("1 1 1 1 1", count=99999999),
         "line 11: must be a grain: fewer than .*")
for settings, line in [
        (["frame=1"], "grains: frame: must be below 1, the frames there are, got 1"),
        (["frame=-2"], r"pack.frame: must be from -1 to 1e\+12, got -2"),
        (["domain.cut.shape=box"],
         "pack.domain.cut.upper: must be given and above pack.domain.cut.lower along x")]:
    imported(f"a dump with {settings[0]} is refused", good, line, "--set", *settings)

done()
