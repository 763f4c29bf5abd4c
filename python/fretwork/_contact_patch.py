"""Contact patches in closed form."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from os import PathLike
from typing import Any, Union

from . import _fretwork

Number = Union[str, float]
"""A number in SI units, or a text with a unit such as ``"75 kN"``."""
Numbers = Union[Number, Sequence[Number]]
"""One for both bodies, or one for each."""
Interval = Union[Number, tuple[float, float]]
"""A number, its lowest and highest value, or a text such as ``"0.40+-0.03"``."""
AnyPath = Union[str, PathLike[str]]


def _text(number: Number) -> str:
    return number if isinstance(number, str) else repr(float(number))


def _texts(numbers: Numbers | None) -> list[str]:
    if numbers is None:
        return []
    if isinstance(numbers, (str, int, float)):
        return [part.strip() for part in _text(numbers).split(",")]
    return [_text(number) for number in numbers]


def _interval(interval: Interval | None) -> str | None:
    if isinstance(interval, tuple):
        low, high = interval
        return f"{float(low)!r}..{float(high)!r}"
    return None if interval is None else _text(interval)


def contact_patch(
    load: Number,
    radius: Numbers,
    across: Numbers | None = None,
    *,
    material: str | Sequence[str] | None = None,
    young: Numbers | None = None,
    poisson: Numbers | None = None,
    hardness: Numbers | None = None,
    yield_stress: Number | None = None,
    friction: Interval | None = None,
    friction_of: Sequence[AnyPath] = (),
    accept: Sequence[str] = (),
    force: Number | None = None,
    displacement: Number | None = None,
    creepage: Number | None = None,
    speed: Number | None = None,
    wear: Interval | None = None,
    window: Number | None = None,
) -> dict[str, Any]:
    """Hertz pressure and size of a contact patch, where gross slip begins, friction and wear against creepage.

    ``load`` is a force (N), or a text with a force per length such as ``"13 MN/m"`` for a line contact; ``radius`` is that along the
    motion (m), ``across`` that across it, each of one body or of both, where ``"flat"`` is a plane and a negative radius concave.
    ``friction_of`` takes the friction coefficient from folders of runs, with its interval over them, and ``accept`` takes them although
    they differ from the patch in ``"materials"``, ``"pressure"`` or ``"drive"``, from each other (``"inputs"``), or are ``"untrusted"``;
    ``wear`` is Archard's K, a pure number. Answers with an interval are ``{"low", "value", "high"}``; all are in SI units, of a line contact per metre.
    ``docs/steel_to_number/patch.md`` has the meaning of each.

    >>> import fretwork
    >>> patch = fretwork.contact_patch(
    ...     "75 kN", ("0.46 m", "flat"), ("flat", "0.30 m"), material=("wheel_steel_er7", "rail_steel_r260"),
    ...     friction=0.4, creepage="0.5 %",
    ... )
    >>> patch["shape"], f"{patch['patch']['pressure'] / 1e9:.2f} GPa"
    ('ellipse', '1.12 GPa')
    >>> adhesion = patch["rolling"]["adhesion"]["value"]
    >>> adhesion < 0.4
    True

    Raises ``InputError`` where something is missing or contradicts itself.
    """
    texts = [material] if isinstance(material, str) else list(material or [])
    asked: dict[str, object] = {
        "load": _text(load),
        "radius": _texts(radius),
        "across": _texts(across),
        "material": texts,
        "young": _texts(young),
        "poisson": _texts(poisson),
        "hardness": _texts(hardness),
        "friction": _interval(friction),
        "runs": [os.fspath(folder) for folder in friction_of],
        "accept": list(accept),
        "wear": _interval(wear),
    }
    single = {
        "yield_stress": yield_stress,
        "force": force,
        "displacement": displacement,
        "creepage": creepage,
        "speed": speed,
        "window": window,
    }
    asked.update((key, _text(number)) for key, number in single.items() if number is not None)
    answer: dict[str, Any] = json.loads(_fretwork.contact_patch(json.dumps(asked)))
    return answer
