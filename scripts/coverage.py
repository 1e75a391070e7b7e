# SPDX-License-Identifier: MIT
"""See scripts/coverage.sh."""

import collections
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
# Each with its folders and the least percentage of its lines.
ROOMS = {
    "core": (("core/",), 90),
    "datasets": (("datasets/",), 90),
    "methods": (("methods/",), None),
    "eval": (("eval/",), 90),
    "benchmark": (("benchmark/",), None),
    "stores": (("benchmark/result/", "benchmark/run/folder/"), 90),
}


def counts_of(notes):
    """What gcov says of one object, by file; only of files of the repository."""
    data = notes.with_suffix(".gcda")
    done = subprocess.run(
        ["gcov", "--json-format", "--stdout", "--branch-probabilities",
         str(data if data.exists() else notes)],
        capture_output=True, check=False)
    if done.returncode != 0:
        sys.exit(f"coverage.sh: gcov cannot read {notes}:\n{done.stderr.decode(errors='replace')}")
    files = []
    for text in done.stdout.splitlines():
        files += json.loads(text)["files"]
    return files


class Coverage:
    """Counts of lines and branches of all objects together, by file."""

    def __init__(self):
        self.lines = collections.defaultdict(collections.Counter)
        self.branches = collections.defaultdict(dict)

    def add(self, file):
        path = pathlib.Path(file["file"]).resolve()
        if not path.is_relative_to(ROOT):
            return
        name = str(path.relative_to(ROOT))
        for line in file["lines"]:
            number = line["line_number"]
            self.lines[name][number] += line["count"]
            taken = [branch["count"] > 0 for branch in line["branches"] if not branch["throw"]]
            known = self.branches[name].setdefault(number, taken)
            # A template may have other branches elsewhere: the longer list counts.
            if len(known) == len(taken):
                self.branches[name][number] = [a or b for a, b in zip(known, taken)]
            elif len(known) < len(taken):
                self.branches[name][number] = taken

    def of(self, folders):
        """(lines, those that ran, branches, those that were taken) of all files in `folders`."""
        names = [name for name in self.lines if name.startswith(folders)]
        lines = [count for name in names for count in self.lines[name].values()]
        branches = [b for name in names for taken in self.branches[name].values() for b in taken]
        return len(lines), sum(count > 0 for count in lines), len(branches), sum(branches)

    def missed(self, name):
        return sorted(n for n, count in self.lines[name].items() if count == 0)


def percent(part, whole):
    return 100.0 * part / whole if whole else 0.0


def table(coverage):
    """Prints the rooms. Returns the names of those with too little."""
    print(f"{'room':<10} {'lines':>7} {'ran':>7} {'%':>6}  {'branches':>8} {'taken':>7} {'%':>6}")
    bad = []
    for room, (folders, least) in ROOMS.items():
        lines, ran, branches, taken = coverage.of(folders)
        share = percent(ran, lines)
        note = ""
        if least is not None and share < least:
            note = f"  less than {least} % of lines"
            bad.append(room)
        print(f"{room:<10} {lines:>7} {ran:>7} {share:>6.1f}  {branches:>8} {taken:>7} "
              f"{percent(taken, branches):>6.1f}{note}")
    print("stores are " + " and ".join(folder.rstrip("/") for folder in ROOMS["stores"][0]))
    return bad


def main():
    build, files = pathlib.Path(sys.argv[1]), sys.argv[2:]
    notes = sorted(n for n in build.rglob("*.gcno") if "CMakeFiles/test_" not in str(n))
    if not any(n.with_suffix(".gcda").exists() for n in notes):
        sys.exit(f"coverage.sh: {build} has no counts. Build it with -DRAYMOVAL_COVERAGE=ON, and "
                 f"run its tests.")
    coverage = Coverage()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for found in pool.map(counts_of, notes):
            for file in found:
                coverage.add(file)
    bad = table(coverage)
    for name in files:
        print(f"{name}: lines that did not run: "
              f"{', '.join(map(str, coverage.missed(name))) or 'none'}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
