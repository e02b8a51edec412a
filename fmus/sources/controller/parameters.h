/* What the regulator is set to. The symbols are those of Yang & Özgüner 2019 (arXiv 1907.05178), table 1. */
#ifndef PARAMETERS_H
#define PARAMETERS_H

#include <stdbool.h>

enum { HORIZON_MIN = 2, HORIZON_MAX = 200 };

/* The order is that of the letters in the token and of the value references from PARAMETER_M on. */
typedef struct {
    double M;        /* [kg]       mass of the model */
    double alpha;    /* [N.s/m]    viscous friction of the model */
    double dt;       /* [s]        time between two decisions */
    double v_r;      /* [m/s]      desired speed */
    double d_safe;   /* [m]        distance to keep */
    double d_margin; /* [m]        added to it in plans: how far the vehicle may miss its model */
    double d_buffer; /* [m]        over which the PID's reference speed rises to v_r */
    double v_min;    /* [m/s] */
    double v_max;    /* [m/s] */
    double u_max;    /* [N]        limit of the force, either way */
    double du_max;   /* [N]        limit of its change per step; of plans, not of the PID */
    double K_p;      /* [N.s/m] */
    double K_i;      /* [N/m] */
    double K_d;      /* [N.s2/m] */
    double N;        /*            horizon in steps, a whole number */
    double mpc;      /*            0: the PID alone, else the MPC with the PID as its fallback */
} Parameters;

enum { PARAMETER_COUNT = sizeof(Parameters) / sizeof(double) };

/* Start values: those of the paper, but for what follows MODEL_TOKEN in the token. False where it is none of ours. */
bool parameters_from_token(const char *token, Parameters *p);

/* What is wrong with the parameters, as a printf format of one value (in *value); NULL: nothing. */
const char *parameter_problem(const Parameters *p, double *value);

#endif
