"""Tribology of dry contacts: non-smooth contact dynamics with interface laws that users write.

>>> import fretwork
>>> case = fretwork.Case.load("cases/plane_shear.ron", set={"time.end": 0.01})
>>> results = case.run(out="results/shear", progress=False)
>>> results.summary["steps"]
50

A :class:`Case` is read, edited, checked and run; a :class:`Simulation` is stepped by hand; :class:`Results` reads what a run wrote,
:func:`read_study` the table of a study; :func:`material` has the numbers of a material, with their sources.
``fretwork.law`` has laws written in Python. ``docs/python.md`` shows all of it.
"""

import sys as _sys

from . import _fretwork, law
from ._case import Case
from ._check import Check
from ._contact_patch import contact_patch
from ._errors import Error, InputError, MissingPackageError, RunError
from ._fretwork import __version__
from ._material import Material, Number, material, materials
from ._new_case import NewCase, new_case
from ._observers import Column, Observer, Stop
from ._patch import patch
from ._progress import Progress
from ._report import compare, report
from ._results import Results
from ._sections import Section
from ._shipped import copy_shipped
from ._simulation import Simulation, StepReport
from ._study import read_study

# The compiled part is the program here: its file identifies the built-in laws, and laws are tried
# out in another process of it.
_fretwork.declare(
    _fretwork.__file__, [_sys.executable, "-m", "fretwork"] if _sys.executable else []
)

__all__ = [
    "Case",
    "Check",
    "Column",
    "Error",
    "InputError",
    "Material",
    "MissingPackageError",
    "Number",
    "NewCase",
    "Observer",
    "Progress",
    "Results",
    "RunError",
    "Section",
    "Simulation",
    "StepReport",
    "Stop",
    "__version__",
    "compare",
    "contact_patch",
    "copy_shipped",
    "law",
    "material",
    "materials",
    "new_case",
    "patch",
    "read_study",
    "report",
]
