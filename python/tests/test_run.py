"""Runs: the same bits as the command line, observers, interruption, errors."""

import csv
import json
import os
import signal
import subprocess
import sys
import threading
import time

import pytest

import fretwork
from fretwork import Case, Column, InputError, Observer, RunError, Stop


def command(*words):
    """The command line in a process of its own."""
    return subprocess.run([sys.executable, "-m", "fretwork", *words], capture_output=True, text=True, check=False)


def rows(folder):
    with open(folder / "statistics.csv", newline="") as file:
        return list(csv.DictReader(file))


def test_a_run_has_the_bits_of_the_command_line(shear, here):
    results = shear.run("results/python", progress=False)
    again = shear.run("results/threads", progress=False, threads=2)
    sets = ["time.end=0.01", "output.frames=0", "output.figures=false"]
    sets = [word for text in sets for word in ("--set", text)]
    done = command("run", "cases/plane_shear.ron", "--out", "results/command", *sets)
    assert done.returncode == 0, done.stderr
    # The program itself, where it is built.
    program = os.environ.get("FRETWORK_PROGRAM")
    if program:
        subprocess.run(
            [program, "run", "cases/plane_shear.ron", "--out", "results/program", *sets],
            check=True,
            capture_output=True,
        )
        result = (here / "results/program/statistics.csv").read_bytes()
        assert result == (here / "results/python/statistics.csv").read_bytes()
    bytes_of = [(here / "results" / n / "statistics.csv").read_bytes() for n in ("python", "threads", "command")]
    assert bytes_of[0] == bytes_of[1] == bytes_of[2]
    other = json.loads((here / "results/command/summary.json").read_text())
    assert results.summary["identity"] == again.summary["identity"] == other["identity"]
    # The file with the built-in laws, not the interpreter, is what identifies them.
    assert results.summary["plugins"] == other["plugins"]
    assert "_fretwork" in results.summary["plugins"][0]["path"]
    assert results.summary["plugins"][0]["certified"]


def test_a_run_of_a_case_of_python(slider, here):
    results = slider.run(progress=False)
    assert results.folder == here.__class__("results/case")
    force = float(rows(results.folder)[-1]["slider_fx [N/m]"])
    assert force == pytest.approx(-30.0, rel=1e-6)


def test_progress_is_told(slider, here):
    slider["time.end"] = 0.5
    result = []
    slider.run(progress=result.append)
    assert result[-1].step == result[-1].steps == 5000
    assert [p.step for p in result] == sorted({p.step for p in result})
    assert "contacts" in result[-1].text()


def test_an_exception_of_progress_ends_the_run(shear, here):
    shear["time.end"] = 3.0

    def fail(now):
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        shear.run("results/a", progress=fail)
    assert fretwork.Results("results/a").summary["interrupted"]


def interrupt_soon(seconds=0.3):
    def interrupt():
        time.sleep(seconds)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt, daemon=True).start()


def test_ctrl_c_leaves_files_from_which_the_run_goes_on(shear, here):
    shear["time.end"] = 0.1
    shear["output.figures"] = True
    whole = shear.run("results/whole", progress=False)
    seen = []

    def interrupt(sim):
        seen.append(sim.steps)
        if sim.steps == 100:
            os.kill(os.getpid(), signal.SIGINT)
        if sim.steps > 100:
            time.sleep(0.02)

    with pytest.raises(KeyboardInterrupt):
        shear.run("results/part", progress=False, observers=[interrupt])
    part = fretwork.Results("results/part")
    assert part.summary["interrupted"] and 100 <= part.summary["steps"] < 500
    assert "KeyboardInterrupt" in part.summary["stopped"]
    # Who presses Ctrl-C does not wait for figures.
    figures = {file.name for file in whole.folder.glob("*.png")}
    assert figures and not list(part.folder.glob("*.png"))
    with pytest.raises(InputError, match="resume=True|another case"):
        other = shear.copy()
        other.seed = 4
        other.run("results/part", resume=True, progress=False)

    seen.clear()
    on = shear.run("results/part", resume=True, progress=False, observers=[interrupt])
    assert seen and min(seen) > 100
    assert on.summary["steps"] == 500 and on.summary["stopped"] is None
    assert (part.folder / "statistics.csv").read_bytes() == (whole.folder / "statistics.csv").read_bytes()
    assert {file.name for file in on.folder.glob("*.png")} == figures
    # A finished run is left as it is.
    before = os.stat(on.folder / "results.h5").st_mtime_ns
    shear.run("results/part", resume=True, progress=False, observers=[interrupt])
    assert os.stat(on.folder / "results.h5").st_mtime_ns == before


class Top(Observer):
    """The highest grain, and how often it looked."""

    name = "top"
    every = 5
    columns = [Column("top", "m", "height of the highest grain"), "looks"]

    def __init__(self):
        self.looks = 0
        self.stop_at = None

    def step(self, sim):
        self.looks += 1
        values = {"top": sim.grains.position[:, 1].max(), "looks": self.looks}
        if self.stop_at is not None and sim.steps >= self.stop_at:
            return values, Stop("high enough")
        return values

    def save(self):
        return {"looks": self.looks}

    def restore(self, saved):
        self.looks = saved["looks"]


def test_an_observer_adds_columns_and_stops(shear, here):
    whole = shear.run("results/whole", progress=False, observers=[Top()])
    table = rows(whole.folder)
    assert [float(row["looks"]) for row in table] == list(range(1, 11))
    assert 0.2 < float(table[-1]["top [m]"]) < 0.3
    plain = rows(shear.run("results/plain", progress=False).folder)
    assert [{k: row[k] for k in plain[0]} for row in table] == plain

    top = Top()
    top.stop_at = 25
    part = shear.run("results/part", progress=False, observers=[top])
    assert part.summary["steps"] == 25
    assert part.summary["stopped"].startswith("high enough")
    shear.run("results/part", progress=False, resume=True, observers=[Top()])
    assert (part.folder / "statistics.csv").read_bytes() == (whole.folder / "statistics.csv").read_bytes()


def test_an_exception_of_an_observer_goes_on_to_the_caller(shear, here):
    kept = []

    def fail(sim):
        kept.append(sim)
        if sim.steps == 10:
            raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        shear.run("results/a", progress=False, observers=[fail])
    results = fretwork.Results("results/a")
    assert results.summary["steps"] == 10 and "LookupError" in results.summary["stopped"]
    assert len(kept) == 10
    with pytest.raises(RuntimeError, match="during the call only"):
        kept[0].time


def test_an_observer_gets_copies_that_last(shear, here):
    kept = []

    def look(sim):
        kept.append((sim.time, sim.grains.velocity, sim.contacts.force_normal, sim.first_bodies["top"].position))
        with pytest.raises(RuntimeError, match="cannot step"):
            sim.step()

    shear.run("results/a", progress=False, observers=[look])
    sim = shear.simulation()
    for time_, velocity, force, top in kept:
        sim.step()
        assert sim.time == time_
        assert (sim.grains.velocity == velocity).all() and (sim.contacts.force_normal == force).all()
        assert (sim.first_bodies["top"].position == top).all()


def test_wrong_values_of_an_observer_are_an_error(shear, here):
    class Wrong(Observer):
        columns = ["a"]

        def step(self, sim):
            return {"b": 1.0}

    with pytest.raises(ValueError, match="Wrong returned values of \\['b'\\]"):
        shear.run("results/a", progress=False, observers=[Wrong()])
    with pytest.raises(InputError, match="no observer"):
        shear.run("results/a", progress=False, observers=[3])
    Wrong.columns = ["time"]
    with pytest.raises(RunError, match="two columns of statistics.csv are named `time`"):
        shear.run("results/a", progress=False, observers=[Wrong()])


def test_errors_of_runs(shear, here):
    (here / "file").write_text("")
    with pytest.raises(RunError, match="cannot write") as raised:
        shear.run("file/results", progress=False)
    assert raised.value.out == here.__class__("file/results")
    with pytest.raises(InputError, match="threads=0"):
        shear.run("results/a", threads=0)
    with pytest.raises(InputError, match="no such folder"):
        shear.run("results/a", plugin_path=["nowhere"])
    with pytest.raises(InputError, match="no results"):
        fretwork.Results("nowhere")
    shear["materials.glass"] = "glas_bead"
    with pytest.raises(InputError) as raised:
        shear.run("results/b", progress=False)
    assert raised.value.line and "glass_bead" in raised.value.proposal
    assert not (here / "results" / "b").exists()


def test_a_failing_step_says_where(slider, here):
    slider["bodies.slider.dofs.y"] = {"Force": 1e308}
    with pytest.raises(RunError, match="step 1") as raised:
        slider.run("results/a", progress=False)
    assert raised.value.out.name == "a"
    assert fretwork.Results("results/a").summary["stopped"]
