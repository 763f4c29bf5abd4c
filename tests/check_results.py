#!/usr/bin/env python3
"""Opens the results of a run, or of a patch, with h5py and with VTK's own reader.

    pip install h5py vtk
    cargo run --release -- run cases/cylinder_on_flat_fretting.ron
    python3 tests/check_results.py results/wheel_rail_fretting
    cargo run --release -- patch patches/wheel_on_rail.ron
    python3 tests/check_results.py results/patch/wheel_on_rail

Exits with a sentence where something cannot be read or does not agree.
With --live the file is opened as one that is being written, or whose writer was killed.
"""
import json
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
    # Without friction what is left of the tangential part is round-off of the normal force.
    pushes = data["force_normal"][:]
    round_off = 1e-12 * np.hypot(pushes, norm)
    if (np.abs(norm - data["force_tangential"][:]) > round_off).any():
        fail("the components of tangential forces are not those of their norm")
    force = data["force"][:]
    if not np.array_equal(data["normal"][:, :dimension].T, normal):
        fail("the vectors `normal` are not their components")
    if (np.abs((force[:, :dimension].T * normal).sum(axis=0) - pushes) > round_off).any():
        fail("the vectors `force` do not have the normal force along the normal")
    if (np.abs(np.linalg.norm(force, axis=1) - np.hypot(pushes, norm)) > round_off).any():
        fail("the vectors `force` are not as large as normal and tangential force")
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


def check_motion(data, dimension):
    """Vectors of grains are their components, and identities are written."""
    for vector, part in (("velocity", "velocity"), ("angular_velocity", "spin"))[:dimension - 1]:
        parts = np.array([data[f"{part}_{a}"][:] for a in "xyz"]).T
        if not np.array_equal(data[vector][:], parts):
            fail(f"the vectors `{vector}` of grains are not their components")
    if dimension == 3 and not np.allclose(np.linalg.norm(data["angular_velocity"][:], axis=1), data["spin"][:], rtol=1e-12, atol=0.0):
        fail("`spin` is not the norm of `angular_velocity`")
    turns = [f"orientation_{a}" for a in "wxyz"]
    if all(t in data for t in turns) and not np.allclose(sum(data[t][:]**2 for t in turns), 1.0, rtol=1e-12):
        fail("orientations of grains are no unit quaternions")
    if (data["corners"][:] > 0).any() and "angle" not in data and turns[0] not in data:
        fail("grains that are no balls have no orientation")


def check_identities(views):
    """Bodies of contacts are grains, or bodies with an outline or a surface."""
    known = set(views["grains/PointData/id"][:].astype(int)) | set(views["bodies/CellData/body"][:].astype(int))
    for side in ("body_1", "body_2"):
        strangers = set(views[f"contacts/CellData/{side}"][:]) - known
        if strangers:
            fail(f"{side} of contacts names bodies {sorted(strangers)[:5]} that are neither grains nor bodies")


def mesh_state(view, k):
    """Point and cell data of a state of a mesh, whose points and cells are those of all states."""
    steps = view["Steps"]
    counts = {"PointData": int(view["NumberOfPoints"][0]), "CellData": int(view["NumberOfCells"][0])}
    out = {}
    for place, count in counts.items():
        for name, data in view[place].items():
            first = int(steps[f"{place}Offsets/{name}"][k])
            out[name] = data[first:first + count]
            if len(out[name]) != count:
                fail(f"state {k} of {view.name}: {name} has {len(out[name])} values of {count}")
    return out


def check_mesh(view):
    """A mesh of an unstructured grid: one part that all states share."""
    steps, n = view["Steps"], len(view["Steps/Values"])
    if n == 0 or int(steps.attrs["NSteps"]) != n or not (np.diff(steps["Values"]) > 0).all():
        fail(f"{view.name} has no states, or their time does not advance")
    points, offsets, corners = view["Points"][:], view["Offsets"][:], view["Connectivity"][:]
    if len(points) != view["NumberOfPoints"][0] or len(offsets) != view["NumberOfCells"][0] + 1:
        fail(f"{view.name}: points or cells are not as many as it says")
    if offsets[-1] != len(corners) or view["NumberOfConnectivityIds"][0] != len(corners) or corners.max() >= len(points):
        fail(f"{view.name}: corners of cells do not agree with its points")
    if view["Types"].dtype != np.uint8 or len(view["Types"]) != len(offsets) - 1:
        fail(f"{view.name}: kinds of cells are no bytes, one a cell")
    for name, value in (("PartOffsets", 0), ("NumberOfParts", 1), ("PointOffsets", 0), ("CellOffsets", 0), ("ConnectivityIdOffsets", 0)):
        if (steps[name][:] != value).any() or len(steps[name]) != n:
            fail(f"{view.name}/Steps/{name} is not {value} in each of {n} states")
    for k in range(n):
        if not all(np.isfinite(values).all() for values in mesh_state(view, k).values()):
            fail(f"state {k} of {view.name} has values that are not finite")
    return n


def check_stress(name, state):
    """The von Mises stress is that of the six components, in their order."""
    xx, yy, zz, xy, yz, xz = state["stress"].T
    squared = 0.5 * ((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) + 3.0 * (xy**2 + yz**2 + xz**2)
    if not np.allclose(np.sqrt(squared), state["von_mises"], rtol=1e-12):
        fail(f"the von Mises stress of {name} is not that of its stress")


def check_end(folder, name, state):
    """The last state of a mesh is that of its legacy file."""
    with open(os.path.join(folder, f"{name}.vtk")) as file:
        lines = file.read().split("\n")
    start = next(k for k, line in enumerate(lines) if line.startswith("VECTORS displacement")) + 1
    count = len(state["displacement"])
    table = np.array([line.split() for line in lines[start:start + count]], dtype=float)
    off = np.abs(table - state["displacement"]).max()
    if off > 1e-12 * np.abs(table).max():
        fail(f"displacements of {name} at the end differ from {name}.vtk by {off:e} m")


def check_grains(folder, name, view, state, file):
    """Grains that deform: their bodies are grains of the run, and the last state is that of the legacy file."""
    known = set(file["views/grains/PointData/id"][:].astype(int))
    ids = [view[place]["body"][:] for place in ("PointData", "CellData")]
    if not all(set(i) <= known for i in ids):
        fail(f"bodies of {view.name} are no grains of the run")
    corners = view["Connectivity"][:].reshape(len(ids[1]), -1)
    if (ids[0][corners] != ids[1][:, None]).any():
        fail(f"elements of {view.name} join points of other grains")
    if len(file["views/elastic_grains"]) == 1 and folder:
        # The only material: the legacy file has no other grains.
        check_end(folder, "elastic_grains", {"displacement": state["deformation"]})
    print(f"  grains of {name}: {len(set(ids[0]))} of {len(ids[1])} elements, von Mises stress up to {state['von_mises'].max():.3e} Pa")


def check_surface(folder, name, state, dimension):
    """The sums of pressure and traction times area are the forces of the contacts at the end."""
    table = np.genfromtxt(os.path.join(folder, f"{name}_tractions.csv"), delimiter=",", names=True)
    area = state["area"]
    newton = "Nm" if dimension == 2 else "N"
    pairs = [(table[f"normal_force_{newton}"].sum(), (state["pressure"] * area).sum())]
    for k, axis in enumerate("xyz"[:dimension]):
        pairs.append((table[f"force_{axis}_{newton}"].sum(), (state["traction"][:, k] * area).sum()))
    scale = max(abs(p[0]) for p in pairs)
    if any(abs(a - b) > 1e-12 * scale for a, b in pairs):
        fail(f"tractions of {name} do not sum up to its forces: {pairs}")
    if not set(np.unique(state["status"])) <= {0.0, 1.0, 2.0} or ((state["status"] > 0) & (np.abs(state["traction"]).max(axis=1) == 0)).any():
        fail(f"the status of {name} does not agree with its tractions")
    stick, slip = [int((state["status"] == k).sum()) for k in (1, 2)]
    print(f"  surface {name}: {pairs[0][1]:.6g} normal, off by {max(abs(a - b) for a, b in pairs) / scale:.1e}; {stick} points stick, {slip} slip")


def check_meshes(folder, file, live):
    """Fields of deformable bodies; those of the end also against the other files of the run."""
    dimension = int(file.attrs["dimension"])
    for kind in ("meshes", "surfaces", "elastic_grains"):
        for name, view in file["views"].get(kind, {}).items():
            n = check_mesh(view)
            last = mesh_state(view, n - 1)
            if kind != "surfaces":
                check_stress(name, last)
            at_end = abs(view["Steps/Values"][-1] - file["statistics/time"][-1]) < 1e-12
            whole = not live and at_end
            if kind == "elastic_grains":
                check_grains(folder if whole else None, name, view, last, file)
                continue
            if not whole:
                continue
            if kind == "meshes":
                check_end(folder, name, last)
            else:
                check_surface(folder, name, last, dimension)


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
        check_motion(f["views/grains/PointData"], int(f.attrs["dimension"]))
        check_identities(f["views"])
        check_meshes(os.path.dirname(path), f, live)
        views = {name: check_view(f["views"][name], name) for name in ("grains", "contacts", "bodies")}
        laws = [b.decode() if isinstance(b, bytes) else b for b in f["plugins/name"][:]]
        print(f"h5py {h5py.__version__}: {next(iter(lengths.values()))} rows of {len(lengths)} statistics, states {views}, laws {laws}")


# Arrays of the files that ParaView opens, and their numbers of components: what its filters, such
# as Glyph, take.
ARRAYS = {
    "grains": ("Point", {"id": 1, "radius": 1, "velocity": 3, "spin": 1}),
    "contacts": ("Cell", {"body_1": 1, "body_2": 1, "status": 1, "force": 3, "normal": 3, "force_normal": 1}),
    "bodies": ("Cell", {"body": 1, "velocity": 3}),
    "shapes": ("Cell", {"id": 1, "radius": 1, "velocity": 3, "spin": 1}),
}


def check_arrays(name, data):
    """VTK gives the arrays of grains, contacts and bodies as numbers and vectors."""
    place, arrays = ARRAYS[name]
    given = data.GetPointData() if place == "Point" else data.GetCellData()
    for array, components in arrays.items():
        found = given.GetArray(array)
        if found is None or found.GetNumberOfComponents() != components:
            fail(f"VTK has no array {array} of {components} components in {name}.vtkhdf")


def check_shapes(folder):
    """The cells of shapes.vtkhdf are the points of grains.vtkhdf in all states: with their fields, about their places, in 2D of their size."""
    from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.util.numpy_support import vtk_to_numpy

    path = os.path.join(folder, "shapes.vtkhdf")
    if not os.path.exists(path):
        return
    with h5py.File(os.path.join(folder, "results.h5"), "r") as file:
        view = file["views/grains"]
        flat, counts = int(file.attrs["dimension"]) == 2, view["NumberOfPoints"][:]
        reader = vtkHDFReader()
        reader.SetFileName(path)
        reader.UpdateInformation()
        if reader.GetNumberOfSteps() != len(counts):
            fail(f"{path} has {reader.GetNumberOfSteps()} states, grains {len(counts)}")
        largest = 0.0
        for k, first in enumerate(np.cumsum(counts) - counts):
            reader.SetStep(k)
            reader.Update()
            cells, rows = reader.GetOutputDataObject(0), slice(first, first + counts[k])
            if cells.GetNumberOfCells() != counts[k]:
                fail(f"state {k} of {path} has {cells.GetNumberOfCells()} cells for {counts[k]} grains")
            for name, values in view["PointData"].items():
                seen = vtk_to_numpy(cells.GetCellData().GetArray(name))
                if not np.array_equal(seen, values[rows], equal_nan=True):
                    fail(f"VTK reads other values of {name} of shapes than of grains in state {k} of {path}")
            bounds = np.array([cells.GetCell(c).GetBounds() for c in range(counts[k])])
            at, radius = view["Points"][rows], view["PointData/radius"][rows]
            outside = np.maximum(bounds[:, 0::2] - at, at - bounds[:, 1::2]).max(axis=1)
            if (outside > 1e-9 * radius).any():
                fail(f"a shape of state {k} of {path} is not about the place of its grain")
            if flat:
                sizes = vtkCellSizeFilter()
                sizes.SetInputData(cells)
                sizes.Update()
                area = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Area"))
                shaped = area > 0.0
                # The polygon of a disk has 16 corners: 8 sin(pi/8) over pi of its area. A rounded
                # corner is divided finer.
                off = np.abs(area[shaped] / (np.pi * radius[shaped] ** 2) - 1.0)
                largest = max(largest, off.max(initial=0.0))
        if largest > 1.001 * (1.0 - 8.0 * np.sin(np.pi / 8.0) / np.pi):
            fail(f"a shape of {path} has an area that is not that of its grain: {100.0 * largest:.1f} % off")
        print(f"VTK and h5py shapes: {len(counts)} states, areas within {100.0 * largest:.1f} % of those of the grains")


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
        if name in ARRAYS:
            check_arrays(name, data)
        seen.append((times[k], data.GetNumberOfPoints(), data.GetNumberOfCells(), arrays))
    print(f"VTK {vtkVersion.GetVTKVersion()} {name}: " + "; ".join(
        f"t {t:.4e}: {p} points, {c} cells, {a} arrays" for t, p, c, a in seen))


def check_image(path):
    """VTK's image of a patch has the cells and the values that h5py reads, and the load."""
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.util.numpy_support import vtk_to_numpy

    reader = vtkHDFReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    with h5py.File(path.removesuffix(".vtkhdf") + ".h5", "r") as file:
        axes = [file[name][:] for name in ("x", "y") if name in file]
        states = file["states"][:] if "states" in file else [None]
        for k, state in enumerate(states):
            reader.SetStep(k)
            reader.Update()
            image = reader.GetOutputDataObject(0)
            for axis, places in enumerate(axes):
                first = image.GetOrigin()[axis] + 0.5 * image.GetSpacing()[axis]
                expected = first + image.GetSpacing()[axis] * np.arange(image.GetDimensions()[axis] - 1)
                if not np.allclose(expected, places, rtol=0.0, atol=1e-9 * image.GetSpacing()[axis]):
                    fail(f"the cells of {path} are not those of its axes")
            for name, values in file["fields"].items():
                seen = vtk_to_numpy(image.GetCellData().GetArray(name))
                own = values[k] if state is not None else values[:]
                if not np.array_equal(seen, own.ravel(), equal_nan=True):
                    fail(f"VTK reads other values of {name} than h5py in state {k} of {path}")
        print(f"VTK and h5py {os.path.basename(path)}: {len(states)} states of {sorted(file['fields'])}")
        if "pressure" in file["fields"]:
            return file["fields/pressure"][0].sum() * np.prod([places[1] - places[0] for places in axes if len(places) > 1])
    return None


def check_patch(folder):
    """The images of a patch; pressures over its cells carry the load."""
    with open(os.path.join(folder, "patch.json")) as file:
        answer = json.load(file)
    for name in sorted(os.listdir(folder)):
        if name.endswith(".vtkhdf"):
            load = check_image(os.path.join(folder, name))
            if name == "patch.vtkhdf" and min(answer["cells"]) > 1 and abs(load / answer["load"] - 1.0) > 1e-9:
                fail(f"the pressures of {name} carry {load} N of {answer['load']} N")


def main():
    live = "--live" in sys.argv
    folders = [a for a in sys.argv[1:] if not a.startswith("--")]
    if len(folders) != 1:
        sys.exit(__doc__)
    if os.path.exists(os.path.join(folders[0], "patch.json")):
        check_patch(folders[0])
        print("all readable")
        return
    path = os.path.join(folders[0], "results.h5")
    if not os.path.exists(path):
        fail(f"there is no {path}")
    check_h5(path, live)
    if not live:
        check_vtk(path, "results.h5")
        check_shapes(folders[0])
        missing = [name for name in ("grains", "contacts", "bodies") if not os.path.exists(os.path.join(folders[0], f"{name}.vtkhdf"))]
        if missing:
            fail(f"there is no {missing[0]}.vtkhdf in {folders[0]}")
        for file in sorted(os.listdir(folders[0])):
            if file.endswith(".vtkhdf"):
                check_vtk(os.path.join(folders[0], file), file.removesuffix(".vtkhdf"))
    print("all readable")


if __name__ == "__main__":
    main()
