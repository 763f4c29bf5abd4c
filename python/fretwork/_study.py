"""Tables of studies."""

from __future__ import annotations

import os
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

from ._errors import InputError, need

if TYPE_CHECKING:
    import pandas as pd

# Hashes may look like numbers, and reasons are sentences.
TEXTS = ("status", "reason", "not_trustworthy", "identity", "folder")
WHOLE = ("point", "setting", "seed", "steps")


def read_study(folder: Union[str, PathLike[str]], *, settings: bool = False) -> pd.DataFrame:
    """The table of a study, a row for each run; with ``settings`` a row for each setting, with means over its seeds.

    ``folder`` is what ``fretwork study run`` wrote, ``results/study/<study>`` by default. ``attrs["units"]`` is a
    dictionary of the units (SI) by column, ``"1"`` for pure numbers and texts. Unknown values are missing (NaN or None): of a run that was not made, or that has none.
    Means should be over the runs whose ``status`` is ``done``, as they are in the table of settings.

    Raises ``InputError`` if there is no table, ``MissingPackageError`` without pandas.

    >>> table = fretwork.read_study("results/study/four_laws")  # doctest: +SKIP
    >>> done = table[table.status == "done"]  # doctest: +SKIP
    >>> done.groupby("law").friction_coefficient.agg(["mean", "std"])  # doctest: +SKIP
    """
    pandas = need("pandas", "results", "the table of a study")
    path = Path(os.fspath(folder)) / ("settings.csv" if settings else "table.csv")
    if not path.is_file():
        text = f"{path}: there is no such table; give the folder of a study, in which `fretwork study run` or `collect` wrote it"
        raise InputError(text, str(path), expected="a folder with the tables of a study")
    # Only what is empty is unknown, and not a law that is called "none".
    read = pandas.read_csv(path, dtype=str, keep_default_na=False)
    units, columns = {}, {}
    for heading in read.columns:
        name, _, unit = heading.partition(" [")
        units[name] = unit.rstrip("]") or "1"
        columns[name] = _values(name, read[heading].tolist())
    table: pd.DataFrame = pandas.DataFrame(columns)
    table.attrs["units"] = units
    return table


def _values(name: str, texts: list[str]) -> list[Any]:
    if name in TEXTS:
        return [text or None for text in texts]
    try:
        # To the same bits as in the file.
        numbers = [float(text) if text else float("nan") for text in texts]
    except ValueError:
        return [text or None for text in texts]
    whole = name in WHOLE or name.endswith("_runs")
    return [int(x) for x in numbers] if whole and "" not in texts else numbers
