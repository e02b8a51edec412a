/* One instance of the vehicle, whatever the FMI version: variables, life cycle, saved states.
 *
 * The front ends fmi2.c and fmi3.c translate their standard's calls into these and own the way
 * messages are written. Whatever is refused leaves the instance as it was, writes one message and
 * returns STATUS_ERROR.
 */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "plant.h"

#include <stdbool.h>
#include <stddef.h>

#define MODEL_NAME "LongitudinalVehicle"

/* The values of fmi2Status and fmi3Status. */
typedef enum { STATUS_OK, STATUS_WARNING, STATUS_DISCARD, STATUS_ERROR, STATUS_FATAL } Status;

/* Value references, the same in both model descriptions. */
enum {
    TIME,
    FORCE,
    POSITION,
    SPEED,
    ACCELERATION,
    PARAMETER_M,
    PARAMETER_ALPHA,
    PARAMETER_S0,
    PARAMETER_V0,
    PARAMETER_EXACT,
    PARAMETER_REVERSE
};

/* Bits, so that several phases can be allowed at once. */
typedef enum { CREATED = 1, INITIALISING = 2, STEPPING = 4, TERMINATED = 8 } Phase;

/* All that a saved state holds. */
typedef struct {
    Phase phase;
    PlantParameters parameters;
    PlantState state;
    double force;     /* [N] the input */
    double time;      /* [s] */
    double stop_time; /* [s] infinite where the host defines none */
} Snapshot;

enum { MESSAGE_SIZE = 512 };

typedef struct Instance Instance;
struct Instance {
    void (*write)(const Instance *self, Status status, const char *category, const char *message);
    char *name;
    bool debug; /* report what happens, not only what goes wrong */
    Snapshot now;
    PlantDiscretisation discretisation; /* of the last step's dt and of the parameters */
};

/* False where the token is another model's or memory has run out; the front end frees. */
bool instance_create(Instance *self, const char *name, const char *token, bool debug);
void instance_destroy(Instance *self);

Status instance_error(const Instance *self, const char *format, ...);
Status instance_require(const Instance *self, const char *function, int phases);

Status instance_get_real(const Instance *self, unsigned reference, double *value);
Status instance_set_real(Instance *self, unsigned reference, double value);
Status instance_get_boolean(const Instance *self, unsigned reference, bool *value);
Status instance_set_boolean(Instance *self, unsigned reference, bool value);

/* Start and stop time [s]; an undefined stop time is infinite. */
Status instance_set_experiment(Instance *self, double start, double stop);
Status instance_enter_initialisation(Instance *self);
Status instance_exit_initialisation(Instance *self);
Status instance_step(Instance *self, const char *function, double time, double dt);
Status instance_terminate(Instance *self, const char *function);
Status instance_reset(Instance *self, const char *function);

Status instance_save(const Instance *self, Snapshot **saved);
Status instance_restore(Instance *self, const Snapshot *saved);

/* Doubles, in a buffer of `size` bytes that may be unaligned. */
size_t snapshot_size(void);
Status snapshot_serialize(const Instance *self, const Snapshot *saved, void *bytes, size_t size);
Status snapshot_deserialize(const Instance *self, const void *bytes, size_t size, Snapshot **saved);

#endif
