@HEAD@
enum { THERMAL, ELECTRIC };
static const fw_field parameters[] = {
    {"thermal", "W/(N K)", "thermal conductance per force", 1e-3, 0.0, 1e30, 0},
    {"electric", "S/N", "electrical conductance per force", 1.0, 0.0, 1e30, 0},
};

@FAIL@
/* (1) Normal force (N) from the normal impulse over the step (N s). */
static double force(double impulse, double h) { return fmax(impulse / h, 0.0); }

/* (2) Thermal (W/K) or electrical (S) conductance under a normal force (N), at the temperature of
 * the contact (K). */
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

@TABLE@
    .flags = 0,
    .doc = "conductance in proportion to the force",
    .commit = commit,
@END@
