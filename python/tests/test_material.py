"""Materials from Python."""

from pathlib import Path

import pytest

import fretwork


def test_numbers_have_unit_range_and_source() -> None:
    steel = fretwork.material("60E1 R260")
    assert steel.name == "rail_steel_r260" and steel.kind == "steel"
    young = steel.properties["young"]
    assert float(young) == 210e9 and young.unit == "Pa" and "EN 1993" in young.source
    hardness = steel.properties["hardness"]
    assert hardness.given == "260 HBW"
    assert hardness.range == pytest.approx((260 * 9.80665e6, 300 * 9.80665e6))
    assert steel["plane_strain_modulus"] == pytest.approx(210e9 / 0.91, rel=1e-12)
    assert steel["density"] == 7850.0
    with pytest.raises(KeyError, match="colour"):
        steel["colour"]


def test_all_are_listed() -> None:
    found = fretwork.materials()
    assert len(found) >= 40
    assert all(each.properties[name].source for each in found for name in each.properties)
    assert {each.kind for each in fretwork.materials("bearing steel")} == {"steel"}


def test_an_own_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = '(doc: "own", also: ["No 7"], density: (value: 2 g/cm^3, source: "weighed"), properties: {"young": (value: 3 GPa, source: "s")})'
    (tmp_path / "materials").mkdir()
    file = tmp_path / "materials" / "mine.ron"
    file.write_text(text)
    monkeypatch.chdir(tmp_path)
    for name in ("mine", "no 7", file):
        mine = fretwork.material(name)
        assert (mine.name, mine["density"], mine["young"]) == ("mine", 2000.0, 3e9)
    assert "mine" in [each.name for each in fretwork.materials()]
    file.write_text(text.replace("GPa", "gpa"))
    with pytest.raises(fretwork.InputError, match="did you mean `GPa`"):
        fretwork.material("mine")


def test_an_unknown_name() -> None:
    with pytest.raises(fretwork.InputError, match="did you mean `Ti-6Al-4V`"):
        fretwork.material("Ti-6Al-4W")
