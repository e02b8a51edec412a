/* The model predictive controller of Yang & Özgüner 2019, section 3. */
#ifndef MPC_H
#define MPC_H

#include "active_set.h"

typedef struct {
    SpeedProblem problem;
    ActiveSet active;
} Mpc;

/* NULL where memory has run out; released by free(). */
Mpc *mpc_create(const Parameters *p);

/* Plan from the state at t_k. PLANNED: *force is u(k) [N]. Depends on nothing but its arguments. */
Infeasibility mpc_plan(Mpc *mpc, const PlanStart *start, double *force);

#endif
