/* One instance of the regulator, whatever the FMI version: variables, life cycle, saved states.
 *
 * It decides at t_k = start + k dt. Its outputs at t_k depend on its inputs at t_k, so they are computed when they
 * are read after an input was set there, and count only once a step from t_k has been asked for. Thus a host that
 * sets the inputs, reads the force, hands it to the vehicle and steps both has no lag; and whoever reads the
 * outputs after a step, before any input is set, sees those of that step.
 *
 * The front ends fmi2.c and fmi3.c translate their standard's calls into these and own the way messages are
 * written. Whatever is refused leaves the instance as it was, writes one message and returns STATUS_ERROR.
 */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "regulator.h"

#include <stdbool.h>
#include <stddef.h>

#define MODEL_NAME "LongitudinalController"

/* The values of fmi2Status and fmi3Status. */
typedef enum { STATUS_OK, STATUS_WARNING, STATUS_DISCARD, STATUS_ERROR, STATUS_FATAL } Status;

/* Value references, the same in both model descriptions. */
enum {
    TIME,
    SPEED,
    POSITION,
    GAP,
    SPEED_LIMIT,
    FORCE,
    REFERENCE_SPEED,
    ACTING,
    FEASIBLE,
    INFEASIBILITY,
    PARAMETER_M,                            /* and the others, in the order of Parameters */
    PARAMETER_N = PARAMETER_M + 14,         /* whole */
    PARAMETER_MPC = PARAMETER_M + 15,       /* boolean */
    OBSTACLE = 100,                         /* FMI 3: the array; FMI 2: its first element */
    OBSTACLE_END = OBSTACLE + HORIZON_MAX
};

/* Bits, so that several phases can be allowed at once. */
typedef enum { CREATED = 1, CONFIGURING = 2, INITIALISING = 4, STEPPING = 8, TERMINATED = 16 } Phase;

typedef enum {
    HELD,   /* the outputs are those of the decision before */
    OPEN,   /* an input has been set: they are to be computed when somebody reads them */
    DECIDED /* they are those of the inputs as they are */
} Stage;

/* All that a saved state holds; no padding, so that its bytes can be written out. */
typedef struct {
    int phase, stage;
    Parameters parameters;
    Observation seen;   /* the inputs */
    Memory memory;      /* of the decisions that count */
    Memory afterwards;  /* what it becomes when the present decision counts; of stage DECIDED */
    Decision decision;  /* the outputs */
    double decisions;   /* how many count: the next is at start_time + decisions dt */
    double acted;       /* Acting, of the last that counts */
    double start_time, time, stop_time; /* [s] the last is infinite where the host defines none */
} Snapshot;

enum { MESSAGE_SIZE = 512 };

typedef struct Instance Instance;
struct Instance {
    void (*write)(const Instance *self, Status status, const char *category, const char *message);
    char *name;
    bool debug;       /* report what happens, not only what goes wrong */
    Parameters start; /* the token's */
    Snapshot now;
    Mpc *mpc; /* of the parameters of the last decision; NULL: none was needed yet */
};

/* False where the token is another model's or memory has run out; the front end frees. */
bool instance_create(Instance *self, const char *name, const char *token, bool debug);
void instance_destroy(Instance *self);

Status instance_error(const Instance *self, const char *format, ...);
Status instance_require(const Instance *self, const char *function, int phases);

/* Compute the outputs from the inputs as they are; whether the decision counts is left open. */
Status instance_decide(Instance *self);
/* Something has been set: outputs are to be computed anew, but for those held between two decisions. */
void snapshot_reopen(Snapshot *s);

/* Reading an output may compute it. */
Status instance_get_real(Instance *self, unsigned reference, double *value);
Status instance_set_real(Instance *self, unsigned reference, double value);
Status instance_get_integer(Instance *self, unsigned reference, int *value);
Status instance_get_boolean(Instance *self, unsigned reference, bool *value);
Status instance_set_boolean(Instance *self, unsigned reference, bool value);
/* The horizon N is the only whole number that can be set; the phases in which it can are the standard's. */
Status instance_set_horizon(Instance *self, unsigned reference, double value, int phases);

/* Start and stop time [s]; an undefined stop time is infinite. */
Status instance_set_experiment(Instance *self, double start, double stop);
Status instance_enter(Instance *self, Phase phase);
Status instance_exit_initialisation(Instance *self);
Status instance_step(Instance *self, const char *function, double time, double step);
Status instance_terminate(Instance *self, const char *function);
Status instance_reset(Instance *self, const char *function);

Status instance_save(const Instance *self, Snapshot **saved);
Status instance_restore(Instance *self, const Snapshot *saved);

/* Bytes of a serialised state; the buffers may be unaligned. */
size_t snapshot_size(void);
Status snapshot_serialize(const Instance *self, const Snapshot *saved, void *bytes, size_t size);
Status snapshot_deserialize(const Instance *self, const void *bytes, size_t size, Snapshot **saved);

#endif
