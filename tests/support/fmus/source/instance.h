/* An instance of the car behind any of the three FMI versions. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "car.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef enum { OK, WARNING, DISCARD, ERROR, FATAL, PENDING } Status;

typedef enum { AT_LOAD, AT_INSTANTIATE, AT_INITIALISE, AT_STEP, AT_EVENT, AT_TERMINATE, AT_FREE, AT_UNLOAD } Phase;

enum { MAX_VARIABLES = 64, MAX_ELEMENTS = 16, MAX_FAULTS = 8, INPUT_ARRAY = 60, MAX_TEXT = 256 };

typedef struct {
    char name[40];
    Phase phase;
    double from; /* [s] it happens in the first step that begins at or after this time */
    int count;   /* how often it has happened */
} FaultEntry;

typedef struct Instance Instance;

struct Instance {
    Car car;
    char token[MAX_TEXT], load[MAX_TEXT], calls[4 * MAX_TEXT];
    double factor[QUANTITY_COUNT], offset[QUANTITY_COUNT]; /* SI = factor * raw + offset */
    struct {
        int count;
        Quantity quantity[MAX_ELEMENTS];
    } variables[MAX_VARIABLES]; /* by value reference */
    FaultEntry faults[MAX_FAULTS];
    int fault_count;
    bool once_per_process, strict_time;
    bool keeps_final_only; /* a step after which its state may be set back is not kept */
    bool needs_event_mode; /* FMI 3: no step without it, nor before its events are handled */
    bool event_mode, event_pending;
    bool only_event_mode; /* FMI 3: makes no instance without it */
    bool samples;         /* the force counts as its clock ticks */
    bool ticks;           /* it ticks now */
    double interval;      /* [s] of the clock, for who asks */
    double next_force;    /* the input, until the next tick */
    bool divides;         /* by an input, as it enters initialization mode */
    double needs_stop_time; /* [s] it has to be told one as late as this; 0: none */
    double stop_time;
    double only_step;   /* [s] refuses every other one */
    bool constant_step; /* refuses a step that differs from the first */
    double first_step;
    double nominal;
    bool initialised, dead, ended; /* ended: the FMU asks to end the simulation */
    double last_time; /* lastSuccessfulTime */
    void (*say)(Instance *self, Status status, const char *format, ...);
    void *environment, *logger;
};

/* Read resources/car.txt; NULL with a word on stderr if there is none. */
Instance *instance_create(const char *resources, const char *token,
                          void (*say)(Instance *, Status, const char *, ...), void *environment, void *logger);
void instance_destroy(Instance *self);
bool read_settings(Instance *self, const char *resources);

/* Every call: keeps the journal of calls, and dies of a call after 'fatal'. */
void instance_called(Instance *self, const char *function);
Status instance_enter(Instance *self);
Status instance_initialise(Instance *self);
Status instance_step(Instance *self, double time, double step, bool final);
Status instance_get(Instance *self, unsigned reference, double values[], int *count);
Status instance_set(Instance *self, unsigned reference, const double values[], int *count);
Status instance_set_text(Instance *self, const char *text);
const char *path_of(const char *location); /* of a file: URI or a path */

/* faults.c */
Status misbehave(Instance *self, Phase phase, double time, double step);
bool has_fault(const Instance *self, const char *name);

#endif
