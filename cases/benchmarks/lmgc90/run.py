"""Runs a scene file of cases/benchmarks with LMGC90 and prints the processor time of its steps.

    python cases/benchmarks/lmgc90/run.py cases/benchmarks/scene2d_box_5000.txt --steps 261 --windows 2-61 202-261

Needs the package `pylmgc90` of LMGC90 (https://git-xen.lmgc.univ-montp2.fr/lmgc90/lmgc90_user) on PYTHONPATH. One thread. All
parameters are those of the `param` lines; the solver is Gauss-Seidel with stored Delassus operator, its norm tested every
`check_every` iterations, contacts searched anew in every step, as LMGC90's examples do. The first step is cold. One
line per window of steps: means per step of the processor time (ms) and its parts, iterations, contacts, the forces and the
motion to compare by. `--state FILE` writes the places and velocities of the bodies at the end.
"""

import argparse
import json
import math
import os
import tempfile
from pathlib import Path
from time import process_time

import numpy as np


def read(path):
    """Parameters, walls, bodies and clusters of a scene file."""
    scene = {"param": {}, "wall": [], "body": [], "cluster": []}
    for line in Path(path).read_text().splitlines():
        word = line.split()
        if not word or word[0].startswith("#"):
            continue
        if word[0] == "dim":
            scene["dim"] = int(word[1])
        elif word[0] == "param":
            values = [float(x) if x[0] in "-.0123456789" else x for x in word[2:]]
            scene["param"][word[1]] = values if len(values) > 1 else values[0]
        elif word[0] == "wall":
            scene["wall"].append([float(x) for x in word[3:]])
        elif word[0] == "body":
            scene["body"].append([float(x) for x in word[3:]])
        elif word[0] == "cluster":
            scene["cluster"].append((word[1], [float(x) for x in word[2:4]], []))
        elif word[0] == "cd":
            scene["cluster"][-1][2].append([float(x) for x in word[1:]])
    return scene


def write(scene, pre):
    """Writes LMGC90's own files of a scene into ./DATBOX."""
    dim, p = scene["dim"], scene["param"]
    bodies, materials, models = pre.avatars(), pre.materials(), pre.models()
    see, laws = pre.see_tables(), pre.tact_behavs()
    grain = pre.material(name="grain", materialType="RIGID", density=p["density"])
    materials.addMaterial(grain)
    rigid = pre.model(name="rigid", physics="MECAx", element=f"Rxx{dim}D", dimension=dim)
    models.addModel(rigid)
    for place in scene["body"]:
        make = pre.rigidDisk if dim == 2 else pre.rigidSphere
        bodies.addAvatar(make(r=place[-1], center=place[:-1], model=rigid, material=grain, color="BLUEx"))
    fixed = [1, 2, 3] if dim == 2 else [1, 2, 3, 4, 5, 6]
    for w in scene["wall"]:
        if dim == 2:
            body = pre.rigidJonc(axe1=w[2], axe2=w[3], center=w[:2], model=rigid, material=grain, color="WALLx")
            body.rotate(psi=w[4], center=body.nodes[1].coor)
        else:
            body = pre.rigidPlan(*w[3:6], center=w[:3], model=rigid, material=grain, color="WALLx")
            # the normal of a plan is its third axis
            normal = np.array(w[6:9])
            axis = np.cross([0.0, 0.0, 1.0], normal)
            angle = math.acos(normal[2])
            if angle > 1e-9:
                axis = axis if np.linalg.norm(axis) > 1e-9 else np.array([1.0, 0.0, 0.0])
                body.rotate(description="axis", alpha=angle, axis=axis, center=body.nodes[1].coor)
        body.imposeDrivenDof(component=fixed, dofty="vlocy")
        bodies.addAvatar(body)
    for name, center, disks in scene["cluster"]:
        body = pre.avatar(dimension=2)
        body.addBulk(pre.rigid2d())
        body.addNode(pre.node(coor=np.array(center), number=1))
        body.defineGroups()
        body.defineModel(model=rigid)
        body.defineMaterial(material=grain)
        for x, y, r in disks:
            body.addContactors(shape="DISKx", color="BLUEx", byrd=r, shift=[x - center[0], y - center[1]])
        body.computeRigidProperties()
        if name == "bottom":
            body.imposeDrivenDof(component=fixed, dofty="vlocy")
        else:
            load = -p["pressure"] * p["length"]
            body.imposeDrivenDof(component=3, dofty="vlocy")
            body.imposeDrivenDof(component=2, dofty="force", ct=load)
            if "speed" in p:
                body.imposeDrivenDof(component=1, dofty="vlocy", ct=p["speed"])
            else:
                omega = 2 * math.pi * p["frequency"]
                body.imposeDrivenDof(component=1, dofty="vlocy", amp=p["amplitude"] * omega, omega=omega)
        bodies.addAvatar(body)
    friction = p.get("mu", p.get("mu_disk_disk", p.get("mu_sphere_sphere")))
    if p["law"] == "IQS_MAC_CZM":
        values = {"stfr": friction, "dyfr": friction, "cn": p["cn"], "ct": p["ct"], "b": p["b"], "w": p["w"]}
    else:
        values = {"fric": friction}
    law = pre.tact_behav(name="grain", law=p["law"], **values)
    laws.addBehav(law)
    ball, wall, family = ("DISKx", "JONCx", "RBDY2") if dim == 2 else ("SPHER", "PLANx", "RBDY3")
    for other, color in [(ball, "BLUEx")] + ([(wall, "WALLx")] if scene["wall"] else []):
        see.addSeeTable(
            pre.see_table(
                CorpsCandidat=family, candidat=ball, colorCandidat="BLUEx", behav=law, alert=p["alert"],
                CorpsAntagoniste=family, antagoniste=other, colorAntagoniste=color,
            )
        )
    gravity = (p["gravity"] + [0.0])[:3]
    pre.writeDatbox(dim, materials, models, bodies, laws, see, post=pre.postpro_commands(), gravy=gravity)


class Steps:
    """A scene in LMGC90, and the processor time of the parts of its steps (s)."""

    parts = ("detect", "prepare", "sweeps", "tests", "rest")

    def __init__(self, scene, chipy):
        self.scene, self.c = scene, chipy
        p, dim = scene["param"], scene["dim"]
        chipy.Initialize()
        chipy.checkDirectories()
        chipy.utilities_DisableLogMes()
        chipy.SetDimension(dim, 1 if dim == 2 else 0)
        chipy.TimeEvolution_SetTimeStep(p["dt"])
        chipy.Integrator_InitTheta(p["theta"])
        if dim == 3:
            chipy.RBDY3_NewRotationScheme()
        # ReadDatbox without its writing of files.
        chipy.bulk_behav_ReadBehaviours()
        chipy.tact_behav_ReadBehaviours()
        chipy.ReadBodies()
        chipy.LoadBehaviours()
        chipy.ReadIniDof()
        chipy.ReadDrivenDof()
        chipy.LoadTactors()
        chipy.ReadIniVlocRloc()
        if "periodic" in p:
            chipy.SetPeriodicCondition(xperiod=p["periodic"])
        chipy.ComputeMass()
        solver = "nlgs" if dim == 2 else "nlgs_3D"
        self.solver = {k: getattr(chipy, f"{solver}_{k}") for k in ("SetCheckType", "ExPrep", "ExIter", "AfterIterCheck", "ExPost")}
        self.name = "RBDY2" if dim == 2 else "RBDY3"
        self.handler = f"inter_handler_{dim}D"
        ids = ("DKDKx_ID", "DKJCx_ID") if dim == 2 else ("SPSPx_ID", "SPPLx_ID")
        self.ids = [getattr(chipy, i) for i in ids]

    def step(self):
        """One step: its times by part, its iterations."""
        c, p, s = self.c, self.scene["param"], self.solver
        times = dict.fromkeys(self.parts, 0.0)
        clock = process_time()

        def lap(part):
            nonlocal clock
            now = process_time()
            times[part] += now - clock
            clock = now

        c.IncrementStep()
        c.ComputeFext()
        c.ComputeBulk()
        c.ComputeFreeVelocity()
        lap("rest")
        c.SelectProxTactors()
        lap("detect")
        c.RecupRloc()
        lap("rest")
        # What ExSolver does, in parts.
        s["SetCheckType"](f"{p['norm']:<5}", p["tol"], 1.0)
        s["ExPrep"](f"{'Stored_Delassus_Loops':<30}")
        lap("prepare")
        every, iterations = int(p["check_every"]), 0
        while iterations < p["max_iter"]:
            s["ExIter"](every)
            iterations += every
            lap("sweeps")
            converged = s["AfterIterCheck"]()
            lap("tests")
            if converged == 0:
                break
        s["ExPost"]()
        lap("tests")
        c.UpdateTactBehav()
        c.StockRloc()
        c.ComputeDof()
        c.UpdateStep()
        lap("rest")
        return times, iterations

    def contacts(self):
        """Number of contacts, and of those that carry."""
        dim, found, carrying = self.scene["dim"], 0, 0
        for i in self.ids:
            if getattr(self.c, f"{self.handler}_getNb")(i) == 0:
                continue
            rows = getattr(self.c, f"{self.handler}_getAll")(i)
            # rows: place, frame, forces t n (s), velocities, gap
            force = rows[:, 7 if dim == 2 else 13]
            found += len(rows)
            carrying += int((force > 0).sum())
        return found, carrying

    def vectors(self, what):
        """A vector of each body."""
        dim = self.scene["dim"]
        return np.array(getattr(self.c, f"{self.name}_GetAllBodyVector")(f"{what:<5}"))[:, : 3 if dim == 2 else 6]

    def motion(self):
        """Kinetic energy of the grains (J), and force of all contacts on the walls, or on the top (N)."""
        dim, grains = self.scene["dim"], np.array(self.scene["body"])
        r = grains[:, -1]
        rho = self.scene["param"]["density"]
        mass = rho * np.pi * r**2 if dim == 2 else rho * 4 / 3 * np.pi * r**3
        inertia = (0.5 if dim == 2 else 0.4) * mass * r**2
        v = self.vectors("V____")
        n = len(grains)
        energy = 0.5 * (mass * (v[:n, :dim] ** 2).sum(1)).sum() + 0.5 * (inertia * (v[:n, dim:] ** 2).sum(1)).sum()
        loaded = slice(n, None) if self.scene["wall"] else slice(-1, None)
        return energy, self.vectors("Reac_")[loaded, :dim].sum(0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("scene")
    parser.add_argument("--steps", type=int, default=61)
    parser.add_argument("--windows", nargs="+", default=["2-61"], help="first-last steps to average over; the first step is 1")
    parser.add_argument("--state", help="file for places and velocities at the end")
    parser.add_argument("--json", action="store_true", help="print JSON lines")
    args = parser.parse_args()
    os.environ["OMP_NUM_THREADS"] = "1"
    from pylmgc90 import chipy, pre

    scene = read(args.scene)
    state = Path(args.state).resolve() if args.state else None
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        Path("DATBOX").mkdir()
        write(scene, pre)
        steps = Steps(scene, chipy)
        rows = []
        for _ in range(args.steps):
            times, iterations = steps.step()
            found, carrying = steps.contacts()
            energy, force = steps.motion()
            rows.append({**times, "iterations": iterations, "contacts": found, "carrying": carrying, "energy": energy,
                         "force_x": force[0], "force_z": force[-1]})
        if state:
            np.savetxt(state, np.hstack([steps.vectors("Coor_"), steps.vectors("V____")]))
        os.chdir("/")
    for window in ["1-1", *args.windows]:
        first, last = (int(x) for x in window.split("-"))
        part = rows[first - 1 : last]
        mean = {k: float(np.mean([r[k] for r in part])) for k in rows[0]}
        ms = {k: 1e3 * mean.pop(k) for k in Steps.parts}
        out = {"scene": Path(args.scene).stem, "steps": window, "cpu_ms": sum(ms.values()), **ms, **mean}
        out["sweep_ns"] = 1e6 * ms["sweeps"] / (mean["iterations"] * mean["contacts"])
        if args.json:
            print(json.dumps(out))
        else:
            print("  ".join(f"{k} {v:.4g}" if isinstance(v, float) else f"{v}" for k, v in out.items()))


if __name__ == "__main__":
    main()
