"""Laws that there are, and the test bench: one contact driven along a path, and the certificate of a law."""

from __future__ import annotations

import builtins
import json
import math
import os
import re
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fretwork._errors import InputError, RunError, missing

from .source import LawError, nearest

if TYPE_CHECKING:
    import pandas as pd

    from .definition import Law

PathLike: TypeAlias = str | os.PathLike[str]

#: Units of the columns of `drive`.
UNITS = {
    "time": "s",
    "opening_n": "m",
    "opening_t1": "m",
    "opening_t2": "m",
    "traction_n": "Pa",
    "traction_t1": "Pa",
    "traction_t2": "Pa",
    "damage": "",
    "work": "J/m^2",
    "stored": "J/m^2",
    "friction": "",
    "tension_strength": "Pa",
    "worn": "m^3",
}


@dataclass(frozen=True)
class Field:
    """A parameter or an internal variable of a law.

    Attributes:
        name: its name.
        unit: SI unit, `""` for a pure number.
        doc: one line about it.
        default: default of a parameter, initial value of a variable.
        minimum: smallest accepted value.
        maximum: largest accepted value.
    """

    name: str
    unit: str
    doc: str
    default: float
    minimum: float
    maximum: float


@dataclass(frozen=True)
class Info:
    """What is known of a law.

    Attributes:
        kind: word of its kind.
        name: name in cases.
        doc: one line about it.
        reference: paper or DOI.
        version: its own version.
        path: its library, or the file that it is built into.
        sha256: SHA-256 of that file.
        built_in: whether it comes with Fretwork.
        parameters: its parameters.
        variables: its internal variables.
        error: why its library cannot be used; empty if it can.
    """

    kind: str
    name: str
    doc: str
    reference: str
    version: str
    path: Path
    sha256: str
    built_in: bool
    parameters: tuple[Field, ...]
    variables: tuple[Field, ...]
    error: str = ""

    def __str__(self) -> str:
        if self.error:
            return f"{self.kind} law {self.name}: cannot be used: {self.error}"
        lines = [f"{self.kind} law {self.name} {self.version}", f"  {self.doc}", f"  reference  {self.reference or '-'}"]
        lines += [f"  library    {'built into ' if self.built_in else ''}{self.path}"]
        for title, fields in (("parameters", self.parameters), ("variables", self.variables)):
            lines += [f"  {title}"] if fields else []
            for f in fields:
                span = f" in [{f.minimum:g}, {f.maximum:g}]" if title == "parameters" else ""
                lines.append(f"    {f.name:<18} {f.default:>10g} {f.unit or '-':<9}{span}  {f.doc}")
        return "\n".join(lines)


@dataclass(frozen=True)
class Check:
    """A line of a certificate.

    Attributes:
        name: what is checked.
        outcome: `"pass"`, `"fail"`, or `"skip"` where it does not apply to the law.
        number: the number that decided.
        text: what it is.
    """

    name: str
    outcome: Literal["pass", "fail", "skip"]
    number: float
    text: str


@dataclass(frozen=True)
class Certificate:
    """Result of `certify`; printed, it is the table of `fretwork law certify`.

    Attributes:
        kind: kind of the law.
        name: its name.
        version: its version.
        sha256: SHA-256 of its library.
        library: its library.
        checks: all lines.
    """

    kind: str
    name: str
    version: str
    sha256: str
    library: Path
    checks: tuple[Check, ...]

    @property
    def certified(self) -> bool:
        """Whether no check failed."""
        return not self.failures

    @property
    def failures(self) -> tuple[Check, ...]:
        """The checks that failed."""
        return tuple(c for c in self.checks if c.outcome == "fail")

    def __str__(self) -> str:
        words = {"pass": "pass", "fail": "FAIL", "skip": "-"}
        lines = [f"{self.kind} law {self.name} {self.version} ({self.sha256[:12]})"]
        lines += [f"  {words[c.outcome]:<5} {c.name:<16} {c.number:>10.2e}  {c.text}" for c in self.checks]
        return "\n".join([*lines, "  certified" if self.certified else "  NOT certified"])


class Curve(dict[str, NDArray[np.float64]]):
    """Response of a contact: one array a column, of one length; `UNITS` has the units.

    The columns: time, opening and traction along n, t1, t2, damage, cumulative work and stored energy per area, friction
    coefficient, attraction without opening, cumulative worn volume.
    """

    #: what the test bench remarked, such as that a bond failed before the target was reached
    remarks: str = ""

    @property
    def units(self) -> dict[str, str]:
        """Units of the columns."""
        return {name: UNITS.get(name, "") for name in self}

    def frame(self) -> pd.DataFrame:
        """As a table of pandas, with the units in `attrs["units"]`."""
        try:
            import pandas as pd
        except ImportError:
            raise missing("pandas", "results", "a table") from None
        table: pd.DataFrame = pd.DataFrame(dict(self))
        table.attrs["units"] = self.units
        return table


def inputs(kind: str) -> dict[str, str]:
    """Inputs that functions of a law of a kind may have as arguments: names with descriptions and units.

    >>> inputs("wear")["slip"]
    'Slip distance over this step, h |u_t| (m) (wear).'
    """
    from .kinds import KINDS

    if kind not in KINDS:
        raise LawError(f"there is no kind `{kind}`{nearest(kind, KINDS)}; kinds are {', '.join(KINDS)}")
    return KINDS[kind].inputs()


def list(plugin_path: PathLike | Iterable[PathLike] = ()) -> builtins.list[Info]:
    """All laws that a run finds: those that come with Fretwork, in these folders, and in `FRETWORK_PLUGIN_PATH`.

    Args:
        plugin_path: further folders with libraries of laws.

    >>> [law.name for law in list() if law.kind == "wear"]
    ['archard', 'broken-bonds', 'dissipated-energy', 'oxidation', 't-gamma', 'tabulated', 'thermal-archard']
    """
    return _infos(_native("laws", None, _folders(plugin_path)))


def show(name: str, plugin_path: PathLike | Iterable[PathLike] = ()) -> Info:
    """What is known of a law.

    Args:
        name: its name, or kind/name if laws of several kinds have it.
        plugin_path: further folders with libraries of laws.

    >>> show("archard").parameters[0].unit
    '1/Pa'
    """
    found = _infos(_native("laws", name, _folders(plugin_path)))
    if len(found) > 1:
        raise LawError(f"laws of several kinds are named `{name}`; use one of {', '.join(f'{i.kind}/{i.name}' for i in found)}")
    return found[0]


def certify(law: Law | str, /, plugin_path: PathLike | Iterable[PathLike] = (), **parameters: float) -> Certificate:
    """Tests what a law promises, as `fretwork law certify`: energy, dissipation, batches, threads, invalid numbers.

    The tests run in a process of their own: a law that crashes or hangs fails the check `comes back`.

    Args:
        law: a law in Python, or the name of a law, kind/name if laws of several kinds have it.
        plugin_path: further folders with libraries of laws.
        parameters: values of its parameters; the others have their defaults.

    >>> certify("archard", k=1e-13).certified
    True
    """
    names, folders = _built([law], plugin_path)
    given = [(name, _number(name, value)) for name, value in parameters.items()]
    found = json.loads(_native("certify_law", names[0], given, folders))
    lines = tuple(
        Check(line["check"], line["outcome"], math.inf if line["number"] is None else line["number"], line["text"])
        for line in found["lines"]
    )
    return Certificate(found["kind"], found["name"], found["version"], found["sha256"], Path(found["library"]), lines)


def drive(
    *laws: Law | str,
    parameters: Mapping[str, float] | None = None,
    mode: Literal["I", "II", "mixed", "cyclic", "force", "slide"] = "I",
    path: PathLike | Mapping[str, ArrayLike] | None = None,
    to: float | None = None,
    angle: float | None = None,
    rate: float = 1e-3,
    steps: int = 2000,
    cycles: int = 5,
    velocities: Sequence[float] = (),
    pressure: float | None = None,
    radius: float | None = None,
    case: PathLike | None = None,
    interface: str | None = None,
    plugin_path: PathLike | Iterable[PathLike] = (),
) -> Curve:
    """Drives one contact along a path, as `fretwork law drive`.

    It runs in a process of its own: a law that crashes or hangs ends as an error here.

    Args:
        laws: laws to compose, in Python or by name: a name fills every slot that has a law of this name, kind/name one.
        parameters: values by name, or by kind.name where laws of several kinds have the name; with `case` values of the case by key.
        mode: opening along the normal (I), along the tangent (II), at an angle (mixed), forth and back (cyclic), under a traction that
            grows (force); sliding at `velocities`.
        path: a path in place of a mode: a CSV file, or columns `time` (s), `n`, `t1` and perhaps `t2` (m), each of one value a step.
        to: largest opening (m), traction (force, Pa) or distance at each velocity (slide, m); by default beyond the break of the bond.
        angle: angle to the normal (degrees) in mixed, cyclic and force.
        rate: speed of the opening (m/s).
        steps: steps of the path, of each cycle or of each velocity.
        cycles: number of cycles.
        velocities: velocities in sequence (m/s) in slide.
        pressure: compressive pressure (Pa); by default 1e6 in slide, otherwise 0.
        radius: reduced radius of the contact (m).
        case: drive the laws of an interface of this case.
        interface: name of the interface, if the case has several.
        plugin_path: further folders with libraries of laws.

    Returns:
        One array a column; `.frame()` makes a table of pandas.

    >>> curve = drive("elastic-bond", "linear-softening", parameters={"strength": 2e5})
    >>> bool(abs(curve["traction_n"].max() - 2e5) < 1e3)
    True
    """
    if not laws and case is None:
        raise LawError('name a law to drive: drive(my_law), or drive("elastic-bond", "linear-softening")')
    names, folders = _built(laws, plugin_path)
    words = [*names, "--mode", mode]
    values = {"to": to, "angle": angle, "rate": rate, "pressure": pressure, "radius": radius}
    for name, value in values.items():
        words += [f"--{name}={_number(name, value)!r}"] if value is not None else []
    words += [f"--steps={int(steps)}", f"--cycles={int(cycles)}"]
    if len(velocities):
        words.append("--velocities=" + ",".join(repr(_number("velocities", v)) for v in velocities))
    for name, value in (parameters or {}).items():
        words.append(f"--set={name}={value if case is not None else repr(_number(name, value))}")
    words += [f"--case={os.fspath(case)}"] if case is not None else []
    words += [f"--interface={interface}"] if interface is not None else []
    words += [f"--plugin-path={folder}" for folder in folders]
    with tempfile.TemporaryDirectory(prefix="fretwork-path-") as folder:
        if path is not None:
            file = _path_file(path, Path(folder)) if isinstance(path, Mapping) else os.fspath(path)
            words.append(f"--path={file}")
        try:
            table, remarks = _native("drive_laws", words)
        except LawError as e:
            # Options of the command line as the arguments that they are here.
            said = re.sub(r"--([a-z][a-z-]+)", lambda m: m[1].replace("-", "_"), e.message)
            raise LawError(said) from None
    rows = json.loads(table)
    curve = Curve({name: np.array([row[name] for row in rows]) for name in rows[0]})
    curve.remarks = remarks
    return curve


def _path_file(path: Mapping[str, ArrayLike], folder: Path) -> str:
    columns = {name: np.asarray(values, dtype=float).reshape(-1) for name, values in path.items()}
    known = ("time", "n", "t1", "t2", "t")
    for name in columns:
        if name not in known:
            raise LawError(f"the path has a column `{name}`{nearest(name, known)}; it has time (s), n, t1 and perhaps t2 (m)")
    if len({len(c) for c in columns.values()}) > 1:
        raise LawError("the columns of the path differ in length: " + ", ".join(f"{n} has {len(c)}" for n, c in columns.items()))
    file = folder / "path.csv"
    lines = [",".join(columns)]
    lines += [",".join(repr(float(x)) for x in row) for row in zip(*columns.values(), strict=True)]
    file.write_text("\n".join(lines) + "\n", "utf-8")
    return str(file)


def _built(laws: Iterable[Law | str], plugin_path: PathLike | Iterable[PathLike]) -> tuple[builtins.list[str], builtins.list[str]]:
    """Names of laws, and the folders where they are: laws in Python are built."""
    from .definition import Law

    names, folders = [], []
    for law in laws:
        if isinstance(law, Law):
            folders.append(str(law.build().parent))
            names.append(f"{law.kind}/{law.name}")
        elif isinstance(law, str):
            names.append(law)
        else:
            raise LawError(f"{law!r} is no law; give a law in Python or the name of one")
    return names, [*folders, *_folders(plugin_path)]


def _folders(plugin_path: PathLike | Iterable[PathLike]) -> builtins.list[str]:
    one = isinstance(plugin_path, (str, os.PathLike))
    folders: Any = [plugin_path] if one else plugin_path
    return [os.fspath(folder) for folder in folders]


def _number(name: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise LawError(f"`{name}` needs a number, not {value!r}") from None


def _infos(text: str) -> builtins.list[Info]:
    def field(f: dict[str, Any]) -> Field:
        low = -math.inf if f["minimum"] is None else f["minimum"]
        high = math.inf if f["maximum"] is None else f["maximum"]
        return Field(f["name"], f["unit"], f["doc"], f["default"], low, high)

    found = []
    for law in json.loads(text):
        found.append(
            Info(
                kind=law["kind"],
                name=law["name"],
                doc=law.get("doc", ""),
                reference=law.get("reference", ""),
                version=law.get("version", ""),
                path=Path(law["path"]),
                sha256=law.get("sha256", ""),
                built_in=law.get("built_in", False),
                parameters=tuple(field(f) for f in law.get("parameters", ())),
                variables=tuple(field(f) for f in law.get("variables", ())),
                error=law.get("error", ""),
            )
        )
    return found


def _native(function: str, *arguments: Any) -> Any:
    """Calls the compiled module; its errors are sentences."""
    import fretwork._fretwork as native

    called: Callable[..., Any] = getattr(native, function)
    try:
        return called(*arguments)
    except (InputError, RunError):
        raise
    except (ValueError, RuntimeError) as e:
        raise LawError(str(e)) from None
