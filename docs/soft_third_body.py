#!/usr/bin/env python3
"""Friction of a soft, cohesive third body against cohesion and stiffness.

Runs cases/soft_third_body.ron with cohesions from none to eight times the pressure, at two stiffnesses of the grains over the pressure, kappa = E/P, from
several seeds of the packing. Prints a line a run, and for each cohesion the mean over the seeds with Student's interval of 95 %. From the root of the
repository, after `cargo build --release`:

    python3 docs/soft_third_body.py [FOLDER] [--seeds 3]        # eight minutes a seed

Trend to compare with: G. Zhang, G. Mollon, S. Descartes, "Significance of third body rheology in friction at a dry sliding interface observed by a
multibody meshfree model: influence of cohesion between particles", Tribology International 145 (2020): friction rises with the cohesion and levels off;
a flow of shear through the layer gives way to clusters that roll and to slip.
"""
import argparse
import json
import os
import statistics
import subprocess

E = 568e6
# Seed of the case.
FIRST_SEED = 3
PROGRAM = os.environ.get("FRETWORK", "target/release/fretwork")
# Student's t of 97.5 % for 1, 2, ... degrees of freedom.
STUDENT = (12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262)


def interval(values: list[float]) -> str:
    """Mean and half-width of its interval of 95 %."""
    mean = statistics.fmean(values)
    if not 2 <= len(values) <= len(STUDENT) + 1:
        return f"{mean:.3f}"
    half = STUDENT[len(values) - 2] * statistics.stdev(values) / len(values) ** 0.5
    return f"{mean:.3f} +- {half:.3f}"


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("folder", nargs="?", default="results/soft_third_body")
parser.add_argument("--seeds", type=int, default=3)
options = parser.parse_args()
means = []


def run(pressure: float, ratio: float, seed: int) -> dict:
    """The summary of a run at a pressure (Pa), a cohesion over it, and a seed."""
    folder = f"{options.folder}/{E / pressure:.0f}_{ratio:g}_{seed}"
    # The plate comes down, and inertial forces stay small, as in the case.
    sets = [
        f"bodies.1.dofs.y=Pressure(value: Ramp(from: {-0.01 * pressure:e}, to: {-pressure:e}, start: 0.0, end: 0.15))",
        f"bodies.1.mass={2e4 * pressure / 2.5e5:e}",
        f"inertia_scaling={30 * pressure / 2.5e5:e}",
        f"seed={seed}",
        "output.figures=false",
        "output.frames=0",
    ]
    for k in (0, 1):
        for name in ("cohesion", "tension"):
            sets.append(f"interfaces.{k}.parameters.contact.{name}={ratio * pressure:e}")
    words = [PROGRAM, "run", "cases/soft_third_body.ron", "--out", folder, "--force"]
    for each in sets:
        words += ["--set", each]
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(f"{folder}/summary.json", encoding="utf-8") as file:
        return json.load(file)


print("kappa   C/P  seed  friction         interior shear  slip at the plates  solid fraction  largest strain, reasons not to trust")
for pressure in (2.5e5, 2.5e4):
    for ratio in (0.0, 1.0, 2.0, 4.0, 8.0):
        frictions, shears = [], []
        for seed in range(FIRST_SEED, FIRST_SEED + options.seeds):
            s = run(pressure, ratio, seed)
            layer = s["measures"]
            scatter = s["uncertainty"]["friction_coefficient"]["scatter"]
            scatter = "?" if scatter is None else f"{scatter:.3f}"
            strain = max(grain["strain"] for grain in s["small_strain"])
            frictions.append(s["friction_coefficient"])
            shears.append(layer["layer_interior_shear"])
            print(
                f"{E / pressure:5.0f}  {ratio:4g}  {seed:4d}  {s['friction_coefficient']:.3f} +- {scatter}  {layer['layer_interior_shear']:10.2f}"
                f"  {layer['layer_slip_first_share']:12.2f} {layer['layer_slip_second_share']:.2f}  {layer['layer_solid_fraction']:14.3f}"
                f"  {strain:.3f}  {'; '.join(s['reasons'])[:60]}",
                flush=True,
            )
        means.append(f"{E / pressure:5.0f}  {ratio:4g}  {interval(frictions):16s}  {interval(shears)}")

print("\nkappa   C/P  friction          interior shear")
print("\n".join(means))
