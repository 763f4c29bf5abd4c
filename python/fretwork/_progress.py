"""Progress of a run: a bar where tqdm is installed, in terminals and notebooks; else lines."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Progress:
    """How far a run is."""

    step: int
    """Steps done."""
    steps: int
    """Steps in total."""
    resumed_at: int
    """Steps done before this part of a resumed run."""
    cycle: int
    """Cycle of the friction test; 0 before the first."""
    cycles: int
    """Cycles in total."""
    contacts: int
    """Number of contacts."""
    iterations: int
    """Iterations of the solver in the last step."""
    error: float
    """Error of the solver in the last step."""
    unconverged: int
    """Steps that missed the tolerance."""
    damage_ratio: float
    """Broken bonds over bonds made."""

    def text(self) -> str:
        """In a few words."""
        words = [f"{self.contacts} contacts", f"{self.iterations} iterations"]
        if self.cycles:
            words.insert(0, f"cycle {self.cycle}/{self.cycles}")
        if self.damage_ratio:
            words.append(f"damage ratio {self.damage_ratio:.3f}")
        if self.unconverged:
            words.append(f"{self.unconverged} steps not converged")
        return ", ".join(words)


class Silent:
    """Shows nothing."""

    def show(self, now: Progress) -> None:
        """Is called some twenty times a second."""

    def close(self) -> None:
        """Is called at the end."""


class Called(Silent):
    """Calls a function of the user."""

    def __init__(self, function: Callable[[Progress], object]) -> None:
        self._function = function

    def show(self, now: Progress) -> None:
        self._function(now)


class Lines(Silent):
    """Writes a line every few seconds, to standard error."""

    def __init__(self) -> None:
        self._next = time.monotonic() + 2.0

    def show(self, now: Progress) -> None:
        if time.monotonic() < self._next and now.step < now.steps:
            return
        self._next = time.monotonic() + 10.0
        print(f"step {now.step}/{now.steps}, {now.text()}", file=sys.stderr, flush=True)


class Bar(Silent):
    """A bar of tqdm."""

    def __init__(self, tqdm: Any) -> None:
        self._tqdm = tqdm
        self._bar: Any = None

    def show(self, now: Progress) -> None:
        if self._bar is None:
            self._bar = self._tqdm(total=now.steps, initial=now.resumed_at, unit=" steps")
        self._bar.set_postfix_str(now.text(), refresh=False)
        self._bar.update(now.step - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()


def display(wanted: bool | Callable[[Progress], object]) -> Silent:
    """What shows the progress of a run."""
    if callable(wanted):
        return Called(wanted)
    if not wanted:
        return Silent()
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return Lines()
    return Bar(tqdm)
