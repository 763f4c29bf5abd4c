"""Numba's errors as sentences about a line of the user's file."""

from __future__ import annotations

import math
import re
from types import FunctionType

from . import source
from .source import LawError

#: Types of numba in words.
_WORDS = {
    "float64": "a number",
    "int64": "a whole number",
    "bool": "true or false",
    "boolean": "true or false",
    "none": "nothing",
    "unicode_type": "a text",
}


def explain(error: Exception, function: FunctionType, files: set[str]) -> LawError:
    """The error of a law for an error of numba in one of these files."""
    text = re.sub(r"\x1b\[[0-9;]*m", "", str(error))
    file, line = _place(text, function, files)
    return LawError(_sentence(text, function), file, line)


def _place(text: str, function: FunctionType, files: set[str]) -> tuple[str, int]:
    """The last place in one of the user's files that numba names."""
    import os

    known = {os.path.abspath(f): f for f in files} | {f: f for f in files}
    own = os.path.dirname(__file__)
    found = []
    for name, line in re.findall(r'File "([^"]+)", line (\d+)', text) + re.findall(r"at ((?:[A-Za-z]:)?[^\s()]+) \((\d+)\)", text):
        place = known.get(name) or known.get(os.path.abspath(name))
        if place is not None and os.path.dirname(os.path.abspath(place)) != own:
            found.append((place, int(line)))
    return found[-1] if found else (function.__code__.co_filename, source.head(function))


def _words(type_name: str) -> str:
    name = type_name.strip()
    if name in _WORDS:
        return _WORDS[name]
    if name.startswith(("Literal[str]", "unicode")):
        return "a text"
    if name.startswith(("Literal[int]", "int", "uint")):
        return "a whole number"
    if name.startswith(("omitted", "float")):
        return "a number"
    if name.startswith("complex"):
        return "a complex number"
    if name.startswith(("Tuple", "UniTuple")):
        return "several numbers"
    if name.startswith(("list", "reflected list", "ListType", "array", "DictType", "dict", "set")):
        return "a list, array or table"
    return f"`{name}`"


def _sentence(text: str, function: FunctionType) -> str:
    """What is wrong, from what numba says."""
    if m := re.search(r"Unknown attribute '(\w+)' of type Module\(<module '([\w.]+)'", text):
        import importlib

        try:
            names = dir(importlib.import_module(m[2]))
        except ImportError:
            names = []
        if m[1] in names:
            return f"`{m[2]}.{m[1]}` cannot be compiled; use functions of `math` on numbers"
        return f"`{m[2]}` has no `{m[1]}`{source.nearest(m[1], names)}"
    if m := re.search(r"Unknown attribute '(\w+)' of type (\S+)", text):
        return f"{_words(m[2])} has no `{m[1]}`"
    if m := re.search(r"NameError: name '(\w+)' is not defined", text):
        return f"`{m[1]}` is not defined{source.nearest(m[1], [*function.__globals__, *dir(math)])}"
    if m := re.search(r"Untyped global name '(\w+)'[^<]*(<class '[^']+'>)?", text):
        return f"`{m[1]}` is no number and no function that can be compiled; a law uses numbers, functions in Python and `math`"
    if m := re.search(r"Cannot unify (.+?) and (.+?) for '(\w+?)(?:\.\d+)?'", text):
        return f"`{m[3]}` is {_words(m[1])} on one path and {_words(m[2])} on another; make it a number on both"
    if re.search(r"(unify return type|return type.*unify)", text):
        return "the function returns different things on different paths; return the same kind of answer on all"
    if m := re.search(r"Variable '?(\w+?)(?:\.\d+)?'? referenced before assignment", text):
        return f"`{m[1]}` is used before it has a value"
    if m := re.search(
        r"No implementation of function Function\(<(?:built-in )?function (\w+)[^>]*>\) found for signature:\s*>>> \w+\((.*?)\)\s*$",
        text,
        re.M,
    ):
        sign = {
            "add": "+",
            "sub": "-",
            "mul": "*",
            "truediv": "/",
            "pow": "**",
            "lt": "<",
            "gt": ">",
            "le": "<=",
            "ge": ">=",
            "eq": "==",
            "getitem": "[ ]",
        }.get(m[1].removeprefix("i"))
        given = " and ".join(_words(t) for t in re.split(r",\s*(?![^(]*\))", m[2]) if t) or "nothing"
        what = f"`{sign}`" if sign else f"`{m[1]}`"
        return f"{what} does not take {given}; a law works with numbers"
    if m := re.search(r"(missing a required argument: '\w+'|got an unexpected keyword argument '\w+'|too many positional arguments)", text):
        return f"a function is called with other arguments than it has: {m[1]}"
    if m := re.search(r"tuple index out of range", text):
        return "there are fewer values than the place that is asked for"
    if m := re.search(
        r"(?:UnsupportedError|NotImplementedError|UnsupportedBytecodeError)?:? ?([^\n]*not supported[^\n]*|[^\n]*unsupported[^\n]*|Use of [^\n]*)",
        text,
    ):
        return f"this cannot be compiled: {m[1].strip().rstrip('.')}; a law works with numbers, `if`, `for` and `while`"
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    said = [line for line in lines if not line.startswith(("Failed in", "During:", "File ", "<source", "^", "-", "This error", "For more"))]
    return f"this cannot be compiled: {(said or ['numba gives no reason'])[0].rstrip('.')}"
