"""Materials with their numbers, units, ranges and sources."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from os import PathLike
from typing import Any, Union

from . import _fretwork


@dataclass(frozen=True)
class Number:
    """A number of a material in SI units."""

    value: float
    unit: str
    """Empty for a pure number; ``"HRC"`` and the like for a hardness on a scale that is no pressure."""
    range: tuple[float, float] | None
    """Smallest and largest value in the source."""
    source: str
    """Publication, standard or data sheet; of what is derived, the formula."""
    given: str
    """Value and unit as the file has them; of what is derived, empty."""

    def __float__(self) -> float:
        return self.value

    def __str__(self) -> str:
        return f"{self.value:g} {self.unit}".rstrip()


@dataclass(frozen=True)
class Material:
    """A material: what it is, and its numbers by their names, ``material["young"]``."""

    name: str
    doc: str
    kind: str | None
    """Its class: ``"steel"``, ``"ceramic"``, ...; None if its file gives none."""
    also: tuple[str, ...]
    """Other names."""
    file: str | None
    """The file; None if it is built in."""
    density: Number
    properties: dict[str, Number]
    derived: dict[str, Number]
    """What follows from the properties: plane strain modulus, diffusivity of heat, ..."""
    laws: tuple[str, ...]
    """Laws for which it has parameters, ``"contact.hertz-mindlin"``."""

    def __getitem__(self, name: str) -> float:
        """The value of the density, of a property or of what is derived, in SI units."""
        if name == "density":
            return self.density.value
        for numbers in (self.properties, self.derived):
            if name in numbers:
                return numbers[name].value
        known = ", ".join(["density", *self.properties, *self.derived])
        raise KeyError(f"{self.name} has no {name!r}; it has {known}")


def _number(read: dict[str, Any]) -> Number:
    low_high = read["range"]
    return Number(
        value=read["value"],
        unit=read["unit"],
        range=None if low_high is None else (low_high[0], low_high[1]),
        source=read["source"],
        given=read["given"],
    )


def _material(read: dict[str, Any]) -> Material:
    return Material(
        name=read["name"],
        doc=read["doc"],
        kind=read["class"],
        also=tuple(read["also"]),
        file=read["file"],
        density=_number(read["density"]),
        properties={name: _number(number) for name, number in read["properties"].items()},
        derived={
            each["name"]: Number(each["value"], each["unit"], None, each["formula"], "") for each in read["derived"]
        },
        laws=tuple(read["laws"]),
    )


def material(name: Union[str, PathLike[str]]) -> Material:
    """The material of a name that a case may use, or of a file ``.ron``.

    Case, blanks and hyphens of names do not matter. Files in a folder ``materials`` here or above precede those of the program.

    >>> import fretwork
    >>> titanium = fretwork.material("Ti-6Al-4V")
    >>> titanium["young"], titanium.properties["young"].range
    (114000000000.0, (105000000000.0, 120000000000.0))
    >>> titanium.properties["hardness"].given, f"{titanium['hardness'] / 1e9:.2f} GPa"
    ('349 HV', '3.42 GPa')
    >>> f"{titanium['thermal_diffusivity'] * 1e6:.1f} mm^2/s"
    '2.9 mm^2/s'

    Raises ``InputError`` where there is none of this name, or its file cannot be read.
    """
    return _material(json.loads(_fretwork.material(os.fspath(name))))


def materials(word: str = "") -> list[Material]:
    """All materials, or those with a word in name, other names, class or description.

    >>> import fretwork
    >>> [each.name for each in fretwork.materials("diamond")]
    ['dlc_a_c_h', 'dlc_ta_c']
    """
    everything = [_material(each) for each in json.loads(_fretwork.materials())]
    wanted = word.lower()
    return [each for each in everything if any(wanted in text.lower() for text in (each.name, each.doc, each.kind or "", *each.also))]
