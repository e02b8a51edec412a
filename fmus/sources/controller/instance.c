#include "instance.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FAR_AWAY 1e9  /* start value of gap, speed_limit and obstacle_position: nobody, no limit */
#define ROUNDING 1e-3 /* part of a step by which the host's t_k may differ from ours */

/* ---- creation and messages ---- */

static Snapshot fresh(const Parameters *p) {
    Snapshot s;
    memset(&s, 0, sizeof s);
    s.phase = CREATED;
    s.stage = HELD;
    s.parameters = *p;
    s.seen.gap = s.seen.speed_limit = FAR_AWAY;
    for (int i = 0; i < HORIZON_MAX; ++i) s.seen.obstacle[i] = FAR_AWAY;
    s.stop_time = HUGE_VAL;
    return s;
}

bool instance_create(Instance *self, const char *name, const char *token, bool debug) {
    self->debug = debug;
    const char *shown = name != NULL && *name != '\0' ? name : MODEL_NAME;
    self->name = calloc(strlen(shown) + 1, 1);
    if (self->name == NULL) return false;
    strcpy(self->name, shown);
    if (!parameters_from_token(token, &self->start)) {
        instance_error(self, "GUID or instantiation token %.100s: not of this build; the model description and the "
                       "binary are of different exports", token != NULL ? token : "(none)");
        return false;
    }
    self->now = fresh(&self->start);
    return true;
}

void instance_destroy(Instance *self) {
    if (self != NULL) {
        free(self->mpc);
        free(self->name);
    }
    free(self);
}

static void report(const Instance *self, Status status, const char *category, const char *format, va_list values) {
    char message[MESSAGE_SIZE];
    vsnprintf(message, sizeof message, format, values);
    self->write(self, status, category, message);
}

Status instance_error(const Instance *self, const char *format, ...) {
    va_list values;
    va_start(values, format);
    report(self, STATUS_ERROR, "logStatusError", format, values);
    va_end(values);
    return STATUS_ERROR;
}

static void trace(const Instance *self, const char *format, ...) {
    if (!self->debug) return;
    va_list values;
    va_start(values, format);
    report(self, STATUS_OK, "logEvents", format, values);
    va_end(values);
}

static const char *phase_name(int phase) {
    switch (phase) {
    case CREATED: return "instantiated";
    case CONFIGURING: return "in configuration mode";
    case INITIALISING: return "in initialization mode";
    case STEPPING: return "in step mode";
    default: return "terminated";
    }
}

Status instance_require(const Instance *self, const char *function, int phases) {
    if (self->now.phase & phases) return STATUS_OK;
    return instance_error(self, "%s: not allowed while %s", function, phase_name(self->now.phase));
}

/* ---- deciding ---- */

static const char *reason(Infeasibility why) {
    switch (why) {
    case PLANNED: return "it drives alone";
    case TOO_CLOSE: return "no plan: the obstacle will be nearer than d_safe";
    case SPEED_BOUNDS_CROSS: return "no plan: the force limits allow no speed within its bounds";
    case CANNOT_STOP: return "no plan: not even the hardest braking keeps d_safe";
    case CANNOT_HOLD_SPEED: return "no plan: not even the strongest drive holds v_min";
    case NO_PLAN_EXISTS: return "no plan keeps all constraints";
    default: return "no plan that keeps all constraints was found";
    }
}

static Status check_parameters(const Instance *self) {
    double value;
    const char *problem = parameter_problem(&self->now.parameters, &value);
    return problem == NULL ? STATUS_OK : instance_error(self, problem, value);
}

/* The room for plans fits the parameters; none is needed where the PID drives alone. */
static Status prepare(Instance *self) {
    const Parameters *const p = &self->now.parameters;
    const bool fits = self->mpc != NULL && memcmp(&self->mpc->problem.p, p, sizeof *p) == 0;
    if (fits || p->mpc == 0.0) return STATUS_OK;
    if (check_parameters(self)) return STATUS_ERROR;
    free(self->mpc);
    self->mpc = mpc_create(p);
    return self->mpc != NULL ? STATUS_OK : instance_error(self, "out of memory for a horizon of %g steps", p->N);
}

Status instance_decide(Instance *self) {
    if (prepare(self)) return STATUS_ERROR;
    Snapshot *const now = &self->now;
    Mpc *const mpc = now->parameters.mpc != 0.0 ? self->mpc : NULL;
    now->afterwards = now->memory;
    now->decision = regulator_decide(&now->parameters, mpc, &now->seen, &now->afterwards);
    now->stage = DECIDED;
    if (isfinite(now->decision.force)) return STATUS_OK;
    now->stage = OPEN;
    return instance_error(self, "speed %g m/s, gap %g m: the force leaves the range of numbers", now->seen.speed,
                          now->seen.gap);
}

/* From now on the decision counts. */
static void commit(Instance *self) {
    Snapshot *const now = &self->now;
    const Decision *const d = &now->decision;
    const bool handed_over = d->acting != now->acted;
    now->memory = now->afterwards;
    now->stage = HELD;
    now->decisions += 1.0;
    now->acted = d->acting;
    if (!handed_over) return;
    if (d->acting == BY_MPC)
        trace(self, "at %.9g s: the MPC acts", now->time);
    else
        trace(self, "at %.9g s: the PID acts; %s", now->time, reason(d->infeasibility));
}

static double next_decision(const Snapshot *s) { return s->start_time + s->decisions * s->parameters.dt; }

void snapshot_reopen(Snapshot *s) {
    const bool due = fabs(s->time - next_decision(s)) <= ROUNDING * s->parameters.dt;
    if (s->phase != STEPPING || due) s->stage = OPEN;
}

/* ---- life cycle ---- */

Status instance_set_experiment(Instance *self, double start, double stop) {
    if (!isfinite(start)) return instance_error(self, "start time %g s: expected a finite number", start);
    if (!(stop >= start)) return instance_error(self, "stop time %g s: expected %g s or later", stop, start);
    self->now.start_time = self->now.time = start;
    self->now.stop_time = stop;
    return STATUS_OK;
}

Status instance_enter(Instance *self, Phase phase) {
    self->now.phase = phase;
    if (phase == INITIALISING) self->now.stage = OPEN;
    return STATUS_OK;
}

Status instance_exit_initialisation(Instance *self) {
    if (check_parameters(self) || prepare(self)) return STATUS_ERROR;
    self->now.phase = STEPPING;
    const Parameters *const p = &self->now.parameters;
    trace(self, "initialised at %g s: %s, dt = %g s, N = %g", self->now.time, p->mpc != 0.0 ? "MPC with PID" : "PID",
          p->dt, p->N);
    return STATUS_OK;
}

Status instance_step(Instance *self, const char *function, double time, double step) {
    if (instance_require(self, function, STEPPING)) return STATUS_ERROR;
    Snapshot *const now = &self->now;
    const double dt = now->parameters.dt, end = time + step;
    if (!(step > 0.0 && isfinite(step)))
        return instance_error(self, "%s: step of %g s: expected more than 0", function, step);
    if (!(fabs(time - now->time) <= ROUNDING * step))
        return instance_error(self, "%s: from %.9g s, but the controller is at %.9g s", function, time, now->time);
    if (end > now->stop_time + ROUNDING * step)
        return instance_error(self, "%s: to %.9g s, beyond the stop time of %.9g s", function, end, now->stop_time);
    const bool due = fabs(time - next_decision(now)) <= ROUNDING * dt;
    const double next = due ? next_decision(now) + dt : next_decision(now);
    if (end > next + ROUNDING * dt)
        return instance_error(self,
                              "%s: to %.9g s, past the decision that is due at %.9g s; expected steps of dt = %g s or "
                              "a whole fraction of it (or another value of the parameter dt)",
                              function, end, next, dt);
    if (due) {
        if (now->stage != DECIDED && instance_decide(self)) return STATUS_ERROR;
        commit(self);
    }
    now->time = end;
    return STATUS_OK;
}

Status instance_terminate(Instance *self, const char *function) {
    if (instance_require(self, function, STEPPING)) return STATUS_ERROR;
    self->now.phase = TERMINATED;
    return STATUS_OK;
}

Status instance_reset(Instance *self, const char *function) {
    trace(self, "%s", function);
    self->now = fresh(&self->start);
    return STATUS_OK;
}
