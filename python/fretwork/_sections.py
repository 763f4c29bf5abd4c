"""Parts of a case: what stands at a key path."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ._values import loads

if TYPE_CHECKING:
    from ._case import Case


def part(key: object) -> str:
    """A component of a key path."""
    text = str(key)
    return f'"{text}"' if "." in text and isinstance(key, str) and '"' not in text else text


class Section:
    """A struct, map or list of a case, by its key path.

    Fields are attributes, entries of maps and lists are items; both can be set. ``value`` is a copy in plain Python.
    """

    __slots__ = ("_case", "_path")
    _case: Case
    _path: str

    def __init__(self, case: Case, path: str) -> None:
        object.__setattr__(self, "_case", case)
        object.__setattr__(self, "_path", path)

    @property
    def value(self) -> Any:
        """A copy as dictionaries, lists, numbers and texts."""
        return self._case._value(self._path)

    def _below(self, key: object) -> str:
        return f"{self._path}.{part(key)}"

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        try:
            return self._case[self._below(name)]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __setattr__(self, name: str, value: object) -> None:
        self._case[self._below(name)] = value

    def __getitem__(self, key: int | str) -> Any:
        if isinstance(key, int):
            size = len(self)
            if not -size <= key < size:
                raise IndexError(f"`{self._path}` has {size} elements")
            key %= size
        return self._case[self._below(key)]

    def __setitem__(self, key: int | str, value: object) -> None:
        if isinstance(key, int) and key < 0:
            key += len(self)
        self._case[self._below(key)] = value

    def __len__(self) -> int:
        return len(self.value)

    def __iter__(self) -> Iterator[Any]:
        value = self.value
        if isinstance(value, list):
            return (self[k] for k in range(len(value)))
        return iter(value)

    def keys(self) -> list[str]:
        """Names of fields, or of entries."""
        return self._case.keys(self._path)

    def append(self, value: object) -> None:
        """Adds an element to a list."""
        self._case.append(self._path, value)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(k for k in self.keys() if k.isidentifier())]

    def _ipython_key_completions_(self) -> list[str]:
        return self.keys()

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Section):
            return bool(self.value == other.value)
        return bool(self.value == other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"{self._path}: {self.value!r}"


def shown(case: Case, path: str, json: str | None) -> Any:
    """What a key path gives: a section of what has parts, else the value."""
    if json is None:
        return None
    value = loads(json)
    parts = isinstance(value, dict) or (
        isinstance(value, list) and any(isinstance(x, dict) for x in value)
    )
    return Section(case, path) if parts else value
