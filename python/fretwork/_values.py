"""Values of a case as JSON, in which the compiled part takes and gives them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from os import PathLike, fspath
from typing import Any

from ._errors import InputError


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


def dumps(value: object, path: str) -> str:
    """A value as JSON; ``path`` is where it goes, for messages."""
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        text = f"{path}: a case cannot hold this value: {error}"
        expected = "finite numbers, texts, true or false, lists and dictionaries of these"
        raise InputError(f"{text}; expected {expected}", path, expected=expected) from error


def loads(text: str) -> Any:
    """A value from JSON."""
    return json.loads(text)


def assignments(given: Mapping[str, object] | None) -> list[str]:
    """``key.path=value`` of a dictionary; a text that is one in itself is given to :meth:`Case.set`."""
    return [f"{key}={dumps(value, key)}" for key, value in (given or {}).items()]
