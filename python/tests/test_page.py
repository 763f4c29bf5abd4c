"""Pages with blocks of Python, run as they stand: code blocks in their order, and what they print."""

import contextlib
import io
import re

import pytest
from conftest import ROOT

pytest.importorskip("xarray")


def blocks(page):
    """Language, text and line of each block."""
    text = page.read_text("utf-8")
    for match in re.finditer(r"^```(\w*)\n(.*?)^```$", text, re.S | re.M):
        yield match[1], match[2], text[: match.start()].count("\n") + 2


@pytest.mark.parametrize(("name", "least"), [("python.md", 6), ("materials.md", 1)])
def test_the_page_does_what_it_says(here, name, least):
    page = ROOT / "docs" / name
    names, printed, ran = {}, None, 0
    for language, text, line in blocks(page):
        if language == "python":
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                exec(compile("\n" * (line - 1) + text, str(page), "exec"), names)
            printed, ran = output.getvalue(), ran + 1
        elif language == "text":
            assert printed == text, f"what the block above line {line} prints"
    assert ran == sum(language == "python" for language, _, _ in blocks(page)) >= least
