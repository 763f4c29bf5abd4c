"""Makes the foreign_*.hdf5 files beside this one with h5py: what other writers do that ours does not.

    cd tests/fclib && python3 make_foreign.py
"""

import h5py
import numpy as np


def problem(name, q=None, **how):
    """One contact in the plane, W = diag(2, 1), q = (-1, 0)."""
    with h5py.File(name, "w", libver="latest") as file:
        g = file.create_group("fclib_local")
        g.create_dataset("spacedim", data=np.array([2], "i4"))
        w = g.create_group("W")
        for part, data in {
            "m": [2], "n": [2], "nz": [-2], "nzmax": [2], "p": [0, 1, 2], "i": [0, 1]
        }.items():
            w.create_dataset(part, data=np.array(data, how.get("whole", "i4")))
        w.create_dataset("x", data=np.array([2, 1], how.get("real", "f8")))
        v = g.create_group("vectors")
        v.create_dataset("mu", data=np.array([0.5], how.get("real", "f8")))
        if q:
            q(v)
        else:
            v.create_dataset("q", data=np.array([-1.0, 0.0]))
        return how.get("more", lambda file: None)(file)


def dress(file):
    """Attributes, texts that are no text, groups that nobody asked for, a solution never written."""
    g = file["fclib_local"]
    g["W"].attrs["cond"] = np.nan
    g["W"].attrs["symmetry"] = True
    info = g.create_group("info")
    info.attrs["numberOfInvolvedDS"] = np.int64(1)
    info.create_dataset("title", data=np.array(b"caf\xe9 \x1b[2J \xa8", "S"))
    info.create_dataset("description", data="of any length")
    info.create_dataset("math_info", data=np.arange(3))
    for name in "ur":
        file.create_dataset(f"solution/{name}", (2,), "f8")
    file.create_group("guesses").create_dataset("number_of_guesses", data=np.array([0], "i4"))


problem("foreign_types.hdf5", whole=">i8", real=">f4", more=dress)
problem("foreign_unwritten.hdf5", q=lambda v: v.create_dataset("q", (2,), "f8"))
problem("foreign_huge.hdf5", q=lambda v: v.create_dataset("q", (10**12,), "f8"))
problem("foreign_chunked.hdf5", q=lambda v: v.create_dataset("q", data=[-1.0, 0.0], chunks=(2,), compression="gzip"))
problem("foreign_outside.hdf5", q=lambda v: v.create_dataset("q", (2,), "f8", external=[("/etc/hostname", 0, 16)]))
problem("foreign_linked.hdf5", q=lambda v: v.__setitem__("q", h5py.ExternalLink("foreign_types.hdf5", "/fclib_local/vectors/q")))
