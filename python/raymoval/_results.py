# SPDX-License-Identifier: MIT
"""Scores of masks, and runs of many methods on many sequences."""
from __future__ import annotations

import os
import shutil
import tempfile
import weakref
from collections.abc import Iterable, Mapping, Sequence as AnySequence
from dataclasses import dataclass, field
from typing import Any, Optional, Union

import numpy.typing as npt

from raymoval import _raymoval
from raymoval._methods import MethodLike, Value, entry, setting_text
from raymoval._progress import Progress, told
from raymoval._sequences import open as open_sequence

Path = Union[str, os.PathLike[str]]


@dataclass(frozen=True)
class ProtocolScore:
    """What one protocol says of masks."""

    protocol: str
    counts: dict[str, int]
    rates: dict[str, Optional[float]]  #: In their units (see `describe`); None where undefined.
    undefined: dict[str, str]  #: Why a rate has no value.
    intervals: dict[str, tuple[float, float]]  #: 95 %, by block bootstrap over scans.
    warnings: list[str]

    def __getitem__(self, name: str) -> Optional[float]:
        """The value of a rate."""
        return self.rates[name]

    def __str__(self) -> str:
        parts = [f"{name} {'n/a' if value is None else format(value, '.4f')}"
                 for name, value in self.rates.items()]
        return f"{self.protocol}: {', '.join(parts)}"


@dataclass(frozen=True)
class Scores:
    """What all protocols say of masks: scores["erasor"]["F1"]."""

    protocols: dict[str, ProtocolScore]
    #: Shares of points by class, range and height: percent (None where undefined), part, whole.
    columns: dict[str, tuple[Optional[float], int, int]] = field(repr=False)

    def __getitem__(self, protocol: str) -> ProtocolScore:
        return self.protocols[protocol]

    def __str__(self) -> str:
        return "\n".join(str(score) for score in self.protocols.values())


def _option_texts(options: Optional[Mapping[str, Value]]) -> list[str]:
    return [f"{name}={setting_text(name, value)}" for name, value in (options or {}).items()]


def score(sequence: Union[_raymoval.Sequence, Path],
          masks: Union[_raymoval.Masks, Iterable[npt.ArrayLike]],
          protocols: Union[str, Iterable[str]] = ("erasor",), *,
          options: Optional[Mapping[str, Value]] = None, threads: int = 0,
          progress: Progress = True) -> Scores:
    """Scores an answer.

    sequence: of `open` or `from_arrays`, with labels.
    masks: for each scan N bool, True for what is removed, as `clean` gives them.
    protocols: names, see `protocols()`.
    options: of protocols by name, such as {"dynamicmap.distance": 0.1}.
    Raises DataError if there are no labels, MethodError for masks that do not fit.
    """
    opened = sequence if isinstance(sequence, _raymoval.Sequence) else open_sequence(
        sequence, progress=progress)
    names = [protocols] if isinstance(protocols, str) else list(protocols)
    with told(progress) as on_progress:
        scored = _raymoval.score(opened, masks, names, _option_texts(options), threads, on_progress)
    return Scores({one["protocol"]: ProtocolScore(**one) for one in scored["protocols"]},
                  scored["columns"])


class _TemporaryFolder:
    """A folder that goes with this object."""

    def __init__(self) -> None:
        self.name = tempfile.mkdtemp(prefix="raymoval-run-")
        weakref.finalize(self, shutil.rmtree, self.name, ignore_errors=True)


def _frame(rows: list[dict[str, Any]]) -> Any:
    try:
        import pandas  # type: ignore
    except ImportError:
        return rows
    return pandas.DataFrame(rows)


@dataclass(frozen=True)
class Run:
    """A run in its folder."""

    folder: str
    cells: int
    reused: int  #: Cells that were there already.
    failures: list[str]  #: "sequence / method: reason".
    control_problems: list[str]  #: Controls without their expected scores; empty if there are none.
    warnings: list[str]
    #: A temporary folder, which is removed with this object; None if the caller named a folder.
    temporary: Optional[_TemporaryFolder] = field(repr=False, default=None)

    @property
    def good(self) -> bool:
        """Whether no cell failed and the controls have their expected scores."""
        return not self.failures and not self.control_problems

    @property
    def rows(self) -> list[dict[str, Any]]:
        """A record for each cell and protocol, as in results.csv."""
        return _raymoval.load_run(self.folder)

    @property
    def frame(self) -> Any:
        """The rows as a pandas.DataFrame; as they are if there is no pandas."""
        return _frame(self.rows)

    def __str__(self) -> str:
        return _raymoval.summary_text(self.folder)


def run(sequences: Union[_raymoval.Sequence, Path, AnySequence[Union[_raymoval.Sequence, Path]]],
        methods: Union[MethodLike, AnySequence[MethodLike]], *, out: Optional[Path] = None,
        protocols: Union[str, Iterable[str]] = ("erasor",),
        settings: Optional[Mapping[str, Value]] = None, controls: bool = True,
        keep_removals: bool = False, overwrite: bool = False, threads: int = 0,
        progress: Progress = True) -> Run:
    """Runs methods on sequences and scores them, as `raymoval run` does, in this process.

    sequences: paths or scenes, or sequences that `open` gave; all with labels.
    methods: names, `Remover` objects of yours, or their classes.
    out: folder for the results. Cells that are there already are kept. Without it they are gone
        with the object that is returned.
    settings: parameters by method, {"erasor.scan_ratio_threshold": 0.3}, and options of protocols,
        {"protocol:dynamicmap.distance": 0.1}.
    controls: whether noop, remove-all and oracle are added and checked.
    keep_removals: whether what was removed is kept, so that `show` has a 3-D view.
    A method that fails is a failed cell of the run, and no exception.
    """
    listed = sequences if isinstance(sequences, (list, tuple)) else [sequences]
    opened = [one if isinstance(one, _raymoval.Sequence) else open_sequence(one, progress=progress)
              for one in listed]
    chosen = methods if isinstance(methods, (list, tuple)) else [methods]
    given: list[Union[str, dict[str, Any]]] = [
        one if isinstance(one, str) else entry(one) for one in chosen]
    names = [protocols] if isinstance(protocols, str) else list(protocols)
    temporary = _TemporaryFolder() if out is None else None
    folder = os.fspath(out) if out is not None else temporary.name  # type: ignore[union-attr]
    with told(progress) as on_progress:
        summary = _raymoval.run(opened, given, names, _option_texts(settings), folder, controls,
                                keep_removals, overwrite, threads, on_progress)
    return Run(folder=folder, temporary=temporary, **summary)


def _folder_of(run_or_folder: Union[Run, Path]) -> str:
    return run_or_folder.folder if isinstance(run_or_folder, Run) else os.fspath(run_or_folder)


def load_run(folder: Union[Run, Path]) -> Any:
    """The results of a run folder, a row for each cell and protocol: a pandas.DataFrame if pandas
    is installed, else a list of dicts.

    Raises UsageError if there is no run, DataError if its files are damaged.
    """
    return _frame(_raymoval.load_run(_folder_of(folder)))


@dataclass(frozen=True)
class Comparison:
    """What is not the same in two runs, in sentences."""

    verdict: str  #: "not comparable", "worse", "better, no regression" or "no regression".
    exit_code: int  #: That of `raymoval compare`: 0 the same or better, 1 worse, 2 not comparable.
    worse: list[str]
    better: list[str]
    moved: list[str]
    incomparable: list[str]
    times: list[str]
    cells: int  #: Of the reference.
    same_cells: int
    text: str = field(repr=False)

    def __str__(self) -> str:
        return self.text


def compare(run: Union[Run, Path], reference: Union[Run, Path], *,
            tolerances: Optional[Mapping[str, float]] = None, across: Iterable[str] = (),
            time_band: Optional[float] = None) -> Comparison:
    """Compares a run with a reference cell by cell, as `raymoval compare` does.

    tolerances: how much worse a rate may get, in its own unit: {"F1": 0.01}.
    across: what may differ: "parameters", "version".
    time_band: a method that is slower by more than this factor is worse.
    """
    return Comparison(**_raymoval.compare(_folder_of(run), _folder_of(reference),
                                          dict(tolerances or {}), list(across), time_band))
