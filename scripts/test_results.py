# SPDX-License-Identifier: MIT
"""What ctest has told of its tests, for scripts/test.sh.

    test_results.py BUILD JUNIT FAILURES

Prints "TOTAL BAD" (a test named "... 24 cases ..." counts as 24), and adds to the file FAILURES, for
each test that failed, its name and the last 30 lines of what it printed."""

import pathlib
import re
import sys
import xml.etree.ElementTree

LINES = 30


def cases_of(name):
    found = re.search(r": (\d+) cases from ", name)
    return int(found.group(1)) if found else 1


def main():
    build, junit, failures = map(pathlib.Path, sys.argv[1:])
    outputs = {case.get("name"): case.findtext("system-out", "")
               for case in xml.etree.ElementTree.parse(junit).iter("testcase")}
    # "12:name" in each line; there is no such file if none failed.
    listed = build / "Testing/Temporary/LastTestsFailed.log"
    failed = []
    if listed.exists():
        failed = [line.split(":", 1)[1] for line in listed.read_text(errors="replace").splitlines()]
    with failures.open("a", encoding="utf-8") as file:
        for name in failed:
            said = outputs.get(name, "").strip().splitlines()
            file.write(f"== failed: {name} ({build.name})\n" + "\n".join(said[-LINES:]) + "\n")
    total = sum(map(cases_of, outputs))
    print(total, len(failed))


if __name__ == "__main__":
    main()
