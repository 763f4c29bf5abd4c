"""Tables of studies, made by the command line of the package."""

import json
import subprocess
import sys

import numpy as np
import pytest

from fretwork import InputError, MissingPackageError, read_study

STUDY = """(
    case: "slider.ron",
    factors: [
        Values(name: "mu", key: "interfaces.dry.parameters.contact.mu", values: [0.2, 0.4]),
        Options(name: "load", options: [(name: "none"), (name: "twice", set: ["bodies.slider.dofs.y=Force(Constant(-200.0))"])]),
    ],
    seeds: 2,
    outputs: ["energy.friction"],
)"""


@pytest.fixture
def folder(slider, here):
    slider.save("slider.ron")
    (here / "slide.ron").write_text(STUDY)
    subprocess.run([sys.executable, "-m", "fretwork", "study", "run", "slide.ron"], check=True, capture_output=True)
    return here / "results" / "study" / "slide"


def test_a_row_is_a_run_with_units(folder):
    table = read_study(folder)
    assert table.attrs["units"]["energy.friction"] == "J/m" and table.attrs["units"]["mu"] == "1"
    assert list(table.attrs["units"]) == list(table.columns)
    assert table["mu"].tolist() == [0.2] * 4 + [0.4] * 4
    # A word that other readers take for nothing.
    assert table["load"].tolist() == ["none", "none", "twice", "twice"] * 2
    assert table["point"].dtype == np.int64 and table["steps"].tolist() == [500] * 8
    assert (table["status"] == "done").all() and table["reason"].isna().all()
    assert table["folder"].map(len).eq(24).all()
    for _, row in table.iterrows():
        summary = json.loads((folder / "runs" / row["folder"] / "summary.json").read_text())
        assert summary["energy"]["friction"] == row["energy.friction"] and summary["identity"] == row["identity"]
    # Coulomb: the force mu N over 5 mm.
    load = table["load"].map({"none": 100.0, "twice": 200.0})
    assert np.allclose(table["energy.friction"], table["mu"] * load * 5e-3, rtol=1e-6)


def test_a_row_is_a_setting(folder):
    table, means = read_study(folder), read_study(folder, settings=True)
    assert means["setting"].tolist() == [1, 2, 3, 4] and means["energy.friction_runs"].tolist() == [2] * 4
    own = table.groupby("setting")["energy.friction"].agg(["mean", "std"])
    assert np.allclose(means["energy.friction"], own["mean"], rtol=1e-12)
    assert np.allclose(means["energy.friction_scatter"], own["std"], rtol=1e-9, atol=1e-15)
    assert means.attrs["units"]["energy.friction_half_width"] == "J/m"


def test_what_is_missing_is_named(folder, here, monkeypatch):
    with pytest.raises(InputError, match="study/slider/table.csv: .*fretwork study run"):
        read_study("results/study/slider")
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(MissingPackageError, match="pandas: pip install 'pyfretwork\\[results\\]'"):
        read_study(folder)
