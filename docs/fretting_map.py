#!/usr/bin/env python3
"""Fretting maps: regime, Q/(mu P), A = E_d/(4 Q delta) and the energy of a loop against displacement and load, of a sphere or a cylinder on a flat.

Runs cases/sphere_on_flat_fretting.ron, or with --cylinder cases/cylinder_on_flat_fretting.ron, at three loads and displacements from a quarter to
four times that of the end of partial slip, delta*, and prints a line a run with the closed forms of Mindlin and Deresiewicz (sphere), of Cattaneo and
Mindlin (cylinder) beside. From the root of the repository, after `cargo build --release`:

    python3 docs/fretting_map.py [FOLDER]               # three minutes
    python3 docs/fretting_map.py --cylinder [FOLDER]    # ten minutes

A cylinder: displacements of far points of a half-plane are infinite, and those of the holder have the compliance C of the bodies, which a run that
sticks tells. What is left depends on x = Q/(mu P) alone. With the normal compliance d delta_n/dP = (K - ln P)/(pi E*), K of the bodies,
Ciavarella's and Jaeger's superposition for like bodies, delta = mu (delta_n(P) - delta_n(P - Q/mu)), is

    delta = C Q + mu P/(pi E*) ((1 - x) ln(1 - x) + x)                      delta* = mu P (C + 1/(pi E*))

and by Masing's rule the loop between -Q and Q has the area 8 (int Q d delta - Q delta/2), to which C Q adds nothing:

    E_d = 4 (mu P)^2/(pi E*) ((1 - x) ln(1 - x) + x - x^2/2)

`check` finds the same by summing traction times slip: with the stick zone c = a sqrt(1 - x) the slip of a half cycle is 2 mu/R int_c^x sqrt(t^2 - c^2) dt
under the traction mu p. At the end of partial slip A is then 1/(2 (1 + pi E* C)): 0.2, that of a sphere, is that of one compliance alone.

Sources: K. L. Johnson, "Contact Mechanics" (1985), sections 4.2, 7.2 and 7.4; M. Ciavarella, Int. J. Solids Struct. 35 (1998) 2349; S. Fouvry, Ph.
Kapsa, L. Vincent, Wear 185 (1995) 35: A is 0.2 at the end of partial slip.
"""
import json
import math
import os
import subprocess
import sys

MU = 0.6
PROGRAM = os.environ.get("FRETWORK", "target/release/fretwork")
RATIOS = (0.25, 0.5, 0.75, 1.0, 1.25, 2.0, 4.0)
FREQUENCY = 20.0


class Pair:
    """Two bodies of one material."""

    def modulus(self):
        """E* of the pair (Pa)."""
        return self.shear / (1 - self.poisson)


class Sphere(Pair):
    """A sphere on a flat; loads in N."""

    case, radius, loads, unit = "sphere_on_flat_fretting", 0.05, (50.0, 99.52, 150.0), ("N", "uJ")
    along, down = "half_spaces.1.dofs.x", "half_spaces.1.dofs.z"
    shear, poisson = 82e9, 0.28

    def __init__(self, load):
        self.load = load
        self.a = (3 * load * self.radius / (4 * self.modulus())) ** (1 / 3)
        self.limit = 3 * MU * load * (2 - self.poisson) / (8 * self.shear * self.a)

    def share(self, delta):
        """Q/(mu P) at a displacement (m)."""
        return 1 - max(0.0, 1 - delta / self.limit) ** 1.5

    def loop(self, share):
        """Energy of a loop of partial slip (J)."""
        rest = 1 - share
        loop = 1.8 * (MU * self.load) ** 2 * (2 - self.poisson) / (self.a * self.shear)
        return loop * (1 - rest ** (5 / 3) - 5 * share / 6 * (1 + rest ** (2 / 3)))


class Cylinder(Pair):
    """A cylinder on a flat; loads in N/m."""

    case, radius, loads, unit = "cylinder_on_flat_fretting", 0.5, (100e3, 178.9e3, 250e3), ("N/m", "uJ/m")
    along, down = "elastic.1.supports.0.x", "elastic.1.supports.0.y"
    shear, poisson = 210e9 / 2.6, 0.3

    def __init__(self, load):
        self.load = load
        self.local = 1 / (math.pi * self.modulus())
        # A tenth of the local part of delta* sticks nearly.
        small = 0.1 * MU * load * self.local
        cycle = run(self, load, small, f"{load:g}_stuck")
        self.compliance = small / cycle["tangential_amplitude"]
        self.limit = MU * load * (self.compliance + self.local)

    def share(self, delta):
        """Q/(mu P) at a displacement (m)."""
        low, high = 0.0, 1.0
        for _ in range(60):
            x = 0.5 * (low + high)
            found = MU * self.load * (self.compliance * x + self.local * ((1 - x) * math.log(max(1 - x, 1e-300)) + x))
            low, high = (x, high) if found < delta else (low, x)
        return low if delta < self.limit else 1.0

    def loop(self, share):
        """Energy of a loop of partial slip (J/m)."""
        rest = 1 - share
        part = (rest * math.log(rest) if rest > 0.0 else 0.0) + share - share**2 / 2
        return 4 * (MU * self.load) ** 2 * self.local * part

    def check(self, share, cells=20000):
        """The same by traction times slip."""
        a = math.sqrt(4 * self.load * self.radius * self.local)
        c, p0 = a * math.sqrt(1 - share), 2 * self.load / (math.pi * a)
        step, slip, total = (a - c) / cells, 0.0, 0.0
        for k in range(cells):
            x = c + (k + 0.5) * step
            gradient = MU / self.radius * math.sqrt(x * x - c * c)
            total += MU * p0 * math.sqrt(1 - (x / a) ** 2) * (slip + 0.5 * step * gradient) * step
            slip += step * gradient
        # Both sides, twice that slip in each of two half cycles.
        return 8 * total


def summary(shape, load, delta, folder):
    """The summary of a run in a folder."""
    sets = [
        f"{shape.along}=Displacement(Sine(amplitude: {delta:e}, frequency: {FREQUENCY}, start: 0.01))",
        f"{shape.down}=Force(Ramp(from: 0.0, to: {-load:e}, start: 0.0, end: 8e-3))",
        "output.views=0",
        "output.frames=0",
        "output.figures=false",
    ]
    words = [PROGRAM, "run", f"cases/{shape.case}.ron", "--out", folder, "--force"]
    for each in sets:
        words += ["--set", each]
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(f"{folder}/summary.json", encoding="utf-8") as file:
        return json.load(file)


def run(shape, load, delta, name):
    """The last cycle of a run in its summary."""
    return summary(shape, load, delta, f"{shape.out}/{name}")["cycles"][-1]


def main():
    words = sys.argv[1:]
    shape = Cylinder if "--cylinder" in words else Sphere
    words = [w for w in words if w != "--cylinder"]
    shape.out = words[0] if words else f"results/fretting_map_{shape.__name__.lower()}"
    force, energy = shape.unit
    print(f"load ({force})  delta (um)  delta/delta*  Q/(mu P), closed form  A, closed form  loop ({energy}), closed form  regime")
    for load in shape.loads:
        closed = shape(load)
        if shape is Cylinder:
            for share in (0.2, 0.6, 0.95):
                assert abs(closed.check(share) / closed.loop(share) - 1) < 1e-3, share
            print(f"compliance of the bodies: pi E* C = {closed.compliance / closed.local:.3f}, A at the end of partial slip {closed.loop(1.0) / (4 * MU * load * closed.limit):.3f}")
        for ratio in RATIOS:
            delta = ratio * closed.limit
            cycle = run(shape, load, delta, f"{load:g}_{ratio:g}")
            share = closed.share(delta)
            loop = closed.loop(share) + 4 * MU * load * max(0.0, delta - closed.limit)
            found = cycle["tangential_amplitude"] / (MU * cycle["normal_force"])
            print(
                f"{load:9g}  {delta * 1e6:10.3f}  {ratio:12.2f}  {found:8.4f}  {share:11.4f}  {cycle['energy_ratio']:5.3f}  {loop / (4 * share * MU * load * delta):6.3f}"
                f"  {cycle['work'] * 1e6:12.3f}  {loop * 1e6:12.3f}  {cycle['regime']}",
                flush=True,
            )


if __name__ == "__main__":
    main()
