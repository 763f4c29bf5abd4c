"""Uses of the package whose types a checker confirms; see test.sh."""

from collections.abc import Callable
from typing import Any

import fretwork


def top(sim: fretwork.Simulation) -> fretwork.Stop | None:
    return fretwork.Stop("high") if sim.time > 1.0 else None


class Count(fretwork.Observer):
    columns = [fretwork.Column("count")]

    def step(self, sim: fretwork.Simulation) -> dict[str, float]:
        return {"count": float(len(sim.contacts))}


def uses(case: fretwork.Case) -> float:
    case["time.end"] = 0.1
    progress: Callable[[fretwork.Progress], None] = lambda now: print(now.step / now.steps)
    results: fretwork.Results = case.run("out", observers=[top, Count()], progress=progress)
    report: fretwork.StepReport = case.simulation(threads=2).step(3)
    check: list[str] = case.check()["dimension"]
    energy: dict[str, float] = case.simulation().energy
    wear: float = fretwork.read_study("results/study/wear", settings=True)["wear.Qs"].max()
    patch: dict[str, Any] = fretwork.contact_patch("75 kN", 0.46, ("flat", 0.3), material="rail_steel_r260", friction=(0.3, 0.5))
    young: float = fretwork.material("PTFE").properties["young"].value + fretwork.materials()[0]["density"]
    return wear + young + float(patch["load"]) + report.error + len(check) + energy["friction"] + float(results.statistics["time"].iloc[-1])


def errors() -> int | None:
    try:
        fretwork.Case.load("a.ron", set={"time.end": 1})
    except fretwork.InputError as error:
        return error.line
    return None
