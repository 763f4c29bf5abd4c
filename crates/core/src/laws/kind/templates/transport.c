/* @NAME@: a @KIND@ law for Fretwork. Fill in the two functions marked (1) and (2).
 * fretwork.h documents the content and unit of every column, and when each call is made. */
#include <math.h>
#include <string.h>
#include "fretwork.h"

enum { THERMAL, ELECTRIC };
static const fw_field parameters[] = {
    {"thermal", "W/(N K)", "thermal conductance per force", 1e-3, 0.0, 1e30, 0},
    {"electric", "S/N", "electrical conductance per force", 1.0, 0.0, 1e30, 0},
};

/* Returns an error with a message; contacts are counted from 0. */
static int32_t fail(fw_message *message, size_t contact, const char *text) {
    message->contact = (int64_t)contact;
    if (message->capacity > 0) {
        strncpy(message->text, text, message->capacity - 1);
        message->text[message->capacity - 1] = 0;
    }
    return FW_ERROR;
}

/* (1) Normal force (N) from the normal impulse over the step (N s). */
static double force(double impulse, double h) { return fmax(impulse / h, 0.0); }

/* (2) Thermal (W/K) or electrical (S) conductance under a normal force (N), at the temperature of the contact (K). */
static double conductance(const double *p, int which, double force, double temperature) {
    (void)temperature;
    return p[which] * force;
}

static int32_t commit(const fw_batch *b, fw_message *message) {
    for (size_t k = 0; k < b->n; k++) {
        double f = force(b->impulse_n[k], b->h);
        double t = b->temperature[k];
        b->out_conductance[k] = conductance(b->parameters, THERMAL, f, t);
        b->out_electric_conductance[k] = conductance(b->parameters, ELECTRIC, f, t);
        if (!isfinite(b->out_conductance[k])) return fail(message, k, "the conductance is not finite");
    }
    return FW_OK;
}

static const fw_plugin table = {
    .size = sizeof(fw_plugin),
    .abi_major = FW_ABI_MAJOR,
    .abi_minor = FW_ABI_MINOR,
    .kind = FW_KIND_@KINDUP@,
    .flags = 0,
    .name = "@NAME@",
    .version = "0.1.0",
    .doc = "conductance in proportion to the force",
    .reference = "say where the equations come from",
    .n_parameters = sizeof parameters / sizeof *parameters,
    .parameters = parameters,
    .commit = commit,
};

const fw_plugin *fretwork_plugin(void) { return &table; }
