"""Exceptions."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any


class Error(Exception):
    """What all exceptions of this package are."""


class InputError(Error, ValueError):
    """A case, a file or an argument is wrong.

    The text names the place, what was expected and what to write instead; its parts are attributes.
    """

    file: str
    """The file or argument that has the error."""
    line: int | None
    """The line, from 1; none where the error has no place in a file."""
    column: int | None
    """The column in characters, from 1."""
    message: str
    """What is wrong."""
    expected: str | None
    """What was expected."""
    proposal: str | None
    """What to write instead, such as ``did you mean `mu`?``."""

    def __init__(
        self,
        text: str,
        file: str = "",
        line: int | None = None,
        column: int | None = None,
        message: str | None = None,
        expected: str | None = None,
        proposal: str | None = None,
    ) -> None:
        super().__init__(text)
        self.file = file
        self.line = line
        self.column = column
        self.message = text if message is None else message
        self.expected = expected
        self.proposal = proposal


class RunError(Error, RuntimeError):
    """A run or a step failed. What was computed until then is on disk."""

    out: Path | None
    """The folder with what was computed; none where nothing was written."""

    def __init__(self, text: str, out: Path | None = None) -> None:
        super().__init__(text)
        self.out = out


class MissingPackageError(Error, ImportError):
    """A package that is not installed with this one is needed."""


def missing(package: str, extra: str, what: str) -> MissingPackageError:
    """The error for a package that an extra of this one brings."""
    return MissingPackageError(
        f"{what} needs the package {package}: pip install 'pyfretwork[{extra}]'"
    )


def need(package: str, extra: str, what: str) -> Any:
    """The package, which an extra of this one brings."""
    try:
        return import_module(package)
    except ImportError as error:
        raise missing(package, extra, what) from error
