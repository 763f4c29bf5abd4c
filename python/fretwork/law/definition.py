"""A law in Python, and the decorators that make one."""

from __future__ import annotations

import inspect
import os
import re
from collections.abc import Callable
from pathlib import Path
from types import FunctionType
from typing import TYPE_CHECKING, Any, Protocol, overload

from . import header, source
from .fields import Parameter, Variable
from .kinds import COMMON_OPTIONS, KINDS, Function, Kind
from .source import LawError

if TYPE_CHECKING:
    from .bench import Certificate, Curve

_EMPTY = inspect.Parameter.empty


class Law:
    """A law written in Python: made by the decorators of its kind, see `docs/python_laws.md`.

    Further functions are added with the decorators named after them, ``@my_law.energy``, ``@my_law.commit``, ... They have the
    parameters and variables of the law as arguments by name. Called, a law evaluates its first function in Python, with its
    parameters at their defaults.

    Attributes:
        kind: word of its kind.
        name: name in cases.
        doc: one line about it.
        reference: paper or DOI.
        version: its own version.
        parameters: its parameters, by name.
        variables: its internal variables, by name.
    """

    def __init__(
        self,
        kind: Kind,
        function: FunctionType,
        *,
        name: str | None,
        reference: str,
        version: str,
        constants: dict[str, Callable[..., float]],
        degradation: float,
        options: dict[str, bool],
    ) -> None:
        self._kind = kind
        self.kind = kind.word
        self.name = name or function.__name__.replace("_", "-")
        self.doc = source.doc_line(function) or f"{kind.word} law in Python"
        self.reference, self.version = reference, version
        self.degradation = degradation
        self.options = options
        self.parameters: dict[str, Parameter] = {}
        self.variables: dict[str, Variable] = {}
        self.constants: dict[str, FunctionType] = {}
        self.functions: dict[str, FunctionType] = {}
        self.conditions: list[tuple[str, FunctionType]] = []
        self.fracture: FunctionType | None = None
        self.__doc__ = inspect.getdoc(function)
        self.__wrapped__ = function
        self._check_texts(function)
        self._declare(function)
        for constant, formula in constants.items():
            self._add_constant(constant, formula, function)
        self._arguments(function)
        self.functions[kind.main.name] = function

    def __repr__(self) -> str:
        return f"<{self.kind} law {self.name} of {len(self.parameters)} parameters>"

    def __call__(self, *args: Any, **named: Any) -> Any:
        """The first function in Python, with parameters at their defaults and variables at their initial values."""
        function = self.functions[self._kind.main.name]
        bound = inspect.signature(function).bind_partial(*args, **named)
        for argument in inspect.signature(function).parameters:
            if argument in bound.arguments:
                continue
            if argument in self.parameters:
                bound.arguments[argument] = self.parameters[argument].default
            elif argument in self.variables:
                bound.arguments[argument] = self.variables[argument].initial
            elif argument in self.constants:
                formula = self.constants[argument]
                values = (self.parameters[p].default for p in source.signature(formula))
                bound.arguments[argument] = formula(*values)
            else:
                raise TypeError(f"give `{argument}`, an input of the {self.kind} law `{self.name}`")
        return function(*bound.args, **bound.kwargs)

    # Decorators of further functions.

    def __getattr__(self, name: str) -> Callable[[FunctionType], FunctionType]:
        kind: Kind | None = self.__dict__.get("_kind")
        if kind is None or name.startswith("__"):
            raise AttributeError(name)
        spec = next((f for f in kind.more if f.name == name), None)
        if spec is None:
            names = [f.name for f in kind.more] + [n for n in dir(type(self)) if not n.startswith("_")]
            raise AttributeError(
                f"a {self.kind} law has no `{name}`{source.nearest(name, names) or '.'} "
                f"Functions that may be added: {', '.join(f.name for f in kind.more) or 'none'}"
            )
        return lambda function: self._add(spec, function)

    def _add(self, spec: Function, function: FunctionType) -> FunctionType:
        _plain(function, f"@{self.name}.{spec.name}")
        if spec.name in self.functions:
            raise source.at(function, f"the law `{self.name}` has a function `{spec.name}` already; drop one of the two")
        if spec.moves:
            other = next((f for f in self._kind.more if f.moves and f.name != spec.name and f.name in self.functions), None)
            if other is not None:
                raise source.at(
                    function,
                    f"the law `{self.name}` has a function `{other.name}`, which moves its variables; `{spec.name}` would do so "
                    "again: drop one of the two",
                )
        self._declare(function)
        self._arguments(function)
        self.functions[spec.name] = function
        return function

    def fracture_energy(self, function: FunctionType) -> FunctionType:
        """Adds the fracture energy (J/m^2) of slow monotonic loading, of parameters and ``angle`` (rad; 0 is mode I), for `certify`."""
        _plain(function, f"@{self.name}.fracture_energy")
        if not self._kind.fractures:
            raise source.at(function, f"a {self.kind} law has no fracture energy; only cohesion and damage laws have one")
        self._of_parameters(function, "the fracture energy", ("angle",))
        self.fracture = function
        return function

    def require(self, message: str) -> Callable[[FunctionType], FunctionType]:
        """Adds a condition between parameters: a function of parameters that is true where a case may have them.

        Args:
            message: what a user reads whose parameters do not fulfil it.
        """
        if not isinstance(message, str):
            raise LawError("`require` needs the sentence that a user reads: @my_law.require('`mu_d` exceeds `mu_s`')")

        def add(function: FunctionType) -> FunctionType:
            _plain(function, f"@{self.name}.require(...)")
            self._of_parameters(function, "a condition")
            self.conditions.append((message, function))
            return function

        return add

    # Checks of what was declared.

    def _check_texts(self, function: FunctionType) -> None:
        if not re.fullmatch(r"[a-z0-9][a-z0-9-]{0,59}", self.name):
            raise source.at(
                function,
                f'`{self.name}` is no valid name for a law; use a-z, 0-9 and -, at most 60 characters: name="my-law"',
            )
        for what, text in (("doc", self.doc), ("reference", self.reference), ("version", self.version)):
            if not isinstance(text, str) or "\0" in text or "\n" in text:
                raise source.at(function, f"the {what} of the law `{self.name}` must be a text of one line")
        if not (isinstance(self.degradation, (int, float)) and 0.0 <= self.degradation < 1e300):
            raise source.at(function, f"the degradation exponent {self.degradation!r} must be a number, 0 or above")

    def _declare(self, function: FunctionType) -> None:
        """Takes parameters and variables from the defaults of arguments."""
        for name, default in source.signature(function).items():
            if default is _EMPTY:
                continue
            line = source.argument_line(function, name)
            if not isinstance(default, (Parameter, Variable)):
                hint = f"{name}=Parameter({default!r}, range=(..., ...), doc=...)"
                raise source.at(function, f"the argument `{name}` has the default {default!r}; a parameter is written {hint}", line)
            what = type(default).__name__.lower()
            problem = default.problem()
            if problem:
                raise source.at(function, f"the {what} `{name}` {problem}", line)
            if not re.fullmatch(r"[a-z][a-z0-9_]*", name):
                raise source.at(function, f"the {what} `{name}` needs a name of a-z, 0-9 and _, a letter first", line)
            if name in self._kind.inputs():
                doc = self._kind.inputs()[name]
                raise source.at(function, f"`{name}` is an input ({doc}); give the {what} another name", line)
            if name in self.parameters or name in self.variables:
                raise source.at(function, f"`{name}` is declared already; write it here without a default", line)
            if isinstance(default, Parameter):
                self.parameters[name] = default
            else:
                self.variables[name] = default

    def _arguments(self, function: FunctionType) -> None:
        """Refuses arguments that are nothing the law has."""
        inputs = self._kind.inputs()
        own = [*self.parameters, *self.variables, *self.constants]
        for name in source.signature(function):
            if name in inputs or name in own:
                continue
            near = source.nearest(name, [*inputs, *own])
            raise source.at(
                function,
                f"a {self.kind} law has no input `{name}`{near or '; fretwork.law.inputs(' + repr(self.kind) + ') lists them.'} "
                f"A parameter is written {name}=Parameter(default, range=(smallest, largest), unit=..., doc=...)",
                source.argument_line(function, name),
            )
        source.check(function, [*inputs, *own])

    def _of_parameters(self, function: FunctionType, what: str, more: tuple[str, ...] = ()) -> None:
        for name in source.signature(function):
            if name not in self.parameters and name not in more:
                near = source.nearest(name, [*self.parameters, *more])
                raise source.at(
                    function,
                    f"{what} depends on parameters alone, and `{name}` is none of the law `{self.name}`{near}",
                    source.argument_line(function, name),
                )
        source.check(function, self.parameters)

    def _add_constant(self, name: str, formula: Any, function: FunctionType) -> None:
        if not source.is_plain(formula):
            raise source.at(function, f"the constant `{name}` must be a function of parameters: constants={{'{name}': lambda mu: ...}}")
        if name in self.parameters or name in self.variables or name in self._kind.inputs():
            raise source.at(function, f"`{name}` is a constant and something else; give the constant another name")
        self._of_parameters(formula, f"the constant `{name}`")
        self.constants[name] = formula

    # What a law can do.

    def build(self, folder: str | os.PathLike[str] | None = None) -> Path:
        """Compiles the law to a plugin that needs no Python.

        Args:
            folder: where the library goes, made if it does not exist; by default a temporary folder of this process, its own
                for each version of the law.

        Returns:
            Path of the library, ``libfretwork_KIND_NAME.so``; its folder is a plugin path.

        Raises:
            LawError: with the file and line of what cannot be compiled.
        """
        from . import build

        return build.build(self, folder)

    def drive(self, *partners: Law | str, **options: Any) -> Curve:
        """Drives one contact with this law and perhaps others along a path: see `fretwork.law.drive`."""
        from . import bench

        return bench.drive(self, *partners, **options)

    def certify(self, **parameters: float) -> Certificate:
        """Tests what the law promises: see `fretwork.law.certify`."""
        from . import bench

        return bench.certify(self, (), **parameters)


def _plain(function: Any, decorator: str) -> None:
    if not source.is_plain(function):
        raise LawError(f"{decorator} stands above a function of Python (`def`), not above {function!r}")


class Decorator(Protocol):
    """The decorator of a kind, above a function or with options."""

    @overload
    def __call__(self, function: Callable[..., Any], /) -> Law: ...

    @overload
    def __call__(
        self,
        *,
        name: str | None = None,
        reference: str = "",
        version: str = "0.1.0",
        constants: dict[str, Callable[..., float]] | None = None,
        degradation: float = 1.0,
        **options: bool,
    ) -> Callable[[Callable[..., Any]], Law]: ...


def decorator(word: str) -> Decorator:
    """The decorator of a kind."""
    kind = KINDS[word]
    options = {**COMMON_OPTIONS, **kind.options}
    names = ["name", "reference", "version", "constants", *(["degradation"] if kind.degradation else []), *options]

    def law(
        function: Any = None,
        /,
        *,
        name: str | None = None,
        reference: str = "",
        version: str = "0.1.0",
        constants: dict[str, Callable[..., float]] | None = None,
        degradation: float = kind.degradation,
        **chosen: bool,
    ) -> Any:
        wrong = next((option for option in chosen if option not in options), None)
        if degradation != kind.degradation and not kind.degradation:
            wrong = "degradation"
        if wrong is not None:
            raise LawError(f"@{word} has no option `{wrong}`{source.nearest(wrong, names) or '.'} It has {', '.join(names)}")

        def make(function: FunctionType) -> Law:
            _plain(function, f"@{word}")
            return Law(
                kind,
                function,
                name=name,
                reference=reference,
                version=version,
                constants=constants or {},
                degradation=degradation,
                options={option: bool(chosen.get(option, default)) for option, (_, default) in options.items()},
            )

        return make(function) if function is not None else make

    law.__name__ = law.__qualname__ = word
    law.__doc__ = _documentation(kind, options)
    return law


def _documentation(kind: Kind, options: dict[str, tuple[str, bool]]) -> str:
    flags = header.constants()
    lines = [f"Makes a {kind.word} law of a function of one contact, which returns {kind.main.returns}.", ""]
    lines.append(f'Its arguments are inputs by name (`fretwork.law.inputs("{kind.word}")` lists them), parameters')
    if kind.main.moves:
        lines.append("(`mu=Parameter(...)`) and internal variables (`psi=Variable(...)`), whose new values it returns behind its answer:")
        lines.append("`return answer, psi`.")
    else:
        movers = " or ".join(f"`@my_law.{f.name}`" for f in kind.more if f.moves)
        lines.append("(`mu=Parameter(...)`) and internal variables (`psi=Variable(...)`), whose new values a function returns that stands")
        lines.append(f"under {movers}.")
    lines += ["", "Args:", "    name: name in cases; by default that of the function with `-` for `_`."]
    lines += ["    reference: paper or DOI.", "    version: the law's own version."]
    lines += ["    constants: functions of parameters by name, computed once a call; arguments like the others."]
    lines += ["    degradation: exponent m of psi = (1 - D)^m psi_0."] if kind.degradation else []
    for option, (flag, default) in options.items():
        lines.append(f"    {option}: {flags[flag].rstrip('.')}. {'True' if default else 'False'} by default.")
    if kind.more:
        lines += ["", "Further functions:"]
        lines += [f"    `@my_law.{f.name}` returns {f.returns}." for f in kind.more]
    return "\n".join(lines) + "\n"
