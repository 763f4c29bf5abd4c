"""Two blocks of bonded disks whose asperities are joined by a junction are slid past each other: a particle, or a junction that shears?

    python3 validation/smallest_particle.py --program target/release/fretwork --out target/validation/smallest_particle

Writes a case for each size of the junction, ductility ratio and packing, runs it (a finished run is not made again), reads the last
state from `results.h5` (needs h5py) and prints a table of the runs, and one of all runs in the folder that have the same travel, speed and
step; writes their outcomes to `table.csv` in that folder, from which the page of the validation is made. A changed constant below needs another folder.
"""

import argparse
import csv
import functools
import json
import math
import random
import subprocess
import sys
from pathlib import Path

DIAMETER = 1e-3  # d, m
SPREAD = 0.2  # of the radii, to both sides
DENSITY = 2500.0  # kg/m^3, of materials/glass_bead.ron
MODULUS = 1e6  # K, N/m of a bond per metre of depth: k d, and the stiffness of contacts
STRAIN = 0.01  # s/(k d): strength of a bond over its stiffness, in diameters
FRICTION = 0.3
DAMPING = 0.0  # of a bond, of the critical damping of two grains
LOAD = 0.05  # normal force over s D
WIDTH = 2.5  # of a block (the period), in D
DEPTH = 0.75  # of a block, in D
HEIGHT = 0.5  # of both asperities together, in D
FOOT = 1.25  # width of the joined asperities where they meet the blocks, in D
SOLID = 0.84  # solid fraction before the radii are fitted

TURNED = 0.1  # rad: a grain that turns with its neighbours by more than this moves with neither block
PARTICLE = 0.5  # D^2: a piece that is at least so large is a particle; both asperities together have 0.56 D^2
CARRIED = 0.25  # D^2: as much of one side has gone with the other; an asperity has 0.28 D^2

WAVE = math.sqrt(MODULUS / DENSITY)


def pairs_near(x, y, width, height, reach):
    """Pairs closer than `reach` in a cell that is periodic both ways."""
    def near(i, j):
        dx, dy = x[i] - x[j], y[i] - y[j]
        dx -= width * round(dx / width)
        dy -= height * round(dy / height)
        return dx * dx + dy * dy < reach * reach

    nx, ny = max(1, int(width / reach)), max(1, int(height / reach))
    if nx < 3 or ny < 3:
        return [(i, j) for i in range(len(x)) for j in range(i) if near(i, j)]
    cells = {}
    for i in range(len(x)):
        key = (int(x[i] / width * nx) % nx, int(y[i] / height * ny) % ny)
        cells.setdefault(key, []).append(i)
    found = []
    for (cx, cy), own in cells.items():
        for ox, oy in ((0, 0), (1, 0), (-1, 1), (0, 1), (1, 1)):
            other = cells.get(((cx + ox) % nx, (cy + oy) % ny), ())
            for i in own:
                for j in other:
                    if ((ox, oy) != (0, 0) or j < i) and near(i, j):
                        found.append((i, j))
    return found


def packing(width, height, seed):
    """Disks of mean diameter 1 at random, pushed apart until they hardly overlap; then the radii shrink until none does."""
    rng = random.Random(seed)
    mean_area = math.pi / 4 * (1 + SPREAD**2 / 3)
    count = round(SOLID * width * height / mean_area)
    radius = [0.5 * (1 + SPREAD * (2 * (k + 0.5) / count - 1)) for k in range(count)]
    rng.shuffle(radius)
    x = [rng.uniform(0, width) for _ in range(count)]
    y = [rng.uniform(0, height) for _ in range(count)]
    vx, vy = [0.0] * count, [0.0] * count
    step, alpha, downhill = 0.1, 0.1, 0
    near, moved = [], 1e9
    for sweep in range(2000):
        if moved > 0.15:
            near, moved = pairs_near(x, y, width, height, 1 + SPREAD + 0.3), 0.0
        fx, fy = [0.0] * count, [0.0] * count
        energy, deepest = 0.0, 0.0
        for i, j in near:
            dx, dy = x[i] - x[j], y[i] - y[j]
            if dx > 0.5 * width:
                dx -= width
            elif dx < -0.5 * width:
                dx += width
            if dy > 0.5 * height:
                dy -= height
            elif dy < -0.5 * height:
                dy += height
            reach = radius[i] + radius[j]
            square = dx * dx + dy * dy
            if square < reach * reach:
                distance = math.sqrt(square) or 1e-9
                overlap = reach - distance
                energy += overlap * overlap
                deepest = max(deepest, overlap)
                fx[i] += overlap * dx / distance
                fy[i] += overlap * dy / distance
                fx[j] -= overlap * dx / distance
                fy[j] -= overlap * dy / distance
        if deepest < 0.003:
            break
        # FIRE (E. Bitzek et al., Phys. Rev. Lett. 97 (2006) 170201)
        power = sum(a * b for a, b in zip(fx, vx)) + sum(a * b for a, b in zip(fy, vy))
        if power > 0:
            force = math.sqrt(sum(a * a for a in fx) + sum(a * a for a in fy)) or 1.0
            speed = math.sqrt(sum(a * a for a in vx) + sum(a * a for a in vy))
            for v, f in ((vx, fx), (vy, fy)):
                for i in range(count):
                    v[i] = (1 - alpha) * v[i] + alpha * speed * f[i] / force
            downhill += 1
            if downhill > 5:
                step, alpha = min(1.1 * step, 1.0), 0.99 * alpha
        else:
            vx, vy = [0.0] * count, [0.0] * count
            step, alpha, downhill = 0.5 * step, 0.1, 0
        largest = 0.0
        for i in range(count):
            vx[i] += step * fx[i]
            vy[i] += step * fy[i]
            x[i] += step * vx[i]
            y[i] += step * vy[i]
            largest = max(largest, abs(vx[i]), abs(vy[i]))
        for i in range(count):
            x[i] %= width
            y[i] %= height
        moved += 2 * step * largest
    radius = [r * (1 - 1.001 * deepest) for r in radius]
    return x, y, radius


@functools.lru_cache(maxsize=4)
def grains(size, seed):
    """Grains of the two blocks and their bases: (x, y, radius), the middle of the junction at (width/2, 0)."""
    width = WIDTH * size
    top = (DEPTH + 0.5 * HEIGHT) * size
    half = top + 1.5  # a base is 1.5 d thick
    x, y, radius = packing(width, 2 * half + 0.5, seed)
    free, lower, upper = [], [], []
    for px, py, r in zip(x, y, radius):
        py -= half
        if py > half:
            continue
        if abs(py) > top:
            (upper if py > 0 else lower).append((px, py, r))
            continue
        high = 0.5 * HEIGHT * size
        if abs(py) < high:
            reach = 0.5 * size * (1 + (FOOT - 1) * abs(py) / high)
            if abs(px - 0.5 * width) > reach:
                continue
        free.append((px, py, r))
    return width, top, free, lower, upper


def case(folder, size, ratio, seed, travel, speed, step):
    """Writes a case into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    width, top, free, lower, upper = grains(size, seed)
    d = DIAMETER
    with open(folder / "grains.csv", "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["x", "y", "radius"])
        out.writerows([f"{v * d:.9g}" for v in g] for g in free)
    stiffness = MODULUS / d
    strength = STRAIN * MODULUS
    energy = ratio * strength**2 / stiffness
    opening = 2 * energy / strength
    mass = DENSITY * math.pi / 4 * d * d
    damping = DAMPING * 2 * math.sqrt(MODULUS * 0.5 * mass) / d
    velocity = speed * WAVE
    h = step * d / WAVE
    ramp = 0.05 * size * d / velocity
    end = travel * size * d / velocity + 0.5 * ramp
    balls = lambda those: ", ".join(f"([{x * d:.9g}, {y * d:.9g}], {r * d:.9g})" for x, y, r in those)
    contact = f'{{"stiffness": {MODULUS}, "ratio": 0.8, "restitution": 0.1, "mu": {FRICTION}}}'
    bond = f'{{"k_n": {stiffness}, "k_t": {stiffness}, "d_n": {damping}, "d_t": {damping}}}'
    rows = max(1, round(end / h / 1000))
    (folder / "case.ron").write_text(f"""// Written by validation/smallest_particle.py.
(
    name: "junction of {size} grains",
    dimension: 2,
    time: (step: {h}, end: {end}),
    periodic: (x: {width * d}),
    detection: (alert: {max(0.1 * d, 1.2 * opening)}, skin: {0.2 * d}),
    materials: {{"grain": "glass_bead", "base": "glass_bead"}},
    interfaces: [
        (name: "solid", between: ("grain", "grain"), contact: "linear-contact", cohesion: "elastic-bond", damage: "linear-softening",
         parameters: (contact: {contact}, cohesion: {bond}, damage: {{"strength": {strength}, "energy": {energy}}}),
         bonds: Start, bonds_within: {0.1 * d}, area_factor: 4.0),
        (name: "held", between: ("base", "grain"), contact: "linear-contact", cohesion: "elastic-bond",
         parameters: (contact: {contact}, cohesion: {bond}), bonds: Start, bonds_within: {0.1 * d}, area_factor: 4.0),
    ],
    bodies: [
        (name: "lower", material: "base", shapes: [Balls([{balls(lower)}])]),
        (name: "upper", material: "base", shapes: [Balls([{balls(upper)}])],
         dofs: (x: Velocity(Ramp(from: 0.0, to: {velocity}, start: 0.0, end: {ramp})), y: Force({-LOAD * strength * size * d}))),
    ],
    grains: [Csv(file: "grains.csv", material: "grain")],
    friction: (body: "upper", along: 0, normal: 1),
    circuit: (bases: ["lower", "upper"], bonds: ["solid", "held"], start: {10 * h}),
    uncertainty: (repeats: 0),
    output: (frames: 6, views: 11, every: {rows}, checkpoint: Never),
)
""")


def state(file, index):
    """Grains (identity: x, y, radius) and contacts (two identities, whether the bond is unbroken) of a recorded state."""
    def part(view, kind, names):
        group = file["views"][view]
        begin = int(group["Steps/" + kind + "Offsets"][names[0]][index])
        count = int(group["NumberOfPoints" if kind == "PointData" else "Lines/NumberOfCells"][index])
        return [group[kind][name][begin : begin + count] for name in names]

    grains_view = file["views/grains"]
    begin = int(grains_view["Steps/PointOffsets"][index])
    places = grains_view["Points"][begin : begin + int(grains_view["NumberOfPoints"][index])]
    identity, radius, first = part("grains", "PointData", ["id", "radius", "first_body"])
    disks = {int(i): (float(p[0]), float(p[1]), float(r)) for i, p, r, f in zip(identity, places, radius, first) if not f}
    one, two, bond = part("contacts", "CellData", ["body_1", "body_2", "state"])
    return disks, [(int(a), int(b)) for a, b, s in zip(one, two, bond) if s == 1]


def outcome(folder, size):
    """What became of the junction: numbers, areas over that of a square of material as wide as the junction."""
    import h5py

    summary = json.loads((folder / "out/summary.json").read_text())
    width = WIDTH * size * DIAMETER
    square = SOLID * (size * DIAMETER) ** 2
    with h5py.File(folder / "out/results.h5") as file:
        last = len(file["views/grains/NumberOfPoints"]) - 1
        before, made = state(file, 0)
        after, bonds = state(file, last)
        broken = file["events/broken"]
        weight, height = 0.0, 0.0
        for a, b, e in zip(broken["body_1"][:], broken["body_2"][:], broken["fracture"][:]):
            if int(a) in before and int(b) in before:
                weight += float(e)
                height += float(e) * abs(before[int(a)][1] + before[int(b)][1]) / 2
        force = [abs(float(v)) for v in file["statistics/Q"][:]]
        places = file["statistics/upper_x"]
        travel = float(places[-1] - places[0])
    # Rotation of a grain with those that it is still bonded to.
    wrap = lambda v: v - width * round(v / width)
    sums = {i: [0.0, 0.0, 0] for i in after}
    for a, b in bonds:
        if a in after and b in after:
            x0, y0 = wrap(before[a][0] - before[b][0]), before[a][1] - before[b][1]
            x1, y1 = wrap(after[a][0] - after[b][0]), after[a][1] - after[b][1]
            for i in (a, b):
                sums[i][0] += x0 * x1 + y0 * y1
                sums[i][1] += x0 * y1 - y0 * x1
                sums[i][2] += 1
    turned = {i for i, (c, s, n) in sums.items() if n >= 2 and abs(math.atan2(s, c)) > TURNED}
    area = lambda those: sum(math.pi * after[i][2] ** 2 for i in those) / square
    def groups(members):
        near = {i: [] for i in members}
        for a, b in bonds:
            if a in members and b in members:
                near[a].append(b)
                near[b].append(a)
        found, seen = [], set()
        for i in members:
            if i in seen:
                continue
            group, queue = [], [i]
            seen.add(i)
            while queue:
                j = queue.pop()
                group.append(j)
                for k in near[j]:
                    if k not in seen:
                        seen.add(k)
                        queue.append(k)
            found.append(group)
        return found
    particle = max(groups(turned), key=area, default=[])
    # Grains of one side that moved with the other, without turning.
    shift = {i: wrap(after[i][0] - before[i][0]) / travel for i in after}
    carried = [i for i in after if i not in turned and (before[i][1] < 0) == (shift[i] > 0.5)]
    # Separation: what no path of unbroken bonds joins to a base.
    bases = {i for pair in bonds for i in pair} - set(after)
    loose = [g for g in groups(set(after) | bases) if not bases & set(g)]
    return {
        "particle": area(particle), "grains": len(particle), "carried": area(carried),
        "loose": max((area(g) for g in loose), default=0.0),
        "height": height / weight / (size * DIAMETER) if weight else 0.0,
        "peak": max(force) / (STRAIN * MODULUS * size * DIAMETER), "left": sum(force[-50:]) / 50 / max(force),
        "travel": travel / (size * DIAMETER), "cpu": summary["cpu_seconds"], "residual": summary["energy_residual_relative"],
        "released": summary["fracture"]["released_over_declared"],
        "reasons": summary["reasons"], "version": summary["version"],
    }


def run(program, out, point, limit):
    """Runs a point, unless its outcome is there; its outcome, or None if it did not end."""
    size, ratio, seed, travel, speed, step = point
    folder = out / f"d{size}_r{ratio:g}_p{seed}_u{travel:g}_v{speed:g}_h{step:g}"
    kept = folder / "outcome.json"
    if kept.exists():
        return json.loads(kept.read_text())
    case(folder, *point)
    command = [program, "run", str(folder / "case.ron"), "--out", str(folder / "out"), "--threads", "1", "--no-report", "--force"]
    try:
        ended = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        print(f"{folder.name}: stopped after {limit} s", file=sys.stderr)
        return None
    if ended.returncode != 0:
        print(f"{folder.name}: {ended.stderr[-500:]}", file=sys.stderr)
        return None
    found = outcome(folder, size)
    kept.write_text(json.dumps(found))
    return found


def kind(found):
    """What an outcome is called."""
    if found["particle"] >= PARTICLE:
        return "particle"
    return "transfer" if found["carried"] >= CARRIED else "sheared"


def summary(found):
    """A row for each size and ratio: how often each outcome came, and means with the smallest and the largest value."""
    print("\n| D/d | R | D/(R d) | runs | particle | transfer | sheared | particle, D^2 | largest turned piece otherwise, D^2 | height of fracture, D | peak of Q/(s D) |")
    print("|" + "---|" * 11)
    def spread(values):
        values = list(values)
        return f"{sum(values) / len(values):.2f} ({min(values):.2f} to {max(values):.2f})" if values else "-"
    for size, ratio in sorted({point[:2] for point, _ in found}):
        those = [r for point, r in found if point[:2] == (size, ratio)]
        kinds = [kind(r) for r in those]
        cells = [size, f"{ratio:g}", f"{size / ratio:g}", len(those), *(kinds.count(k) for k in ("particle", "transfer", "sheared"))]
        cells.append(spread(r["particle"] for r in those if kind(r) == "particle"))
        cells.append(spread(r["particle"] for r in those if kind(r) != "particle"))
        cells += [spread(r[k] for r in those) for k in ("height", "peak")]
        print("| " + " | ".join(str(c) for c in cells) + " |")


def shares(found):
    """How many runs have a particle, and the mean peak force over s D, by D/(R d) and D."""
    sizes = sorted({size for (size, _), _ in found})
    print("\n| D/(R d) | " + " | ".join(f"D = {size} d" for size in sizes) + " |")
    print("|" + "---|" * (1 + len(sizes)))
    for over in sorted({size / ratio for (size, ratio), _ in found}, reverse=True):
        cells = [f"{over:g}"]
        for size in sizes:
            those = [r for (s, ratio), r in found if s == size and s / ratio == over]
            particles = sum(kind(r) == "particle" for r in those)
            peak = sum(r["peak"] for r in those) / max(1, len(those))
            cells.append(f"{particles} of {len(those)} ({peak:.2f})" if those else "-")
        print("| " + " | ".join(cells) + " |")


def solve(matrix, right):
    """A linear system of three unknowns, by Cramer's rule."""
    def det(m):
        return sum(m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]) for i in range(3))
    whole = det(matrix)
    return [det([[right[r] if c == k else matrix[r][c] for c in range(3)] for r in range(3)]) / whole for k in range(3)]


def growth(found, least):
    """Logistic regression of whether there is a particle on ln D and ln R: how the R of equal odds grows with D."""
    rows = [((1.0, math.log(size), math.log(ratio)), kind(r) == "particle") for (size, ratio), r in found if size >= least]
    b = [0.0] * 3
    for _ in range(30):
        slope, curve = [0.0] * 3, [[0.0] * 3 for _ in range(3)]
        for x, y in rows:
            p = 1 / (1 + math.exp(-sum(u * v for u, v in zip(b, x))))
            for i in range(3):
                slope[i] += x[i] * (y - p)
                for j in range(3):
                    curve[i][j] += x[i] * x[j] * p * (1 - p)
        b = [u + v for u, v in zip(b, solve(curve, slope))]
    gradient = [0.0, -1 / b[2], b[1] / b[2] ** 2]
    error = math.sqrt(sum(u * v for u, v in zip(gradient, solve(curve, gradient))))
    half = math.exp(-(b[0] + b[1] * math.log(8)) / b[2])
    print(f"\nD >= {least} d, {len(rows)} runs: half have a particle at R = {half:.2f} for D = 8 d, growing as D^({-b[1] / b[2]:.2f} +- {error:.2f})")


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--program", default="target/release/fretwork")
    words.add_argument("--out", type=Path, default=Path("target/validation/smallest_particle"))
    words.add_argument("--sizes", type=int, nargs="+", default=[4, 8, 16], help="of the junction, in d")
    words.add_argument("--ratios", type=float, nargs="+", default=[1, 2, 4, 8, 16, 32], help="w k/s^2")
    words.add_argument("--packings", type=int, nargs="+", default=[1, 2, 3], help="seeds")
    words.add_argument("--travel", type=float, default=0.5, help="of the upper block, in D")
    words.add_argument("--speed", type=float, default=0.004, help="over the speed of waves, sqrt(k d/rho)")
    words.add_argument("--step", type=float, default=0.15, help="d over the speed of waves")
    words.add_argument("--limit", type=float, default=900.0, help="of a run, s")
    given = words.parse_args()
    print("| D/d | R | D/(R d) | packing | particle, D^2 | grains | carried, D^2 | loose, D^2 | height of fracture, D | peak of Q/(s D) | Q left | cpu, s | reasons |")
    print("|" + "---|" * 13)
    for size in given.sizes:
        for seed in given.packings:
            for ratio in given.ratios:
                r = run(given.program, given.out, (size, ratio, seed, given.travel, given.speed, given.step), given.limit)
                if r:
                    numbers = [f"{r[k]:.2f}" for k in ("carried", "loose", "height", "peak", "left")]
                    cells = [size, f"{ratio:g}", f"{size / ratio:g}", seed, f"{r['particle']:.2f}", r["grains"], *numbers, f"{r['cpu']:.0f}", " ".join(r["reasons"])]
                    print("| " + " | ".join(str(c) for c in cells) + " |", flush=True)
    # Of all runs that are there with this travel, speed and step.
    found, rows = [], []
    for kept in sorted(given.out.glob(f"d*_r*_p*_u{given.travel:g}_v{given.speed:g}_h{given.step:g}/outcome.json")):
        size, ratio, packing = kept.parent.name.split("_")[:3]
        found.append(((int(size[1:]), float(ratio[1:])), json.loads(kept.read_text())))
        rows.append([int(size[1:]), float(ratio[1:]), int(packing[1:]), kind(found[-1][1])])
    with open(given.out / "table.csv", "w", newline="") as file:
        csv.writer(file).writerows([["size", "ratio", "packing", "outcome"], *rows])
    summary(found)
    shares(found)
    for least in (4, 8):
        try:
            growth(found, least)
        except (ZeroDivisionError, OverflowError):
            print(f"D >= {least} d: too few runs to show how d* grows")


if __name__ == "__main__":
    main()
