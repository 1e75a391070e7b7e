# SPDX-License-Identifier: MIT
"""A second opinion on dynamicmap-strict, in plain Python: cells of static points of which one is
kept, and cells of moving points of which all are removed."""
from collections import defaultdict

from dynamicmap import judged_points, means
from erasor import cell_of

DEFAULTS = {"voxel_size": 0.1, "maximum_range": 0.0, "ego_range": 3.0}


def score(sequence, **settings):
    """Counts of the protocol for the answer that the sequence carries."""
    options = {**DEFAULTS, **settings}
    counts = defaultdict(int)
    cells = {"static": set(), "dynamic": set()}
    kept = {"static": set(), "dynamic": set()}
    for point, moves, removed, ignored in judged_points(sequence, options, counts):
        if ignored:
            continue
        side = "dynamic" if moves else "static"
        cell = cell_of(point, 1.0 / options["voxel_size"])
        cells[side].add(cell)
        if not removed:
            kept[side].add(cell)
    counts["static_voxels"] = len(cells["static"])
    counts["dynamic_voxels"] = len(cells["dynamic"])
    counts["preserved_static"] = len(kept["static"])
    counts["remaining_dynamic"] = len(kept["dynamic"])
    counts["mixed_voxels"] = len(cells["static"] & cells["dynamic"])
    return dict(counts)


def rates(counts):
    """SA, DA, AA and HA in percent; None where one is not defined."""
    static, dynamic = counts["static_voxels"], counts["dynamic_voxels"]
    kept = 100 * counts["preserved_static"] / static if static else None
    gone = 100 * (dynamic - counts["remaining_dynamic"]) / dynamic if dynamic else None
    return {"SA": kept, "DA": gone, **means(kept, gone)}
