#!/usr/bin/env python3
"""The creep curve of an elliptic contact of wheel and rail: Q/(mu P) against creepage, beside the reference output of CONTACT.

Runs cases/verification/elastic/creep_curve.ron (106.7 kN, mu 0.33, G 82 GPa, nu 0.28, R 625 mm along the rolling direction, a/b 0.5) with a number of
cells over each half-axis; a step rolls by a share of a cell, and the contact rolls by 12 half-axes. From the root of the repository, after
`cargo build --release`:

    python3 docs/creep_curve.py                      # 12 cells, half a cell a step: three minutes a point
    python3 docs/creep_curve.py --cells 6 --step 1   # seconds
    python3 docs/creep_curve.py FOLDER

Prints for each creepage Q/(mu P), CONTACT's, the difference, how much it changed over the last half-axis rolled, and the processor time.

Reference: the output of CONTACT (E. A. H. Vollebregt) for its example of this contact.
"""
import argparse
import csv
import json
import math
import os
import subprocess

LOAD, MU, A, B = 106.7e3, 0.33, 6.304e-3, 12.608e-3
CONTACT = ((0.04, 0.2588), (0.12, 0.6482), (0.20, 0.8816), (0.28, 0.9832))
PROGRAM = os.environ.get("FRETWORK", "target/release/fretwork")

words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
words.add_argument("folder", nargs="?", default="results/creep_curve")
words.add_argument("--cells", type=int, default=12, help="cells over each half-axis")
words.add_argument("--step", type=float, default=0.5, help="cells that a step rolls by, at most 1")
words.add_argument("--rolled", type=float, default=12.0, help="half-axes rolled")
words = words.parse_args()


def force(creepage):
    """Q/(mu P) at the end and half an axis before, and the processor time (s)."""
    # Cells reach an eighth of the half-axes beyond the ellipse.
    wide = math.ceil(1.125 * words.cells)
    size = (A / words.cells, B / words.cells)
    folder = f"{words.folder}/{words.cells}_{words.step:g}_{creepage:g}"
    sets = [f"time.step={size[0] * words.step:e}", f"time.end={words.rolled * A:e}", f"half_spaces.1.rolling=Constant({1 + creepage / 100})"]
    for body in (0, 1):
        for axis, length in zip("xy", size):
            sets.append(f"half_spaces.{body}.{axis}=(from: {-wide * length:e}, to: {wide * length:e}, size: {length:e})")
    sets += ["output.every=1", "output.views=0", "output.figures=false"]
    call = [PROGRAM, "run", "cases/verification/elastic/creep_curve.ron", "--out", folder, "--force"]
    for each in sets:
        call += ["--set", each]
    subprocess.run(call, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(f"{folder}/statistics.csv", encoding="utf-8") as file:
        rows = [abs(float(row["wheel_holder_fx [N]"])) / (MU * LOAD) for row in csv.DictReader(file)]
    with open(f"{folder}/summary.json", encoding="utf-8") as file:
        seconds = json.load(file)["cpu_seconds"]
    back = math.ceil(words.cells / words.step)
    return rows[-1], rows[-1 - back], seconds


print("creepage (%)  Q/(mu P)  CONTACT  off (%)  changed over the last half-axis (%)  processor time (s)")
for creepage, reference in CONTACT:
    found, before, seconds = force(creepage)
    off = 100 * (found / reference - 1)
    print(f"{creepage:12.2f}  {found:8.4f}  {reference:7.4f}  {off:7.2f}  {100 * (found / before - 1):35.2f}  {seconds:18.0f}", flush=True)
