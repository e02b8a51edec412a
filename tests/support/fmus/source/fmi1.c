/* FMI 1.0 for Co-Simulation. Its functions carry the model identifier, here 'car'. */
#include "instance.h" /* first: fmi1Functions.h needs size_t */
#include "fmi1Functions.h"

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

/* The message is a printf format: the arguments are those of the fault message_arguments. */
static void say(Instance *self, Status status, const char *format, ...) {
    if (self->logger == NULL) return;
    ((fmi1CallbackLogger)self->logger)(self, "car", (fmi1Status)status, "car", format, "axle", 3, 99.5);
}

EXPORT const char *car_fmiGetTypesPlatform(void) { return "standard32"; }

EXPORT const char *car_fmiGetVersion(void) { return "1.0"; }

EXPORT fmi1Component car_fmiInstantiateSlave(fmi1String instanceName, fmi1String guid, fmi1String location,
                                             fmi1String mimeType, fmi1Real timeout, fmi1Boolean visible,
                                             fmi1Boolean interactive, fmi1CallbackFunctions functions,
                                             fmi1Boolean loggingOn) {
    char resources[4096];
    snprintf(resources, sizeof resources, "%s/resources", path_of(location));
    return instance_create(resources, guid, say, NULL, (void *)functions.logger);
}

EXPORT void car_fmiFreeSlaveInstance(fmi1Component c) { instance_destroy(c); }

EXPORT fmi1Status car_fmiSetDebugLogging(fmi1Component c, fmi1Boolean loggingOn) { return fmi1OK; }

EXPORT fmi1Status car_fmiInitializeSlave(fmi1Component c, fmi1Real start, fmi1Boolean stopDefined, fmi1Real stop) {
    ((Instance *)c)->stop_time = stopDefined ? stop : 0.0;
    return (fmi1Status)instance_initialise(c);
}

EXPORT fmi1Status car_fmiTerminateSlave(fmi1Component c) {
    instance_called(c, "terminate");
    return (fmi1Status)misbehave(c, AT_TERMINATE, 0.0, 0.0);
}

EXPORT fmi1Status car_fmiResetSlave(fmi1Component c) { return fmi1Error; }

EXPORT fmi1Status car_fmiDoStep(fmi1Component c, fmi1Real time, fmi1Real step, fmi1Boolean newStep) {
    return (fmi1Status)instance_step(c, time, step, true);
}

EXPORT fmi1Status car_fmiCancelStep(fmi1Component c) { return fmi1Error; }

#define ACCESS(NAME, TYPE)                                                                                    \
    EXPORT fmi1Status car_fmiGet##NAME(fmi1Component c, const fmi1ValueReference vr[], size_t n, TYPE value[]) { \
        double all[MAX_ELEMENTS];                                                                             \
        int count;                                                                                            \
        for (size_t i = 0; i < n; ++i) {                                                                      \
            if (instance_get(c, vr[i], all, &count)) return fmi1Error;                                        \
            value[i] = (TYPE)all[0];                                                                          \
        }                                                                                                     \
        return fmi1OK;                                                                                        \
    }                                                                                                         \
    EXPORT fmi1Status car_fmiSet##NAME(fmi1Component c, const fmi1ValueReference vr[], size_t n,              \
                                       const TYPE value[]) {                                                  \
        int count;                                                                                            \
        for (size_t i = 0; i < n; ++i) {                                                                      \
            double one = (double)value[i];                                                                    \
            if (instance_set(c, vr[i], &one, &count)) return fmi1Error;                                       \
        }                                                                                                     \
        return fmi1OK;                                                                                        \
    }
ACCESS(Real, fmi1Real)
ACCESS(Integer, fmi1Integer)
ACCESS(Boolean, fmi1Boolean)

EXPORT fmi1Status car_fmiGetString(fmi1Component c, const fmi1ValueReference vr[], size_t n, fmi1String value[]) {
    for (size_t i = 0; i < n; ++i) value[i] = ((Instance *)c)->load;
    return fmi1OK;
}

EXPORT fmi1Status car_fmiSetString(fmi1Component c, const fmi1ValueReference vr[], size_t n, const fmi1String value[]) {
    for (size_t i = 0; i < n; ++i)
        if (instance_set_text(c, value[i])) return fmi1Error;
    return fmi1OK;
}

EXPORT fmi1Status car_fmiSetRealInputDerivatives(fmi1Component c, const fmi1ValueReference vr[], size_t n,
                                                 const fmi1Integer order[], const fmi1Real value[]) {
    return fmi1Error;
}

EXPORT fmi1Status car_fmiGetRealOutputDerivatives(fmi1Component c, const fmi1ValueReference vr[], size_t n,
                                                  const fmi1Integer order[], fmi1Real value[]) {
    return fmi1Error;
}

EXPORT fmi1Status car_fmiGetStatus(fmi1Component c, const fmi1StatusKind kind, fmi1Status *value) { return fmi1Discard; }

EXPORT fmi1Status car_fmiGetRealStatus(fmi1Component c, const fmi1StatusKind kind, fmi1Real *value) {
    if (kind != fmi1LastSuccessfulTime) return fmi1Discard;
    *value = ((Instance *)c)->last_time;
    return fmi1OK;
}

EXPORT fmi1Status car_fmiGetIntegerStatus(fmi1Component c, const fmi1StatusKind kind, fmi1Integer *value) { return fmi1Discard; }

EXPORT fmi1Status car_fmiGetBooleanStatus(fmi1Component c, const fmi1StatusKind kind, fmi1Boolean *value) { return fmi1Discard; }

EXPORT fmi1Status car_fmiGetStringStatus(fmi1Component c, const fmi1StatusKind kind, fmi1String *value) { return fmi1Discard; }
