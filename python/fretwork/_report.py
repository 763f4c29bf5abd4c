"""Reports: a run, or several side by side, on one HTML page, with measured curves in their figures."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Union

from . import _fretwork
from ._errors import InputError

AnyPath = Union[str, PathLike[str]]
Measured = Union[AnyPath, Sequence[AnyPath]]
"""A table of a measured curve, or several."""


def _measured(
    measured: Measured, columns: Mapping[str, str] | None, depth: str | float | None
) -> tuple[list[str], list[str], str | None]:
    files = [measured] if isinstance(measured, (str, PathLike)) else list(measured)
    if not files and (columns or depth is not None):
        raise InputError("columns and depth are those of measured curves: give measured")
    named = [f"{name}={column}" for name, column in (columns or {}).items()]
    length = None if depth is None else depth if isinstance(depth, str) else repr(float(depth))
    return [os.fspath(file) for file in files], named, length


def report(
    folder: AnyPath,
    *,
    size: float = 5.0,
    full: bool = False,
    measured: Measured = (),
    columns: Mapping[str, str] | None = None,
    depth: str | float | None = None,
) -> Path:
    """Makes ``report.html`` in the folder of a run, finished or not, and returns its path.

    States, fields and rows are left out to stay below ``size`` (MB), which the page says, unless ``full``.
    ``measured`` is a table of a measured loop, of friction by cycle or of a scar, or several, drawn in the figure of its kind, there
    and as ``NAME_measured.png``; ``columns`` says which its columns are where they are named otherwise, ``{"delta": "Weg (um)"}``;
    ``depth`` is the length of the contact across the motion (m, or a text with a unit), by which a force is divided for a run in two
    dimensions. ``docs/report.md`` has the kinds of tables.

    Raises ``InputError`` if there is no run or a curve does not fit to it, ``RunError`` if the page cannot be written.
    """
    if not 0.5 <= size <= 2000.0:
        raise InputError(f"size={size}: give a size from 0.5 to 2000 (MB), or full=True")
    curves = _measured(measured, columns, depth)
    return Path(_fretwork.report(os.fspath(folder), None if full else int(size * 1e6), *curves))


def compare(
    folders: Sequence[AnyPath],
    out: AnyPath = "compare.html",
    *,
    measured: Measured = (),
    columns: Mapping[str, str] | None = None,
    depth: str | float | None = None,
) -> Path:
    """Puts runs side by side on a page, whose path is returned: verdicts, inputs that differ, results with their intervals, and
    figures over each other. ``measured``, ``columns`` and ``depth`` are those of :func:`report`.

    Raises ``InputError`` if there are fewer than two folders, one has no run or a curve does not fit to them, ``RunError`` if the page
    cannot be written.
    """
    if len(folders) < 2:
        raise InputError("compare takes the folders of two or more runs")
    curves = _measured(measured, columns, depth)
    _fretwork.compare([os.fspath(folder) for folder in folders], os.fspath(out), *curves)
    return Path(out)
