"""The laws of `fretwork law new --lang c`, one of each kind, in Python: the same formulas and parameters."""

import math

import fretwork.law as law
from fretwork.law import Parameter, Traction


@law.contact(name="python-weakening")
def weakening(
    sliding_speed,
    mu_s=Parameter(0.4, range=(0.0, 10.0), doc="friction coefficient at rest"),
    mu_d=Parameter(0.3, range=(0.0, 10.0), doc="friction coefficient at high speed"),
    v=Parameter(0.1, range=(1e-12, 1e30), unit="m/s", doc="velocity over which it falls"),
):
    """friction that falls with the velocity"""
    return mu_d + (mu_s - mu_d) * math.exp(-sliding_speed / v)


@law.cohesion(name="python-bond")
def bond(
    opening_n,
    opening_t1,
    opening_t2,
    damage,
    k_n=Parameter(1e12, range=(1.0, 1e30), unit="Pa/m", doc="normal stiffness of the intact bond"),
    k_t=Parameter(1e12, range=(1.0, 1e30), unit="Pa/m", doc="tangential stiffness of the intact bond"),
):
    """linear bond"""
    n, t = (1.0 - damage) * k_n, (1.0 - damage) * k_t
    return Traction(n * opening_n, t * opening_t1, t * opening_t2, n, t)


@bond.energy
def stored(tensile_opening, opening_t, damage, k_n, k_t):
    return (1.0 - damage) * (0.5 * (k_n * tensile_opening * tensile_opening + k_t * opening_t * opening_t))


@law.damage(name="python-softening")
def softening(
    damage,
    energy_intact,
    intact_n,
    intact_t1,
    intact_t2,
    degradation,
    strength=Parameter(3e5, range=(1e-30, 1e30), unit="Pa", doc="traction at which damage begins"),
    energy=Parameter(0.5, range=(1e-30, 1e30), unit="J/m^2", doc="fracture energy: area under the curve"),
):
    """linear softening"""
    pull = max(intact_n, 0.0)
    t0 = math.sqrt(pull * pull + intact_t1 * intact_t1 + intact_t2 * intact_t2)
    if t0 <= 0.0:
        return damage
    u = 2.0 * energy_intact / t0
    first = strength * u / t0
    last = 2.0 * energy / strength
    if t0 <= strength:
        return max(damage, 0.0)
    if u >= last or last <= first:
        return 1.0
    return max(damage, 1.0 - (strength * (last - u) / (last - first) / t0) ** (1.0 / degradation))


@softening.fracture_energy
def area(energy):
    return energy


@law.wear(name="python-archard")
def archard(
    normal_force,
    slip,
    k=Parameter(1e-4, range=(0.0, 1.0), doc="wear coefficient"),
    hardness=Parameter(3e9, range=(1.0, 1e30), unit="Pa", doc="hardness of the softer body"),
):
    """volume proportional to force and slip"""
    return k / hardness * normal_force * slip


LAWS = (weakening, bond, softening, archard)
