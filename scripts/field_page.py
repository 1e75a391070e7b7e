# SPDX-License-Identifier: MIT
"""Writes the tables of docs/field.md, and its chart, from the results that scripts/field.sh left.

    field_page.py            # writes docs/field.md's tables and results/pictures/field.svg
    field_page.py --check    # writes nothing; fails if one of them is not what it would write
    field_page.py --take RESULTS_CSV KEPT_CSV      # KEPT_CSV gets the rates of this run
    field_page.py --within RESULTS_CSV KEPT_CSV    # only the cells of this run are replaced there

The numbers stand in results/field/*.csv and results/delay/*.csv (the columns of a run's results.csv), and nowhere
else: a table in the page is what stands between its lines "<!-- table NAME -->" and "<!-- end -->"."""

import csv
import pathlib
import re
import statistics
import sys

HOUSE = pathlib.Path(__file__).resolve().parent.parent
PAGE = HOUSE / "docs/field.md"
CHART = HOUSE / "results/pictures/field.svg"
RESULTS = HOUSE / "results/field"
DELAYS = HOUSE / "results/delay"
# Times of cells that ran side by side are no measure, and memory is not that page's matter.
KEPT = ("sequence", "method", "variant", "protocol", "status", "PR", "RR", "F1", "SA", "DA", "AA", "HA", "precision",
        "recall", "IoU", "name")
CONTROLS = ("noop", "remove-all", "oracle")

SCENES = ("town", "highway", "country", "suburb", "crossing", "excavator")
SENSORS = (("16 beams", "vlp16"), ("32", "hdl32e"), ("64", ""), ("128", "os1-128"), ("solid state", "solid-state"),
           ("rosette", "rosette"))
RATES = (("10 Hz", ""), ("5 Hz", "5hz"), ("2 Hz", "2hz"))
HARD = ("junction", "market", "walk", "carpark", "motorway", "mountain", "warehouse", "rain", "glass", "revisit")
HARD_SEEDS = ("306", "308", "310")
HARD_SENSORS = (("its own", HARD_SEEDS), ("16 beams", ("vlp16",)), ("32", ("hdl32e",)),
                ("solid state", ("solid-state",)), ("rosette", ("rosette",)))


def with_suffix(scenes, suffix):
    return [scene + ("-" + suffix if suffix else "") for scene in scenes]


# A table is a list of columns: a heading, and the sequences whose mean is shown.
TABLES = {
    "scenes": [(scene, [scene]) for scene in SCENES] + [("mean", list(SCENES))],
    "sensors": [(label, with_suffix(("town", "crossing"), suffix)) for label, suffix in SENSORS]
    + [("in the hand", ["walk"])],
    "rates": [(label, with_suffix(("town", "highway", "crossing"), suffix)) for label, suffix in RATES],
    "drive": [("10 Hz", ["drive"]), ("5 Hz", ["drive-5hz"]), ("2 Hz", ["drive-2hz"])],
    "hard": [(world, [f"{world}-{seed}" for seed in HARD_SEEDS]) for world in HARD]
    + [("mean", [f"{world}-{seed}" for world in HARD for seed in HARD_SEEDS])],
    "hard-sensors": [(label, [f"{world}-{suffix}" for world in HARD for suffix in suffixes])
                     for label, suffixes in HARD_SENSORS],
}


def read_rates(folder):
    """{(sequence, name): {rate: value}} of every cell that has one; a cell that failed has none."""
    rates = {}
    files = sorted(folder.glob("*.csv"))
    if not files:
        sys.exit(f"field_page.py: {folder} has no results; scripts/field.sh makes them.")
    for path in files:
        with path.open(newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                cell = rates.setdefault((row["sequence"], row["name"]), {})
                for rate in ("PR", "RR", "F1", "SA", "DA", "AA"):
                    if row[rate]:
                        cell[rate] = float(row[rate])
    return rates


def methods_of(rates, columns):
    """Names with a value in some column, best mean first; controls are left out."""
    names = {name for _, name in rates if name.split(":")[0] not in CONTROLS}
    means = {}
    for name in names:
        values = [value for _, sequences in columns
                  if (value := mean_of(rates, sequences, name, "F1")) is not None]
        if values:
            means[name] = statistics.fmean(values)
    return sorted(means, key=lambda name: (-means[name], name))


def mean_of(rates, sequences, name, rate):
    """The mean over sequences, or None where one has no value: a mean of fewer would not be comparable."""
    values = [rates.get((sequence, name), {}).get(rate) for sequence in sequences]
    return None if None in values else statistics.fmean(values)


def table(rates, columns, rate):
    names = methods_of(rates, columns)
    values = {name: [mean_of(rates, sequences, name, rate) for _, sequences in columns] for name in names}
    decimals = 3 if rate == "F1" else 1
    best = [max((values[name][i] for name in names if values[name][i] is not None), default=None)
            for i in range(len(columns))]

    def shown(value, i):
        if value is None:
            return "n/a"
        text = f"{value:.{decimals}f}"
        return f"**{text}**" if best[i] is not None and text == f"{best[i]:.{decimals}f}" else text

    lines = ["| " + rate + " | " + " | ".join(heading for heading, _ in columns) + " |",
             "|---|" + "---:|" * len(columns)]
    for name in names:
        lines.append(f"| `{name}` | " + " | ".join(shown(value, i) for i, value in enumerate(values[name])) + " |")
    return "\n".join(lines)


def delay_table(rates):
    """F1 and DA of the only method there, a row for each sequence and a column for each delay in seconds."""
    names = {float(name.rpartition("=")[2]): name for _, name in rates}
    delays = sorted(names)
    lines = ["| F1 (DA) | " + " | ".join("at once" if delay == 0 else f"{delay:g} s" for delay in delays) + " |",
             "|---|" + "---:|" * len(delays)]
    for sequence in dict.fromkeys(sequence for sequence, _ in rates):
        cells = [rates[sequence, names[delay]] for delay in delays]
        lines.append(f"| {sequence} | " + " | ".join(f"{cell['F1']:.3f} ({cell['DA']:.1f})" for cell in cells) + " |")
    return "\n".join(lines)


def colour(value):
    """From vermillion (0) over white (.8) to blue (1): told apart by the colour-blind, too."""
    low, middle, high = (213, 94, 0), (255, 255, 255), (0, 114, 178)
    share = min(max(value / 0.8, 0), 1) if value < 0.8 else min((value - 0.8) / 0.2, 1)
    start, end = (low, middle) if value < 0.8 else (middle, high)
    return "#" + "".join(f"{round(a + (b - a) * share):02x}" for a, b in zip(start, end))


def chart(rates):
    """A cell for each method and condition, coloured by F1, as SVG text."""
    groups = [("scenes", TABLES["scenes"][:-1]), ("sensors", TABLES["sensors"]), ("rates", TABLES["rates"])]
    if any(sequence == "drive" for sequence, _ in rates):
        groups.append(("a real drive", TABLES["drive"]))
    names = methods_of(rates, [column for _, columns in groups[:3] for column in columns])
    left, top, wide, high, gap = 190, 96, 46, 22, 14
    parts, x = [], left
    for title, columns in groups:
        parts.append(f'<text x="{x}" y="16" class="group">{title}</text>')
        for heading, sequences in columns:
            parts.append(f'<text transform="translate({x + wide // 2 + 4},{top - 6}) rotate(-50)">{heading}</text>')
            for row, name in enumerate(names):
                value = mean_of(rates, sequences, name, "F1")
                y = top + row * high
                fill = "none" if value is None else colour(value)
                text = "" if value is None else f"{value:.2f}".lstrip("0") if value < 0.995 else "1"
                ink = "#fff" if value is not None and (value > 0.95 or value < 0.15) else "#111"
                parts.append(f'<rect x="{x}" y="{y}" width="{wide - 2}" height="{high - 2}" fill="{fill}"/>'
                             f'<text x="{x + wide // 2 - 1}" y="{y + 14}" class="value" fill="{ink}">{text}</text>')
            x += wide
        x += gap
    for row, name in enumerate(names):
        parts.append(f'<text x="{left - 8}" y="{top + row * high + 14}" class="name">{name}</text>')
    width, height = x + 20, top + len(names) * high + 10
    style = ("text{font:11px sans-serif}.group{font-weight:bold}.name{text-anchor:end}.value{text-anchor:middle}")
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
            f'height="{height}" role="img" aria-label="F1 of each method in each condition">\n<style>{style}</style>\n'
            f'<rect width="{width}" height="{height}" fill="#fff"/>\n' + "\n".join(parts) + "\n</svg>\n")


def page(rates, delays, text):
    """The page with each table made anew."""

    def made(match):
        name, _, rate = match.group(1).partition(" ")
        rows = delay_table(delays) if name == "delay" else table(rates, TABLES[name], rate or "F1")
        return f"<!-- table {match.group(1)} -->\n{rows}\n<!-- end -->"

    return re.sub(r"<!-- table ([^>]*?) -->\n.*?<!-- end -->", made, text, flags=re.DOTALL)


def read_run(path):
    if not path.is_file():
        sys.exit(f"field_page.py: there is no {path}; expected a run's results.csv, or rates that were kept before.")
    with path.open(newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        missing = [column for column in KEPT if column not in (reader.fieldnames or ())]
        if missing:
            sys.exit(f"field_page.py: {path} has no column {', '.join(missing)}; expected a run's results.csv.")
        return [{column: row[column] for column in KEPT} for row in reader]


def cell(row):
    return row["sequence"], row["name"], row["protocol"]


def merged(old, new):
    """Old rows with those of `new` in their places; cells that are only in `new` come last."""
    fresh = {cell(row): row for row in new}
    rows = [fresh.pop(cell(row), row) for row in old]
    return rows + list(fresh.values())


def take(results, kept, within):
    """Takes the rates of a run's results.csv into a file of results/field/ or results/delay/."""
    rows = read_run(results)
    if within:
        rows = merged(read_run(kept), rows)
    with kept.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, KEPT, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main():
    if sys.argv[1:2] in (["--take"], ["--within"]) and len(sys.argv) == 4:
        take(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]), sys.argv[1] == "--within")
        return
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(f"field_page.py: {' '.join(sys.argv[1:])} is unknown; expected nothing, or --check.")
    rates = read_rates(RESULTS)
    new_page = page(rates, read_rates(DELAYS), PAGE.read_text(encoding="utf-8"))
    for path, new in ((PAGE, new_page), (CHART, chart(rates))):
        if not check:
            path.write_text(new, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != new:
            sys.exit(f"field_page.py: {path.relative_to(HOUSE)} does not say what {RESULTS.relative_to(HOUSE)}/ and "
                     f"{DELAYS.relative_to(HOUSE)}/ hold; scripts/field_page.py writes it anew.")


if __name__ == "__main__":
    main()
