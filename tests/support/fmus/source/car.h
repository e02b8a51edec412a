/* The car of the zoo: M v' + alpha v + c v |v| = F, in SI, whatever an FMU calls it outside. */
#ifndef CAR_H
#define CAR_H

#include <stdbool.h>

/* Everything that has a number. The builder names them in resources/car.txt. */
#define QUANTITIES(X)                                                                               \
    X(force) X(drive_force) X(brake_force) X(wanted_acceleration) X(throttle) X(brake)              \
    X(speed_setpoint) X(spare_input) X(grade)                                                    \
    X(speed) X(position) X(acceleration) X(wheel_force) X(gear) X(clock)                            \
    X(state_position) X(state_speed) X(state_force)                                                 \
    X(rate_position) X(rate_speed) X(rate_force) X(indicator)                                       \
    X(mass) X(friction) X(drag) X(lag) X(response) X(full_drive) X(full_brake) X(holds)             \
    X(gear_time) X(gear_speed) X(gear_ratio) X(gears) X(engaged) X(initial_speed)                   \
    X(initial_position) X(array_size) X(position_step) X(creep) X(sensor_lag)

typedef enum {
#define X(name) Q_##name,
    QUANTITIES(X)
#undef X
    QUANTITY_COUNT
} Quantity;

typedef enum { ROLE_FORCE, ROLE_DRIVE_BRAKE, ROLE_ACCELERATION, ROLE_THROTTLE_BRAKE, ROLE_SPEED } Role;

enum { MAX_STATES = 4 };

/* A plain value: a saved state is a copy of it. */
typedef struct {
    Role role;
    bool euler;           /* one explicit Euler step per communication step, stable or not */
    double value[QUANTITY_COUNT]; /* inputs and parameters */
    double time;
    double x[MAX_STATES]; /* position, speed, force of the actuator (with a lag only), filtered speed */
    bool held;            /* the brake holds the standing car */
    bool shifted;         /* into the second gear */
    bool frozen;          /* nothing moves any more */
    bool position_stands, speed_stands; /* the output does not follow any more */
    double stood;         /* its value */
    bool chatters;        /* every event iteration needs another */
    bool undefined;       /* after a discard that has to be undone */
    double added[QUANTITY_COUNT]; /* what a fault adds to an output: also NaN */
    double rate_fault;    /* what a fault adds to the derivatives */
} Car;

int car_states(const Car *car);
bool car_is_static(const Car *car);
void car_start(Car *car);
void car_rates(const Car *car, double rates[]);
double car_get(const Car *car, Quantity quantity);

/* Model Exchange */
double car_indicator(const Car *car);
bool car_wants_event(const Car *car);
bool car_event(Car *car); /* true: the continuous states have changed */

/* Co-Simulation */
void car_step(Car *car, double time, double step);

#endif
