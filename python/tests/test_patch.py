"""Contact patches by the laws of an interface, against closed forms."""

from pathlib import Path

import pytest

import fretwork

WHEEL = """(
    name: "a wheel", materials: {"wheel": "wheel_steel_er7", "rail": "rail_steel_r260"},
    bodies: ((material: "wheel", radius: 0.46 m), (material: "rail", across: 0.3 m)),
    interfaces: [(name: "dry", between: ("wheel", "rail"), contact: "coulomb", parameters: (contact: {"mu": 0.4}))],
    load: 75 kN, cells: 32, motion: Rolling(along: [0.1 %, 5 %]), members: [(contact: {"mu": 0.3})],
)"""


def test_a_wheel_that_slides_has_the_coefficient_as_its_adhesion(tmp_path: Path) -> None:
    file = tmp_path / "wheel.ron"
    file.write_text(WHEEL)
    found = fretwork.patch(file, out=tmp_path / "out")
    creeps, slides = found["points"]
    assert 0.0 < creeps["adhesion"] < 0.3
    assert slides["adhesion"] == pytest.approx(0.4, rel=1e-4)
    assert slides["adhesion_band"]["low"] == pytest.approx(0.3, rel=1e-4)
    assert slides["t_gamma"] == pytest.approx(0.4 * 75e3 * 0.05, rel=1e-4)
    assert (tmp_path / "out" / "patch.json").is_file() and (tmp_path / "out" / "patch.h5").is_file()
    assert fretwork.patch(file) == found


def test_a_wrong_file_is_said(tmp_path: Path) -> None:
    file = tmp_path / "wheel.ron"
    file.write_text(WHEEL.replace('"coulomb"', '"columb"'))
    with pytest.raises(fretwork.InputError, match="coulomb"):
        fretwork.patch(file)
