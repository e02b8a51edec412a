/* FMI 2.0 for Co-Simulation on top of instance.h. */
#include "fmi2_begin.h"

/* ---- life cycle ---- */

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance, fmi2Real startTime,
                               fmi2Boolean stopTimeDefined, fmi2Real stopTime) {
    REQUIRE(c, "fmi2SetupExperiment", CREATED);
    return (fmi2Status)instance_set_experiment(c, startTime, stopTimeDefined ? stopTime : HUGE_VAL);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    REQUIRE(c, "fmi2EnterInitializationMode", CREATED);
    return (fmi2Status)instance_enter(c, INITIALISING);
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    REQUIRE(c, "fmi2ExitInitializationMode", INITIALISING);
    return (fmi2Status)instance_exit_initialisation(c);
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint, fmi2Real communicationStepSize,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint) {
    if (c == NULL) return fmi2Error;
    return (fmi2Status)instance_step(c, "fmi2DoStep", currentCommunicationPoint, communicationStepSize);
}

fmi2Status fmi2Terminate(fmi2Component c) {
    return c == NULL ? fmi2Error : (fmi2Status)instance_terminate(c, "fmi2Terminate");
}

fmi2Status fmi2Reset(fmi2Component c) { return c == NULL ? fmi2Error : (fmi2Status)instance_reset(c, "fmi2Reset"); }

/* ---- variables ---- */

#define TRANSFER(NAME, VALUE, BODY)                                                              \
    fmi2Status NAME(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, VALUE value[]) { \
        if (c == NULL) return fmi2Error;                                                         \
        for (size_t i = 0; i < nvr; ++i)                                                         \
            if (BODY) return fmi2Error;                                                          \
        return fmi2OK;                                                                           \
    }

static Status get_boolean(Instance *self, fmi2ValueReference reference, fmi2Boolean *value) {
    bool is_true = false;
    const Status status = instance_get_boolean(self, reference, &is_true);
    *value = is_true ? fmi2True : fmi2False;
    return status;
}

TRANSFER(fmi2GetReal, fmi2Real, instance_get_real(c, vr[i], &value[i]))
TRANSFER(fmi2SetReal, const fmi2Real, instance_set_real(c, vr[i], value[i]))
TRANSFER(fmi2GetInteger, fmi2Integer, instance_get_integer(c, vr[i], &value[i]))
TRANSFER(fmi2SetInteger, const fmi2Integer, instance_set_horizon(c, vr[i], value[i], CREATED | INITIALISING))
TRANSFER(fmi2GetBoolean, fmi2Boolean, get_boolean(c, vr[i], &value[i]))
TRANSFER(fmi2SetBoolean, const fmi2Boolean, instance_set_boolean(c, vr[i], value[i] != fmi2False))

/* The model has no strings: asking for none of them is no error. */
#define ABSENT(NAME, VALUE)                                                                     \
    fmi2Status NAME(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, VALUE value[]) { \
        return nvr == 0 ? fmi2OK : unsupported(c, #NAME);                                       \
    }
ABSENT(fmi2GetString, fmi2String)
ABSENT(fmi2SetString, const fmi2String)

#include "fmi2_rest.h"
