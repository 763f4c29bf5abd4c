"""The notebooks run from beginning to end, each in an empty folder, and are kept with the outputs that they have."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")

FOLDER = Path(__file__).resolve().parents[1] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
sys.path.insert(0, str(FOLDER))
from run import LARGEST, clean, execute  # noqa: E402


def test_there_are_notebooks() -> None:
    assert len(NOTEBOOKS) >= 6


def kinds(notebook: Any) -> list[list[str]]:
    """What the outputs of each cell are: streams, and data by their kinds."""
    return [
        [" ".join(sorted(output.get("data", {})) or [output.output_type]) for output in cell.get("outputs", [])]
        for cell in notebook.cells
    ]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook(path: Path, tmp_path: Path) -> None:
    saved = nbformat.read(path, as_version=4)
    assert path.stat().st_size <= LARGEST
    notebook = nbformat.read(path, as_version=4)
    execute(notebook, tmp_path)
    clean(notebook)
    again = "the outputs are not those of the cells: python3 python/notebooks/run.py"
    assert kinds(saved) == kinds(notebook), again
    assert any("image/png" in kind for outputs in kinds(saved) for kind in outputs), "a notebook shows a picture"
