"""Shipped laws once more, in Python: the same formulas, parameters and defaults. `SHIPPED` has the names of the originals."""

import math

import fretwork.law as law
from fretwork.law import Attraction, Friction, Parameter, Spring, Traction, Variable, damage_for, damping_ratio

LARGEST = 1.7976931348623157e308


@law.contact
def py_coulomb(
    mu=Parameter(0.3, range=(0.0, math.inf), doc="friction coefficient"),
    restitution_n=Parameter(0.0, range=(0.0, 1.0), doc="normal restitution (Newton)"),
    restitution_t=Parameter(0.0, range=(0.0, 1.0), doc="tangential restitution (Newton)"),
):
    """Coulomb friction with Newton's restitution"""
    return Friction(mu, restitution_n=restitution_n, restitution_t=restitution_t)


@law.contact(reference="L. C. Bo, D. Pavelescu, Wear 82 (1982) 277-289, exponent 1", version="1.2.3")
def py_velocity_weakening(
    sliding_speed,
    mu_s=Parameter(0.4, range=(0.0, 1e6), doc="friction coefficient at rest"),
    mu_d=Parameter(0.3, range=(0.0, 1e6), doc="friction coefficient at high velocity, at most mu_s"),
    v_s=Parameter(0.1, range=(1e-12, 1e6), unit="m/s", doc="velocity over which it falls, V_s"),
):
    """mu_d + (mu_s - mu_d) exp(-V/V_s)"""
    return mu_d + (mu_s - mu_d) * math.exp(-sliding_speed / v_s)


@py_velocity_weakening.require("`mu_d` exceeds `mu_s`; this law weakens with velocity")
def weakens(mu_s, mu_d):
    return mu_d <= mu_s


def seen(speed, v_min):
    """The velocity that enters the law: positive and finite."""
    return min(max(speed, v_min), LARGEST)


@law.contact
def py_rate_and_state(
    sliding_speed,
    mu_0=Parameter(0.6, range=(0.0, 1e3), doc="friction coefficient of steady sliding at V_0"),
    a=Parameter(0.010, range=(0.0, 1e3), doc="direct effect of the velocity"),
    b=Parameter(0.015, range=(0.0, 1e3), doc="effect of the state"),
    v_0=Parameter(1e-6, range=(1e-30, 1e6), unit="m/s", doc="reference velocity V_0"),
    d_c=Parameter(1e-5, range=(1e-30, 1e6), unit="m", doc="slip over which the state is renewed, D_c"),
    v_min=Parameter(1e-9, range=(1e-30, 1e6), unit="m/s", doc="smallest velocity the law sees"),
    slip_law=Parameter(0.0, range=(0.0, 1.0), doc="0 aging law (Dieterich), 1 slip law (Ruina)"),
    psi=Variable(0.0, doc="state ln(V_0 theta/D_c) of rate-and-state friction"),
):
    """mu_0 + a ln(V/V_0) + b ln(V_0 theta/D_c)"""
    direct = a * (math.log(seen(sliding_speed, v_min)) - math.log(v_0))
    return min(max(mu_0 + direct + b * psi, 0.0), LARGEST)


@py_rate_and_state.commit
def psi_after(sliding_speed, impulse_n, h, v_0, d_c, v_min, slip_law, psi):
    if impulse_n <= 0.0:
        return psi
    v = seen(sliding_speed, v_min)
    z = v * max(h, 0.0) / d_c
    steady = -(math.log(v) - math.log(v_0))
    if slip_law > 0.5:
        return steady + (psi - steady) * math.exp(-z)
    old = psi - z
    new = steady + math.log(-math.expm1(-z))
    large, small = max(old, new), min(old, new)
    return large + math.log1p(math.exp(small - large))


@law.contact(constants={"zeta": lambda restitution: damping_ratio(restitution)})
def py_linear_contact(
    stiffness=Parameter(1e6, range=(1e-300, 1e300), unit="N/m", doc="normal stiffness k"),
    ratio=Parameter(0.8, range=(0.0, 1e3), doc="tangential over normal stiffness"),
    restitution=Parameter(1.0, range=(0.0, 1.0), doc="share of the approach velocity with which two bodies part"),
    mu=Parameter(0.3, range=(0.0, 1e6), doc="friction coefficient"),
):
    """linear springs at contacts, with damping and Coulomb friction"""
    return mu


@py_linear_contact.spring
def spring(overlap, effective_mass, spring_t1, spring_t2, stiffness, ratio, zeta):
    k_t = min(ratio * stiffness, LARGEST)
    return Spring(
        contact_force_n=min(stiffness * overlap, LARGEST),
        contact_stiffness_n=stiffness,
        contact_damping_n=2.0 * zeta * math.sqrt(stiffness * effective_mass),
        contact_force_t1=spring_t1,
        contact_force_t2=spring_t2,
        contact_stiffness_t=k_t,
        contact_unloading_t=k_t,
    )


@law.cohesion
def py_elastic_bond(
    opening_n,
    opening_t1,
    opening_t2,
    damage,
    k_n=Parameter(1e14, range=(0.0, 1e30), unit="Pa/m", doc="normal stiffness"),
    k_t=Parameter(1e14, range=(0.0, 1e30), unit="Pa/m", doc="tangential stiffness"),
    d_n=Parameter(0.0, range=(0.0, 1e30), unit="Pa s/m", doc="normal damping"),
    d_t=Parameter(0.0, range=(0.0, 1e30), unit="Pa s/m", doc="tangential damping"),
):
    """linear elastic bond"""
    g = 1.0 - damage
    n, t = g * k_n, g * k_t
    return Traction(n * opening_n, t * opening_t1, t * opening_t2, n, t, damping_n=g * d_n, damping_t=g * d_t)


@py_elastic_bond.energy
def stored(tensile_opening, opening_t1, opening_t2, damage, k_n, k_t):
    n = tensile_opening
    return 0.5 * (1.0 - damage) * (k_n * n * n + k_t * (opening_t1 * opening_t1 + opening_t2 * opening_t2))


@law.cohesion
def py_tvergaard(
    opening_n,
    opening_t1,
    opening_t2,
    damage,
    k=Parameter(1e13, range=(1.0, 1e30), unit="Pa/m", doc="stiffness, the same in both directions"),
    strength=Parameter(1e6, range=(1e-30, 1e30), unit="Pa", doc="traction of the plateau"),
    energy=Parameter(5.0, range=(1e-30, 1e30), unit="J/m^2", doc="fracture energy"),
    plateau=Parameter(0.5, range=(0.0, 1.0), doc="length of the plateau: 0 none, 1 all of the energy"),
):
    """trapezoidal cohesion that breaks by itself"""
    g = 0.0 if damage >= 1.0 else (1.0 - damage) * k
    return Traction(law.bounded(g * opening_n), law.bounded(g * opening_t1), law.bounded(g * opening_t2), g, g)


def effective(opening_n, opening_t):
    return math.hypot(max(opening_n, 0.0), opening_t)


@py_tvergaard.energy
def held(opening_n, opening_t, damage, k):
    if damage >= 1.0:
        return 0.0
    u = effective(opening_n, opening_t)
    return law.bounded(0.5 * (1.0 - damage) * k * u * u)


@py_tvergaard.damage
def breaks(opening_n, opening_t, damage, k, strength, energy, plateau):
    u = effective(opening_n, opening_t)
    first = strength / k
    if u <= first:
        return damage
    longest = 0.5 * first + energy / strength
    end = first + plateau * (longest - first)
    last = 2.0 * energy / strength + first - end
    if u >= last:
        return 1.0
    share = 1.0 if u <= end else (last - u) / (last - end)
    return max(1.0 - share * first / u, damage)


@py_tvergaard.fracture_energy
def of_trapezoid(energy):
    return energy


@py_tvergaard.require("strength^2/(2 k) must be below the energy: the elastic part alone holds more")
def holds(strength, k, energy):
    return strength * strength < 2.0 * k * energy


@law.cohesion
def py_attraction(
    gap,
    area,
    stress=Parameter(0.0, range=(0.0, 1e30), unit="Pa", doc="attraction over the contact's area"),
    force=Parameter(1e-6, range=(0.0, 1e30), unit="N", doc="attraction whatever the area (N/m in 2D)"),
    range=Parameter(1e-7, range=(0.0, 1e30), unit="m", doc="largest gap over which it acts"),
):
    """constant attraction within a range of gaps (wet grains)"""
    if not (gap <= range and area > 0.0):
        return Attraction(0.0)
    return Attraction(min(stress + force / area, LARGEST))


@law.damage
def py_linear_softening(
    damage,
    intact_opening,
    intact_stiffness,
    intact_traction,
    degradation,
    strength=Parameter(3e5, range=(1e-30, 1e30), unit="Pa", doc="traction at which damage begins"),
    energy=Parameter(0.5, range=(1e-30, 1e30), unit="J/m^2", doc="fracture energy, the area under the curve"),
):
    """traction falls linearly from the strength to zero"""
    if intact_stiffness <= 0.0 or intact_traction <= strength:
        return damage
    first, last = strength / intact_stiffness, 2.0 * energy / strength
    if intact_opening >= last or last <= first:
        return 1.0
    traction = strength * ((last - intact_opening) / (last - first))
    return max(damage_for(traction, intact_traction, degradation), damage)


@py_linear_softening.fracture_energy
def under_the_curve(energy):
    return energy


@law.damage
def py_roe_siegmund(
    damage,
    intact_opening,
    intact_stiffness,
    intact_traction,
    degradation,
    strength=Parameter(1e6, range=(1e-30, 1e30), unit="Pa", doc="strength of the new bond"),
    energy=Parameter(5.0, range=(1e-30, 1e30), unit="J/m^2", doc="fracture energy of the envelope"),
    length=Parameter(1e-5, range=(1e-30, 1e30), unit="m", doc="accumulated opening over which damage grows"),
    endurance=Parameter(0.25, range=(0.0, 1.0), doc="share of the strength below which cycles do nothing"),
    start=Parameter(0.0, range=(0.0, 1e30), unit="m", doc="accumulated opening before damage begins"),
    last=Variable(0.0, unit="m", doc="opening at the end of the last step", output=False),
    travel=Variable(0.0, unit="m", doc="accumulated opening"),
):
    """fatigue damage by accumulated opening under traction, with an endurance limit"""
    u = min(intact_opening, LARGEST)
    du = abs(u - last)
    far = min(travel + du, LARGEST)
    left = 1.0 - damage
    if left <= 0.0:
        return damage, u, far
    load = intact_traction * left**degradation / (strength * left)
    grown = damage
    if far > start and load > endurance:
        grown += du / length * (min(load, LARGEST) - endurance)
    envelope = 0.0
    if intact_stiffness > 0.0 and intact_traction > strength:
        first, end = strength / intact_stiffness, 2.0 * energy / strength
        if intact_opening >= end or end <= first:
            envelope = 1.0
        else:
            traction = strength * ((end - intact_opening) / (end - first))
            envelope = damage_for(traction, intact_traction, degradation)
    return max(min(grown, 1.0), envelope), u, far


@law.wear
def py_archard(
    normal_force,
    slip,
    k=Parameter(1e-14, range=(0.0, 1.0), unit="1/Pa", doc="wear coefficient over hardness, K/H"),
):
    """volume k F s"""
    return k * normal_force * slip


@law.wear
def py_broken_bonds(
    damage,
    area,
    opening_n,
    opening_t1,
    opening_t2,
    thickness=Parameter(1e-5, range=(0.0, 1e6), unit="m", doc="matter behind a contact over its area"),
    bond_history=Variable(0.0, doc="0 never bonded, 1 bonded, 2 broken and counted as wear", output=False),
):
    """thickness times area, once, when the bond breaks"""
    if damage < 1.0:
        return 0.0, 1.0
    opened = opening_n != 0.0 or opening_t1 != 0.0 or opening_t2 != 0.0
    if bond_history == 1.0 or (bond_history == 0.0 and opened):
        return min(thickness * max(area, 0.0), LARGEST), 2.0
    return 0.0, bond_history


#: The original of each law.
SHIPPED = {
    py_coulomb: "coulomb",
    py_velocity_weakening: "velocity-weakening",
    py_rate_and_state: "rate-and-state",
    py_linear_contact: "linear-contact",
    py_elastic_bond: "elastic-bond",
    py_tvergaard: "tvergaard-hutchinson",
    py_attraction: "constant-attraction",
    py_linear_softening: "linear-softening",
    py_roe_siegmund: "roe-siegmund",
    py_archard: "archard",
    py_broken_bonds: "broken-bonds",
}
