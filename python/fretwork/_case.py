"""Cases: read, built, edited, checked and run."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from time import time
from typing import Any, Literal, Union
from warnings import warn

from . import _fretwork
from ._check import Check
from ._errors import Error
from ._fretwork import CaseData, SimulationData
from ._observers import Answer, Observer, adapt
from ._plot import LivePlot
from ._progress import Progress, display
from ._report import report as make_report
from ._results import Results
from ._sections import Section, part, shown
from ._simulation import Simulation
from ._values import assignments, dumps, loads

AnyPath = Union[str, "PathLike[str]"]
Sets = Union[Mapping[str, object], Sequence[str]]

_NAME = "case.ron (built in Python)"


def _sets(given: Sets) -> list[str]:
    return assignments(given) if isinstance(given, Mapping) else list(given)


def _make_report(folder: AnyPath) -> None:
    """The report of a run that has just ended. That there is none does not change how the run ended."""
    try:
        make_report(folder)
    except Error as error:
        warn(f"there is no report: {error}", stacklevel=3)


def _has_results_since(folder: AnyPath, began: float) -> bool:
    """Whether a run has written results since a time, so that those in the folder are not of an older one."""
    try:
        return (Path(folder) / "results.h5").stat().st_mtime >= began - 1.0
    except OSError:
        return False


class Case:
    """A case: what a case file says, to be read, changed, checked and run.

    >>> case = Case(
    ...     name="a ball in the air",
    ...     dimension=2,
    ...     time={"step": 1e-3, "end": 0.1},
    ...     gravity=[0.0, -9.81],
    ...     materials={"steel": "rail_steel_r260"},
    ...     grains=[{"List": {"material": "steel", "grains": [{"at": [0.0, 0.0], "radius": 0.01}]}}],
    ... )
    >>> case["time.end"] = 0.2            # by key path, as with --set
    >>> case.time.end, case.time.theta    # or by attributes, defaults included
    (0.2, 0.5)
    >>> case.grains[0].grains[0].radius
    0.01

    The keywords are the fields of case files (``docs/case_format.md``). A kind with fields, ``Sine(amplitude: 1.0, ...)`` in a
    case file, is ``{"Sine": {"amplitude": 1.0, ...}}``; one without, ``Free``, is ``"Free"``. A mistake raises
    :class:`InputError`, and the case stays as it was.
    """

    __slots__ = ("_data",)
    _data: CaseData

    def __init__(self, *, folder: AnyPath = "", **fields: object) -> None:
        """Makes a case of its fields; ``folder`` is where files that it names are looked for."""
        fields.setdefault("interfaces", [])
        data = CaseData.from_json(_NAME, dumps(fields, "the case"), os.fspath(folder))
        object.__setattr__(self, "_data", data)

    @classmethod
    def _of(cls, data: CaseData) -> Case:
        case = cls.__new__(cls)
        object.__setattr__(case, "_data", data)
        return case

    @classmethod
    def load(cls, path: AnyPath, set: Sets = ()) -> Case:
        """Reads a case file. ``set`` changes values: a dictionary by key path, or texts ``key.path=value`` as after ``--set``."""
        return cls._of(CaseData.load(os.fspath(path), _sets(set)))

    @classmethod
    def from_text(
        cls, text: str, *, name: str = "case.ron", folder: AnyPath = "", set: Sets = ()
    ) -> Case:
        """Reads the text of a case file; errors name it ``name``, and files that it names are looked for in ``folder``."""
        return cls._of(CaseData.from_text(name, text, os.fspath(folder), _sets(set)))

    def copy(self) -> Case:
        """The same case, to be changed by itself."""
        return self._of(self._data.copy())

    # Values.

    def _value(self, path: str) -> Any:
        json = self._data.value(path)
        return None if json is None else loads(json)

    def __getitem__(self, path: str) -> Any:
        """The value at a key path: a number, text or list, or a :class:`Section` of what has parts. ``KeyError`` if there is
        no such path."""
        return shown(self, path, self._data.value(path))

    def __setitem__(self, path: str, value: object) -> None:
        if isinstance(value, Section):
            value = value.value
        self._data.assign(path, dumps(value, path))

    def __contains__(self, path: str) -> bool:
        try:
            return self._data.value(path) is not None
        except KeyError:
            return False

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __setattr__(self, name: str, value: object) -> None:
        self[name] = value

    def set(self, *assignments: str) -> None:
        """Changes values by texts ``key.path=value``, as after ``--set``: the value is written as in a case file. All of them,
        or none if one is wrong."""
        self._data.set(list(assignments))

    def append(self, path: str, value: object) -> None:
        """Adds an element to the list at a key path, such as a grain or a body."""
        old = self._value(path) or []
        if not isinstance(old, list):
            raise TypeError(f"`{path}` is no list")
        self[path] = [*old, value]

    def keys(self, path: str = "") -> list[str]:
        """Names at a key path: fields, whether the case gives them or not; of a map or list its entries."""
        result = self._data.names(path)
        return result[1] if result is not None and result[0] != "kinds" else []

    def kinds(self, path: str) -> list[str]:
        """What a value that is one of several kinds may be.

        >>> Case.load("cases/plane_shear.ron").kinds("coupling")
        ['Explicit', 'Midpoint', 'Implicit']
        """
        result = self._data.names(path)
        return result[1] if result is not None and result[0] == "kinds" else []

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.keys()]

    def _ipython_key_completions_(self) -> list[str]:
        found = []
        for key in self.keys():
            found.append(key)
            found += [f"{key}.{part(below)}" for below in self.keys(key)]
        return found

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Case) and self._data.equals(other._data)

    __hash__ = None  # type: ignore[assignment]

    # Text.

    @property
    def text(self) -> str:
        """The text of the case file, edits applied; comments are kept."""
        return self._data.text

    def to_ron(self) -> str:
        """The case as a new text with all numbers written out, defaults too."""
        return self._data.to_ron()

    def to_dict(self) -> dict[str, Any]:
        """The fields of the case: ``Case(**case.to_dict()) == case``."""
        result: dict[str, Any] = loads(self._data.value_of_all())
        return result

    def save(self, path: AnyPath) -> None:
        """Writes :attr:`text` into a file."""
        Path(path).write_text(self.text, encoding="utf-8")

    @property
    def file(self) -> Path:
        """The file that the case was read from."""
        return Path(self._data.path)

    def __repr__(self) -> str:
        return f"<Case {self._value('name')!r} in {self._value('dimension')}D, {self.file}>"

    # What is done with it.

    def check(
        self,
        *,
        timing: bool = True,
        plugin_path: Sequence[AnyPath] = (),
        trust_plugins: bool = False,
    ) -> Check:
        """Builds the scene and reports what it uses and will cost, as ``fretwork check --verbose``. With ``timing`` steps are timed for half
        a second."""
        folders = [os.fspath(p) for p in plugin_path]
        title, lines = self._data.check(folders, trust_plugins, timing)
        return Check(str(self.file), title, lines)

    def run(
        self,
        out: AnyPath | None = None,
        *,
        threads: int = 1,
        progress: bool | Literal["plot"] | Callable[[Progress], object] = True,
        resume: bool = False,
        report: bool = True,
        observers: Sequence[Observer | Callable[[Simulation], Answer]] = (),
        plugin_path: Sequence[AnyPath] = (),
        trust_plugins: bool = False,
    ) -> Results:
        """Runs the case to its end and returns its results.

        Files go to ``out``, by default ``results/NAME`` of the case file; those of an older run there are replaced. They are the
        same bits as those of ``fretwork run``, on any number of ``threads``. ``progress`` shows a bar (with tqdm), with
        ``"plot"`` in a notebook also the figure of :meth:`Results.plot` as the run goes on, or calls a function with a
        :class:`Progress` some times a second.

        Ctrl-C ends the run after its step, with all files written, and raises ``KeyboardInterrupt``; ``resume=True`` goes on
        from there, or from the last checkpoint of a run that was killed. A finished run is not repeated.

        ``report=False`` leaves out ``report.html``, and so does Ctrl-C; :func:`report` makes it later.

        ``observers`` are called after each step: functions of the simulation, or objects of a class of :class:`Observer`.

        Raises ``InputError`` if the case is wrong, ``RunError`` if the run fails, and what an observer raises.
        """
        folder = _fretwork.default_folder(self.file) if out is None else out
        shows = LivePlot(display(True), Path(folder), lambda: Results(folder).statistics) if progress == "plot" else display(progress)
        began = time()

        def show(*line: Any) -> None:
            shows.show(Progress(*line))

        try:
            _fretwork.run(
                self._data,
                os.fspath(folder),
                threads,
                resume,
                [os.fspath(p) for p in plugin_path],
                trust_plugins,
                show if progress else None,
                [adapt(observer) for observer in observers],
            )
        except Exception:
            if report and _has_results_since(folder, began):
                _make_report(folder)
            raise
        finally:
            shows.close()
        if report:
            _make_report(folder)
        return Results(folder)

    def simulation(
        self,
        *,
        threads: int = 1,
        plugin_path: Sequence[AnyPath] = (),
        trust_plugins: bool = False,
    ) -> Simulation:
        """Builds the scene, to be stepped by hand. Nothing is written."""
        folders = [os.fspath(p) for p in plugin_path]
        return Simulation(SimulationData(self._data, threads, folders, trust_plugins))
