"""Reports of runs, and runs side by side."""

import warnings

import pytest

import fretwork
from fretwork import InputError


def test_a_run_has_a_report_unless_told_otherwise(shear, here):
    shear.run("results/with", progress=False)
    page = (here / "results/with/report.html").read_text(encoding="utf-8")
    assert shear.name in page and "default-src" in page
    results = shear.run("results/without", progress=False, report=False)
    assert not (results.folder / "report.html").exists()
    path = fretwork.report(results.folder, full=True)
    assert path == results.folder / "report.html" and path.is_file()


def test_runs_are_put_side_by_side(shear, here):
    folders = []
    for seed in (1, 2):
        shear["seed"] = seed
        folders.append(shear.run(f"results/seed_{seed}", progress=False, report=False).folder)
    path = fretwork.compare(folders, "both.html")
    page = path.read_text(encoding="utf-8")
    assert "seed_1" in page and "seed_2" in page


@pytest.fixture
def rubbed(slider):
    """The slider, moved to and fro with a friction test; it has loops."""
    slider["bodies.slider.dofs.x"] = {"Displacement": {"Sine": {"amplitude": 1e-3, "frequency": 40}}}
    slider["friction"] = {"body": "slider", "along": 0, "normal": 1}
    slider["output.figures"] = True
    return slider


def test_measured_curves_are_drawn_beside_the_run(rubbed, here):
    folder = rubbed.run("results/rubbed", progress=False, report=False).folder
    table = here / "loop.csv"
    table.write_bytes("Weg (\u00b5m);Kraft (N)\n-1000,0;-3\n1000,0;3\n".encode("latin-1"))
    columns = {"delta": "Weg (um)", "Q": "Kraft (N)"}
    path = fretwork.report(folder, measured=table, columns=columns, depth="100 mm")
    assert "measured: loop.csv" in path.read_text(encoding="utf-8")
    assert (folder / "fretting_loops_measured.png").is_file()
    other = rubbed.run("results/other", progress=False, report=False).folder
    both = fretwork.compare([folder, other], "both.html", measured=[table], columns=columns, depth=0.1)
    assert "measured: loop.csv" in both.read_text(encoding="utf-8")
    with pytest.raises(InputError, match="depth"):
        fretwork.report(folder, measured=table, columns=columns)
    with pytest.raises(InputError, match="above zero"):
        fretwork.report(folder, measured=table, columns=columns, depth=0)
    with pytest.raises(InputError, match="give measured"):
        fretwork.report(folder, depth=0.1)


def test_what_is_no_run_is_refused(here):
    (here / "empty").mkdir()
    with pytest.raises(InputError, match="empty"):
        fretwork.report("empty")
    with pytest.raises(InputError, match="0.5 to 2000"):
        fretwork.report("empty", size=0.0)
    with pytest.raises(InputError, match="two or more"):
        fretwork.compare(["empty"])


def test_a_report_that_cannot_be_written_leaves_the_run_as_it_is(shear, here):
    (here / "results/blocked/report.html/in_the_way").mkdir(parents=True)
    with warnings.catch_warnings(record=True) as result:
        warnings.simplefilter("always")
        results = shear.run("results/blocked", progress=False)
    assert results.summary["steps"] > 0
    assert any("there is no report" in str(w.message) for w in result)
