/* A bouncing ball for Model Exchange with FMI 1.0: h' = v, v' = -gravity - friction sign(v). At h = 0 it turns round with
 * `restitution` times its speed; it stays on the ground once that is below 1 cm/s. */
#include <stdlib.h>
#include <string.h>

#define EXPORT __attribute__((visibility("default")))

typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
} Callbacks;

typedef struct {
    char iterationConverged, stateValueReferencesChanged, stateValuesChanged, terminateSimulation, upcomingTimeEvent;
    double nextEventTime;
} EventInfo;

enum { H, V, GRAVITY, RESTITUTION, BOUNCES, FRICTION, REALS };

typedef struct {
    Callbacks callbacks;
    double real[REALS], time;
    char moving;
} Ball;

EXPORT const char *ball_fmiGetModelTypesPlatform(void) { return "standard32"; }
EXPORT const char *ball_fmiGetVersion(void) { return "1.0"; }

EXPORT void *ball_fmiInstantiateModel(const char *name, const char *guid, Callbacks callbacks, char loggingOn) {
    if (!loggingOn || strcmp(guid, "{ball}") != 0) {
        callbacks.logger(NULL, name, 3, "error", "wrong GUID %s", guid);
        return NULL;
    }
    Ball *ball = callbacks.allocateMemory(1, sizeof *ball);
    *ball = (Ball){.callbacks = callbacks, .real = {1.0, 0.0, 9.81, 0.7, 0.0, 0.0}, .moving = 1};
    return ball;
}

EXPORT void ball_fmiFreeModelInstance(void *c) { ((Ball *)c)->callbacks.freeMemory(c); }

EXPORT int ball_fmiSetTime(void *c, double time) {
    ((Ball *)c)->time = time;
    return 0;
}

EXPORT int ball_fmiSetReal(void *c, const unsigned vr[], size_t n, const double value[]) {
    for (size_t i = 0; i < n; ++i) ((Ball *)c)->real[vr[i]] = value[i];
    return 0;
}

EXPORT int ball_fmiGetReal(void *c, const unsigned vr[], size_t n, double value[]) {
    for (size_t i = 0; i < n; ++i) value[i] = ((Ball *)c)->real[vr[i]];
    return 0;
}

EXPORT int ball_fmiSetBoolean(void *c, const unsigned vr[], size_t n, const char value[]) {
    if (n > 0) ((Ball *)c)->moving = value[n - 1];
    return 0;
}

EXPORT int ball_fmiGetBoolean(void *c, const unsigned vr[], size_t n, char value[]) {
    memset(value, ((Ball *)c)->moving, n);
    return 0;
}

EXPORT int ball_fmiInitialize(void *c, char toleranceControlled, double tolerance, EventInfo *info) {
    *info = (EventInfo){.iterationConverged = 1};
    return toleranceControlled && tolerance > 0.0 ? 0 : 3;
}

EXPORT int ball_fmiEventUpdate(void *c, char intermediateResults, EventInfo *info) {
    Ball *ball = c;
    *info = (EventInfo){.iterationConverged = 1};
    if (ball->moving && ball->real[H] <= 0.0 && ball->real[V] < 0.0) {
        ball->real[H] = 0.0;
        ball->real[V] *= -ball->real[RESTITUTION];
        ball->real[BOUNCES] += 1.0;
        info->stateValuesChanged = 1;
        if (ball->real[V] < 0.01) {
            ball->moving = 0;
            ball->real[V] = 0.0;
        }
    }
    return 0;
}

EXPORT int ball_fmiCompletedIntegratorStep(void *c, char *callEventUpdate) {
    *callEventUpdate = 0;
    return 0;
}

EXPORT int ball_fmiGetContinuousStates(void *c, double x[], size_t n) {
    memcpy(x, ((Ball *)c)->real, n * sizeof *x);
    return 0;
}

EXPORT int ball_fmiSetContinuousStates(void *c, const double x[], size_t n) {
    memcpy(((Ball *)c)->real, x, n * sizeof *x);
    return 0;
}

static double sign(double value) { return (value > 0.0) - (value < 0.0); }

EXPORT int ball_fmiGetDerivatives(void *c, double rates[], size_t n) {
    const Ball *ball = c;
    rates[0] = ball->moving ? ball->real[V] : 0.0;
    rates[1] = ball->moving ? -ball->real[GRAVITY] - ball->real[FRICTION] * sign(ball->real[V]) : 0.0;
    return 0;
}

EXPORT int ball_fmiGetEventIndicators(void *c, double z[], size_t n) {
    const Ball *ball = c;
    z[0] = ball->moving ? ball->real[H] : 1.0;
    return 0;
}

EXPORT int ball_fmiGetNominalContinuousStates(void *c, double x[], size_t n) {
    for (size_t i = 0; i < n; ++i) x[i] = 1.0;
    return 0;
}

EXPORT int ball_fmiTerminate(void *c) { return 0; }
