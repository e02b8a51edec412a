#include "speed_problem.h"

#include <math.h>

/* ---- rows ---- */

void speed_problem_values(const SpeedProblem *s, const double *V, double *values) {
    const int N = s->N;
    double *const accelerations = values + N;
    double *const rates = accelerations + N - 1;
    double *const distances = rates + N - 1;
    for (int i = 0; i < N; ++i) values[i] = V[i];
    for (int i = 0; i < N - 1; ++i) accelerations[i] = -s->decay * V[i] + V[i + 1];
    rates[0] = (-s->decay - 1.0) * V[0] + V[1];
    for (int i = 1; i < N - 1; ++i) rates[i] = s->decay * V[i - 1] + (-s->decay - 1.0) * V[i] + V[i + 1];
    double driven = V[0];
    for (int i = 0; i < N - 2; ++i) {
        driven += V[i + 1];
        distances[i] = driven;
    }
}

void speed_problem_row(const SpeedProblem *s, int i, double *row) {
    const int N = s->N;
    for (int j = 0; j < N; ++j) row[j] = 0.0;
    if (i < N) {
        row[i] = 1.0;
    } else if (i < 2 * N - 1) {
        row[i - N] = -s->decay;
        row[i - N + 1] = 1.0;
    } else if (i < 3 * N - 2) {
        const int r = i - (2 * N - 1);
        if (r > 0) row[r - 1] = s->decay;
        row[r] = -s->decay - 1.0;
        row[r + 1] = 1.0;
    } else {
        for (int j = 0; j <= i - (3 * N - 2) + 1; ++j) row[j] = 1.0;
    }
}

/* ---- bounds ---- */

/* The slowest and the fastest speeds that the force limits allow, against c6 and c5.
 *
 * Speeds grow with forces and positions with speeds (decay >= 0), so braking as hard as allowed at every step,
 * but not below v_min, bounds every plan from below. The converse does not hold: a plan at this bound may have
 * to release the brake faster than allowed.
 */
static Infeasibility prove_infeasible(const SpeedProblem *s, const PlanStart *start) {
    const int N = s->N;
    const double v_min = s->p.v_min - SLACK;
    const double change_max = s->per_force * s->p.u_max + SLACK; /* [m/s] by u_max in one step */
    const double rate_max = s->per_force * s->p.du_max + SLACK;
    const double *const allowed = s->upper + 3 * N - 3; /* of the sum of speeds 0 ... i */
    double slowest = start->speed, fastest = start->speed;
    double weakest = s->per_force * start->previous_force, strongest = weakest; /* [m/s] a step */
    double driven = 0.0;
    for (int i = 0; i < N; ++i) {
        weakest = larger(-change_max, weakest - rate_max);
        strongest = smaller(change_max, strongest + rate_max);
        slowest = larger(v_min, s->decay * slowest + weakest);
        fastest = s->decay * fastest + strongest;
        if (fastest < v_min - SPEED_TOLERANCE) return CANNOT_HOLD_SPEED;
        driven += slowest;
        if (1 <= i && i < N - 1 && driven > allowed[i]) return CANNOT_STOP;
    }
    return PLANNED;
}

Infeasibility speed_problem_update(SpeedProblem *s, const PlanStart *start) {
    const Parameters *const p = &s->p;
    const int N = s->N;
    const double *const x_p = start->obstacle;
    double *const lower = s->lower, *const upper = s->upper;
    const double after_one = start->position + p->dt * start->speed; /* x_1(k+1) */
    s->target = start->reference_speed;
    if (after_one > x_p[0] - s->d_safe + SLACK) return TOO_CLOSE;

    for (int i = 0; i < N; ++i) {
        lower[i] = p->v_min;
        upper[i] = p->v_max;
    }
    const double weakest = larger(-p->u_max, start->previous_force - p->du_max);
    const double strongest = smaller(p->u_max, start->previous_force + p->du_max);
    lower[0] = larger(p->v_min, s->decay * start->speed + s->per_force * weakest);
    upper[0] = smaller(p->v_max, s->decay * start->speed + s->per_force * strongest);
    upper[0] = smaller(upper[0], (x_p[1] - s->d_safe - after_one) / p->dt);
    for (int i = N; i < 2 * N - 1; ++i) {
        lower[i] = -s->per_force * p->u_max;
        upper[i] = s->per_force * p->u_max;
    }
    for (int i = 2 * N - 1; i < 3 * N - 2; ++i) {
        lower[i] = -s->per_force * p->du_max;
        upper[i] = s->per_force * p->du_max;
    }
    lower[2 * N - 1] -= s->decay * start->speed; /* u(k) = (v(k+1) - a v(k)) M/dt has a constant part */
    upper[2 * N - 1] -= s->decay * start->speed;
    for (int i = 2; i < N; ++i) {
        lower[3 * N - 4 + i] = -HUGE_VAL;
        upper[3 * N - 4 + i] = (x_p[i] - s->d_safe - after_one) / p->dt;
    }
    for (int i = 0; i < s->rows; ++i) {
        lower[i] -= SLACK;
        upper[i] += SLACK;
    }
    if (lower[0] > upper[0] + SPEED_TOLERANCE) return SPEED_BOUNDS_CROSS;
    upper[0] = larger(lower[0], upper[0]);
    return prove_infeasible(s, start);
}
