"""Results of a run: the files of its folder as tables, arrays over time and meshes.

The files are read by h5py, the reader that results are tested with, and not by the compiled part: one reader less to keep right, and
files of other versions, of runs that are still going on or were killed open all the same.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

from ._errors import InputError, need
from ._plot import described, figure_of

if TYPE_CHECKING:
    import h5py
    import pandas as pd
    import pyvista as pv
    import xarray as xr
    from matplotlib.figure import Figure

AXES = ("x", "y", "z")


def _attributes(data: Any) -> dict[str, str]:
    """Unit and explanation of a dataset, in the words of the CF conventions."""
    return {"units": _text(data.attrs.get("unit", "")) or "1", "long_name": _text(data.attrs.get("doc", ""))}


def _text(value: Any) -> str:
    """A text of a file, which h5py gives as bytes or as str."""
    return value.decode() if isinstance(value, bytes) else str(value)


class Results:
    """Results of a run, by their folder. Each property reads the files when it is asked for."""

    def __init__(self, folder: Union[str, PathLike[str]]) -> None:
        self.folder = Path(os.fspath(folder))
        """The folder."""
        if not (self.folder / "results.h5").is_file() and not (self.folder / "summary.json").is_file():
            text = f"{self.folder}: it has no results of a run; give the folder that the run wrote, out=..."
            raise InputError(text, str(self.folder), expected="a folder with results.h5")

    @property
    def summary(self) -> dict[str, Any]:
        """The summary of the run (``summary.json``). A run that goes on, or was killed, has none yet."""
        path = self.folder / "summary.json"
        try:
            result: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            text = f"{path}: it is written at the end of a run; resume the run (resume=True), or look at statistics"
            raise InputError(text, str(path)) from None
        return result

    @property
    def warnings(self) -> list[str]:
        """Warnings of the run, worst first."""
        result: list[str] = self.summary["warnings"]
        return result

    @property
    def quantities(self) -> dict[str, dict[str, Any]]:
        """What each path of the summary is, ``*`` standing for the places of a list: ``unit`` (``"1"`` for pure numbers, none of
        texts), ``doc``, ``role``, ``topic``, ``label``, and ``estimate`` with half-widths by cause where they were estimated."""
        return {entry["path"]: entry for entry in self.summary.get("quantities", [])}

    @property
    def trustworthy(self) -> bool:
        """Whether all checks of the run passed."""
        return bool(self.summary["trustworthy"])

    @property
    def grade(self) -> str:
        """Trust in the run: ``not trustworthy``, ``consistent``, or ``error known``; empty for runs of version 0.1.0."""
        return str(self.summary.get("grade", ""))

    @contextmanager
    def open(self) -> Iterator[h5py.File]:
        """The file ``results.h5`` in h5py, also while a run writes it."""
        h5py = need("h5py", "results", "reading fields of results")
        path = self.folder / "results.h5"
        if not path.is_file():
            raise InputError(f"{path}: there is no such file", str(path))
        with h5py.File(path, "r", locking=False, swmr=True) as file:
            yield file

    @property
    def case(self) -> str:
        """The text of the case as it was run."""
        with self.open() as file:
            text = file["case"][0]
        return _text(text)

    @property
    def statistics(self) -> pd.DataFrame:
        """The statistics as a table, one row a line of ``statistics.csv`` with the same numbers. ``attrs`` has two dictionaries by
        column: ``units``, and ``long_name`` with the explanations."""
        pandas = need("pandas", "results", "the table of statistics")
        np = need("numpy", "results", "arrays")
        path = self.folder / "statistics.csv"
        if not path.is_file():
            raise InputError(f"{path}: there is no such file", str(path))
        with open(path, encoding="utf-8") as file:
            headings = file.readline().rstrip("\n").split(",")
            # The last line of a run that goes on may be cut.
            rows = [line for line in file if line.endswith("\n")]
        # Numbers are written with as many digits as their bits need, and are read back to the same
        # bits.
        values = np.loadtxt(rows, delimiter=",", ndmin=2) if rows else np.empty((0, len(headings)))
        units = {}
        for heading in headings:
            name, _, unit = heading.partition(" [")
            units[name] = unit.rstrip("]") or "1"
        names = list(units)
        table: pd.DataFrame = pandas.DataFrame(values[:, : len(names)], columns=names)
        table.attrs["units"] = units
        with self.open() as file:
            columns = file["statistics"]
            result = {n: _attributes(columns[n])["long_name"] for n in names if n in columns}
        table.attrs["long_name"] = result
        return table

    @property
    def events(self) -> dict[str, xr.Dataset]:
        """Tables of events by their names, also those of observers: ``(event,)``, with the columns of ``/events/NAME``. A column with
        any number of values for each event, such as ``grains`` of ``debris``, has a dimension of its own name with ``_value``."""
        xarray, np = need("xarray", "results", "tables of events"), need("numpy", "results", "arrays")
        result: dict[str, xr.Dataset] = {}
        with self.open() as file:
            for table, columns in file.get("events", {}).items():
                values = {name: np.asarray(data[:]) for name, data in columns.items()}
                listed = _text(columns.attrs.get("list", ""))
                # A run that goes on may have written more of one column than of another.
                rows = min((len(v) for name, v in values.items() if name != listed), default=0)
                fields = {
                    name: (f"{name}_value", v, _attributes(columns[name])) if name == listed else ("event", v[:rows], _attributes(columns[name]))
                    for name, v in values.items()
                }
                result[table] = xarray.Dataset(fields, attrs=self._said(file))
        return result

    @property
    def grains(self) -> xr.Dataset:
        """Balls and other parts of grains and first bodies over time: ``(time, grain)``, vectors ``(time, grain, axis)``, with the
        fields of ``results.h5``."""
        xarray, np = need("xarray", "results", "fields over time"), need("numpy", "results", "arrays")
        with self.open() as file:
            view = file["views/grains"]
            times, counts = view["Steps/Values"][:], view["NumberOfPoints"][:]
            if len(set(counts.tolist())) > 1:
                raise InputError(f"{self.folder}: the number of grains changes over time; read it with open()")
            shape = (len(times), int(counts[0]) if len(counts) else 0)
            rows = shape[0] * shape[1]
            dims = ("time", "grain")
            fields: dict[str, Any] = {
                name: ((*dims, "axis")[: 1 + data.ndim], np.asarray(data[:rows]).reshape(*shape, *data.shape[1:]), _attributes(data))
                for name, data in view["PointData"].items()
            }
            points = view["Points"]
            at = np.asarray(points[:rows]).reshape(*shape, 3)
            fields["position"] = ((*dims, "axis"), at, {"units": "m", "long_name": "centres"})
            coordinates = {"time": ("time", times, {"units": "s", "long_name": "time"}), "axis": list(AXES)}
            if "id" in fields and shape[0]:
                _, ids, said = fields.pop("id")
                coordinates["id"] = ("grain", ids[0].astype(np.int64), said)
            result: xr.Dataset = xarray.Dataset(fields, coordinates, self._said(file))
            return result

    @property
    def contacts(self) -> xr.Dataset:
        """Contacts at all recorded times, one after another: ``(contact,)`` with the coordinates ``time`` and ``record``, the number
        of the recorded time. ``contacts.sel(contact=contacts.record == 3)`` has those of one time. ``ends`` are the places of candidate and antagonist."""
        xarray, np = need("xarray", "results", "fields over time"), need("numpy", "results", "arrays")
        with self.open() as file:
            view = file["views/contacts"]
            times, counts = view["Steps/Values"][:], view["Lines/NumberOfCells"][:]
            rows = int(counts.sum())
            fields: dict[str, Any] = {
                name: (("contact", "axis")[: data.ndim], np.asarray(data[:rows]), _attributes(data))
                for name, data in view["CellData"].items()
            }
            ends = np.asarray(view["Points"][: 2 * rows]).reshape(rows, 2, 3)
            said = {"units": "m", "long_name": "the ends of its line: candidate and antagonist"}
            fields["ends"] = (("contact", "end", "axis"), ends, said)
            state = np.repeat(np.arange(len(times)), counts)
            coordinates = {
                "time": ("contact", times[state], {"units": "s", "long_name": "time"}),
                "record": ("contact", state, {"long_name": "number of the recorded time"}),
                "axis": list(AXES),
                "end": ["candidate", "antagonist"],
            }
            result: xr.Dataset = xarray.Dataset(fields, coordinates, self._said(file))
            return result

    @property
    def bodies(self) -> xr.Dataset:
        """First bodies over time: ``position``, ``velocity`` and ``force`` of all contacts, ``(time, body, axis)``, at the rows of
        the statistics."""
        xarray, np = need("xarray", "results", "fields over time"), need("numpy", "results", "arrays")
        with self.open() as file:
            columns = file["statistics"]
            names = [n.removesuffix("_fx") for n in columns if n.endswith("_fx")]
            names = [n for n in names if f"{n}_vx" in columns and f"{n}_x" in columns]
            axes = [a for a in AXES if all(f"{n}_f{a}" in columns for n in names)] if names else []
            times = columns["time"][:]
            size = len(times)
            fields: dict[str, Any] = {}
            for field, letter in (("position", ""), ("velocity", "v"), ("force", "f")):
                values = np.full((size, len(names), len(axes)), np.nan)
                said = {}
                for b, name in enumerate(names):
                    for k, axis in enumerate(axes):
                        data = columns[f"{name}_{letter}{axis}"]
                        values[:, b, k] = data[:size]
                        said = _attributes(data)
                fields[field] = (("time", "body", "axis"), values, said)
            coordinates = {
                "time": ("time", times, {"units": "s", "long_name": "time"}),
                "body": names,
                "axis": axes,
            }
            result: xr.Dataset = xarray.Dataset(fields, coordinates, self._said(file))
            return result

    @staticmethod
    def _said(file: h5py.File) -> dict[str, Any]:
        return {"title": _text(file.attrs["case"]), "units": _text(file.attrs["units"])}

    @property
    def views(self) -> list[str]:
        """What :meth:`mesh` can show."""
        with self.open() as file:
            views = file["views"]
            found = []
            for name, group in views.items():
                found += [name] if "Steps" in group else [f"{name}/{inner}" for inner in group]
            return found

    @property
    def times(self) -> list[float]:
        """The recorded times (s) of grains, contacts and meshes."""
        with self.open() as file:
            result: list[float] = file["views/grains/Steps/Values"][:].tolist()
            return result

    def mesh(self, state: int = -1, view: str = "grains") -> pv.DataSet:
        """A recorded state as a mesh of pyvista, with its fields. ``state`` counts the recorded :attr:`times`, negative from the
        end; ``view`` is one of :attr:`views`."""
        pyvista, np = need("pyvista", "mesh", "meshes"), need("numpy", "mesh", "arrays")
        with self.open() as file:
            group = file["views"].get(view)
            if group is None or "Steps" not in group:
                text = f"{self.folder}: there is no view `{view}`; there are {', '.join(self.views)}"
                raise InputError(text, str(self.folder))
            steps = group["Steps"]
            size = len(steps["Values"])
            if not -size <= state < size:
                raise IndexError(f"there are {size} recorded states of {view}")
            state %= size
            part = int(steps["PartOffsets"][state])
            count = int(group["NumberOfPoints"][part])
            first = int(steps["PointOffsets"][state])
            points = group["Points"][first : first + count]
            cells: tuple[str, ...]
            if "Types" in group:
                offsets, corners = group["Offsets"][:], group["Connectivity"][:]
                mesh = pyvista.UnstructuredGrid(_cells(offsets, corners, np), group["Types"][:], points)
                of_cells = mesh.n_cells
            else:
                mesh = pyvista.PolyData()
                mesh.points = points
                cells = ("Vertices", "Lines", "Polygons", "Strips")
                of_cells = 0
                for k, (kind, slot) in enumerate(zip(cells, ("verts", "lines", "faces", "strips"))):
                    number = int(group[kind]["NumberOfCells"][part])
                    start = int(steps["CellOffsets"][state][k]) + part
                    at = int(steps["ConnectivityIdOffsets"][state][k])
                    used = int(group[kind]["NumberOfConnectivityIds"][part])
                    offsets = group[kind]["Offsets"][start : start + number + 1]
                    corners = group[kind]["Connectivity"][at : at + used]
                    if number:
                        setattr(mesh, slot, _cells(offsets, corners, np))
                    of_cells += number
            for place, rows, data in (("PointData", count, mesh.point_data), ("CellData", of_cells, mesh.cell_data)):
                for name, values in group.get(place, {}).items():
                    begin = int(steps[f"{place}Offsets/{name}"][state])
                    data[name] = values[begin : begin + rows]
            mesh.field_data["time"] = [float(steps["Values"][state])]
            result: pv.DataSet = mesh
            return result

    def plot(self, *names: str, against: str = "time") -> Figure:
        """Draws columns of the :attr:`statistics` against another, side by side, with matplotlib; a notebook shows the figure.

        Without names it draws columns of the first figures that the run itself draws, such as the loops of a friction test.
        ``results.plot("Q", against="delta")`` draws a loop, ``figure.axes`` changes
        what is drawn, and ``figure.savefig("loop.png")`` writes it. The run may still go on.
        """
        return figure_of(self.statistics, described(self.folder), names, against)

    def _repr_html_(self) -> str:
        """What a notebook shows of it: the trust in the run, the main results with their half-widths, the warnings."""
        path = self.folder / "summary.json"
        where = escape(str(self.folder))
        if not path.is_file():
            return f"<p>{where}: the run goes on, or was stopped; <code>statistics</code> and <code>plot()</code> show it so far.</p>"
        summary, quantities = self.summary, self.quantities
        headlines = [name for name, entry in quantities.items() if entry.get("role") == "headline" and "*" not in name]
        rows: list[str] = []
        for name in headlines or [name for name, entry in quantities.items() if entry.get("role") == "secondary" and "*" not in name]:
            entry = quantities[name]
            value: Any = summary
            for part in name.split("."):
                value = value.get(part) if isinstance(value, dict) else None
            if not isinstance(value, (int, float)) or isinstance(value, bool):
                continue
            estimate = entry.get("estimate") or {}
            widths = [estimate[of] for of in ("scatter", "step", "tolerance") if estimate.get(of) is not None]
            half = ""
            if widths:
                width = sum(w * w for w in widths) ** 0.5
                determined = estimate.get("determined")
                half = f" ± {width:.2g}" if determined or (determined is None and width <= 0.25 * abs(value)) else " (not determined)"
            unit = "" if entry.get("unit") == "1" else escape(str(entry.get("unit", "")))
            label = escape(str(entry.get("label") or entry.get("doc", name)))
            rows.append(f"<tr><td style='text-align:left'>{label}</td><td>{value:.4g}{half}</td><td style='text-align:left'>{unit}</td></tr>")
        warned = "".join(f"<li>{escape(text)}</li>" for text in self.warnings)
        return (
            f"<p><b>{escape(self.grade or ('trustworthy' if self.trustworthy else 'not trustworthy'))}</b>, {where}</p>"
            f"<table>{''.join(rows)}</table>" + (f"<ul>{warned}</ul>" if warned else "")
        )

    def __repr__(self) -> str:
        return f"Results({str(self.folder)!r})"


def _cells(offsets: Any, corners: Any, np: Any) -> Any:
    """Cells as pyvista takes them: before the corners of each their number."""
    sizes = np.diff(offsets)
    return np.insert(corners, offsets[:-1] - offsets[0], sizes) if len(sizes) else np.array([], int)
