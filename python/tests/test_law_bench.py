"""Laws listed, described, driven and certified from Python."""

import json
import math
import subprocess
import sys

import numpy as np
import pytest

import fretwork.law as law


def command_line(*words):
    return subprocess.run([sys.executable, "-m", "fretwork", *map(str, words)], capture_output=True, text=True)


def test_the_shipped_laws_are_listed_with_their_schemas():
    laws = {(info.kind, info.name): info for info in law.list()}
    assert len(laws) == 53
    mac = laws["damage", "mac"]
    assert mac.built_in and not mac.error
    w = mac.parameters[0]
    assert (w.name, w.unit, w.default, w.minimum, w.maximum) == ("w", "J/m^2", 0.1, 0.0, 1e30)
    assert laws["contact", "coulomb"].parameters[0].maximum == math.inf
    assert laws["contact", "rate-and-state"].variables[0].name == "psi"
    assert "reference" in str(mac) and "w " in str(mac)


def test_a_name_is_looked_up():
    assert law.show("damage/mac").kind == "damage"
    with pytest.raises(law.LawError, match="damage/mac"):
        law.show("mac")
    with pytest.raises(law.LawError, match="did you mean `archard`\\?"):
        law.show("archerd")


def test_drive_gives_the_table_of_the_command_line():
    words = ["elastic-bond", "linear-softening", "--mode", "mixed", "--angle", "30", "--steps", "50", "--set", "strength=2e5"]
    rows = json.loads(command_line("law", "drive", *words, "--json").stdout)
    curve = law.drive("elastic-bond", "linear-softening", mode="mixed", angle=30, steps=50, parameters={"strength": 2e5})
    assert list(curve) == list(rows[0])
    for name, values in curve.items():
        assert values.tolist() == [row[name] for row in rows]
    assert curve.units["traction_n"] == "Pa"
    assert curve["work"][-1] == pytest.approx(0.5, rel=5e-2)  # fifty steps


def test_drive_along_a_path_of_arrays():
    u = np.linspace(1e-8, 1e-6, 20)
    curve = law.drive("elastic-bond", parameters={"k_n": 1e12}, path={"time": np.arange(1, 21) * 1e-4, "n": u, "t1": 0.0 * u})
    assert np.allclose(curve["traction_n"][1:], 1e12 * u, rtol=1e-12)
    with pytest.raises(law.LawError, match="differ in length"):
        law.drive("elastic-bond", path={"time": [1.0], "n": [1.0, 2.0], "t1": [0.0]})
    with pytest.raises(law.LawError, match="did you mean `time`"):
        law.drive("elastic-bond", path={"tim": [1.0]})


def test_wrong_arguments_are_sentences():
    with pytest.raises(law.LawError, match="steps must be at least 1"):
        law.drive("elastic-bond", steps=0)
    with pytest.raises(law.LawError, match="no law named"):
        law.drive("no-such-law")
    with pytest.raises(law.LawError, match="name a law to drive"):
        law.drive()
    with pytest.raises(law.LawError, match="has no parameter `ww`"):
        law.certify("damage/mac", ww=1.0)
    with pytest.raises(law.LawError, match="needs a number"):
        law.certify("damage/mac", w="one")


def test_drive_makes_a_table_of_pandas():
    pytest.importorskip("pandas")
    table = law.drive("elastic-bond", to=1e-6, steps=10).frame()
    assert len(table) == 11
    assert table.attrs["units"]["opening_n"] == "m"


def test_a_certificate_has_its_lines():
    certificate = law.certify("wear/archard", k=1e-13)
    assert certificate.certified and (certificate.kind, certificate.name) == ("wear", "archard")
    lines = {check.name: check for check in certificate.checks}
    assert lines["bad numbers"].outcome == "pass"
    assert str(certificate).endswith("certified")


# Laws in Python.


@pytest.fixture(scope="module")
def examples():
    pytest.importorskip("numba")
    import law_examples

    return law_examples


def test_every_example_is_certified(examples):
    for one in examples.SHIPPED:
        certificate = one.certify()
        assert certificate.certified, str(certificate)
        assert certificate.name == one.name


def test_the_schema_is_that_of_the_source(examples):
    one = examples.py_rate_and_state
    info = law.show(one.name, plugin_path=one.build().parent)
    assert info.kind == "contact" and info.doc == "mu_0 + a ln(V/V_0) + b ln(V_0 theta/D_c)"
    assert [p.name for p in info.parameters] == list(one.parameters)
    for field in info.parameters:
        declared = one.parameters[field.name]
        assert (field.default, field.unit, field.doc) == (declared.default, declared.unit, declared.doc)
        assert (field.minimum, field.maximum) == declared.range
    assert [v.name for v in info.variables] == ["psi"]
    assert law.show("py-coulomb", plugin_path=examples.py_coulomb.build().parent).parameters[0].maximum == math.inf


def test_a_law_is_a_function_in_python(examples):
    assert examples.py_velocity_weakening(0.0) == 0.4
    assert examples.py_velocity_weakening(sliding_speed=1.0, v_s=1e-3) == pytest.approx(0.3)
    assert examples.py_coulomb() == law.Friction(0.3, 0.0, 0.0)
    with pytest.raises(TypeError, match="sliding_speed"):
        examples.py_velocity_weakening()


def test_python_and_the_library_agree(examples):
    curve = examples.py_velocity_weakening.drive(mode="slide", velocities=[0.05, 0.2], to=1e-5, steps=10)
    speeds = np.diff(curve["opening_t1"]) / np.diff(curve["time"])
    expected = [examples.py_velocity_weakening(v) for v in speeds]
    assert np.allclose(curve["friction"][1:], expected, rtol=1e-12)


def test_a_condition_refuses_parameters(examples):
    with pytest.raises(law.LawError, match="`mu_d` exceeds `mu_s`"):
        examples.py_velocity_weakening.drive(mode="slide", velocities=[0.1], parameters={"mu_s": 0.1})


def test_a_value_that_is_not_finite_is_named_with_what_led_to_it():
    pytest.importorskip("numba")

    @law.contact
    def inverse_speed(sliding_speed, mu=law.Parameter(0.25, range=(0.0, 1.0), doc="friction coefficient")):
        return mu / (sliding_speed - sliding_speed)

    with pytest.raises(law.LawError) as raised:
        inverse_speed.drive(mode="slide", velocities=[0.5], to=1e-5, steps=10)
    message = str(raised.value)
    assert "`friction` that is not finite" in message and "mu = 0.25" in message and "velocity_t1 = 0" in message


def test_an_array_is_not_read_beyond_its_end():
    pytest.importorskip("numba")
    values = np.array([0.1, 0.2, 0.3])

    @law.contact
    def beyond(sliding_speed, place=law.Parameter(1.0, range=(0.0, 10.0), doc="place in the array")):
        return values[int(place)]

    options = {"mode": "slide", "velocities": [1.0], "steps": 2}
    assert beyond.drive(**options)["friction"][-1] == 0.2
    with pytest.raises(law.LawError, match="beyond the end of an array"):
        beyond.drive(parameters={"place": 3.0}, **options)


def test_a_law_asks_for_a_smaller_step():
    pytest.importorskip("numba")

    @law.contact
    def careful(sliding_speed, h, mu=law.Parameter(0.25, range=(0.0, 1.0), doc="friction coefficient")):
        return law.SMALLER_STEP if h > 1e-6 else mu

    with pytest.raises(law.LawError, match="take a smaller one"):
        careful.drive(mode="slide", velocities=[1.0], to=1e-2, steps=10)
    curve = careful.drive(mode="slide", velocities=[1.0], to=1e-6, steps=10)
    assert curve["friction"][-1] == 0.25


def test_a_law_that_breaks_a_promise_is_not_certified():
    pytest.importorskip("numba")

    @law.contact
    def negative(sliding_speed, mu=law.Parameter(0.25, range=(0.0, 1.0), doc="friction coefficient")):
        return mu - 1.0 - sliding_speed

    certificate = negative.certify()
    assert not certificate.certified
    assert any("friction" in check.text for check in certificate.failures)
    assert str(certificate).endswith("NOT certified")


def test_a_transport_law_and_one_that_reads_temperatures_are_certified():
    pytest.importorskip("numba")

    @law.transport
    def my_spots(normal_force, conductivity, resistivity, per_force=law.Parameter(1e-6, range=(0.0, 1.0), unit="m/N", doc="width per force")):
        "conductances in proportion to the force"
        width = per_force * normal_force
        return law.Conductance(conductivity * width, width / resistivity)

    @law.contact
    def my_warm(temperature, cold=law.Parameter(0.4, range=(0.0, 10.0), doc="friction at 300 K")):
        "friction that falls with the temperature"
        return cold / (1.0 + max(temperature - 300.0, 0.0) / 300.0)

    for one in (my_spots, my_warm):
        certificate = one.certify()
        assert certificate.certified, str(certificate)
    checks = {check.name for check in my_spots.certify().checks}
    assert {"sign", "symmetry", "continuity"} <= checks


def test_a_changed_law_is_a_new_library():
    """In one process, as in a notebook; also where a function that it calls changes."""
    pytest.importorskip("numba")
    world = {"law": law, "__name__": "notebook"}

    def cell(text):
        exec(text, world)

    cell("def g(mu):\n    return mu\n")
    cell("@law.contact\ndef edited(mu=law.Parameter(0.25, range=(0.0, 1.0), doc='friction coefficient')):\n    return g(mu)\n")
    first = world["edited"].build()
    assert world["edited"].build() == first
    assert world["edited"].drive(mode="slide", velocities=[1.0], steps=2)["friction"][-1] == 0.25
    cell("def g(mu):\n    return 2.0 * mu\n")
    assert world["edited"].build() != first
    assert world["edited"].drive(mode="slide", velocities=[1.0], steps=2)["friction"][-1] == 0.5


def test_a_rebuilt_file_is_warned_about(tmp_path):
    pytest.importorskip("numba")
    for factor in ("1.0", "2.0"):
        world = {"law": law}
        text = f"def same(mu=law.Parameter(0.2, range=(0.0, 1.0), doc='friction')):\n    return {factor} * mu\n"
        exec(text, world)
        made = law.contact(world["same"])
        if factor == "1.0":
            made.build(tmp_path)
        else:
            with pytest.warns(RuntimeWarning, match="start Python again"):
                made.build(tmp_path)


def test_zig_links_where_there_is_no_c_compiler(examples, monkeypatch, tmp_path):
    pytest.importorskip("ziglang")
    from fretwork.law import build, link

    monkeypatch.setattr(link.shutil, "which", lambda _: None)
    monkeypatch.delenv("CC", raising=False)
    assert link.compiler()[1:] == ["-m", "ziglang", "cc"]
    content = link.library(*build.compiled(examples.py_roe_siegmund))
    (tmp_path / "libfretwork_damage_py_roe_siegmund.so").write_bytes(content)
    assert law.certify("damage/py-roe-siegmund", plugin_path=tmp_path).certified
