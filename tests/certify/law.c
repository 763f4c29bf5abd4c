/* A linear bond that softens linearly, and the same with one promise broken: -DWRONG_...
 * chooses. */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "fretwork.h"

enum { K, STRENGTH, ENERGY };
static const fw_field parameters[] = {
    {"k", "Pa/m", "stiffness", 1e12, 1.0, 1e30, 0},
    {"strength", "Pa", "strength", 1e6, 1e-30, 1e30, 0},
    {"energy", "J/m^2", "fracture energy", 5.0, 1e-30, 1e30, 0},
};
static const fw_field variables[] = {{"last", "m", "last opening", 0.0, -INFINITY, INFINITY, 0}};

static double length(double a, double b, double c) { return sqrt(a * a + b * b + c * c); }

#if defined(WRONG_HIDDEN)
static double memory;
#endif
#if defined(WRONG_LARGE)
#define WRONG_SCRATCH
static double scratch[1 << 26];
#elif defined(WRONG_SCRATCH)
static double scratch[1 << 16];
#endif
#if defined(WRONG_COUNTER)
static long calls;
#endif
#if defined(WRONG_CACHE)
/* The stiffness of who asked last: of another interface, perhaps. */
static double cache;
#endif
#if defined(WRONG_GROWING)
/* A work array that is made larger when a batch needs it. */
static double *work;
static size_t room;
#endif
#if defined(WRONG_NOTHING_SET_UP_ONCE)
/* No promise is broken: what is set up at the first call and never changes is no one's hidden
 * state. */
static double first[64];
static int ready;
#endif
#if defined(WRONG_THREADS)
static atomic_int threads;
static _Thread_local int me = -1;
#endif

/* How much of the stiffness k holds at opening u, beside damage. */
static double shape(const double *p, double u) {
#if defined(WRONG_CURVED)
    return 1.0 + 0.3 * u * p[K] / p[STRENGTH];
#else
    (void)p;
    (void)u;
    return 1.0;
#endif
}

static double stored(const double *p, double u) {
#if defined(WRONG_CURVED)
    return p[K] * u * u * (0.5 + 0.1 * u * p[K] / p[STRENGTH]);
#else
    return 0.5 * p[K] * u * u;
#endif
}

/* Every output through here: what is not finite is said. */
static int bad(double x) {
#if defined(WRONG_NUMBERS)
    (void)x;
    return 0;
#else
    return !isfinite(x);
#endif
}

static int32_t fail(fw_message *m, size_t k) {
    m->contact = (int64_t)k;
    strncpy(m->text, "the opening is too large", m->capacity);
    return FW_ERROR;
}

static int32_t prepare(const fw_batch *b, fw_message *m) {
    const double *p = b->parameters;
#if defined(WRONG_SCRATCH)
    for (size_t k = 0; k < b->n; k++) scratch[k] = b->opening_n[k];
#elif defined(WRONG_COUNTER)
    calls++;
#elif defined(WRONG_GROWING)
    if (b->n > room) {
        double *grown = realloc(work, b->n * sizeof *grown);
        if (!grown) return fail(m, 0);
        work = grown;
        room = b->n;
    }
    for (size_t k = 0; k < b->n; k++) work[k] = b->opening_n[k];
#elif defined(WRONG_NOTHING_SET_UP_ONCE)
    if (!ready) {
        for (int k = 0; k < 64; k++) first[k] = cos(k);
        ready = 1;
    }
    if (first[0] != 1.0) return fail(m, 0);
#elif defined(WRONG_INPUT)
    ((double *)b->opening_n)[0] += 1e-20;
#elif defined(WRONG_STATE)
    ((double *)b->state[0])[0] += 1e-20;
#elif defined(WRONG_PARAMETER)
    ((double *)b->parameters)[K] *= 1.0 + 1e-15;
#elif defined(WRONG_BEFORE)
    b->out_traction_n[-1] = 0.0;
#elif defined(WRONG_FAR)
    b->out_traction_n[b->n + 300] = 0.0;
#endif
    for (size_t k = 0; k < b->n; k++) {
        double t2 = b->opening_t2 ? b->opening_t2[k] : 0.0;
        double n = b->opening_n[k], t1 = b->opening_t1[k];
#if defined(WRONG_SCRATCH)
        n = scratch[k];
#elif defined(WRONG_GROWING)
        n = work[k];
#endif
        double u = length(n, t1, t2), s = (1.0 - b->damage[k]) * p[K] * shape(p, u);
#if defined(WRONG_CACHE)
        s = (1.0 - b->damage[k]) * cache * shape(p, u);
#endif
#if defined(WRONG_BATCH)
        s *= 1.0 + 1e-9 * (double)k;
#elif defined(WRONG_THREADS)
        if (me < 0) me = atomic_fetch_add(&threads, 1);
        s *= 1.0 + 1e-9 * me;
#elif defined(WRONG_HIDDEN)
        s *= 1.0 + 1e-9 * memory * p[K] / p[STRENGTH];
        memory = u;
#endif
#if defined(WRONG_DEGRADATION)
        /* Right on its own curve, where D follows from u, and wrong for a damage that comes from
         * elsewhere. */
        double first = p[STRENGTH] / p[K], end = 2.0 * p[ENERGY] / p[STRENGTH], d = b->damage[k];
        double least = u <= first ? 0.0 : u >= end ? 1.0 : end * (u - first) / (u * (end - first));
        if (u < 0.7 * first && d > least) s *= 1.0 - 0.5 * d;
#elif defined(WRONG_SECANT)
        /* Leaves the line to the origin on its way back, where the undamaged bond is on one. */
        double first = p[STRENGTH] / p[K], d = b->damage[k];
        if (u > 0.7 * first && u < 0.99 * first && d > 0.0) s *= 1.0 - 0.5 * d;
#endif
        b->out_traction_n[k] = s * n;
        b->out_traction_t1[k] = s * t1;
        if (b->out_traction_t2) b->out_traction_t2[k] = s * t2;
#if defined(WRONG_FRAME)
        if (b->out_traction_t2) b->out_traction_t2[k] *= 1.0 + 1e-4;
#endif
        b->out_stiffness_n[k] = s;
        b->out_stiffness_t[k] = s;
#if defined(WRONG_TANGENT)
        b->out_stiffness_n[k] = 1.5 * s;
#endif
        if (bad(s * u) || bad(b->out_stiffness_n[k])) return fail(m, k);
    }
    return FW_OK;
}

static int32_t energy(const fw_batch *b, fw_message *m) {
    for (size_t k = 0; k < b->n; k++) {
        double t2 = b->opening_t2 ? b->opening_t2[k] : 0.0;
        double u = length(b->opening_n[k], b->opening_t1[k], t2);
        b->out_energy[k] = (1.0 - b->damage[k]) * stored(b->parameters, u);
#if defined(WRONG_DISSIPATION)
        b->out_energy[k] *= 1.5;
#elif defined(WRONG_STORED)
        b->out_energy[k] *= 1.005;
#endif
        if (bad(b->out_energy[k])) return fail(m, k);
    }
    return FW_OK;
}

static int32_t commit(const fw_batch *b, fw_message *m) {
    const double *p = b->parameters;
    for (size_t k = 0; k < b->n; k++) {
        double t2 = b->opening_t2 ? b->opening_t2[k] : 0.0;
        double u = length(b->opening_n[k], b->opening_t1[k], t2), d = b->damage[k];
        double first = p[STRENGTH] / p[K], end = 2.0 * p[ENERGY] / p[STRENGTH];
        double new = u <= first ? 0.0 : u >= end ? 1.0 : end * (u - first) / (u * (end - first));
        if (new < d) new = d;
#if defined(WRONG_HEALING)
        if (u < 0.5 * b->state[0][k]) new = 0.9 * d;
#elif defined(WRONG_STEP)
        new = u > first && u > b->state[0][k] ? fmin(1.0, d + 0.002) : d;
#endif
        b->out_damage[k] = new;
        b->state_next[0][k] = fmax(u, b->state[0][k]);
        if (bad(u) || bad(new)) return fail(m, k);
    }
    return FW_OK;
}

static double declared(const double *p, double angle) {
    (void)angle;
#if defined(WRONG_ENERGY)
    return 1.1 * p[ENERGY];
#elif defined(WRONG_ENERGY_BY_HALF_A_PERCENT)
    return 1.005 * p[ENERGY];
#elif defined(WRONG_CURVED) || defined(WRONG_STEP)
    (void)p;
    return NAN;
#else
    return p[ENERGY];
#endif
}

#if defined(WRONG_CACHE)
static int32_t validate(const double *p, fw_message *m) {
    (void)m;
    cache = p[K];
    return FW_OK;
}
#endif

static const fw_plugin table = {
    .size = sizeof(fw_plugin),
    .abi_major = FW_ABI_MAJOR,
    .abi_minor = FW_ABI_MINOR,
    .kind = FW_KIND_COHESION,
    .flags = FW_FLAG_OPENING | FW_FLAG_BREAKS,
    .name = "tested",
    .version = "1.0.0",
    .doc = "a linear bond that softens linearly",
    .reference = "none",
    .n_parameters = 3,
    .parameters = parameters,
    .n_variables = 1,
    .variables = variables,
    .degradation = 1.0,
#if defined(WRONG_CACHE)
    .validate = validate,
#endif
    .prepare = prepare,
    .commit = commit,
    .energy = energy,
    .fracture_energy = declared,
};

const fw_plugin *fretwork_plugin(void) { return &table; }
