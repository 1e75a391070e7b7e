# SPDX-License-Identifier: MIT
"""The worked example of docs/protocols.md: nine points of one scan, and an answer.

    protocol_examples.py PATH/TO/raymoval            # writes the page's table of rates, and its pictures
    protocol_examples.py PATH/TO/raymoval --check    # writes nothing; fails if one of them is out of date

The program counts the numbers. The table stands between the lines "<!-- table rates -->" and "<!-- end -->" of the page.
The pictures are results/pictures/protocol_*.svg."""

import json
import math
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

HOUSE = pathlib.Path(__file__).resolve().parent.parent.parent
PAGE = HOUSE / "docs/protocols.md"
PICTURES = HOUSE / "results/pictures"
ROAD, WALL, CAR = 40, 50, 252
# Name, x, y (m, all at one height), label, and whether the answer removes it.
POINTS = (("a", 5.12, 0.11, ROAD, False), ("b", 5.31, 0.08, ROAD, False), ("c", 5.35, 0.14, ROAD, True),
          ("d", 5.52, 0.11, ROAD, True), ("e", 5.71, 0.31, CAR, True), ("f", 5.75, 0.35, CAR, True),
          ("g", 5.91, 0.31, CAR, False), ("h", 5.97, 0.51, WALL, False), ("i", 6.01, 0.51, CAR, True))
Z = -1.63
RATES = {"erasor": ("PR", "RR", "F1"), "dynamicmap": ("SA", "DA", "AA", "HA"),
         "dynamicmap-strict": ("SA", "DA", "AA", "HA"), "mos": ("precision", "recall", "IoU")}
ANSWERS = (("the answer", lambda p: p[4]), ("all moving points removed", lambda p: p[3] == CAR))
BLUE, VERMILLION, GREY, INK = "#0072b2", "#d55e00", "#9a9a9a", "#222222"


def write_sequence(folder):
    """The points as a sequence in SemanticKITTI layout: float32 x y z reflectance, and a label word for each."""
    for name in ("velodyne", "labels"):
        (folder / name).mkdir(parents=True)
    (folder / "velodyne/000000.bin").write_bytes(b"".join(struct.pack("<4f", x, y, Z, 0) for _, x, y, _, _ in POINTS))
    (folder / "labels/000000.label").write_bytes(b"".join(struct.pack("<I", p[3]) for p in POINTS))
    (folder / "poses.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n")
    (folder / "calib.txt").write_text("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n")


def scores(program, work):
    """{answer: {protocol: {"counts": {}, "rates": {}}}}, as the program counts them."""
    write_sequence(work / "example")
    found = {}
    for i, (answer, removes) in enumerate(ANSWERS):
        labels = work / f"answer{i}"
        labels.mkdir()
        (labels / "000000.label").write_bytes(b"".join(struct.pack("<I", 251 if removes(p) else 9) for p in POINTS))
        command = [program, "score", "--sequence", work / "example", "--predictions", labels, "--up", "z",
                   "--sensor", "hdl64e", "--json", work / f"score{i}.json", "--quiet"]
        for protocol in RATES:
            command += ["--protocol", protocol]
        said = subprocess.run(command, capture_output=True, text=True)
        if said.returncode != 0:
            sys.exit(f"protocol_examples.py: raymoval score: {said.stderr}")
        found[answer] = {p["name"]: p for p in json.loads((work / f"score{i}.json").read_text())["protocols"]}
    return found


# --- what the pictures say, point by point and voxel by voxel ---


def moves(point):
    return point[3] == CAR


def nearest(x, y, points):
    """The nearest of `points` and its distance."""
    return min(((p, math.hypot(p[1] - x, p[2] - y)) for p in points), key=lambda found: found[1])


def voxels(points):
    """Points by cells of 0.2 m: [(names, x, y, label)] with the mean of each cell, which has one label here."""
    cells = {}
    for p in points:
        cells.setdefault((math.floor(p[1] * 5), math.floor(p[2] * 5)), []).append(p)
    return [("".join(p[0] for p in cell), sum(p[1] for p in cell) / len(cell), sum(p[2] for p in cell) / len(cell),
             cell[0][3]) for cell in cells.values()]


def erasor_verdicts():
    """[(voxel of the truth, its partner or None, what becomes of it)] by the rules of the protocol."""
    estimate = voxels([p for p in POINTS if not p[4]])
    found = []
    for voxel in voxels(POINTS):
        partner, distance = nearest(voxel[1], voxel[2], estimate)
        same = distance < 0.1 * math.sqrt(3) and (partner[3] == CAR) == moves(voxel)
        word = ("remains" if same else "rejected") if moves(voxel) else ("preserved" if same else "lost")
        found.append((voxel, partner if distance < 0.1 * math.sqrt(3) else None, word))
    return found


def dynamicmap_verdicts():
    """[(point, what becomes of it)]: a point is there if a kept point lies within 0.05 m of it."""
    kept = [p for p in POINTS if not p[4]]
    words = {(False, True): "there", (False, False): "lost", (True, True): "there", (True, False): "gone"}
    return [(p, words[moves(p), nearest(p[1], p[2], kept)[1] <= 0.05]) for p in POINTS]


def check_verdicts(protocols):
    """Fails if a picture says something else than the program counts."""
    words = [word for _, _, word in erasor_verdicts()]
    points = [(moves(p), word) for p, word in dynamicmap_verdicts()]
    for protocol, name, shown in (
            ("erasor", "static_voxels", words.count("preserved") + words.count("lost")),
            ("erasor", "dynamic_voxels", words.count("remains") + words.count("rejected")),
            ("erasor", "preserved_static", words.count("preserved")),
            ("erasor", "remaining_dynamic", words.count("remains")),
            ("dynamicmap", "present_static_points", points.count((False, "there"))),
            ("dynamicmap", "removed_dynamic_points", points.count((True, "gone"))),
            ("mos", "flagged_dynamic_points", sum(p[4] and moves(p) for p in POINTS)),
            ("mos", "kept_static_points", sum(not p[4] and not moves(p) for p in POINTS))):
        counted = protocols[protocol]["counts"][name]
        if counted != shown:
            sys.exit(f"protocol_examples.py: the pictures show {name} {shown}, but {protocol} counts {counted}.")


# --- pictures ---
SCALE, LEFT, TOP, FIRST_X, LAST_X, LAST_Y = 540, 20, 30, 5.0, 6.2, 0.6


def at(x, y):
    return LEFT + (x - FIRST_X) * SCALE, TOP + (LAST_Y - y) * SCALE


def text(x, y, words, colour=INK, size=14, anchor="middle"):
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" font-size="{size}" text-anchor="{anchor}">{words}</text>'


def circle(x, y, radius, look):
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:.1f}" {look}/>'


def grid(step):
    lines = []
    for i in range(round((LAST_X - FIRST_X) / step) + 1):
        (x, top), (_, bottom) = at(FIRST_X + i * step, LAST_Y), at(FIRST_X + i * step, 0)
        lines.append(f'<line x1="{x:.1f}" y1="{top:.1f}" x2="{x:.1f}" y2="{bottom:.1f}" stroke="#d0d0d0"/>')
    for i in range(round(LAST_Y / step) + 1):
        (left, y), (right, _) = at(FIRST_X, i * step), at(LAST_X, i * step)
        lines.append(f'<line x1="{left:.1f}" y1="{y:.1f}" x2="{right:.1f}" y2="{y:.1f}" stroke="#d0d0d0"/>')
    return lines


def colour_of(point):
    return VERMILLION if moves(point) else BLUE


def dot(point, radius=7):
    x, y = at(point[1], point[2])
    fill = "#ffffff" if point[4] else colour_of(point)
    return circle(x, y, radius, f'fill="{fill}" stroke="{colour_of(point)}" stroke-width="2.5"')


def picture(title, drawn, legend):
    """A picture as SVG: what is drawn, and below it a legend of (colour, filled, words)."""
    width, height = 2 * LEFT + (LAST_X - FIRST_X) * SCALE, TOP + LAST_Y * SCALE + 76
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" width="{width:.0f}" '
             f'height="{height:.0f}" font-family="DejaVu Sans, sans-serif">', f"<title>{title}</title>",
             f'<rect width="{width:.0f}" height="{height:.0f}" fill="#ffffff"/>', *drawn]
    x, y = LEFT + 8, height - 18
    for colour, filled, words in legend:
        fill = colour if filled else "#ffffff"
        lines.append(circle(x, y - 5, 6, f'fill="{fill}" stroke="{colour}" stroke-width="2.5"'))
        lines.append(text(x + 12, y, words, size=13, anchor="start"))
        x += 34 + 7.6 * len(words)
    return "\n".join([*lines, "</svg>", ""])


def points_picture():
    drawn = grid(0.2)
    for p in POINTS:
        x, y = at(p[1], p[2])
        drawn += [dot(p), text(x - 14, y - 9, p[0])]
    drawn.append(text(LEFT, TOP - 10, "from above; a square is 0.2 m wide", GREY, 13, "start"))
    return picture("Nine points of one scan, and which of them an answer removes", drawn,
                   ((BLUE, True, "static, kept"), (BLUE, False, "static, removed"), (VERMILLION, True, "moving, kept"),
                    (VERMILLION, False, "moving, removed")))


def erasor_picture():
    drawn = grid(0.2)
    for (names, vx, vy, label), partner, word in erasor_verdicts():
        left, top = at(math.floor(vx * 5) / 5, math.floor(vy * 5) / 5 + 0.2)
        colour = VERMILLION if label == CAR else BLUE
        edge = 0.2 * SCALE
        drawn.append(f'<rect x="{left:.1f}" y="{top:.1f}" width="{edge:.1f}" height="{edge:.1f}" fill="{colour}" '
                     f'fill-opacity="0.13" stroke="{colour}" stroke-opacity="0.5"/>')
        drawn += [text(left + edge / 2, top + 16, word, size=13), text(left + 7, top + edge - 7, names, GREY, 13, "start")]
        x, y = at(vx, vy)
        if partner and partner[1:3] != (vx, vy):
            px, py = at(partner[1], partner[2])
            drawn.append(f'<line x1="{x:.1f}" y1="{y:.1f}" x2="{px:.1f}" y2="{py:.1f}" stroke="{INK}"/>')
        drawn.append(circle(x, y, 7, f'fill="#ffffff" stroke="{colour}" stroke-width="2.5"'))
    for _, vx, vy, label in voxels([p for p in POINTS if not p[4]]):
        x, y = at(vx, vy)
        drawn.append(circle(x, y, 4, f'fill="{VERMILLION if label == CAR else BLUE}"'))
    x, y = at(5.52, 0.11)
    drawn.append(circle(x, y, 0.1 * math.sqrt(3) * SCALE, f'fill="none" stroke="{BLUE}" stroke-dasharray="5 4"'))
    drawn.append(text(LEFT, TOP - 10, "a tinted square is a voxel of the truth; the dashed circle around d has a radius of "
                      "0.173 m", GREY, 13, "start"))
    return picture("The voxels of the truth, their partners, and what becomes of them", drawn,
                   ((GREY, False, "voxel of the truth (mean of its points)"), (GREY, True, "voxel of the estimate")))


def dynamicmap_picture():
    drawn = grid(0.2)
    for p in POINTS:
        if not p[4]:
            x, y = at(p[1], p[2])
            drawn.append(circle(x, y, 0.05 * SCALE, f'fill="#000000" fill-opacity="0.08" stroke="{GREY}" '
                                                    'stroke-dasharray="4 3"'))
    for p, word in dynamicmap_verdicts():
        x, y = at(p[1], p[2])
        side = -1 if p[0] in "beh" else 1
        drawn += [dot(p), text(x + side * 14, y - 12 if p[0] != "b" else y + 26, f"{p[0]}: {word}", size=13,
                               anchor="end" if side < 0 else "start")]
    drawn.append(text(LEFT, TOP - 10, "the circles have a radius of 0.05 m around each kept point", GREY, 13, "start"))
    return picture("Which points are there, gone or lost", drawn,
                   ((BLUE, True, "static, kept"), (BLUE, False, "static, removed"), (VERMILLION, True, "moving, kept"),
                    (VERMILLION, False, "moving, removed")))


# --- the page ---


def number(value, rate):
    return "n/a" if value is None else f"{value:.4f}" if rate == "F1" else f"{value:.3f}"


def table(found):
    lines = [f"| protocol | rates | {' | '.join(found)} |", "|---|---|" + "---|" * len(found)]
    for protocol, rates in RATES.items():
        answers = (", ".join(number(protocols[protocol]["rates"].get(rate), rate) for rate in rates)
                   for protocols in found.values())
        lines.append(f"| `{protocol}` | {', '.join(rates)} | {' | '.join(answers)} |")
    return "\n".join(lines)


def check_distances(words):
    """Fails unless the page says how far these points are from the nearest one that is kept."""
    kept = [p for p in POINTS if not p[4]]
    for name, decimals in (("c", 3), ("d", 2), ("i", 2)):
        point = next(p for p in POINTS if p[0] == name)
        distance = f"{nearest(point[1], point[2], kept)[1]:.{decimals}f} m"
        if not re.search(rf"^- \*\*{name}\*\* .*{distance}", words, re.MULTILINE):
            sys.exit(f"protocol_examples.py: {PAGE.name} does not say that {name} is {distance} from the nearest kept point.")


def page(found):
    """The page with the present table."""
    old = PAGE.read_text(encoding="utf-8")
    check_distances(old)
    form = re.compile(r"(<!-- table rates -->\n).*?(<!-- end -->)", re.DOTALL)
    if not form.search(old):
        sys.exit(f"protocol_examples.py: {PAGE.name} has no '<!-- table rates -->'.")
    return form.sub(lambda match: match[1] + table(found) + "\n" + match[2], old)


def main():
    arguments = [a for a in sys.argv[1:] if a != "--check"]
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(__doc__)
        sys.exit(0 if arguments in (["--help"], ["-h"]) else 2)
    with tempfile.TemporaryDirectory() as work:
        found = scores(arguments[0], pathlib.Path(work))
    check_verdicts(found["the answer"])
    written = {PAGE: page(found), PICTURES / "protocol_points.svg": points_picture(),
               PICTURES / "protocol_erasor.svg": erasor_picture(),
               PICTURES / "protocol_dynamicmap.svg": dynamicmap_picture()}
    stale = [path for path, words in written.items() if not path.exists() or path.read_text(encoding="utf-8") != words]
    if "--check" not in sys.argv:
        for path in stale:
            path.write_text(written[path], encoding="utf-8")
    elif stale:
        sys.exit(f"protocol_examples.py: {', '.join(path.name for path in stale)}: not what the program counts. "
                 "scripts/site/protocol_examples.py PATH/TO/raymoval writes it.")


if __name__ == "__main__":
    main()
