#include "regulator.h"

#include <stddef.h>

#define STANDSTILL 1e-9 /* [m/s] below it the car stands and the brake's force does no work */

static Decision by_pid(const Parameters *p, const Observation *seen, Memory *memory, Infeasibility why) {
    return (Decision){.force = pid_control(p, &memory->pid, seen->speed, seen->gap, seen->speed_limit),
                      .reference_speed = pid_reference_speed(p, seen->gap, seen->speed_limit),
                      .acting = BY_PID,
                      .infeasibility = why};
}

Decision regulator_decide(const Parameters *p, Mpc *mpc, const Observation *seen, Memory *memory) {
    Decision decision;
    if (mpc == NULL) {
        decision = by_pid(p, seen, memory, PLANNED);
    } else {
        const PlanStart start = {
            .position = seen->position,
            .speed = seen->speed,
            /* At a standstill the force is a brake that holds: a plan may start from none, while c2 would tie it
             * to the braking before and c5 would then have no solution. */
            .previous_force = seen->speed <= STANDSTILL ? 0.0 : memory->previous_force,
            .reference_speed = smaller(p->v_r, seen->speed_limit),
            .obstacle = seen->obstacle};
        double force;
        const Infeasibility why = mpc_plan(mpc, &start, &force);
        if (why == PLANNED) {
            pid_track(p, &memory->pid, seen->speed, seen->gap, seen->speed_limit);
            decision = (Decision){
                .force = force, .reference_speed = start.reference_speed, .acting = BY_MPC, .infeasibility = PLANNED};
        } else {
            decision = by_pid(p, seen, memory, why);
        }
    }
    memory->previous_force = decision.force;
    return decision;
}
