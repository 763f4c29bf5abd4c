"""The plugin interface as its C header says it: columns of a batch with their documentation, functions of the table, constants.

The header is the only place that lists them. The C compiler reads the layout of the structs from it when a law is built; here
only names and texts are read.
"""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass
from importlib import resources


@dataclass(frozen=True)
class Member:
    """A member of a struct of the header."""

    name: str
    type: str
    doc: str

    @property
    def is_input(self) -> bool:
        """Whether it is a column that a law reads."""
        return self.type == "const double *"

    @property
    def is_output(self) -> bool:
        """Whether it is a column that a law writes."""
        return self.type == "double *" and self.name.startswith("out_")


@functools.cache
def text() -> str:
    """The header."""
    return resources.files(__package__).joinpath("fretwork.h").read_text("utf-8")


@functools.cache
def members(struct: str) -> dict[str, Member]:
    """The members of a struct, by name."""
    body = re.search(rf"typedef struct {struct} \{{(.*?)\n\}} {struct};", text(), re.S)
    if body is None:
        raise RuntimeError(f"the header of the plugin interface has no struct `{struct}`; the installation is incomplete")
    line = re.compile(r"^\s*([A-Za-z_][\w \t*]*?)(\w+);\s*/\*\s*(.*?)\s*\*/\s*$", re.M)
    found = (Member(m[2], " ".join(m[1].replace("*", " *").split()), m[3]) for m in line.finditer(body[1]))
    return {member.name: member for member in found}


def columns() -> dict[str, Member]:
    """The columns that laws read, by name: without parameters and internal variables, which have names of their own."""
    batch = members("fw_batch").items()
    return {name: m for name, m in batch if m.is_input and name != "parameters"}


def numbers() -> dict[str, Member]:
    """The numbers that are the same for all contacts of a batch, by name."""
    batch = members("fw_batch").items()
    return {name: m for name, m in batch if m.type == "double" or name == "dimension"}


def outputs() -> dict[str, Member]:
    """The columns that laws write, by name."""
    return {name: m for name, m in members("fw_batch").items() if m.is_output}


def constants() -> dict[str, str]:
    """The constants, by name, with what is said of them."""
    found = re.findall(r"/\* ((?:(?!\*/).)*?) \*/\n#define (FW_\w+) ", text(), re.S)
    return {name: re.sub(r"\s*\n \* ", " ", said).split(": ", 1)[-1] for said, name in found}
