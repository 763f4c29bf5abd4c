"""The 5,000 spheres at rest in a box in LIGGGHTS, softened, and the errors of the forces of a run of LIGGGHTS or Fretwork.

    python spheres.py write FOLDER [--young 1e7] [--time 0.1] [--share 0.15]   # then: cd FOLDER && liggghts -in in.spheres
    python spheres.py errors FOLDER_OF_LIGGGHTS [--reference FOLDER]
    python spheres.py errors results/RUN/results.h5 [--reference OTHER.h5]     # needs h5py

Errors, at the end of a run:

* unbalanced: mean |sum of forces on a grain, weight included| over mean |contact force|, both codes alike; in Fretwork
  the sum is mass times change of velocity over the step;
* floor: vertical force on floor, lid and side walls over the weight of the grains;
* overlap: mean over the contacts that carry, over the mean diameter;
* deviation: of the force of a contact from that of the reference run, of either code: root mean square of the difference over that
  of the reference, over all pairs that carry in one of the two.
"""

import argparse
from pathlib import Path

import numpy as np

SCENE = Path(__file__).parent.parent / "scene3d_box_5000.txt"
DENSITY, GRAVITY, FRICTION, POISSON, RESTITUTION = 2000.0, 9.81, 0.3, 0.3, 0.3


def scene():
    """Centres and radii (m), and the lower and upper corner of the box (m)."""
    lines = [line.split() for line in SCENE.read_text().splitlines()]
    balls = np.array([[float(x) for x in w[3:7]] for w in lines if w and w[0] == "body"])
    low, high = np.full(3, -np.inf), np.full(3, np.inf)
    for w in (w for w in lines if w and w[0] == "wall"):
        v = np.array([float(x) for x in w[3:]])
        axis = int(np.argmax(np.abs(v[6:9])))
        face = v[axis] + v[5] * v[6 + axis]
        (low if v[6 + axis] > 0 else high)[axis] = face
    return balls, low, high


def write(args):
    """Writes the data file and the input script of LIGGGHTS."""
    balls, low, high = scene()
    folder = Path(args.folder)
    folder.mkdir(parents=True, exist_ok=True)
    shear = args.young / (2 * (1 + POISSON))
    rayleigh = np.pi * balls[:, 3].min() * np.sqrt(DENSITY / shear) / (0.1631 * POISSON + 0.8766)
    step = args.share * rayleigh
    steps = round(args.time / step)
    rows = [f"{n} 1 {2 * r:.12e} {DENSITY} {x:.12e} {y:.12e} {z:.12e}" for n, (x, y, z, r) in enumerate(balls, 1)]
    box = "\n".join(f"{a - 0.02:.6f} {b + 0.02:.6f} {k}lo {k}hi" for a, b, k in zip(low, high, "xyz"))
    (folder / "spheres.data").write_text(f"spheres\n\n{len(rows)} atoms\n1 atom types\n\n{box}\n\nAtoms\n\n" + "\n".join(rows) + "\n")
    model = "model hertz tangential history"
    walls = "\n".join(
        f"fix {k}{side} all wall/gran {model} primitive type 1 {k}plane {value:.12e}"
        for k, a, b in zip("xyz", low, high)
        for side, value in (("low", a), ("high", b))
    )
    (folder / "in.spheres").write_text(f"""\
# 5,000 spheres at rest: E = {args.young:g} Pa, {steps} steps of {args.share} of the Rayleigh time ({rayleigh:.3e} s)
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
read_data spheres.data
neighbor 1e-3 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype {args.young}
fix m2 all property/global poissonsRatio peratomtype {POISSON}
fix m3 all property/global coefficientRestitution peratomtypepair 1 {RESTITUTION}
fix m4 all property/global coefficientFriction peratomtypepair 1 {FRICTION}
pair_style gran {model}
pair_coeff * *
{walls}
fix g all gravity {GRAVITY} vector 0.0 0.0 -1.0
fix i all nve/sphere
timestep {step:.12e}
compute pairs all pair/gran/local id force
thermo_style custom step ke cpu
thermo {steps}
thermo_modify lost error norm no
run {steps}
# one more step, for the forces
dump a all custom 1 grains.txt id fx fy fz x y z radius vx vy vz
dump_modify a sort id format "%d %.10e %.10e %.10e %.10e %.10e %.10e %.10e %.10e %.10e %.10e"
dump c all local 1 contacts.txt c_pairs[1] c_pairs[2] c_pairs[4] c_pairs[5] c_pairs[6]
run 1
""")
    print(f"{steps} steps of {step:.3e} s")


def tables(path):
    """The numbers of the last part of a dump."""
    lines = Path(path).read_text().splitlines()
    start = max(n for n, line in enumerate(lines) if line.startswith("ITEM: ATOMS") or line.startswith("ITEM: ENTRIES"))
    return np.array([[float(x) for x in line.split()] for line in lines[start + 1 :]])


def of_liggghts(folder):
    """Sum of forces on each grain, forces of pairs by pair, of walls by grain (N), overlaps (m)."""
    grains, found = tables(Path(folder) / "grains.txt"), tables(Path(folder) / "contacts.txt")
    n = len(grains)
    total, place, r = grains[:, 1:4], grains[:, 4:7], grains[:, 7]
    i, j = found[:, 0].astype(int) - 1, found[:, 1].astype(int) - 1
    force = found[:, 2:5]
    carries = np.linalg.norm(force, axis=1) > 0
    i, j, force = i[carries], j[carries], force[carries]
    gap = np.linalg.norm(place[i] - place[j], axis=1) - r[i] - r[j]
    # The walls' forces are what is missing in the sums.
    wall = total + weights(r)
    # which of the two a pair's force acts on: that which leaves less for the walls
    signs = []
    for sign in (1, -1):
        rest = wall.copy()
        np.subtract.at(rest, i, sign * force)
        np.add.at(rest, j, sign * force)
        signs.append(rest)
    wall = min(signs, key=lambda w: np.linalg.norm(w, axis=1).sum())
    _, low, high = scene()
    touch = [(np.minimum(place - r[:, None] - low, high - place - r[:, None])).min(1) < 0]
    wall[~touch[0]] = 0.0
    pairs = {(min(a, b), max(a, b)): f if a < b else -f for a, b, f in zip(i, j, force)}
    return total, pairs, {("wall", k): wall[k] for k in range(n) if touch[0][k]}, gap, wall.sum(0), r


def weights(r):
    """Weight of each grain as a vector upwards (N)."""
    up = np.zeros((len(r), 3))
    up[:, 2] = DENSITY * 4 / 3 * np.pi * r**3 * GRAVITY
    return up


def of_fretwork(path):
    """As `of_liggghts`."""
    import h5py

    with h5py.File(path) as file:
        view = file["views/contacts"]
        start = view["Steps/CellOffsets"][-1, 1]
        cells = {k: view[f"CellData/{k}"][start:] for k in ("body_1", "body_2", "force", "gap")}
        grains = file["VTKHDF"]
        start = grains["Steps/PointOffsets"][-1]
        number, r = (grains[f"PointData/{k}"][start:] for k in ("id", "radius"))
    walls = int(number[0])
    # Fretwork orders the grains anew; the radius tells which grain of the scene one is.
    known = scene()[0][:, 3]
    of_scene = np.argsort(known)[np.argsort(np.argsort(r))]
    assert np.allclose(known[of_scene], r, rtol=1e-7)
    first, second, force = cells["body_1"].astype(int), cells["body_2"].astype(int), cells["force"]
    carries = np.linalg.norm(force, axis=1) > 0
    first, second, force, gap = first[carries], second[carries], force[carries], cells["gap"][carries]
    # The force of a contact acts on its first body.
    sums = np.vstack([np.zeros((walls, 3)), -weights(r)])
    np.add.at(sums, first, force)
    np.subtract.at(sums, second, force)
    sums = sums[walls:]
    load, pairs, on_walls = np.zeros(3), {}, {}
    name = np.concatenate([np.full(walls, -1), of_scene])
    for a, b, f in zip(name[first], name[second], force):
        if a >= 0 and b >= 0:
            pairs[(min(a, b), max(a, b))] = f if a < b else -f
        else:
            grain = max(a, b)
            push = f if a >= 0 else -f
            load += push
            on_walls[("wall", grain)] = on_walls.get(("wall", grain), 0) + push
    return sums, pairs, on_walls, gap, load, r


def read(path):
    """What a run of either code left."""
    return of_fretwork(path) if str(path).endswith(".h5") else of_liggghts(path)


def errors(args):
    """Prints the errors of a run."""
    total, pairs, walls, gap, load, r = read(args.folder)
    size = np.mean([np.linalg.norm(f) for f in [*pairs.values(), *walls.values()]])
    print(f"contacts that carry {len(pairs)} + {len(walls)} with walls, mean force {size:.4g} N")
    print(f"unbalanced {np.linalg.norm(total, axis=1).mean() / size:.3e}")
    print(f"floor {load[2] / weights(r)[:, 2].sum():.6f} of the weight")
    print(f"overlap {np.mean(np.maximum(-gap, 0)) / (2 * r.mean()):.2e}, largest {np.max(-gap) / (2 * r.mean()):.2e} of a diameter")
    if args.reference:
        mine = {**pairs, **walls}
        reference = read(args.reference)
        other = {**reference[1], **reference[2]}
        zero = np.zeros(3)
        both = mine.keys() | other.keys()
        difference = sum(((mine.get(k, zero) - other.get(k, zero)) ** 2).sum() for k in both)
        print(f"deviation {np.sqrt(difference / sum((f**2).sum() for f in other.values())):.3e}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("what", choices=["write", "errors"])
    parser.add_argument("folder")
    parser.add_argument("--young", type=float, default=1e7, help="Young's modulus, Pa")
    parser.add_argument("--time", type=float, default=0.1, help="physical time, s")
    parser.add_argument("--share", type=float, default=0.15, help="time step over the Rayleigh time")
    parser.add_argument("--reference", help="run to compare the forces of contacts with")
    args = parser.parse_args()
    write(args) if args.what == "write" else errors(args)


if __name__ == "__main__":
    main()
