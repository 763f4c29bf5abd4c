#!/usr/bin/env python3
"""Opens the results of a run with h5py and with VTK's own reader.

    pip install h5py vtk
    python3 tests/check_results.py results/wheel_rail_fretting

Exits with a sentence where something cannot be read or does not agree.
With --live the file is opened as one that is being written, or whose writer was killed.
"""
import os
import sys

import h5py
import numpy as np

CELLS = ("Vertices", "Lines", "Polygons", "Strips")


def fail(sentence):
    sys.exit(f"check_results: {sentence}")


def check_view(view, name):
    steps = view["Steps"]
    n = len(steps["Values"])
    if n == 0:
        fail(f"the view {name} has no step")
    points = view["Points"]
    for k in range(n):
        part = int(steps["PartOffsets"][k])
        first, count = int(steps["PointOffsets"][k]), int(view["NumberOfPoints"][part])
        if first + count > len(points):
            fail(f"step {k} of {name} points beyond its {len(points)} points")
        if not np.isfinite(points[first:first + count]).all():
            fail(f"step {k} of {name} has coordinates that are not finite")
        for c, kind in enumerate(CELLS):
            cells = int(view[kind]["NumberOfCells"][part])
            ids = int(view[kind]["NumberOfConnectivityIds"][part])
            start = int(steps["CellOffsets"][k][c]) + part
            offsets = view[kind]["Offsets"][start:start + cells + 1]
            if len(offsets) != cells + 1 or offsets[0] != 0 or offsets[-1] != ids:
                fail(f"step {k} of {name}: the offsets of {kind} do not agree")
            at = int(steps["ConnectivityIdOffsets"][k][c])
            used = view[kind]["Connectivity"][at:at + ids]
            if len(used) and used.max() >= count:
                fail(f"step {k} of {name}: {kind} name points that are not there")
    times = steps["Values"][:]
    if not (np.diff(times) > 0).all():
        fail(f"the time of {name} does not advance")
    return n


STORED_AND_SPENT = ("kinetic", "potential", "elastic", "fracture", "friction", "impact", "adhesion", "viscous", "correction", "scheme", "carried")


def check_ledger(table):
    """The columns of the ledger add up to its residual, row by row."""
    entries = [table[n][:] for n in STORED_AND_SPENT] + [-table["external_work"][:], -table["initial_kinetic"][:]]
    off = np.abs(sum(entries) - table["residual"][:])
    scale = np.max(np.abs(entries), axis=0)
    if (off > 1e-14 * scale).any():
        fail(f"the energies do not add up: {off.max():e} of {scale.max():e}")


def check_contacts(data, dimension):
    """Components of forces, directions, bodies and status of contacts agree."""
    axes = "xyz"[:dimension]
    normal = np.array([data[f"normal_{a}"][:] for a in axes])
    t = [data[f"force_tangential_{k}"][:] for k in range(1, dimension)]
    norm = np.sqrt(sum(x**2 for x in t))
    if not np.allclose(norm, data["force_tangential"][:], rtol=1e-12, atol=0.0):
        fail("the components of tangential forces are not those of their norm")
    if not np.allclose((normal**2).sum(axis=0), 1.0, rtol=1e-12):
        fail("normals are not of length 1")
    if dimension == 3:
        tangent = np.array([data[f"tangent_1_{a}"][:] for a in axes])
        if (np.abs((normal * tangent).sum(axis=0)) > 1e-12).any():
            fail("tangents are not perpendicular to their normals")
    if not all(data[n].dtype == np.int64 for n in ("body_1", "body_2")):
        fail("identities of bodies are no whole numbers of 64 bits")
    if not set(np.unique(data["status"][:])) <= {0.0, 1.0, 2.0, 3.0, 4.0}:
        fail("contacts have a status that is none")


def check_h5(path, live):
    with h5py.File(path, "r", swmr=live) as f:
        for group in ("case", "materials", "plugins", "statistics", "views/grains", "views/contacts", "views/bodies", "VTKHDF"):
            if group not in f:
                fail(f"{path} has no /{group}")
        lengths = {name: len(d) for name, d in f["statistics"].items()}
        if len(set(lengths.values())) != 1:
            fail(f"columns of the statistics differ in length: {lengths}")
        for group in ("statistics", "views/grains/PointData", "views/contacts/CellData", "views/bodies/CellData"):
            bare = [n for n, d in f[group].items() if not (d.attrs.get("unit") and d.attrs.get("doc"))]
            if bare:
                fail(f"{bare} in {group} have no unit or no explanation")
        check_ledger(f["statistics"])
        check_contacts(f["views/contacts/CellData"], int(f.attrs["dimension"]))
        views = {name: check_view(f["views"][name], name) for name in ("grains", "contacts", "bodies")}
        laws = [b.decode() if isinstance(b, bytes) else b for b in f["plugins/name"][:]]
        print(f"h5py {h5py.__version__}: {next(iter(lengths.values()))} rows of {len(lengths)} statistics, states {views}, laws {laws}")


def check_vtk(path, name):
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.vtkCommonCore import vtkVersion
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

    reader = vtkHDFReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    info = reader.GetOutputInformation(0)
    times = info.Get(Pipeline.TIME_STEPS()) or ()
    if not times:
        fail(f"VTK finds no time steps in {path}")
    seen = []
    for k in sorted({0, len(times) // 2, len(times) - 1}):
        reader.UpdateTimeStep(times[k])
        data = reader.GetOutputDataObject(0)
        arrays = data.GetPointData().GetNumberOfArrays() + data.GetCellData().GetNumberOfArrays()
        if arrays == 0:
            fail(f"VTK finds no data on {name} at step {k}")
        seen.append((times[k], data.GetNumberOfPoints(), data.GetNumberOfCells(), arrays))
    print(f"VTK {vtkVersion.GetVTKVersion()} {name}: " + "; ".join(
        f"t {t:.4e}: {p} points, {c} cells, {a} arrays" for t, p, c, a in seen))


def main():
    live = "--live" in sys.argv
    folders = [a for a in sys.argv[1:] if not a.startswith("--")]
    if len(folders) != 1:
        sys.exit(__doc__)
    path = os.path.join(folders[0], "results.h5")
    if not os.path.exists(path):
        fail(f"there is no {path}")
    check_h5(path, live)
    if not live:
        check_vtk(path, "grains")
        for name in ("contacts", "bodies"):
            check_vtk(os.path.join(folders[0], f"{name}.vtkhdf"), name)
    print("all readable")


if __name__ == "__main__":
    main()
