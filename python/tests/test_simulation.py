"""Simulations that are stepped by hand."""

import gc
import os
import signal
import threading
import time

import numpy as np
import pytest

from fretwork import InputError, RunError


def test_steps_are_those_of_a_run(shear, here):
    results = shear.run("results/a", progress=False)
    sim = shear.simulation(threads=2)
    assert (sim.time, sim.steps, sim.dimension) == (0.0, 0, 2)
    # Rows every five steps, as in the run: some columns are means since the row before.
    sim.step(45)
    assert sim.statistics["time"] == pytest.approx(0.009)
    report = sim.step(5)
    assert sim.steps == 50 and sim.time == pytest.approx(0.01) and report.converged
    row = results.statistics.iloc[-1]
    np.testing.assert_equal(sim.statistics, row.to_dict())
    np.testing.assert_equal(sim.statistics, row.to_dict())
    grains = results.grains.isel(time=-1)
    assert (grains.position[:, :2] == sim.parts.position).all()
    for name in set(grains.data_vars) - {"position"}:
        assert (grains[name] == sim.parts[name]).all(), name
    contacts = results.contacts
    contacts = contacts.sel(contact=contacts.record == contacts.record.max())
    for name in set(contacts.data_vars) - {"ends"}:
        assert (contacts[name] == sim.contacts[name]).all(), name
    assert sim.energy["friction"] == row["friction"]


def test_columns_are_views_that_keep_their_numbers(shear):
    sim = shear.simulation()
    sim.step(5)
    a, b = sim.grains.position, sim.bodies.position
    assert np.shares_memory(a, b) and a.shape == (500, 2) and b.shape == (502, 2)
    assert not a.flags.writeable and not a.flags.owndata
    with pytest.raises(ValueError, match="read-only"):
        a[0, 0] = 1.0
    before = a.copy()
    half = sim.grains.velocity[::2, 1]
    kept = half.copy()
    sim.step(200)
    now = sim.grains.position
    assert (a == before).all() and (half == kept).all()
    assert not np.shares_memory(a, now) and (now != before).any()
    # What nobody holds is shown again from the same memory.
    where = sim.grains.mass.__array_interface__["data"]
    sim.step()
    assert sim.grains.mass.__array_interface__["data"] == where
    spin = sim.grains.spin
    del sim
    gc.collect()
    np.ones(100_000)
    assert np.isfinite(spin).all() and (a == before).all()
    assert spin.shape == (500,)


def test_columns_have_names_units_and_explanations(shear):
    sim = shear.simulation()
    assert sim.contacts.fields()["gap"].unit == "m"
    assert "gap" in dir(sim.contacts) and "velocity_x" in dir(sim.parts) and "position" in dir(sim.grains)
    assert sim.statistics_fields()["kinetic"].unit == "J/m"
    with pytest.raises(KeyError, match="there are id, position"):
        sim.grains["radius"]
    with pytest.raises(AttributeError, match="force_normal"):
        _ = sim.contacts.force_norml


def test_vectors_are_columns_of_three(shear):
    sim = shear.simulation()
    sim.step(5)
    parts, contacts = sim.parts, sim.contacts
    assert parts.velocity.shape == (len(parts), 3) and contacts.normal.shape == (len(contacts), 3)
    assert (parts.velocity[:, 0] == parts.velocity_x).all() and (parts.velocity[:, 2] == 0.0).all()
    np.testing.assert_allclose(np.linalg.norm(contacts.normal, axis=1), 1.0, rtol=1e-14)
    assert len(sim.parts) == 550 and len(sim.grains) == 500 and len(sim.contacts) > 0


def test_the_slider_has_the_force_of_coulomb(slider):
    sim = slider.simulation()
    sim.run_until(0.02)
    assert sim.time == pytest.approx(0.02)
    body = sim.first_bodies["slider"]
    assert body.force == pytest.approx([-30.0, 100.0], rel=1e-6)
    # The centre of mass, between the two balls.
    assert body.position[0] == pytest.approx(0.025 + 0.002, rel=1e-9)
    assert sim.contacts.force_normal.sum() == pytest.approx(100.0, rel=1e-6)
    assert abs(sim.energy["residual"]) < 1e-9 * sim.energy["scale"]


def test_a_solid_has_three_components(here):
    import fretwork

    case = fretwork.Case.load("cases/shear_cell_3d.ron")
    sim = case.simulation()
    sim.step(2)
    assert sim.dimension == 3
    assert sim.grains.position.shape[1] == sim.grains.spin.shape[1] == 3
    assert sim.contacts.position.shape == (len(sim.contacts), 3)


def test_ctrl_c_ends_between_two_steps(shear):
    sim = shear.simulation()

    def interrupt():
        time.sleep(0.3)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt, daemon=True).start()
    with pytest.raises(KeyboardInterrupt):
        sim.step(10**9)
    steps = sim.steps
    sim.step()
    assert sim.steps == steps + 1


def test_two_threads_do_not_step_at_once(shear):
    sim = shear.simulation()
    begun = threading.Event()
    failed = []

    def step():
        begun.set()
        try:
            while not failed and sim.steps < 5000:
                sim.step(100)
        except RuntimeError as error:
            failed.append(error)

    other = threading.Thread(target=step)
    other.start()
    begun.wait()
    try:
        while not failed and sim.steps < 5000:
            sim.step(100)
    except RuntimeError as error:
        failed.append(error)
    other.join()
    assert failed and "another thread" in str(failed[0])


def test_what_cannot_be_stepped_by_hand(shear, slider):
    shear["accuracy"] = {"share": 0.1, "of": "Friction"} if "Friction" in shear.kinds("accuracy.of") else {"share": 0.1}
    with pytest.raises(InputError, match="accuracy"):
        shear.simulation()
    slider["bodies.slider.dofs.y"] = {"Force": 1e308}
    with pytest.raises(RunError, match="step 1"):
        slider.simulation().step()
