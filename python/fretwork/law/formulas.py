"""Inputs that follow from columns of the header, and functions for laws. They are compiled with the law that uses them.

The formulas are those of the crate `fretwork-law` for laws in Rust, in the same order of operations, so that the same law
gives the same bits in both languages.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable

_LARGEST = 1.7976931348623157e308

#: Returned in place of an answer, it asks the host for a smaller time step (a case with `accuracy`
#: then halves the step).
SMALLER_STEP: float = struct.unpack("<d", struct.pack("<Q", 0x7FF8_F2E7_0511_57E9))[0]


def _length(a: float, b: float) -> float:
    """hypot, which is |a| for the b of two dimensions: a constant there, so that the call is compiled away."""
    return abs(a) if b == 0.0 else math.hypot(a, b)


def sliding_speed(velocity_t1: float, velocity_t2: float) -> float:
    """Tangential speed (m/s)."""
    return _length(velocity_t1, velocity_t2)


def approach_speed(velocity_n: float) -> float:
    """Speed of approach along the normal (m/s), zero where the bodies separate."""
    return max(-velocity_n, 0.0)


def opening_t(opening_t1: float, opening_t2: float) -> float:
    """Norm of the tangential opening (m)."""
    return _length(opening_t1, opening_t2)


def tensile_opening(opening_n: float) -> float:
    """Normal opening where positive, otherwise zero (m)."""
    return max(opening_n, 0.0)


def normal_force(impulse_n: float, h: float) -> float:
    """Compressive force (N), zero in tension."""
    return max(impulse_n / h, 0.0)


def pressure(impulse_n: float, h: float, area: float) -> float:
    """Compressive pressure over the area (Pa), zero in tension."""
    force = h * area
    if force > 0.0:
        return max(impulse_n / force, 0.0)
    return 0.0


def intact_traction(intact_n: float, intact_t1: float, intact_t2: float) -> float:
    """Norm of the tensile traction of the undamaged bond, sqrt(<t_n>^2 + |t_t|^2) (Pa)."""
    return math.hypot(max(intact_n, 0.0), _length(intact_t1, intact_t2))


def intact_opening(energy_intact: float, intact_n: float, intact_t1: float, intact_t2: float) -> float:
    """Opening of a linear bond that carries this traction and stores this energy, 2 psi_0/|t| (m)."""
    traction = intact_traction(intact_n, intact_t1, intact_t2)
    if traction > 0.0:
        return 2.0 * energy_intact / traction
    return 0.0


def intact_stiffness(energy_intact: float, intact_n: float, intact_t1: float, intact_t2: float) -> float:
    """Stiffness of the undamaged bond, |t|/opening (Pa/m); zero without tensile traction."""
    traction = intact_traction(intact_n, intact_t1, intact_t2)
    if energy_intact > 0.0:
        return 0.5 * traction * traction / energy_intact
    return 0.0


#: Inputs that are computed from columns, by name: a law has them as arguments like the columns
#: themselves.
DERIVED: dict[str, Callable[..., float]] = {
    f.__name__: f
    for f in (
        sliding_speed,
        approach_speed,
        opening_t,
        tensile_opening,
        normal_force,
        pressure,
        intact_traction,
        intact_opening,
        intact_stiffness,
    )
}


def damage_for(traction: float, intact_traction: float, degradation: float) -> float:
    """Damage at which a bond carries a traction: (1 - D)^m |t_0| = traction; 0 where the undamaged bond carries less.

    Args:
        traction: traction to be carried (Pa).
        intact_traction: traction of the undamaged bond |t_0| (Pa).
        degradation: exponent m.
    """
    if intact_traction <= traction or intact_traction <= 0.0:
        return 0.0
    left = max(traction / intact_traction, 0.0)
    if degradation == 1.0:
        return 1.0 - left
    return 1.0 - math.pow(left, 1.0 / degradation)


def release_rate(damage: float, energy_intact: float, degradation: float) -> float:
    """Driving force of damage, Y = -d psi/d D = m (1 - D)^(m - 1) psi_0 (J/m^2)."""
    if degradation == 1.0:
        return energy_intact
    if degradation == 2.0:
        return 2.0 * (1.0 - damage) * energy_intact
    return degradation * math.pow(1.0 - damage, degradation - 1.0) * energy_intact


def bounded(x: float) -> float:
    """The number, or the largest finite one of its sign where it overflowed."""
    return min(max(x, -_LARGEST), _LARGEST)


def damping_ratio(restitution: float) -> float:
    """Damping ratio zeta of a linear spring, d = 2 zeta sqrt(k m), whose impacts rebound with this share of the approach velocity.

    The contact ends as soon as its force is zero: T. Schwager, T. Poschel, Granular Matter 9 (2007) 465, eqs. 20 to 22. Make it a
    constant of the law, which is computed once a call: ``constants={"zeta": lambda restitution: damping_ratio(restitution)}``.
    """
    wanted = min(max(restitution, 1e-6), 1.0)
    if wanted == 1.0:
        return 0.0
    low, high = 0.0, 1e4
    for _ in range(60):
        middle = 0.5 * (low + high)
        if _rebound(middle) > wanted:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def _rebound(zeta: float) -> float:
    share = 2.0 * zeta * zeta
    if zeta < 1.0:
        w = math.sqrt(1.0 - zeta * zeta)
        angle = math.atan2(2.0 * zeta * w, 1.0 - share)
        return math.exp(-zeta / w * (math.pi - angle))
    if zeta == 1.0:
        return math.exp(-2.0)
    w = math.sqrt(zeta * zeta - 1.0)
    return math.exp(-zeta / w * 2.0 * math.log(zeta + w))
