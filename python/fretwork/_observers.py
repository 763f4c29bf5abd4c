"""Observers: what looks at a run while it is computed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Union

from ._errors import InputError
from ._values import dumps, loads

if TYPE_CHECKING:
    from ._fretwork import SimulationData
    from ._simulation import Simulation


@dataclass(frozen=True)
class Stop:
    """What an observer returns to end a run: after this step, with all files written, so that it may be resumed."""

    reason: str
    """Why, for the summary."""


@dataclass(frozen=True)
class Column:
    """A column that an observer adds to the statistics."""

    name: str
    unit: str = ""
    """SI unit; empty for a pure number."""
    doc: str = ""
    """One line of explanation."""


class Observer:
    """What looks at a run after its steps. Override :meth:`step`, and what else is needed.

    >>> class Height(Observer):
    ...     columns = [Column("top", "m", "height of the highest grain")]
    ...     def step(self, sim):
    ...         return {"top": sim.grains.position[:, 1].max()}
    """

    name: str = ""
    """Tells the observers of a run apart in its checkpoints; that of the class by default."""
    every: int = 1
    """It looks at every so many steps."""
    columns: list[Column] | list[str] = []
    """Columns that it adds to the statistics; between two looks they repeat their values."""

    def begin(self, sim: Simulation) -> None:
        """The run begins; called again where its second phase does."""

    def step(self, sim: Simulation) -> Answer:
        """A step is done. Returns values of its columns by name, a :class:`Stop`, both in a tuple, or nothing. An
        exception ends the run, with all files written, and goes on to the caller of ``run``."""
        return None

    def save(self) -> Any:
        """What it carries from step to step, for checkpoints: numbers, texts, lists, dictionaries."""
        return None

    def restore(self, saved: Any) -> None:
        """Goes on from what :meth:`save` returned, in a resumed run."""


Answer = Union[Mapping[str, float], Stop, tuple[Mapping[str, float], Stop], None]


class _Function(Observer):
    """A function as an observer."""

    def __init__(self, function: Callable[[Simulation], Answer]) -> None:
        self.name = getattr(function, "__name__", "function")
        self._function = function

    def step(self, sim: Simulation) -> Answer:
        return self._function(sim)


class Adapter:
    """An observer in the form in which the compiled part calls it."""

    def __init__(self, observer: Observer) -> None:
        self._observer = observer
        self.name = observer.name or type(observer).__name__
        self.every = int(observer.every)
        if self.every < 1:
            raise InputError(f"observer {self.name}: every={self.every}; take at least 1", self.name)
        columns = [Column(c) if isinstance(c, str) else c for c in observer.columns]
        self.columns = [(c.name, c.unit, c.doc) for c in columns]
        self._names = [c.name for c in columns]

    def begin(self, data: SimulationData) -> tuple[None, None]:
        from ._simulation import Simulation

        self._observer.begin(Simulation(data))
        return None, None

    def step(self, data: SimulationData) -> tuple[list[float] | None, str | None]:
        from ._simulation import Simulation

        answer = self._observer.step(Simulation(data))
        stop = None
        if isinstance(answer, tuple):
            answer, stop = answer
        if isinstance(answer, Stop):
            answer, stop = None, answer
        reason = None if stop is None else stop.reason
        if answer is None:
            return None, reason
        if set(answer) != set(self._names):
            given, wanted = sorted(answer), sorted(self._names)
            raise ValueError(
                f"the observer {self.name} returned values of {given}, and has the columns {wanted}"
            )
        return [float(answer[name]) for name in self._names], reason

    def save(self) -> bytes:
        return dumps(self._observer.save(), f"what the observer {self.name} saves").encode()

    def restore(self, saved: bytes) -> None:
        self._observer.restore(loads(saved.decode()))


def adapt(observer: Observer | Callable[[Simulation], Answer]) -> Adapter:
    """An observer, or a function that is called every step, for the compiled part."""
    if isinstance(observer, Observer):
        return Adapter(observer)
    if callable(observer):
        return Adapter(_Function(observer))
    raise InputError(
        f"{observer!r} is no observer: give a function of the simulation, or an object of a class of Observer", "observers"
    )
