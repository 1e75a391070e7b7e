# SPDX-License-Identifier: MIT
"""A second opinion on mos, in plain Python: a matrix of what points are and what the answer says,
as semantic-kitti-api's evaluate_mos fills it."""
from collections import defaultdict

from sequence_files import distance_to_sensor, returns

DEFAULTS = {"ignore_unlabelled": True}


def score(sequence, **settings):
    """Counts of the protocol for the answer that the sequence carries."""
    options = {**DEFAULTS, **settings}
    counts = defaultdict(int)
    unlabelled = {0, 1} if options["ignore_unlabelled"] and not {0, 1} & sequence.moving else set()
    matrix = defaultdict(int)  # (moves, called moving)
    for _, point, label, removed in returns(sequence):
        if not sequence.range_min <= distance_to_sensor(point) <= sequence.range_max:
            counts["out_of_range_points"] += 1
        elif label in sequence.ignored or label in unlabelled:
            counts["ignored_points"] += 1
        else:
            matrix[label in sequence.moving, bool(removed)] += 1
    counts["static_points"] = matrix[False, False] + matrix[False, True]
    counts["dynamic_points"] = matrix[True, False] + matrix[True, True]
    counts["kept_static_points"] = matrix[False, False]
    counts["flagged_dynamic_points"] = matrix[True, True]
    return dict(counts)


def rates(counts):
    """Precision, recall and IoU of the moving class in percent; None where one is not defined."""
    hit, moving = counts["flagged_dynamic_points"], counts["dynamic_points"]
    wrong = counts["static_points"] - counts["kept_static_points"]
    return {"precision": 100 * hit / (hit + wrong) if hit + wrong else None,
            "recall": 100 * hit / moving if moving else None,
            "IoU": 100 * hit / (moving + wrong) if moving else None}
