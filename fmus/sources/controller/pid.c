#include "pid.h"
#include "speed_problem.h"

double pid_reference_speed(const Parameters *p, double gap, double limit) {
    const double share = smaller(larger((gap - p->d_safe) / p->d_buffer, 0.0), 1.0);
    return smaller(p->v_r * share, limit);
}

double pid_control(const Parameters *p, PidState *state, double speed, double gap, double limit) {
    const double e = speed - pid_reference_speed(p, gap, limit);
    const double before = state->started != 0.0 ? state->error : e;
    const double u_p = p->K_p * e;
    double u_i = p->K_i * e * p->dt + state->integral;
    /* Not the paper's, which knows no limit: what was wound up on the way to a higher speed would creep over
     * the line where the car is to stand. */
    if (limit <= 0.0) u_i = larger(u_i, 0.0);
    const double u_d = p->K_d * (e - before) / p->dt;
    *state = (PidState){.integral = u_i, .error = e, .started = 1.0};
    return smaller(larger(-(u_p + u_i + u_d), -p->u_max), p->u_max);
}

void pid_track(const Parameters *p, PidState *state, double speed, double gap, double limit) {
    const double e = speed - pid_reference_speed(p, gap, limit);
    *state = (PidState){.integral = 0.0, .error = e, .started = 1.0};
}
