"""The C source around the compiled loops: the plugin table and the functions that the host calls.

It includes the header of the plugin interface, from which the C compiler has the layout of all structs.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from . import header
from .formulas import SMALLER_STEP
from .loops import Loop

if TYPE_CHECKING:
    from .definition import Law

_COMMON = r"""#define _DEFAULT_SOURCE
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include "fretwork.h"

struct column { const char *name; size_t offset; };

/* The column at an offset of the batch, null for a host that does not have it. */
static double *column(const fw_batch *b, size_t offset) {
    double *found;
    if (b->size < offset + sizeof found) return 0;
    memcpy(&found, (const char *)b + offset, sizeof found);
    return found;
}
#define COLUMN(name) column(b, offsetof(fw_batch, name))

static int32_t write_message(fw_message *m, int64_t contact, int32_t status, const char *format, ...) {
    va_list list;
    if (m == 0) return status;
    m->contact = contact;
    if (m->text == 0 || m->capacity == 0) return status;
    va_start(list, format);
    vsnprintf(m->text, m->capacity, format, list);
    va_end(list);
    return status;
}

static int asks_for_smaller_step(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (bits & UINT64_C(0x7fffffffffffffff)) == UINT64_C(@SMALLER_STEP@);
}

static int32_t refuse(const fw_batch *b, fw_message *m, size_t k, const char *name, double x, const struct column *inputs) {
    char values[1024] = "";
    size_t used = 0;
    if (asks_for_smaller_step(x)) {
        return write_message(m, (int64_t)k, FW_REDUCE_STEP, "the law cannot follow a step of %g s; take a smaller one", b->h);
    }
    for (size_t v = 0; v < N_PARAMETERS; v++) {
        used += (size_t)snprintf(values + used, sizeof values - used, ", %s = %.17g", parameters[v].name, b->parameters[v]);
        if (used >= sizeof values) used = sizeof values - 1;
    }
    for (; inputs->name; inputs++) {
        const double *from = column(b, inputs->offset);
        used += (size_t)snprintf(values + used, sizeof values - used, ", %s = %.17g", inputs->name, from ? from[k] : 0.0);
        if (used >= sizeof values) used = sizeof values - 1;
    }
    return write_message(m, (int64_t)k, FW_ERROR, "the law gave a value of `%s` that is not finite, at h = %.17g%s", name, b->h, values);
}

/* Finds the value that is not finite. */
static int32_t search(const fw_batch *b, fw_message *m, const struct column *outputs, const struct column *inputs, int moves) {
    for (size_t k = 0; k < b->n; k++) {
        for (const struct column *o = outputs; o->name; o++) {
            const double *from = column(b, o->offset);
            if (from && !isfinite(from[k])) return refuse(b, m, k, o->name, from[k], inputs);
        }
        for (size_t v = 0; moves && v < N_VARIABLES; v++) {
            double x = b->state_next[v][k];
            if (!isfinite(x)) return refuse(b, m, k, variables[v].name, x, inputs);
        }
    }
    return write_message(m, -1, FW_ERROR, "the law gave a value that is not finite");
}

static int32_t incomplete(const fw_batch *b, fw_message *m, const struct column *inputs, const struct column *outputs) {
    for (const struct column *c = inputs; c->name; c++)
        if (!column(b, c->offset)) return write_message(m, -1, FW_ERROR, "the law needs the column `%s`, which this program does not give", c->name);
    for (const struct column *c = outputs; c->name; c++)
        if (!column(b, c->offset)) return write_message(m, -1, FW_ERROR, "the law gives the column `out_%s`, which this program does not take", c->name);
    return write_message(m, -1, FW_ERROR, "the batch has no parameters or internal variables");
}
"""


#: Functions of `math` that numba calls by names of its own, with those of the C library.
MATH = {
    "numba_erf": "double numba_erf(double x) { return erf(x); }",
    "numba_erfc": "double numba_erfc(double x) { return erfc(x); }",
    "numba_gamma": "double numba_gamma(double x) { return tgamma(x); }",
    "numba_lgamma": "double numba_lgamma(double x) { int sign; return lgamma_r(x, &sign); }",
    "numba_frexp": "double numba_frexp(double x, int *exponent) { return frexp(x, exponent); }",
    "numba_ldexp": "double numba_ldexp(double x, int exponent) { return ldexp(x, exponent); }",
}


def source(
    law: Law,
    loops: list[Loop],
    flags: list[str],
    conditions: list[tuple[str, str]],
    fracture: str | None,
    math_functions: list[str],
) -> str:
    """The C source of a law's plugin.

    Args:
        law: the law.
        loops: its loops; those of a slot in the order in which they are tried.
        flags: names of its flags.
        conditions: sentence and symbol of each condition between parameters.
        fracture: symbol of the fracture energy.
        math_functions: those of `MATH` that the loops call.
    """
    common = _COMMON.replace("@SMALLER_STEP@", f"0x{_bits(SMALLER_STEP):016x}")
    head, rest = common.split("struct column {", 1)
    parts = [head + "\n" + _schema(law) + "\nstruct column {" + rest]
    parts += [MATH[name] for name in math_functions]
    slots = list(dict.fromkeys(loop.slot for loop in loops))
    for slot in slots:
        parts.append(_call(law, slot, [loop for loop in loops if loop.slot == slot]))
    parts.append(_validate(law, conditions))
    if fracture:
        parts.append(_fracture(law, fracture))
    entries = [f"    .{slot} = call_{slot}," for slot in slots]
    entries += ["    .validate = validate,"] if conditions else []
    entries += ["    .fracture_energy = fracture_energy,"] if fracture else []
    parts.append(_table(law, flags, entries))
    return "\n".join(part for part in parts if part)


def _schema(law: Law) -> str:
    rows = [(name, p.unit, p.doc, p.default, *(p.range or (-math.inf, math.inf)), 2 * int(p.friction)) for name, p in law.parameters.items()]
    states = [(name, v.unit, v.doc, v.initial, -math.inf, math.inf, int(v.output)) for name, v in law.variables.items()]
    out = []
    for what, fields in (("parameters", rows), ("variables", states)):
        lines = [
            f"    {{{_text(n)}, {_text(u)}, {_text(d)}, {_number(v)}, {_number(a)}, {_number(b)}, {f}}}," for n, u, d, v, a, b, f in fields
        ]
        # C has no empty array.
        lines = lines or ["    {0, 0, 0, 0.0, 0.0, 0.0, 0},"]
        out.append(f"enum {{ N_{what.upper()} = {len(fields)} }};\nstatic const fw_field {what}[] = {{\n" + "\n".join(lines) + "\n};")
    return "\n".join(out)


def _call(law: Law, slot: str, loops: list[Loop]) -> str:
    numbers = header.numbers()
    full = loops[0]
    inputs = "".join(f'{{"{c}", offsetof(fw_batch, {c})}}, ' for c in full.inputs)
    outputs = "".join(f'{{"{c.removeprefix("out_")}", offsetof(fw_batch, {c})}}, ' for c in full.outputs)
    lines = [
        f"static const struct column inputs_{slot}[] = {{{inputs}{{0, 0}}}};",
        f"static const struct column outputs_{slot}[] = {{{outputs}{{0, 0}}}};",
    ]
    for loop in loops:
        kinds = ["int64_t" if m.type != "double" else "double" for m in numbers.values()]
        state = ["const double *"] * len(law.variables) + ["double *"] * (len(law.variables) if loop.moves else 0)
        heads = ["int64_t *", "void **", "int64_t", *kinds, "const double *", *state]
        heads += ["const double *"] * len(loop.inputs) + ["double *"] * len(loop.outputs)
        lines.append(f"extern int32_t fretwork_{loop.symbol}({', '.join(heads)});")
    lines += [
        f"static int32_t call_{slot}(const fw_batch *b, fw_message *m) {{",
        "    int64_t wrong = 0;",
        "    void *exception = 0;",
        "    int32_t status;",
        '    if (b == 0 || b->size < offsetof(fw_batch, gap)) return write_message(m, -1, FW_ERROR, "the batch is null or shorter than version 1.0");',
        "    if (b->n == 0) return FW_OK;",
    ]
    needs = ["b->parameters"] if law.parameters else []
    if law.variables:
        needs.append("b->state")
        needs += [f"b->state[{v}]" for v in range(len(law.variables))]
        if full.moves:
            needs.append("b->state_next")
            needs += [f"b->state_next[{v}]" for v in range(len(law.variables))]
    if needs:
        lines.append(
            f"    if (!({' && '.join(needs)})) return incomplete(b, m, inputs_{slot} + {len(full.inputs)}, outputs_{slot} + {len(full.outputs)});"
        )
    word = "    if"
    for loop in loops:
        have = " && ".join(f"COLUMN({c})" for c in (*loop.inputs, *loop.outputs)) or "1"
        given = ["&wrong", "&exception", "(int64_t)b->n", *(f"b->{n}" for n in numbers), "b->parameters"]
        given += [f"b->state[{v}]" for v in range(len(law.variables))]
        given += [f"b->state_next[{v}]" for v in range(len(law.variables))] if loop.moves else []
        given += [f"COLUMN({c})" for c in (*loop.inputs, *loop.outputs)]
        lines += [f"{word} ({have})", f"        status = fretwork_{loop.symbol}({', '.join(given)});"]
        word = "    else if"
    lines += [
        "    else",
        f"        return incomplete(b, m, inputs_{slot}, outputs_{slot});",
        '    if (status != 0) return write_message(m, -1, FW_ERROR, "the law asks for a value beyond the end of an array");',
        f"    return wrong ? search(b, m, outputs_{slot}, inputs_{slot}, {int(full.moves)}) : FW_OK;",
        "}",
    ]
    return "\n".join(lines)


def _validate(law: Law, conditions: list[tuple[str, str]]) -> str:
    if not conditions:
        return ""
    lines = [f"extern int32_t fretwork_{symbol}(int64_t *, void **, int64_t, const double *);" for _, symbol in conditions]
    lines += ["static int32_t validate(const double *values, fw_message *m) {", "    int64_t holds;", "    void *exception = 0;"]
    for message, symbol in conditions:
        lines += [
            f"    holds = 0;\n    if (fretwork_{symbol}(&holds, &exception, 1, values) != 0 || !holds)",
            f'        return write_message(m, -1, FW_BAD_PARAMETER, "%s", {_text(message)});',
        ]
    return "\n".join([*lines, "    return FW_OK;", "}"])


def _fracture(law: Law, symbol: str) -> str:
    return "\n".join(
        [
            f"extern int32_t fretwork_{symbol}(double *, void **, int64_t, double, const double *);",
            "static double fracture_energy(const double *values, double angle) {",
            "    double energy = NAN;",
            "    void *exception = 0;",
            f"    return fretwork_{symbol}(&energy, &exception, 1, angle, values) == 0 ? energy : NAN;",
            "}",
        ]
    )


def _table(law: Law, flags: list[str], entries: list[str]) -> str:
    lines = [
        "static const fw_plugin table = {",
        "    .size = sizeof(fw_plugin),",
        "    .abi_major = FW_ABI_MAJOR,",
        "    .abi_minor = FW_ABI_MINOR,",
        f"    .kind = FW_KIND_{law.kind.upper()},",
        f"    .flags = {' | '.join(flags) or '0'},",
        f"    .name = {_text(law.name)},",
        f"    .version = {_text(law.version)},",
        f"    .doc = {_text(law.doc)},",
        f"    .reference = {_text(law.reference)},",
        "    .n_parameters = N_PARAMETERS,",
        "    .parameters = parameters,",
        "    .n_variables = N_VARIABLES,",
        "    .variables = variables,",
        f"    .degradation = {_number(law.degradation if 'FW_FLAG_OPENING' in flags else 0.0)},",
        *entries,
        "};",
        "",
        "const fw_plugin *fretwork_plugin(void) { return &table; }",
        "",
    ]
    return "\n".join(lines)


def _text(text: str) -> str:
    """A C string; bytes beyond ASCII in octal, three digits each, so that no following digit joins them."""
    plain = "".join(chr(b) if 32 <= b < 127 and chr(b) not in '"\\?' else f"\\{b:03o}" for b in text.encode())
    return f'"{plain}"'


def _number(x: float) -> str:
    if math.isinf(x):
        return "INFINITY" if x > 0 else "-INFINITY"
    return float(x).hex()


def _bits(x: float) -> int:
    import struct

    return int(struct.unpack("<Q", struct.pack("<d", x))[0])
