/* The paper's QP in the unknowns V = v(k+1) ... v(k+N): min |V - v_ref|^2, lower <= rows V <= upper.
 *
 * Forces follow from speeds, u(i) = M/dt (v(i+1) - a v(i)) with a = 1 - alpha dt / M, which turns the cost into
 * a sum of squares whatever mass and time step are. Rows, 4 N - 4 in this order (Yang & Özgüner 2019, eqs. (9)
 * to (16)):
 *     N       speeds: c4, c5; the first also holds c1 to c3 of u(k) and c6 of x_1(k+2)
 *     N - 1   v(i+1) - a v(i) = dt/M u(i): c1
 *     N - 1   differences of these: c2, c3
 *     N - 2   sums of speeds, the distances driven to x_1(k+3) ... x_1(k+N), over dt: c6
 * Forward Euler makes x_1(k+1) independent of all unknowns: its row is a test before any solve.
 */
#ifndef SPEED_PROBLEM_H
#define SPEED_PROBLEM_H

#include "parameters.h"

/* Why there is no plan; PLANNED: there is one. The values of the output `infeasibility`. */
typedef enum {
    PLANNED,
    TOO_CLOSE,          /* x_1(k+1), which no force changes, violates c6 */
    SPEED_BOUNDS_CROSS, /* what the force limits leave of v(k+1) misses its bounds */
    CANNOT_STOP,        /* even the hardest braking at every step violates c6 */
    CANNOT_HOLD_SPEED,  /* even the strongest drive at every step violates c5 */
    NO_PLAN_EXISTS,     /* the dual active-set method ended with a certificate */
    NOT_VERIFIED        /* a plan was found, but it misses a constraint: rounding */
} Infeasibility;

/* All bounds are this much wider, in [m/s] and [m]: a plan that touches its bounds, as those that just stop do,
 * leaves the next problem a single point, which rounding would make empty. */
#define SLACK 1e-9

/* Violation [m/s] of the speed bounds with which a plan is accepted. The proofs from these bounds leave as much
 * room: the state that an accepted plan leads to has a plan. */
#define SPEED_TOLERANCE 1e-6

/* What is planned from, at t_k. */
typedef struct {
    double position;        /* [m]   x_1(k) of the point that keeps the distance */
    double speed;           /* [m/s] x_2(k) */
    double previous_force;  /* [N]   u(k-1) */
    double reference_speed; /* [m/s] over this horizon */
    const double *obstacle; /* [m]   (N,) x_p(k+1) ... x_p(k+N) */
} PlanStart;

typedef struct {
    Parameters p;
    int N, rows;
    double decay;     /* a */
    double per_force; /* dt/M */
    double d_safe;    /* [m] the margin included */
    double target;    /* [m/s] the reference speed, of every step */
    double *lower;    /* (rows,) */
    double *upper;    /* (rows,) */
} SpeedProblem;

static inline double smaller(double a, double b) { return b < a ? b : a; }
static inline double larger(double a, double b) { return b > a ? b : a; }

/* Set the bounds; PLANNED where only a solve can tell. */
Infeasibility speed_problem_update(SpeedProblem *s, const PlanStart *start);

/* values[i] = rows[i] V for all rows. */
void speed_problem_values(const SpeedProblem *s, const double *V, double *values);

/* The coefficients of one row, (N,). */
void speed_problem_row(const SpeedProblem *s, int i, double *row);

#endif
