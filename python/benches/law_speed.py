"""What a law in Python costs per contact, beside the same law in C: python benches/law_speed.py

The C laws are those that `fretwork law new --lang c` writes, built with cc -O2 and with -O3, the Python laws those of `laws.py`. One
program calls all of them in turn, so that what disturbs one disturbs the others; of each the least time of many rounds counts.
A batch is that of a step: columns of the contacts of an interface.
"""

import argparse
import ctypes
import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from fretwork.law import header, link
from laws import LAWS

TEMPLATES = Path(__file__).parents[2] / "crates/core/src/laws/kind/templates"

HARNESS = r"""
#define _POSIX_C_SOURCE 199309L
#include <time.h>
#include "fretwork.h"
@COLUMNS@
static double now(void) { struct timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return 1e9 * (double)t.tv_sec + (double)t.tv_nsec; }
/* Least time per contact (ns) of each law; the columns are those of `columns`, in the order of the struct. */
int measure(const fw_plugin *const *laws, int count, int slot, size_t n, unsigned dimension, const double *const *given, double **written,
            int rounds, int calls, double *best) {
    char text[1024];
    for (int law = 0; law < count; law++) best[law] = 1e300;
    for (int round = 0; round < rounds; round++) {
        for (int law = 0; law < count; law++) {
            double values[16];
            for (size_t p = 0; p < laws[law]->n_parameters; p++) values[p] = laws[law]->parameters[p].default_value;
            fw_message m = {sizeof m, text, sizeof text, -1};
            fw_batch b = {.size = sizeof b, .n = n, .dimension = dimension, .h = 1e-4, .theta = 0.5, .degradation = 1.0, .parameters = values};
            fill(&b, given, written, dimension);
            fw_call call = slot == 0 ? laws[law]->prepare : slot == 1 ? laws[law]->commit : laws[law]->energy;
            double start = now();
            for (int k = 0; k < calls; k++) if (call(&b, &m) != FW_OK) return 1;
            double each = (now() - start) / ((double)calls * (double)n);
            if (each < best[law]) best[law] = each;
        }
    }
    return 0;
}
"""

#: Sizes of the inputs (SI): everything else is of the order of one.
SCALES = {"opening_n": 1e-6, "opening_t1": 1e-6, "opening_t2": 1e-6, "impulse_n": 1e-3, "slip": 1e-6, "energy_intact": 0.1}
SCALES |= {"intact_n": 4e5, "intact_t1": 1e5, "intact_t2": 1e5, "damage": 0.5}


def build_c(source: str, output: Path, optimise: str) -> None:
    folder = output.parent
    (folder / "fretwork.h").write_text(header.text())
    file = output.with_suffix(".c")
    file.write_text(source)
    subprocess.run(["cc", optimise, "-std=c11", "-shared", "-fPIC", "-o", str(output), str(file), "-lm"], check=True)


def harness(folder: Path) -> ctypes.CDLL:
    spatial = re.compile(r"_t2$|^rotation_n$|moment_n$")
    lines = ["static void fill(fw_batch *b, const double *const *given, double **written, unsigned dimension) {"]
    for what, names in (("given", header.columns()), ("written", header.outputs())):
        for k, name in enumerate(names):
            null = "dimension == 2 ? 0 : " if spatial.search(name) else ""
            lines.append(f"    b->{name} = {null}{what}[{k}];")
    output = folder / "harness.so"
    build_c(HARNESS.replace("@COLUMNS@", "\n".join([*lines, "}"])), output, "-O2")
    library = ctypes.CDLL(str(output))
    library.measure.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_int, ctypes.c_size_t, ctypes.c_uint]
    library.measure.argtypes += [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int, ctypes.c_int, ctypes.c_void_p]
    return library


def table(path: Path) -> int:
    entry = ctypes.CDLL(str(path)).fretwork_plugin
    entry.restype = ctypes.c_void_p
    return entry()


def columns(n: int) -> tuple[list[np.ndarray], list[np.ndarray]]:
    numbers = np.random.default_rng(1)
    given = [SCALES.get(name, 1.0) * numbers.uniform(0.0, 1.0, n) for name in header.columns()]
    return given, [np.zeros(n) for _ in header.outputs()]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=500)
    parser.add_argument("--contacts", type=int, nargs="*", default=[16, 256, 4096])
    chosen = parser.parse_args()
    worst = 0.0
    print(f"{'law':<28} {'call':<8} dim contacts   C -O2   C -O3  Python   (ns a contact)   Python/-O2  Python/-O3")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run = harness(folder)
        for law in LAWS:
            source = (TEMPLATES / f"{law.kind}.c").read_text()
            source = source.replace("@NAME@", law.name).replace("@KIND@", law.kind).replace("@KINDUP@", law.kind.upper())
            paths = [folder / f"{law.kind}_{level}.so" for level in (2, 3)]
            for path, level in zip(paths, (2, 3), strict=True):
                build_c(source, path, f"-O{level}")
            paths.append(law.build(folder / "python"))
            tables = (ctypes.c_void_p * 3)(*(table(path) for path in paths))
            slots = {"contact": ["prepare"], "cohesion": ["prepare", "energy"]}.get(law.kind, ["commit"])
            for slot in slots:
                for dimension in (2, 3):
                    for n in chosen.contacts:
                        given, written = columns(n)
                        inputs = (ctypes.c_void_p * len(given))(*(c.ctypes.data for c in given))
                        outputs = (ctypes.c_void_p * len(written))(*(c.ctypes.data for c in written))
                        best = np.zeros(3)
                        calls = max(1, 20_000 // n)
                        place = ["prepare", "commit", "energy"].index(slot)
                        refused = run.measure(tables, 3, place, n, dimension, inputs, outputs, chosen.rounds, calls, best.ctypes.data)
                        if refused:
                            raise SystemExit(f"{law.name}: a law refuses the batch")
                        ratios = best[2] / best[:2]
                        worst = max(worst, best[2] / best[:2].min())
                        print(
                            f"{law.name:<28} {slot:<8} {dimension}D {n:>9} {best[0]:>7.2f} {best[1]:>7.2f} {best[2]:>7.2f}"
                            f"{ratios[0]:>29.2f} {ratios[1]:>11.2f}"
                        )
    print(f"Python over the faster of both builds of C, at most: {worst:.2f} ({link.compiler()[0]})")


if __name__ == "__main__":
    main()
