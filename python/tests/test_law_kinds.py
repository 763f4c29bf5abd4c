"""The table of kinds and the header of the plugin interface say the same; a further kind is a further entry."""

import re

import pytest

import fretwork.law as law
from fretwork.law import definition, header, kinds, loops
from fretwork.law.kinds import KINDS, Function, Kind


def test_the_header_is_read():
    columns, numbers, outputs = header.columns(), header.numbers(), header.outputs()
    declared = re.search(r"typedef struct fw_batch \{(.*?)\n\} fw_batch;", header.text(), re.S)[1]
    assert len(header.members("fw_batch")) == len(re.findall(r"^\s+[a-z].*;", declared, re.M))
    assert columns["gap"].doc == "Gap at detection (m), positive when open."
    assert {"time", "h", "theta", "degradation", "dimension"} == set(numbers)
    assert len(outputs) == len(re.findall(r"^\s+double \*out_", declared, re.M))
    assert set(columns).isdisjoint({"parameters", "state"})


def test_the_kinds_are_those_of_the_header():
    words = {m.lower() for m in re.findall(r"#define FW_KIND_(\w+)", header.text())}
    assert set(KINDS) == words
    slots = header.text().split("typedef struct fw_plugin {")[1]
    for kind in KINDS.values():
        for function in kind.functions():
            assert re.search(rf"fw_call {function.slot};", slots)
            assert function.column is None or function.column in header.outputs()
            for result in function.results:
                assert {f"out_{name}" for name in result._fields} <= set(header.outputs())
        for claim in kind.claims:
            assert any(name.startswith(claim) for name in {**header.columns(), **header.numbers()})
        options = {**kinds.COMMON_OPTIONS, **kind.options}.values()
        flags = {flag for flag, _ in options} | {f.flag for f in kind.functions() if f.flag} | set(kind.asks.values())
        assert flags <= set(header.constants())


def test_decorators_say_what_they_take():
    said = law.cohesion.__doc__
    assert "tension_only: the normal stiffness acts in tension only; the contact carries compression." in said
    assert "`@my_law.energy` returns the energy stored by the bond" in said and "degradation" not in law.wear.__doc__


def test_columns_of_two_dimensions_are_those_that_the_header_calls_null():
    spatial = {name for name in {**header.columns(), **header.outputs()} if loops.is_spatial(name)}
    assert {name for name in header.columns() if name.endswith("_t2")} <= spatial
    assert {"rotation_n", "intact_moment_n", "out_moment_n"} <= spatial
    assert "rotation_t1" not in spatial


def test_inputs_are_those_of_the_kind():
    assert "slip" in law.inputs("wear") and "slip" not in law.inputs("contact")
    assert "intact_traction" in law.inputs("damage") and "intact_traction" not in law.inputs("wear")
    assert "overlap" in law.inputs("contact") and "degradation" not in law.inputs("contact")
    with pytest.raises(law.LawError, match="did you mean `wear`"):
        law.inputs("waer")


def test_a_further_kind_is_an_entry(monkeypatch, tmp_path):
    """Built, up to the linker: the header that is shipped has no such kind."""
    pytest.importorskip("numba")
    from fretwork.law import build

    new = Kind("diffusion", Function("flux", "commit", "the volume that moves (m^3)", "out_volume", moves=True), claims=("slip",))
    monkeypatch.setitem(KINDS, "diffusion", new)
    diffusion = definition.decorator("diffusion")

    @diffusion
    def my_flux(slip, area, share=law.Parameter(0.1, range=(0.0, 1.0), doc="share"), moved=law.Variable(0.0, "m^3", "moved")):
        """volume that moves with the slip"""
        return share * slip * area, moved + share * slip * area

    table, loops_object = build.compiled(my_flux)
    assert ".kind = FW_KIND_DIFFUSION," in table and ".commit = call_commit," in table
    assert b"fretwork_commit_0" in loops_object
    assert "slip" in law.inputs("diffusion") and "slip" in law.inputs("wear") and "slip" not in law.inputs("contact")
