#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Every command in the project's pages can be typed: its programs, targets and files exist, its
# parameters are known with these values, its filters are jq. What it makes is not looked at here.
import glob
import os
import re
import shlex
import subprocess
import sys

sys.path.insert(0, "tests")
from tap import BIN, code_blocks, done, ok, read

STAGES = sorted(os.listdir(BIN))
WRITERS = ["pack", "tessellate", "merge-nodes", "dry", "force-protocol", "dem-replay", "deform", "simulate", "shearstats",
           "import-network", "invade", "flow"]  # of HDF5, which no terminal takes
DATABASE = subprocess.run(["make", "-qp"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
TARGETS = set(re.findall(r"^([\w./-]+):", DATABASE, re.M))
VARIABLES = set(re.findall(r"\$[({](\w+)", "".join(read(path).decode() for path in ["Makefile", *glob.glob("pipelines/**/*.mk", recursive=True)])))


def blocks(page):
    """What a page shows as code; documents that are fed to a program left out."""
    text = re.sub(r"^    .*<<'?(\w+)'?.*\n(.*\n)*?    \1\n", "", read(page).decode(), flags=re.M)
    return code_blocks(text)


def commands(text):
    """Lists of words, and whether another command takes the output; none of what is no shell."""
    text = re.sub(r"(^|\s)#.*$", "", text.replace("\\\n", " "), flags=re.M)
    for name in re.findall(r"\bfor (\w+) in ", text):
        text = re.sub(rf"\${name}\b", "1", text)
    lexer = shlex.shlex(text + "\n", posix=True, punctuation_chars="();<>|&\n")
    lexer.whitespace_split, lexer.commenters, lexer.whitespace = True, "", " \t"
    words = []
    try:
        for word in lexer:
            if re.fullmatch(r"[();<>|&\n]+", word):
                yield words, word == "|"
                words = []
            else:
                words.append(word)
    except ValueError:  # quotes that do not close: a text, not a command
        return


def make_fault(words):
    for word in words[1:]:
        if re.match(r"\w+=", word):
            if word.split("=")[0] not in VARIABLES:
                return f"no variable {word}"
        elif not word.startswith("-") and word not in TARGETS and not os.path.exists(word):
            return f"no target {word}"
    return None


def stage_fault(words):
    """What the program says of the options, with the scenes that exist here."""
    stage = f"{BIN}/{words[0]}"
    options, keep = subprocess.run([stage, "--help"], stdout=subprocess.PIPE, text=True).stdout, []
    rest = iter(words[1:])
    for word in rest:
        if word in ["-s", "--set"]:
            setting = next(rest)
            keep += [] if "$" in setting else ["--set", setting]
        elif word in ["-p", "--params"]:
            scene = next(rest)
            keep += ["-p", scene] if os.path.exists(scene) else []
        elif re.match(r"--[a-z]", word) and word.split("=")[0] not in options:
            return f"no option {word}"
    if "--parameters" not in options:
        return None
    said = subprocess.run([stage, *keep, "--parameters"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    return said.stderr if said.returncode and "must be given" not in said.stderr else None


def jq_fault(words):
    """Compiles the filter, which stands behind flags and names."""
    flags, rest = [], iter(words[1:])
    for word in rest:
        flags.append(word)
        if word in ["--arg", "--argjson"]:
            flags += [next(rest), "0"]
            next(rest)
        elif not word.startswith("-"):
            break
    said = subprocess.run(["jq", *flags, os.devnull], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    return said.stderr if said.returncode == 3 else None


def fault(words, piped):
    while words and re.match(r"[A-Z_]+=", words[0]):
        words = words[1:]
    if words and words[0] in WRITERS and not piped and not {"-o", "--estimate"} & {word.split("=")[0] for word in words}:
        return "no output is named"
    if words[:1] == ["make"]:
        return make_fault(words)
    if words[:1] == ["jq"] and "$SLURM_ARRAY_TASK_ID" not in words[1]:
        return jq_fault(words)
    if words and words[0] in STAGES and len(words) > 1:
        return stage_fault(words)
    return None


seen = 0
for page in sorted(["README.md", "CONTRIBUTING.md", *glob.glob("docs/*.md")]):
    faults = []
    for block in blocks(page):
        for words, piped in commands(block):
            seen += 1
            faults += [(words, said) for said in [fault(words, piped)] if said]
        faults += [("no file", path) for path in re.findall(r"(?:samples|tests|pipelines)/[\w./-]*\w", block) if not glob.glob(path + "*")]
    ok(not faults, f"the commands of {page} can be typed", faults)
ok(seen > 250, "commands are found", seen)
done()
