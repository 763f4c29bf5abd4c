#!/usr/bin/env python3
"""The fretting map of a sphere on a flat: regime, Q/(mu P), A = E_d/(4 Q delta) and the energy of a loop against displacement and load.

Runs cases/sphere_on_flat_fretting.ron at three loads and displacements from a quarter to four times that of the end of partial slip, delta*, and
prints a line a run with the closed forms of Mindlin and Deresiewicz beside. From the root of the repository, after `cargo build --release`:

    python3 docs/fretting_map.py [FOLDER]        # three minutes

Sources: K. L. Johnson, "Contact Mechanics" (1985), sections 7.2 and 7.4; S. Fouvry, Ph. Kapsa, L. Vincent, Wear 185 (1995) 35: A is 0.2
at the end of partial slip.
"""
import json
import math
import os
import subprocess
import sys

G, NU, MU, R = 82e9, 0.28, 0.6, 0.05
MODULUS = 2 * G * (1 + NU) / (2 * (1 - NU**2))
PROGRAM = os.environ.get("FRETWORK", "target/release/fretwork")
out = sys.argv[1] if len(sys.argv) > 1 else "results/fretting_map"


def closed_forms(load, delta):
    """Q/(mu P), and the energy of a loop (J), of an amplitude."""
    a = (3 * load * R / (4 * MODULUS)) ** (1 / 3)
    limit = 3 * MU * load * (2 - NU) / (8 * G * a)
    share = 1 - max(0.0, 1 - delta / limit) ** 1.5
    rest = 1 - share
    loop = 1.8 * (MU * load) ** 2 * (2 - NU) / (a * G)
    loop *= 1 - rest ** (5 / 3) - 5 * share / 6 * (1 + rest ** (2 / 3))
    return limit, share, loop + 4 * MU * load * max(0.0, delta - limit)


print("load (N)  delta (um)  delta/delta*  Q/(mu P), closed form  A      loop (uJ), closed form  regime")
for load in (50.0, 99.52, 150.0):
    limit = closed_forms(load, 0.0)[0]
    for ratio in (0.25, 0.5, 0.75, 1.0, 1.25, 2.0, 4.0):
        delta = ratio * limit
        folder = f"{out}/{load:g}_{ratio:g}"
        sets = [
            f"half_spaces.1.dofs.x=Displacement(Sine(amplitude: {delta:e}, frequency: 20.0, start: 0.01))",
            f"half_spaces.1.dofs.z=Force(Ramp(from: 0.0, to: {-load:e}, start: 0.0, end: 8e-3))",
            "output.views=0",
            "output.figures=false",
        ]
        words = [PROGRAM, "run", "cases/sphere_on_flat_fretting.ron", "--out", folder]
        for each in sets:
            words += ["--set", each]
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with open(f"{folder}/summary.json", encoding="utf-8") as file:
            cycle = json.load(file)["cycles"][-1]
        _, share, loop = closed_forms(load, delta)
        found = cycle["tangential_amplitude"] / (MU * cycle["normal_force"])
        print(
            f"{load:8.2f}  {delta * 1e6:10.3f}  {ratio:12.2f}  {found:8.4f}  {share:11.4f}  {cycle['energy_ratio']:5.3f}"
            f"  {cycle['work'] * 1e6:9.3f}  {loop * 1e6:11.3f}  {cycle['regime']}",
            flush=True,
        )
