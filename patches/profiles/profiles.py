"""Writes the standard profiles of this folder from the formulas of their drawings.

s1002.csv: a new wheel, S1002 of EN 13715 and UIC 510-2: a line, two polynomials, three circles and a line, in their order from the
rim to the back of the flange. Flange of 32.5 mm, flange height 28 mm, tape circle at y = 0.

60e1.csv: a new rail head, 60E1 of EN 13674-1 (UIC 60): arcs of 300, 80 and 13 mm with common tangents, which end 20.456, 52.053 and
72 mm apart, and a side of 20:1, symmetric. The top of the head is at y = 0. Construction as in the manual of the program GENSYS
(gensys.se, create_UIC60).

y points away from the middle of the track, z upwards. Run as ``python3 patches/profiles/profiles.py`` in the folder of the project.
"""

from __future__ import annotations

from collections.abc import Callable
from math import asin, cos, hypot, sin, sqrt
from pathlib import Path

COARSE, FINE = 0.05, 0.025
BACK, RIM = -69.0, 60.0

TREAD = (
    0.0, -3.358537058e-02, 1.565681624e-03, -2.810427944e-05, 5.844240864e-08, -1.562379023e-08, 5.309217349e-15, -5.957839843e-12,
    2.646656573e-13,
)
ROOT = (
    -4.320221063e03, -1.038384026e03, -1.065501873e02, -6.051367875, -2.054332446e-01, -4.169739389e-03, -4.687195829e-05,
    -2.252755540e-07,
)


def polynomial(coefficients: tuple[float, ...], y: float) -> float:
    value = 0.0
    for c in reversed(coefficients):
        value = value * y + c
    return value


def s1002(y: float) -> float:
    """Height of the tread (mm) at a place (mm), downwards from the tape circle."""
    if y >= 32.15796:
        return 1.364323640 - y / 15.0
    if y >= -26.0:
        return polynomial(TREAD, y)
    if y >= -35.0:
        return polynomial(ROOT, y)
    if y >= -38.426669071:
        return 16.446 - sqrt(13.0**2 - (y + 26.210665) ** 2)
    if y >= -39.764473993:
        return -93.576667419 - 2.747477419 * y
    if y >= -49.662510381:
        return 8.834924130 + sqrt(20.0**2 - (y + 58.558326413) ** 2)
    if y >= -62.764705882:
        return 16.0 + sqrt(12.0**2 - (y + 55.0) ** 2)
    return 9.519259302 + sqrt(20.5**2 - (y + 49.5) ** 2)


def rail_60e1(y: float) -> float:
    """Height of the head (mm) at a place (mm), downwards from its top."""
    large, middle, small = 300.0, 80.0, 13.0
    ends = (20.456 / 2.0, 52.053 / 2.0, 72.0 / 2.0)
    angle = asin(ends[0] / large)
    second = ((large - middle) * sin(angle), large - (large - middle) * cos(angle))
    angle = asin((ends[1] - second[0]) / middle)
    third = (second[0] + (middle - small) * sin(angle), second[1] - (middle - small) * cos(angle))
    y = abs(y)
    if y <= ends[0]:
        return large - sqrt(large**2 - y**2)
    if y <= ends[1]:
        return second[1] - sqrt(middle**2 - (y - second[0]) ** 2)
    side = min(y, ends[2])
    return third[1] - sqrt(small**2 - (side - third[0]) ** 2) + 20.0 * (y - side)


def along(profile: Callable[[float], float], start: float, end: float, step: Callable[[float], float]) -> list[tuple[float, float]]:
    """Returns places and heights of a profile, upwards, in steps along it."""
    rows, y = [], start
    while y < end:
        rows.append((y, -profile(y)))
        slope = (profile(y + 1e-6) - profile(y - 1e-6)) / 2e-6
        y += step(y) / hypot(1.0, slope)
    return [*rows, (end, -profile(end))]


def write(name: str, head: list[str], rows: list[tuple[float, float]]) -> None:
    lines = [*(f"# {line}" for line in head), "y [mm],z [mm]", *(f"{y:.7f},{z:.7f}" for y, z in rows)]
    Path(__file__).with_name(name).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    wheel = along(s1002, BACK, RIM, lambda y: FINE if y < -26.0 else COARSE)
    head = ["Wheel S1002 (EN 13715), new, by profiles.py; y away from the middle of the track from the tape circle, z upwards."]
    write("s1002.csv", head, wheel)
    rail = along(rail_60e1, 0.0, 36.25, lambda y: FINE if y > 25.0 else COARSE)
    rail = [*((-y, z) for y, z in reversed(rail[1:])), *rail]
    write("60e1.csv", ["Rail head 60E1 (EN 13674-1), new, by profiles.py; y across from the middle of the head, z upwards."], rail)
