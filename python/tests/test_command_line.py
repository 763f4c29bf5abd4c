"""The command line, called in a process of Python."""

import os
import subprocess
import sys

import pytest

import fretwork


def call(*words, **more):
    return subprocess.run(
        [sys.executable, "-m", "fretwork", *words], capture_output=True, text=True, check=False, **more
    )


def test_the_console_script_is_the_command_line():
    script = os.path.join(os.path.dirname(sys.executable), "fretwork")
    result = subprocess.run([script, "--version"], capture_output=True, text=True, check=True).stdout
    assert result == call("--version").stdout == f"fretwork {fretwork.__version__}\n"


def test_exit_codes_and_streams(here):
    assert "coulomb" in call("law", "list").stdout
    wrong = call("check", "cases/plane_shear.ron", "--set", "time.stp=1")
    assert wrong.returncode == 2 and "did you mean `step`" in wrong.stderr and not wrong.stdout
    assert call("run", "cases/plane_shear.ron", "--no-such-option").returncode == 2
    assert call().returncode == 2


def test_check_says_the_same_as_in_python(here):
    result = call("check", "cases/plane_shear.ron", "--no-timing", "--verbose").stdout
    case = fretwork.Case.load("cases/plane_shear.ron")
    # The command names an option of its own at the end.
    lines, _, last = result.rstrip("\n").rpartition("\n")
    assert last.split()[0] == "inputs"
    assert lines == str(case.check(timing=False))


def test_ctrl_c_ends_the_command_line_with_its_own_words(here):
    run = subprocess.Popen(
        [sys.executable, "-m", "fretwork", "run", "cases/plane_shear.ron", "--set", "output.figures=false"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    while not (here / "results" / "plane_shear" / "results.h5").exists():
        assert run.poll() is None
    run.send_signal(2)
    _, said = run.communicate(timeout=60)
    assert run.returncode == 1
    assert "interrupted by SIGINT (Ctrl-C)" in said
    assert "fretwork run cases/plane_shear.ron --set output.figures=false --resume" in said


@pytest.mark.parametrize("kind", ["contact", "damage"])
def test_shipped_laws_are_certified(kind):
    name = {"contact": "coulomb", "damage": "mac"}[kind]
    done = call("law", "certify", f"{kind}/{name}")
    assert done.returncode == 0, done.stdout + done.stderr
