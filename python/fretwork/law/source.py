"""Errors with the place in the user's Python file, and what can be read off the source of a function."""

from __future__ import annotations

import ast
import difflib
import functools
import inspect
import linecache
import os
import textwrap
from collections.abc import Callable, Iterable
from types import FunctionType
from typing import Any


class LawError(ValueError):
    """What is wrong with a law written in Python, with the file and the line.

    Attributes:
        file: the Python file; ``None`` where the law as a whole is meant.
        line: the line in it, counted from 1.
    """

    def __init__(self, message: str, file: str | None = None, line: int | None = None) -> None:
        self.file, self.line = file, line
        if file is not None and line is not None:
            code = linecache.getline(file, line).rstrip()
            message = f"{_shown(file)}, line {line}: {message}" + (f"\n    {code.strip()}" if code.strip() else "")
        super().__init__(message)


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


#: Statements that have no meaning in a function compiled for one contact, with what to write in their place.
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
    ast.Lambda: "write a function of its own in place of a `lambda` inside a law",
}


def check(function: FunctionType, names: Iterable[str] = ()) -> None:
    """Refuses what a compiled function cannot have, and names that are not defined.

    Raises:
        LawError: with the line.
    """
    node = tree(function)
    body: list[ast.AST] = []
    if isinstance(node, ast.FunctionDef):
        body = [inner for statement in node.body for inner in ast.walk(statement)]
    elif node is not None:
        body = list(ast.walk(node.body))
    for inner in body:
        refused = _REFUSED.get(type(inner))
        if refused:
            raise at(function, refused, getattr(inner, "lineno", None))
        if isinstance(inner, ast.Call) and isinstance(inner.func, ast.Name) and inner.func.id == "print":
            raise at(function, "a compiled law cannot print; call the law in Python to look at its numbers", inner.lineno)
    _undefined(function, body, names)


def _undefined(function: FunctionType, body: list[ast.AST], names: Iterable[str]) -> None:
    import builtins

    known = {*function.__globals__, *vars(builtins), *function.__code__.co_varnames, *function.__code__.co_freevars}
    known |= {*function.__code__.co_cellvars}
    for inner in body:
        if isinstance(inner, ast.Name) and isinstance(inner.ctx, ast.Load) and inner.id not in known:
            if inner.id in names:
                reason = f"`{inner.id}` is not defined here; make it an argument of `{function.__name__}`"
            else:
                reason = f"`{inner.id}` is not defined{nearest(inner.id, [*names, *known])}"
            raise at(function, reason, inner.lineno)


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
