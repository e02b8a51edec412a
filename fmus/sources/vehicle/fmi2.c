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
    return (fmi2Status)instance_enter_initialisation(c);
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

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[]) {
    if (c == NULL) return fmi2Error;
    for (size_t i = 0; i < nvr; ++i)
        if (instance_get_real(c, vr[i], &value[i])) return fmi2Error;
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[]) {
    if (c == NULL) return fmi2Error;
    for (size_t i = 0; i < nvr; ++i)
        if (instance_set_real(c, vr[i], value[i])) return fmi2Error;
    return fmi2OK;
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Boolean value[]) {
    if (c == NULL) return fmi2Error;
    for (size_t i = 0; i < nvr; ++i) {
        bool is_true;
        if (instance_get_boolean(c, vr[i], &is_true)) return fmi2Error;
        value[i] = is_true ? fmi2True : fmi2False;
    }
    return fmi2OK;
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Boolean value[]) {
    if (c == NULL) return fmi2Error;
    for (size_t i = 0; i < nvr; ++i)
        if (instance_set_boolean(c, vr[i], value[i] != fmi2False)) return fmi2Error;
    return fmi2OK;
}

/* The model has no integers and no strings: asking for none of them is no error. */
#define ABSENT(NAME, VALUE)                                                                     \
    fmi2Status NAME(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, VALUE value[]) { \
        return nvr == 0 ? fmi2OK : unsupported(c, #NAME);                                       \
    }
ABSENT(fmi2GetInteger, fmi2Integer)
ABSENT(fmi2SetInteger, const fmi2Integer)
ABSENT(fmi2GetString, fmi2String)
ABSENT(fmi2SetString, const fmi2String)

#include "fmi2_rest.h"
