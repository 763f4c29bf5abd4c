"""Figures of a run, drawn by matplotlib: when it has ended, and while it goes on."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._errors import InputError, need
from ._progress import Progress, Silent

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

# Prefixes of units, by their powers of ten.
PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}


MOST = 3
"""Most panels of a figure that is not asked for by names."""


def chosen(table: pd.DataFrame, figures: Sequence[Any]) -> list[tuple[str, str]]:
    """Pairs of columns, across and up, of the first curve of each figure that the run describes, those that lead first; the
    contacts over time of a run without any of them."""
    pairs: list[tuple[str, str]] = []
    for figure in sorted(figures, key=lambda figure: not figure["leads"]):
        sources = (series["source"] for chart in figure["charts"] for series in chart["series"][:1])
        rows = (source["Rows"] for source in sources if isinstance(source, dict) and "Rows" in source)
        curves = ((of["x"]["column"], of["y"]["column"]) for of in rows if of["x"]["over"] is None and of["y"]["over"] is None)
        pair = next((pair for pair in curves if all(name in table for name in pair)), None)
        if pair and pair not in pairs:
            pairs.append(pair)
    return pairs[:MOST] or [("time", "contacts")]


def scaled(values: Any, unit: str) -> tuple[float, str]:
    """The factor and the unit in which values are numbers of one to three digits."""
    if unit in ("1", "") or unit[0] not in "mNJPWVAs" or unit.startswith(("m^", "mm")):
        return 1.0, "" if unit == "1" else unit
    largest = float(abs(values).max())
    power = next((p for p in sorted(PREFIXES) if largest < 1e3 * 10.0**p), 9) if 0.0 < largest < float("inf") else 0
    return 10.0**-power, PREFIXES[power] + unit


def draw(figure: Figure, table: pd.DataFrame, pairs: Sequence[tuple[str, str]]) -> None:
    """Draws pairs of columns side by side into an empty figure, with their meanings and units at the axes."""
    panels = figure.subplots(1, len(pairs), squeeze=False)[0]
    for panel, pair in zip(panels, pairs):
        lines, labels = [], []
        for name in pair:
            factor, unit = scaled(table[name], table.attrs["units"][name])
            lines.append(table[name] * factor)
            meaning = table.attrs["long_name"].get(name, "") if name != "time" else "time"
            meaning = name if not meaning or len(meaning) > 40 else meaning
            labels.append(f"{meaning} ({unit})" if unit else meaning)
        panel.plot(*lines, linewidth=1.0)
        panel.set_xlabel(labels[0])
        panel.set_ylabel(labels[1])
        panel.grid(alpha=0.3)


def described(folder: Path) -> list[Any]:
    """The figures that a run describes, in `figures.json`."""
    try:
        return list(json.loads((folder / "figures.json").read_text(encoding="utf-8")))
    except (OSError, ValueError):
        return []  # not written yet


def figure_of(table: pd.DataFrame, figures: Sequence[Any], names: Sequence[str], against: str) -> Figure:
    """A figure of columns against one, or of those that show most."""
    need("matplotlib", "notebooks", "figures of results")
    from matplotlib.figure import Figure as Base

    class Shown(Base):
        """A figure that a notebook shows, also where pyplot has drawn none before."""

        def _repr_png_(self) -> bytes:
            out = BytesIO()
            self.savefig(out, format="png")
            return out.getvalue()

    wrong = [name for name in (*names, against) if name not in table]
    if wrong:
        raise InputError(f"there is no column `{wrong[0]}` in the statistics: {', '.join(table.columns)}", wrong[0])
    pairs = [(against, name) for name in names] or chosen(table, figures)
    figure = Shown(figsize=(4.2 * len(pairs), 3.2), layout="constrained")
    draw(figure, table, pairs)
    return figure


class LivePlot(Silent):
    """A bar, and below it in a notebook the figure of the run so far, drawn again every few seconds."""

    EVERY = 3.0
    """Least time between two figures (s)."""
    SHARE = 10.0
    """Time of the run over that of drawing, at least."""

    def __init__(self, bar: Silent, folder: Path, read: Callable[[], pd.DataFrame]) -> None:
        need("matplotlib", "notebooks", "the figure of a run")
        need("IPython", "notebooks", "the figure of a run that goes on")
        self._bar, self._folder, self._read = bar, folder, read
        self._handle: Any = None
        self._next = time.monotonic() + self.EVERY

    def show(self, now: Progress) -> None:
        self._bar.show(now)
        if time.monotonic() < self._next:
            return
        began = time.monotonic()
        self._draw()
        ended = time.monotonic()
        self._next = ended + max(self.EVERY, self.SHARE * (ended - began))

    def close(self) -> None:
        self._bar.close()
        self._draw()

    def _draw(self) -> None:
        from IPython.display import display

        try:
            table = self._read()
        except (InputError, OSError):
            return  # the run has written nothing yet
        if len(table) < 2:
            return
        figure = figure_of(table, described(self._folder), (), "time")
        if self._handle is None:
            self._handle = display(figure, display_id=True)  # type: ignore[no-untyped-call]
        else:
            self._handle.update(figure)
