@HEAD@
enum { MU_STATIC, MU_DYNAMIC, VELOCITY };
static const fw_field parameters[] = {
    {"mu_s", "", "friction coefficient at rest", 0.4, 0.0, 10.0, 0},
    {"mu_d", "", "friction coefficient at high speed", 0.3, 0.0, 10.0, 0},
    {"v", "m/s", "velocity over which it falls", 0.1, 1e-12, 1e30, 0},
};

@FAIL@
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

@TABLE@
    .flags = 0,
    .doc = "friction that falls with the velocity",
    .prepare = prepare,
@END@
