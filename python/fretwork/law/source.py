"""Errors with the place in the user's Python file, and what can be read off the source of a function."""

from __future__ import annotations

import ast
import builtins
import difflib
import functools
import inspect
import linecache
import os
import textwrap
from collections.abc import Callable, Iterable
from types import CodeType, FunctionType, ModuleType
from typing import Any

from fretwork._errors import InputError


class LawError(InputError):
    """What is wrong with a law, or with what it is asked for; of a law written in Python with the file and the line."""

    def __init__(self, message: str, file: str | None = None, line: int | None = None) -> None:
        text = message
        if file is not None and line is not None:
            code = linecache.getline(file, line).strip()
            text = f"{_shown(file)}, line {line}: {message}" + (f"\n    {code}" if code else "")
        super().__init__(text, file or "", line, message=message)


def _shown(file: str) -> str:
    """A file as a reader finds it: relative where it is near."""
    if file.startswith("<"):
        return file
    near = os.path.relpath(file)
    return file if near.startswith("..") else near


def at(function: FunctionType, message: str, line: int | None = None) -> LawError:
    """An error at a line of a function, by default its first."""
    return LawError(message, function.__code__.co_filename, line or head(function))


@functools.cache
def tree(function: FunctionType) -> ast.FunctionDef | ast.Lambda | None:
    """The syntax tree of a function with the line numbers of its file; ``None`` where the source is not known."""
    try:
        lines, first = inspect.getsourcelines(function)
        parsed = ast.parse(textwrap.dedent("".join(lines)))
    except (OSError, TypeError, SyntaxError):
        return None
    ast.increment_lineno(parsed, max(first, 1) - 1)
    kinds = (ast.Lambda,) if function.__name__ == "<lambda>" else (ast.FunctionDef,)
    found = [node for node in ast.walk(parsed) if isinstance(node, kinds)]
    named = [node for node in found if isinstance(node, ast.Lambda) or node.name == function.__name__]
    return named[0] if len(named) == 1 else None


def head(function: FunctionType) -> int:
    """Line of ``def``."""
    node = tree(function)
    return node.lineno if node else function.__code__.co_firstlineno


def argument_line(function: FunctionType, name: str) -> int:
    """Line at which an argument stands."""
    node = tree(function)
    every = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs] if node else []
    return next((a.lineno for a in every if a.arg == name), head(function))


def is_plain(function: Any) -> bool:
    """Whether it is a function written in Python."""
    return isinstance(function, FunctionType)


def signature(function: FunctionType) -> dict[str, Any]:
    """Names of the arguments with their defaults (``inspect.Parameter.empty`` without one)."""
    spread = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    found = {}
    for name, argument in inspect.signature(function).parameters.items():
        if argument.kind in spread:
            raise at(
                function,
                f"a law names each of its arguments, but `{function.__name__}` has `*{name}`; write out the inputs and the parameters",
                argument_line(function, name),
            )
        found[name] = argument.default
    return found


#: Statements that have no meaning in a function compiled for one contact, with what to write in
#: their place.
_REFUSED: dict[type[ast.AST], str] = {
    ast.Raise: "a compiled law cannot raise; return a number, or `SMALLER_STEP` to ask for a smaller time step",
    ast.Assert: "a compiled law cannot assert; give the parameter a range, or add a condition on parameters with `require`",
    ast.Try: "a compiled law has no exceptions: 1/0 is infinite and sqrt(-1) is not a number; test the argument in place of `try`",
    ast.With: "a compiled law cannot use `with`: it works with numbers alone",
    ast.Global: "a law is pure: it cannot change a global; keep what a contact remembers in a Variable",
    ast.Nonlocal: "a law is pure: it cannot change names outside; keep what a contact remembers in a Variable",
    ast.JoinedStr: "a compiled law works with numbers and cannot make texts",
    ast.Import: "import at the top of the file, not in a law",
    ast.ImportFrom: "import at the top of the file, not in a law",
    ast.Yield: "a law returns its answer; it cannot `yield`",
    ast.Await: "a law returns its answer; it cannot `await`",
    ast.List: "a compiled law has no lists: write numbers, one variable for each, or a tuple",
    ast.ListComp: "a compiled law has no lists: write a loop over numbers",
    ast.SetComp: "a compiled law has no sets: write a loop over numbers",
    ast.DictComp: "a compiled law has no tables: write a loop over numbers",
    ast.GeneratorExp: "a compiled law has no generators: write a loop over numbers",
    ast.Dict: "a compiled law has no tables: write numbers, one variable for each",
    ast.Set: "a compiled law has no sets: write numbers, one variable for each",
    ast.Lambda: "write a function of its own in place of a `lambda` inside a law",
}


def check(function: FunctionType, names: Iterable[str] = ()) -> None:
    """Refuses what a compiled function cannot have: exceptions, texts, lists, names that are not defined.

    Args:
        function: a function of a law, or one that it calls.
        names: inputs and parameters that it might have as arguments.

    Raises:
        LawError: with the line.
    """
    node = tree(function)
    if isinstance(node, ast.FunctionDef):
        documented = ast.get_docstring(node) is not None
        body: list[ast.AST] = [inner for statement in node.body[documented:] for inner in ast.walk(statement)]
        _unassigned(function, node)
    else:
        body = list(ast.walk(node.body)) if node is not None else []
    for inner in body:
        refused = _REFUSED.get(type(inner))
        if isinstance(inner, ast.Constant) and isinstance(inner.value, (str, bytes)):
            refused = "a compiled law works with numbers and has no texts"
        if refused:
            raise at(function, refused, getattr(inner, "lineno", None))
        if isinstance(inner, ast.Call):
            _call(function, inner)
        if isinstance(inner, ast.Attribute):
            module = _value(function, inner.value)
            if isinstance(module, ModuleType) and not hasattr(module, inner.attr):
                near = nearest(inner.attr, dir(module))
                raise at(function, f"`{module.__name__}` has no `{inner.attr}`{near}", inner.lineno)
    _undefined(function, body, names)


def _value(function: FunctionType, node: ast.AST) -> Any:
    """What a name, or a name in a module, stands for outside the function; `None` where it is not known."""
    if isinstance(node, ast.Name) and node.id not in function.__code__.co_varnames:
        return function.__globals__.get(node.id)
    if isinstance(node, ast.Attribute):
        module = _value(function, node.value)
        return getattr(module, node.attr, None) if isinstance(module, ModuleType) else None
    return None


def _call(function: FunctionType, node: ast.Call) -> None:
    called = _value(function, node.func)
    if isinstance(node.func, ast.Name) and node.func.id == "print":
        raise at(function, "a compiled law cannot print; call the law in Python to look at its numbers", node.lineno)
    fields = getattr(called, "_fields", None)
    if not isinstance(called, type) or fields is None:
        return
    for keyword in node.keywords:
        if keyword.arg is not None and keyword.arg not in fields:
            near = nearest(keyword.arg, fields)
            what = f"`{called.__name__}` has no `{keyword.arg}`{near}{'' if near else ';'} It has {', '.join(fields)}"
            raise at(function, what, keyword.value.lineno)
    given = {*fields[: len(node.args)], *(k.arg for k in node.keywords)}
    missing = [f for f in fields if f not in given and f not in getattr(called, "_field_defaults", {})]
    if missing and not any(isinstance(a, ast.Starred) for a in node.args) and None not in given:
        raise at(function, f"`{called.__name__}` also needs {', '.join(missing)}", node.lineno)


def _undefined(function: FunctionType, body: list[ast.AST], names: Iterable[str]) -> None:
    known = {*function.__globals__, *vars(builtins), *function.__code__.co_varnames, *function.__code__.co_freevars}
    known |= {*function.__code__.co_cellvars}
    for inner in body:
        if isinstance(inner, ast.Name) and isinstance(inner.ctx, ast.Load) and inner.id not in known:
            if inner.id in names:
                reason = f"`{inner.id}` is not defined here; make it an argument of `{function.__name__}`"
            else:
                reason = f"`{inner.id}` is not defined{nearest(inner.id, [*names, *known])}"
            raise at(function, reason, inner.lineno)


def _unassigned(function: FunctionType, node: ast.FunctionDef) -> None:
    """Refuses a variable that has a value on some paths only: compiled, it would be zero on the others."""
    names = set(function.__code__.co_varnames)
    arguments = {a.arg for a in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)}

    def reads(tree: ast.AST | None, known: set[str]) -> None:
        for inner in ast.walk(tree) if tree is not None else ():
            if isinstance(inner, ast.Name) and isinstance(inner.ctx, ast.Load) and inner.id in names - known:
                reason = f"`{inner.id}` has a value on some paths only; give it one before the `if` or the loop"
                raise at(function, reason, inner.lineno)

    def targets(tree: ast.AST) -> set[str]:
        return {n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}

    def run(statements: list[ast.stmt], known: set[str]) -> set[str]:
        """The names with values after these statements; all of them behind a jump."""
        for statement in statements:
            if isinstance(statement, ast.If):
                reads(statement.test, known)
                known = run(statement.body, set(known)) & run(statement.orelse, set(known))
            elif isinstance(statement, ast.While):
                reads(statement.test, known)
                run(statement.body, set(known))
                run(statement.orelse, set(known))
            elif isinstance(statement, ast.For):
                reads(statement.iter, known)
                run(statement.body, known | targets(statement.target))
                run(statement.orelse, set(known))
            elif isinstance(statement, ast.AugAssign):
                if isinstance(statement.target, ast.Name):
                    reads(ast.copy_location(ast.Name(statement.target.id, ast.Load()), statement), known)
                reads(statement.value, known)
            elif isinstance(statement, (ast.Return, ast.Break, ast.Continue, ast.Raise)):
                reads(statement, known)
                return set(names)
            else:
                reads(statement, known)
                known = known | targets(statement)
        return known

    run(node.body, arguments)


def state(function: FunctionType, seen: tuple[FunctionType, ...] = ()) -> tuple[Any, ...]:
    """What the compiled function depends on: its code, and the values of the names it looks up, in functions it calls too."""
    names = names_used(function.__code__)
    values = [(name, function.__globals__[name]) for name in sorted(names) if name in function.__globals__]
    values += [("", cell.cell_contents) for cell in function.__closure__ or ()]
    modules = [v for _, v in values if isinstance(v, ModuleType) and v.__name__.split(".")[0] not in KNOWN_MODULES]
    values += [(name, getattr(module, name)) for module in modules for name in sorted(names) if hasattr(module, name)]
    found: list[Any] = [function.__code__]
    for name, value in values:
        if isinstance(value, FunctionType) and value not in seen:
            found.append((name, state(value, (*seen, function))))
        elif isinstance(value, (int, float, tuple)):
            found.append((name, repr(value)))
        elif hasattr(value, "tobytes"):
            found.append((name, value.tobytes()))
    return tuple(found)


def names_used(code: CodeType) -> set[str]:
    """Names that a code and those within it look up."""
    names = set(code.co_names)
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            names |= names_used(constant)
    return names


#: Modules whose functions numba compiles itself.
KNOWN_MODULES = ("math", "cmath", "numpy", "operator", "builtins", "numba")


def empty_return(function: FunctionType) -> int:
    """Line of the first ``return`` without a value, or the last line."""
    node = tree(function)
    if not isinstance(node, ast.FunctionDef):
        return head(function)
    returns = [n for n in ast.walk(node) if isinstance(n, ast.Return) and n.value is None]
    return returns[0].lineno if returns else node.body[-1].end_lineno or node.lineno


def nearest(name: str, names: Iterable[str]) -> str:
    """`; did you mean ...?`, or nothing."""
    near = difflib.get_close_matches(name, sorted(set(names)), n=1, cutoff=0.6)
    return f"; did you mean `{near[0]}`?" if near else ""


def doc_line(function: Callable[..., Any]) -> str:
    """First line of the documentation of a function."""
    lines = (inspect.getdoc(function) or "").strip().splitlines()
    return lines[0].strip() if lines else ""
