# SPDX-License-Identifier: MIT
"""Small sequences that are hard to score, as files.

Coordinates are mostly multiples of powers of 1/2, so that what looks like a tie, a wall or a limit
is one in every arithmetic.
"""
import json
import math
import random
import struct
from dataclasses import dataclass, field

LABELS = [0, 1, 10, 40, 48, 50, 70, 252, 253, 254, 258, 259]
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
KEPT_WORDS = [9, 0, 1, 40, 250, 260, 9 | 251 << 16]
REMOVED_WORDS = [251, 252, 259, 255 | 7 << 16]


@dataclass
class Case:
    """A sequence: scans of (x, y, z, label word), poses, and what is asked of the program."""

    name: str
    scans: list
    poses: list = None
    told: dict = field(default_factory=dict)  # sequence.json
    calibration: list = field(default_factory=lambda: IDENTITY)
    settings: list = field(default_factory=lambda: [{}])  # dictionaries of protocol options
    removed_share: float = 0.4
    removed: list = None  # what is removed of each scan, where it is not at random
    layout: str = "semantickitti"
    as_cloud: bool = False  # the answer is a cleaned map
    expected: dict = field(default_factory=dict)  # rates that the protocol's description has


def write(case, folder, answers, seed):
    """Writes the sequence and an answer at random."""
    generator = random.Random(seed)
    for name in (folder / "velodyne", folder / "labels", answers):
        name.mkdir(parents=True, exist_ok=True)
    for number, scan in enumerate(case.scans):
        points = b"".join(struct.pack("<4f", *point[:3], 0.5) for point in scan)
        (folder / "velodyne" / f"{number:06d}.bin").write_bytes(points)
        words = struct.pack(f"<{len(scan)}I", *(point[3] for point in scan))
        (folder / "labels" / f"{number:06d}.label").write_bytes(words)
        flags = [generator.random() < case.removed_share for _ in scan]
        if case.removed:
            flags = case.removed[number]
        answer = [generator.choice(REMOVED_WORDS if flag else KEPT_WORDS) for flag in flags]
        (answers / f"{number:06d}.label").write_bytes(struct.pack(f"<{len(scan)}I", *answer))
    poses = case.poses or [IDENTITY] * len(case.scans)
    rows = [" ".join(repr(float(value)) for value in pose) for pose in poses]
    (folder / "poses.txt").write_text("\n".join(rows) + "\n")
    tr = " ".join(repr(float(value)) for value in case.calibration)
    (folder / "calib.txt").write_text(f"P0: {' '.join('0' * 12)}\nTr: {tr}\n")
    if case.layout == "dynamicmap":
        write_clouds(case, poses, folder.parent / "clouds")
    if case.told:
        (folder / "sequence.json").write_text(json.dumps(case.told))


def write_clouds(case, poses, folder):
    """Writes the scans in the layout of DynamicMap: in the world frame, with the label as intensity
    and the sensor in VIEWPOINT. The poses only move."""
    (folder / "pcd").mkdir(parents=True)
    (folder / "sequence.json").write_text(json.dumps(case.told))
    for number, (scan, pose) in enumerate(zip(case.scans, poses)):
        shift = pose[3], pose[7], pose[11]
        rows = b"".join(struct.pack("<4f", *(a + b for a, b in zip(point, shift)), point[3])
                        for point in scan)
        head = ("VERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\n"
                f"COUNT 1 1 1 1\nWIDTH {len(scan)}\nHEIGHT 1\n"
                f"VIEWPOINT {shift[0]} {shift[1]} {shift[2]} 1 0 0 0\n"
                f"POINTS {len(scan)}\nDATA binary\n")
        (folder / "pcd" / f"{number:06d}.pcd").write_bytes(head.encode() + rows)


def lattice(generator, count, step, extent, labels=LABELS, height=2.0):
    """Points at random on a lattice of a step around the sensor."""
    def coordinate(size):
        return step * generator.randint(round(-size / step), round(size / step))

    points = []
    while len(points) < count:
        point = (coordinate(extent), coordinate(extent), coordinate(height))
        if any(point):
            points.append((*point, generator.choice(labels)))
    return points


def moved(x, y, z):
    """A pose that only moves."""
    return [1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z]


EXACT = {"erasor": {"voxel_size": 0.25, "lift": 0.0, "minimum_horizontal_range": 0.0},
         "dynamicmap": {"distance": 0.25, "ego_range": 0.0},
         "dynamicmap-strict": {"voxel_size": 0.25}}


def exact(**erasor):
    """The settings EXACT with further options of erasor."""
    return {**EXACT, "erasor": {**EXACT["erasor"], **erasor}}


def walls():
    """Points on walls of voxels of 0.2 m, which no float holds, with both signs."""
    generator = random.Random(1)
    scans = []
    for _ in range(3):
        scan = [(0.2 * generator.randint(-40, 40), 0.2 * generator.randint(-40, 40),
                 0.2 * generator.randint(-10, 10), generator.choice(LABELS)) for _ in range(300)]
        whole = [(generator.randint(-8, 8), generator.randint(3, 8), generator.randint(-2, 2),
                  generator.choice(LABELS)) for _ in range(100)]
        # Beside each, what is in the upper voxel only, so that a point in the lower one shows.
        upper = [(x + 0.0625, y + 0.0625, z + 0.0625, generator.choice(LABELS))
                 for x, y, z, _ in whole]
        scans.append(scan + whole + upper)
    poses = [moved(0.6, -1.4, 0.2), moved(-0.6, 2.2, 1.4), moved(0.3, 0.7, -1.2)]
    settings = [{}, {"erasor": {"lift": 0.0}}, {"erasor": {"lift": 0.6, "label_mode": "nearest"}}]
    return Case("walls", scans, poses, settings=settings)


def ties():
    """Voxels whose centroid is as far from points of several labels, and truth whose nearest
    voxels are equally far: two places a voxel edge."""
    generator = random.Random(2)
    scans = [lattice(generator, 500, 0.125, 1.5, height=0.5) for _ in range(4)]
    settings = [exact(), exact(label_rule="geometry"), exact(matching="same_cell"),
                exact(label_mode="nearest"), exact(truck_is_moving=False),
                exact(ignore_0_1=True)]
    return Case("ties", scans, settings=settings)


def near_ties():
    """Scans that are shifted by parts of a nanometre, around the limit of a tie (1e-9 m)."""
    generator = random.Random(3)
    places = lattice(generator, 200, 0.125, 2.0, height=0.5)
    scans = [[(*place[:3], generator.choice(LABELS)) for place in places] for _ in range(6)]
    shifts = [0, 0.4e-9, 1.3e-9, 2.9e-9, 6.1e-9, -3.3e-9]
    return Case("near_ties", scans, [moved(shift, -shift, 0) for shift in shifts],
                settings=[exact(), exact(label_mode="nearest")])


def limits():
    """Voxels exactly half a diagonal apart, points exactly at ranges and distances."""
    generator = random.Random(4)
    triples = [(3, 4, 0), (0, 5, 12), (5, 12, 0), (8, 15, 0), (2, 2, 1), (0, 0, 3), (1, 2, 2),
               (0, 0, 1), (6, 2, 3), (0.5, 0.5, 0.25)]
    points = []
    for x, y, z in triples:
        for sign in (1, -1):
            for label in LABELS:
                points.append((sign * x, y, z, label))
                points.append((y, sign * x, z * sign, label))
    for _ in range(300):
        corner = [0.25 * generator.randint(-20, 20) for _ in range(3)]
        offset = generator.choice([0.125, -0.125])
        points.append((*corner, generator.choice(LABELS)))
        points.append((*[value + offset for value in corner], generator.choice(LABELS)))
    points = [point for point in points if any(point[:3])]
    generator.shuffle(points)
    settings = [
        exact(minimum_horizontal_range=5.0),
        {**EXACT, "dynamicmap": {"distance": 0.25, "maximum_range": 13.0, "ego_range": 3.0},
         "dynamicmap-strict": {"voxel_size": 0.25, "maximum_range": 13.0, "ego_range": 3.0},
         "mos": {"ignore_unlabelled": False}},
        {"dynamicmap": {"distance": 0.0}},
        {},
    ]
    return Case("limits", [points[0::2], points[1::2]], settings=settings,
                told={"range_m": {"min": 3, "max": 17}})


def empty_scans():
    """Scans of which nothing is judged, first and last ones too: all of it is cropped, out of range
    or ignored. Scans without a return are refused, so each has one."""
    generator = random.Random(5)
    full = lattice(generator, 300, 0.0625, 6.0)
    cropped = lattice(generator, 40, 0.0625, 0.5)
    outside = [(20.0 + k, 1.0, 0.0, 252) for k in range(9)]
    ignored = [(4.0, 0.5 * k, 0.25, 99) for k in range(9)]
    nan = math.nan
    dark = [(nan, nan, nan, 40), (0.0, -0.0, 0.0, 252), (nan, 1.0, 1.0, 70), (4.0, 4.0, 0.0, 40)]
    some_dark = [point if k % 9 else (0.0, 0.0, -0.0, 252) for k, point in enumerate(full)]
    return Case("empty_scans", [cropped, full, outside, dark, ignored, some_dark, ignored[:1]],
                told={"labels": {"moving": [252, 253, 254], "ignored": [99]},
                      "range_m": {"min": 0, "max": 15}},
                settings=[{}, exact(minimum_horizontal_range=1.0), exact(label_mode="nearest")])


def unlabelled():
    """Points of no class and of classes nobody knows, instances, all around the ego ranges."""
    generator = random.Random(6)
    labels = [0, 1, 0, 1, 40, 252, 777, 65535, 252 | 9 << 16, 40 | 252 << 16, 258, 1 << 16]
    scans = [lattice(generator, 400, 0.125, 4.0, labels) for _ in range(3)]
    settings = [{}, {"erasor": {"ignore_0_1": True, "truck_is_moving": False}},
                {"erasor": {"ignore_0_1": True, "label_mode": "nearest"}}]
    return Case("unlabelled", scans, settings=settings)


def rule(name, labels, ranges=None, settings=None):
    """A sequence with a label rule of its own."""
    generator = random.Random(7)
    told = {"labels": labels, **({"range_m": ranges} if ranges else {})}
    scans = [lattice(generator, 400, 0.125, 5.0) for _ in range(3)]
    return Case(name, scans, told=told, settings=settings or [{}, exact()])


def turned(name, offset, settings=None, as_cloud=False):
    """Quarter turns about all axes and a world far away: exact in double."""
    generator = random.Random(8)
    x, y, z = offset
    poses = [[0, -1, 0, x, 1, 0, 0, y, 0, 0, 1, z], [0, 0, 1, x + 2, 1, 0, 0, y, 0, 1, 0, z],
             [-1, 0, 0, x, 0, -1, 0, y - 3, 0, 0, 1, z], [1, 0, 0, x, 0, 0, -1, y, 0, 1, 0, z + 1]]
    scans = [lattice(generator, 300, 0.125, 3.0) for _ in poses]
    settings = settings or [exact(), exact(lift=1.75), exact(label_mode="nearest"), {}]
    return Case(name, scans, poses, settings=settings, as_cloud=as_cloud)


def maps():
    """Cleaned maps: points on the lattice of the truth, a few of them in the air."""
    settings = [exact(), exact(label_rule="geometry"), {}, exact(minimum_horizontal_range=2.0)]
    return turned("maps", (0, 0, 0), settings, as_cloud=True)


def oblique(name, offset):
    """Poses that turn about all axes by angles of no meaning, with a calibration."""
    generator = random.Random(9)
    poses = []
    for _ in range(4):
        a, b = generator.uniform(-3, 3), generator.uniform(-0.3, 0.3)
        ca, sa, cb, sb = math.cos(a), math.sin(a), math.cos(b), math.sin(b)
        shift = [value + generator.uniform(-2, 2) for value in offset]
        poses.append([ca, -sa * cb, sa * sb, shift[0], sa, ca * cb, -ca * sb, shift[1], 0, sb, cb,
                      shift[2]])
    scans = [[(*(generator.uniform(-6, 6) for _ in range(3)), generator.choice(LABELS))
              for _ in range(600)] for _ in poses]
    tr = [0.0, -1.0, 0.0, -0.05, 0.0, 0.0, -1.0, -0.07, 1.0, 0.0, 0.0, -0.33]
    settings = [{}, {"erasor": {"frame": "erasor"}}, {"erasor": {"label_mode": "nearest"}}]
    return Case(name, scans, poses, calibration=tr, settings=settings)


def one_sided(name, labels, removed_share):
    """Nothing moves or everything does; nothing or all is removed."""
    generator = random.Random(10)
    scans = [lattice(generator, 200, 0.125, 5.0, labels) for _ in range(2)]
    return Case(name, scans, removed_share=removed_share)


def clouds():
    """The layout of DynamicMap: 0 is static, 1 moves, also near the sensor."""
    generator = random.Random(11)
    scans = [lattice(generator, 400, 0.125, 5.0, [0, 0, 1]) for _ in range(3)]
    poses = [moved(10.5, -2.25, 1.0), moved(11.5, -2.25, 1.0), moved(12.75, -2.5, 1.125)]
    return Case("clouds", scans, poses, told={"labels": {"moving": [1], "ignored": []}},
                settings=[{}, exact()], layout="dynamicmap")


def worked(name, removed, expected, settings):
    """The example that the protocol's description works out by hand; two scans a metre apart."""
    first = [(2.60, 0, -1.63, 40), (5.05, 0.05, -1.63, 40), (5.15, 0.15, -1.63, 40),
             (8.05, 2.05, -0.63, 252), (8.07, 2.07, -0.63, 252), (8.15, 2.15, -0.63, 70),
             (-6.05, -3.05, -1.63, 50), (0.05, 6.10, -1.63, 48), (-0.05, 6.10, -1.63, 254)]
    second = [(4.07, 0.07, -1.63, 40), (11.05, 0.05, -1.63, 40), (10.95, 0.05, -1.63, 327933)]
    flags = [number in removed for number in range(1, 13)]
    return Case(f"worked_{name}", [first, second], [IDENTITY, moved(1, 0, 0)],
                settings=[settings], removed=[flags[:9], flags[9:]], expected=expected)


def worked_cases():
    """The rows of its table that a right program has."""
    method, oracle = {2, 3, 4, 5, 7, 9, 11}, {4, 5, 9, 12}
    index, nearest = {}, {"erasor": {"label_mode": "nearest"}}
    points = {"SA": 62.5, "DA": 75.0, "AA": 68.4653, "HA": 68.1818}
    return [
        worked("method", method, {"PR": 50, "RR": 66.667, "F1": 0.571429, **points}, index),
        worked("method_nearest", method, {"PR": 50, "RR": 33.333, "F1": 0.4}, nearest),
        worked("nothing", set(), {"PR": 100, "RR": 0, "F1": 0, "SA": 100, "DA": 0, "AA": 0,
                                  "HA": 0}, index),
        worked("everything", set(range(13)), {"PR": 0, "RR": 100, "F1": 0, "SA": 0, "DA": 100},
               index),
        worked("oracle", oracle, {"PR": 100, "RR": 100, "F1": 1}, index),
        worked("oracle_nearest", oracle, {"PR": 100, "RR": 66.667, "F1": 0.8}, nearest),
    ]


def objects():
    """Objects by instance id: parked and moving ones, one of each with too few points, cars that
    park in one scan and move in another. Each loses another share of its points, some all but 5 %."""
    generator = random.Random(8)
    words = [10 | 1 << 16, 10 | 2 << 16, 252 | 2 << 16, 20 | 3 << 16, 254 | 4 << 16, 259 | 5 << 16,
             30 | 6 << 16, 253 | 7 << 16, 40, 70 | 8 << 16, 1 | 9 << 16]
    lost = [0.0, 0.5, 0.96, 0.05, 0.95, 0.94, 0.3, 1.0, 0.5, 0.06, 0.5]
    scans, removed = [], []
    for _ in range(3):
        scan = [(generator.uniform(3, 8), generator.uniform(3, 8), generator.uniform(-1, 2), word)
                for word in words for _ in range(100 if word >> 16 != 6 else 60)]
        seen = [lost[words.index(word)] for *_, word in scan]
        scans.append(scan)
        removed.append([i % 100 < round(100 * share) for i, share in enumerate(seen)])
    return Case("objects", scans, removed=removed)


def cases():
    """All of them."""
    static, moving = [40, 50], [252, 254]
    far = (0.25 * 2**21, -0.25 * 2**23, 0.25 * 2**9)
    return [
        walls(), ties(), near_ties(), limits(), empty_scans(), unlabelled(),
        rule("rule_parked", {"moving": [10, 252], "ignored": [40, 258]}),
        rule("rule_of_0_and_1", {"moving": [0, 254], "ignored": [1]}, {"min": 1, "max": 4.5}),
        rule("rule_of_1", {"moving": [1, 254], "ignored": []}),
        rule("rule_ignores_0", {"moving": [252, 253], "ignored": [0, 70, 259]}, settings=[
            {}, {"dynamicmap": {"ignored_in_estimate": False, "distance": 0.5}},
            {"dynamicmap": {"distance": 0.5}}]),
        turned("turned", (0, 0, 0)), turned("far", far), maps(),
        oblique("oblique", (0, 0, 0)), oblique("utm", (430123.0, 5400321.0, 250.0)),
        clouds(), objects(), *worked_cases(),
        one_sided("nothing_moves", static, 0.4), one_sided("all_moves", moving, 0.4),
        one_sided("nothing_removed", static + moving, 0.0),
        one_sided("all_removed", static + moving, 1.0),
        one_sided("nothing_moves_all_removed", static, 1.0),
        one_sided("all_moves_nothing_removed", moving, 0.0),
    ]
