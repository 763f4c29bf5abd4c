"""The gallery is made from the shipped cases as they are, and has all of them."""

from __future__ import annotations

import importlib.util
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]


def test_the_gallery_is_that_of_the_cases() -> None:
    spec = importlib.util.spec_from_file_location("gallery", PROJECT / "docs/gallery.py")
    assert spec is not None and spec.loader is not None
    gallery = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(gallery)
    listed = [name for cases in gallery.GALLERY.values() for name in cases]
    assert sorted(listed) == sorted(path.stem for path in (PROJECT / "cases").glob("*.ron"))
    again = "python3 docs/gallery.py"
    assert (PROJECT / "docs/gallery.md").read_text(encoding="utf-8") == gallery.page(gallery.read_times()), again
    missing = [name for name in listed if not gallery.of_case(name, "name") or not gallery.of_case(name, "doc")]
    assert not missing
