"""What is wrong with a law is said with its file and line."""

import importlib.util
import subprocess
import sys

import pytest

pytest.importorskip("numba")

import fretwork.law as law  # noqa: E402
from fretwork.law import numba_compiler  # noqa: E402

HEAD = """import math
import numpy as np
import fretwork.law as law
from fretwork.law import Friction, Parameter, Traction, Variable
MU = Parameter(0.3, range=(0.0, 1.0), doc="friction coefficient")
NAMES = {"a": 1}
"""

#: A law, the line at which it is wrong (counted from that below `HEAD`), and what the message says.
WRONG = {
    "no range": ("@law.contact\ndef f(\n    mu=Parameter(0.3, doc='x'),\n):\n    return mu\n", 3, "`mu` has no range"),
    "no description": ("@law.contact\ndef f(mu=Parameter(0.3, (0, 1))):\n    return mu\n", 2, "`mu` has no description"),
    "default out of range": (
        "@law.contact\ndef f(mu=Parameter(3.0, (0, 1), doc='x')):\n    return mu\n",
        2,
        "default 3.0, which is outside its range",
    ),
    "range upside down": ("@law.contact\ndef f(mu=Parameter(0.3, (1, 0), doc='x')):\n    return mu\n", 2, "smaller end first"),
    "a plain default": ("@law.contact\ndef f(mu=0.3):\n    return mu\n", 2, "mu=Parameter(0.3, range="),
    "unknown input": ("@law.contact\ndef f(\n    sliding_sped,\n    mu=MU,\n):\n    return mu\n", 3, "did you mean `sliding_speed`?"),
    "input of another kind": ("@law.contact\ndef f(slip, mu=MU):\n    return mu\n", 2, "a contact law has no input `slip`"),
    "a parameter named as an input": ("@law.contact\ndef f(gap=MU):\n    return gap\n", 2, "`gap` is an input"),
    "no return": ("@law.contact\ndef f(mu=MU):\n    mu * 2.0\n", 3, "`f` returns nothing; it returns the friction coefficient"),
    "return on some path": (
        "@law.contact\ndef f(gap, mu=MU):\n    if gap > 0.0:\n        return mu\n    return\n",
        5,
        "returns nothing on some path",
    ),
    "another answer": ("@law.contact\ndef f(mu=MU):\n    return Traction(mu, mu, mu, mu, mu)\n", 2, "returns a Traction"),
    "unknown function": ("@law.contact\ndef f(mu=MU):\n    x = 1.0\n    return x * math.expp(mu)\n", 4, "did you mean `exp`?"),
    "unknown name": ("@law.contact\ndef f(gap, mu=MU):\n    return muu\n", 3, "`muu` is not defined; did you mean `mu`?"),
    "an input that is no argument": ("@law.contact\ndef f(mu=MU):\n    return mu * gap\n", 3, "make it an argument of `f`"),
    "unknown field": ("@law.contact\ndef f(mu=MU):\n    return Friction(mu, rolin=1.0)\n", 3, "did you mean `rolling`?"),
    "missing field": ("@law.cohesion\ndef f(k=MU):\n    return Traction(k, 0.0, 0.0)\n", 3, "also needs stiffness_n, stiffness_t"),
    "a text": ("@law.contact\ndef f(mu=MU):\n    x = 'a'\n    return mu\n", 3, "no texts"),
    "a list": ("@law.contact\ndef f(mu=MU):\n    return [mu, mu][0]\n", 3, "no lists"),
    "an array": ("@law.contact\ndef f(mu=MU):\n    a = np.zeros(3)\n    a[0] = mu\n    return a.sum()\n", 2, "cannot make arrays"),
    "a table outside": ("@law.contact\ndef f(mu=MU):\n    return mu * NAMES['a']\n", 3, "no texts"),
    "an object outside": ("@law.contact\ndef f(mu=MU):\n    return mu * len(NAMES)\n", 3, "`NAMES` is no number"),
    "an exception": ("@law.contact\ndef f(mu=MU):\n    if mu > 1:\n        raise ValueError\n    return mu\n", 4, "cannot raise"),
    "a variable on some paths": (
        "@law.contact\ndef f(gap, mu=MU):\n    if gap > 0.0:\n        x = 1.0\n    return mu * x\n",
        5,
        "`x` has a value on some paths only",
    ),
    "in a function that it calls": (
        "def g(x):\n    return math.sinn(x)\n\n@law.contact\ndef f(mu=MU):\n    return g(mu)\n",
        2,
        "did you mean `sin`?",
    ),
    "arguments of a function that it calls": (
        "def g(x):\n    return x\n\n@law.contact\ndef f(mu=MU):\n    return g(mu, 1.0)\n",
        6,
        "other arguments than it has",
    ),
    "recursion": ("def g(x):\n    return g(x)\n\n@law.contact\ndef f(mu=MU):\n    return g(mu)\n", 1, "calls itself"),
    "too few values": (
        "@law.damage\ndef f(damage, a=Variable(doc='x'), b=Variable(doc='y')):\n    return damage, a\n",
        2,
        "`return d, a, b`",
    ),
    "nothing moves a variable": ("@law.contact\ndef f(mu=MU, a=Variable(doc='x')):\n    return mu + a\n", 2, "@f.commit"),
    "two functions move it": (
        "@law.cohesion\ndef f(k=MU, a=Variable(doc='x')):\n    return k\n@f.commit\ndef g(a):\n    return a\n@f.damage\ndef h(damage, a):\n    return damage, a\n",
        8,
        "moves its variables",
    ),
    "a spring's input without a spring": ("@law.contact\ndef f(overlap, mu=MU):\n    return mu\n", 2, "@f.spring"),
    "a bond without energy": ("@law.cohesion\ndef f(opening_n, k=MU):\n    return Traction(k, 0.0, 0.0, k, k)\n", 2, "@f.energy"),
    "a name": ("@law.contact(name='My Law')\ndef f(mu=MU):\n    return mu\n", 2, "no valid name"),
    "a condition on more than parameters": (
        "@law.contact\ndef f(gap, mu=MU):\n    return mu\n@f.require('x')\ndef g(muu):\n    return muu > 0\n",
        5,
        "did you mean `mu`?",
    ),
    "a constant of more than parameters": (
        "@law.contact(constants={'c': lambda gap: gap})\ndef f(c, mu=MU):\n    return mu\n",
        1,
        "depends on parameters alone",
    ),
    "spread arguments": ("@law.contact\ndef f(*values):\n    return 0.3\n", 2, "write out the inputs"),
}


def load(tmp_path, code):
    file = tmp_path / "mine.py"
    file.write_text(HEAD + code, "utf-8")
    spec = importlib.util.spec_from_file_location(f"mine_{tmp_path.name}", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("wrong", WRONG)
def test_the_line_is_named(wrong, tmp_path):
    code, line, said = WRONG[wrong]
    with pytest.raises(law.LawError) as raised:
        load(tmp_path, code).f.build(tmp_path / "laws")
    line += HEAD.count("\n")
    message = str(raised.value)
    assert said in message
    assert raised.value.file.endswith("mine.py") and raised.value.line == line, message
    assert f"mine.py, line {line}: " in message
    assert not (tmp_path / "laws").exists()


def test_options_and_functions_are_named():
    with pytest.raises(law.LawError, match="did you mean `tension_only`\\?"):
        law.cohesion(tensiononly=False)
    with pytest.raises(law.LawError, match="no option `degradation`"):
        law.wear(degradation=2.0)

    @law.contact
    def f(mu=law.Parameter(0.3, range=(0.0, 1.0), doc="friction coefficient")):
        return mu

    with pytest.raises(AttributeError, match="did you mean `spring`\\?"):
        f.sprig  # noqa: B018
    with pytest.raises(law.LawError, match="stands above a function"):
        law.contact(3)


def test_another_numba_is_refused(monkeypatch):
    monkeypatch.setattr(numba_compiler, "NUMBA", "0.1.2")
    with pytest.raises(law.LawError, match="pip install numba==0.1.2"):
        numba_compiler.require_numba()


def test_laws_that_exist_need_no_numba():
    code = (
        "import sys; sys.modules['numba'] = None\n"
        "import fretwork.law as law\n"
        "assert law.show('wear/archard').parameters[0].name == 'k'\n"
        "assert law.drive('elastic-bond', to=1e-6)['traction_n'][-1] > 0.0\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_without_a_compiler_it_says_what_to_install(monkeypatch):
    from fretwork.law import link

    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr(link.shutil, "which", lambda _: None)
    monkeypatch.setattr(link.importlib.util, "find_spec", lambda _: None)
    with pytest.raises(law.LawError, match="pip install ziglang"):
        link.compiler()
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.raises(law.LawError, match="cannot be started"):
        link.library("", b"")
