#define _GNU_SOURCE
#include "instance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#ifndef _WIN32
#include <dlfcn.h>
#endif

static int living; /* instances of this process */

static const char *const QUANTITY_NAMES[] = {
#define X(name) #name,
    QUANTITIES(X)
#undef X
};
static const char *const ROLE_NAMES[] = {"force", "drive_brake", "acceleration", "throttle_brake", "speed_setpoint"};
static const char *const PHASE_NAMES[] = {"load", "instantiate", "initialise", "step", "event", "terminate", "free", "unload"};

static int index_of(const char *name, const char *const names[], size_t count) {
    for (size_t i = 0; i < count; ++i)
        if (name != NULL && strcmp(name, names[i]) == 0) return (int)i;
    fprintf(stderr, "car.txt: unknown word '%s'\n", name ? name : "");
    abort();
}
#define INDEX_OF(name, names) index_of((name), (names), sizeof(names) / sizeof *(names))

static double number(char **rest) {
    const char *word = strtok_r(NULL, " \n", rest);
    return word == NULL ? 0.0 : strtod(word, NULL);
}

static void read_line(Instance *self, char *line) {
    char *rest = NULL;
    const char *key = strtok_r(line, " \n", &rest);
    if (key == NULL) return;
    if (strcmp(key, "token") == 0) snprintf(self->token, sizeof self->token, "%s", strtok_r(NULL, "\n", &rest));
    else if (strcmp(key, "calls") == 0) snprintf(self->calls, sizeof self->calls, "%s", strtok_r(NULL, "\n", &rest));
    else if (strcmp(key, "role") == 0) self->car.role = (Role)INDEX_OF(strtok_r(NULL, " \n", &rest), ROLE_NAMES);
    else if (strcmp(key, "euler") == 0) self->car.euler = true;
    else if (strcmp(key, "once_per_process") == 0) self->once_per_process = true;
    else if (strcmp(key, "strict_time") == 0) self->strict_time = true;
    else if (strcmp(key, "constant_step") == 0) self->constant_step = true;
    else if (strcmp(key, "keeps_final_only") == 0) self->keeps_final_only = true;
    else if (strcmp(key, "only_event_mode") == 0) self->only_event_mode = true;
    else if (strcmp(key, "samples") == 0) self->samples = true;
    else if (strcmp(key, "interval") == 0) self->interval = number(&rest);
    else if (strcmp(key, "divides") == 0) self->divides = true;
    else if (strcmp(key, "needs_event_mode") == 0) self->needs_event_mode = true;
    else if (strcmp(key, "needs_stop_time") == 0) self->needs_stop_time = number(&rest);
    else if (strcmp(key, "only_step") == 0) self->only_step = number(&rest);
    else if (strcmp(key, "nominal") == 0) self->nominal = number(&rest);
    else if (strcmp(key, "variable") == 0) {
        unsigned reference = (unsigned)number(&rest);
        int *count = &self->variables[reference].count;
        for (char *word; (word = strtok_r(NULL, " \n", &rest)) != NULL && *count < MAX_ELEMENTS;)
            self->variables[reference].quantity[(*count)++] = (Quantity)INDEX_OF(word, QUANTITY_NAMES);
    } else if (strcmp(key, "value") == 0) {
        int quantity = INDEX_OF(strtok_r(NULL, " \n", &rest), QUANTITY_NAMES);
        self->car.value[quantity] = number(&rest);
    } else if (strcmp(key, "scale") == 0) {
        int quantity = INDEX_OF(strtok_r(NULL, " \n", &rest), QUANTITY_NAMES);
        self->factor[quantity] = number(&rest);
        self->offset[quantity] = number(&rest);
    } else if (strcmp(key, "fault") == 0 && self->fault_count < MAX_FAULTS) {
        FaultEntry *fault = &self->faults[self->fault_count++];
        snprintf(fault->name, sizeof fault->name, "%s", strtok_r(NULL, " \n", &rest));
        fault->phase = (Phase)INDEX_OF(strtok_r(NULL, " \n", &rest), PHASE_NAMES);
        fault->from = number(&rest);
    }
}

bool read_settings(Instance *self, const char *resources) {
    char path[4096], line[4096];
    snprintf(path, sizeof path, "%s/car.txt", resources);
    FILE *file = fopen(path, "r");
    if (file == NULL) return false;
    for (int i = 0; i < QUANTITY_COUNT; ++i) self->factor[i] = 1.0;
    while (fgets(line, sizeof line, file) != NULL) read_line(self, line);
    fclose(file);
    return true;
}

const char *path_of(const char *location) {
    static char path[4096];
    if (location == NULL) return "";
    if (strncmp(location, "file:", 5) == 0) {
        location += 5;
        if (strncmp(location, "//", 2) == 0) location = strchr(location + 2, '/') ? strchr(location + 2, '/') : location + 2;
    }
    char *end = path;
    while (*location != '\0' && end < path + sizeof path - 1) {
        unsigned code;
        if (*location == '%' && sscanf(location + 1, "%2x", &code) == 1) {
            *end++ = (char)code;
            location += 3;
        } else {
            *end++ = *location++;
        }
    }
    *end = '\0';
    return path;
}

Instance *instance_create(const char *resources, const char *token,
                          void (*say)(Instance *, Status, const char *, ...), void *environment, void *logger) {
    Instance *self = calloc(1, sizeof *self);
    self->say = say;
    self->environment = environment;
    self->logger = logger;
    self->nominal = 1.0;
    if (!read_settings(self, resources)) {
        say(self, ERROR, "no car.txt among the resources: is their location right?");
        free(self);
        return NULL;
    }
    instance_called(self, "instantiate");
    Status status = misbehave(self, AT_INSTANTIATE, 0.0, 0.0);
    if (token == NULL || strcmp(token, self->token) != 0) {
        say(self, ERROR, "the token is that of another model");
        status = ERROR;
    }
    if (self->once_per_process && living > 0) {
        say(self, ERROR, "only one instance per process, and there is one");
        status = ERROR;
    }
    if (status >= ERROR) {
        free(self);
        return NULL;
    }
    ++living;
    return self;
}

void instance_destroy(Instance *self) {
    if (self == NULL) return;
    instance_called(self, "free");
    misbehave(self, AT_FREE, self->car.time, 0.0);
    --living;
    free(self);
}

void instance_called(Instance *self, const char *function) {
    if (self->dead) {
        fprintf(stderr, "%s called after the FMU had said 'fatal'\n", function);
        abort();
    }
    if (self->calls[0] == '\0') return;
    FILE *file = fopen(self->calls, "a");
    if (file == NULL) return;
    fprintf(file, "%s\n", function);
    fclose(file);
}

Status instance_enter(Instance *self) {
    instance_called(self, "enter");
    if (!self->divides || self->car.value[Q_spare_input] != 0.0) return OK;
    self->say(self, ERROR, "spare_input is 0: division by zero");
    return ERROR;
}

Status instance_initialise(Instance *self) {
    instance_called(self, "initialise");
    Status status = misbehave(self, AT_INITIALISE, 0.0, 0.0);
    if (status >= DISCARD) return status;
    if (self->stop_time < self->needs_stop_time) {
        self->say(self, ERROR, "no stop time, or too early");
        return ERROR;
    }
    if (self->load[0] != '\0' && strcmp(self->load, "empty") != 0) {
        if (strcmp(self->load, "full") != 0) {
            self->say(self, ERROR, "load: neither empty nor full");
            return ERROR;
        }
        self->car.value[Q_mass] *= 1.5;
        self->load[0] = '\0';
    }
    if (self->car.value[Q_mass] <= 0.0) {
        self->say(self, ERROR, "mass: not above zero");
        return ERROR;
    }
    car_start(&self->car);
    self->initialised = true;
    return status;
}

/* What this FMU is particular about; the standard allows each. */
static Status check_step(Instance *self, double time, double step) {
    if (!self->initialised) {
        self->say(self, ERROR, "a step before the initialisation");
        return ERROR;
    }
    if (self->car.undefined) {
        self->say(self, ERROR, "a step after a discard, without the state before it");
        return ERROR;
    }
    if (self->strict_time && time != self->car.time && fabs(time - self->car.time) > 1e-15 * (1.0 + fabs(time))) {
        self->say(self, ERROR, "not the time at which the last step ended");
        return ERROR;
    }
    if (self->first_step == 0.0) self->first_step = step;
    if (self->only_step > 0.0 && fabs(step - self->only_step) > 1e-9) {
        self->say(self, ERROR, "not my step");
        return ERROR;
    }
    if (self->constant_step && fabs(step - self->first_step) > 1e-9) {
        self->say(self, ERROR, "not the step that I began with");
        return ERROR;
    }
    return OK;
}

Status instance_step(Instance *self, double time, double step, bool final) {
    if (self->calls[0] != '\0') {
        char call[80];
        snprintf(call, sizeof call, "step %.17g %.17g %d", time, step, final);
        instance_called(self, call);
    } else {
        instance_called(self, "step");
    }
    Status status = check_step(self, time, step);
    if (status >= DISCARD) return status;
    self->last_time = time;
    status = misbehave(self, AT_STEP, time, step);
    if (status >= DISCARD) return status;
    Car before = self->car;
    car_step(&self->car, time, step);
    if (self->keeps_final_only && !final) self->car = before;
    self->last_time = time + step;
    return status;
}

Status instance_get(Instance *self, unsigned reference, double values[], int *count) {
    if (self->dead) instance_called(self, "get");
    *count = 0;
    if (reference >= MAX_VARIABLES || self->variables[reference].count == 0) {
        self->say(self, ERROR, "no such variable to read");
        return ERROR;
    }
    *count = self->variables[reference].count;
    for (int i = 0; i < *count; ++i) {
        Quantity quantity = self->variables[reference].quantity[i];
        values[i] = (car_get(&self->car, quantity) - self->offset[quantity]) / self->factor[quantity];
    }
    return OK;
}

Status instance_set(Instance *self, unsigned reference, const double values[], int *count) {
    if (self->dead) instance_called(self, "set");
    *count = 0;
    if (reference >= MAX_VARIABLES || self->variables[reference].count == 0) {
        self->say(self, ERROR, "no such variable to set");
        return ERROR;
    }
    *count = self->variables[reference].count;
    for (int i = 0; i < *count; ++i) {
        Quantity quantity = self->variables[reference].quantity[i];
        if (quantity >= Q_speed && quantity <= Q_clock) {
            self->say(self, ERROR, "an output cannot be set");
            return ERROR;
        }
        if (quantity >= Q_mass && self->initialised) {
            self->say(self, ERROR, "a parameter cannot be set any more");
            return ERROR;
        }
        if (quantity == Q_array_size) { /* the array of inputs; further elements are spare */
            if (values[i] < 1.0 || values[i] > MAX_ELEMENTS) return ERROR;
            for (int j = self->variables[INPUT_ARRAY].count; j < (int)values[i]; ++j)
                self->variables[INPUT_ARRAY].quantity[j] = Q_spare_input;
            self->variables[INPUT_ARRAY].count = (int)values[i];
        }
        if (quantity >= Q_mass && has_fault(self, "refuse_start_value")) {
            self->say(self, ERROR, "I do not like this start value");
            return ERROR;
        }
        if (quantity == Q_force && self->samples && self->initialised) {
            self->next_force = self->factor[quantity] * values[i] + self->offset[quantity];
            continue;
        }
        if (quantity >= Q_state_position && quantity <= Q_state_force)
            self->car.x[quantity - Q_state_position] = values[i];
        self->car.value[quantity] = self->factor[quantity] * values[i] + self->offset[quantity];
    }
    return OK;
}

Status instance_set_text(Instance *self, const char *text) {
    if (self->initialised || text == NULL) return ERROR;
    snprintf(self->load, sizeof self->load, "%s", text);
    return OK;
}

/* ---- what happens when the library is loaded and unloaded ---- */

#ifndef _WIN32
static void at_library(Phase phase) {
    Dl_info info;
    char folder[4096];
    if (dladdr((void *)at_library, &info) == 0) return;
    snprintf(folder, sizeof folder, "%s", info.dli_fname);
    for (int level = 0; level < 3; ++level) { /* binaries/PLATFORM/car.so */
        char *slash = strrchr(folder, '/');
        if (slash == NULL) return;
        *slash = '\0';
    }
    strncat(folder, "/resources", sizeof folder - strlen(folder) - 1);
    Instance *self = calloc(1, sizeof *self);
    if (read_settings(self, folder)) misbehave(self, phase, 0.0, 0.0);
    free(self);
}

__attribute__((constructor)) static void loaded(void) { at_library(AT_LOAD); }

__attribute__((destructor)) static void unloaded(void) { at_library(AT_UNLOAD); }
#endif
