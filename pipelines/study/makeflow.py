# SPDX-License-Identifier: GPL-3.0-or-later
"""What is stale of a study as rules of Makeflow (Cooperative Computing Tools), which gives them to HTCondor,
PBS, Slurm, Work Queue and others. Its JSON form: words of a shell need no second quoting there."""
import json
import os

import rules
from plan import Artifact


def rule_of(path, inputs, key, command):
    """tools/memo keeps what it makes as `make study` does, so that either goes on where the other ended."""
    words = rules.quoted([rules.MEMO, "run", *key, "--", *command])
    return {"command": words, "inputs": inputs, "outputs": [path]}


def write_rules(plan, made, stale, folder):
    """FOLDER/study.makeflow.json, for a Makeflow that works in FOLDER; gives its name."""
    missing, found = set(stale), []
    for path in stale:
        inputs = dict.fromkeys(each.path for part in plan.parts[path] for each in part.inputs
                               if isinstance(each, Artifact) and each.path in missing)
        found.append(rule_of(path, list(inputs), *made[path]))
    name = os.path.join(folder, "study.makeflow.json")
    with open(name, "w", encoding="utf-8") as file:
        json.dump({"rules": found}, file, indent=1)
    print(f"{len(found)} rules: {name}; cd {folder} && makeflow --json study.makeflow.json", flush=True)
