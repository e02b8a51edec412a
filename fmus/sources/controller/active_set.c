#include "active_set.h"
#include "refinement.h"

#include <math.h>

#define DEPENDENT 1e-18 /* squared length of what is left of a row, relative, that counts as zero */

static double dot(const double *x, const double *y, int n) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += x[i] * y[i];
    return sum;
}

/* ---- the active rows' factors ---- */

/* Take its part in the span of the active rows away from `normal`; `share` receives the coefficients of that
 * part in the basis. Modified Gram-Schmidt, twice: once loses orthogonality where rows nearly depend. */
static void project(ActiveSet *a, int N) {
    for (int k = 0; k < a->active; ++k) a->share[k] = 0.0;
    for (int pass = 0; pass < 2; ++pass) {
        for (int k = 0; k < a->active; ++k) {
            const double *const q = a->Q + k * N;
            const double product = dot(q, a->normal, N);
            a->share[k] += product;
            for (int j = 0; j < N; ++j) a->normal[j] -= product * q[j];
        }
    }
}

/* Append the row whose projection is in `normal` and `share`. */
static void append(ActiveSet *a, int N, int row, int side, double price) {
    const int k = a->active++;
    const double length = sqrt(dot(a->normal, a->normal, N));
    for (int j = 0; j < N; ++j) a->Q[k * N + j] = a->normal[j] / length;
    for (int i = 0; i < k; ++i) a->R[i * N + k] = a->share[i];
    a->R[k * N + k] = length;
    a->index[k] = row;
    a->dual[k] = price;
    a->side[row] = side;
}

/* Rotate two rows of the basis, and of the triangle from column `from` on, so that R[k + 1][from] vanishes. */
static void rotate(ActiveSet *a, int N, int k, int from, int to) {
    double *const upper = a->R + k * N, *const lower = upper + N;
    const double length = sqrt(upper[from] * upper[from] + lower[from] * lower[from]);
    const double c = upper[from] / length, s = lower[from] / length;
    for (int j = from; j < to; ++j) {
        const double above = upper[j], below = lower[j];
        upper[j] = c * above + s * below;
        lower[j] = c * below - s * above;
    }
    double *const q = a->Q + k * N, *const next = q + N;
    for (int j = 0; j < N; ++j) {
        const double above = q[j], below = next[j];
        q[j] = c * above + s * below;
        next[j] = c * below - s * above;
    }
}

/* Remove the active row number p. */
static void drop(ActiveSet *a, int N, int p) {
    const int count = --a->active;
    a->side[a->index[p]] = 0;
    for (int k = p; k < count; ++k) {
        a->index[k] = a->index[k + 1];
        a->dual[k] = a->dual[k + 1];
        for (int i = 0; i <= k + 1; ++i) a->R[i * N + k] = a->R[i * N + k + 1];
    }
    for (int k = p; k < count; ++k) rotate(a, N, k, k, count);
}

/* ---- the method ---- */

int most_violated(ActiveSet *a, const SpeedProblem *s, int *side) {
    double worst = PRIMAL_TOLERANCE;
    int found = -1;
    speed_problem_values(s, a->V, a->values);
    for (int i = 0; i < s->rows; ++i) {
        if (a->side[i] != 0) continue;
        if (a->values[i] - s->upper[i] > worst) {
            worst = a->values[i] - s->upper[i];
            found = i;
            *side = 1;
        }
        if (s->lower[i] - a->values[i] > worst) {
            worst = s->lower[i] - a->values[i];
            found = i;
            *side = -1;
        }
    }
    return found;
}

/* The violated row less a non-positive combination of active ones: Farkas' multipliers. */
static void certificate(ActiveSet *a, const SpeedProblem *s, int violated, int side) {
    for (int i = 0; i < s->rows; ++i) a->multipliers[i] = 0.0;
    a->multipliers[violated] = side;
    for (int k = 0; k < a->active; ++k) a->multipliers[a->index[k]] = -a->right[k] * a->side[a->index[k]];
}

/* By how much each multiplier falls for a unit step, in `right`: R right = share, from the bottom up. The step, up
 * to which none falls below 0, and the active row that limits it; -1: none does. */
static int dual_limit(ActiveSet *a, int N, double *step) {
    for (int k = a->active - 1; k >= 0; --k) {
        double rest = a->share[k];
        for (int l = k + 1; l < a->active; ++l) rest -= a->R[k * N + l] * a->right[l];
        a->right[k] = rest / a->R[k * N + k];
    }
    int blocking = -1;
    *step = HUGE_VAL;
    for (int k = 0; k < a->active; ++k) {
        if (a->right[k] > 0.0 && a->dual[k] < *step * a->right[k]) {
            *step = a->dual[k] / a->right[k];
            blocking = k;
        }
    }
    return blocking;
}

/* Make one violated row bind: steps towards it, and drops of rows whose multiplier reaches 0 on the way. */
static SolveResult add(ActiveSet *a, const SpeedProblem *s, int violated, int side, int *steps_left) {
    const int N = s->N;
    double price = 0.0;
    for (; *steps_left > 0; --*steps_left) {
        speed_problem_row(s, violated, a->normal);
        const double value = dot(a->normal, a->V, N);
        const double size = dot(a->normal, a->normal, N);
        const double excess = side > 0 ? value - s->upper[violated] : s->lower[violated] - value;
        for (int j = 0; j < N; ++j) a->normal[j] *= side;
        project(a, N);
        const double length = dot(a->normal, a->normal, N);
        const bool independent = a->active < N && length > DEPENDENT * size;
        const double full = independent ? excess / length : HUGE_VAL;
        double partial;
        const int blocking = dual_limit(a, N, &partial);
        const double taken = smaller(partial, full);
        if (!(taken < HUGE_VAL)) {
            certificate(a, s, violated, side);
            return INFEASIBLE;
        }
        for (int k = 0; k < a->active; ++k) a->dual[k] -= taken * a->right[k];
        price += taken;
        if (independent)
            for (int j = 0; j < N; ++j) a->V[j] -= taken * a->normal[j];
        if (full <= partial) {
            append(a, N, violated, side, price);
            return SOLVED;
        }
        drop(a, N, blocking);
    }
    return UNFINISHED;
}

SolveResult active_set_solve(ActiveSet *a, const SpeedProblem *s) {
    int steps_left = 10 * s->N;
    for (int i = 0; i < s->rows; ++i) a->side[i] = 0;
    for (int j = 0; j < s->N; ++j) a->V[j] = s->target;
    a->active = 0;
    for (; steps_left > 0; --steps_left) {
        int side = 0;
        const int violated = most_violated(a, s, &side);
        if (violated < 0) return refine(a, s) ? SOLVED : UNFINISHED;
        const SolveResult result = add(a, s, violated, side, &steps_left);
        if (result != SOLVED) return result;
    }
    return UNFINISHED;
}

bool active_set_certifies(ActiveSet *a, const SpeedProblem *s) {
    const int N = s->N;
    const double box_low = s->p.v_min - 1.0, box_high = s->p.v_max + 1.0;
    double largest = 0.0;
    for (int i = 0; i < s->rows; ++i) largest = larger(largest, fabs(a->multipliers[i]));
    if (!(largest > 0.0 && isfinite(largest))) return false;
    double *const gradient = a->right, *const row = a->normal;
    double support = 0.0, size = 0.0;
    for (int j = 0; j < N; ++j) gradient[j] = 0.0;
    for (int i = 0; i < s->rows; ++i) {
        const double y = a->multipliers[i] / largest;
        const double bound = y > 0.0 ? s->upper[i] : s->lower[i];
        if (y == 0.0 || !isfinite(bound)) continue; /* of a bound that is not there: rounding */
        support += y * bound;
        size += fabs(y * bound);
        speed_problem_row(s, i, row);
        for (int j = 0; j < N; ++j) gradient[j] += y * row[j];
    }
    double least = 0.0;
    for (int j = 0; j < N; ++j) {
        least += smaller(gradient[j] * box_low, gradient[j] * box_high);
        size += fabs(gradient[j]) * box_high;
    }
    return least - support > 1e-12 * size;
}
