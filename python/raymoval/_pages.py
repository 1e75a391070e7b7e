# SPDX-License-Identifier: MIT
"""Pages with a 3-D view, for notebooks and for files."""
from __future__ import annotations

import html
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Union

import numpy.typing as npt

from raymoval import _raymoval
from raymoval._progress import Progress, told
from raymoval._results import Run


class Page:
    """A page that needs nothing else. A notebook shows it; `save` writes it to a file."""

    def __init__(self, text: str, warnings: list[str], height: int) -> None:
        self.html = text
        self.warnings = warnings  #: What is missing from it.
        self.height = height  #: Pixels, in a notebook.

    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes it to a file for a browser."""
        Path(path).write_text(self.html, encoding="utf-8")

    def _repr_html_(self) -> str:
        return (f'<iframe srcdoc="{html.escape(self.html)}" width="100%" height="{self.height}" '
                'style="border:0"></iframe>')

    def __repr__(self) -> str:
        return f"<raymoval.Page of {len(self.html)} characters>"


def show(what: Union[Run, str, os.PathLike[str], _raymoval.Sequence],
         masks: Union[_raymoval.Masks, Iterable[npt.ArrayLike], None] = None, *,
         points: int = 300_000, height: int = 800, progress: Progress = True) -> Page:
    """The page of a run (a `Run` or its folder): tables, charts and the points in 3-D, if it was run
    with keep_removals; or of a sequence and its masks: what was kept and removed.

    points: the most that the page shows.
    """
    with told(progress) as on_progress:
        if isinstance(what, _raymoval.Sequence):
            if masks is None:
                raise _raymoval.UsageError("show(sequence, masks): the masks are missing.")
            return Page(_raymoval.masks_page(what, masks, points, on_progress), [], height)
        folder = what.folder if isinstance(what, Run) else os.fspath(what)
        text, warnings = _raymoval.run_page(folder, points, on_progress)
        return Page(text, warnings, height)


__all__ = ["Page", "show"]
