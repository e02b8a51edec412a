#include "car.h"

#include <math.h>
#include <string.h>

static const double SUBSTEP = 1e-3; /* [s] Runge-Kutta of order four: exact to the last digits */
static const double SLACK = 1e-9;   /* keeps event indicators off zero while nothing happens */

static double parameter(const Car *car, Quantity quantity) { return car->value[quantity]; }

bool car_is_static(const Car *car) { return car->role == ROLE_SPEED && parameter(car, Q_response) == 0.0; }

int car_states(const Car *car) { return car_is_static(car) ? 0 : parameter(car, Q_lag) > 0.0 ? 3 : 2; }

/* The force that the actuator is to exert; below zero it brakes. */
static double wanted_force(const Car *car, double speed) {
    const double *v = car->value;
    switch (car->role) {
        case ROLE_FORCE: return v[Q_force];
        case ROLE_DRIVE_BRAKE: return v[Q_drive_force] - v[Q_brake_force];
        case ROLE_ACCELERATION: return v[Q_mass] * v[Q_wanted_acceleration];
        case ROLE_THROTTLE_BRAKE: return v[Q_throttle] * v[Q_full_drive] - v[Q_brake] * v[Q_full_brake];
        case ROLE_SPEED: return v[Q_mass] * (v[Q_speed_setpoint] - speed) / v[Q_response];
    }
    return 0.0;
}

/* What moves a car without drive and brake: an automatic gearbox up to 1.5 m/s, and the road's grade. */
static double pull(const Car *car, double speed) {
    const double *v = car->value;
    return v[Q_creep] * fmax(0.0, 1.0 - speed / 1.5) - 9.81 * v[Q_mass] * sin(v[Q_grade]);
}

static double force_at(const Car *car, const double x[]) {
    return parameter(car, Q_lag) > 0.0 ? x[2] : wanted_force(car, x[1]);
}

/* An acceleration or speed set-point is kept against all resistance. */
static double resistance(const Car *car, double speed) {
    if (car->role == ROLE_ACCELERATION || car->role == ROLE_SPEED) return 0.0;
    return parameter(car, Q_friction) * speed + parameter(car, Q_drag) * speed * fabs(speed);
}

static void rates_at(const Car *car, const double x[], double rates[]) {
    memset(rates, 0, MAX_STATES * sizeof *rates);
    if (car->frozen) return;
    double force = force_at(car, x);
    if (parameter(car, Q_lag) > 0.0) rates[2] = (wanted_force(car, x[1]) - x[2]) / parameter(car, Q_lag);
    if (parameter(car, Q_engaged) == 0.0 && force > 0.0) force = 0.0;
    if (force > 0.0) force *= parameter(car, Q_gears) * (car->shifted ? parameter(car, Q_gear_ratio) : 1.0);
    bool rubs = parameter(car, Q_holds) != 0.0 && pull(car, 0.0) != 0.0; /* brakes act against the motion */
    if (rubs && force < 0.0 && car->x[1] < 0.0) force = -force;
    if (!car->held) {
        rates[0] = x[1];
        rates[1] = (force + pull(car, x[1]) - resistance(car, x[1])) / parameter(car, Q_mass);
    }
    if (parameter(car, Q_sensor_lag) > 0.0) rates[3] = (x[1] - x[3]) / parameter(car, Q_sensor_lag);
    rates[1] += car->rate_fault;
}

void car_rates(const Car *car, double rates[]) {
    double all[MAX_STATES];
    rates_at(car, car->x, all);
    memcpy(rates, all, (size_t)car_states(car) * sizeof *rates);
}

void car_start(Car *car) {
    car->x[0] = parameter(car, Q_initial_position);
    car->x[1] = parameter(car, Q_initial_speed);
    car->x[2] = 0.0;
    car->x[3] = car->x[1];
    car_event(car);
}

double car_get(const Car *car, Quantity quantity) {
    double rates[MAX_STATES];
    switch (quantity) {
        case Q_speed: if (car->speed_stands) return car->stood;
            if (parameter(car, Q_sensor_lag) > 0.0) return car->x[3] + car->added[Q_speed];
            return (car_is_static(car) ? car->value[Q_speed_setpoint] : car->x[1]) + car->added[Q_speed];
        case Q_position: {
            double quantum = parameter(car, Q_position_step), at = car->x[0] + car->added[Q_position];
            if (car->position_stands) return car->stood;
            return quantum > 0.0 ? quantum * floor(at / quantum) : at;
        }
        case Q_acceleration: rates_at(car, car->x, rates); return rates[1] + car->added[Q_acceleration];
        case Q_wheel_force: return force_at(car, car->x);
        case Q_gear: return car->shifted ? 2.0 : 1.0;
        case Q_clock: return car->time;
        case Q_state_position: return car->x[0];
        case Q_state_speed: return car->x[1];
        case Q_state_force: return car->x[2];
        case Q_rate_position: rates_at(car, car->x, rates); return rates[0];
        case Q_rate_speed: rates_at(car, car->x, rates); return rates[1];
        case Q_rate_force: rates_at(car, car->x, rates); return rates[2];
        case Q_indicator: return car_indicator(car);
        default: return car->value[quantity];
    }
}

/* ---- events: the brake takes hold at v = 0 and lets go; the gear shifts at a time or a speed ---- */

double car_indicator(const Car *car) {
    return (car->held ? -force_at(car, car->x) : car->x[1]) + SLACK;
}

/* Whether the standing car leaves its place: its brake is released, or weaker than what pulls. */
static bool leaves(const Car *car, const double x[]) {
    double force = force_at(car, x);
    return force > 0.0 ? force + pull(car, 0.0) != 0.0 : fabs(pull(car, 0.0)) > -force;
}

static bool shifts(const Car *car) {
    return !car->shifted && ((parameter(car, Q_gear_time) > 0.0 && car->time >= parameter(car, Q_gear_time)) ||
                             (parameter(car, Q_gear_speed) > 0.0 && car->x[1] >= parameter(car, Q_gear_speed)));
}

bool car_wants_event(const Car *car) { return shifts(car); }

bool car_event(Car *car) {
    if (shifts(car)) car->shifted = true;
    if (parameter(car, Q_holds) == 0.0) return false;
    bool pushes = leaves(car, car->x);
    if (car->held && pushes) car->held = false;
    if (car->held || pushes || car->x[1] > 0.0) return false;
    bool moved = car->x[1] != 0.0;
    car->held = true;
    car->x[1] = 0.0;
    return moved;
}

/* ---- integration ---- */

static void runge_kutta(const Car *car, const double x[], double h, double next[]) {
    static const double weights[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}, nodes[4] = {0.0, 0.5, 0.5, 1.0};
    double rates[MAX_STATES] = {0}, at[MAX_STATES];
    memcpy(next, x, sizeof at);
    for (int stage = 0; stage < 4; ++stage) {
        for (int i = 0; i < MAX_STATES; ++i) at[i] = x[i] + nodes[stage] * h * rates[i];
        rates_at(car, at, rates);
        for (int i = 0; i < MAX_STATES; ++i) next[i] += weights[stage] * h * rates[i];
    }
}

static bool crossed(const Car *car, const double x[]) {
    if (parameter(car, Q_holds) == 0.0) return false;
    return car->held ? leaves(car, x) : x[1] < 0.0 && !leaves(car, x);
}

/* One sub-step of at most h; returns how long it was: an event ends it. */
static double advance(Car *car, double h) {
    double next[MAX_STATES];
    runge_kutta(car, car->x, h, next);
    if (crossed(car, next)) {
        double before = 0.0, after = h;
        for (int i = 0; i < 60 && after - before > 0.0; ++i) {
            double middle = 0.5 * (before + after);
            runge_kutta(car, car->x, middle, next);
            if (crossed(car, next)) after = middle; else before = middle;
        }
        h = after;
        runge_kutta(car, car->x, h, next);
    }
    memcpy(car->x, next, sizeof next);
    car->time += h;
    car_event(car);
    return h;
}

void car_step(Car *car, double time, double step) {
    double end = time + step;
    car->time = time;
    car_event(car); /* the inputs may have changed */
    if (car_is_static(car)) {
        car->x[0] += step * car->value[Q_speed_setpoint];
    } else if (car->euler) {
        double rates[MAX_STATES];
        rates_at(car, car->x, rates);
        for (int i = 0; i < MAX_STATES; ++i) car->x[i] += step * rates[i];
        car_event(car);
    } else {
        double left = step, shift = parameter(car, Q_gear_time);
        for (int events = 0; left > 0.0 && events < 1000000; ++events) {
            double h = left < SUBSTEP ? left : SUBSTEP;
            if (!car->shifted && shift > car->time && shift < car->time + h) h = shift - car->time;
            left -= advance(car, h);
        }
    }
    car->time = end;
    car_event(car);
}
