#!/usr/bin/env python3
"""Writes the shear stress of compressed powders against slip distance, hou_*.csv, from the published straight lines.

K. Hou, J. Kalousek, E. Magel, Wear 211 (1997) 134-140, sheared powders between steel under 900 MPa; the lines
tau = tau_c0 + k_u (u - u_c0) for slip distances u above an elastic limit u_c0 are those that the program CONTACT
(E. Vollebregt) has for its third-body layer. Measured points and their errors are not published with them. The standard
deviation is therefore assumed: 5 % of the stress and 0.5 % of the pressure. The abscissa is the slip beyond the elastic
limit, u - u_c0, since the elastic part contains the apparatus and a layer of unknown thickness.

    python3 fits/hou.py
"""

from pathlib import Path

PRESSURE = 900.0  # MPa

# u_c0 (mm), tau_c0 (MPa), k_u (MPa/mm)
POWDERS = {
    "magnetite": (0.070, 560.0, 0.0),
    "clay": (0.040, 200.0, 400.0),
    "sand": (0.050, 400.0, -200.0),
    "molybdenum_disulfide": (0.020, 20.0, 20.0),
}

for name, (elastic, stress, slope) in POWDERS.items():
    lines = [
        f"# {name} under {PRESSURE:.0f} MPa, from tau = {stress:g} + {slope:g} (u - {elastic:g}), u in mm: fits/hou.py",
        "slip beyond the elastic limit [mm],shear stress [MPa],standard deviation [MPa]",
    ]
    for k in range(1, 7):
        slip = 0.01 * k
        tau = stress + slope * slip
        lines.append(f"{slip:.3f},{tau:.1f},{0.05 * tau + 0.005 * PRESSURE:.1f}")
    Path(__file__).with_name(f"hou_{name}.csv").write_text("\n".join(lines) + "\n")
