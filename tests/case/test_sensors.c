/* SPDX-License-Identifier: BSD-3-Clause */
/* Sensors of a case as columns of probes.csv: pressures, panels, rows, gauges and forces of water
 * at rest are hydrostatic. */
#include "case_kit.h"
#include <math.h>
#include <mps/mps.h>
#include <unistd.h>

enum { CAPACITY = 16384, COLUMNS = 64 };

/* Names and last row of probes.csv. */
typedef struct table {
    char names[CAPACITY], row[CAPACITY];
    int count;
    const char *name[COLUMNS];
    double value[COLUMNS];
} table;

static void read_table(const char *folder, table *t)
{
    char path[400], line[CAPACITY];
    snprintf(path, sizeof path, "%s/probes.csv", folder);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(t->names, sizeof t->names, file));
    while (fgets(line, sizeof line, file)) memcpy(t->row, line, sizeof line);
    fclose(file);
    char *names = t->names, *row = t->row;
    for (t->count = 0; names && t->count < COLUMNS; t->count++) {
        t->name[t->count] = names;
        t->value[t->count] = strtod(row, &row);
        if (*row) row++;
        names = strpbrk(names, ",\n");
        if (names && *names == '\n') names = NULL;
        if (names) *names++ = '\0';
    }
}

static double column(const table *t, const char *name)
{
    const size_t length = strlen(name);
    for (int k = 0; k < t->count; k++)
        if (strncmp(t->name[k], name, length) == 0 && strchr("[,\n", t->name[k][length]))
            return t->value[k];
    fail_msg("no column '%s'", name);
    return NAN;
}

static void near(const table *t, const char *name, double value, double most)
{
    const double got = column(t, name);
    if (!(fabs(got - value) <= most))
        fail_msg("%s is %.9g, not %.9g +- %g", name, got, value, most);
}

static void quiet(void *user, int32_t kind, const char *text)
{
    (void)user;
    (void)kind;
    (void)text;
}

static void run(const char *text, table *t)
{
    char folder[] = "mps_sensors_XXXXXX", command[100], error[300] = "";
    mps_case *c = NULL;
    mps_job *job;
    mps_sim *sim;
    mps_job_config config;
    assert_non_null(mkdtemp(folder));
    mps_job_config_init(&config, sizeof config);
    config.folder = folder;
    config.print = quiet;
    config.error = error;
    config.error_size = sizeof error;
    kit_read(text, NULL, &c);
    const mps_status status = mps_case_job(c, &config, &job, &sim);
    char *all = kit_messages(c);
    if (status != MPS_OK) fail_msg("%s%s", all, error);
    free(all);
    assert_int_equal(mps_job_run(job, sim), MPS_EXIT_OK);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    mps_case_destroy(c);
    read_table(folder, t);
    snprintf(command, sizeof command, "rm -rf %s", folder);
    assert_int_equal(system(command), 0);
}

#define SHORT "run: {until: 0.02 s}\noutput: {frames: 0, page: 0 MB}\n"

/* 0.5 m of water; rho g = 9810 Pa/m, to 0.1 % of the pressure at the floor. */
static void space(void **state)
{
    static const double unit = 9810, most = 5;
    static table t;
    (void)state;
    run("mps: 1\ndim: 3\ndp: 50 mm\ntank: {size: 1 0.8 0.6 m}\nfill: [{water: {depth: 0.5 m}}]\n"
        "motion: {axes: 'x forward, y port, z up', roll: {amplitude: 0.00001 deg, period: 5 s}}\n"
        "sensors:\n"
        "  P: {wall: 0 0.2 m}\n"
        "  panel: {panel: [0 0.1 0.1 m, 0 0.4 0.5 m], cells: 3 2}\n"
        "  turned: {panel: [0 0.1 0.1 m, 0 0.4 0.1 m, 0 0.4 0.5 m], cells: 2}\n"
        "  one: {panel: [0 0.1 0.1 m, 0 0.4 0.5 m]}\n"
        "  top: {row: [1 0.1 0.3 m, 1 0.4 0.3 m], cells: 3}\n"
        "  mean: {row: [1 0.1 0.3 m, 1 0.4 0.3 m], cells: 3, take: mean}\n"
        "  where: {row: [1 0.1 0.3 m, 1 0.4 0.3 m], cells: 3, take: place}\n"
        "  eta: {gauge: 950 50 mm}\n"
        "  up: {gauge: 0.2 0.1 0.3 m, level: 0.4 m}\n"
        "  F: {force: tank, about: 0.4 0 0.3 m}\n"
        "  load: {force: tank, about: 0.4 0 0.3 m, axes: ship}\n"
        "  Fy: {force: tank.y0, component: y}\n"
        "  fluid: {pressure: 0.5 0.2 m}\n"
        "  x: {measure: centre of mass, axis: x}\n" SHORT,
        &t);
    near(&t, "P", 0.3 * unit, most);
    near(&t, "panel", 0.25 * unit, most);
    near(&t, "panel_1", 0.35 * unit, most);
    near(&t, "panel_6", 0.15 * unit, most);
    near(&t, "turned", 0.25 * unit, most);
    near(&t, "turned_2", 0.175 * unit, most);
    near(&t, "turned_3", 0.325 * unit, most);
    near(&t, "one", 0.25 * unit, 3 * most); /* a disc that reaches beyond the panel */
    near(&t, "top", 0.35 * unit, most);
    near(&t, "mean", 0.25 * unit, most);
    near(&t, "where", 0.05, 1e-12);
    near(&t, "eta", 0, 1e-3);
    near(&t, "up", 0.1, 1e-3);
    const double weight = 0.3 * unit;
    near(&t, "F_x", 0, 1e-3 * weight);
    near(&t, "F_y", -weight, 2e-3 * weight);
    near(&t, "F_mz", -0.1 * weight, 2e-3 * weight); /* 0.1 m behind the centre of the tank */
    near(&t, "load_heave", -weight, 2e-3 * weight);
    near(&t, "load_pitch", 0.1 * weight, 2e-3 * weight); /* bow down */
    near(&t, "load_roll", 0, 1e-3 * weight);
    near(&t, "Fy", -weight, 2e-3 * weight);
    near(&t, "fluid", 0.3 * unit, most);
    near(&t, "x", 0.5, 1e-6);
}

/* In 2-D, with a plate, and a gauge that starts on the slope of a chamfer. The rows next to the
 * slopes settle in the first 0.2 s. */
static void plane(void **state)
{
    static const double unit = 9810;
    static table t;
    (void)state;
    run("mps: 1\ndp: 20 mm\ntank: {size: 2 1 m, chamfer: {bottom: 0.4 m, top: 0.2 0.2 m}}\n"
        "solids:\n  baffle: {plate: [1 0.2 m, 1 0.4 m], thickness: 20 mm}\n"
        "fill: [{water: {depth: 0.6 m}}]\n"
        "sensors:\n"
        "  slope: {wall: 0.2 0.2 m}\n"
        "  panel: {panel: [0.1 0.3 m, 0.3 0.1 m], cells: 4}\n"
        "  eta: {gauge: 0.1 m}\n"
        "  F: {force: all}\n"
        "  drag: {force: baffle, component: x}\n"
        "  yaw: {force: all, component: mz, about: 1 0 m}\n"
        "run: {until: 0.25 s}\noutput: {frames: 0, page: 0 MB}\n",
        &t);
    const double weight = (2 * 0.6 - 0.4 * 0.4 - 0.2 * 0.02) * unit; /* without plate and slopes */
    near(&t, "slope", 0.4 * unit, 0.005 * unit);
    near(&t, "panel", 0.4 * unit, 0.005 * unit);
    near(&t, "panel_1", 0.325 * unit, 0.005 * unit);
    near(&t, "eta", 0, 4e-3);
    near(&t, "F_x", 0, 2e-3 * weight);
    near(&t, "F_y", -weight, 5e-3 * weight);
    near(&t, "drag", 0, 2e-3 * weight);
    near(&t, "yaw", 0, 2e-3 * weight);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(space), cmocka_unit_test(plane)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
