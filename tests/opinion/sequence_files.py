# SPDX-License-Identifier: MIT
"""Reads a sequence in SemanticKITTI layout and the answer of a method, with nothing but Python.

It is written from the description of the layout and not from the program's reader, so that the two
check each other.
"""
import json
import math
from array import array
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

MOVING = frozenset(range(252, 260))
REMOVED = frozenset(range(251, 260))


@dataclass
class Scan:
    """One scan: points in the sensor frame (metres), label words, what the method removed."""

    points: list  # of (x, y, z)
    words: list
    removed: list
    camera_pose: list  # the row of poses.txt as a 4 x 4 matrix of fractions
    pose: list  # T_world_sensor: 3 rows of 4 floats

    def world(self, x, y, z):
        """A point of the sensor frame in the world."""
        return tuple(r[0] * x + r[1] * y + r[2] * z + r[3] for r in self.pose)


@dataclass
class Sequence:
    """Scans with what the folder says about them."""

    scans: list
    calibration: list  # Tr, a 4 x 4 matrix of fractions
    moving: frozenset = MOVING
    ignored: frozenset = frozenset()
    range_min: float = 0.0
    range_max: float = math.inf


def matrix_of(numbers):
    """A 4 x 4 matrix of fractions from the 12 numbers of its upper rows."""
    values = [Fraction(float(number)) for number in numbers]
    rows = [values[4 * i : 4 * i + 4] for i in range(3)]
    return rows + [[Fraction(0)] * 3 + [Fraction(1)]]


def product(a, b):
    """The exact product of two matrices of fractions."""
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def inverse(matrix):
    """The exact inverse of a 4 x 4 matrix of fractions (Gauss and Jordan)."""
    rows = [list(matrix[i]) + [Fraction(int(i == j)) for j in range(4)] for i in range(4)]
    for column in range(4):
        pivot = next(i for i in range(column, 4) if rows[i][column] != 0)
        rows[column], rows[pivot] = rows[pivot], rows[column]
        rows[column] = [value / rows[column][column] for value in rows[column]]
        for i in range(4):
            if i != column:
                factor = rows[i][column]
                rows[i] = [a - factor * b for a, b in zip(rows[i], rows[column])]
    return [row[4:] for row in rows]


def read_calibration(path):
    """The row Tr of calib.txt."""
    for line in Path(path).read_text().splitlines():
        name, _, numbers = line.partition(":")
        if name.strip() == "Tr":
            return matrix_of(numbers.split())
    raise ValueError(f"{path} has no row Tr")


def read_points(path):
    """Points of a .bin file: float32 x y z reflectance."""
    values = array("f")
    values.frombytes(Path(path).read_bytes())
    return list(zip(values[0::4], values[1::4], values[2::4]))


def read_words(path):
    """Words of a .label file: 32 bits for each point."""
    words = array("I")
    words.frombytes(Path(path).read_bytes())
    return words.tolist()


def read_sequence(folder, answers, first=0, last=None, stride=1, rule=None):
    """A sequence and an answer.

    folder: velodyne/, labels/, poses.txt, calib.txt and perhaps sequence.json
    answers: a folder of NNNNNN.label files, in which 251 to 259 mean removed
    rule: a dictionary as the key "labels" of sequence.json; it goes before that of the folder
    """
    folder = Path(folder)
    told = {}
    if (folder / "sequence.json").exists():
        told = json.loads((folder / "sequence.json").read_text())
    calibration = read_calibration(folder / "calib.txt")
    to_lidar = inverse(calibration)
    lines = (folder / "poses.txt").read_text().splitlines()
    rows = [line.split() for line in lines if line.strip()]
    scans = []
    for frame in range(first, len(rows) if last is None else last + 1, stride):
        camera_pose = matrix_of(rows[frame])
        exact = product(product(to_lidar, camera_pose), calibration)
        points = read_points(folder / "velodyne" / f"{frame:06d}.bin")
        words = read_words(folder / "labels" / f"{frame:06d}.label")
        answer = read_words(Path(answers) / f"{frame:06d}.label")
        assert len(points) == len(words) == len(answer), frame
        pose = [[float(value) for value in row] for row in exact[:3]]
        removed = [word & 0xFFFF in REMOVED for word in answer]
        scans.append(Scan(points, words, removed, camera_pose, pose))
    labels = rule if rule is not None else told.get("labels", {})
    limits = told.get("range_m", {})
    maximum = limits.get("max")
    return Sequence(
        scans,
        calibration,
        frozenset(labels.get("moving", MOVING)),
        frozenset(labels.get("ignored", ())),
        limits.get("min", 0.0),
        math.inf if maximum is None else maximum,
    )


def is_return(point):
    """Whether a point is a return: finite, and not the origin."""
    return all(math.isfinite(value) for value in point) and any(value != 0 for value in point)


def distance_to_sensor(point):
    """Range of a point of the sensor frame, metres."""
    return math.sqrt(point[0] * point[0] + point[1] * point[1] + point[2] * point[2])


def returns(sequence):
    """The points that are returns, with what is known of each: (scan, point, label id, removed)."""
    for scan, point, word, removed in returns_with_words(sequence):
        yield scan, point, word & 0xFFFF, removed


def returns_with_words(sequence):
    """The same with the whole label word, of which the upper 16 bits are the instance id."""
    for scan in sequence.scans:
        for point, word, removed in zip(scan.points, scan.words, scan.removed):
            if is_return(point):
                yield scan, point, word, removed
