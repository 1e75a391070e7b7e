# SPDX-License-Identifier: MIT
"""Sequences of scans, and cleaning them."""
from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Sequence
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from raymoval import _raymoval
from raymoval._methods import MethodLike, Remover, remover_name, setting_text
from raymoval._progress import Progress, told

Floats = npt.NDArray[np.floating[Any]]


def open(path: Union[str, os.PathLike[str]], *, frames: Optional[str] = None,
         threads: int = 0, progress: Progress = True, **options: Any) -> _raymoval.Sequence:
    """Opens a sequence as the program does: a folder of scans with poses, a data set, a recording,
    or a scene by its name ("street", "town:scans=60"), which is simulated at its first use.

    frames: "FIRST:LAST:STRIDE" of frame numbers, ends included; each may be left out.
    options: as `raymoval clean --help` lists them, with _ for -: poses, pose_format, T_sensor,
        time_offset, max_gap, points, point_layout, deskew, point_time_unit, label_rule, range,
        sensor, up, drop_ego, skip_bad_scans, name, topic, pose_topic.
    Raises DataError, UsageError or ConfigurationError that say what was found and expected.
    """
    given = {key: value for key, value in options.items() if value is not None}
    if frames is not None:
        given["frames"] = frames
    with told(progress) as on_progress:
        return _raymoval.open(os.fspath(path), given, threads, on_progress)


def from_arrays(scans: Iterable[npt.ArrayLike], poses: npt.ArrayLike, *,
                times: Optional[npt.ArrayLike] = None,
                sensor: Union[str, _raymoval.SensorModel, None] = None,
                up: Optional[str] = None,
                labels: Optional[Iterable[npt.ArrayLike]] = None,
                name: str = "arrays") -> _raymoval.Sequence:
    """A sequence of arrays, as `clean` makes it, to be used more than once or scored.

    scans: arrays N x 3 or N x 4 (x, y, z, reflectance), float32 or float64, in the sensor's frame,
        NaN where nothing came back. A list or a 3-D array is used where it is; another sequence is
        asked for its scans when they are needed; a generator is written to a file below TMPDIR.
    poses: n x 4 x 4, T_world_sensor of each scan.
    times: n seconds; without them a scan comes each 0.1 s.
    sensor: name of a known sensor (see `sensors`), or a model; estimated from the scans without.
    up: the direction of the world that is up, such as "-y"; estimated from the scans without.
    labels: for each scan N label words of SemanticKITTI (252 to 259 move), so that methods can be
        scored.
    """
    given = None if times is None else np.asarray(times, dtype=np.float64).ravel().tolist()
    return _raymoval.from_arrays(scans, poses, given, sensor, up, labels, name)


def clean(scans: Union[_raymoval.Sequence, Iterable[npt.ArrayLike]],
          poses: Optional[npt.ArrayLike] = None, method: MethodLike = "raymoval_plus", *,
          times: Optional[npt.ArrayLike] = None,
          sensor: Union[str, _raymoval.SensorModel, None] = None,
          up: Optional[str] = None, threads: int = 0, progress: Progress = True,
          **parameters: Union[bool, int, float, str]) -> _raymoval.Masks:
    """Finds the points of moving objects.

    scans, poses, times, sensor, up: as `from_arrays`; or one sequence of `open`, which has all.
    method: its name ("erasor:version2", see `methods`), or a `Remover` of yours.
    threads: how many it may use; 0: as many as there are. The answer does not depend on it.
    parameters: those of the method, see `describe`.
    Returns for each scan N bool, True for each point to remove, in the order of its array. Rows
    without a return are False.
    Raises UsageError, DataError, ConfigurationError, MethodError; what a `Remover` of yours raises;
    KeyboardInterrupt.
    """
    if isinstance(scans, _raymoval.Sequence):
        if poses is not None or times is not None or sensor is not None or up is not None:
            raise _raymoval.UsageError("an opened sequence has poses, times, sensor and up of its "
                                       "own; give them to raymoval.open.")
        sequence = scans
    else:
        sequence = from_arrays(scans, poses, times=times, sensor=sensor, up=up)  # type: ignore[arg-type]
    if isinstance(method, type) and issubclass(method, Remover):
        method = method()
    with told(progress) as on_progress:
        if isinstance(method, str):
            settings = [(name, setting_text(name, value)) for name, value in parameters.items()]
            return _raymoval.clean(sequence, method, settings, threads, on_progress)
        if parameters:
            raise _raymoval.UsageError("a Remover has its parameters as attributes; set them there, "
                                       f"not in the call: {', '.join(parameters)}.")
        return _raymoval.clean_with(sequence, remover_name(method), method, threads, on_progress)


def _with_new_poses(sequence: _raymoval.Sequence, refines: bool,
                    file: Union[str, os.PathLike[str], None], threads: int,
                    progress: Progress) -> npt.NDArray[np.float64]:
    with told(progress) as on_progress:
        poses, notes = _raymoval.make_poses(sequence, refines, "" if file is None else os.fspath(file),
                                            threads, on_progress)
    for note in notes:
        if not note.startswith(("The poses are estimated", "The poses are refined")):
            warnings.warn(note, stacklevel=3)
    return poses


def estimate(scans: Union[_raymoval.Sequence, Sequence[npt.ArrayLike]], *,
             times: Optional[npt.ArrayLike] = None,
             file: Union[str, os.PathLike[str], None] = None, threads: int = 0,
             progress: Progress = True) -> npt.NDArray[np.float64]:
    """Estimates the poses of scans from the scans alone.

    scans, times: as `from_arrays`; or a sequence of `open`, whose poses are not used.
    file: also writes the poses, in TUM's format, or in KITTI's if the name ends in .kitti or
        _kitti.txt. An existing file is replaced.
    threads: how many it may use; 0: as many as there are. The answer does not depend on it.
    Returns n x 4 x 4, T_world_sensor; the first is the identity, or near it after a closed loop.
    Warns of scans whose motion is uncertain, and of a sensor at rest.
    Raises DataError that names the scan that does not overlap with those before it.
    """
    if not isinstance(scans, _raymoval.Sequence):
        scans = list(scans)
        scans = from_arrays(scans, np.tile(np.eye(4), (len(scans), 1, 1)), times=times)
    return _with_new_poses(scans, False, file, threads, progress)


def refine(scans: Union[_raymoval.Sequence, Iterable[npt.ArrayLike]],
           poses: Optional[npt.ArrayLike] = None, *, times: Optional[npt.ArrayLike] = None,
           file: Union[str, os.PathLike[str], None] = None, threads: int = 0,
           progress: Progress = True) -> npt.NDArray[np.float64]:
    """Improves the poses of scans: noise, jumps, and drift on a return to a place.

    scans, poses, times: as `from_arrays`; or one sequence of `open`, which has all.
    file, threads: as `estimate`.
    Returns n x 4 x 4, in the world frame of the given poses. Those are returned, with a warning, if
    refined poses would fit the scans worse.
    """
    if not isinstance(scans, _raymoval.Sequence):
        scans = from_arrays(scans, poses, times=times)  # type: ignore[arg-type]
    elif poses is not None or times is not None:
        raise _raymoval.UsageError("an opened sequence has poses and times of its own.")
    return _with_new_poses(scans, True, file, threads, progress)


def times(sequence: _raymoval.Sequence, *, progress: Progress = True) -> npt.NDArray[np.float64]:
    """The times of all scans, n seconds since the first scan of the data set. Reads all of them;
    `Scan.time` is that of one."""
    with told(progress) as on_progress:
        return _raymoval.times(sequence, on_progress)


__all__ = ["clean", "estimate", "from_arrays", "open", "refine", "times"]
