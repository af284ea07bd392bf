/* SPDX-License-Identifier: BSD-3-Clause */
/* mps coefficients: forced oscillations of a tank, one run for each degree of freedom and
 * frequency, and a slow tilt for each angle. */
#include "coefficients.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROLL = 3, TEXT_SIZE = 512, MOTION_SIZE = 2048, TILT_ROWS = 241, PERIODS_USUAL = 12 };

/* Default w/w1. At 1 the waves grow until they break. */
static const double RATIOS[] = {0.5,  0.6, 0.7,  0.8, 0.85, 0.9, 0.95,
                                1.05, 1.1, 1.15, 1.2, 1.3,  1.4, 1.5};

/* A slow tilt [T1]: at rest, tilted between the first and the second time, fixed until the third;
 * loads are means over whole periods. */
static const double TILT_BEGIN = 4, TILT_END = 12, TILT_UNTIL = 16, TILT_ANGLE = 1;

/* ---- requested runs ---- */

/* Each line of the text of a case ends with '\n'. */
static const char *next_line(const char *line)
{
    return line + strcspn(line, "\n") + 1;
}

/* The next line of the block of a key, " centre: 0 0 m"; NULL: end of the block.
 * @param line  NULL: the first */
static const char *block_line(const mps_case *tank, const char *key, const char *line)
{
    const size_t length = strlen(key);
    if (!line) {
        line = mps_case_text(tank);
        while (*line && (strncmp(line, key, length) != 0 || line[length] != ':'))
            line = next_line(line);
        if (!*line) return NULL;
    }
    /* indented by two blanks */
    for (line = next_line(line); *line == ' '; line = next_line(line))
        if (line[2] != ' ') return line;
    return NULL;
}

/* Centre and axes of the motion, or of the body; degrees of freedom that it moves, if the user
 * names none.
 * @return false: the buffer is too small */
static bool read_block(coefficients *k, const mps_case *tank, const char *key)
{
    static const char *const kept[] = {"centre", "axes", "forward", "order"};
    size_t used = strlen(k->motion);
    for (const char *line = block_line(tank, key, NULL); line; line = block_line(tank, key, line)) {
        const char *name = line + 2;
        const size_t length = strcspn(name, ":"), end = strcspn(name, "\n");
        const int32_t degree = forced_degree(name, length);
        for (int i = 0; i < 4; i++)
            if (strlen(kept[i]) == length && strncmp(kept[i], name, length) == 0)
                used += (size_t)snprintf(k->motion + used, sizeof k->motion - used, "%.*s, ",
                                         (int)end, name);
        if (used >= sizeof k->motion) return false;
        if (degree >= 0 && !k->c->degrees) k->degree[k->degrees++] = degree;
    }
    return true;
}

static int refuse(const coefficients *k, const char *what, const char *why)
{
    fprintf(stderr, "mps %s: %s: %s\n", k->c->verb, what, why);
    return MPS_EXIT_USAGE;
}

static int no_memory(const coefficients *k)
{
    fprintf(stderr, "mps %s: %s: an allocation failed\n", k->c->verb, k->c->file[0]);
    return MPS_EXIT_FAILED;
}

/* Parse "surge roll". @return -1, or the exit code */
static int read_degrees(coefficients *k)
{
    const char *at = k->c->degrees;
    char name[TEXT_SIZE];
    while (at && *(at += strspn(at, ", "))) { /* without --degrees those of the case */
        const size_t length = strcspn(at, ", ");
        const int32_t degree = forced_degree(at, length);
        snprintf(name, sizeof name, "--degrees: '%.*s'", (int)length, at);
        if (degree < 0)
            return refuse(k, name, "no degree; there are surge, sway, heave, roll, pitch and yaw");
        for (int32_t i = 0; i < k->degrees; i++)
            if (k->degree[i] == degree) return refuse(k, name, "this degree is named twice");
        k->degree[k->degrees++] = degree;
        at += length;
    }
    if (k->degrees > 0) return -1;
    return refuse(k, k->c->file[0],
                  "the case moves no degree by harmonics; name some, e.g. --degrees 'surge roll'");
}

/* "motion={centre: 0 0 m, surge: {slope: 0.25 deg, period: 0.8 T1, ramp: 4}}" */
static void motion_text(const coefficients *k, int32_t degree, const char *frequency, int32_t ramp,
                        char out[MOTION_SIZE])
{
    const char *size = k->c->amplitude ? k->c->amplitude : "0.25 deg";
    const bool angle = strstr(size, "deg") || strstr(size, "rad");
    snprintf(out, MOTION_SIZE, "motion={%s%s: {%s: %s, %s, ramp: %d}}", k->motion,
             forced_names[degree], angle && degree < ROLL ? "slope" : "amplitude", size, frequency,
             (int)ramp);
}

/* Whether the reader refuses the amplitude of a motion; other messages concern the case and are
 * left to the runs. */
static bool amplitude_fails(const mps_case *c, int32_t degree)
{
    char size[64], slope[64];
    mps_case_message m = {.struct_size = sizeof m};
    snprintf(size, sizeof size, "motion.%s.amplitude", forced_names[degree]);
    snprintf(slope, sizeof slope, "motion.%s.slope", forced_names[degree]);
    for (int32_t i = 0; i < mps_case_message_count(c); i++)
        if (mps_case_message_get(c, i, &m) == MPS_OK && !m.warning &&
            (strstr(m.text, size) || strstr(m.text, slope)))
            return true;
    return false;
}

/* Check the amplitude in each moving degree of freedom before the first run.
 * @return -1, or the exit code */
static int check_amplitude(const coefficients *k)
{
    static const char *const allowed[2] = {
        "it must be a length or an angle, and not 0, e.g. '2 mm' or '0.25 deg'",
        "it must be an angle, and not 0, e.g. '0.25 deg'"};
    const char *size = k->c->amplitude;
    char motion[MOTION_SIZE], what[MOTION_SIZE];
    if (!size) return -1;
    for (int32_t at = 0; at < k->degrees; at++) {
        const int32_t degree = k->degree[at];
        choices one = *k->c;
        mps_case *tank = NULL;
        motion_text(k, degree, "period: 1 s", 1, motion);
        one.set[one.sets++] = motion;
        const mps_status status = cli_open(&one, &tank);
        /* one value, without further keys of the motion */
        const bool bad = size[strcspn(size, ",:#{}[]\"'\n")] || !(fabs(strtod(size, NULL)) > 0) ||
                         amplitude_fails(tank, degree);
        mps_case_destroy(tank);
        if (status == MPS_E_NOMEM) return no_memory(k);
        snprintf(what, sizeof what, "--amplitude: %s: '%.200s'", forced_names[degree], size);
        if (bad) return refuse(k, what, allowed[degree >= ROLL]);
    }
    return -1;
}

/* Read frequencies as a sweep, which the reader checks. @return -1, or the exit code */
static int read_frequencies(coefficients *k)
{
    char motion[MOTION_SIZE], sweep[MOTION_SIZE], list[TEXT_SIZE] = "", got[TEXT_SIZE];
    const choices *c = k->c;
    choices one = *c;
    size_t used = 0;
    int code = MPS_EXIT_FAILED;
    for (size_t i = 0; i < sizeof RATIOS / sizeof *RATIOS; i++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%.9g ", 1 / RATIOS[i]);
    snprintf(list + used, sizeof list - used, "T1");
    const char *key = c->omega ? "omega" : "period", *values = c->omega    ? c->omega
                                                               : c->period ? c->period
                                                                           : list;
    if (c->omega && c->period) return refuse(k, "--omega", "give it or --period, not both");
    motion_text(k, k->degree[0], "period: 1 s", 1, motion);
    snprintf(sweep, sizeof sweep, "sweep={motion.%s.%s: %s}", forced_names[k->degree[0]], key,
             values);
    one.set[one.sets++] = motion;
    one.set[one.sets++] = sweep;
    mps_case *tank = cli_case(&one, &code);
    if (!tank) return code;
    k->count = mps_case_runs(tank) > FREQUENCIES_MOST ? FREQUENCIES_MOST + 1
                                                      : (int32_t)mps_case_runs(tank);
    mps_status status = MPS_OK;
    for (int32_t n = 0; n < k->count && n < FREQUENCIES_MOST && status == MPS_OK; n++) {
        status = mps_case_sweep_get(tank, n, 0, got, sizeof got);
        snprintf(k->frequency[n], sizeof k->frequency[n], "%s: %s", key,
                 got + strcspn(got, "=") + 1);
    }
    mps_case_destroy(tank);
    if (status != MPS_OK) return no_memory(k);
    return k->count > FREQUENCIES_MOST ? refuse(k, values, "more than 200 frequencies") : -1;
}

/* ---- the runs ---- */

/* Number of measured periods: more if the beat of forced and free wave is slow. */
static int32_t periods_of(const coefficients *k, int32_t n)
{
    const int least = 8, most = 24;
    char *unit;
    if (k->c->periods > 0) return k->c->periods;
    const double value = strtod(strchr(k->frequency[n], ':') + 1, &unit);
    if (strcmp(unit, " T1") != 0) return PERIODS_USUAL;
    return (int32_t)fmin(most, fmax(least, ceil(1.2 / fabs(1 - 1 / value))));
}

/* So many periods as a time. */
static void until_text(const coefficients *k, int32_t n, double periods, char out[TEXT_SIZE])
{
    char *unit;
    const double value = strtod(strchr(k->frequency[n], ':') + 1, &unit);
    if (k->frequency[n][0] == 'p')
        snprintf(out, TEXT_SIZE, "run.until=%.9g%s", periods * value, unit);
    else
        snprintf(out, TEXT_SIZE, "run.until=%.9g s",
                 periods * (strstr(unit, "deg") ? 360 : 2 * acos(-1.0)) / value);
}

/* A run with this motion, its loads and all its steps. */
static int run_motion(const coefficients *k, int32_t index, int32_t runs, const char *motion,
                      const char *until)
{
    char folder[SERIES_PATH];
    choices one = *k->c;
    series_folder(k->place, index, folder);
    one.set[one.sets++] = motion;
    one.set[one.sets++] = until;
    one.set[one.sets++] = "sensors.liquid={load: momentum}";
    one.set[one.sets++] = "sensors.walls={load: walls}";
    one.set[one.sets++] = "output.trace=yes";
    if (!k->c->quiet)
        fprintf(stderr, "mps %s: run %d of %d: %s\n", k->c->verb, (int)index + 1, (int)runs,
                motion);
    bool busy;
    const int code = series_run(&one, folder, &busy);
    if (code != MPS_EXIT_OK)
        fprintf(stderr, "mps %s: %s %s, exit code %d\n", k->c->verb, folder,
                code == MPS_EXIT_INTERRUPTED ? "was interrupted" : "failed", code);
    return code;
}

static int run_forced(coefficients *k, int32_t at, int32_t n, int32_t runs)
{
    char motion[MOTION_SIZE], until[TEXT_SIZE], folder[SERIES_PATH];
    const int32_t index = at * k->count + n, periods = periods_of(k, n), ramp = (periods + 1) / 2;
    motion_text(k, k->degree[at], k->frequency[n], ramp, motion);
    until_text(k, n, ramp + 1 + periods, until);
    const int code = run_motion(k, index, runs, motion, until);
    if (code != MPS_EXIT_OK) return code;
    series_folder(k->place, index, folder);
    const bool read = forced_read(k->c, folder, k->degree[at], periods, &k->result[index]);
    return read ? MPS_EXIT_OK : MPS_EXIT_FAILED;
}

/* Write the table of a slow tilt. */
static bool write_tilt(const char *path, const char *name, double T1)
{
    FILE *out = fopen(path, "w");
    if (!out) return false;
    fprintf(out, "time[s],%s[deg]\n0,0\n", name);
    for (int i = 0; i < TILT_ROWS; i++) {
        const double s = (double)i / (TILT_ROWS - 1);
        fprintf(out, "%.9g,%.9g\n", T1 * (TILT_BEGIN + s * (TILT_END - TILT_BEGIN)),
                TILT_ANGLE * s * s * s * (10 + s * (-15 + 6 * s)));
    }
    fprintf(out, "%.9g,%.9g\n", T1 * (TILT_UNTIL + 1), TILT_ANGLE);
    int failed = ferror(out);
    failed |= fclose(out);
    return failed == 0;
}

/* Quote a YAML text in single quotes: those inside are doubled.
 * @param out  [twice the text and 3] */
static void quote(const char *text, char *out)
{
    *out++ = '\'';
    for (; *text; text++) {
        if (*text == '\'') *out++ = '\'';
        *out++ = *text;
    }
    *out++ = '\'';
    *out = '\0';
}

/* Compute C of an angle. @param T1  [s] */
static int run_tilt(coefficients *k, int32_t at, int32_t index, int32_t runs, double T1)
{
    const double from[2] = {T1, T1 * (TILT_UNTIL - 3)}, until[2] = {T1 * 4, T1 * TILT_UNTIL};
    char motion[2 * MOTION_SIZE], path[SERIES_PATH + 32], quoted[2 * sizeof path + 1],
        end[TEXT_SIZE], folder[SERIES_PATH];
    double C[FORCED_DEGREES];
    const char *name = forced_names[k->degree[at]];
    snprintf(path, sizeof path, "%s/tilt_%s.csv", k->place, name);
    quote(path, quoted);
    snprintf(motion, sizeof motion, "motion={%s%sfile: %s, columns: {%s: %s}}", k->motion,
             strstr(k->motion, "axes:") ? "" : "axes: 'x forward, y up, z starboard', ", quoted,
             name, name);
    snprintf(end, sizeof end, "run.until=%.9g s", T1 * TILT_UNTIL);
    if (!write_tilt(path, name, T1)) return refuse(k, path, strerror(errno));
    const int code = run_motion(k, index, runs, motion, end);
    series_folder(k->place, index, folder);
    if (code != MPS_EXIT_OK) return code;
    if (!forced_tilt_read(k->c, folder, from, until, TILT_ANGLE * acos(-1.0) / 180, C))
        return MPS_EXIT_FAILED;
    for (int32_t i = 0; i < FORCED_DEGREES; i++) k->C[i][k->degree[at]] = C[i];
    return MPS_EXIT_OK;
}

/* T1 of the case, else the longest period. */
static double tilt_time(const coefficients *k)
{
    double longest = NAN;
    for (int32_t i = 0; i < k->degrees * k->count; i++) {
        if (!isfinite(k->result[i].omega)) continue;
        if (isfinite(k->result[i].T1)) return k->result[i].T1;
        longest = fmax(longest, 2 * acos(-1.0) / k->result[i].omega);
    }
    return longest;
}

/* Add the restoring term of a tilt to A. */
static void take_restoring(coefficients *k)
{
    for (int32_t at = 0; at < k->degrees; at++)
        for (int32_t n = 0; n < k->count; n++) {
            forced *f = &k->result[at * k->count + n];
            for (int32_t i = 0; i < FORCED_DEGREES; i++) {
                f->A[i] += k->C[i][k->degree[at]] / (f->omega * f->omega);
                f->walls[i] += k->C[i][k->degree[at]] / (f->omega * f->omega);
            }
        }
}

/* @return the worst exit code */
static int run_all(coefficients *k)
{
    const int32_t forced_runs = k->degrees * k->count;
    int32_t runs = forced_runs, tilts = 0;
    int worst = MPS_EXIT_OK;
    for (int32_t at = 0; at < k->degrees; at++) runs += k->degree[at] >= ROLL;
    for (int32_t i = 0; i < forced_runs && worst != MPS_EXIT_INTERRUPTED; i++) {
        const int code = run_forced(k, i / k->count, i % k->count, runs);
        if (code > worst) worst = code;
    }
    const double T1 = tilt_time(k);
    for (int32_t at = 0; at < k->degrees && worst != MPS_EXIT_INTERRUPTED && T1 > 0; at++) {
        if (k->degree[at] < ROLL) continue;
        const int code = run_tilt(k, at, forced_runs + tilts++, runs, T1);
        if (code > worst) worst = code;
    }
    take_restoring(k);
    return worst;
}

static int do_all(coefficients *k)
{
    k->result = calloc((size_t)k->degrees * (size_t)k->count, sizeof *k->result);
    if (!k->result) return no_memory(k);
    for (int32_t i = 0; i < k->degrees * k->count; i++) k->result[i].omega = NAN;
    for (int32_t at = 0; at < k->degrees; at++) /* translations: 0; rotations: not known yet */
        for (int32_t i = 0; i < FORCED_DEGREES; i++)
            k->C[i][k->degree[at]] = k->degree[at] < ROLL ? 0 : NAN;
    const int worst = run_all(k);
    bool any = false;
    for (int32_t i = 0; i < k->degrees * k->count; i++) any = any || isfinite(k->result[i].omega);
    coefficients_sort(k);
    if (any) coefficients_print(k);
    const int saved = any ? coefficients_save(k) : MPS_EXIT_OK;
    free(k->result);
    return worst != MPS_EXIT_OK ? worst : saved;
}

int verb_coefficients(const choices *c)
{
    static coefficients k;
    char dim[8] = "2", folder[SERIES_PATH];
    int code = MPS_EXIT_FAILED;
    k = (coefficients){.c = c};
    mps_case *tank = cli_case(c, &code);
    if (!tank) return code;
    series_place(c, k.place);
    series_key(tank, "dim", dim, sizeof dim);
    k.dim = dim[0] == '3' ? 3 : 2;
    const bool swept = mps_case_sweep_count(tank) > 0;
    const bool kept = read_block(&k, tank, "motion") && read_block(&k, tank, "body");
    mps_case_destroy(tank);
    if (!kept) return refuse(&k, c->file[0], "centre, axes, forward and order are too long");
    if (swept) return refuse(&k, c->file[0], "the case has a sweep; use 'mps sweep'");
    /* no run has a longer folder name than the last possible one */
    if (!series_folder(k.place, FORCED_DEGREES * (FREQUENCIES_MOST + 1) - 1, folder))
        return refuse(&k, "--out", "is too long");
    code = read_degrees(&k);
    if (code < 0 && c->sets + 5 > CLI_SETS) code = refuse(&k, "--set", "there are too many");
    if (code < 0) code = check_amplitude(&k);
    if (code < 0) code = read_frequencies(&k);
    return code < 0 ? do_all(&k) : code;
}
