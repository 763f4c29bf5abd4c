/* @NAME@: a @KIND@ law for Fretwork. Fill in the two functions marked (1) and (2).
 * fretwork.h documents the content and unit of every column, and when each call is made. */
#include <math.h>
#include <string.h>
#include "fretwork.h"

enum { STRENGTH, ENERGY };
static const fw_field parameters[] = {
    {"strength", "Pa", "traction at which damage begins", 3e5, 1e-30, 1e30, 0},
    {"energy", "J/m^2", "fracture energy: area under the traction-opening curve", 0.5, 1e-30, 1e30, 0},
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

/* (1) D at the end of the step, where t0 (Pa) is the traction that the undamaged bond would carry at the opening u
 * (m), so that psi = (1 - D)^m psi_0. Here: a line from the strength to zero. */
static double damage(const double *p, double t0, double u, double m) {
    double first = p[STRENGTH] * u / t0, last = 2.0 * p[ENERGY] / p[STRENGTH];
    if (t0 <= p[STRENGTH]) return 0.0;
    if (u >= last || last <= first) return 1.0;
    return 1.0 - pow(p[STRENGTH] * (last - u) / (last - first) / t0, 1.0 / m);
}

/* (2) Area under the curve that `law certify` compares with, at any angle; NAN to skip the test. */
static double fracture_energy(const double *p, double angle) {
    (void)angle;
    return p[ENERGY];
}

static int32_t commit(const fw_batch *b, fw_message *message) {
    for (size_t k = 0; k < b->n; k++) {
        double t2 = b->intact_t2 ? b->intact_t2[k] : 0.0;
        double pull = fmax(b->intact_n[k], 0.0);
        double t0 = sqrt(pull * pull + b->intact_t1[k] * b->intact_t1[k] + t2 * t2);
        double d = b->damage[k];
        if (t0 > 0.0) d = fmax(d, damage(b->parameters, t0, 2.0 * b->energy_intact[k] / t0, b->degradation));
        if (!isfinite(d) || !isfinite(t0)) return fail(message, k, "the traction is not finite; take a smaller step");
        b->out_damage[k] = d;
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
    .doc = "linear softening",
    .reference = "say where the equations come from",
    .n_parameters = sizeof parameters / sizeof *parameters,
    .parameters = parameters,
    .commit = commit,
    .fracture_energy = fracture_energy,
};

const fw_plugin *fretwork_plugin(void) { return &table; }
