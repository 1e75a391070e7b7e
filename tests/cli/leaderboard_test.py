#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""docs/leaderboard.md says what results/reference/street and results/submissions say."""
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
DECIMALS = {"F1": 4}


def cells():
    """All cells by (submission, method)."""
    reference = json.loads((ROOT / "results/reference/street/results.json").read_text())
    found = {("quick", cell["name"]): cell for cell in reference["cells"]
             if not cell["method"]["control"]}
    for path in (ROOT / "results/submissions").glob("*/*.json"):
        cell = json.loads(path.read_text())
        found[path.parent.name, cell["name"]] = cell
    return found


def rows(page):
    """Of each table the protocol, and each row by the headings of its columns."""
    protocol, heads = "", []
    for line in page.splitlines():
        title = re.fullmatch(r"## street by protocol (\S+)", line)
        if title:
            protocol, heads = title.group(1), []
        elif line.startswith("| ") and protocol:
            columns = [text.strip() for text in line.strip("|").split("|")]
            if not heads:
                heads = columns
            elif not set(columns[0]) <= set("-: "):
                yield protocol, dict(zip(heads, columns))


known = cells()
failures = []
seen = set()
for protocol, row in rows((ROOT / "docs/leaderboard.md").read_text()):
    key = row["submission"], row["method"]
    seen.add((protocol, key))
    if key not in known:
        failures.append(f"{key}: unknown")
        continue
    if row["version"] != known[key]["method"]["version"]:
        failures.append(f"{key}: version {row['version']}, is {known[key]['method']['version']}")
    score = next(s for s in known[key]["protocols"] if s["name"] == protocol)
    for rate, value in score["rates"].items():
        text = format(value, f".{DECIMALS.get(rate, 3)}f")
        if rate in row and row[rate] != text:
            failures.append(f"{protocol} {key}: {rate} {row[rate]}, is {text}")
for key, cell in known.items():
    for score in cell["protocols"]:
        if (score["name"], key) not in seen:
            failures.append(f"{key}: no row by protocol {score['name']}")
for failure in failures:
    print("FAILED:", failure, "(scripts/leaderboard.sh makes the page anew)")
print(f"leaderboard: {len(seen)} rows are looked at")
sys.exit(1 if failures or not seen else 0)
