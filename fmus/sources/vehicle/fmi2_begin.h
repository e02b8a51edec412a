/* FMI 2.0: what does not differ between our models; the beginning of fmi2.c. */
#include "fmi2Functions.h"
#include "instance.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
    Instance base; /* first, so that the two pointers convert */
    fmi2CallbackLogger logger;
    fmi2ComponentEnvironment environment;
} Component;

static void write_message(const Instance *self, Status status, const char *category, const char *message) {
    const Component *c = (const Component *)self;
    if (c->logger == NULL) return;
    /* To the host it is a printf format. Escaped instead of sent through "%s", it can also be read by
     * a host that cannot expand formats, as those in languages without C's variable arguments. */
    char format[2 * MESSAGE_SIZE];
    char *end = format;
    for (; *message != '\0'; ++message) {
        if (*message == '%') *end++ = '%';
        *end++ = *message;
    }
    *end = '\0';
    c->logger(c->environment, self->name, (fmi2Status)status, category, format);
}

static fmi2Status unsupported(fmi2Component c, const char *function) {
    return c == NULL ? fmi2Error : (fmi2Status)instance_error(c, "%s: this model does not offer it", function);
}

#define REQUIRE(c, function, phases) \
    if ((c) == NULL || instance_require((c), (function), (phases))) return fmi2Error

/* ---- creation ---- */

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation, const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn) {
    Component *c = calloc(1, sizeof *c);
    if (c == NULL) return NULL;
    c->base.write = write_message;
    if (functions != NULL) {
        c->logger = functions->logger;
        c->environment = functions->componentEnvironment;
    }
    bool created = instance_create(&c->base, instanceName, fmuGUID, loggingOn);
    if (created && fmuType != fmi2CoSimulation) {
        instance_error(&c->base, "fmi2Instantiate: this FMU is for Co-Simulation only");
        created = false;
    }
    if (created) return c;
    instance_destroy(&c->base);
    return NULL;
}

void fmi2FreeInstance(fmi2Component c) { instance_destroy(c); }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories, const fmi2String categories[]) {
    if (c == NULL) return fmi2Error;
    ((Instance *)c)->debug = loggingOn;
    return fmi2OK;
}
