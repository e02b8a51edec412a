#include "refinement.h"

#include <math.h>

#define PIVOT 1e-11           /* relative: below it a binding row depends on the others */
#define DUAL_TOLERANCE 1e-11  /* [m/s] by which a multiplier may have the wrong sign */

/* List the active rows in the order of their indices; their number, -1 where they are too many. */
static int gather(ActiveSet *a, const SpeedProblem *s) {
    int count = 0;
    for (int i = 0; i < s->rows; ++i) {
        if (a->side[i] == 0) continue;
        if (count == s->N) return -1;
        speed_problem_row(s, i, a->rows + count * s->N);
        a->index[count++] = i;
    }
    return count;
}

/* Minimise |V - target|^2 with the active rows at their bounds, by a Cholesky factorisation of their Gram matrix
 * (in R). -1, or the number of an active row that depends on those before it. */
static int solve_equalities(ActiveSet *a, const SpeedProblem *s) {
    const int N = s->N, count = a->active;
    double *const factor = a->R, *const dual = a->dual;
    for (int k = 0; k < count; ++k) {
        const double *const row = a->rows + k * N;
        double value = 0.0, scale = 0.0;
        for (int j = 0; j < N; ++j) value += row[j] * s->target;
        for (int j = 0; j < N; ++j) scale += row[j] * row[j];
        a->right[k] = value - (a->side[a->index[k]] > 0 ? s->upper : s->lower)[a->index[k]];
        for (int l = 0; l <= k; ++l) {
            const double *const other = a->rows + l * N;
            double product = 0.0;
            for (int j = 0; j < N; ++j) product += row[j] * other[j];
            for (int c = 0; c < l; ++c) product -= factor[k * N + c] * factor[l * N + c];
            if (l < k)
                factor[k * N + l] = product / factor[l * N + l];
            else if (product <= PIVOT * scale)
                return k;
            else
                factor[k * N + k] = sqrt(product);
        }
    }
    for (int k = 0; k < count; ++k) {
        double value = a->right[k];
        for (int c = 0; c < k; ++c) value -= factor[k * N + c] * dual[c];
        dual[k] = value / factor[k * N + k];
    }
    for (int k = count - 1; k >= 0; --k) {
        double value = dual[k];
        for (int c = k + 1; c < count; ++c) value -= factor[c * N + k] * dual[c];
        dual[k] = value / factor[k * N + k];
    }
    for (int j = 0; j < N; ++j) {
        double value = s->target;
        for (int k = 0; k < count; ++k) value -= a->rows[k * N + j] * dual[k];
        a->V[j] = value;
    }
    return -1;
}

static bool all_finite(const double *values, int n) {
    for (int i = 0; i < n; ++i)
        if (!isfinite(values[i])) return false;
    return true;
}

/* The number of the active row whose multiplier has the wrong sign by most; -1: none has. */
static int wrong_sign(const ActiveSet *a) {
    double worst = -DUAL_TOLERANCE;
    int found = -1;
    for (int k = 0; k < a->active; ++k) {
        const double of_its_side = a->dual[k] * a->side[a->index[k]];
        if (of_its_side < worst) {
            worst = of_its_side;
            found = k;
        }
    }
    return found;
}

bool refine(ActiveSet *a, const SpeedProblem *s) {
    for (int correction = 0; correction < 4 * s->N; ++correction) {
        a->active = gather(a, s);
        if (a->active < 0) return false;
        int superfluous = solve_equalities(a, s);
        if (superfluous < 0) superfluous = wrong_sign(a);
        if (superfluous >= 0) {
            a->side[a->index[superfluous]] = 0;
            continue;
        }
        int side = 0;
        const int missing = most_violated(a, s, &side);
        if (missing < 0) return all_finite(a->V, s->N);
        a->side[missing] = side;
    }
    return false;
}
