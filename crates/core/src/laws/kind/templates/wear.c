@HEAD@
enum { COEFFICIENT, HARDNESS };
static const fw_field parameters[] = {
    {"k", "", "wear coefficient", 1e-4, 0.0, 1.0, 0},
    {"hardness", "Pa", "hardness of the softer body", 3e9, 1.0, 1e30, 0},
};

@FAIL@
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

@TABLE@
    .flags = 0,
    .doc = "volume proportional to force and slip",
    .commit = commit,
@END@
