# SPDX-License-Identifier: MIT
"""A second opinion on the columns: shares of points by class, range, height and time."""
from collections import defaultdict

from dynamicmap import is_present
from erasor import Buckets
from sequence_files import distance_to_sensor, returns_with_words

RANGES = [(0, 10, "0-10 m"), (10, 20, "10-20 m"), (20, 30, "20-30 m"), (30, 40, "30-40 m"),
          (40, 50, "40-50 m"), (50, float("inf"), "50 m and more")]
HEIGHTS = [(float("-inf"), 0.3, "below 0.3 m"), (0.3, 1, "0.3-1 m"), (1, 2, "1-2 m"),
           (2, 4, "2-4 m"), (4, float("inf"), "4 m and more")]
NAMES = {
    0: "unlabelled", 1: "outlier", 10: "car", 11: "bicycle", 13: "bus", 15: "motorcycle",
    16: "on-rails", 18: "truck", 20: "other-vehicle", 30: "person", 31: "bicyclist",
    32: "motorcyclist", 40: "road", 44: "parking", 48: "sidewalk", 49: "other-ground",
    50: "building", 51: "fence", 52: "other-structure", 60: "lane-marking", 70: "vegetation",
    71: "trunk", 72: "terrain", 80: "pole", 81: "traffic-sign", 99: "other-object",
    252: "moving-car", 253: "moving-bicyclist", 254: "moving-person", 255: "moving-motorcyclist",
    256: "moving-on-rails", 257: "moving-bus", 258: "moving-truck", 259: "moving-other-vehicle",
}
SENSOR_HEIGHT = 1.73  # metres
CROP = 2.7  # metres
NEAR = 0.05  # metres
FEWEST_POINTS = 200  # of an object


def bin_of(value, bins):
    """The name of the bin of a value; its lower end belongs to it."""
    return next(name for low, high, name in bins if low <= value < high)


def of_objects(objects, moving, names):
    """The columns of objects. objects: [removed or not, ...] by (class, instance)."""
    large = {key: answers for key, answers in objects.items() if len(answers) >= FEWEST_POINTS}
    kept = []
    for (label, instance), answers in large.items():
        moving_names = {names.get(other, f"label-{other}") for other, its in objects if its == instance}
        if label not in moving and "moving-" + names.get(label, f"label-{label}") not in moving_names:
            kept.append((answers.count(False), len(answers)))
    gone = [answers.count(True) / len(answers) for (label, _), answers in large.items() if label in moving]
    columns = {}
    if kept:
        columns["parked"] = (sum((2 * 10**6 * part + whole) // (2 * whole) for part, whole in kept),
                             10**6 * len(kept))
        columns["parked worst"] = min(kept, key=lambda share: share[0] / share[1])
        columns["parked below 95 %"] = (sum(part / whole < 0.95 for part, whole in kept), len(kept))
    if gone:
        columns["trails"] = (sum(share >= 0.95 for share in gone), len(gone))
    return columns


def values(sequence, names=None, cloud=None):
    """(part, whole) of each column that has points.

    names: those of classes
    cloud: points of a cleaned map in the world; a point is removed if none lies within 0.05 m
    """
    names = NAMES if names is None else names
    buckets = None if cloud is None else Buckets(cloud, NEAR)
    columns = defaultdict(lambda: [0, 0])
    objects = defaultdict(list)
    tenths = {id(scan): 10 * i // len(sequence.scans) for i, scan in enumerate(sequence.scans)}

    def count(name, hit):
        columns[name][0] += hit
        columns[name][1] += 1

    for scan, point, word, removed in returns_with_words(sequence):
        label, instance = word & 0xFFFF, word >> 16
        if buckets:
            removed = not is_present(buckets, scan.world(*point), NEAR)
        distance = distance_to_sensor(point)
        if not sequence.range_min <= distance <= sequence.range_max or label in sequence.ignored:
            continue
        if point[0] * point[0] + point[1] * point[1] < CROP * CROP:
            continue
        moves = label in sequence.moving
        if instance:
            objects[label, instance].append(bool(removed))
        if removed:
            count("precision", moves)
        else:
            count("residue", moves)
        if moves:
            count("recall", removed)
        name, hit = ("rejection", removed) if moves else ("preservation", not removed)
        of_range = "range " + bin_of(distance, RANGES)
        of_height = "height " + bin_of(point[2] + SENSOR_HEIGHT, HEIGHTS)
        of_class = names.get(label, f"label-{label}")
        tenth = tenths[id(scan)]
        of_time = f"time {10 * tenth}-{10 * tenth + 10} %"
        count(name, hit)
        for what in (of_range, of_height, of_time, of_class):
            count(f"{name} [{what}]", hit)
        for what in (of_range, of_height):
            count(f"{name} [{of_class}, {what}]", hit)
    return {name: tuple(numbers) for name, numbers in columns.items()} | of_objects(
        objects, sequence.moving, names)
