"""Temperatures of the two surfaces of a sliding contact: a run of cases/surface_temperatures.ron beside a one-dimensional reference (docs/heat/surface_temperatures.md).

Variant B as an example, in bash: its options, from the head of the case, go to both runs (none for A). `fretwork` stands for `cargo run --release --` in a clone.
Other seeds (`--set seed=2` in the first run) go with the second run as it is.

    VARIANT="--set interfaces.inside.parameters.contact.mu=0.6 --set interfaces.lower.parameters.contact.mu=0.3"
    fretwork run cases/surface_temperatures.ron --out target/validation/B $VARIANT
    fretwork run cases/surface_temperatures.ron --out target/validation/B_conduction $VARIANT \\
        --set heat.shares.friction=0 --set heat.shares.viscous=0 --set heat.shares.impact=0 --set heat.shares.adhesion=0 \\
        --set heat.bodies.bottom.store=Fixed --set heat.bodies.top.store=Fixed --set heat.bodies.top.temperature=393.15
    python3 validation/surface_temperatures.py target/validation/B target/validation/B_conduction

Reference: half-space | layer | half-space, rho c dT/dt = d/dy(k dT/dy) + q(y, t), with a conductance h of contacts between each body and the layer. Of heat
made at contacts with a body e/(e + e_grain), e = sqrt(k rho c), goes to its surface, the rest to the face of the layer. k and h are measured in the second run,
in which friction makes no heat and the surfaces keep their temperatures; nothing is fitted to the first. Only for runs without `heat.clock`.
"""

import argparse
import csv
import math
import re
from pathlib import Path

MATERIALS = Path(__file__).resolve().parent.parent / "materials"
SLICES = 80  # of the layer, a multiple of the bins of layer_energy.csv
FIRST = 2e-7  # m, width of the cell of a half-space below its surface
GROWTH = 1.05  # of the next cell
EDGE = 0.12  # of the thickness at both faces of the layer, left out when its gradient of temperature is measured


def one(pattern, text):
    """The only group of a pattern in a text."""
    if found := re.search(pattern, text):
        return found.group(1)
    raise SystemExit(f"not found: {pattern}")


def case_of(folder):
    """The text of the case as it was run, `--set` applied, without comments: it stands in results.h5 as it is, between zero bytes."""
    data = (folder / "results.h5").read_bytes()
    middle = data.index(b"materials: {")
    return re.sub(r"//.*", "", data[data.rindex(b"\0", 0, middle) + 1 : data.index(b"\0", middle)].decode())


def scene_of(case):
    """What of a case is not of its heat or its output, without its seed."""
    return re.sub(r"\bseed: \d+", "", case[: case.index("heat: (")])


def material_of(role, case):
    """k in W/(m K) and rho c in J/(m^3 K) of the material that has a role ("oxide") in a case, from its file in `materials/`."""
    name = one(rf'"{role}": "([^"]+)"', one(r"materials: \{([^}]*)\}", case))
    text = (MATERIALS / f"{name}.ron").read_text(encoding="utf-8")
    conductivity, density, heat = (float(one(rf'\b{key}"?: \(value: ([^,)]+)', text)) for key in ("conductivity", "density", "heat_capacity"))
    return conductivity, density * heat


def columns(file):
    """Columns of numbers of a table, by their names without units."""
    with open(file, newline="") as lines:
        head, *rows = csv.reader(lines)
    return {name.split(" [")[0]: [float(v) for v in values] for name, values in zip(head, zip(*rows))}


def mean(values, times, start):
    """Mean of the values at times after a start."""
    those = [v for v, t in zip(values, times) if t > start]
    return sum(those) / len(those)


def conduction(folder, lower, upper, case):
    """Conductivity k = q/(dT/dy) of the layer (W/(m K)), conductances h = q/(jump at a face) to both bodies (W/(m^2 K)), while `across` is measured."""
    rows, across = columns(folder / "statistics.csv"), columns(folder / "across.csv")
    if rows["heat_dissipated"][-1] != 0:
        raise SystemExit(f"{folder}: friction makes heat")
    start, period = float(one(r"\bProfile\([^)]*start: ([^,)]+)", case)), float(one(r"periodic: \(x: ([^,)]+)", case))
    into_lower, into_upper, thickness = (mean(rows[name], rows["time"], start) for name in (f"{lower}_heat_flow", f"{upper}_heat_flow", "layer_thickness"))
    flux = (into_lower - into_upper) / 2 / period
    points = [(y, t) for y, t in zip(across["y"], across["temperature"]) if EDGE < y / thickness < 1 - EDGE and math.isfinite(t)]
    y0, t0 = (sum(v) / len(points) for v in zip(*points))
    slope = sum((y - y0) * (t - t0) for y, t in points) / sum((y - y0) ** 2 for y, _ in points)
    below = t0 - slope * y0 - rows[f"{lower}_temperature"][-1]
    above = rows[f"{upper}_temperature"][-1] - t0 - slope * (thickness - y0)
    return flux / slope, flux / below, flux / above


def shares_of_heat(folder, lower, upper, source):
    """Shares of the heat made at contacts with the lower body, with the upper one, and between grains in each bin of the layer."""
    with open(folder / "layer_energy.csv", newline="") as lines:
        heat = {row["place"]: float(row["total [J/m]"]) for row in csv.DictReader(lines)}
    first, second, inside = heat[f"{lower}_grain"], heat[f"{upper}_grain"], heat["grain_grain"]
    bins = [v for place, v in heat.items() if place.startswith("bin_")]
    if source == "one_surface":
        return float(first > second), float(first <= second), [0.0] * len(bins)
    if source == "even":
        return 0.0, 0.0, [1 / len(bins)] * len(bins)
    # The bins at the faces have the contacts with the bodies too.
    bins[0], bins[-1] = max(0.0, bins[0] - first), max(0.0, bins[-1] - second)
    whole = first + second + inside
    return first / whole, second / whole, [v / sum(bins) * inside / whole for v in bins]


def half_space(material, duration):
    """Widths of cells (m) from the surface, which is one of no width, to a depth of 8 sqrt(k t/(rho c))."""
    widths, (conductivity, capacity) = [0.0, FIRST], material
    while sum(widths) < 8 * math.sqrt(conductivity / capacity * duration):
        widths.append(widths[-1] * GROWTH)
    return widths


def solve(diagonal, beside, right):
    """A symmetric tridiagonal system, by elimination in place."""
    for i, b in enumerate(beside):
        diagonal[i + 1] -= b * b / diagonal[i]
        right[i + 1] -= b / diagonal[i] * right[i]
    right[-1] /= diagonal[-1]
    for i in reversed(range(len(beside))):
        right[i] = (right[i] - beside[i] * right[i + 1]) / diagonal[i]
    return right


def reference(bodies, grain, solid, thickness, layer, shares, steps):
    """Rise of both surfaces (K) and heat in both bodies (J/m^2) after steps of a time (s) and a heat made in it (J/m^2).

    Cells from below, those of no width are the surfaces of the bodies and the faces of the layer. Implicit in time: w rho c dT/dt = sum (T' - T)/R + q,
    with R = (w/k + w'/k')/2 between the middles of two cells, 1/h between a surface and a face (m^2 K/W).
    """
    conductivity, *conductances = layer
    below, above = (half_space(body, sum(time for time, _ in steps)) for body in bodies)
    slices = [0.0, *[thickness / SLICES] * SLICES, 0.0]
    parts = (below[::-1], bodies[0]), (slices, (conductivity, solid * grain[1])), (above, bodies[1])
    cells = [(w, *material) for widths, material in parts for w in widths]
    faces = len(below), len(below) + len(slices) - 1
    surfaces = faces[0] - 1, faces[1] + 1
    resistance = [(w1 / k1 + w2 / k2) / 2 for (w1, k1, _), (w2, k2, _) in zip(cells, cells[1:])]
    source = [0.0] * len(cells)
    for share, body, surface, face, h in zip(shares, bodies, surfaces, faces, conductances):
        part = 1 / (1 + math.sqrt(grain[0] * grain[1] / (body[0] * body[1])))
        source[surface], source[face] = share * part, share * (1 - part)
        resistance[min(surface, face)] = 1 / h
    many = SLICES // len(shares[2])
    source[faces[0] + 1 : faces[1]] = [v / many for v in shares[2] for _ in range(many)]
    capacity, rise = [w * c for w, _, c in cells], [0.0] * len(cells)
    for time, heat in steps:
        flow = [time / r for r in resistance]
        diagonal = [c + a + b for c, a, b in zip(capacity, [0.0, *flow], [*flow, 0.0])]
        rise = solve(diagonal, [-f for f in flow], [c * t + s * heat for c, t, s in zip(capacity, rise, source)])
    stored = [c * t for c, t in zip(capacity, rise)]
    return [rise[i] for i in surfaces], [sum(stored[: faces[0]]), sum(stored[surfaces[1] :])]


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("run", type=Path, help="folder of results")
    words.add_argument("conduction_run", type=Path, help="that of the same variant without heat, between surfaces of fixed temperatures")
    source = "of heat: as in the run, over time and across the layer; or constant power |Q| V, all at the surface that has most of it, or evenly in the layer"
    words.add_argument("--source", choices=["measured", "one_surface", "even"], default="measured", help=source)
    given = words.parse_args()
    case, still = case_of(given.run), case_of(given.conduction_run)
    if scene_of(case) != scene_of(still):
        raise SystemExit("the two runs must be of one case but for `seed` and `heat`: give the options of the variant to both")
    if still.count("store: Fixed") < 2:
        raise SystemExit("the conduction run must keep the temperatures of both surfaces: see the head of this script")
    if "clock:" in case + still:
        raise SystemExit("the runs must be without `heat.clock`")
    names = re.search(r'ThirdBody\([^)]*between: \("([^"]+)", "([^"]+)"\)', case).groups()
    bodies = [material_of(one(rf'name: "{name}",\s*material: "([^"]+)"', case), case) for name in names]
    grain = material_of(one(r'grains: \[\s*\w+\(material: "([^"]+)"', case), case)
    begin, slip, period = (float(one(p + r": ([^,)]+)", case)) for p in (r"\bheat: \([^()]*start", r"\bfriction: \([^)]*start", r"periodic: \(x"))
    layer = conduction(given.conduction_run, *names, still)
    times = (rows := columns(given.run / "statistics.csv"))["time"]
    # While the upper body slides.
    thickness, solid = (mean(rows[name], times, slip) for name in ("layer_thickness", "layer_solid_fraction"))
    power = mean([abs(q * v) for q, v in zip(rows["Q"], rows[f"{names[1]}_vx"])], times, slip)  # W/m
    heat = rows["heat_dissipated"] if given.source == "measured" else [power * time for time in times]
    steps = [(t1 - t0, (q1 - q0) / period) for t0, t1, q0, q1 in zip(times, times[1:], heat, heat[1:]) if t0 > begin - 1e-9]
    shares = shares_of_heat(given.run, *names, given.source)
    surfaces, stored = reference(bodies, grain, solid, thickness, layer, shares, steps)
    print(f"reference: heat {sum(q for _, q in steps) * period:.2f} J/m, {shares[0]:.0%} at the lower surface, {sum(shares[2]):.0%} inside, {shares[1]:.0%} at the upper")
    print(f"layer {1e6 * thickness:.1f} um, {layer[0]:.2f} W/(m K); {thickness / layer[0] + 1 / layer[1] + 1 / layer[2]:.2g} m^2 K/W from surface to surface\n")
    print(f"{'':33}{'run':>9}{'reference':>12}{'difference':>12}")
    for place, name, found in zip(("lower", "upper"), names, surfaces):
        measured = rows[f"{name}_temperature"][-1] - rows[f"{name}_temperature"][0]
        print(f"{place + ' surface, above the start (K)':33}{measured:9.1f}{found:12.1f}{measured - found:12.1f}")
    into = [sum(q * (b - a) for q, a, b in zip(rows[f"{name}_heat_flow"], [0.0, *times], times)) for name in names]
    for place, own, found in zip(("lower", "upper"), into, stored):
        print(f"{'heat into the ' + place + ' body (J/m)':33}{own:9.2f}{found * period:12.2f}{own - found * period:12.2f}")
    print(f"{'share of heat in the lower body':33}{into[0] / sum(into):9.3f}{stored[0] / sum(stored):12.3f}")


if __name__ == "__main__":
    main()
