/* The plant M s'' + alpha s' = u: its parameters, its state and one step of it. Knows no FMI. */
#ifndef PLANT_H
#define PLANT_H

#include <stdbool.h>

typedef struct {
    double M;     /* [kg]    mass */
    double alpha; /* [N.s/m] viscous friction */
    double s0;    /* [m]     position at the start */
    double v0;    /* [m/s]   speed at the start */
    bool exact;   /* false: forward Euler, as the paper; true: exact for a force held over the step */
    bool reverse; /* false: brakes hold a standing car, v >= 0; true: linear everywhere */
} PlantParameters;

typedef struct {
    double position;     /* [m] */
    double speed;        /* [m/s] */
    double acceleration; /* [m/s2] mean over the last step: (v(k+1) - v(k)) / dt; 0 before the first */
} PlantState;

/* x(k+1) = [1 a12; 0 a22] x(k) + [b1; b2] u(k) with x = (position, speed) and a step of dt. */
typedef struct {
    double dt; /* [s] */
    double a12, a22, b1, b2;
} PlantDiscretisation;

extern const PlantParameters PLANT_DEFAULTS;

/* What is wrong with the parameters, as a printf format of one value (in *value); NULL: nothing. */
const char *plant_parameter_problem(const PlantParameters *p, double *value);

PlantState plant_initial_state(const PlantParameters *p);

PlantDiscretisation plant_discretise(const PlantParameters *p, double dt);

/* One step under the constant force u [N]. */
PlantState plant_step(const PlantParameters *p, const PlantDiscretisation *d, PlantState x, double u);

#endif
