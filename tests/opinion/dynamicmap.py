# SPDX-License-Identifier: MIT
"""A second opinion on the protocol of KTH's DynamicMap benchmark, in plain Python.

Each point of all scans is looked for among the kept points: it is present if one lies at most a
distance away. A static point should be present, a moving one gone.
"""
import math
from collections import defaultdict

from erasor import Buckets, square
from sequence_files import distance_to_sensor, returns

DEFAULTS = {
    "distance": 0.05,
    "maximum_range": 0.0,
    "ego_range": 3.0,
    "ignored_in_estimate": True,
}


def judged_points(sequence, options, counts):
    """(world point, moves, removed, ignored) of the points that are on some side."""
    # Where 0 or 1 move they are not SemanticKITTI's "unlabelled" and "outlier".
    ego_labels = set() if {0, 1} & sequence.moving else {0, 1} - sequence.ignored
    for scan, point, label, removed in returns(sequence):
        distance = distance_to_sensor(point)
        limit = options["maximum_range"] or math.inf
        if not sequence.range_min <= distance <= sequence.range_max or distance >= limit:
            counts["out_of_range_points"] += 1
            continue
        ignored = label in sequence.ignored
        counts["ignored_points"] += ignored
        moves = label in sequence.moving
        if label in ego_labels and distance < options["ego_range"]:
            counts["ego_points"] += 1
            moves = True
        yield scan.world(*point), moves, removed, ignored


def is_present(buckets, point, limit):
    """Whether a kept point lies at most the distance away."""
    for _, index in buckets.within(point, limit):
        if square(point, buckets.points[index]) <= limit * limit:
            return True
    return False


def score(sequence, cloud=None, **settings):
    """Counts of the protocol for the answer that the sequence carries, or for a cleaned map, whose
    points are given in the world."""
    options = {**DEFAULTS, **settings}
    counts = defaultdict(int)
    judged = list(judged_points(sequence, options, counts))
    with_ignored = options["ignored_in_estimate"]
    kept = [p for p, _, removed, ignored in judged if not removed and (with_ignored or not ignored)]
    if cloud is not None:
        kept = cloud
    buckets = Buckets(kept, max(options["distance"], 0.05))
    present = {}
    for point, moves, removed, ignored in judged:
        if ignored:
            continue
        if point not in present:
            present[point] = is_present(buckets, point, options["distance"])
        if cloud is not None:
            removed = not present[point]
        if moves:
            counts["dynamic_points"] += 1
            counts["removed_dynamic_points"] += not present[point]
            counts["flagged_dynamic_points"] += removed
        else:
            counts["static_points"] += 1
            counts["present_static_points"] += present[point]
            counts["kept_static_points"] += not removed
    return dict(counts)


def rates(counts):
    """SA, DA, AA and HA in percent; None where one is not defined."""
    static, dynamic = counts.get("static_points", 0), counts.get("dynamic_points", 0)
    kept = 100 * counts.get("present_static_points", 0) / static if static else None
    gone = 100 * counts.get("removed_dynamic_points", 0) / dynamic if dynamic else None
    return {"SA": kept, "DA": gone, **means(kept, gone)}


def means(kept, gone):
    """The geometric and the harmonic mean of two rates; 0 if both are 0."""
    if kept is None or gone is None:
        return {"AA": None, "HA": None}
    harmonic = 2 * kept * gone / (kept + gone) if kept + gone else 0.0
    return {"AA": math.sqrt(kept * gone), "HA": harmonic}
