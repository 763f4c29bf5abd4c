#!/usr/bin/env python3
"""Makes a measured curve with known parameters: runs a case, takes a curve of its statistics at some places, adds noise.

Usage: fits/plant.py NAME [SEED [FILE]], from the root of the repository after `cargo build --release`; NAME is one of the plants below.
The curves of fits/*.csv were made with seed 1.
"""
import csv
import pathlib
import random
import subprocess
import sys
import tempfile

PROGRAM = pathlib.Path("target/release/fretwork")

# By name: the case, its changes with the planted values, the curve as columns, the abscissae, the noise, the headings.
PLANTS = {
    "bond_opening": dict(
        case="cases/verification/bond_mode_1.ron",
        sets=["time.step=2e-8", "coupling=Midpoint", "output.every=1",
              "interfaces.grain.parameters.cohesion.c_n=1.5e12", "interfaces.grain.parameters.damage.w=0.08"],
        x=lambda r: 1e6 * (r["grip_y"] - 2), y=lambda r: -1e-6 * r["grip_fy"] / 0.5,
        at=[0.02 * k for k in range(1, 16)] + [0.3 + 0.1 * k for k in range(1, 20)], noise=0.01,
        headings=("opening [um]", "traction [MPa]", "uncertainty [MPa]"),
    ),
}


def curve(plant):
    with tempfile.TemporaryDirectory() as folder:
        command = [PROGRAM, "run", plant["case"], "--out", folder, "--json", "--no-report"]
        for change in plant["sets"] + ["output.figures=false", "output.frames=0", "output.views=0"]:
            command += ["--set", change]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        with open(pathlib.Path(folder) / "statistics.csv") as file:
            rows = [{k.partition(" [")[0]: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    points = [(plant["x"](r), plant["y"](r)) for r in rows]
    return [p for k, p in enumerate(points) if k == 0 or p[0] > points[k - 1][0]]


def interpolate(points, x):
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x0 <= x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    raise SystemExit(f"{x} lies outside the curve, {points[0][0]} to {points[-1][0]}")


def plant(name, seed):
    chosen = PLANTS[name]
    points = curve(chosen)
    noise = random.Random(seed)
    return chosen["headings"], [(x, interpolate(points, x) + noise.gauss(0, chosen["noise"]), chosen["noise"]) for x in chosen["at"]]


def write(name, seed, path):
    headings, rows = plant(name, seed)
    with open(path, "w", newline="") as file:
        file.write(f"# planted: fits/plant.py {name} {seed}\n")
        table = csv.writer(file, lineterminator="\n")
        table.writerow(headings)
        table.writerows([f"{value:.6g}" for value in row] for row in rows)


if __name__ == "__main__":
    name = sys.argv[1]
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    write(name, seed, sys.argv[3] if len(sys.argv) > 3 else f"fits/{name}.csv")
