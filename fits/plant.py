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

# By name: the case, its changes with the planted values, the curve as columns, the abscissae, the
# noise, the headings.
PLANTS = {
    "bond_opening": dict(
        case="cases/verification/bond_mode_1.ron",
        sets=["time.step=2e-8", "coupling=Midpoint", "output.every=1",
              "interfaces.grain.parameters.cohesion.c_n=1.5e12", "interfaces.grain.parameters.damage.w=0.08"],
        x=lambda r: 1e6 * (r["grip_y"] - 2 - 0.5 * 0.045 * 2e-8), y=lambda r: -1e-6 * r["grip_fy"] / 0.5,
        at=[0.02 * k for k in range(1, 16)] + [0.3 + 0.1 * k for k in range(1, 20)], noise=0.01,
        headings=("opening [um]", "traction [MPa]", "uncertainty [MPa]"), truth={"stiffness": 1.5e12, "energy": 0.08},
    ),
    "falling_friction": dict(
        case="fits/cases/falling_friction.ron",
        sets=["time.step=5e-5", "output.every=5", "interfaces.dry.parameters.contact.mu_0=0.5", "interfaces.dry.parameters.contact.a=0.3",
              "interfaces.dry.parameters.contact.b=0.9"],
        x=lambda r: r["slider_vx"], y=lambda r: r["mu"], at=[0.1 * k for k in range(1, 40)], noise=0.01,
        headings=("velocity [m/s]", "friction", "uncertainty"), truth={"mu_0": 0.5, "a": 0.3, "b": 0.9},
    ),
    "fretting_loop": dict(
        case="fits/cases/fretting_loop.ron",
        sets=["time.step=1.25e-6", "output.every=16", "interfaces.dry.parameters.contact.ratio=0.7", "interfaces.dry.parameters.contact.mu=0.6"],
        # The second cycle by its path; the measured loop is told in um and N, in the order in which
        # it is run through.
        loop=True, x=lambda r: 1e6 * r["delta"], y=lambda r: r["Q"], at=[0.25 + 0.5 * k for k in range(39)], noise=15.0,
        headings=("displacement [um]", "force [N/m]", "uncertainty [N/m]"), truth={"ratio": 0.7, "friction": 0.6},
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
    if plant.get("loop"):
        rows = [r for r in rows if r["cycle"] == 2]
        return along_path([(plant["x"](r), plant["y"](r)) for r in rows])
    points = [(plant["x"](r), plant["y"](r), plant["x"](r)) for r in rows]
    return [p for k, p in enumerate(points) if k == 0 or p[0] > points[k - 1][0]]


def along_path(points):
    """Points with the path along the abscissa first, and the abscissa last."""
    path, out, last = 0.0, [], points[0][0]
    for x, y in points:
        path, last = path + abs(x - last), x
        if not out or path > out[-1][0]:
            out.append((path, y, x))
    return out


def interpolate(points, x):
    for (x0, y0, a0), (x1, y1, a1) in zip(points, points[1:]):
        if x0 <= x <= x1:
            share = (x - x0) / (x1 - x0)
            return a0 + (a1 - a0) * share, y0 + (y1 - y0) * share
    raise SystemExit(f"{x} lies outside the curve, {points[0][0]} to {points[-1][0]}")


def noisy(plant, points, seed):
    noise = random.Random(seed)
    rows = []
    if plant.get("loop"):
        rows.append((points[0][2], points[0][1] + noise.gauss(0, plant["noise"]), plant["noise"]))
    for x in plant["at"]:
        abscissa, value = interpolate(points, x)
        rows.append((abscissa, value + noise.gauss(0, plant["noise"]), plant["noise"]))
    return rows


def write(name, seed, path, points=None):
    chosen = PLANTS[name]
    headings, rows = chosen["headings"], noisy(chosen, points or curve(chosen), seed)
    with open(path, "w", newline="") as file:
        file.write(f"# planted: fits/plant.py {name} {seed}\n")
        table = csv.writer(file, lineterminator="\n")
        table.writerow(headings)
        table.writerows([f"{value:.6g}" for value in row] for row in rows)


if __name__ == "__main__":
    name = sys.argv[1]
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    write(name, seed, sys.argv[3] if len(sys.argv) > 3 else f"fits/{name}.csv")
