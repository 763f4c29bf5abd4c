#!/usr/bin/env python3
"""What a run says of friction near the end of partial slip: the verdict, Q*/(mu P) and the coefficient of sliding against the displacement.

Runs the sphere and the cylinder on a flat of docs/fretting_map.py at one load and displacements from 0.6 to 3 times that of the end of partial slip,
delta*. By the closed forms nothing slides as a whole below delta*, and the coefficient is mu above it. A line ends with what is wrong: a coefficient
below delta*, none above it, one that differs from mu by more than 2 %, or a regime that is not that of the closed form. Within 5 % of delta* the
cells decide, and "near" says so. From the root of the repository, after `cargo build --release`:

    python3 docs/dev/transition.py [FOLDER]            # sphere, a minute and a half
    python3 docs/dev/transition.py --cylinder [FOLDER] # five minutes
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from fretting_map import MU, Cylinder, Sphere, summary  # noqa: E402

RATIOS = (0.6, 0.85, 0.95, 1.0, 1.05, 1.15, 1.4, 2.0, 3.0)


def wrong(ratio, coefficient, regime):
    """What is wrong with a verdict."""
    slides = ratio > 1
    found = []
    if coefficient is None and slides:
        found.append("no coefficient, though it slides")
    if coefficient is not None and not slides:
        found.append("a coefficient, though it does not slide")
    if coefficient is not None and abs(coefficient / MU - 1) > 0.02:
        found.append(f"{100 * (coefficient / MU - 1):+.1f} % of mu")
    if (regime == "gross") != slides:
        found.append(f"regime {regime}")
    near = ["near"] if found and abs(ratio - 1) <= 0.05 else []
    return ", ".join(near + found)


def main():
    words = sys.argv[1:]
    shape = Cylinder if "--cylinder" in words else Sphere
    words = [w for w in words if w != "--cylinder"]
    shape.out = words[0] if words else f"results/transition_{shape.__name__.lower()}"
    load = shape.loads[1]
    closed = shape(load)
    print("delta/delta*  Q*/(mu P), closed form  slip ratio     A  coefficient  regime   wrong")
    for ratio in RATIOS:
        delta = ratio * closed.limit
        found = summary(closed, load, delta, f"{shape.out}/{ratio:g}")
        cycle, coefficient = found["cycles"][-1], found["friction_coefficient"]
        regime = (found["fretting"] or {}).get("regime")
        share = cycle["tangential_amplitude"] / (MU * cycle["normal_force"])
        shown = "none" if coefficient is None else f"{coefficient:.4f}"
        print(
            f"{ratio:12.2f}  {share:9.4f}  {closed.share(delta):11.4f}  {cycle['slip_ratio']:10.3f}  {cycle['energy_ratio']:4.3f}"
            f"  {shown:>11}  {regime!s:7}  {wrong(ratio, coefficient, regime)}",
            flush=True,
        )


if __name__ == "__main__":
    main()
