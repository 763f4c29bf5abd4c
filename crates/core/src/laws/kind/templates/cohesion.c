@HEAD@
enum { K_N, K_T };
static const fw_field parameters[] = {
    {"k_n", "Pa/m", "normal stiffness of the intact bond", 1e12, 1.0, 1e30, 0},
    {"k_t", "Pa/m", "tangential stiffness of the intact bond", 1e12, 1.0, 1e30, 0},
};

@FAIL@
/* (1) Remaining stiffness fraction at damage D: traction = left(D) k x and psi = left(D) k x^2/2
 * must agree, and with `degradation` in the table, left = (1 - D)^m. */
static double left(double damage) { return 1.0 - damage; }

/* (2) Energy stored by the undamaged bond (J/m^2); a normal opening contributes only if
 * positive. */
static double stored(const double *p, double n, double t) {
    n = fmax(n, 0.0);
    return 0.5 * (p[K_N] * n * n + p[K_T] * t * t);
}

static double tangential(const fw_batch *b, size_t k) {
    return b->opening_t2 ? hypot(b->opening_t1[k], b->opening_t2[k]) : fabs(b->opening_t1[k]);
}

static int32_t prepare(const fw_batch *b, fw_message *message) {
    for (size_t k = 0; k < b->n; k++) {
        double kn = left(b->damage[k]) * b->parameters[K_N], kt = left(b->damage[k]) * b->parameters[K_T];
        b->out_traction_n[k] = kn * b->opening_n[k];
        b->out_traction_t1[k] = kt * b->opening_t1[k];
        if (b->out_traction_t2) b->out_traction_t2[k] = kt * b->opening_t2[k];
        b->out_stiffness_n[k] = kn;
        b->out_stiffness_t[k] = kt;
        if (!isfinite(kn * b->opening_n[k]) || !isfinite(kt * tangential(b, k)))
            return fail(message, k, "the traction is not finite");
    }
    return FW_OK;
}

static int32_t energy(const fw_batch *b, fw_message *message) {
    for (size_t k = 0; k < b->n; k++) {
        b->out_energy[k] = left(b->damage[k]) * stored(b->parameters, b->opening_n[k], tangential(b, k));
        if (!isfinite(b->out_energy[k])) return fail(message, k, "the energy is not finite");
    }
    return FW_OK;
}

@TABLE@
    .flags = FW_FLAG_OPENING | FW_FLAG_TENSION_ONLY | FW_FLAG_FORMS,
    .doc = "linear bond",
    .degradation = 1.0,
    .prepare = prepare,
    .energy = energy,
@END@
