"""The loops over a batch that are generated around the functions of a law.

For each slot of the plugin table that the law fills there is one loop for each set of columns that a host may give: with
and without those of a third dimension, with and without rotations. A column that is not given is zero. A loop reads the inputs,
calls the functions of the law, writes their answers, and says whether all of them were finite.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from types import FunctionType
from typing import TYPE_CHECKING, Any

from . import header, source
from .formulas import DERIVED
from .kinds import Function, arguments

if TYPE_CHECKING:
    from .definition import Law


@dataclass
class Answer:
    """What one function of the law answers."""

    spec: Function
    function: FunctionType
    #: the columns it writes, with the places of their values in what it returns; a place of `None`
    #: is the value itself
    columns: list[tuple[str, tuple[int, ...]]] = field(default_factory=list)
    #: places of the new internal variables, in their order
    state: list[tuple[int, ...]] = field(default_factory=list)


@dataclass(frozen=True)
class Loop:
    """A generated loop."""

    symbol: str
    slot: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    moves: bool
    code: str


def is_spatial(column: str) -> bool:
    """Whether a column is null in two dimensions."""
    name = column.removeprefix("out_")
    return name.endswith("_t2") or name in ("rotation_n", "moment_n", "intact_moment_n")


def is_rotation(column: str) -> bool:
    """Whether a column is null where the cohesion law of the interface does not resist rotation."""
    return column.startswith(("rotation_", "intact_moment_"))


def used_columns(law: Law, functions: Iterable[FunctionType]) -> list[str]:
    """The columns that functions read, directly or by inputs that are computed from them."""
    known, found = header.columns(), []
    for function in functions:
        for name in source.signature(function):
            needed = arguments(DERIVED[name]) if name in DERIVED else (name,)
            found += [n for n in needed if n in known]
    return [name for name in known if name in found]


def variants(columns: Iterable[str]) -> list[frozenset[str]]:
    """Sets of columns that may be missing, the fewest first."""
    columns = list(columns)
    spatial = frozenset(c for c in columns if is_spatial(c))
    rotating = frozenset(c for c in columns if is_rotation(c))
    sets = [frozenset(), rotating, spatial, spatial | rotating]
    return sorted(set(sets), key=lambda s: (len(s), sorted(s)))


def generate(law: Law, slot: str, answers: list[Answer], missing: frozenset[str], symbol: str) -> Loop:
    """The source of a loop."""
    functions = [a.function for a in answers]
    columns = used_columns(law, functions)
    given = [c for c in columns if c not in missing]
    written = [(c, k, place) for k, a in enumerate(answers) for c, place in a.columns if c not in missing]
    moves = any(a.spec.moves for a in answers) and bool(law.variables)
    numbers = list(header.numbers())
    heads = ["n", *(f"i_{name}" for name in numbers), "parameters"]
    heads += [f"s_{v}" for v in law.variables]
    heads += [f"x_{v}" for v in law.variables] if moves else []
    heads += [f"c_{c}" for c in given] + [f"o_{c}" for c, _, _ in written]
    lines = [f"def {symbol}({', '.join(heads)}):"]
    lines += [f"    i_{name} = parameters[{k}]" for k, name in enumerate(law.parameters)]
    wanted = {name for f in functions for name in source.signature(f)}
    for name, formula in law.constants.items():
        if name in wanted:
            lines.append(f"    i_{name} = constant_{name}({_call(source.signature(formula))})")
    lines += ["    finite = True", "    for k in range(n):"]
    lines += [f"        i_{c} = {'0.0' if c in missing else f'c_{c}[k]'}" for c in columns]
    lines += [f"        i_{v} = s_{v}[k]" for v in law.variables if v in wanted]
    for name, derived in DERIVED.items():
        if name in wanted:
            lines.append(f"        i_{name} = derived_{name}({_call(arguments(derived))})")
    for k, answer in enumerate(answers):
        lines.append(f"        r_{k} = function_{k}({_call(source.signature(answer.function))})")
    for column, k, place in written:
        lines += [f"        v = float({_at(f'r_{k}', place)})", f"        o_{column}[k] = v", "        finite &= isfinite(v)"]
    for k, answer in enumerate(answers):
        for variable, place in zip(law.variables, answer.state, strict=bool(answer.state)):
            lines += [f"        v = float({_at(f'r_{k}', place)})", f"        x_{variable}[k] = v", "        finite &= isfinite(v)"]
    lines += ["    return 0 if finite else 1"]
    outputs = tuple(c for c, _, _ in written)
    return Loop(symbol, slot, tuple(given), outputs, moves, "\n".join(lines) + "\n")


def _call(names: Iterable[str]) -> str:
    return ", ".join(f"i_{name}" for name in names)


def _at(value: str, place: tuple[int, ...]) -> str:
    return value + "".join(f"[{k}]" for k in place)


def names(law: Law, answers: list[Answer], compiled: Callable[[Any], Any]) -> dict[str, Any]:
    """What the source of a loop refers to: the compiled functions."""
    found: dict[str, Any] = {f"function_{k}": compiled(a.function) for k, a in enumerate(answers)}
    found |= {f"derived_{name}": compiled(formula) for name, formula in DERIVED.items()}
    found |= {f"constant_{name}": compiled(formula) for name, formula in law.constants.items()}
    return found
