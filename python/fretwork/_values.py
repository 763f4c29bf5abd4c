"""Values of a case as JSON, in which the compiled part takes and gives them."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from os import PathLike, fspath
from typing import Any

from ._errors import InputError

_INFINITE = math.nextafter(math.nextafter(math.inf, 0.0), 0.0)
"""Stands for infinity in JSON, as in `src/infinity.rs`."""


def _plain(value: object) -> object:
    """What JSON can hold, for a value that it does not know."""
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, PathLike):
        return fspath(value)
    if hasattr(value, "tolist"):  # arrays and numbers of NumPy
        return value.tolist()
    if hasattr(value, "__iter__"):
        return list(value)
    raise TypeError(f"{value!r} is a {type(value).__name__}")


def _finite(value: object) -> object:
    """A value without infinite numbers."""
    if isinstance(value, float) and math.isinf(value):
        return math.copysign(_INFINITE, value)
    if isinstance(value, Mapping):
        return {key: _finite(x) for key, x in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(x) for x in value]
    return value


def dumps(value: object, path: str) -> str:
    """A value as JSON; ``path`` is where it goes, for messages."""
    try:
        text = json.dumps(value, default=_plain)
        if "Infinity" in text or "NaN" in text:
            text = json.dumps(_finite(json.loads(text)), allow_nan=False)
        return text
    except (TypeError, ValueError) as error:
        text = f"{path}: a case cannot hold this value: {error}"
        expected = "numbers, texts, true or false, lists and dictionaries of these"
        raise InputError(f"{text}; expected {expected}", path, expected=expected) from error


def loads(text: str) -> Any:
    """A value from JSON."""
    return json.loads(text, parse_float=_number)


def _number(text: str) -> float:
    number = float(text)
    return math.copysign(math.inf, number) if abs(number) == _INFINITE else number


def assignments(given: Mapping[str, object] | None) -> list[str]:
    """``key.path=value`` of a dictionary; a text that is one in itself is given to :meth:`Case.set`."""
    return [f"{key}={dumps(value, key)}" for key, value in (given or {}).items()]
