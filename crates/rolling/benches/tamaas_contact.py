"""A rough ball on a flat by Tamaas, for `cargo bench -p fretwork-rolling`.

    python3 tamaas_contact.py HEIGHTS CELLS EXTENT MODULUS LOAD TOLERANCE PRESSURES

HEIGHTS: file of 8-byte numbers, CELLS x CELLS, distances of the bodies (m) over a square of side
EXTENT (m); MODULUS: E* (Pa); LOAD (N). Without periods. Writes the pressures (Pa) to a file, and
prints the wall-clock time (s) of the solution on one thread, without that of set-up.
"""

import sys
import time

import numpy as np
import tamaas as tm


def main():
    heights, cells, extent, modulus, load, tolerance, pressures = sys.argv[1:]
    cells = int(cells)
    extent, modulus, load, tolerance = map(float, (extent, modulus, load, tolerance))
    tm.initialize(1)
    tm.set_log_level(tm.LogLevel.error)
    surface = -np.fromfile(heights).reshape(cells, cells)
    model = tm.Model(tm.model_type.basic_2d, [extent, extent], [cells, cells])
    model.E, model.nu = modulus, 0.0
    tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    by_pressure = tm.PolonskyKeerRey.pressure
    solver = tm.PolonskyKeerRey(model, surface, tolerance, by_pressure, by_pressure)
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 10_000
    # The mean pressure stands for the load.
    start = time.perf_counter()
    solver.solve(load / extent**2)
    print(time.perf_counter() - start)
    np.asarray(model.traction, dtype=float).tofile(pressures)


if __name__ == "__main__":
    main()
