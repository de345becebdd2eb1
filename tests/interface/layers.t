#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# The sources have layers, and no two files call each other in a circle: tests/circles finds nothing
# here, and finds what is wrong in a small tree that was made so.
import os
import subprocess
import sys

sys.path.insert(0, "tests")
from tap import BIN, done, ok, scratch

CIRCLES = os.path.abspath("tests/circles")


def looked(tree, objects):
    """Exit status of tests/circles and its lines."""
    told = subprocess.run([CIRCLES, objects], cwd=tree, stdout=subprocess.PIPE, text=True, check=False)
    return told.returncode, told.stdout


status, told = looked(".", os.path.join(os.path.dirname(BIN), "obj"))
ok(status == 0, "no circle of calls, no arrow that climbs the layers", told)

# --- a tree with two libraries and two stages -------------------------------------------------

TABLES = {"stages/lib/README.md": "| layer | libraries |\n|--:|---|\n| 1 | `low` |\n| 2 | `high` |\n",
          "stages/two/README.md": "| layer | rooms |\n|--:|---|\n| 1 | `gas` |\n| 2 | `run` |\n"}
SOURCES = {"stages/lib/low/low.c": "int low(void);\nint low(void) { return 1; }\n",
           "stages/lib/high/high.c": "int low(void);\nint high(void);\n"
                                     "int high(void) { return low(); }\n",
           "stages/one/one.c": "int high(void);\nint one(void);\nint one(void) { return high(); }\n",
           "stages/two/gas/gas.c": "int gas(void);\nint gas(void) { return 1; }\n",
           "stages/two/run/run.c": "int gas(void);\nint run(void);\nint run(void) { return gas(); }\n",
           "stages/two/two.c": "int run(void);\nint two(void);\nint two(void) { return run(); }\n"}


def found_in(changed, title, *wanted):
    """What is said of the tree with the files of CHANGED in place of its own."""
    with scratch() as tree:
        for path, text in {**TABLES, **SOURCES, **changed}.items():
            os.makedirs(os.path.join(tree, os.path.dirname(path)), exist_ok=True)
            with open(os.path.join(tree, path), "w", encoding="utf-8") as file:
                file.write(text)
        for path in {**SOURCES, **changed}:
            made = os.path.join(tree, "build/obj", path.removesuffix(".c") + ".o")
            os.makedirs(os.path.dirname(made), exist_ok=True)
            if path.endswith(".c"):
                subprocess.run(["gcc", "-Istages/lib", "-Istages", "-c", path, "-o", made],
                               cwd=tree, check=True)
        status, told = looked(tree, "build/obj")
        ok(status == bool(wanted) and all(line in told.splitlines() for line in wanted)
           and told.count("\n") == len(wanted), title, told)


found_in({}, "a tree in order")
found_in({"stages/lib/low/low.c": "int high(void);\nint low(void);\nint low(void) { return high(); }\n"},
         "a library that uses a higher one, and so a circle",
         "circle of 2 files:",
         "    stages/lib/high/high uses low of stages/lib/low/low",
         "    stages/lib/low/low uses high of stages/lib/high/high",
         "stages/lib/low/low uses high of stages/lib/high/high: layer 2, from layer 1")
found_in({"stages/lib/high/high.h": "#define HIGH 1\n",
          "stages/lib/low/low.c": "#include \"high/high.h\"\nint low(void);\nint low(void) { return HIGH; }\n"},
         "a library that includes a higher one",
         "stages/lib/low/low.c includes stages/lib/high/high.h: layer 2, from layer 1")
found_in({"stages/one/one.c": "int two(void);\nint one(void);\nint one(void) { return two(); }\n"},
         "a stage that uses another",
         "stages/one/one uses two of stages/two/two: another stage")
found_in({"stages/two/gas/gas.c": "extern int ran;\nint gas(void);\nint gas(void) { return ran; }\n",
          "stages/two/run/ran.c": "int ran = 1;\n"},
         "a room of a stage that uses a higher one",
         "stages/two/gas/gas uses ran of stages/two/run/ran: layer 2, from layer 1")
found_in({"stages/two/gas/gas.c": "#include \"two/two.h\"\nint gas(void);\nint gas(void) { return TWO; }\n",
          "stages/two/two.h": "#define TWO 2\n"},
         "a room that uses what lies above all rooms",
         "stages/two/gas/gas.c includes stages/two/two.h: above its rooms")
found_in({"stages/two/README.md": "| 1 | `gas` |\n| 2 | `units` |\n| 3 | `run` |\n",
          "stages/two/gas/gas.c": "#include \"two/units.h\"\nint gas(void);\nint gas(void) { return UNIT; }\n",
          "stages/two/units.h": "#define UNIT 2\n"},
         "a room that uses a file which the table puts above it",
         "stages/two/gas/gas.c includes stages/two/units.h: layer 2, from layer 1")
found_in({"stages/lib/other/other.c": "int low(void);\nint other(void);\nint other(void) { return low(); }\n"},
         "a library that the table does not name",
         "stages/lib/other/other uses low of stages/lib/low/low: not both in the table of layers: "
         "stages/lib/other, stages/lib/low")
found_in({"stages/one/one.h": "int one(void);\n"}, "a function in a header that no other file uses",
         "stages/one/one.c: no other file uses one")
found_in({"stages/one/one.h": "int one(void);\n",
          "stages/one/use.c": "int one(void);\nint use(void);\nint use(void) { return one(); }\n"}, "one that another uses")
done()
