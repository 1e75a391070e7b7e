# SPDX-License-Identifier: MIT
"""A second opinion on the ERASOR protocol, in plain Python, slow and short.

Written from docs of the protocol alone: the map of all scans is voxelised twice (each scan, then
their sum), each voxel's centroid takes the label of the nearest point of the input, and a voxel of
the truth is found again if the nearest centroid of the estimate lies nearer than half a diagonal
and has its class.
"""
import math
from collections import defaultdict

from sequence_files import distance_to_sensor, is_return, matrix_of, product

DEFAULTS = {
    "voxel_size": 0.2,
    "minimum_horizontal_range": 2.7,
    "lift": 1.73,
    "frame": "sequence",
    "truck_is_moving": True,
    "ignore_0_1": False,
    "label_rule": "both",
    "matching": "radius",
    "label_mode": "index",
}
TIE = 1e-9  # metres
CLASSED = ("static_voxels", "dynamic_voxels", "preserved_static", "remaining_dynamic")

# KITTI's Tr of sequences 04 to 12, which ERASOR's map tool has for all.
FIXED_TR = """-1.857739385241e-03 -9.999659513510e-01 -8.039975204516e-03 -4.784029760483e-03
    -6.481465826011e-03 8.051860151134e-03 -9.999466081774e-01 -7.337429464231e-02
    9.999773098287e-01 -1.805528627661e-03 -6.496203536139e-03 -3.339968064433e-01"""
FORWARD_LEFT_UP = "0 0 1 0 -1 0 0 0 0 -1 0 0"


def cell_of(point, inverse_size):
    """The voxel of a point; a point on a wall belongs to the upper one."""
    return tuple(math.floor(value * inverse_size) for value in point)


def square(a, b):
    """The squared distance of two points."""
    dx, dy, dz = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return dx * dx + dy * dy + dz * dz


class Buckets:
    """Points by voxel, to search exactly and without a limit on distance."""

    def __init__(self, points, size):
        self.points = points
        self.size = size
        self.inverse = 1.0 / size
        self.cells = defaultdict(list)
        for index, point in enumerate(points):
            self.cells[cell_of(point, self.inverse)].append(index)

    def within(self, centre, radius):
        """(distance, index) of all points whose distance is at most radius, and of some beyond."""
        low = cell_of([value - radius for value in centre], self.inverse)
        high = cell_of([value + radius for value in centre], self.inverse)
        for x in range(low[0], high[0] + 1):
            for y in range(low[1], high[1] + 1):
                for z in range(low[2], high[2] + 1):
                    for index in self.cells.get((x, y, z), ()):
                        yield math.sqrt(square(centre, self.points[index])), index

    def nearest_ties(self, centre, reach):
        """Indices of the points that are nearest to centre, up to TIE; reach is a first guess."""
        while True:
            found = sorted(self.within(centre, reach))
            if found and found[0][0] + TIE <= reach:
                limit = found[0][0] + TIE
                return sorted(index for distance, index in found if distance <= limit)
            reach = found[0][0] + 2 * TIE if found else 2 * reach


def voxelise(points, labels, size, moving):
    """Centroids of the voxels, x fastest, with the label of the nearest point of the input.

    Returns points, labels, cells, and the number of voxels with a tie between a label that moves
    and one that does not.
    """
    buckets = Buckets(points, size)
    centroids, votes, cells, ties = [], [], [], 0
    for cell in sorted(buckets.cells, key=lambda c: (c[2], c[1], c[0])):
        inside = buckets.cells[cell]
        sums = (math.fsum(points[i][axis] for i in inside) for axis in range(3))
        centroid = tuple(total / len(inside) for total in sums)
        reach = min(math.sqrt(square(centroid, points[i])) for i in inside) + 2 * TIE
        nearest = buckets.nearest_ties(centroid, reach)
        ties += len({labels[i] in moving for i in nearest}) > 1
        centroids.append(centroid)
        votes.append(labels[nearest[0]])
        cells.append(cell)
    return centroids, votes, cells, ties


def poses_in(sequence, frame):
    """A function from a scan and a point of the sensor frame to the world of the map."""
    if frame == "sequence":
        return lambda scan: scan.pose
    axes, fixed = matrix_of(FORWARD_LEFT_UP.split()), matrix_of(FIXED_TR.split())

    def pose_of(scan):
        exact = product(product(axes, scan.camera_pose), fixed)
        return [[float(value) for value in row] for row in exact[:3]]

    return pose_of


def dense_map(sequence, options, moving, kept_only, counts):
    """Per-scan voxelised clouds, one after the other."""
    points, labels, ties = [], [], 0
    pose_of = poses_in(sequence, options["frame"])
    crop = options["minimum_horizontal_range"]
    for scan in sequence.scans:
        rows = pose_of(scan)
        placed, ids = [], []
        for point, word, removed in zip(scan.points, scan.words, scan.removed):
            if not is_return(point):
                continue
            label = word & 0xFFFF
            fate = "evaluated_points"
            if not sequence.range_min <= distance_to_sensor(point) <= sequence.range_max:
                fate = "out_of_range_points"
            elif label in sequence.ignored:
                fate = "ignored_points"
            elif point[0] * point[0] + point[1] * point[1] < crop * crop:
                fate = "cropped_points"
            counts[fate] += 1
            if fate != "evaluated_points":
                continue
            counts["removed_points"] += removed
            if kept_only and removed:
                continue
            x, y, z = point[0], point[1], point[2] + options["lift"]
            placed.append(tuple(r[0] * x + r[1] * y + r[2] * z + r[3] for r in rows))
            ids.append(label)
        centroids, votes, _, mixed = voxelise(placed, ids, options["voxel_size"], moving)
        points += centroids
        labels += votes
        ties += mixed
    return points, labels, ties


def partner(buckets, cells, point, cell, options, limit):
    """Index of the estimate's voxel that answers for a voxel of the truth, or None."""
    if options["matching"] == "same_cell":
        return cells.get(cell)
    best = None
    for _, index in buckets.within(point, math.sqrt(limit)):
        candidate = (square(point, buckets.points[index]), index)
        if candidate[0] < limit and (best is None or candidate < best):
            best = candidate
    return None if best is None else best[1]


def score(sequence, cloud=None, **settings):
    """Counts of the protocol for the answer that the sequence carries, or for a cleaned map.

    cloud: points of the map in the world; its labels are those of the nearest points of the dense
    map. It carries no lift, so that the truth should have none either.
    """
    options = {**DEFAULTS, **settings}
    size = options["voxel_size"]
    moving = sequence.moving if options["truck_is_moving"] else sequence.moving - {258}
    counts = defaultdict(int)
    dense, dense_labels, truth_ties = dense_map(sequence, options, moving, False, counts)
    truth, truth_labels, truth_cells, mixed = voxelise(dense, dense_labels, size, moving)
    counts["mixed_label_ties"] = truth_ties + mixed
    kept_ties = 0
    if cloud is None:
        kept, kept_labels, kept_ties = dense_map(sequence, options, moving, True, defaultdict(int))
    else:
        kept, kept_labels = cloud, [None] * len(cloud)
        counts["cloud_points"] = len(cloud)
        del counts["removed_points"]
    estimate, estimate_labels, estimate_cells, mixed = voxelise(kept, kept_labels, size, moving)
    counts["estimate_mixed_label_ties"] = kept_ties + mixed
    if cloud is not None or options["label_mode"] == "nearest":
        source = Buckets(dense, size)
        nearest = [source.nearest_ties(point, size) for point in estimate]
        estimate_labels = [dense_labels[indices[0]] for indices in nearest]
    truth = truth, truth_labels, truth_cells
    estimate = estimate, estimate_labels, estimate_cells
    count_matches(counts, options, moving, truth, estimate)
    add_no_truck(counts, options, moving, truth, estimate)
    return dict(counts)


def add_no_truck(counts, options, moving, truth, estimate):
    """Adds the counts of the list without 258 (moving truck) if they are others."""
    if 258 not in moving:
        return
    others = defaultdict(int)
    count_matches(others, options, moving - {258}, truth, estimate)
    if any(others[name] != counts[name] for name in CLASSED):
        counts.update({f"{name}_no_truck": others[name] for name in CLASSED})


def count_matches(counts, options, moving, truth, estimate):
    """Finds the voxels of the truth again, and counts the estimate's that belong to none."""
    limit = 0.75 * options["voxel_size"] ** 2
    buckets = Buckets(estimate[0], options["voxel_size"])
    cells = {cell: index for index, cell in enumerate(estimate[2])}
    for name in CLASSED:
        counts[name] += 0
    for point, label, cell in zip(*truth):
        counts["unlabelled_voxels"] += label in (0, 1)
        if options["ignore_0_1"] and label in (0, 1):
            continue
        moves = label in moving
        counts["dynamic_voxels" if moves else "static_voxels"] += 1
        index = partner(buckets, cells, point, cell, options, limit)
        if index is None:
            continue
        agrees = options["label_rule"] == "geometry" or (estimate[1][index] in moving) == moves
        if agrees:
            counts["remaining_dynamic" if moves else "preserved_static"] += 1
    counts["estimate_voxels"] = len(estimate[0])
    owners = Buckets(truth[0], options["voxel_size"])
    counts["estimate_voxels_without_partner"] = sum(
        all(square(point, truth[0][index]) >= limit
            for _, index in owners.within(point, math.sqrt(limit)))
        for point in estimate[0])


def rates(counts):
    """PR and RR in percent, F1 as a fraction; None where one is not defined."""
    named = rates_of(*(counts[name] for name in CLASSED))
    if "static_voxels_no_truck" in counts:
        others = rates_of(*(counts[f"{name}_no_truck"] for name in CLASSED))
        named.update({f"{name}_no_truck": rate for name, rate in others.items()})
    return named


def rates_of(static, dynamic, preserved, remaining):
    """PR, RR and F1 of four counts."""
    kept = preserved / static if static else None
    gone = (dynamic - remaining) / dynamic if dynamic else None
    harmonic = None
    if kept is not None and gone is not None:
        harmonic = 2 * kept * gone / (kept + gone) if kept + gone else 0.0
    return {"PR": None if kept is None else 100 * kept, "RR": None if gone is None else 100 * gone,
            "F1": harmonic}
