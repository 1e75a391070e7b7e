# SPDX-License-Identifier: MIT
"""How far a long call is: a bar of tqdm, or what the caller does with it."""
from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Optional, Union


@dataclass(frozen=True)
class ProgressState:
    """How far a task is."""

    context: str  #: The larger task, such as "[2/10] octomap:ground on town"; may be empty.
    task: str
    done: int  #: Steps.
    total: int  #: Steps; 0 when the task has ended.


#: True: a bar if tqdm is installed; False: nothing; a function: it is called with the state.
Progress = Union[bool, Callable[[ProgressState], object]]
_OnProgress = Callable[[str, str, int, int, int], None]


class _Bar:
    """A bar of tqdm for each task."""

    def __init__(self, tqdm: Any) -> None:
        self._tqdm = tqdm
        self._bar: Any = None
        self._number = 0

    def show(self, context: str, task: str, number: int, done: int, total: int) -> None:
        if self._bar is not None and (number != self._number or total == 0):
            self.close()
        if total == 0:
            return
        if self._bar is None:
            text = f"{context}: {task}" if context else task
            self._bar = self._tqdm(total=total, desc=text, leave=False, unit="scan")
            self._number = number
        self._bar.update(done - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
            self._bar = None


@contextlib.contextmanager
def told(progress: Progress) -> Iterator[Optional[_OnProgress]]:
    """What the compiled part calls with how far it is; None if nobody wants to know."""
    if progress is False:
        yield None
    elif progress is True:
        try:
            from tqdm.auto import tqdm  # type: ignore
        except ImportError:
            yield None
            return
        bar = _Bar(tqdm)
        try:
            yield bar.show
        finally:
            bar.close()
    else:
        tell = progress
        yield lambda context, task, number, done, total: (
            tell(ProgressState(context, task, done, total)), None)[1]
