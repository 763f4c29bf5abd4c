#!/usr/bin/env python3
"""Runs the notebooks, and saves them with their outputs.

    pip install './python[notebooks]'
    python3 python/notebooks/run.py [NAME ...]

Each runs in an empty folder, as somebody with the installed package would run it. Outputs that differ
from run to run (times, memory addresses, progress bars) are not saved.
"""

from __future__ import annotations

import base64
import re
import sys
import tempfile
from pathlib import Path
from typing import Any

import nbclient
import nbformat

FOLDER = Path(__file__).resolve().parent
ADDRESS = re.compile(r" \(0x[0-9a-f]+\)")
UNPACKED = re.compile(r"[^\s:]*/fretwork/[0-9.]+-[0-9a-f]{16}/")
"""The folder of a user in which shipped cases are."""
WIDGET = "application/vnd.jupyter.widget-view+json"
LARGEST = 250_000
"""Largest notebook with its outputs (bytes)."""


def execute(notebook: Any, folder: Path) -> None:
    """Runs all cells in a folder; raises what a cell raises."""
    client = nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(folder)}})
    # The client's own handler of output widgets sends on the socket on which it waits for answers,
    # and now and then one is lost (nbclient, issue 312). Nothing here needs it.
    client.comm_open_handlers["jupyter.widget"] = lambda message: None
    client.execute()


def clean(notebook: Any) -> None:
    """Leaves of the outputs what a reader sees and what is the same in each run."""
    notebook.metadata.pop("widgets", None)
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)
        if cell.cell_type != "code":
            continue
        cell.outputs = [output for output in cell.outputs if seen(output)]
        for output in cell.outputs:
            data = output.get("data", {})
            if "image/png" in data:
                output.data = type(data)({"image/png": smaller(data["image/png"])})
            elif "text" in output:
                output.text = UNPACKED.sub("", ADDRESS.sub("", output.text))


def seen(output: Any) -> bool:
    """Whether a reader of the saved notebook has something of an output: not of progress, of widgets, and of what they return."""
    data = output.get("data", {})
    returned = output.output_type == "display_data" and list(data) == ["text/plain"]
    return output.get("name") != "stderr" and WIDGET not in data and not returned


def smaller(text: str) -> str:
    """The picture with a palette of colours."""
    from io import BytesIO

    from PIL import Image

    image = Image.open(BytesIO(base64.b64decode(text))).convert("RGB")
    out = BytesIO()
    image.quantize(64).save(out, "PNG", optimize=True)
    return base64.b64encode(out.getvalue()).decode() + "\n"


def main() -> None:
    names = sys.argv[1:] or sorted(path.stem for path in FOLDER.glob("*.ipynb"))
    for name in names:
        path = FOLDER / f"{name}.ipynb"
        notebook = nbformat.read(path, as_version=4)
        with tempfile.TemporaryDirectory() as folder:
            execute(notebook, Path(folder))
        clean(notebook)
        text = nbformat.writes(notebook) + "\n"
        if len(text) > LARGEST:
            sys.exit(f"{path.name} has {len(text)} bytes, more than {LARGEST}: draw less, or smaller pictures")
        path.write_text(text, encoding="utf-8")
        print(f"{path.name}: {len(text) / 1000:.0f} kB", flush=True)


if __name__ == "__main__":
    main()
