"""From a law in Python to a library."""

from __future__ import annotations

import atexit
import functools
import hashlib
import os
import shutil
import tempfile
import warnings
from pathlib import Path
from types import FunctionType
from typing import TYPE_CHECKING, Any, cast

from . import header, link, loops, plugin_table, source
from .kinds import COMMON_OPTIONS, Function
from .loops import Answer, Loop
from .source import LawError

if TYPE_CHECKING:
    from .definition import Law
    from .numba_compiler import Compiler


def build(law: Law, folder: str | os.PathLike[str] | None = None) -> Path:
    """Writes the library of a law: see `Law.build`."""
    content = library(law)
    kept = hashlib.sha256(content).hexdigest()
    place = _own_folder() / kept[:16] if folder is None else Path(folder)
    try:
        place.mkdir(parents=True, exist_ok=True)
        path = place.resolve() / f"{link.PREFIX}fretwork_{law.kind}_{law.name.replace('-', '_')}{link.SUFFIX}"
        _warn_if_replaced(law, path, kept)
        if not path.is_file() or path.read_bytes() != content:
            # A new file: a process that has the old one open keeps it whole.
            fresh = path.with_name(f".{path.name}.{os.getpid()}")
            fresh.write_bytes(content)
            fresh.chmod(0o755)
            fresh.replace(path)
    except OSError as e:
        raise LawError(f"the library of the law `{law.name}` cannot be written to {place}: {e.strerror}; choose another folder") from None
    return path


#: SHA-256 of what this process wrote, by path.
_written: dict[Path, str] = {}


def _warn_if_replaced(law: Law, path: Path, kept: str) -> None:
    if _written.setdefault(path, kept) != kept:
        _written[path] = kept
        warnings.warn(
            f"the law `{law.name}` was changed and built to the same file; a library that this Python has opened stays as it was: "
            "build without a folder, or start Python again, to run the new one here",
            RuntimeWarning,
            stacklevel=4,
        )


@functools.cache
def _own_folder() -> Path:
    folder = Path(tempfile.mkdtemp(prefix="fretwork-laws-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def library(law: Law) -> bytes:
    """The library of a law: the same bytes for the same law."""
    content: bytes | None = law.__dict__.get("_library")
    functions = [*law.functions.items(), *law.constants.items(), *law.conditions]
    functions += [("", law.fracture)] if law.fracture else []
    state = [(name, source.state(function)) for name, function in functions]
    if content is None or law.__dict__.get("_state") != state:
        try:
            content = link.library(*compiled(law))
        except link.UnknownFunction as e:
            raise source.at(law.functions[law._kind.main.name], str(e)) from None
        law.__dict__["_library"], law.__dict__["_state"] = content, state
    return content


def compiled(law: Law) -> tuple[str, bytes]:
    """The C source of the table, and the object file of the loops.

    Raises:
        LawError: with the file and line of what cannot be compiled.
    """
    from .numba_compiler import Compiler

    _complete(law)
    compiler = Compiler()
    specs = law._kind.functions()
    answers = [_answer(law, compiler, spec, law.functions[spec.name]) for spec in specs if spec.name in law.functions]
    given = {f"out_{name}" for fields in compiler.given.values() for name in fields}
    for answer in answers:
        needed = {f"out_{f}" for result in answer.spec.results for f in result._fields if f not in result._field_defaults}
        answer.columns = [(c, p) for c, p in answer.columns if not answer.spec.results or c in given or c in needed]
    flags = _flags(law, answers)
    for spec in specs:
        if spec.name not in law.functions and spec.otherwise is not None:
            answers.append(_answer(law, compiler, spec, cast(FunctionType, spec.otherwise)))
    made: list[Loop] = []
    for slot in dict.fromkeys(a.spec.slot for a in answers):
        here = [a for a in answers if a.spec.slot == slot]
        columns = loops.used_columns(law, [a.function for a in here]) + [c for a in here for c, _ in a.columns]
        for k, missing in enumerate(loops.variants(columns)):
            loop = loops.generate(law, slot, here, missing, f"{slot}_{k}")
            numbers = header.numbers().values()
            kinds = ("i", *("d" if m.type == "double" else "i" for m in numbers))
            pointers = 1 + len(law.variables) * (1 + loop.moves) + len(loop.inputs) + len(loop.outputs)
            compiler.add(loop.code, loop.symbol, loops.names(law, here, compiler.function), pointers, kinds)
            made.append(loop)
    conditions = []
    for k, (message, function) in enumerate(law.conditions):
        _number_of(compiler, function, "a condition returns whether the parameters are accepted, true or false")
        _of_parameters(law, compiler, function, f"condition_{k}", "1 if {} else 0")
        conditions.append((message, f"condition_{k}"))
    if law.fracture is not None:
        _number_of(compiler, law.fracture, "the fracture energy is a number (J/m^2)")
        _of_parameters(law, compiler, law.fracture, "fracture", "float({})", ("angle",))
    content = compiler.object()
    called = [name for name in plugin_table.MATH if name.encode() + b"\0" in content]
    table = plugin_table.source(law, made, flags, conditions, "fracture" if law.fracture else None, called)
    return table, content


def _of_parameters(law: Law, compiler: Compiler, function: FunctionType, symbol: str, answer: str, more: tuple[str, ...] = ()) -> None:
    heads = ", ".join(["n", *(f"i_{m}" for m in more), "parameters"])
    values = ", ".join(
        f"i_{name}" if name in more else f"parameters[{list(law.parameters).index(name)}]" for name in source.signature(function)
    )
    code = f"def {symbol}({heads}):\n    return {answer.format(f'function({values})')}\n"
    compiler.add(code, symbol, {"function": compiler.function(function)}, 1, ("i", *("d" for _ in more)))


def _complete(law: Law) -> None:
    """Refuses a law that lacks a function."""
    kind = law._kind
    main = law.functions[kind.main.name]
    moving = [f for f in kind.functions() if f.moves and f.name in law.functions]
    if law.variables and not moving:
        names = [f"@{main.__name__}.{f.name}" for f in kind.more if f.moves]
        raise source.at(
            main,
            f"the law `{law.name}` has the internal variable `{next(iter(law.variables))}`, and nothing moves it; add a function "
            f"under {' or '.join(names)} that returns its new value",
        )
    for function in law.functions.values():
        for name in loops.used_columns(law, [function]):
            for start, flag in kind.asks.items():
                giver = next((f for f in kind.more if f.flag == flag), None)
                if name.startswith(start) and giver and giver.name not in law.functions:
                    raise source.at(
                        function,
                        f"`{name}` is given to laws with a function under @{main.__name__}.{giver.name} only; add one, or drop the argument",
                        source.argument_line(function, name),
                    )


def _answer(law: Law, compiler: Compiler, spec: Function, function: FunctionType) -> Answer:
    """Compiles a function of the law, and finds which columns what it returns goes to."""
    types = _types()
    type_ = compiler.returned(function, ("dimension",))
    answer = Answer(spec, function)
    moves = spec.moves and bool(law.variables)
    wanted = _wanted(law, spec, moves)
    if isinstance(type_, (types.NoneType, types.Optional)):
        some = "returns nothing" if isinstance(type_, types.NoneType) else "returns nothing on some path"
        raise source.at(function, f"`{function.__name__}` {some}; it returns {wanted}", source.empty_return(function))
    refused = source.at(function, f"`{function.__name__}` returns {_described(type_)}; it returns {wanted}")
    first: Any = type_
    place: tuple[int, ...] = ()
    if moves:
        items = list(type_.types) if isinstance(type_, types.BaseTuple) and not isinstance(type_, types.BaseNamedTuple) else [type_]
        lead = 0 if spec.column is None else 1
        if len(items) != lead + len(law.variables):
            raise refused
        if any(not _is_number(t) for t in items):
            raise refused
        single = not isinstance(type_, types.BaseTuple)
        answer.state = [() if single else (lead + k,) for k in range(len(law.variables))]
        first, place = items[0], () if single else (0,)
    if spec.column is None and not spec.results:
        return answer
    results: dict[Any, Any] = {result.__name__: result for result in spec.results}
    if isinstance(first, types.BaseNamedTuple) and first.instance_class in results.values():
        fields = first.instance_class._fields
        answer.columns = [(f"out_{name}", (*place, k)) for k, name in enumerate(fields)]
    elif _is_number(first) and spec.column is not None:
        answer.columns = [(spec.column, place)]
    else:
        raise refused
    return answer


def _wanted(law: Law, spec: Function, moves: bool) -> str:
    names = ", ".join(f"`{v}`" for v in law.variables)
    if not moves:
        return spec.returns
    if spec.column is None:
        return f"{spec.returns}: {names}"
    return f"{spec.returns}, and behind it the new values of {names}: `return d, {', '.join(law.variables)}`"


def _described(type_: Any) -> str:
    types = _types()
    if isinstance(type_, types.BaseNamedTuple):
        return f"a {type_.instance_class.__name__}"
    if isinstance(type_, types.BaseTuple):
        return f"{len(type_.types)} values"
    if _is_number(type_):
        return "one number"
    from .explain import _words

    return _words(str(type_))


def _types() -> Any:
    from .numba_compiler import imported

    return imported("numba.core.types")


def _is_number(type_: Any) -> bool:
    types = _types()
    return isinstance(type_, (types.Float, types.Integer, types.Boolean))


def _number_of(compiler: Compiler, function: FunctionType, wanted: str) -> None:
    type_ = compiler.returned(function)
    if not _is_number(type_):
        raise source.at(function, f"`{function.__name__}` returns {_described(type_)}; {wanted}", source.empty_return(function))


def _flags(law: Law, answers: list[Answer]) -> list[str]:
    kind = law._kind
    main = answers[0]
    written = {c for a in answers for c, _ in a.columns}
    used = set(loops.used_columns(law, [a.function for a in answers]))
    flags = {a.spec.flag for a in answers if a.spec.flag}
    flags |= {flag for start, flag in kind.asks.items() if any(c.startswith(start) for c in used | written)}

    opens = "out_traction_n" in written
    if opens:
        flags.add("FW_FLAG_OPENING")
        if "energy" not in law.functions:
            name = main.function.__name__
            raise source.at(
                main.function,
                f"the bond `{law.name}` has a traction and no stored energy; add a function under @{name}.energy that returns it (J/m^2)",
            )
    elif kind.word == "cohesion" and "energy" in law.functions:
        raise source.at(law.functions["energy"], "an attraction stores no energy in the bond; drop this function, or return a Traction")
    for option, (flag, _) in {**COMMON_OPTIONS, **kind.options}.items():
        if law.options[option] and (opens or option not in kind.options):
            flags.add(flag)
    numbers = {n for a in answers for n in source.signature(a.function)} & set(kind.inputs())
    if kind.constant and len(answers) == 1 and not used and not numbers and not law.variables:
        flags.add("FW_FLAG_CONSTANT")
    return sorted(flags)
