"""A first case from what is known about a test."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import NamedTuple, Union

from . import _fretwork
from ._case import Case


class NewCase(NamedTuple):
    """A file that :func:`new_case` made."""

    kind: str
    """``"case"``, which ``fretwork run`` and :class:`Case` take, or ``"patch"``, which :func:`patch` takes."""
    text: str
    """The text of the file, each chosen number with its formula."""

    def case(self) -> Case:
        """The case, to be edited and run.

        Raises ``ValueError`` where it is a patch.
        """
        if self.kind != "case":
            raise ValueError("elastic bodies without debris make a patch: write it with save(), and solve it by fretwork.patch(path)")
        return Case.from_text(self.text, name="new_case.ron")

    def save(self, path: Union[str, PathLike[str]]) -> Path:
        """Writes the file, and returns its path."""
        written = Path(path)
        written.write_text(self.text, encoding="utf-8")
        return written


def new_case(geometry: str, **known: object) -> NewCase:
    """A case from what is known about a test: geometry, load, motion, materials, debris.

    ``geometry`` and the other words are those of ``fretwork new case --help``, with ``_`` for ``-``; numbers are texts with their units.

    >>> import fretwork
    >>> made = fretwork.new_case("window", pressure="1 GPa", amplitude="4 um", material="rail_steel_r260", debris="magnetite", debris_size="4um")
    >>> made.kind, made.case().periodic.x
    ('case', 0.00024)

    Raises ``InputError`` where something is missing, wrong, or does not belong to the geometry.
    """
    values = [(key.replace("_", "-"), str(value)) for key, value in known.items()]
    kind, text = _fretwork.new_case(geometry, values)
    return NewCase(kind, text)
