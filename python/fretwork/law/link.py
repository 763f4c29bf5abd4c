"""The C compiler that makes a library of the compiled loops and the table: `cc`, or zig from PyPI."""

from __future__ import annotations

import importlib.util
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from . import header
from .source import LawError

#: Names of libraries.
PREFIX, SUFFIX = ("", ".dll") if os.name == "nt" else ("lib", ".dylib" if sys.platform == "darwin" else ".so")


class UnknownFunction(LawError):
    """A compiled law calls a function that is nowhere."""


def compiler() -> list[str]:
    """The command of a C compiler: that of the environment variable CC, cc, gcc or clang on the path, or zig from PyPI.

    Raises:
        LawError: if there is none, with what to install.
    """
    chosen = os.environ.get("CC")
    if chosen:
        return shlex.split(chosen)
    for name in ("cc", "gcc", "clang"):
        if shutil.which(name):
            return [name]
    if importlib.util.find_spec("ziglang"):
        return [sys.executable, "-m", "ziglang", "cc"]
    raise LawError("a law is linked by a C compiler, and there is no `cc`, `gcc` or `clang`; install one, or: pip install ziglang")


def library(table: str, loops: bytes) -> bytes:
    """Links a table in C and an object file to a shared library.

    Raises:
        LawError: with what the compiler says.
    """
    command = compiler()
    with tempfile.TemporaryDirectory(prefix="fretwork-law-") as name:
        folder = Path(name)
        (folder / "fretwork.h").write_text(header.text(), "utf-8")
        (folder / "table.c").write_text(table, "utf-8")
        (folder / "loops.o").write_bytes(loops)
        flags = ["-O2", "-std=c11", "-shared", "-fPIC", "-fvisibility=hidden", "-s"]
        flags += ["-Wl,-undefined,error"] if sys.platform == "darwin" else ["-Wl,--no-undefined"]
        # zig compiles for the processor it runs on by default.
        flags += ["-mcpu=baseline"] if "ziglang" in command else []
        line = [*command, *flags, "-o", "law.so", "table.c", "loops.o", "-lm"]
        try:
            done = subprocess.run(line, cwd=folder, capture_output=True, text=True, errors="replace")
        except OSError as e:
            raise LawError(f"the C compiler `{' '.join(command)}` cannot be started ({e}); set CC, or: pip install ziglang") from None
        if done.returncode != 0:
            raise _failed(" ".join(command), done.stderr + done.stdout)
        return (folder / "law.so").read_bytes()


def _failed(command: str, said: str) -> LawError:
    missing = sorted(set(re.findall(r"undefined (?:reference to|symbol:?) [`']?([\w.]+)", said)))
    if any(symbol.startswith("NRT_") for symbol in missing):
        return UnknownFunction(
            "a law cannot make arrays, lists or texts: write numbers, one variable for each; arrays made outside it can be read"
        )
    if missing:
        return UnknownFunction(
            f"the law calls functions that are in no C library ({', '.join(missing[:4])}); use those of `math`, on numbers"
        )
    if re.search(r"(math|stdio|string|stdint|stddef)\.h", said) and re.search("No such file|not found", said):
        return LawError(f"`{command}` finds no headers of the C library; install them (libc6-dev, glibc-devel), or: pip install ziglang")
    lines = [line for line in said.splitlines() if line.strip()]
    return LawError(f"`{command}` could not link the law: " + "\n".join(lines[:8]))
