"""Reads a file by the rules of FCLIB's HDF5 layout (types, shapes, storage, order of indices) and recomputes
the error of its solution with numpy, without a line of Fretwork.

    python3 tests/check_fclib.py FILE.hdf5 [...]        needs h5py and numpy

Exit 0: every file keeps to the layout. 1: the first rule that one breaks is printed.
The error is |r - proj_K(r - (u + mu |u_T| e_N))| / max(|q|, |r|, |u|) of the local form.
"""

import sys

import h5py
import numpy as np


def need(condition, what):
    if not condition:
        raise SystemExit(f"broken rule: {what}")


def plain(dataset):
    """Contiguous, no filter."""
    plist = dataset.id.get_create_plist()
    need(plist.get_layout() == h5py.h5d.CONTIGUOUS, f"{dataset.name} is contiguous")
    need(plist.get_nfilters() == 0, f"{dataset.name} has no filter")


def array(group, name, dtype, length=None):
    need(name in group, f"{group.name}/{name} is there")
    dataset = group[name]
    plain(dataset)
    need(dataset.ndim == 1, f"{dataset.name} has rank 1")
    need(dataset.dtype == np.dtype(dtype), f"{dataset.name} is {dtype}, not {dataset.dtype}")
    need(length is None or len(dataset) == length, f"{dataset.name} has {length} values")
    return dataset[...]


def integer(group, name):
    return int(array(group, name, "<i4", 1)[0])


def matrix(group, name):
    g = group[name]
    rows, columns, nzmax, nz = (integer(g, part) for part in ("m", "n", "nzmax", "nz"))
    out = np.zeros((rows, columns))
    if nz >= 0:
        need(nzmax >= nz, f"{g.name}/nzmax is at least nz")
        column, row = array(g, "p", "<i4")[:nz], array(g, "i", "<i4")[:nz]
        value = array(g, "x", "<f8")[:nz]
    else:
        need(nz in (-1, -2), f"{g.name}/nz is a code of storage")
        lines = columns if nz == -1 else rows
        p = array(g, "p", "<i4", lines + 1)
        other, value = array(g, "i", "<i4", nzmax), array(g, "x", "<f8", nzmax)
        need(p[0] == 0 and p[-1] == nzmax and (np.diff(p) >= 0).all(), f"{g.name}/p are pointers")
        line = np.repeat(np.arange(lines), np.diff(p))
        row, column = (other, line) if nz == -1 else (line, other)
    need(len(row) == len(column) == len(value), f"{g.name} has arrays of one length")
    for index, size, part in ((row, rows, "row"), (column, columns, "column")):
        need(((index >= 0) & (index < size)).all(), f"{g.name}: {part} indices are 0-based and inside")
    np.add.at(out, (row, column), value)
    return out


def text(group, name):
    dataset = group[name]
    kind = h5py.check_string_dtype(dataset.dtype)
    need(dataset.shape == () and kind and kind.length, f"{dataset.name} is one text of fixed length")
    stored = dataset.id.get_type()
    need(stored.get_strpad() == h5py.h5t.STR_NULLTERM, f"{dataset.name} is null-terminated")
    need(stored.get_cset() == h5py.h5t.CSET_ASCII, f"{dataset.name} is ASCII")
    return dataset[()].decode("ascii", "replace")


def error(d, mu, r, u, q):
    r, u = r.reshape(-1, d), u.reshape(-1, d)
    z = r - u
    z[:, 0] -= mu * np.linalg.norm(u[:, 1:], axis=1)
    t = np.linalg.norm(z[:, 1:], axis=1)
    foot = np.maximum((z[:, 0] + mu * t) / (1 + mu**2), 0)
    outside = t > mu * z[:, 0]
    z[outside, 1:] *= (mu * foot / np.where(t > 0, t, 1))[outside, None]
    z[outside, 0] = foot[outside]
    scale = max(np.linalg.norm(q), np.linalg.norm(r), np.linalg.norm(u))
    return np.linalg.norm(r - z) / (scale or 1)


def check(path):
    with h5py.File(path) as file:
        names = [n for n in ("fclib_local", "fclib_global") if n in file]
        need(len(names) == 1, "one of /fclib_local and /fclib_global")
        g = file[names[0]]
        d, vectors = integer(g, "spacedim"), g["vectors"]
        need(d in (2, 3), "spacedim is 2 or 3")
        if "info" in g:
            for name in ("title", "description", "math_info"):
                text(g["info"], name)
        mu = array(vectors, "mu", "<f8")
        m, n, p = d * len(mu), 0, 0
        if names == ["fclib_local"]:
            w, q = matrix(g, "W"), array(vectors, "q", "<f8", m)
            need(w.shape == (m, m), "W is square, as long as q")
            if "V" in g or "R" in g:
                v, r, s = matrix(g, "V"), matrix(g, "R"), array(vectors, "s", "<f8")
                p = len(s)
                need(v.shape == (m, p) and r.shape == (p, p), "V and R have the sizes of q and s")
                w, q = w - v @ np.linalg.solve(r, v.T), q - v @ np.linalg.solve(r, s)
        else:
            mass, h = matrix(g, "M"), matrix(g, "H")
            f, free = array(vectors, "f", "<f8"), array(vectors, "w", "<f8", m)
            n = len(f)
            need(mass.shape == (n, n) and h.shape == (n, m), "M and H have the sizes of f and w")
            gg, b = np.zeros((n, 0)), np.zeros(0)
            if "G" in g:
                gg, b = matrix(g, "G"), array(vectors, "b", "<f8")
                p = len(b)
                need(gg.shape == (n, p), "G has the sizes of f and b")
            saddle = np.block([[mass, -gg], [gg.T, np.zeros((p, p))]])
            tall, load = np.vstack([h, np.zeros((p, m))]), np.concatenate([f, -b])
            w, q = tall.T @ np.linalg.solve(saddle, tall), tall.T @ np.linalg.solve(saddle, load) + free
        line = f"{path}: {names[0]}, dimension {d}, {len(mu)} contacts"
        if "solution" in file:
            s = file["solution"]
            r, u = array(s, "r", "<f8", m), array(s, "u", "<f8", m)
            gap = np.abs(u - (w @ r + q)).max(initial=0)
            need(not r.any() or gap <= 1e-8 * max(np.abs(u).max(), np.abs(q).max()), f"u = W r + q ({gap:.1e})")
            if n:
                v = array(s, "v", "<f8", n)
                l = array(s, "l", "<f8", p) if p else np.zeros(0)
                parts = [mass @ v, h @ r, gg @ l, f]
                gap = np.abs(parts[0] - parts[1] - parts[2] - parts[3]).max(initial=0)
                scale = max(np.abs(x).max(initial=0) for x in parts)
                need(not r.any() or gap <= 1e-8 * scale, f"M v = H r + G l + f ({gap:.1e})")
            line += f", error {error(d, mu, r, w @ r + q, q):.6e}"
        print(line)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    for name in sys.argv[1:]:
        check(name)
