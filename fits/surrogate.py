#!/usr/bin/env python3
"""A fit by a surrogate: efficient global optimisation with Gaussian processes (egobox) on runs of the program.

Where a run takes hours, a search should take few of them: egobox draws a response surface through the runs that are there and proposes the next where it
expects the largest improvement. Each proposal becomes a table of points of `fretwork study`, which runs them, keeps them, and makes none twice; the sum
of squares is that of `fretwork fit`.

Usage, from the root of the repository after `cargo build --release`: pip install egobox numpy pandas pyarrow; python3 fits/surrogate.py [RUNS]
"""
import pathlib
import subprocess
import sys

import egobox
import numpy as np
import pandas as pd

PROGRAM = pathlib.Path("target/release/fretwork")
OUT = pathlib.Path("results/surrogate")
PARAMETERS = {"mu_0": (0.1, 1.0), "a": (0.05, 0.95), "b": (np.log(0.1), np.log(10.0))}
KEYS = {name: f"interfaces.dry.parameters.contact.{name}" for name in PARAMETERS}

measured = pd.read_csv("fits/falling_friction.csv", comment="#")
measured.columns = [name.partition(" [")[0] for name in measured.columns]


def sums_of_squares(points):
    """Runs points (rows of mu_0, a, ln b) as a study, and compares their curves with the measured one."""
    OUT.mkdir(parents=True, exist_ok=True)
    values = pd.DataFrame({KEYS["mu_0"]: points[:, 0], KEYS["a"]: points[:, 1], KEYS["b"]: np.exp(points[:, 2])})
    values.to_csv(OUT / "points.csv", index=False)
    study = f"""(case: "{pathlib.Path.cwd()}/fits/cases/falling_friction.ron", factors: [], design: Table(file: "points.csv"),
        outputs: ["friction_coefficient"])"""
    (OUT / "study.ron").write_text(study)
    subprocess.run([PROGRAM, "study", "run", OUT / "study.ron", "--out", OUT / "study", "--jobs", "2"], check=True, capture_output=True)
    table = pd.read_parquet(OUT / "study" / "table.parquet")
    squares = []
    for _, run in table.iterrows():
        if run.status != "done":
            # egobox leaves out what is not a number.
            squares.append(np.nan)
            continue
        rows = pd.read_csv(OUT / "study" / "runs" / run.folder / "statistics.csv")
        rows.columns = [name.partition(" [")[0] for name in rows.columns]
        friction = np.interp(measured.velocity, rows.slider_vx, rows.mu)
        squares.append((((friction - measured.friction) / measured.uncertainty) ** 2).sum())
    return np.array(squares).reshape(-1, 1)


if __name__ == "__main__":
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 60
    first = 12
    search = egobox.Egor([list(limits) for limits in PARAMETERS.values()], n_doe=first, seed=1)
    # The root: sums of squares range over decades, which a Gaussian process with one length scale
    # does not follow.
    found = search.minimize(lambda points: np.sqrt(sums_of_squares(points)), max_iters=runs - first)
    result = getattr(found, "result", found)
    mu_0, a, ln_b = result.x_opt
    print(f"{runs} runs: mu_0 {mu_0:.3f}, a {a:.3f}, b {np.exp(ln_b):.3f} s/m, sum of squares {float(result.y_opt[0]) ** 2:.1f} for {len(measured)} values")
    print("planted: mu_0 0.5, a 0.3, b 0.9 s/m")
