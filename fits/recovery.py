#!/usr/bin/env python3
"""Whether fits find planted parameters again within the intervals that they state.

Usage: fits/recovery.py [REPETITIONS [NAME...]], from the root of the repository after `cargo build --release`. For each fit of fits/plant.py it makes measured
curves with noise of seeds 1 to REPETITIONS (20), fits each, and counts how often the intervals hold the planted values: those of single parameters, and
the simultaneous ones, which are to hold all of them at once in 95 %. Runs are shared by the repetitions of a fit. Exit code 1 if the simultaneous intervals of
a fit hold in fewer than 19 of 20.
"""
import json
import pathlib
import subprocess
import sys

import plant

repetitions = int(sys.argv[1]) if len(sys.argv) > 1 else 20
names = sys.argv[2:] or list(plant.PLANTS)
good = True
for name in names:
    folder = pathlib.Path("results/recovery") / name
    folder.mkdir(parents=True, exist_ok=True)
    text = pathlib.Path(f"fits/{name}.ron").read_text()
    truth, points = plant.PLANTS[name]["truth"], plant.curve(plant.PLANTS[name])
    alone, together, evaluations = {key: 0 for key in truth}, 0, 0
    for seed in range(1, repetitions + 1):
        csv = folder / f"measured_{seed}.csv"
        plant.write(name, seed, csv, points)
        fit = folder / f"{name}_{seed}.ron"
        root = pathlib.Path.cwd()
        fit.write_text(text.replace(f'"{name}.csv"', f'"{csv.name}"').replace('"cases/', f'"{root}/fits/cases/').replace('"../cases/', f'"{root}/cases/'))
        command = [plant.PROGRAM, "fit", fit, "--out", folder / str(seed), "--cache", folder / "runs", "--jobs", "2", "--json"]
        told = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
        found = {p["name"]: p for p in told["parameters"]}
        hold = {key: found[key]["low"] <= value <= found[key]["high"] for key, value in truth.items()}
        for key in truth:
            alone[key] += hold[key]
        together += all(found[key]["simultaneous_low"] <= value <= found[key]["simultaneous_high"] for key, value in truth.items())
        evaluations += told["evaluations"]
        print(name, seed, " ".join(f"{key} {found[key]['value']:.4g} ({found[key]['low']:.4g} to {found[key]['high']:.4g})" for key in truth), flush=True)
    single = ", ".join(f"{key} {count}" for key, count in alone.items())
    print(f"{name}: all at once {together} of {repetitions}; alone: {single}; {evaluations / repetitions:.0f} points a fit", flush=True)
    good = good and together >= 0.95 * repetitions - 1e-9
sys.exit(0 if good else 1)
