"""Shipped laws written in Python give the bits of the originals, and the same law is the same library."""

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("numba")

import law_examples  # noqa: E402
from law_examples import SHIPPED  # noqa: E402

CASES = Path(__file__).parents[2] / "cases" / "verification"
TESTS = Path(__file__).parent

#: Scenes: the file, what is set in it, the laws that are replaced, and columns that must not be
#: zero throughout.
SCENES = {
    "friction and wear": (
        "worn_slide_3d",
        ["time.end=0.2", "interfaces.grain.parameters.contact={}"],
        [law_examples.py_velocity_weakening, law_examples.py_archard],
        ["friction [J]", "worn_first [m^3]"],
    ),
    "a law of parameters alone": (
        "worn_slide",
        ["time.end=0.1"],
        [law_examples.py_coulomb],
        ["friction [J/m]"],
    ),
    "friction with a variable": (
        "worn_slide",
        ["time.end=0.2", "interfaces.grain.parameters.contact={}"],
        [law_examples.py_rate_and_state, law_examples.py_archard],
        ["friction [J/m]", "worn_first [m^3/m]"],
    ),
    "a spring": (
        "worn_slide",
        ["time.end=0.1", 'interfaces.grain.parameters.contact={"restitution": 0.4}'],
        [law_examples.py_linear_contact],
        ["elastic [J/m]", "viscous [J/m]"],
    ),
    "a bond and its softening": (
        "bond_mixed",
        [
            "time.step=1e-7",
            'interfaces.grain.parameters.cohesion={"k_n": 1e12, "k_t": 1e12}',
            "interfaces.grain.parameters.damage={}",
        ],
        [law_examples.py_elastic_bond, law_examples.py_linear_softening],
        ["elastic [J/m]", "fracture [J/m]", "mean_damage"],
    ),
    "a bond that breaks by itself, and what it releases": (
        "bond_mixed",
        [
            "time.step=1e-6",
            "time.end=4e-4",
            "interfaces.grain.damage=None",
            "interfaces.grain.parameters.damage={}",
            "interfaces.grain.parameters.cohesion={}",
        ],
        [law_examples.py_tvergaard, law_examples.py_broken_bonds],
        ["fracture [J/m]", "worn_third [m^3/m]", "bonds_broken"],
    ),
    "fatigue, with two variables": (
        "bond_fatigue",
        ["time.end=20.0", "jump=None"],
        [law_examples.py_elastic_bond, law_examples.py_roe_siegmund],
        ["mean_damage"],
    ),
    "an attraction": (
        "worn_slide",
        ["time.end=0.1", 'interfaces.grain.parameters.cohesion={"force": 300.0}'],
        [law_examples.py_coulomb, law_examples.py_attraction],
        ["friction [J/m]"],
    ),
}


def run(case, sets, laws, out, plugin_path=None):
    """Runs a case with laws by kind and name; returns the content of its statistics."""
    words = [sys.executable, "-m", "fretwork", "run", str(CASES / f"{case}.ron"), "--out", str(out)]
    for text in [*(f"interfaces.grain.{kind}={name}" for kind, name in laws), *sets]:
        words += ["--set", text]
    words += ["--plugin-path", str(plugin_path)] if plugin_path else []
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return (out / "statistics.csv").read_bytes()


@pytest.mark.skipif(not CASES.is_dir(), reason="the cases are part of the source")
@pytest.mark.parametrize("scene", SCENES)
def test_runs_have_the_bits_of_the_shipped_law(scene, tmp_path):
    case, sets, laws, columns = SCENES[scene]
    folder = tmp_path / "laws"
    for law in laws:
        law.build(folder)
    shipped = run(case, sets, [(law.kind, SHIPPED[law]) for law in laws], tmp_path / "shipped")
    python = run(case, sets, [(law.kind, law.name) for law in laws], tmp_path / "python", folder)
    assert python == shipped
    head, *rows = [line.split(",") for line in shipped.decode().splitlines()]
    for column in columns:
        place = head.index(column)
        assert any(float(row[place]) != 0.0 for row in rows), f"{column} says nothing about the laws"


def test_every_example_is_compared():
    assert {law for _, _, laws, _ in SCENES.values() for law in laws} == set(SHIPPED)


def test_the_same_law_is_the_same_library(tmp_path):
    """In other processes, in another order, with other seeds of hashes."""
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); import law_examples as e\n"
        "laws = [e.py_roe_siegmund, e.py_tvergaard, e.py_velocity_weakening]\n"
        "for law in laws if sys.argv[3] == '1' else reversed(laws): law.build(sys.argv[2])\n"
    )
    found = []
    for turn in ("1", "2"):
        folder = tmp_path / turn
        words = [sys.executable, "-c", code, str(TESTS), str(folder), turn]
        subprocess.run(words, check=True, env={**__import__("os").environ, "PYTHONHASHSEED": turn})
        found.append({file.name: file.read_bytes() for file in folder.iterdir()})
    assert len(found[0]) == 3
    assert found[0] == found[1]


@pytest.mark.skipif(sys.platform != "linux", reason="reads ELF files")
def test_a_library_needs_the_c_library_alone(tmp_path):
    library = law_examples.py_rate_and_state.build(tmp_path)
    needed = subprocess.run(["readelf", "--dynamic", str(library)], capture_output=True, text=True, check=True).stdout
    names = {line.split("[")[1].rstrip("]") for line in needed.splitlines() if "NEEDED" in line}
    assert names <= {"libm.so.6", "libc.so.6"}
