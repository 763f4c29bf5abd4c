"""Results as tables, arrays and meshes."""

import sys

import numpy as np
import pytest

from fretwork import InputError, MissingPackageError, Results


@pytest.fixture
def results(shear, here):
    return shear.run("results/a", progress=False)


def test_the_table_has_units_and_the_bits_of_the_file(results):
    table = results.statistics
    assert table.attrs["units"]["kinetic"] == "J/m" and table.attrs["units"]["step"] == "1"
    assert table.attrs["long_name"]["time"] == "time at its end"
    assert set(table.attrs["long_name"]) == set(table.columns)
    with open(results.folder / "statistics.csv") as file:
        lines = file.read().splitlines()
    assert [repr(float(x)) for x in lines[-1].split(",")] == [repr(float(x)) for x in table.iloc[-1]]
    with results.open() as file:
        assert (file["statistics/residual"][:] == table["residual"]).all()


def test_fields_over_time_have_units(results):
    grains = results.grains
    assert grains.position.dims == ("time", "grain", "axis")
    assert grains.velocity_x.attrs == {"units": "m/s", "long_name": "velocity"}
    assert grains.velocity.dims == ("time", "grain", "axis") and (grains.velocity.sel(axis="x") == grains.velocity_x).all()
    assert grains.time.attrs["units"] == "s" and grains.sizes["grain"] == 550
    assert grains.time.values.tolist() == results.times
    contacts = results.contacts
    assert contacts.force_normal.attrs["units"] == "N/m" and contacts.body_1.dtype == np.int64
    last = contacts.sel(contact=contacts.record == contacts.record.max())
    assert (last.time == results.times[-1]).all() and last.sizes["contact"] > 100
    bodies = results.bodies
    assert bodies.body.values.tolist() == ["bottom", "top"] and bodies.sizes["axis"] == 2
    table = results.statistics
    top = bodies.sel(body="top", axis="y")
    assert (top.force.values == table["top_fy"]).all() and (top.position.values == table["top_y"]).all()
    assert bodies.force.attrs["units"] == "N/m"


def test_tables_of_events_have_units(results, tmp_path):
    assert results.events == {}
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "results.h5", "w") as file:
        file.attrs.update({"case": "pieces", "units": "SI"})
        columns = {"time": ([0.1, 0.2], "s", "when"), "size": ([2.0, 1.0], "1", "grains in it"), "grains": ([7.0, 8.0, 9.0], "1", "which")}
        for name, (values, unit, doc) in columns.items():
            data = file.create_dataset(f"events/debris/{name}", data=values)
            data.attrs.update({"unit": unit, "doc": doc})
        file["events/debris"].attrs["list"] = "grains"
    events = Results(tmp_path).events
    assert list(events) == ["debris"]
    debris = events["debris"]
    assert debris.time.dims == ("event",) and debris.time.values.tolist() == [0.1, 0.2]
    assert debris.time.attrs == {"units": "s", "long_name": "when"}
    assert debris.grains.dims == ("grains_value",) and debris.grains.values.tolist() == [7.0, 8.0, 9.0]


def test_the_summary_and_the_case(results, shear):
    assert results.summary["steps"] == 50 and results.case == shear.text
    assert results.trustworthy == results.summary["trustworthy"] and isinstance(results.warnings, list)
    friction = results.quantities["energy.friction"]
    assert friction["unit"] in ("J", "J/m") and friction["doc"] and friction["role"] in ("secondary", "detail")
    (results.folder / "summary.json").unlink()
    with pytest.raises(InputError, match="end of a run"):
        results.summary


def test_packages_that_are_missing_are_named(results, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(MissingPackageError, match="pandas: pip install 'pyfretwork\\[results\\]'"):
        results.statistics
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match="pyfretwork\\[mesh\\]"):
        results.mesh()


def test_meshes_have_points_cells_and_fields(results):
    pytest.importorskip("pyvista")
    mesh = results.mesh()
    grains = results.grains.isel(time=-1)
    assert (mesh.points == grains.position.values).all() and (mesh["radius"] == grains.radius.values).all()
    contacts = results.mesh(view="contacts", state=0)
    assert contacts.n_lines == contacts.n_cells == len(contacts["gap"])
    with pytest.raises(IndexError):
        results.mesh(100)
    with pytest.raises(InputError, match="grains"):
        results.mesh(view="grans")


def test_a_run_that_goes_on_can_be_read(shear, here):
    seen = []

    def look(sim):
        if sim.steps == 40:
            seen.append(Results("results/b").times)

    shear["output.views"] = 10
    shear["output.checkpoint"] = {"Steps": 10} if "Steps" in shear.kinds("output.checkpoint") else "Never"
    shear.run("results/b", progress=False, observers=[look])
    assert seen and seen[0][0] == 0.0


def shapes_are_the_grains(results):
    """The cells of the shapes are the points of the grains, with their fields, about their places, and of their size in the plane."""
    for state in (0, -1):
        shapes, grains = results.mesh(state, view="shapes"), results.mesh(state)
        assert shapes.n_cells == grains.n_points
        assert set(shapes.cell_data) == set(grains.point_data)
        assert all(np.array_equal(shapes[name], grains[name], equal_nan=True) for name in grains.point_data)
        assert abs(shapes.cell_centers().points - grains.points).max() < 1e-6 * grains["radius"].min()
        # A disk is a polygon of 16 corners.
        area = shapes.compute_cell_sizes(length=False, volume=False)["Area"]
        np.testing.assert_allclose(area, 8.0 * np.sin(np.pi / 8.0) * grains["radius"] ** 2, rtol=1e-9)


def test_shapes_are_the_grains(results):
    pytest.importorskip("pyvista")
    assert "shapes" in results.views
    shapes_are_the_grains(results)
