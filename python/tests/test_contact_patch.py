"""Contact patches against closed forms."""

import math

import pytest

import fretwork


def test_a_sphere_on_a_flat_has_the_closed_form() -> None:
    found = fretwork.contact_patch(50.0, 0.01, young=210e9, poisson=0.3, friction=0.6, displacement="5 um")
    modulus = 105e9 / 0.91
    a = (0.75 * 50.0 * 0.01 / modulus) ** (1 / 3)
    assert found["shape"] == "circle"
    assert found["patch"]["semi_axis"] == pytest.approx(a, rel=1e-12)
    assert found["patch"]["pressure"] == pytest.approx(1.5 * 50.0 / (math.pi * a * a), rel=1e-12)
    # R. D. Mindlin 1949: 3 mu P (2 - nu)/(8 G a).
    slip = 3 * 0.6 * 50.0 * 1.7 / (8 * 210e9 / 2.6 * a)
    assert found["tangential"]["slip_displacement"]["value"] == pytest.approx(slip, rel=1e-12)


def test_texts_numbers_and_intervals_are_the_same() -> None:
    texts = fretwork.contact_patch(
        "75 kN", "0.46 m,flat", "flat,0.3 m", material="rail_steel_r260", friction="0.3..0.5", creepage="0.5 %", wear="1e-4"
    )
    numbers = fretwork.contact_patch(
        75e3, (0.46, "flat"), ("flat", 0.3), material="rail_steel_r260", friction=(0.3, 0.5), creepage=0.005, wear=1e-4
    )
    assert texts == numbers
    adhesion = numbers["rolling"]["adhesion"]
    assert adhesion["low"] < adhesion["value"] < adhesion["high"]


def test_what_is_missing_is_said() -> None:
    with pytest.raises(fretwork.InputError, match="give friction"):
        fretwork.contact_patch("75 kN", 0.46, material="rail_steel_r260", creepage=0.01)
    with pytest.raises(fretwork.InputError, match="did you mean `rail_steel_r260`"):
        fretwork.contact_patch("75 kN", 0.46, material="rail_steel_r26")
