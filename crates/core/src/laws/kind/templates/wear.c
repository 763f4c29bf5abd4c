/* @NAME@: a @KIND@ law for Fretwork. Fill in the two functions marked (1) and (2).
 * fretwork.h documents the content and unit of every column, and when each call is made. */
#include <math.h>
#include <string.h>
#include "fretwork.h"

enum { COEFFICIENT, HARDNESS };
static const fw_field parameters[] = {
    {"k", "", "wear coefficient", 1e-4, 0.0, 1.0, 0},
    {"hardness", "Pa", "hardness of the softer body", 3e9, 1.0, 1e30, 0},
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

/* (2) Volume removed (m^3) by a slip (m) under a normal force (N), or by a friction work (J). */
static double volume(const double *p, double force, double slip, double work) {
    (void)work;
    return p[COEFFICIENT] / p[HARDNESS] * force * slip;
}

static int32_t commit(const fw_batch *b, fw_message *message) {
    for (size_t k = 0; k < b->n; k++) {
        double f = force(b->impulse_n[k], b->h);
        b->out_volume[k] = volume(b->parameters, f, b->slip[k], b->friction_work[k]);
        if (!isfinite(b->out_volume[k])) return fail(message, k, "the volume is not finite");
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
    .doc = "volume proportional to force and slip",
    .reference = "say where the equations come from",
    .n_parameters = sizeof parameters / sizeof *parameters,
    .parameters = parameters,
    .commit = commit,
};

const fw_plugin *fretwork_plugin(void) { return &table; }
