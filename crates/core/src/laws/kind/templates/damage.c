@HEAD@
enum { STRENGTH, ENERGY };
static const fw_field parameters[] = {
    {"strength", "Pa", "traction at which damage begins", 3e5, 1e-30, 1e30, 0},
    {"energy", "J/m^2", "fracture energy: area under the traction-opening curve", 0.5, 1e-30, 1e30, 0},
};

@FAIL@
/* (1) D at the end of the step, where t0 (Pa) is the traction that the undamaged bond would carry
 * at the opening u (m), so that psi = (1 - D)^m psi_0. Here: a line from the strength to zero. */
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

@TABLE@
    .flags = 0,
    .doc = "linear softening",
    .commit = commit,
    .fracture_energy = fracture_energy,
@END@
