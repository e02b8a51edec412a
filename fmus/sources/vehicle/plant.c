/* M s'' + alpha s' = u, the longitudinal vehicle model of Yang & Özgüner 2019 (arXiv 1907.05178).
 *
 * Only + - * / and comparisons of doubles, no libm, compiled without contraction: the same bits on
 * every platform. Each line is evaluated as it stands, left to right.
 */
#include "plant.h"

#include <stddef.h>

const PlantParameters PLANT_DEFAULTS = {
    .M = 1000.0, .alpha = 100.0, .s0 = 0.0, .v0 = 0.0, .exact = false, .reverse = false};

const char *plant_parameter_problem(const PlantParameters *p, double *value) {
    if (!(p->M > 0.0)) {
        *value = p->M;
        return "M = %g kg: expected a mass above 0";
    }
    if (!(p->alpha >= 0.0)) {
        *value = p->alpha;
        return "alpha = %g N.s/m: expected 0 or more";
    }
    if (!p->reverse && p->v0 < 0.0) {
        *value = p->v0;
        return "v0 = %g m/s: expected 0 or more (or reverse = true)";
    }
    return NULL;
}

PlantState plant_initial_state(const PlantParameters *p) {
    return (PlantState){.position = p->s0, .speed = p->v0, .acceleration = 0.0};
}

/* ---- exact discretisation: A = e^(Ac dt), B = (integral of e^(Ac t) over the step) Bc ----
 *
 * With z = alpha dt / M everything is made of two functions without singularity at alpha = 0:
 *     phi1(z) = (1 - e^-z) / z        phi2(z) = (e^-z - 1 + z) / z^2
 */
typedef struct {
    double decay; /* e^-z */
    double phi1, phi2;
} Phi;

static Phi phi(double z) {
    /* Beyond 1000 e^-z is zero in double precision; this also catches z = infinity. */
    if (z > 1000.0) return (Phi){.decay = 0.0, .phi1 = 1.0 / z, .phi2 = (1.0 - 1.0 / z) / z};
    int doublings = 0;
    while (z > 0.5) {
        z *= 0.5;
        ++doublings;
    }
    /* phi2(z) = 1/2! - z/3! + z^2/4! - ...; the first term left out is below 1e-19 for z <= 1/2. */
    double phi2 = 0.0;
    for (int n = 14; n >= 0; --n) phi2 = (1.0 - z * phi2) / (n + 2);
    double phi1 = 1.0 - z * phi2;
    double decay = 1.0 - z * phi1;
    for (; doublings > 0; --doublings) { /* z -> 2 z: sums of positive terms, nothing cancels */
        phi2 = (2.0 * phi2 + phi1 * phi1) * 0.25;
        phi1 = phi1 * (1.0 + decay) * 0.5;
        decay = decay * decay;
    }
    return (Phi){.decay = decay, .phi1 = phi1, .phi2 = phi2};
}

PlantDiscretisation plant_discretise(const PlantParameters *p, double dt) {
    if (!p->exact) /* the paper's A = [1 dt; 0 1 - alpha dt / M], B = [0; dt / M] */
        return (PlantDiscretisation){
            .dt = dt, .a12 = dt, .a22 = 1.0 - p->alpha * dt / p->M, .b1 = 0.0, .b2 = dt / p->M};
    const Phi f = phi(p->alpha * dt / p->M);
    return (PlantDiscretisation){.dt = dt,
                                 .a12 = dt * f.phi1,
                                 .a22 = f.decay,
                                 .b1 = dt * dt * f.phi2 / p->M,
                                 .b2 = dt * f.phi1 / p->M};
}

/* ---- standstill inside an exact step ----
 *
 * M v' + alpha v = u with v > 0 > u reaches v = 0 at t = (M / alpha) ln(1 + w), w = alpha v / -u.
 * Integrating the equation up to there gives the way
 *     M v^2 / -u * (w - ln(1 + w)) / w^2,    for alpha = 0 the familiar v^2 / (2 a).
 */

/* (w - ln(1 + w)) / w^2 for 0 <= w <= 1 */
static double stopping_factor(double w) {
    /* ln(1 + w) = 2 artanh(y), y = w / (2 + w) <= 1/3, and w - 2 y = w y without cancellation. */
    const double y = w / (2.0 + w);
    double series = 0.0; /* 1/3 + y^2/5 + y^4/7 + ... */
    for (int n = 37; n >= 3; n -= 2) series = 1.0 / n + y * y * series;
    return (1.0 - 2.0 * y * series / (2.0 + w)) / (2.0 + w);
}

/* ln(x) for finite x >= 1 */
static double natural_logarithm(double x) {
    const double ln2 = 0.69314718055994530942;
    int twos = 0;
    while (x > 1.5) {
        x *= 0.5;
        ++twos;
    }
    const double y = (x - 1.0) / (x + 1.0); /* |y| <= 1/5 */
    double series = 0.0;
    for (int n = 25; n >= 1; n -= 2) series = 1.0 / n + y * y * series;
    return twos * ln2 + 2.0 * y * series;
}

static double stopping_distance(const PlantParameters *p, double v, double u) {
    const double w = p->alpha * v / -u;
    if (w <= 1.0) return p->M * v / -u * v * stopping_factor(w);
    const double rolled_out = p->M * v / p->alpha; /* the way without any braking */
    return w < 1e300 ? rolled_out * (1.0 - natural_logarithm(1.0 + w) / w) : rolled_out;
}

PlantState plant_step(const PlantParameters *p, const PlantDiscretisation *d, PlantState x, double u) {
    PlantState next;
    next.position = x.position + d->a12 * x.speed + d->b1 * u;
    next.speed = d->a22 * x.speed + d->b2 * u;
    if (!p->reverse && next.speed <= 0.0) { /* the brakes hold; NaN passes, for the host to see */
        if (p->exact && u < 0.0) next.position = x.position + stopping_distance(p, x.speed, u);
        next.speed = 0.0;
    }
    next.acceleration = (next.speed - x.speed) / d->dt;
    return next;
}
