/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of the constants of impacts: keys of a case, names and units for users, members of
 * mps_stats_config. */
#include "page_text.h"
#include "statistics.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { COUNT_MOST = 1000000 };

/* Type of a member: a real number, int32_t from 2 or from 0, the seed. */
typedef enum kind { REAL, EVENTS, COUNT, SEED } kind;

static const struct constant {
    const char *key, *about, *unit;
    size_t place;
    kind kind;
} constants[] = {
#define MEMBER(name) offsetof(mps_stats_config, name)
    {"impacts.from", "samples from", "s", MEMBER(from), REAL},
    {"impacts.until", "until", "s", MEMBER(until), REAL},
    {"impacts.rate", "rate (0: as in probes.csv)", "Hz", MEMBER(rate), REAL},
    {"impacts.high_pass", "high-pass (0: none)", "Hz", MEMBER(high_pass), REAL},
    {"impacts.threshold", "threshold", "Pa", MEMBER(threshold), REAL},
    {"impacts.deviations", "else standard deviations above the mean", "", MEMBER(deviations), REAL},
    {"impacts.window", "window", "s", MEMBER(window), REAL},
    {"", "else share of the period", "", MEMBER(window_share), REAL},
    {"T1", "period", "s", MEMBER(period), REAL},
    {"impacts.share", "rise and decay from this share of the peak", "", MEMBER(share), REAL},
    {"", "time that is resolved", "s", MEMBER(crossing_time), REAL},
    {"impacts.least_events", "least events of a fit", "", MEMBER(least_events), EVENTS},
    {"impacts.resamples", "resamples of a band", "", MEMBER(resamples), COUNT},
    {"impacts.confidence", "share of the resamples in a band", "", MEMBER(confidence), REAL},
    {"impacts.seed", "seed", "", MEMBER(seed), SEED},
    {"impacts.exposure", "exposure", "s", MEMBER(exposure), REAL},
    {"impacts.exposure_ratio", "warning beyond lengths of the record", "", MEMBER(exposure_ratio),
     REAL},
    {"impacts.dependence", "warning beyond correlation times sqrt(N)", "", MEMBER(dependence),
     REAL},
    {"impacts.scale", "length at full scale over that here", "", MEMBER(length_scale), REAL},
    {"impacts.density_ratio", "density at full scale over that here", "", MEMBER(density_ratio),
     REAL}};

enum { CONSTANTS = sizeof constants / sizeof constants[0] };

static double value_of(const mps_stats_config *config, const struct constant *k)
{
    const void *place = (const char *)config + k->place;
    return k->kind == REAL   ? *(const double *)place
           : k->kind == SEED ? (double)*(const uint64_t *)place
                             : *(const int32_t *)place;
}

mps_status mps_stats_constant_get(const mps_stats_config *config, int32_t index,
                                  mps_stats_constant *constant)
{
    if (!mps__stats_known(config, sizeof *config) ||
        !mps__stats_known(constant, sizeof *constant) || index < 0 || index >= CONSTANTS)
        return MPS_E_ARG;
    const struct constant *k = &constants[index];
    const mps_stats_constant found = {
        .key = k->key, .about = k->about, .unit = k->unit, .value = value_of(config, k)};
    mps__stats_out(constant, &found, sizeof found);
    return MPS_OK;
}

bool mps__stats_put(mps_stats_config *config, const char *key, double value)
{
    const struct constant *k = constants;
    while (k < constants + CONSTANTS && (!k->key[0] || strcmp(k->key, key) != 0)) k++;
    if (k == constants + CONSTANTS) return false;
    void *place = (char *)config + k->place;
    if (k->kind == REAL) {
        *(double *)place = value;
        return true;
    }
    if (!(value >= (k->kind == EVENTS ? 2 : 0) && value <= COUNT_MOST)) return false;
    if (k->kind == SEED)
        *(uint64_t *)place = (uint64_t)value;
    else
        *(int32_t *)place = (int32_t)value;
    return true;
}

mps_status mps__stats_put_sensors(mps_stats_config *config, const char *names)
{
    MPS__STATS_CHECK(config, strlen(names) < sizeof config->sensors,
                     "impacts.sensors: the list has more than %d bytes",
                     (int)sizeof config->sensors - 1);
    snprintf(config->sensors, sizeof config->sensors, "%s", names);
    return MPS_OK;
}

size_t mps_quantity_write(double value, const char *unit, char *buffer, size_t size)
{
    /* on the page; a terminal and a program need a hyphen */
    static const char minus[] = "\xe2\x88\x92";
    char text[TEXT_NUMBER];
    if (!unit || (!buffer && size > 0)) return 0;
    mps__quantity(text, value, unit);
    const bool negative = strncmp(text, minus, sizeof minus - 1) == 0;
    const int length = snprintf(buffer, size, "%s%s", negative ? "-" : "",
                                text + (negative ? sizeof minus - 1 : 0));
    return (size_t)length;
}
