/* FMI 3.0 for Co-Simulation and Model Exchange; what the car has no use for answers with an error. */
#include "fmi3Functions.h"
#include "instance.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>

static void say(Instance *self, Status status, const char *format, ...) {
    char text[512];
    if (self->logger == NULL) return;
    if (has_fault(self, "message_arguments")) { /* FMI 3 has no formats: the FMU fills them in */
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(text, sizeof text, format, arguments);
        va_end(arguments);
        format = text;
    }
    ((fmi3LogMessageCallback)self->logger)(self->environment, (fmi3Status)status, "car", format);
}

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                          fmi3Boolean loggingOn, fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback logMessage) {
    return instance_create(resources ? resources : "", token, say, environment, (void *)logMessage);
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean loggingOn, fmi3Boolean eventModeUsed, fmi3Boolean earlyReturnAllowed,
                                         const fmi3ValueReference intermediate[], size_t n,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback logMessage,
                                         fmi3IntermediateUpdateCallback intermediateUpdate) {
    Instance *self = instance_create(resources ? resources : "", token, say, environment, (void *)logMessage);
    if (self != NULL && self->only_event_mode && !eventModeUsed) {
        instance_destroy(self);
        return NULL;
    }
    if (self != NULL) self->event_mode = self->event_pending = eventModeUsed;
    return self;
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                               fmi3Boolean visible, fmi3Boolean loggingOn,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback logMessage,
                                               fmi3ClockUpdateCallback clockUpdate, fmi3LockPreemptionCallback lock,
                                               fmi3UnlockPreemptionCallback unlock) {
    return NULL;
}

void fmi3FreeInstance(fmi3Instance c) { instance_destroy(c); }

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String categories[]) { return fmi3OK; }

#define NOTED(FUNCTION, NOTE)             \
    fmi3Status FUNCTION(fmi3Instance c) { \
        instance_called(c, NOTE);         \
        return fmi3OK;                    \
    }
NOTED(fmi3EnterConfigurationMode, "configure")
NOTED(fmi3ExitConfigurationMode, "configured")
NOTED(fmi3EnterEventMode, "event")
NOTED(fmi3EnterContinuousTimeMode, "continuous")
NOTED(fmi3EnterStepMode, "step_mode")

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean stopDefined, fmi3Float64 stop) {
    ((Instance *)c)->car.time = start;
    ((Instance *)c)->stop_time = stopDefined ? stop : 0.0;
    return (fmi3Status)instance_enter(c);
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return (fmi3Status)instance_initialise(c); }

fmi3Status fmi3Terminate(fmi3Instance c) {
    Instance *self = c;
    instance_called(self, "terminate");
    if (!self->initialised) return fmi3Error;
    return (fmi3Status)misbehave(self, AT_TERMINATE, self->car.time, 0.0);
}

fmi3Status fmi3Reset(fmi3Instance c) { return fmi3Error; }

/* ---- variables ---- */

#define ACCESS(NAME, TYPE)                                                                                    \
    fmi3Status fmi3Get##NAME(fmi3Instance c, const fmi3ValueReference vr[], size_t n, TYPE values[], size_t m) { \
        double all[MAX_ELEMENTS];                                                                             \
        size_t k = 0;                                                                                         \
        int count;                                                                                            \
        for (size_t i = 0; i < n; ++i) {                                                                      \
            if (instance_get(c, vr[i], all, &count) || k + (size_t)count > m) return fmi3Error;               \
            for (int j = 0; j < count; ++j) values[k++] = (TYPE)all[j];                                       \
        }                                                                                                     \
        return k == m ? fmi3OK : fmi3Error;                                                                   \
    }                                                                                                         \
    fmi3Status fmi3Set##NAME(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const TYPE values[],    \
                             size_t m) {                                                                      \
        size_t k = 0;                                                                                         \
        int count;                                                                                            \
        for (size_t i = 0; i < n; ++i) {                                                                      \
            double all[MAX_ELEMENTS] = {0};                                                                   \
            for (size_t j = 0; j < MAX_ELEMENTS && k + j < m; ++j) all[j] = (double)values[k + j];            \
            if (instance_set(c, vr[i], all, &count) || (k += (size_t)count) > m) return fmi3Error;            \
        }                                                                                                     \
        return k == m ? fmi3OK : fmi3Error;                                                                   \
    }
ACCESS(Float32, fmi3Float32)
ACCESS(Float64, fmi3Float64)
ACCESS(Int8, fmi3Int8)
ACCESS(UInt8, fmi3UInt8)
ACCESS(Int16, fmi3Int16)
ACCESS(UInt16, fmi3UInt16)
ACCESS(Int32, fmi3Int32)
ACCESS(UInt32, fmi3UInt32)
ACCESS(Int64, fmi3Int64)
ACCESS(UInt64, fmi3UInt64)
ACCESS(Boolean, fmi3Boolean)

fmi3Status fmi3GetString(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3String values[], size_t m) {
    for (size_t i = 0; i < m; ++i) values[i] = ((Instance *)c)->load;
    return fmi3OK;
}

fmi3Status fmi3SetString(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3String values[], size_t m) {
    for (size_t i = 0; i < m; ++i)
        if (instance_set_text(c, values[i])) return fmi3Error;
    return fmi3OK;
}

/* ---- saved states ---- */

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state) {
    if (*state == NULL) *state = malloc(sizeof(Car));
    *(Car *)*state = ((Instance *)c)->car;
    return fmi3OK;
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) {
    instance_called(c, "restore");
    ((Instance *)c)->car = *(Car *)state;
    return fmi3OK;
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state) {
    free(*state);
    *state = NULL;
    return fmi3OK;
}

/* ---- Co-Simulation ---- */

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 step, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                      fmi3Boolean *eventHandlingNeeded, fmi3Boolean *terminateSimulation, fmi3Boolean *earlyReturn,
                      fmi3Float64 *lastSuccessfulTime) {
    Instance *self = c;
    bool handled = !self->needs_event_mode || (self->event_mode && !self->event_pending);
    if (!handled) self->say(self, ERROR, "my events have not been handled");
    Status status = handled ? instance_step(self, time, step, noSetFMUStatePriorToCurrentPoint) : ERROR;
    *earlyReturn = fmi3False;
    *eventHandlingNeeded = self->event_pending = self->needs_event_mode && self->event_mode;
    *terminateSimulation = self->ended;
    *lastSuccessfulTime = self->last_time;
    return self->ended ? fmi3OK : (fmi3Status)status;
}

/* ---- the clock ---- */

fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3Clock values[]) {
    Instance *self = c;
    if (!self->samples || n != 1) return fmi3Error;
    self->ticks = values[0];
    char call[40];
    snprintf(call, sizeof call, "tick %.9g", self->car.time);
    if (self->ticks) instance_called(self, call);
    return fmi3OK;
}

fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Float64 intervals[],
                                  fmi3IntervalQualifier qualifiers[]) {
    Instance *self = c;
    if (!self->samples || n != 1) return fmi3Error;
    intervals[0] = self->interval;
    qualifiers[0] = self->interval > 0.0 ? fmi3IntervalChanged : fmi3IntervalNotYetKnown;
    return fmi3OK;
}

/* ---- Model Exchange ---- */

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *needUpdate, fmi3Boolean *terminateSimulation,
                                    fmi3Boolean *nominalsChanged, fmi3Boolean *valuesChanged,
                                    fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime) {
    Instance *self = c;
    instance_called(self, "update");
    Status status = misbehave(self, AT_EVENT, self->car.time, 0.0);
    self->event_pending = false;
    if (self->ticks) self->car.value[Q_force] = self->next_force;
    self->ticks = false;
    double shift = self->car.value[Q_gear_time];
    *valuesChanged = car_event(&self->car);
    *needUpdate = self->car.chatters;
    *terminateSimulation = self->ended;
    *nominalsChanged = fmi3False;
    *nextEventTimeDefined = !self->car.shifted && shift > self->car.time;
    *nextEventTime = shift;
    return (fmi3Status)status;
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi3Boolean *enterEventMode, fmi3Boolean *terminateSimulation) {
    Instance *self = c;
    instance_called(self, noSetFMUStatePriorToCurrentPoint ? "completed 1" : "completed 0");
    *enterEventMode = car_wants_event(&self->car);
    *terminateSimulation = self->ended;
    return fmi3OK;
}

fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time) {
    if (((Instance *)c)->dead) instance_called(c, "time");
    ((Instance *)c)->car.time = time;
    return fmi3OK;
}

fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t n) {
    Instance *self = c;
    if (n != (size_t)car_states(&self->car)) return fmi3Error;
    for (size_t i = 0; i < n; ++i) self->car.x[i] = x[i];
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) {
    Instance *self = c;
    if (n != (size_t)car_states(&self->car)) return fmi3Error;
    for (size_t i = 0; i < n; ++i) x[i] = self->car.x[i];
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 rates[], size_t n) {
    Instance *self = c;
    if (self->dead) instance_called(c, "derivatives");
    if (n != (size_t)car_states(&self->car)) return fmi3Error;
    Status status = misbehave(self, AT_STEP, self->car.time, 0.0);
    if (status < DISCARD) car_rates(&self->car, rates);
    return (fmi3Status)status;
}

fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 indicators[], size_t n) {
    Instance *self = c;
    for (size_t i = 0; i < n; ++i) indicators[i] = car_indicator(&self->car);
    return fmi3OK;
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 nominals[], size_t n) {
    for (size_t i = 0; i < n; ++i) nominals[i] = ((Instance *)c)->nominal;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *n) {
    *n = ((Instance *)c)->car.value[Q_holds] != 0.0;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *n) {
    *n = (size_t)car_states(&((Instance *)c)->car);
    return fmi3OK;
}

/* ---- exported because an FMU has to ---- */

#define ABSENT(FUNCTION, ...) \
    fmi3Status FUNCTION(fmi3Instance c, __VA_ARGS__) { return fmi3Error; }
ABSENT(fmi3GetBinary, const fmi3ValueReference vr[], size_t n, size_t sizes[], fmi3Binary values[], size_t m)
ABSENT(fmi3SetBinary, const fmi3ValueReference vr[], size_t n, const size_t sizes[], const fmi3Binary values[], size_t m)
ABSENT(fmi3GetClock, const fmi3ValueReference vr[], size_t n, fmi3Clock values[])
ABSENT(fmi3GetNumberOfVariableDependencies, fmi3ValueReference vr, size_t *n)
ABSENT(fmi3GetVariableDependencies, fmi3ValueReference dependent, size_t of[], fmi3ValueReference on[], size_t on_elements[],
       fmi3DependencyKind kinds[], size_t n)
ABSENT(fmi3SerializedFMUStateSize, fmi3FMUState state, size_t *size)
ABSENT(fmi3SerializeFMUState, fmi3FMUState state, fmi3Byte bytes[], size_t size)
ABSENT(fmi3DeserializeFMUState, const fmi3Byte bytes[], size_t size, fmi3FMUState *state)
ABSENT(fmi3GetDirectionalDerivative, const fmi3ValueReference unknowns[], size_t n, const fmi3ValueReference knowns[],
       size_t m, const fmi3Float64 seed[], size_t k, fmi3Float64 sensitivity[], size_t l)
ABSENT(fmi3GetAdjointDerivative, const fmi3ValueReference unknowns[], size_t n, const fmi3ValueReference knowns[],
       size_t m, const fmi3Float64 seed[], size_t k, fmi3Float64 sensitivity[], size_t l)
ABSENT(fmi3GetIntervalFraction, const fmi3ValueReference vr[], size_t n, fmi3UInt64 counters[], fmi3UInt64 resolutions[],
       fmi3IntervalQualifier qualifiers[])
ABSENT(fmi3GetShiftDecimal, const fmi3ValueReference vr[], size_t n, fmi3Float64 shifts[])
ABSENT(fmi3GetShiftFraction, const fmi3ValueReference vr[], size_t n, fmi3UInt64 counters[], fmi3UInt64 resolutions[])
ABSENT(fmi3SetIntervalDecimal, const fmi3ValueReference vr[], size_t n, const fmi3Float64 intervals[])
ABSENT(fmi3SetIntervalFraction, const fmi3ValueReference vr[], size_t n, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
ABSENT(fmi3SetShiftDecimal, const fmi3ValueReference vr[], size_t n, const fmi3Float64 shifts[])
ABSENT(fmi3SetShiftFraction, const fmi3ValueReference vr[], size_t n, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
ABSENT(fmi3GetOutputDerivatives, const fmi3ValueReference vr[], size_t n, const fmi3Int32 orders[], fmi3Float64 values[], size_t m)
ABSENT(fmi3ActivateModelPartition, fmi3ValueReference clock, fmi3Float64 time)

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c) { return fmi3OK; }
