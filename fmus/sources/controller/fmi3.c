/* FMI 3.0 for Co-Simulation on top of instance.h. */
#include "fmi3_begin.h"

/* ---- life cycle ---- */

fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance) {
    REQUIRE(instance, "fmi3EnterConfigurationMode", CREATED);
    return (fmi3Status)instance_enter(instance, CONFIGURING);
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance) {
    REQUIRE(instance, "fmi3ExitConfigurationMode", CONFIGURING);
    return (fmi3Status)instance_enter(instance, CREATED);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
                                       fmi3Float64 startTime, fmi3Boolean stopTimeDefined, fmi3Float64 stopTime) {
    REQUIRE(instance, "fmi3EnterInitializationMode", CREATED);
    if (instance_set_experiment(instance, startTime, stopTimeDefined ? stopTime : HUGE_VAL)) return fmi3Error;
    return (fmi3Status)instance_enter(instance, INITIALISING);
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) {
    REQUIRE(instance, "fmi3ExitInitializationMode", INITIALISING);
    return (fmi3Status)instance_exit_initialisation(instance);
}

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 currentCommunicationPoint, fmi3Float64 communicationStepSize,
                      fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *eventHandlingNeeded,
                      fmi3Boolean *terminateSimulation, fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime) {
    if (instance == NULL) return fmi3Error;
    const Status status = instance_step(instance, "fmi3DoStep", currentCommunicationPoint, communicationStepSize);
    *eventHandlingNeeded = fmi3False;
    *terminateSimulation = fmi3False;
    *earlyReturn = fmi3False;
    *lastSuccessfulTime = ((Instance *)instance)->now.time;
    return (fmi3Status)status;
}

fmi3Status fmi3Terminate(fmi3Instance instance) {
    return instance == NULL ? fmi3Error : (fmi3Status)instance_terminate(instance, "fmi3Terminate");
}

fmi3Status fmi3Reset(fmi3Instance instance) {
    return instance == NULL ? fmi3Error : (fmi3Status)instance_reset(instance, "fmi3Reset");
}

/* ---- variables: scalars, and the array of N predicted positions ---- */

static size_t size_of(const Instance *self, fmi3ValueReference reference) {
    return reference == OBSTACLE ? (size_t)self->now.parameters.N : 1;
}

/* Whether the values of these variables are as many as the host says. */
static bool sizes_agree(const Instance *self, const char *function, const fmi3ValueReference references[], size_t count,
                        size_t values) {
    size_t expected = 0;
    for (size_t i = 0; i < count; ++i) expected += size_of(self, references[i]);
    if (values == expected) return true;
    instance_error(self, "%s: %zu values for %zu variables: expected %zu", function, values, count, expected);
    return false;
}

#define ARGUMENTS(VALUE) \
    fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences, VALUE values[], size_t nValues

#define TRANSFER(NAME, VALUE, CALL)                                                                              \
    fmi3Status NAME(ARGUMENTS(VALUE)) {                                                                          \
        if (instance == NULL) return fmi3Error;                                                                  \
        if (!sizes_agree(instance, #NAME, valueReferences, nValueReferences, nValues)) return fmi3Error;         \
        for (size_t i = 0, k = 0; i < nValueReferences; ++i)                                                     \
            for (fmi3ValueReference j = 0; j < size_of(instance, valueReferences[i]); ++j, ++k)                  \
                if (CALL(instance, valueReferences[i] + j, values + k)) return fmi3Error;                        \
        return fmi3OK;                                                                                           \
    }

static Status set_real(Instance *self, unsigned reference, const double *value) {
    return instance_set_real(self, reference, *value);
}

static Status get_int32(Instance *self, unsigned reference, fmi3Int32 *value) {
    int whole = 0;
    if (reference == PARAMETER_N) return instance_error(self, "value reference %u: the horizon is a UInt64", reference);
    const Status status = instance_get_integer(self, reference, &whole);
    *value = whole;
    return status;
}

static Status get_uint64(Instance *self, unsigned reference, fmi3UInt64 *value) {
    if (reference != PARAMETER_N)
        return instance_error(self, "value reference %u: no UInt64 variable", reference);
    *value = (fmi3UInt64)self->now.parameters.N;
    return STATUS_OK;
}

/* A structural parameter: only in configuration mode. */
static Status set_uint64(Instance *self, unsigned reference, const fmi3UInt64 *value) {
    return instance_set_horizon(self, reference, (double)*value, CONFIGURING);
}

static Status set_boolean(Instance *self, unsigned reference, const fmi3Boolean *value) {
    return instance_set_boolean(self, reference, *value);
}

TRANSFER(fmi3GetFloat64, fmi3Float64, instance_get_real)
TRANSFER(fmi3SetFloat64, const fmi3Float64, set_real)
TRANSFER(fmi3GetInt32, fmi3Int32, get_int32)
TRANSFER(fmi3GetUInt64, fmi3UInt64, get_uint64)
TRANSFER(fmi3SetUInt64, const fmi3UInt64, set_uint64)
TRANSFER(fmi3GetBoolean, fmi3Boolean, instance_get_boolean)
TRANSFER(fmi3SetBoolean, const fmi3Boolean, set_boolean)

/* The model has nothing else that could be read or set: asking for none of it is no error. */
#define ABSENT(NAME, VALUE)                                                     \
    fmi3Status NAME(ARGUMENTS(VALUE)) {                                         \
        return nValueReferences == 0 ? fmi3OK : unsupported(instance, #NAME);   \
    }
#define ABSENT_TYPE(TYPE) \
    ABSENT(fmi3Get##TYPE, fmi3##TYPE) \
    ABSENT(fmi3Set##TYPE, const fmi3##TYPE)
ABSENT_TYPE(Float32)
ABSENT_TYPE(Int8)
ABSENT_TYPE(UInt8)
ABSENT_TYPE(Int16)
ABSENT_TYPE(UInt16)
ABSENT(fmi3SetInt32, const fmi3Int32)
ABSENT_TYPE(UInt32)
ABSENT_TYPE(Int64)
ABSENT_TYPE(String)

#include "fmi3_rest.h"
