/* Who drives: the MPC where it has a plan, else the PID (Yang & Özgüner 2019, algorithm 1). State in, state out. */
#ifndef REGULATOR_H
#define REGULATOR_H

#include "mpc.h"
#include "pid.h"

/* What is seen at t_k; far away or without limit where there is nobody or none. */
typedef struct {
    double speed;                 /* [m/s] */
    double position;              /* [m]   of the point that keeps the distance */
    double gap;                   /* [m]   to the closest obstacle in front now */
    double speed_limit;           /* [m/s] caps the reference speed of both */
    double obstacle[HORIZON_MAX]; /* [m]   the first N: x_p(k+1) ... x_p(k+N) */
} Observation;

typedef enum { NOBODY, BY_MPC, BY_PID } Acting;

typedef struct {
    double force;           /* [N]   u(k) */
    double reference_speed; /* [m/s] of who acts */
    Acting acting;
    Infeasibility infeasibility; /* PLANNED also where the PID drives alone */
} Decision;

/* What one decision leaves to the next. */
typedef struct {
    PidState pid;
    double previous_force; /* [N] u(k-1) */
} Memory;

/* Decide at t_k. `mpc` is of the same parameters, NULL where the PID drives alone. */
Decision regulator_decide(const Parameters *p, Mpc *mpc, const Observation *seen, Memory *memory);

#endif
