# SPDX-License-Identifier: MIT
"""Removes moving objects from LiDAR maps, and scores methods that do.

    import raymoval
    masks = raymoval.clean(scans, poses)          # scans: arrays N x 3; poses: n x 4 x 4
    static = [scan[~mask] for scan, mask in zip(scans, masks)]

Lengths are in metres, angles in radians, times in seconds. A pose is T_world_sensor: it takes points
of the sensor's frame to the world's. Functions that take long let other threads run, show a bar if
tqdm is installed (`progress=False` shows none; a function of yours is called with a
`ProgressState`), and stop on Ctrl-C.
"""
from raymoval._methods import Remover, describe, methods, protocols
from raymoval._progress import ProgressState
from raymoval._raymoval import (Cancelled, ConfigurationError, DataError, Error, InternalError,
                                Masks, MethodError, Scan, Scans, SensorModel, Sequence, Sink,
                                UsageError, __version__, scenes, sensors)
from raymoval._results import (Comparison, ProtocolScore, Run, Scores, compare, load_run, run,
                               score)
from raymoval._sequences import clean, estimate, from_arrays, open, refine, times

__all__ = [
    "Cancelled", "Comparison", "ConfigurationError", "DataError", "Error", "InternalError",
    "Masks", "MethodError", "ProgressState", "ProtocolScore", "Remover", "Run", "Scan",
    "Scans", "Scores", "SensorModel", "Sequence", "Sink", "UsageError", "__version__",
    "clean", "compare", "describe", "estimate", "from_arrays", "load_run", "methods", "open", "protocols",
    "refine", "run", "scenes", "score", "sensors", "times",
]
