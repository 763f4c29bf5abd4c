"""The kinds of laws: one entry a kind, from which decorators, checks and the generated code follow.

A further kind is a further entry: its word, the functions that its laws have with the slots of the plugin table that they fill,
the columns that only its laws are given, and its flags. Names of columns and flags are those of the header.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from . import header
from .formulas import DERIVED
from .results import Attraction, Conductance, Friction, Spring, Traction


@dataclass(frozen=True)
class Function:
    """A function that the author of a law writes for one contact."""

    #: name by which further functions are given, ``@my_law.energy``; that of the first function
    #: says what it returns
    name: str
    #: function of the plugin table that calls it
    slot: str
    #: what it returns, in words
    returns: str
    #: the column written where it returns a number
    column: str | None = None
    #: named tuples that it may return, whose fields are columns without ``out_``
    results: tuple[Any, ...] = ()
    #: whether it also returns the new internal variables
    moves: bool = False
    #: flag that a law has because it has this function
    flag: str | None = None
    #: what the host calls where a law has no such function
    otherwise: Callable[[], float] | None = None


@dataclass(frozen=True)
class Kind:
    """A kind of laws."""

    word: str
    #: the decorated function, and those that may be added
    main: Function
    more: tuple[Function, ...] = ()
    #: columns (by the beginning of their names) and numbers that only laws of this kind are given
    claims: tuple[str, ...] = ()
    #: flags that a law has because it uses columns that begin so
    asks: dict[str, str] = field(default_factory=dict)
    #: options of the decorator, the flag that each sets, and its default
    options: dict[str, tuple[str, bool]] = field(default_factory=dict)
    #: exponent m of psi = (1 - D)^m psi_0 where bonds have one
    degradation: float = 0.0
    #: whether a fracture energy can be declared
    fractures: bool = False
    #: whether a law of parameters alone is called once for all contacts
    constant: bool = False

    def functions(self) -> tuple[Function, ...]:
        """All functions that a law of this kind may have."""
        return (self.main, *self.more)

    def inputs(self) -> dict[str, str]:
        """What its functions may have as arguments: names with descriptions and units."""
        others = tuple(c for kind in KINDS.values() if kind is not self for c in kind.claims if c not in self.claims)
        raw = {**header.columns(), **header.numbers()}
        own = {name: m.doc for name, m in raw.items() if not name.startswith(others)}
        for name, formula in DERIVED.items():
            if all(needed in own for needed in arguments(formula)):
                own[name] = (formula.__doc__ or "").splitlines()[0]
        return own


def arguments(function: Any) -> tuple[str, ...]:
    """Names of the arguments of a function."""
    code = function.__code__
    return tuple(code.co_varnames[: code.co_argcount + code.co_kwonlyargcount])


def _nothing() -> float:
    return 0.0


#: Flags that a law of any kind may have.
COMMON_OPTIONS = {"only_2d": ("FW_FLAG_2D_ONLY", False), "only_3d": ("FW_FLAG_3D_ONLY", False)}

#: A law that uses these columns needs a case that computes heat.
_THERMAL = {name: "FW_FLAG_TEMPERATURE" for name in ("temperature", "conductivity", "resistivity")}

_KINDS = (
    Kind(
        word="contact",
        main=Function("friction", "prepare", "the friction coefficient, or a Friction", "out_friction", (Friction,)),
        more=(
            Function("spring", "prepare", "a Spring", None, (Spring,), flag="FW_FLAG_COMPLIANT"),
            Function("commit", "commit", "the new internal variables", moves=True),
        ),
        claims=("overlap", "effective_mass", "spring_"),
        asks={**_THERMAL, **{name: "FW_FLAG_COMPLIANT" for name in ("overlap", "effective_mass", "spring_")}},
        constant=True,
    ),
    Kind(
        word="cohesion",
        main=Function("traction", "prepare", "a Traction, or an Attraction", "out_tension_strength", (Traction, Attraction)),
        more=(
            Function("energy", "energy", "the energy stored by the bond (J/m^2)", "out_energy", otherwise=_nothing),
            Function("commit", "commit", "the new internal variables", moves=True),
            Function("damage", "commit", "the damage D", "out_damage", moves=True, flag="FW_FLAG_BREAKS"),
        ),
        asks={**_THERMAL, "rotation_": "FW_FLAG_MOMENT", "out_moment_": "FW_FLAG_MOMENT"},
        options={"tension_only": ("FW_FLAG_TENSION_ONLY", True), "forms": ("FW_FLAG_FORMS", True)},
        degradation=1.0,
        fractures=True,
    ),
    Kind(
        word="damage",
        main=Function("damage", "commit", "the damage D at the end of the step", "out_damage", moves=True),
        claims=("intact_", "energy_intact", "degradation"),
        asks=_THERMAL,
        fractures=True,
    ),
    Kind(
        word="wear",
        main=Function("volume", "commit", "the volume removed in the step (m^3)", "out_volume", moves=True),
        claims=("slip", "friction_work"),
        asks=_THERMAL,
    ),
    Kind(
        word="transport",
        main=Function(
            "conductance", "commit", "the thermal conductance (W/K), or a Conductance", "out_conductance", (Conductance,), moves=True
        ),
        claims=("slip", "friction_work"),
    ),
)

#: All kinds, by their words.
KINDS: dict[str, Kind] = {kind.word: kind for kind in _KINDS}
