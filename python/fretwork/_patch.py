"""Contact patches by the laws of an interface."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from os import PathLike
from typing import Any, Union

from . import _fretwork

AnyPath = Union[str, PathLike[str]]


def patch(
    file: AnyPath, *, out: AnyPath | None = None, plugin_path: Sequence[AnyPath] = (), trust_plugins: bool = False
) -> dict[str, Any]:
    """Adhesion, wear and temperature of two bodies that roll or fret, by the laws of their interface.

    ``file`` is that of ``fretwork patch`` (``docs/patch.md``); the answer is its ``patch.json`` in SI units. With ``out`` all files of
    the command are written into that folder. Under a list of loads the answer has those of all as ``loads``. A patch with a
    ``third_body`` needs runs, which the command makes.

    >>> import fretwork
    >>> found = fretwork.patch("patches/wheel_on_rail.ron")  # doctest: +SKIP
    >>> [round(point["adhesion"], 2) for point in found["points"]]  # doctest: +SKIP

    Raises ``InputError`` where the file asks for what a patch cannot follow, ``RunError`` without a solution.
    """
    folders = [os.fspath(folder) for folder in plugin_path]
    into = None if out is None else os.fspath(out)
    answer: dict[str, Any] = json.loads(_fretwork.patch(os.fspath(file), into, folders, trust_plugins))
    return answer
