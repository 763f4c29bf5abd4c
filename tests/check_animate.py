#!/usr/bin/env python3
"""What docs/animate.py writes, read back.

    pip install pytest pillow "imageio[ffmpeg]"
    python3 -m pytest tests/check_animate.py
"""
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

SCRIPT = Path(__file__).parent.parent / "docs" / "animate.py"
COLOURS = [(200, 0, 0), (0, 160, 0), (0, 0, 200)]


def animate(*words):
    return subprocess.run([sys.executable, SCRIPT, *map(str, words)], capture_output=True, text=True)


@pytest.fixture
def run(tmp_path):
    """A run with three pictures, the first one lower, and others that are not of the kind; steps beyond eight digits sort as numbers."""
    folder = tmp_path / "frames"
    folder.mkdir()
    for step, colour, height in zip(("00000000", "00000200", "100000000"), COLOURS, (40, 61, 61)):
        Image.new("RGB", (101, height), colour).save(folder / f"frame_{step}.png")
    Image.new("RGB", (9, 9)).save(folder / "frame_first.png")
    Image.new("RGB", (9, 9)).save(folder / "chains_00000000.png")
    return tmp_path


@pytest.mark.parametrize("suffix", ["webp", "png"])
def test_pixels_are_kept_in_the_order_of_steps(run, suffix):
    out = run / f"a.{suffix}"
    done = animate(run, out, "--rate", "5")
    assert done.returncode == 0, done.stderr
    with Image.open(out) as film:
        assert film.n_frames == 3 and film.size == (101, 61)
        for k, colour in enumerate(COLOURS):
            film.seek(k)
            film.load()
            page = film.convert("RGB")
            assert page.getpixel((50, 30)) == colour
            # The first picture is lower: above and below it is white.
            assert page.getpixel((50, 2)) == ((255, 255, 255) if k == 0 else colour)
            assert film.info["duration"] == 200


def test_smaller_pictures_have_their_width(run):
    out = run / "a.webp"
    done = animate(run, out, "--width", "50")
    assert done.returncode == 0, done.stderr
    with Image.open(out) as film:
        assert film.n_frames == 3 and film.size == (50, 30)
        film.seek(2)
        page = film.convert("RGB")
        assert max(abs(a - b) for a, b in zip(page.getpixel((25, 15)), COLOURS[2])) < 12
    refused = animate(run, out, "--width", "0")
    assert refused.returncode == 1 and "--width" in refused.stderr


def test_a_video_has_all_pictures(run):
    imageio = pytest.importorskip("imageio.v3")
    out = run / "a.mp4"
    done = animate(run, out)
    assert done.returncode == 0, done.stderr
    film = imageio.imread(out)
    assert film.shape == (3, 62, 102, 3)
    for page, colour in zip(film, COLOURS):
        assert abs(page[31, 51].astype(int) - colour).max() < 12
    assert imageio.immeta(out)["codec"] == "h264" and imageio.immeta(out)["fps"] == 4.0
    assert "yuv420p" in imageio.immeta(out)["pix_fmt"]


def test_what_is_wrong_is_said(run):
    for words, said in (
        ([run, run / "a.avi"], "ends in .webp"),
        ([run, run / "a.webp", "--pictures", "stress"], "output.frames"),
        ([run / "none", run / "a.webp"], "0 pictures"),
        ([run, run / "a.webp", "--rate", "0"], "above 0"),
    ):
        done = animate(*words)
        assert done.returncode == 1 and said in done.stderr and "Traceback" not in done.stderr, done.stderr
