/* FMI 3.0: what does not differ between our models; the beginning of fmi3.c. */
#include "fmi3Functions.h"
#include "instance.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
    Instance base; /* first, so that the two pointers convert */
    fmi3LogMessageCallback log;
    fmi3InstanceEnvironment environment;
} Component;

static void write_message(const Instance *self, Status status, const char *category, const char *message) {
    const Component *c = (const Component *)self;
    if (c->log != NULL) c->log(c->environment, (fmi3Status)status, category, message);
}

static fmi3Status unsupported(fmi3Instance instance, const char *function) {
    return instance == NULL ? fmi3Error : (fmi3Status)instance_error(instance, "%s: this model does not offer it", function);
}

#define REQUIRE(instance, function, phases) \
    if ((instance) == NULL || instance_require((instance), (function), (phases))) return fmi3Error

/* ---- creation ---- */

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Instance fmi3InstantiateCoSimulation(fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
                                         fmi3Boolean visible, fmi3Boolean loggingOn, fmi3Boolean eventModeUsed,
                                         fmi3Boolean earlyReturnAllowed,
                                         const fmi3ValueReference requiredIntermediateVariables[],
                                         size_t nRequiredIntermediateVariables,
                                         fmi3InstanceEnvironment instanceEnvironment, fmi3LogMessageCallback logMessage,
                                         fmi3IntermediateUpdateCallback intermediateUpdate) {
    Component *c = calloc(1, sizeof *c);
    if (c == NULL) return NULL;
    c->base.write = write_message;
    c->log = logMessage;
    c->environment = instanceEnvironment;
    if (instance_create(&c->base, instanceName, instantiationToken, loggingOn)) return c;
    instance_destroy(&c->base);
    return NULL;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
                                          fmi3Boolean visible, fmi3Boolean loggingOn,
                                          fmi3InstanceEnvironment instanceEnvironment,
                                          fmi3LogMessageCallback logMessage) {
    return NULL;
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String instanceName, fmi3String instantiationToken,
                                               fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                               fmi3InstanceEnvironment instanceEnvironment,
                                               fmi3LogMessageCallback logMessage, fmi3ClockUpdateCallback clockUpdate,
                                               fmi3LockPreemptionCallback lockPreemption,
                                               fmi3UnlockPreemptionCallback unlockPreemption) {
    return NULL;
}

void fmi3FreeInstance(fmi3Instance instance) { instance_destroy(instance); }

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean loggingOn, size_t nCategories,
                               const fmi3String categories[]) {
    if (instance == NULL) return fmi3Error;
    ((Instance *)instance)->debug = loggingOn;
    return fmi3OK;
}
