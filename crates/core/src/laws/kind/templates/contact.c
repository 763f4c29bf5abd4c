/* @NAME@: a @KIND@ law for Fretwork. Fill in the two functions marked (1) and (2).
 * fretwork.h documents the content and unit of every column, and when each call is made. */
#include <math.h>
#include <string.h>
#include "fretwork.h"

enum { MU_STATIC, MU_DYNAMIC, VELOCITY };
static const fw_field parameters[] = {
    {"mu_s", "", "friction coefficient at rest", 0.4, 0.0, 10.0, 0},
    {"mu_d", "", "friction coefficient at high speed", 0.3, 0.0, 10.0, 0},
    {"v", "m/s", "velocity over which it falls", 0.1, 1e-12, 1e30, 0},
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

/* (1) Friction coefficient at a sliding velocity (m/s). */
static double friction(const double *p, double speed) {
    return p[MU_DYNAMIC] + (p[MU_STATIC] - p[MU_DYNAMIC]) * exp(-speed / p[VELOCITY]);
}

/* (2) Normal restitution, 0 to 1, at an approach velocity (m/s, negative approaches). */
static double restitution(const double *p, double approach) {
    (void)p;
    (void)approach;
    return 0.0;
}

static int32_t prepare(const fw_batch *b, fw_message *message) {
    for (size_t k = 0; k < b->n; k++) {
        double t2 = b->velocity_t2 ? b->velocity_t2[k] : 0.0;
        b->out_friction[k] = friction(b->parameters, hypot(b->velocity_t1[k], t2));
        b->out_restitution_n[k] = restitution(b->parameters, b->velocity_n[k]);
        if (!isfinite(b->out_friction[k])) return fail(message, k, "the friction is not finite");
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
    .doc = "friction that falls with the velocity",
    .reference = "say where the equations come from",
    .n_parameters = sizeof parameters / sizeof *parameters,
    .parameters = parameters,
    .prepare = prepare,
};

const fw_plugin *fretwork_plugin(void) { return &table; }
