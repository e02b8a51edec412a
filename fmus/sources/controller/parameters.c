#include "parameters.h"
#include "token.h" /* MODEL_TOKEN: written by the build */

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* K_p is not the printed 300, which contradicts the paper's own steady-state error. */
static const Parameters PAPER = {.M = 1000.0,
                                 .alpha = 100.0,
                                 .dt = 0.05,
                                 .v_r = 4.0,
                                 .d_safe = 8.0,
                                 .d_margin = 0.0,
                                 .d_buffer = 10.0,
                                 .v_min = 0.0,
                                 .v_max = 20.0,
                                 .u_max = 8000.0,
                                 .du_max = 1000.0,
                                 .K_p = 2400.0,
                                 .K_i = 10.0,
                                 .K_d = 100.0,
                                 .N = 15.0,
                                 .mpc = 1.0};

/* ---- start values ----
 *
 * One binary serves every export. What differs, the start values, has to be known to the binary as well
 * as to modelDescription.xml; a host hands over exactly one text of that file at instantiation, the GUID
 * or instantiation token. So they travel in it, bit by bit, and no file has to be found and read: after
 * the build's own token, for each value that is not the paper's, a letter ('a' is M) and DIGITS digits of
 * base 64. The text stays short, as some hosts name a folder by it.
 */
enum { DIGITS = 11, LAST_BITS = 64 - 6 * (DIGITS - 1) };

static int digit_value(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '-' ? 62 : c == '_' ? 63 : -1;
}

/* The first 64 bits of the digits, the highest first. */
static bool read_double(const char *digits, double *value) {
    uint64_t bits = 0;
    for (int i = 0; i < DIGITS; ++i) {
        const int digit = digit_value(digits[i]);
        if (digit < 0) return false;
        bits = i < DIGITS - 1 ? bits << 6 | (uint64_t)digit : bits << LAST_BITS | (uint64_t)digit >> (6 - LAST_BITS);
    }
    memcpy(value, &bits, sizeof *value);
    return true;
}

bool parameters_from_token(const char *token, Parameters *p) {
    const size_t build = strlen(MODEL_TOKEN);
    if (token == NULL || strncmp(token, MODEL_TOKEN, build) != 0) return false;
    double values[PARAMETER_COUNT];
    memcpy(values, &PAPER, sizeof values);
    const char *entry = token + build;
    for (size_t left = strlen(entry); left > 0; left -= 1 + DIGITS, entry += 1 + DIGITS) {
        const int which = *entry - 'a';
        if (left < 1 + DIGITS || which < 0 || which >= PARAMETER_COUNT) return false;
        if (!read_double(entry + 1, &values[which])) return false;
    }
    memcpy(p, values, sizeof values);
    return true;
}

/* ---- checks ---- */

typedef enum { ABOVE_ZERO, NOT_BELOW_ZERO } Range;

typedef struct {
    size_t offset;
    Range range;
    const char *problem;
} Check;

static const Check CHECKS[] = {
    {offsetof(Parameters, M), ABOVE_ZERO, "M = %g kg: expected a mass above 0"},
    {offsetof(Parameters, alpha), NOT_BELOW_ZERO, "alpha = %g N.s/m: expected 0 or more"},
    {offsetof(Parameters, dt), ABOVE_ZERO, "dt = %g s: expected a time step above 0"},
    {offsetof(Parameters, v_r), ABOVE_ZERO, "v_r = %g m/s: expected a speed above 0"},
    {offsetof(Parameters, d_safe), NOT_BELOW_ZERO, "d_safe = %g m: expected 0 or more"},
    {offsetof(Parameters, d_margin), NOT_BELOW_ZERO, "d_margin = %g m: expected 0 or more"},
    {offsetof(Parameters, d_buffer), ABOVE_ZERO, "d_buffer = %g m: expected a distance above 0"},
    {offsetof(Parameters, v_min), NOT_BELOW_ZERO, "v_min = %g m/s: expected 0 or more"},
    {offsetof(Parameters, u_max), ABOVE_ZERO, "u_max = %g N: expected a force above 0"},
    {offsetof(Parameters, du_max), ABOVE_ZERO, "du_max = %g N: expected a force above 0"},
    {offsetof(Parameters, K_p), NOT_BELOW_ZERO, "K_p = %g N.s/m: expected 0 or more"},
    {offsetof(Parameters, K_i), NOT_BELOW_ZERO, "K_i = %g N/m: expected 0 or more"},
    {offsetof(Parameters, K_d), NOT_BELOW_ZERO, "K_d = %g N.s2/m: expected 0 or more"},
};

const char *parameter_problem(const Parameters *p, double *value) {
    for (size_t i = 0; i < sizeof CHECKS / sizeof *CHECKS; ++i) {
        memcpy(value, (const char *)p + CHECKS[i].offset, sizeof *value);
        const bool good = CHECKS[i].range == ABOVE_ZERO ? *value > 0.0 : *value >= 0.0;
        if (!good || !isfinite(*value)) return CHECKS[i].problem;
    }
    *value = p->v_max;
    if (!(p->v_max > p->v_min) || !isfinite(p->v_max)) return "v_max = %g m/s: expected more than v_min";
    *value = p->N;
    if (!(p->N >= HORIZON_MIN && p->N <= HORIZON_MAX && p->N == (int)p->N))
        return "N = %g: expected a whole number from 2 to 200";
    *value = p->alpha * p->dt / p->M;
    if (p->mpc != 0.0 && !(*value <= 1.0)) return "alpha dt / M = %g: expected 1 or less, or forward Euler is unstable";
    return NULL;
}
