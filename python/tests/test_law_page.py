"""The page `docs/python_laws.md`, run as it stands: code blocks in their order, each followed by what it prints."""

import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

for package in ("numba", "pandas", "h5py"):
    pytest.importorskip(package)

PAGE = Path(__file__).parents[2] / "docs" / "python_laws.md"


def blocks():
    """Language, text and line of each block."""
    text = PAGE.read_text("utf-8")
    for match in re.finditer(r"^```(\w*)\n(.*?)^```$", text, re.S | re.M):
        yield match[1], match[2], text[: match.start()].count("\n") + 2


@pytest.mark.skipif(not PAGE.is_file(), reason="the page is part of the source")
def test_the_page_does_what_it_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", os.path.dirname(sys.executable), prepend=os.pathsep)
    names = {"__name__": "page"}
    printed, last = "", 0
    ran = set()
    for language, text, line in blocks():
        where = f"{PAGE.name}, line {line}"
        if language == "python":
            # A file of its own, so that the functions have a source.
            file = tmp_path / f"block_{line}.py"
            file.write_text(text, "utf-8")
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                exec(compile(text, str(file), "exec"), names)
            printed, last = output.getvalue(), line
        elif language == "text":
            assert printed.strip() == text.strip(), f"{where}: the block of line {last} prints\n{printed}"
            printed = ""
        elif language == "ron":
            (tmp_path / text.split()[1]).write_text(text, "utf-8")
        elif language == "bash":
            assert shutil.which("fretwork"), "the command line is not installed"
            done = subprocess.run(text, shell=True, capture_output=True, text=True)
            assert done.returncode == 0, f"{where}: {done.stderr}"
        ran.add(language)
    assert {"python", "text", "ron", "bash"} <= ran
    assert (tmp_path / "slide" / "statistics.csv").is_file()
