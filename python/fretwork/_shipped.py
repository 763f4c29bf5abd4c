"""Cases, studies, fits and patches that are part of the package."""

from __future__ import annotations

import os
from os import PathLike
from pathlib import Path
from typing import Union

from . import _fretwork


def copy_shipped(name: str, out: Union[str, PathLike[str]] = ".") -> list[Path]:
    """Copies a shipped case, study, fit or patch, with the files that it names, into folders ``cases``, ``studies``, ``fits`` or
    ``patches`` of ``out``, to be changed there. Returns the paths, its own first. ``fretwork cases list`` prints the names.

    >>> import fretwork
    >>> [path.as_posix() for path in fretwork.copy_shipped("fretting_scar", out="mine")]
    ['mine/cases/fretting_scar.ron', 'mine/cases/fretting_scar_flat.csv']

    Raises ``InputError`` where nothing has this name, or a file is there and differs.
    """
    return [Path(path) for path in _fretwork.copy_shipped(name, os.fspath(out))]
