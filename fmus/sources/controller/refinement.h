/* The optimum on the final active set, to rounding, and verified: primal and dual (Boyd & Vandenberghe 2004,
 * section 5.5.3). */
#ifndef REFINEMENT_H
#define REFINEMENT_H

#include "active_set.h"

/* Solve anew on the rows that `side` names, free of the rounding gathered on the way to them, and correct `side`
 * where the optimality conditions ask for it. V receives the minimiser; false where it is not verified. */
bool refine(ActiveSet *a, const SpeedProblem *s);

#endif
