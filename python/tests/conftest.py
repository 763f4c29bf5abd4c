"""Where tests run: in a folder of their own, beside the cases and materials of the project."""

from pathlib import Path

import pytest

import fretwork

ROOT = Path(__file__).parents[2]


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty working folder with `cases`, `materials` and `patches`."""
    for name in ("cases", "materials", "patches"):
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def shear(here):
    """Disks between walls, 50 steps."""
    quick = {"time.end": 0.01, "output.frames": 0, "output.figures": False}
    return fretwork.Case.load("cases/plane_shear.ron", set=quick)


@pytest.fixture
def slider():
    """A slider on a plane: Coulomb friction of 30 N."""
    return fretwork.Case(
        name="a slider on a plane",
        dimension=2,
        time={"step": 1e-4, "end": 0.05},
        materials={"steel": "rail_steel_r260"},
        interfaces=[
            {
                "name": "dry",
                "between": ["steel", "steel"],
                "contact": "coulomb",
                "parameters": {"contact": {"mu": 0.3}},
            }
        ],
        bodies=[
            {"name": "floor", "material": "steel", "shapes": [{"HalfSpace": {"normal": [0, 1]}}]},
            {
                "name": "slider",
                "material": "steel",
                "position": [0.0, 0.01],
                "shapes": [{"Balls": [[[0.0, 0.0], 0.01], [[0.05, 0.0], 0.01]]}],
                "dofs": {"x": {"Velocity": 0.1}, "y": {"Force": -100.0}},
            },
        ],
        output={"frames": 0, "figures": False},
    )
