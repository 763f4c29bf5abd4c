"""Simulations that are stepped by hand, or looked at by observers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from ._fretwork import SimulationData
from ._values import loads

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Numbers = NDArray[np.float64]


class StepReport(NamedTuple):
    """What the solver reached in a step."""

    iterations: int
    """Iterations."""
    error: float
    """Error of the solution, as the tolerance bounds it."""
    converged: bool
    """Whether the tolerance was reached."""


class Field(NamedTuple):
    """What a column is."""

    unit: str
    """SI unit; empty for a pure number."""
    doc: str
    """One line of explanation."""


def _array(memory: object) -> Any:
    import numpy as np

    return np.asarray(memory)


class _Columns:
    """Columns by name, as attributes and items."""

    def fields(self) -> dict[str, Field]:
        """Unit and explanation of each column."""
        raise NotImplementedError

    def _column(self, name: str) -> Any:
        raise NotImplementedError

    def __getitem__(self, name: str) -> Any:
        found = self._column(name)
        if found is None:
            raise KeyError(f"there is no column `{name}`; there are {', '.join(self.fields())}")
        return found

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def keys(self) -> list[str]:
        """Names of the columns."""
        return list(self.fields())

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.fields()]

    def _ipython_key_completions_(self) -> list[str]:
        return self.keys()

    def __repr__(self) -> str:
        return f"{type(self).__name__} with {', '.join(self.fields())}"


class Bodies(_Columns):
    """Columns of bodies: arrays with one row a body, read-only.

    They show the memory of the simulation, without a copy. An array that is kept over a step keeps its numbers: before the step
    the simulation leaves it the memory, and goes on with a copy. Observers of a run get copies.
    """

    def __init__(self, data: SimulationData, start: int, end: int) -> None:
        self._data = data
        self._rows = slice(start, end)

    def fields(self) -> dict[str, Field]:
        return {name: Field(unit, doc) for name, unit, doc in SimulationData.columns()}

    def _column(self, name: str) -> Any:
        memory = self._data.column(name)
        return None if memory is None else _array(memory)[self._rows]

    def __len__(self) -> int:
        return self._rows.stop - self._rows.start


class Parts(_Columns):
    """Fields of the balls and other parts of grains and first bodies: the rows and columns of the grains in ``results.h5``.

    Each array is computed when it is asked for. ``position`` has the centres (m).
    """

    _of = "grains"

    def __init__(self, data: SimulationData) -> None:
        self._data = data

    def fields(self) -> dict[str, Field]:
        result = {"position": Field("m", "centres")}
        result.update({n: Field(unit, doc) for n, unit, doc, _ in self._data.fields(self._of)})
        return result

    def _column(self, name: str) -> Any:
        memory = self._data.grain_points() if name == "position" else self._data.grain_field(name)
        return None if memory is None else _array(memory)

    def __len__(self) -> int:
        return len(self["position"])


class Contacts(Parts):
    """Fields of the contacts of the last step, open ones within the alert distance too: the columns of ``results.h5``.

    Each array is computed when it is asked for. ``position`` has the points of contact, seen from body_1 (m).
    """

    _of = "contacts"

    def _column(self, name: str) -> Any:
        memory = self._data.contact_points() if name == "position" else self._data.contact_field(name)
        return None if memory is None else _array(memory)


class FirstBody:
    """A first body of a simulation, by its name."""

    def __init__(self, data: SimulationData, name: str, place: int) -> None:
        self._data = data
        self.name = name
        """Its name in the case."""
        self.place = place
        """Its place in the columns of bodies."""

    def _of(self, column: str) -> Numbers:
        found: Numbers = _array(self._data.column(column))[self.place].copy()
        return found

    @property
    def position(self) -> Numbers:
        """Centre of mass (m)."""
        return self._of("position")

    @property
    def velocity(self) -> Numbers:
        """Velocity (m/s)."""
        return self._of("velocity")

    @property
    def spin(self) -> Numbers:
        """Angular velocity (rad/s)."""
        return self._of("spin")

    @property
    def force(self) -> Numbers:
        """Mean force of all contacts on it in the last step (N; N/m in 2D)."""
        return self._on(0)

    @property
    def moment(self) -> Numbers:
        """Mean moment of all contacts about its centre in the last step (N m; N in 2D)."""
        return self._on(1)

    def _on(self, which: int) -> Numbers:
        import numpy as np

        result = self._data.contact_force_on(self.name)
        return np.array([] if result is None else result[which])

    def __repr__(self) -> str:
        return f"FirstBody({self.name!r})"


class Simulation:
    """A case that is stepped by hand: ``case.simulation()``.

    An observer of a run gets one too, which it can look at but not step, during its call.
    """

    def __init__(self, data: SimulationData) -> None:
        self._data = data

    def step(self, steps: int = 1) -> StepReport:
        """Makes steps; fewer if the case :attr:`finished`. Ctrl-C raises ``KeyboardInterrupt`` between two steps, and the
        simulation can go on.

        Raises ``RunError`` if a step fails.
        """
        self._data.step(steps)
        return self.last_step

    def run_until(self, time: float) -> StepReport:
        """Makes steps until a time (s) is reached; see :meth:`step`."""
        self._data.run_until(time)
        return self.last_step

    @property
    def last_step(self) -> StepReport:
        """What the solver reached in the last step."""
        result = self._data.last_step()
        return StepReport(0, 0.0, True) if result is None else StepReport(*result)

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._data.dimension

    @property
    def time(self) -> float:
        """Time at the end of the last step (s)."""
        return self._data.time

    @property
    def steps(self) -> int:
        """Steps done."""
        return self._data.steps

    @property
    def step_length(self) -> float:
        """Length of a step (s)."""
        return self._data.step_length

    @property
    def finished(self) -> bool:
        """Whether the phases of the case have come to their end."""
        return self._data.finished

    @property
    def bodies(self) -> Bodies:
        """All bodies: grains, then first bodies and what else there is."""
        return Bodies(self._data, 0, self._data.counts()[0])

    @property
    def grains(self) -> Bodies:
        """The grains that do not deform, those that were taken out too."""
        return Bodies(self._data, 0, self._data.counts()[1])

    @property
    def parts(self) -> Parts:
        """Balls and other parts of grains and first bodies, with the fields of ``results.h5``."""
        return Parts(self._data)

    @property
    def contacts(self) -> Contacts:
        """The contacts of the last step."""
        return Contacts(self._data)

    @property
    def first_bodies(self) -> dict[str, FirstBody]:
        """The first bodies by name."""
        found = self._data.first_bodies()
        return {name: FirstBody(self._data, name, place) for name, place in found}

    @property
    def energy(self) -> dict[str, float]:
        """The energy ledger (J; J/m in 2D)."""
        result: dict[str, float] = loads(self._data.energies())
        return result

    @property
    def statistics(self) -> dict[str, float]:
        """A row of the statistics that a run has, now. Means over time, as of a measure ``Shear``, are of the steps since the row
        before; without a step between, the row is the same."""
        names = (name for name, _, _ in self._data.statistics_columns())
        return dict(zip(names, self._data.statistics()))

    def statistics_fields(self) -> dict[str, Field]:
        """Units and explanations of the statistics."""
        return {n: Field(unit, doc) for n, unit, doc in self._data.statistics_columns()}

    def __repr__(self) -> str:
        return f"<Simulation in {self.dimension}D at t = {self.time:g} s, {len(self.bodies)} bodies>"
