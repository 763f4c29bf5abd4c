"""The page `docs/python.md`, run as it stands: code blocks in their order, and what they print."""

import contextlib
import io
import re

import pytest
from conftest import ROOT

pytest.importorskip("xarray")
PAGE = ROOT / "docs" / "python.md"


def blocks():
    """Language, text and line of each block."""
    text = PAGE.read_text("utf-8")
    for match in re.finditer(r"^```(\w*)\n(.*?)^```$", text, re.S | re.M):
        yield match[1], match[2], text[: match.start()].count("\n") + 2


def test_the_page_does_what_it_says(here):
    names, printed, ran = {}, None, 0
    for language, text, line in blocks():
        if language == "python":
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                exec(compile("\n" * (line - 1) + text, str(PAGE), "exec"), names)
            printed, ran = output.getvalue(), ran + 1
        elif language == "text":
            assert printed == text, f"what the block above line {line} prints"
    assert ran == sum(language == "python" for language, _, _ in blocks()) > 5
