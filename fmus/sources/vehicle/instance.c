#include "instance.h"
#include "token.h" /* MODEL_TOKEN: written by the build, the same as in modelDescription.xml */

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SERIALIZED_FORMAT 20190501.0 /* the first value of a serialised state */
#define SERIALIZED_VALUES 14

/* ---- creation and messages ---- */

bool instance_create(Instance *self, const char *name, const char *token, bool debug) {
    self->debug = debug;
    self->now.parameters = PLANT_DEFAULTS;
    self->now.phase = CREATED;
    self->now.stop_time = HUGE_VAL;
    const char *shown = name != NULL && *name != '\0' ? name : MODEL_NAME;
    self->name = calloc(strlen(shown) + 1, 1);
    if (self->name == NULL) return false;
    strcpy(self->name, shown);
    if (token == NULL || strcmp(token, MODEL_TOKEN) != 0) {
        instance_error(self, "GUID or instantiation token %s: expected %s; the model description is of another build",
                       token != NULL ? token : "(none)", MODEL_TOKEN);
        return false;
    }
    return true;
}

void instance_destroy(Instance *self) {
    if (self != NULL) free(self->name);
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

static const char *phase_name(Phase phase) {
    switch (phase) {
    case CREATED: return "instantiated";
    case INITIALISING: return "in initialization mode";
    case STEPPING: return "in step mode";
    default: return "terminated";
    }
}

Status instance_require(const Instance *self, const char *function, int phases) {
    if (self->now.phase & phases) return STATUS_OK;
    return instance_error(self, "%s: not allowed while %s", function, phase_name(self->now.phase));
}

/* ---- variables ---- */

/* Before the first step the state follows the parameters, which may still change. */
static PlantState current_state(const Instance *self) {
    if (self->now.phase & (CREATED | INITIALISING)) return plant_initial_state(&self->now.parameters);
    return self->now.state;
}

Status instance_get_real(const Instance *self, unsigned reference, double *value) {
    switch (reference) {
    case TIME: *value = self->now.time; return STATUS_OK;
    case FORCE: *value = self->now.force; return STATUS_OK;
    case POSITION: *value = current_state(self).position; return STATUS_OK;
    case SPEED: *value = current_state(self).speed; return STATUS_OK;
    case ACCELERATION: *value = current_state(self).acceleration; return STATUS_OK;
    case PARAMETER_M: *value = self->now.parameters.M; return STATUS_OK;
    case PARAMETER_ALPHA: *value = self->now.parameters.alpha; return STATUS_OK;
    case PARAMETER_S0: *value = self->now.parameters.s0; return STATUS_OK;
    case PARAMETER_V0: *value = self->now.parameters.v0; return STATUS_OK;
    default: return instance_error(self, "value reference %u: no such real variable", reference);
    }
}

Status instance_set_real(Instance *self, unsigned reference, double value) {
    if (!isfinite(value)) return instance_error(self, "value reference %u = %g: expected a finite number", reference, value);
    if (reference == FORCE) {
        if (instance_require(self, "set force", CREATED | INITIALISING | STEPPING)) return STATUS_ERROR;
        self->now.force = value;
        return STATUS_OK;
    }
    double *parameter;
    switch (reference) {
    case PARAMETER_M: parameter = &self->now.parameters.M; break;
    case PARAMETER_ALPHA: parameter = &self->now.parameters.alpha; break;
    case PARAMETER_S0: parameter = &self->now.parameters.s0; break;
    case PARAMETER_V0: parameter = &self->now.parameters.v0; break;
    default: return instance_error(self, "value reference %u: no real variable that can be set", reference);
    }
    if (instance_require(self, "set a fixed parameter", CREATED | INITIALISING)) return STATUS_ERROR;
    *parameter = value;
    return STATUS_OK;
}

Status instance_get_boolean(const Instance *self, unsigned reference, bool *value) {
    switch (reference) {
    case PARAMETER_EXACT: *value = self->now.parameters.exact; return STATUS_OK;
    case PARAMETER_REVERSE: *value = self->now.parameters.reverse; return STATUS_OK;
    default: return instance_error(self, "value reference %u: no such boolean variable", reference);
    }
}

Status instance_set_boolean(Instance *self, unsigned reference, bool value) {
    if (reference != PARAMETER_EXACT && reference != PARAMETER_REVERSE)
        return instance_error(self, "value reference %u: no boolean variable that can be set", reference);
    if (instance_require(self, "set a fixed parameter", CREATED | INITIALISING)) return STATUS_ERROR;
    *(reference == PARAMETER_EXACT ? &self->now.parameters.exact : &self->now.parameters.reverse) = value;
    return STATUS_OK;
}

/* ---- life cycle ---- */

Status instance_set_experiment(Instance *self, double start, double stop) {
    if (!isfinite(start)) return instance_error(self, "start time %g s: expected a finite number", start);
    if (!(stop >= start)) return instance_error(self, "stop time %g s: expected %g s or later", stop, start);
    self->now.time = start;
    self->now.stop_time = stop;
    return STATUS_OK;
}

Status instance_enter_initialisation(Instance *self) {
    self->now.phase = INITIALISING;
    return STATUS_OK;
}

Status instance_exit_initialisation(Instance *self) {
    double value;
    const char *problem = plant_parameter_problem(&self->now.parameters, &value);
    if (problem != NULL) return instance_error(self, problem, value);
    self->now.state = plant_initial_state(&self->now.parameters);
    self->now.phase = STEPPING;
    self->discretisation.dt = 0.0; /* of no step yet */
    trace(self, "initialised at %g s: M = %g kg, alpha = %g N.s/m", self->now.time, self->now.parameters.M,
          self->now.parameters.alpha);
    return STATUS_OK;
}

Status instance_step(Instance *self, const char *function, double time, double dt) {
    if (instance_require(self, function, STEPPING)) return STATUS_ERROR;
    if (!(dt > 0.0 && isfinite(dt))) return instance_error(self, "%s: step of %g s: expected more than 0", function, dt);
    /* The host's t_k = k h and our t_(k-1) + h may differ by rounding, not by a noticeable part of a step. */
    if (!(fabs(time - self->now.time) <= 1e-3 * dt))
        return instance_error(self, "%s: from %.9g s, but the vehicle is at %.9g s", function, time, self->now.time);
    if (time + dt > self->now.stop_time + 1e-3 * dt)
        return instance_error(self, "%s: to %.9g s, beyond the stop time of %.9g s", function, time + dt, self->now.stop_time);
    if (dt != self->discretisation.dt) self->discretisation = plant_discretise(&self->now.parameters, dt);
    const PlantState next = plant_step(&self->now.parameters, &self->discretisation, self->now.state, self->now.force);
    if (!isfinite(next.position) || !isfinite(next.speed) || !isfinite(next.acceleration))
        return instance_error(self, "%s: force %g N at %.9g s: the motion leaves the range of numbers", function,
                              self->now.force, time);
    self->now.state = next;
    self->now.time = time + dt;
    return STATUS_OK;
}

Status instance_terminate(Instance *self, const char *function) {
    if (instance_require(self, function, STEPPING)) return STATUS_ERROR;
    self->now.phase = TERMINATED;
    return STATUS_OK;
}

Status instance_reset(Instance *self, const char *function) {
    trace(self, "%s", function);
    self->now = (Snapshot){.phase = CREATED, .parameters = PLANT_DEFAULTS, .stop_time = HUGE_VAL};
    return STATUS_OK;
}

/* ---- saved states ---- */

Status instance_save(const Instance *self, Snapshot **saved) {
    if (*saved == NULL) *saved = malloc(sizeof **saved);
    if (*saved == NULL) return instance_error(self, "out of memory for a saved state");
    **saved = self->now;
    return STATUS_OK;
}

Status instance_restore(Instance *self, const Snapshot *saved) {
    if (saved == NULL) return instance_error(self, "no saved state to restore");
    self->now = *saved;
    self->discretisation.dt = 0.0; /* the parameters may differ */
    return STATUS_OK;
}

size_t snapshot_size(void) { return SERIALIZED_VALUES * sizeof(double); }

Status snapshot_serialize(const Instance *self, const Snapshot *s, void *bytes, size_t size) {
    if (s == NULL) return instance_error(self, "no saved state to serialise");
    const PlantParameters *p = &s->parameters;
    const double values[SERIALIZED_VALUES] = {
        SERIALIZED_FORMAT, s->phase, p->M, p->alpha, p->s0, p->v0, p->exact, p->reverse,
        s->state.position, s->state.speed, s->state.acceleration, s->force, s->time, s->stop_time};
    if (size < sizeof values) return instance_error(self, "buffer of %zu bytes: expected %zu", size, sizeof values);
    memcpy(bytes, values, sizeof values);
    return STATUS_OK;
}

Status snapshot_deserialize(const Instance *self, const void *bytes, size_t size, Snapshot **saved) {
    double v[SERIALIZED_VALUES];
    if (bytes == NULL || size != sizeof v)
        return instance_error(self, "serialised state of %zu bytes: expected %zu", size, sizeof v);
    memcpy(v, bytes, sizeof v);
    const bool phase = v[1] == CREATED || v[1] == INITIALISING || v[1] == STEPPING || v[1] == TERMINATED;
    if (v[0] != SERIALIZED_FORMAT || !phase) return instance_error(self, "serialised state: not one of this model");
    if (*saved == NULL) *saved = malloc(sizeof **saved);
    if (*saved == NULL) return instance_error(self, "out of memory for a saved state");
    **saved = (Snapshot){
        .phase = (Phase)(int)v[1],
        .parameters = {.M = v[2], .alpha = v[3], .s0 = v[4], .v0 = v[5], .exact = v[6] != 0.0, .reverse = v[7] != 0.0},
        .state = {.position = v[8], .speed = v[9], .acceleration = v[10]},
        .force = v[11],
        .time = v[12],
        .stop_time = v[13]};
    return STATUS_OK;
}
