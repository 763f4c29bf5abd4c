"""Writes scene_sheared_3000.txt from the last view of a run, see cases/benchmarks/README.md.

    python cases/benchmarks/lmgc90/sheared_scene.py RESULTS_FOLDER > cases/benchmarks/scene_sheared_3000.txt

The run sheared the disks of sceneczm_3000.txt without cohesion. Numbers of its disks per cluster are those of that file. Needs `h5py`.
"""

import sys

import h5py

PERIOD, DISKS = 0.14, 93
PARAMETERS = """\
dim 2
param density 2000.0
param gravity 0.0 0.0
param dt 2e-05
param theta 0.5
param pressure 100000.0
param length 0.14
param periodic 0.14
param speed 2.0
param law IQS_CLB
param mu 0.3
param alert 2e-05
param tol 0.0001
param norm Quad
param check_every 10
param max_iter 10000"""

with h5py.File(f"{sys.argv[1]}/results.h5") as file:
    views = file["VTKHDF"]
    start = views["Steps/PointOffsets"][-1]
    points, radius = views["Points"][start:], views["PointData/radius"][start:]
    first = views["PointData/first_body"][start:].astype(bool)
points[:, 0] %= PERIOD

print("# 3,000 disks between two rough rigid walls in steady shear (Fretwork, strain 1.2, inertial number 0.01), periodic along x.")
print("# Start with zero velocities, zero reactions. Bottom cluster fixed; top cluster: rotation blocked, force -pressure*length along y,")
print("# velocity `speed` along x; no gravity, no cohesion.")
print(PARAMETERS)
for n, (p, r) in enumerate(zip(points[~first], radius[~first]), 1):
    print(f"body {n} disk {p[0]:.12e} {p[1]:.12e} {r:.12e}")
walls = list(zip(points[first], radius[first]))
for name, disks in (("bottom", walls[:DISKS]), ("top", walls[DISKS:])):
    print(f"cluster {name} {PERIOD / 2:.12e} {disks[0][0][1]:.12e} {len(disks)}")
    for p, r in disks:
        print(f"cd {p[0]:.12e} {p[1]:.12e} {r:.12e}")
