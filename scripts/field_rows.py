# SPDX-License-Identifier: MIT
"""Takes the rates of a run's results.csv into a file of results/field/.

    field_rows.py RESULTS_CSV KEPT_CSV             # KEPT_CSV has the rates of this run
    field_rows.py --within RESULTS_CSV KEPT_CSV    # only the cells of this run are replaced there

Times of cells that ran side by side are no measure, and memory is not that page's matter, so neither is kept."""

import csv
import pathlib
import sys

KEPT = ("sequence", "method", "variant", "protocol", "status", "PR", "RR", "F1", "SA", "DA", "AA", "HA", "precision",
        "recall", "IoU", "name")


def read(path):
    if not path.is_file():
        sys.exit(f"field_rows.py: there is no {path}; expected a run's results.csv, or rates that were kept before.")
    with path.open(newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        missing = [column for column in KEPT if column not in (reader.fieldnames or ())]
        if missing:
            sys.exit(f"field_rows.py: {path} has no column {', '.join(missing)}; expected a run's results.csv.")
        return [{column: row[column] for column in KEPT} for row in reader]


def cell(row):
    return row["sequence"], row["name"], row["protocol"]


def merged(old, new):
    """Old rows with those of `new` in their places; cells that are only in `new` come last."""
    fresh = {cell(row): row for row in new}
    rows = [fresh.pop(cell(row), row) for row in old]
    return rows + list(fresh.values())


def main():
    arguments = sys.argv[1:]
    within = arguments[:1] == ["--within"]
    paths = [pathlib.Path(text) for text in arguments[within:]]
    if len(paths) != 2 or any(text.startswith("-") for text in arguments[within:]):
        sys.exit(__doc__)
    results, kept = paths
    rows = read(results)
    if within:
        rows = merged(read(kept), rows)
    with kept.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, KEPT, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
