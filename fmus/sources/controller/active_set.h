/* The dual active-set method of Goldfarb & Idnani (1983) for the speed problem: exact, without iterating to a
 * tolerance, and with a certificate where no plan exists. */
#ifndef ACTIVE_SET_H
#define ACTIVE_SET_H

#include "speed_problem.h"

#include <stdbool.h>

/* [m/s] and below: rounding of sums of at most N speeds. */
#define PRIMAL_TOLERANCE 1e-10

/* Room for one solve; nothing is kept from one to the next. */
typedef struct {
    double *V;           /* (N,) the solution [m/s] */
    double *values;      /* (rows,) of the rows at V */
    double *multipliers; /* (rows,) of a certificate */
    int *side;           /* (rows,) +1: the upper bound binds, -1: the lower, 0: neither */
    int active;          /* rows that bind */
    int *index;          /* (N,) which, in the order in which they came */
    double *dual;        /* (N,) their multipliers, >= 0 */
    double *share;       /* (N,) */
    double *normal;      /* (N,) a row, and what is left of it outside the span of the active ones */
    double *Q;           /* (N, N) rows: an orthonormal basis of the active rows, signed by side, ... */
    double *R;           /* (N, N) ... and the upper triangle R with active rows' = Q' R */
    double *rows;        /* (N, N) the active rows in the order of their indices */
    double *right;       /* (N,) scratch */
} ActiveSet;

typedef enum { SOLVED, INFEASIBLE, UNFINISHED } SolveResult;

/* Minimise from the unconstrained optimum on; the minimiser is in V. */
SolveResult active_set_solve(ActiveSet *a, const SpeedProblem *s);

/* The row outside the active set that misses a bound by most, and which bound; -1: none does. */
int most_violated(ActiveSet *a, const SpeedProblem *s, int *side);

/* Whether `multipliers` proves, by our own arithmetic, that no V in the box of possible speeds satisfies all
 * rows (Farkas). */
bool active_set_certifies(ActiveSet *a, const SpeedProblem *s);

#endif
