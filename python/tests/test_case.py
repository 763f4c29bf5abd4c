"""Cases: read, built, edited."""

import numpy as np
import pytest
from conftest import ROOT

import fretwork
from fretwork import Case, InputError

SHIPPED = sorted(ROOT.glob("cases/**/*.ron"))


def is_case(path):
    return "dimension:" in path.read_text("utf-8")


@pytest.mark.parametrize("path", [p for p in SHIPPED if is_case(p)], ids=lambda p: p.stem)
def test_every_case_is_the_same_after_python(path):
    case = Case.load(path)
    assert Case(folder=path.parent, **case.to_dict()) == case
    assert Case.from_text(case.to_ron(), folder=path.parent) == case
    assert Case.from_text(case.text, folder=path.parent) == case


BALL = (ROOT / "tests/support/ball.yaml").read_text("utf-8")


def test_a_case_in_yaml_with_names_and_expressions(tmp_path):
    file = tmp_path / "ball.yaml"
    file.write_text(BALL, encoding="utf-8")
    case = Case.load(file)
    assert case["time.step"] == 2e-4
    assert case["gravity"] == [0.0, -9.81]
    assert Case.load(file, set={"let.T": "10 ms"})["time.end"] == 0.01
    case["time.end"] = 0.01
    results = case.run(out=tmp_path / "out", progress=False)
    assert results.summary["steps"] == 50
    # m (g t)^2 / 2 of a disc of steel, to the order of the step.
    fall = 0.5 * 7850 * np.pi * 0.01**2 * (9.81 * 0.01) ** 2
    assert results.summary["energy"]["kinetic"] == pytest.approx(fall, rel=0.03)
    file.write_text(BALL.replace("T / 100", "R / 100"), encoding="utf-8")
    with pytest.raises(InputError, match=r"ball.yaml:4:14: .*`time.step` is a time, in `s`, and `R / 100` is in `m`"):
        Case.load(file)


def test_values_are_read_by_path_and_by_attribute(shear):
    assert shear["time.step"] == shear.time.step == 2e-4
    assert shear["bodies.top.dofs.y"].value == {"Pressure": {"value": {"Constant": -1000.0}, "between": []}}
    assert shear.bodies["top"].position == shear.bodies[1].position == shear.bodies[-1].position
    assert shear.grains[0].count == 500
    assert shear["phases.shear.drives.top.x.end"] == 0.05
    assert shear.solver.max_iterations == 5000
    # A default that the file does not write, and a field that is left out.
    assert shear.time.theta == 0.5
    assert shear.gravity_drive is None
    assert [body.name for body in shear.bodies] == ["bottom", "top"]
    assert "time.step" in shear and "friction" not in shear and "time.stp" not in shear


def test_an_edit_is_the_same_as_a_set_of_the_command_line(shear):
    path, sets = "cases/plane_shear.ron", []
    case = Case.load(path)
    for key, value, text in [
        ("time.end", 0.1 + 0.2, "0.30000000000000004"),
        ("seed", 7, "7"),
        ("interfaces.grains.contact", "static-dynamic", "static-dynamic"),
        ("solver.method", "Nlgs", "Nlgs"),
        ("solver.tolerance", np.float64(1e-5), "1e-5"),
        ("phases.shear.drives.top.x", {"Velocity": {"Constant": 0.3}}, "Velocity(Constant(0.3))"),
        ("output.figures", False, "false"),
        ("gravity", (0, -9.81), "[0, -9.81]"),
    ]:
        case[key] = value
        sets.append(f"{key}={text}")
    assert case == Case.load(path, set=sets)
    assert Case.load(path, set={"time.end": 0.1 + 0.2})["time.end"] == 0.1 + 0.2
    # Comments of the file stay.
    assert "// Plane shear of disks under a constant pressure" in case.text


def test_attributes_and_elements_are_set(shear):
    shear.time.end = 1.5
    shear.interfaces[0].parameters.contact["mu"] = 0.25
    shear.bodies["top"].dofs.y = {"Force": -10.0}
    assert shear["interfaces.grains.parameters.contact.mu"] == 0.25
    assert shear["bodies.1.dofs.y"] == {"Force": {"Constant": -10.0}}
    shear.append("measures", {"Mass": {"name": "high", "axis": 1, "above": 0.1, "start": 0.0}})
    assert [m["name"] for m in shear.measures][-1] == "high"
    shear["measures"] = []
    assert not shear["measures"]
    grains = [{"at": [0.01 * k, 0.0], "radius": 0.004} for k in range(3)]
    shear["grains"] = [{"List": {"material": "glass", "grains": grains}}]
    assert shear.grains[0].grains[2].at == [0.02, 0.0]
    shear["time.step"] = "20 us"
    assert shear.time.step == 2e-5
    with pytest.raises(InputError, match="`time.step` is a time, and `mm`"):
        shear["time.step"] = "1 mm"
    copy = shear.copy()
    copy.seed = 99
    assert shear.seed == 19 and copy != shear


def test_arrays_of_numpy_are_lists(slider):
    points = np.array([[0.0, 0.0], [1.0, 2.0]])
    slider["bodies.slider.dofs.x"] = {"Displacement": {"Table": points}}
    assert slider["bodies.slider.dofs.x"].value == {"Displacement": {"Table": points.tolist()}}


def test_completion_has_names_of_fields_kinds_and_entries(shear):
    assert {"time", "bodies", "gravity_drive"} <= set(dir(shear))
    assert {"step", "end", "theta"} <= set(dir(shear.time))
    assert shear.bodies.keys() == ["bottom", "top"]
    assert "bodies.top" in shear._ipython_key_completions_()
    assert "dofs" in dir(shear.bodies["top"])
    assert shear.kinds("coupling") == ["Explicit", "Midpoint", "Implicit"]
    assert "Auto" in shear.kinds("solver.method")


def test_a_mistake_says_where_and_what_instead(here):
    text = (here / "cases" / "plane_shear.ron").read_text("utf-8").replace("max_iterations", "max_iteration")
    (here / "wrong.ron").write_text(text, "utf-8")
    with pytest.raises(InputError) as raised:
        Case.load("wrong.ron")
    error = raised.value
    line = text[: text.index("max_iteration")].count("\n") + 1
    assert (error.file, error.line) == ("wrong.ron", line)
    assert error.column == text.splitlines()[line - 1].index("max_iteration") + 1
    assert "max_iterations" in error.proposal and "max_iterations" in error.expected
    assert isinstance(error, ValueError) and isinstance(error, fretwork.Error)
    assert str(error).startswith(f"wrong.ron:{line}:{error.column}: error:")


def test_a_wrong_edit_leaves_the_case_as_it_was(shear):
    before = shear.text
    with pytest.raises(InputError, match="did you mean `step`"):
        shear["time.stp"] = 1.0
    with pytest.raises(InputError) as raised:
        shear["time"] = {"step": 1.0, "ende": 2.0}
    assert raised.value.file == "time.ende" and raised.value.proposal == "did you mean `end`?"
    with pytest.raises(InputError, match="not JSON compliant"):
        shear["time.step"] = float("nan")
    with pytest.raises(InputError, match="object"):
        shear["gravity"] = {1.0, object()}
    with pytest.raises(InputError):
        shear.set("seed=3", "time.step=-1")
    with pytest.raises(InputError, match="9 elements|2 elements|no `9`"):
        shear["bodies.9.mass"] = 1.0
    assert shear.text == before and shear.seed == 19


def test_what_is_not_there_is_a_key_or_attribute_error(shear):
    with pytest.raises(KeyError, match="did you mean `step`"):
        shear["time.stp"]
    with pytest.raises(AttributeError, match="did you mean `step`"):
        shear.time.stp
    with pytest.raises(IndexError):
        shear.bodies[2]


def test_mistakes_in_a_case_of_python_are_input_errors():
    required = {"name": "", "dimension": 2, "time": {"step": 1.0, "end": 1.0}}
    with pytest.raises(InputError, match="materials"):
        Case(**required)
    with pytest.raises(InputError, match="elast"):
        Case(**required, materials={}, elast=[])
    with pytest.raises(InputError) as raised:
        Case(**required, materials={}, coupling="Explict")
    assert raised.value.proposal == "did you mean `Explicit`?"


def test_a_case_is_saved_and_read_again(slider, tmp_path):
    slider.save(tmp_path / "slider.ron")
    assert Case.load(tmp_path / "slider.ron") == slider
    assert "slider" in repr(slider)


def test_check_tells_what_the_command_tells(shear):
    check = shear.check(timing=False)
    assert check["dimension"] == ["2"]
    assert check["steps"] == ["50 of 2e-4 s, theta 0.5"]
    assert any("coulomb" in line for line in check["interface"])
    assert check.title == "plane shear of disks" and check.warnings == []
    assert "run time" not in check and "run time" in shear.check()
    shear["interfaces.grains.contact"] = "culomb"
    with pytest.raises(InputError, match="coulomb") as raised:
        shear.check()
    assert raised.value.line is not None
