#include "mpc.h"

#include <math.h>
#include <stdlib.h>

/* By how much an accepted plan may miss a constraint; SPEED_TOLERANCE for speeds. */
#define POSITION_TOLERANCE 1e-6 /* [m] */
#define FORCE_TOLERANCE 1e-2    /* [N] */

/* ---- memory: one block ---- */

static double *take(double **place, size_t count) {
    double *const taken = *place;
    *place += count;
    return taken;
}

Mpc *mpc_create(const Parameters *p) {
    const size_t N = (size_t)p->N, rows = 4 * N - 4;
    const size_t numbers = 4 * rows + 5 * N + 3 * N * N, integers = rows + N;
    Mpc *const mpc = calloc(1, sizeof(Mpc) + numbers * sizeof(double) + integers * sizeof(int));
    if (mpc == NULL) return NULL;
    double *place = (double *)(mpc + 1);
    mpc->problem = (SpeedProblem){.p = *p,
                                  .N = (int)N,
                                  .rows = (int)rows,
                                  .decay = 1.0 - p->alpha * p->dt / p->M,
                                  .per_force = p->dt / p->M,
                                  .d_safe = p->d_safe + p->d_margin,
                                  .lower = take(&place, rows),
                                  .upper = take(&place, rows)};
    mpc->active = (ActiveSet){.values = take(&place, rows),
                              .multipliers = take(&place, rows),
                              .V = take(&place, N),
                              .dual = take(&place, N),
                              .share = take(&place, N),
                              .normal = take(&place, N),
                              .right = take(&place, N),
                              .Q = take(&place, N * N),
                              .R = take(&place, N * N),
                              .rows = take(&place, N * N)};
    mpc->active.side = (int *)place;
    mpc->active.index = mpc->active.side + rows;
    return mpc;
}

/* ---- planning ---- */

/* Drive the plan's forces through the model: its largest violation of c1 to c6 over its tolerance. */
static double largest_violation(const SpeedProblem *s, const PlanStart *start, const double *V) {
    const Parameters *const p = &s->p;
    const double force_tolerance = larger(FORCE_TOLERANCE, 2.0 * SLACK / s->per_force);
    double position = start->position, speed = start->speed, previous = start->previous_force;
    double before = speed, worst = 0.0;
    for (int i = 0; i < s->N; ++i) {
        const double u = (V[i] - s->decay * before) / s->per_force;
        if (!isfinite(u)) return HUGE_VAL;
        before = V[i];
        worst = larger(worst, (fabs(u) - p->u_max) / force_tolerance);
        worst = larger(worst, (fabs(u - previous) - p->du_max) / force_tolerance);
        position += p->dt * speed;
        speed = s->decay * speed + s->per_force * u;
        worst = larger(worst, (position - (start->obstacle[i] - s->d_safe)) / POSITION_TOLERANCE);
        worst = larger(worst, (speed - p->v_max) / SPEED_TOLERANCE);
        worst = larger(worst, (p->v_min - speed) / SPEED_TOLERANCE);
        previous = u;
    }
    return worst;
}

Infeasibility mpc_plan(Mpc *mpc, const PlanStart *start, double *force) {
    SpeedProblem *const s = &mpc->problem;
    ActiveSet *const a = &mpc->active;
    const Infeasibility proof = speed_problem_update(s, start);
    if (proof != PLANNED) return proof;
    const SolveResult result = active_set_solve(a, s);
    if (result == INFEASIBLE) return active_set_certifies(a, s) ? NO_PLAN_EXISTS : NOT_VERIFIED;
    if (result != SOLVED || !(largest_violation(s, start, a->V) <= 1.0)) return NOT_VERIFIED;
    *force = (a->V[0] - s->decay * start->speed) / s->per_force;
    return PLANNED;
}
