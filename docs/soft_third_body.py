#!/usr/bin/env python3
"""Friction of a soft, cohesive third body against cohesion and stiffness.

Runs cases/soft_third_body.ron with cohesions from none to eight times the pressure, at two stiffnesses of the grains over the pressure, kappa = E/P, and
prints a line a run. From the root of the repository, after `cargo build --release`:

    python3 docs/soft_third_body.py [FOLDER]        # eight minutes

Trend to compare with: G. Zhang, G. Mollon, S. Descartes, "Significance of third body rheology in friction at a dry sliding interface observed by a
multibody meshfree model: influence of cohesion between particles", Tribology International 145 (2020): friction rises with the cohesion and levels off;
a flow of shear through the layer gives way to clusters that roll and to slip.
"""
import json
import os
import subprocess
import sys

E = 568e6
PROGRAM = os.environ.get("FRETWORK", "target/release/fretwork")
out = sys.argv[1] if len(sys.argv) > 1 else "results/soft_third_body"

print("kappa   C/P  friction         interior shear  slip at the plates  solid fraction  largest strain, reasons not to trust")
for pressure in (2.5e5, 2.5e4):
    for ratio in (0.0, 1.0, 2.0, 4.0, 8.0):
        folder = f"{out}/{E / pressure:.0f}_{ratio:g}"
        # The plate comes down, and inertial forces stay small, as in the case.
        sets = [
            f"bodies.1.dofs.y=Pressure(value: Ramp(from: {-0.01 * pressure:e}, to: {-pressure:e}, start: 0.0, end: 0.15))",
            f"bodies.1.mass={2e4 * pressure / 2.5e5:e}",
            f"inertia_scaling={30 * pressure / 2.5e5:e}",
            "output.figures=false",
            "output.frames=0",
        ]
        for k in (0, 1):
            for name in ("cohesion", "tension"):
                sets.append(f"interfaces.{k}.parameters.contact.{name}={ratio * pressure:e}")
        words = [PROGRAM, "run", "cases/soft_third_body.ron", "--out", folder]
        for each in sets:
            words += ["--set", each]
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with open(f"{folder}/summary.json", encoding="utf-8") as file:
            s = json.load(file)
        layer = s["measures"]
        scatter = s["uncertainty"]["friction_coefficient"]["scatter"]
        scatter = "?" if scatter is None else f"{scatter:.3f}"
        strain = max(grain["strain"] for grain in s["small_strain"])
        print(
            f"{E / pressure:5.0f}  {ratio:4g}  {s['friction_coefficient']:.3f} +- {scatter}  {layer['layer_interior_shear']:10.2f}"
            f"  {layer['layer_slip_first_share']:12.2f} {layer['layer_slip_second_share']:.2f}  {layer['layer_solid_fraction']:14.3f}"
            f"  {strain:.3f}  {'; '.join(s['reasons'])[:60]}",
            flush=True,
        )
