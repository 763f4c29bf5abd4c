"""What the functions of a law return where one number is not enough.

The fields are the columns ``out_*`` of the header; those that a law does not give are zero.
"""

from __future__ import annotations

from typing import NamedTuple


class Friction(NamedTuple):
    """Answer of a contact law. A contact law may return the friction coefficient alone."""

    #: friction coefficient
    friction: float
    #: share of the approach velocity with which bodies part, 0 to 1
    restitution_n: float = 0.0
    #: the same along the tangent, -1 to 1
    restitution_t: float = 0.0
    #: rolling friction length (m)
    rolling: float = 0.0
    #: spinning friction length (m)
    spinning: float = 0.0
    #: tension that the contact carries over its area (Pa)
    tension_strength: float = 0.0
    #: shear that it carries without pressure (Pa)
    shear_cohesion: float = 0.0


class Conductance(NamedTuple):
    """Answer of a transport law (in 2D per metre of depth). A transport law may return the thermal conductance alone."""

    #: thermal conductance (W/K), not negative
    conductance: float
    #: electrical conductance (S), not negative
    electric_conductance: float = 0.0


class Spring(NamedTuple):
    """Spring of a compliant contact at the overlap that the law is given (in 2D per metre of depth)."""

    #: compressive force (N), not negative
    contact_force_n: float
    #: its slope with the overlap (N/m)
    contact_stiffness_n: float
    #: normal damping (N s/m)
    contact_damping_n: float = 0.0
    #: tangential force at the start of the step (N): `spring_t1` as it is given, unless the law
    #: changes it
    contact_force_t1: float = 0.0
    #: the same along t2: `spring_t2`
    contact_force_t2: float = 0.0
    #: slope of the tangential force (N/m); 0 for a rigid tangential contact
    contact_stiffness_t: float = 0.0
    #: tangential damping (N s/m)
    contact_damping_t: float = 0.0
    #: slope on unloading, where it differs (N/m)
    contact_unloading_t: float = 0.0


class Traction(NamedTuple):
    """Answer of a cohesion law with an opening: a bond."""

    #: traction (Pa), positive if it pulls the bodies together
    traction_n: float
    #: tangential traction along t1 (Pa)
    traction_t1: float
    #: tangential traction along t2 (Pa)
    traction_t2: float
    #: normal stiffness, tangent or secant, not negative (Pa/m)
    stiffness_n: float
    #: tangential stiffness (Pa/m)
    stiffness_t: float
    #: normal damping (Pa s/m)
    damping_n: float = 0.0
    #: tangential damping (Pa s/m)
    damping_t: float = 0.0
    #: twisting moment over the area, against rotation_n (N m/m^2)
    moment_n: float = 0.0
    #: bending moment over the area, against rotation_t1 (N m/m^2)
    moment_t1: float = 0.0
    #: bending moment over the area, against rotation_t2 (N m/m^2)
    moment_t2: float = 0.0
    #: twisting stiffness over the area (N m/m^2 per rad)
    stiffness_twist: float = 0.0
    #: bending stiffness over the area (N m/m^2 per rad)
    stiffness_bend: float = 0.0


class Attraction(NamedTuple):
    """Answer of a cohesion law without an opening, at every contact. Such a law may return the tension strength alone."""

    #: attraction over the area of the contact (Pa)
    tension_strength: float
    #: shear that it carries without pressure (Pa)
    shear_cohesion: float = 0.0
