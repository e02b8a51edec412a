/* FMI 2.0 for Co-Simulation and Model Exchange. */
#include "fmi2Functions.h"
#include "instance.h"

#include <stdlib.h>

/* The message is a printf format: the arguments are those of the fault message_arguments. */
static void say(Instance *self, Status status, const char *format, ...) {
    if (self->logger == NULL) return;
    ((fmi2CallbackLogger)self->logger)(self->environment, "car", (fmi2Status)status, "car", format, "axle", 3, 99.5);
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String location,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean loggingOn) {
    return instance_create(path_of(location), guid, say, functions->componentEnvironment, (void *)functions->logger);
}

void fmi2FreeInstance(fmi2Component c) { instance_destroy(c); }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[]) { return fmi2OK; }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean stopDefined, fmi2Real stop) {
    instance_called(c, "setup");
    ((Instance *)c)->car.time = start;
    ((Instance *)c)->stop_time = stopDefined ? stop : 0.0;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return (fmi2Status)instance_enter(c); }

fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return (fmi2Status)instance_initialise(c); }

fmi2Status fmi2Terminate(fmi2Component c) {
    Instance *self = c;
    instance_called(self, "terminate");
    if (!self->initialised) return fmi2Error;
    return (fmi2Status)misbehave(self, AT_TERMINATE, self->car.time, 0.0);
}

fmi2Status fmi2Reset(fmi2Component c) { return fmi2Error; }

/* ---- variables ---- */

#define ACCESS(NAME, TYPE)                                                                             \
    fmi2Status fmi2Get##NAME(fmi2Component c, const fmi2ValueReference vr[], size_t n, TYPE value[]) { \
        double all[MAX_ELEMENTS];                                                                      \
        int count;                                                                                     \
        for (size_t i = 0; i < n; ++i) {                                                               \
            if (instance_get(c, vr[i], all, &count)) return fmi2Error;                                 \
            value[i] = (TYPE)all[0];                                                                   \
        }                                                                                              \
        return fmi2OK;                                                                                 \
    }                                                                                                  \
    fmi2Status fmi2Set##NAME(fmi2Component c, const fmi2ValueReference vr[], size_t n, const TYPE value[]) { \
        int count;                                                                                     \
        for (size_t i = 0; i < n; ++i) {                                                               \
            double one = (double)value[i];                                                             \
            if (instance_set(c, vr[i], &one, &count)) return fmi2Error;                                \
        }                                                                                              \
        return fmi2OK;                                                                                 \
    }
ACCESS(Real, fmi2Real)
ACCESS(Integer, fmi2Integer)
ACCESS(Boolean, fmi2Boolean)

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2String value[]) {
    for (size_t i = 0; i < n; ++i) value[i] = ((Instance *)c)->load;
    return fmi2OK;
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2String value[]) {
    for (size_t i = 0; i < n; ++i)
        if (instance_set_text(c, value[i])) return fmi2Error;
    return fmi2OK;
}

/* ---- saved states ---- */

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
    if (*state == NULL) *state = malloc(sizeof(Car));
    *(Car *)*state = ((Instance *)c)->car;
    return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
    instance_called(c, "restore");
    ((Instance *)c)->car = *(Car *)state;
    return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
    free(*state);
    *state = NULL;
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) { return fmi2Error; }

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) { return fmi2Error; }

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) { return fmi2Error; }

/* ---- Co-Simulation ---- */

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean noSetFMUStatePriorToCurrentPoint) {
    return (fmi2Status)instance_step(c, time, step, noSetFMUStatePriorToCurrentPoint);
}

fmi2Status fmi2CancelStep(fmi2Component c) { return fmi2Error; }

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value) {
    if (kind != fmi2DoStepStatus) return fmi2Discard;
    *value = fmi2Pending;
    return fmi2OK;
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
    if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
    *value = ((Instance *)c)->last_time;
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) {
    if (kind != fmi2Terminated) return fmi2Discard;
    *value = ((Instance *)c)->ended;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value) { return fmi2Discard; }

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value) { return fmi2Discard; }

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    return fmi2Error;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                        const fmi2Integer order[], fmi2Real value[]) {
    return fmi2Error;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,
                                        const fmi2ValueReference known[], size_t knowns, const fmi2Real dKnown[],
                                        fmi2Real dUnknown[]) {
    return fmi2Error;
}

/* ---- Model Exchange ---- */

fmi2Status fmi2EnterEventMode(fmi2Component c) {
    instance_called(c, "event");
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
    Instance *self = c;
    instance_called(self, "update");
    Status status = misbehave(self, AT_EVENT, self->car.time, 0.0);
    double shift = self->car.value[Q_gear_time];
    info->valuesOfContinuousStatesChanged = car_event(&self->car);
    info->newDiscreteStatesNeeded = self->car.chatters;
    info->terminateSimulation = self->ended;
    info->nominalsOfContinuousStatesChanged = fmi2False;
    info->nextEventTimeDefined = !self->car.shifted && shift > self->car.time;
    info->nextEventTime = shift;
    return (fmi2Status)status;
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) {
    instance_called(c, "continuous");
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi2Boolean *enterEventMode, fmi2Boolean *terminateSimulation) {
    Instance *self = c;
    instance_called(self, noSetFMUStatePriorToCurrentPoint ? "completed 1" : "completed 0");
    *enterEventMode = car_wants_event(&self->car);
    *terminateSimulation = self->ended;
    return fmi2OK;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
    if (((Instance *)c)->dead) instance_called(c, "time");
    ((Instance *)c)->car.time = time;
    return fmi2OK;
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n) {
    Instance *self = c;
    if (n != (size_t)car_states(&self->car)) return fmi2Error;
    for (size_t i = 0; i < n; ++i) self->car.x[i] = x[i];
    return fmi2OK;
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n) {
    Instance *self = c;
    if (n != (size_t)car_states(&self->car)) return fmi2Error;
    for (size_t i = 0; i < n; ++i) x[i] = self->car.x[i];
    return fmi2OK;
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real rates[], size_t n) {
    Instance *self = c;
    if (self->dead) instance_called(c, "derivatives");
    if (n != (size_t)car_states(&self->car)) return fmi2Error;
    Status status = misbehave(self, AT_STEP, self->car.time, 0.0);
    if (status < DISCARD) car_rates(&self->car, rates);
    return (fmi2Status)status;
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real indicators[], size_t n) {
    Instance *self = c;
    for (size_t i = 0; i < n; ++i) indicators[i] = car_indicator(&self->car);
    return fmi2OK;
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real nominals[], size_t n) {
    for (size_t i = 0; i < n; ++i) nominals[i] = ((Instance *)c)->nominal;
    return fmi2OK;
}
