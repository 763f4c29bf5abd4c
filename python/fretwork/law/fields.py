"""What the author of a law declares: parameters and internal variables."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Parameter:
    """A parameter of a law, written as the default of an argument.

    Args:
        default: value where a case gives none.
        range: smallest and largest value that the law accepts; may be infinite.
        unit: SI unit, ``""`` for a pure number.
        doc: one line for the user of the law.
        friction: whether it is a friction coefficient, on which the results of a case depend: a run notes where a case leaves
            it to its default.

    >>> def friction(mu=Parameter(0.3, range=(0.0, 10.0), unit="", doc="friction coefficient", friction=True)): ...
    """

    default: float
    range: tuple[float, float] | None = None
    unit: str = ""
    doc: str = ""
    friction: bool = False

    def problem(self) -> str | None:
        """What is wrong with it, as the end of a sentence that begins with its name."""
        if self.range is None:
            return "has no range; give the smallest and the largest value that the law accepts: range=(0.0, math.inf)"
        if len(self.range) != 2 or not all(_is_number(x) for x in self.range):
            return "needs a range of two numbers, the smallest and the largest accepted value: range=(0.0, 1.0)"
        low, high = self.range
        if not _is_number(self.default) or not math.isfinite(self.default):
            return f"has the default {self.default!r}; give a finite number"
        if math.isnan(low) or math.isnan(high) or low > high:
            return f"has the range {self.range}, which no number fulfils; give the smaller end first"
        if not low <= self.default <= high:
            return f"has the default {self.default}, which is outside its range {self.range}; change one of the two"
        return _texts(self.unit, self.doc)


@dataclass(frozen=True)
class Variable:
    """An internal variable of a law, which a contact keeps from step to step; written as the default of an argument.

    Args:
        initial: value on a new contact.
        unit: SI unit, ``""`` for a pure number.
        doc: one line for the user of the law.
        output: whether runs write it to their results.

    >>> def grow(damage, psi_max=Variable(0.0, unit="J/m^2", doc="largest stored energy")): ...
    """

    initial: float = 0.0
    unit: str = ""
    doc: str = ""
    output: bool = True

    def problem(self) -> str | None:
        """What is wrong with it, as the end of a sentence that begins with its name."""
        if not _is_number(self.initial) or not math.isfinite(self.initial):
            return f"begins with {self.initial!r}; give a finite number"
        return _texts(self.unit, self.doc)


def _is_number(x: object) -> bool:
    return isinstance(x, (int, float)) and not isinstance(x, bool)


def _texts(unit: object, doc: object) -> str | None:
    if not isinstance(unit, str) or not isinstance(doc, str):
        return 'needs texts for unit and doc: unit="m/s", doc="velocity over which it falls"'
    if not doc.strip():
        return 'has no description; say in one line what it is: doc="friction coefficient at rest"'
    if "\0" in unit + doc or "\n" in unit + doc:
        return "has a unit or a description of several lines; write each in one"
    return None
