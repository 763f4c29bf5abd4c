"""Laws: those that come with the program, and laws written in Python that run at the speed of C.

>>> import math
>>> import fretwork.law as law
>>> @law.contact(reference="L. C. Bo, D. Pavelescu, Wear 82 (1982) 277-289")
... def my_weakening(
...     sliding_speed,
...     mu_s=law.Parameter(0.4, range=(0.0, 10.0), doc="friction coefficient at rest"),
...     mu_d=law.Parameter(0.3, range=(0.0, 10.0), doc="friction coefficient at high speed"),
...     v_s=law.Parameter(0.1, range=(1e-12, 1e6), unit="m/s", doc="speed over which it falls"),
... ):
...     "friction that falls with the sliding speed"
...     return mu_d + (mu_s - mu_d) * math.exp(-sliding_speed / v_s)
>>> round(my_weakening(0.1), 4)
0.3368

`docs/python_laws.md` leads from nothing to a certified law.
"""

from .bench import Certificate, Check, Curve, Field, Info, certify, drive, inputs, list, show
from .definition import Law, decorator
from .fields import Parameter, Variable
from .formulas import SMALLER_STEP, bounded, damage_for, damping_ratio, release_rate
from .kinds import KINDS
from .results import Attraction, Conductance, Friction, Spring, Traction
from .source import LawError

contact = decorator("contact")
cohesion = decorator("cohesion")
damage = decorator("damage")
wear = decorator("wear")
transport = decorator("transport")

__all__ = [
    "SMALLER_STEP",
    "Attraction",
    "Certificate",
    "Check",
    "Conductance",
    "Curve",
    "Field",
    "Friction",
    "Info",
    "Law",
    "LawError",
    "Parameter",
    "Spring",
    "Traction",
    "Variable",
    "bounded",
    "certify",
    "damage_for",
    "damping_ratio",
    "drive",
    "inputs",
    "list",
    "release_rate",
    "show",
    *KINDS,
]
