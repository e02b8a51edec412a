/* The PID of Yang & Özgüner 2019, section 3.4: the MPC's fallback and its rival. State in, state out. */
#ifndef PID_H
#define PID_H

#include "parameters.h"

typedef struct {
    double integral; /* [N]   u_i(k-1) */
    double error;    /* [m/s] e(k-1) */
    double started;  /* 0: there is no e(k-1) yet */
} PidState;

/* v_r clip((gap - d_safe) / d_buffer, 0, 1), figure 3; never more than `limit` [m/s]. */
double pid_reference_speed(const Parameters *p, double gap, double limit);

/* The force u(k) [N]. */
double pid_control(const Parameters *p, PidState *state, double speed, double gap, double limit);

/* While the MPC acts: the integrator stays empty and e(k-1) the present error. So the PID takes over without a
 * kick of its derivative, and without an integral of errors that were not its own. */
void pid_track(const Parameters *p, PidState *state, double speed, double gap, double limit);

#endif
