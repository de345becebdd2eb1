#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input (tests/refusals.py): files that are no artifacts, or other ones."""
import os
import sys

import numpy

sys.path.insert(0, "tests")
from refusals import (BAD_DATA, IO, NO_INPUT, READER, attribute, contents, damage, done, refused,
                      refused_in_shell, text_file)

# ---- not an artifact --------------------------------------------------------------------

refused("text is not an artifact", BAD_DATA,
        ["tessellate", text_file("text", "1 2 3 4\n")], "text: is not an HDF5 file; grains as text go to pack first")
refused("an empty file is not an artifact", BAD_DATA,
        ["tessellate", text_file("empty", "")], "empty: is empty")
refused("three bytes are not an artifact", BAD_DATA,
        ["tessellate", text_file("short", b"\x89HD")], "short: is not an HDF5 file")
refused("an input without end is refused", BAD_DATA, ["crackstats", "/dev/zero"],
        "/dev/zero: is not an HDF5 file")
for program in ["tessellate", "dry", "crackstats", "inspect", "artdiff packing"]:
    refused_in_shell(f"text without end is refused by {program}", BAD_DATA,
                     "while echo yes or no; do sleep 0.01; done |"
                     f" timeout 5 $BIN/{program} -",
                     f"{program.split()[0]}: standard input: is not an HDF5 file; grains as text go to pack first")
refused("a signature alone is not an artifact", BAD_DATA,
        ["tessellate", text_file("signature", b"\x89HDF\r\n\x1a\n")],
        "signature: is a truncated or damaged HDF5 file")
noise = numpy.random.default_rng(1).bytes(5000)
refused("random bytes behind a signature are not an artifact", BAD_DATA,
        ["tessellate", text_file("noise", b"\x89HDF\r\n\x1a\n" + noise)],
        "noise: is a truncated or damaged HDF5 file")
broken = bytearray(contents("packing"))
at = broken.rindex(broken.index(b"HEAP").to_bytes(8, "little"))  # where the names are
broken[at : at + 8] = b"\xff" * 8
refused("an address that makes the HDF5 library crash is refused", BAD_DATA,
        ["tessellate", text_file("broken", bytes(broken))], "broken: .*",
        env=os.environ | {"ASAN_OPTIONS": "handle_segv=0"})  # the crash is not ours
for kind, reader in READER.items():
    whole = contents(kind)
    for cut in (60, 800, len(whole) // 2, len(whole) - 1):
        refused(f"{reader} refuses its input cut to {cut} of {len(whole)} bytes", BAD_DATA,
                [reader, text_file("cut", whole[:cut])],
                "cut: is a truncated or damaged HDF5 file")
refused("inspect refuses a truncated artifact", BAD_DATA,
        ["inspect", text_file("cut", contents("drying")[:-9])],
        "cut: is a truncated or damaged HDF5 file", output=())
refused("pack refuses to import a truncated artifact", BAD_DATA,
        ["pack", "--set", "method=import", text_file("cut", contents("packing")[:-9])],
        "cut: is a truncated or damaged HDF5 file")
refused("truncated input is refused from a pipe as well", BAD_DATA, ["merge-nodes"],
        "standard input: is a truncated or damaged HDF5 file",
        input=contents("network")[:-9])
refused("an empty pipe is refused", BAD_DATA, ["merge-nodes", "-"],
        "standard input: is empty", input=b"")
refused("a missing input is named", NO_INPUT, ["tessellate", "nowhere.h5"],
        "nowhere.h5: No such file or directory")
refused("an input below a file is named", NO_INPUT, ["tessellate", "packing/inner.h5"],
        "packing/inner.h5: Not a directory")
refused("a directory as input is refused", IO, ["tessellate", "/tmp"],
        "/tmp: Is a directory")
refused("inspect names a missing input", NO_INPUT, ["inspect", "nowhere.h5"],
        "nowhere.h5: No such file or directory", output=())
refused_in_shell("a closed standard input is refused", IO, "$BIN/tessellate -o out/result <&-",
                 "tessellate: standard input: Bad file descriptor")

# ---- another artifact -------------------------------------------------------------------

for reader, given, first in [
        ("tessellate", "network", ""), ("merge-nodes", "packing", "tessellate"),
        ("dry", "packing", "tessellate"), ("force-protocol", "forces", ""),
        ("force-protocol", "packing", "tessellate, then dry"),
        ("dem-replay", "drying", "force-protocol"), ("crackstats", "forces", "dem-replay"),
        ("crackstats", "packing", "tessellate, then dry, then force-protocol, then dem-replay"),
        ("invade", "drying", "")]:
    wanted = {"dry": "network", "invade": "network"} | {r: name for name, r in READER.items()}
    refused(f"{reader} refuses a {given}", BAD_DATA, [reader, given],
            f"{given}: must be a {wanted[reader]}, is a {given}"
            + f": first run {first}" * bool(first))
refused("a dump is not an HDF5 file", BAD_DATA, ["tessellate", text_file("dump", "ITEM: TIMESTEP\n0\n")],
        "dump: is not an HDF5 file; grains as text go to pack first")
refused("nor a table with names of columns", BAD_DATA, ["tessellate", text_file("table", "Part,X,Y,Z,R\n1,0,0,0,1\n")],
        "table: is not an HDF5 file; grains as text go to pack first")
refused("a JSON artifact is not an HDF5 file", BAD_DATA, ["crackstats", "crackstats"],
        "crackstats: is not an HDF5 file; parameters, in JSON, go by -p")
damage("an unknown schema is named", "packing",
       attribute("/", "schema", "craquelure/soup/1"), "schema craquelure/soup/1 is unknown")
damage("a later version of a schema is refused", "packing",
       attribute("/", "schema", "craquelure/packing/2"),
       "schema craquelure/packing/2 is unknown; this program knows craquelure/packing/1")
damage("a file without a schema is not an artifact", "packing",
       attribute("/", "schema", None), "is not an artifact: it has no schema attribute")
damage("a schema that is a number is none", "packing", attribute("/", "schema", 7),
       "is not an artifact: it has no schema attribute")
damage("a schema with a line break gives one line", "packing",
       attribute("/", "schema", "a\nb"), r"schema a\?b is unknown")

done()
