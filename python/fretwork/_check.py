"""What a case uses and what it will cost."""

from __future__ import annotations

from collections.abc import Iterator, Mapping


class Check(Mapping[str, list[str]]):
    """The answer of ``fretwork check --verbose``: texts by label, in its order. Printed, it is that answer.

    >>> check = Check("cases/a.ron", "a case", [("dimension", "2"), ("on", "friction"), ("", "bonds")])
    >>> check["dimension"], check["on"]
    (['2'], ['friction', 'bonds'])
    >>> print(check)
    cases/a.ron: a case
      dimension            2
      on                   friction
                           bonds
    """

    def __init__(self, path: str, title: str, lines: list[tuple[str, str]]) -> None:
        self.path = path
        """The file."""
        self.title = title
        """Title of the case."""
        self.lines = lines
        """Label and text of every line; a line that goes on with the one before has no label."""
        self._texts: dict[str, list[str]] = {}
        label = ""
        for given, text in lines:
            label = given or label
            self._texts.setdefault(label, []).append(text)

    def __getitem__(self, label: str) -> list[str]:
        return self._texts[label]

    def __iter__(self) -> Iterator[str]:
        return iter(self._texts)

    def __len__(self) -> int:
        return len(self._texts)

    @property
    def warnings(self) -> list[str]:
        """Texts whose label is in capitals, such as ``COARSE DRIVE``."""
        return [text for label, texts in self._texts.items() if label.isupper() for text in texts]

    def __str__(self) -> str:
        rows = [f"{self.path}: {self.title}"]
        rows += [f"  {label:<20} {text}" for label, text in self.lines]
        return "\n".join(rows)

    __repr__ = __str__
