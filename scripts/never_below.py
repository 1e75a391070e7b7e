# SPDX-License-Identifier: MIT
"""Lists where any method beats raymoval_plus:offline by more than 0.005 F1 or one point of AA.

    never_below.py               # of the recorded results, results/field/*.csv and results/never_below/*.csv
    never_below.py CSV ...       # of a run's results.csv, or several
    never_below.py --check       # fails if a recorded place is not one of KNOWN, or one of KNOWN is gone

Prints how many sequences and cells it looked at, the places in a table of Markdown, and the narrowest margins."""

import collections
import csv
import pathlib
import sys

RESULTS = pathlib.Path(__file__).resolve().parent.parent / "results"
OURS = "raymoval_plus:offline"
CONTROLS = ("noop", "remove-all", "oracle")
MARGINS = {"F1": 0.005, "AA": 1.0}
# (FILE/SEQUENCE, method) of the recorded results where it is so. Never add one to make the check pass: say why in
# methods/raymoval_plus/EXPERIMENTS.md, "Where others are better".
KNOWN = {
    ("hard/junction-rosette", "raymoval_plus:online-lag"),
    ("hard/junction-rosette", "raymoval_plus:online"),
    ("hard/walk-vlp16", "beautymap:wide"),
    ("hard/walk-solid-state", "raymoval_plus:online-lag"),
    ("hard/walk-solid-state", "octomap:ground"),
    ("hard/walk-solid-state", "peopleremover:normals"),
    ("hard/walk-solid-state", "removert:rm3"),
    ("hard/walk-solid-state", "beautymap:wide"),
    ("hard/walk-rosette", "peopleremover:normals"),
    ("hard/walk-rosette", "beautymap:wide"),
    ("hard/walk-rosette", "freedom:few-counts"),
    ("hard/carpark-solid-state", "peopleremover:normals"),
    ("hard-60/walk", "peopleremover:normals"),
}


def read(paths):
    """{file/sequence: {method: {rate: value}}} of all cells with a value."""
    rates = collections.defaultdict(lambda: collections.defaultdict(dict))
    for path in paths:
        with open(path, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                name = row.get("name") or row["method"] + ":" + row["variant"]
                for rate in MARGINS:
                    if row.get(rate):
                        rates[f"{pathlib.Path(path).stem}/{row['sequence']}"][name][rate] = float(row[rate])
    return rates


def differences(rates):
    """(sequence, method, rate, theirs, ours) of every cell that is not ours nor a control's."""
    for sequence, methods in rates.items():
        if OURS not in methods:
            sys.exit(f"never_below.py: {sequence} has no {OURS} to compare with.")
        for name, values in methods.items():
            if name == OURS or name.split(":")[0] in CONTROLS:
                continue
            for rate, theirs in values.items():
                yield sequence, name, rate, theirs, methods[OURS][rate]


def main(arguments):
    check = arguments == ["--check"]
    recorded = sorted(RESULTS.glob("field/*.csv")) + sorted(RESULTS.glob("never_below/*.csv"))
    paths = recorded if check or not arguments else arguments
    if not paths:
        sys.exit(f"never_below.py: {RESULTS}/field has no results; scripts/field.sh makes them.")
    rates = read(paths)
    all_of_them = list(differences(rates))
    above = [one for one in all_of_them if one[3] - one[4] > MARGINS[one[2]]]
    print(f"{len(rates)} sequences, {len({one[:2] for one in all_of_them})} cells of other methods and variants; "
          f"{len({one[:2] for one in above})} of them beat {OURS}.")
    if above:
        print("\n| sequence | method | rate | theirs | ours |\n|---|---|---|---:|---:|")
        for sequence, name, rate, theirs, ours in above:
            print(f"| {sequence} | {name} | {rate} | {theirs} | {ours} |")
    for rate, margin in MARGINS.items():
        closest = max((one for one in all_of_them if one[2] == rate), key=lambda one: one[3] - one[4])
        print(f"Nearest in {rate}: {closest[1]} on {closest[0]}, {closest[3] - closest[4]:+.4f} (listed above {margin}).")
    if check and {one[:2] for one in above} != KNOWN:
        sys.exit("never_below.py: that is not what KNOWN lists.")


main(sys.argv[1:])
