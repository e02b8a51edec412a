/* The variables by their value references. */
#include "instance.h"

#include <math.h>

static double *parameter(Snapshot *s, unsigned reference) {
    return (double *)&s->parameters + (reference - PARAMETER_M);
}

static bool is_real_parameter(unsigned reference) { return reference >= PARAMETER_M && reference < PARAMETER_N; }

static double *input(Snapshot *s, unsigned reference) {
    switch (reference) {
    case SPEED: return &s->seen.speed;
    case POSITION: return &s->seen.position;
    case GAP: return &s->seen.gap;
    case SPEED_LIMIT: return &s->seen.speed_limit;
    default: return reference >= OBSTACLE && reference < OBSTACLE_END ? &s->seen.obstacle[reference - OBSTACLE] : NULL;
    }
}

static const char *input_name(unsigned reference) {
    switch (reference) {
    case SPEED: return "speed";
    case POSITION: return "position";
    case GAP: return "gap";
    case SPEED_LIMIT: return "speed_limit";
    default: return "obstacle_position";
    }
}

static Status require_decision(Instance *self) {
    if (self->now.stage == OPEN && self->now.phase & (INITIALISING | STEPPING)) return instance_decide(self);
    return STATUS_OK;
}

Status instance_get_real(Instance *self, unsigned reference, double *value) {
    if (reference == TIME) {
        *value = self->now.time;
    } else if (reference == FORCE || reference == REFERENCE_SPEED) {
        if (require_decision(self)) return STATUS_ERROR;
        *value = reference == FORCE ? self->now.decision.force : self->now.decision.reference_speed;
    } else if (is_real_parameter(reference)) {
        *value = *parameter(&self->now, reference);
    } else {
        const double *const place = input(&self->now, reference);
        if (place == NULL) return instance_error(self, "value reference %u: no such real variable", reference);
        *value = *place;
    }
    return STATUS_OK;
}

Status instance_set_real(Instance *self, unsigned reference, double value) {
    double *place = input(&self->now, reference);
    if (place != NULL) {
        if (instance_require(self, "set inputs", CREATED | INITIALISING | STEPPING)) return STATUS_ERROR;
        /* Obstacles and limits may be infinitely far. */
        const bool usable = reference == SPEED || reference == POSITION ? isfinite(value) : !isnan(value);
        if (!usable) return instance_error(self, "%s = %g: expected a number", input_name(reference), value);
    } else if (is_real_parameter(reference)) {
        place = parameter(&self->now, reference);
        if (instance_require(self, "set a fixed parameter", CREATED | INITIALISING)) return STATUS_ERROR;
        if (!isfinite(value))
            return instance_error(self, "value reference %u = %g: expected a finite number", reference, value);
    } else {
        return instance_error(self, "value reference %u: no real variable that can be set", reference);
    }
    *place = value;
    snapshot_reopen(&self->now);
    return STATUS_OK;
}

Status instance_get_integer(Instance *self, unsigned reference, int *value) {
    if (reference == PARAMETER_N) {
        *value = (int)self->now.parameters.N;
        return STATUS_OK;
    }
    if (reference != ACTING && reference != INFEASIBILITY)
        return instance_error(self, "value reference %u: no such integer variable", reference);
    if (require_decision(self)) return STATUS_ERROR;
    *value = reference == ACTING ? (int)self->now.decision.acting : (int)self->now.decision.infeasibility;
    return STATUS_OK;
}

Status instance_set_horizon(Instance *self, unsigned reference, double value, int phases) {
    if (reference != PARAMETER_N)
        return instance_error(self, "value reference %u: no integer variable that can be set", reference);
    if (instance_require(self, "set the horizon", phases)) return STATUS_ERROR;
    if (!(value >= HORIZON_MIN && value <= HORIZON_MAX))
        return instance_error(self, "N = %g: expected a whole number from 2 to 200", value);
    self->now.parameters.N = value;
    snapshot_reopen(&self->now);
    return STATUS_OK;
}

Status instance_get_boolean(Instance *self, unsigned reference, bool *value) {
    if (reference == PARAMETER_MPC) {
        *value = self->now.parameters.mpc != 0.0;
        return STATUS_OK;
    }
    if (reference != FEASIBLE) return instance_error(self, "value reference %u: no such boolean variable", reference);
    if (require_decision(self)) return STATUS_ERROR;
    *value = self->now.decision.acting == BY_MPC;
    return STATUS_OK;
}

Status instance_set_boolean(Instance *self, unsigned reference, bool value) {
    if (reference != PARAMETER_MPC)
        return instance_error(self, "value reference %u: no boolean variable that can be set", reference);
    if (instance_require(self, "set a fixed parameter", CREATED | INITIALISING)) return STATUS_ERROR;
    self->now.parameters.mpc = value ? 1.0 : 0.0;
    snapshot_reopen(&self->now);
    return STATUS_OK;
}
