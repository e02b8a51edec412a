/* FMI 3.0 for Co-Simulation on top of instance.h. */
#include "fmi3_begin.h"

/* ---- life cycle ---- */

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
                                       fmi3Float64 startTime, fmi3Boolean stopTimeDefined, fmi3Float64 stopTime) {
    REQUIRE(instance, "fmi3EnterInitializationMode", CREATED);
    if (instance_set_experiment(instance, startTime, stopTimeDefined ? stopTime : HUGE_VAL)) return fmi3Error;
    return (fmi3Status)instance_enter_initialisation(instance);
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

/* ---- variables ---- */

#define ARGUMENTS(VALUE) \
    fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences, VALUE values[], size_t nValues

#define TRANSFER(NAME, VALUE, CALL, VALUE_OF)                                                         \
    fmi3Status NAME(ARGUMENTS(VALUE)) {                                                               \
        if (instance == NULL) return fmi3Error;                                                       \
        if (nValues != nValueReferences)                                                              \
            return (fmi3Status)instance_error(instance, #NAME ": %zu values for %zu scalars", nValues, \
                                              nValueReferences);                                      \
        for (size_t i = 0; i < nValues; ++i)                                                          \
            if (CALL(instance, valueReferences[i], VALUE_OF(values[i]))) return fmi3Error;            \
        return fmi3OK;                                                                                \
    }
TRANSFER(fmi3GetFloat64, fmi3Float64, instance_get_real, &)
TRANSFER(fmi3SetFloat64, const fmi3Float64, instance_set_real, )
TRANSFER(fmi3GetBoolean, fmi3Boolean, instance_get_boolean, &)
TRANSFER(fmi3SetBoolean, const fmi3Boolean, instance_set_boolean, )

/* The model has no variables of the other types: asking for none of them is no error. */
#define ABSENT(TYPE)                                                                                               \
    fmi3Status fmi3Get##TYPE(ARGUMENTS(fmi3##TYPE)) {                                                              \
        return nValueReferences == 0 ? fmi3OK : unsupported(instance, "fmi3Get" #TYPE);                            \
    }                                                                                                              \
    fmi3Status fmi3Set##TYPE(ARGUMENTS(const fmi3##TYPE)) {                                                        \
        return nValueReferences == 0 ? fmi3OK : unsupported(instance, "fmi3Set" #TYPE);                            \
    }
ABSENT(Float32)
ABSENT(Int8)
ABSENT(UInt8)
ABSENT(Int16)
ABSENT(UInt16)
ABSENT(Int32)
ABSENT(UInt32)
ABSENT(Int64)
ABSENT(UInt64)
ABSENT(String)

#include "fmi3_rest.h"

UNSUPPORTED_PLAIN(fmi3EnterConfigurationMode)
UNSUPPORTED_PLAIN(fmi3ExitConfigurationMode)
