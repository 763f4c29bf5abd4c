"""Figures of results, and what a notebook shows of them."""

from __future__ import annotations

import json

import pytest

pytest.importorskip("matplotlib")

from fretwork import InputError, Progress, Results
from fretwork._plot import LivePlot, chosen, described, scaled
from fretwork._progress import Silent


@pytest.fixture
def results(shear, here):
    return shear.run("results/a", progress=False)


def test_a_figure_has_the_columns_with_meaning_and_unit(results):
    table = results.statistics
    (panel,) = results.plot("kinetic").axes
    assert panel.get_xlabel() == "time (ms)" and panel.get_ylabel().startswith("kinetic energy (")
    (line,) = panel.lines
    factor, _ = scaled(table["kinetic"], "J/m")
    assert (line.get_xdata() == table["time"] * 1e3).all() and (line.get_ydata() == table["kinetic"] * factor).all()
    (panel,) = results.plot("friction", against="kinetic").axes
    assert panel.get_xlabel().startswith("kinetic energy (")


def test_a_notebook_shows_a_figure_without_pyplot(results):
    from io import BytesIO

    image = pytest.importorskip("PIL.Image")
    figure = results.plot("kinetic")
    shown = image.open(BytesIO(figure._repr_png_()))
    assert shown.size == tuple((figure.get_size_inches() * figure.dpi).astype(int))
    assert len(shown.convert("L").getcolors()) > 10


def test_a_wrong_column_is_named(results):
    with pytest.raises(InputError, match="no column `kinetics`"):
        results.plot("kinetics")


def test_columns_of_the_figures_of_the_run_are_shown(results):
    table = results.statistics

    def figure(leads, *pairs, over=None):
        axis = lambda name: {"column": name, "over": over}  # noqa: E731
        return {"leads": leads, "charts": [{"series": [{"source": {"Rows": {"x": axis(x), "y": axis(y)}}}]} for x, y in pairs]}

    figures = [
        figure(False, ("time", "kinetic"), ("time", "not there")),
        figure(True, ("kinetic", "friction")),
        figure(True, ("time", "friction"), over="kinetic"),
        {"leads": True, "charts": [{"series": [{"source": "Points"}]}, {"series": []}]},
    ]
    assert chosen(table, figures) == [("kinetic", "friction"), ("time", "kinetic")]
    assert chosen(table, []) == [("time", "contacts")]
    written = chosen(table, described(results.folder))
    assert 1 <= len(written) <= 3 and len(results.plot().axes) == len(written)


@pytest.mark.parametrize(
    ("largest", "unit", "shown"),
    [(5e-6, "m", (1e6, "µm")), (2.2e5, "N/m", (1e-3, "kN/m")), (0.0, "J", (1.0, "J")), (3.0, "1", (1.0, "")), (1e-13, "m^3", (1.0, "m^3")), (300.0, "K", (1.0, "K"))],
)
def test_units_have_numbers_of_a_few_digits(largest, unit, shown):
    import numpy as np

    factor, name = scaled(np.array([-largest, 0.0]), unit)
    assert name == shown[1] and factor == pytest.approx(shown[0])


def test_a_notebook_shows_grade_results_and_warnings(results):
    path = results.folder / "summary.json"
    shown = results._repr_html_()
    assert results.grade in shown and str(results.folder) in shown
    summary = json.loads(path.read_text(encoding="utf-8"))
    summary["warnings"] = ["A <b>bold</b> name"]
    path.write_text(json.dumps(summary), encoding="utf-8")
    assert "<li>A &lt;b&gt;bold&lt;/b&gt; name</li>" in results._repr_html_()
    path.unlink()
    assert "goes on" in results._repr_html_()


def test_the_figure_of_a_run_is_drawn_again_while_it_goes_on(results, monkeypatch):
    display = pytest.importorskip("IPython.display")
    shown = []

    class Handle:
        def update(self, figure):
            shown.append(len(figure.axes[0].lines[0].get_xdata()))

    def first(figure, display_id):
        Handle().update(figure)
        return Handle()

    monkeypatch.setattr(display, "display", first)
    monkeypatch.setattr(LivePlot, "EVERY", 0.0)
    monkeypatch.setattr(LivePlot, "SHARE", 0.0)
    tables = iter([results.statistics.iloc[:1], results.statistics.iloc[:10], results.statistics])
    live = LivePlot(Silent(), results.folder, lambda: next(tables))
    now = Progress(1, 2, 0, 0, 0, 0, 0, 0.0, 0, 0.0)
    for _ in range(2):
        live.show(now)
    live.close()
    assert shown == [10, len(results.statistics)]
    assert isinstance(results, Results)
