"""Reports: a run, or several side by side, on one HTML page."""

from __future__ import annotations

import os
from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import Union

from . import _fretwork
from ._errors import InputError

AnyPath = Union[str, PathLike[str]]


def report(folder: AnyPath, *, size: float = 5.0, full: bool = False) -> Path:
    """Makes ``report.html`` in the folder of a run, finished or not, and returns its path.

    States, fields and rows are left out to stay below ``size`` (MB), which the page says, unless ``full``.

    Raises ``InputError`` if there is no run, ``RunError`` if the page cannot be written.
    """
    if not 0.5 <= size <= 2000.0:
        raise InputError(f"size={size}: give a size from 0.5 to 2000 (MB), or full=True")
    return Path(_fretwork.report(os.fspath(folder), None if full else int(size * 1e6)))


def compare(folders: Sequence[AnyPath], out: AnyPath = "compare.html") -> Path:
    """Puts runs side by side on a page, whose path is returned: verdicts, inputs that differ, results with their intervals, and
    figures over each other.

    Raises ``InputError`` if there are fewer than two folders or one has no run, ``RunError`` if the page cannot be written.
    """
    if len(folders) < 2:
        raise InputError("compare takes the folders of two or more runs")
    _fretwork.compare([os.fspath(folder) for folder in folders], os.fspath(out))
    return Path(out)
