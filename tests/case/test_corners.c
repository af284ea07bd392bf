/* SPDX-License-Identifier: BSD-3-Clause */
/* Corner cases of arguments of cases, jobs and measures: the last of several conditions, and
 * invalid arguments. */
#include "body.h"
#include "build_kit.h"
#include "job_fixture.h"
#include <mps/case.h>
#include <sys/stat.h>

#define TOP   "mps: 1\ndp: 50 mm\n"
#define TANK  TOP "tank: {size: 1 0.6 m}\n"
#define WATER "fill: [{water: {depth: 0.3 m}}]\n"
#define END   "run: {until: 8 ms, dt: 4 ms, threads: 1}\n"

/* ---- numbers and names */

/* All blanks part numbers; an exponent has digits. */
static void numbers(void **state)
{
    built t;
    (void)state;
    built_make(&t, TOP "tank: {size: \"1\\t.06e+1\\r\\n m\"}\n" WATER END, NULL);
    same_number(t.b.tank.size[0], 1, 0);
    same_number(t.b.tank.size[1], 0.6, 1e-15);
    built_free(&t);
    built_make(&t, TOP "tank: {size: 1E0 6e-1 m}\n" WATER END, NULL);
    same_number(t.b.tank.size[0], 1, 0);
    same_number(t.b.tank.size[1], 0.6, 1e-15);
    built_free(&t);
    kit_refused(TOP "tank: {size: 1 1e+ m}\n" WATER END, 3, 14, "tank.size");
    kit_refused(TOP "tank: {size: 1 1e- m}\n" WATER END, 3, 14, "tank.size");
    kit_refused(TOP "tank: {size: 1 1e.5 m}\n" WATER END, 3, 14, "tank.size");
}

/* Of several similar names the nearest is suggested. */
static void nearest_fluid(void **state)
{
    static const char one[] = "{density: 900 kg/m3, viscosity: 1 mPa s}";
    char text[600];
    (void)state;
    for (int k = 0; k < 2; k++) {
        snprintf(text, sizeof text,
                 TANK
                 "fluids:\n  %s: %s\n  %s: %s\n  far: %s\nfill: [{lngs: {depth: 0.3 m}}]\n" END,
                 k ? "lng" : "ling", one, k ? "ling" : "lng", one, one);
        built_refused(text, 8, "no fluid has the name 'lngs'; did you mean 'lng'?");
    }
}

/* Fluids of one density on one line, and on two. */
static void order_of_fluids(void **state)
{
    static const char *const fill[] = {
        "fill: [{a: {box: [0 0 m, 1 0.2 m]}}, {b: {box: [0 0.2 m, 1 0.4 m]}}]\n",
        "fill:\n  - a: {box: [0 0 m, 1 0.2 m]}\n  - b: {box: [0 0.2 m, 1 0.4 m]}\n"};
    char text[600];
    built t;
    (void)state;
    for (int k = 0; k < 2; k++) {
        snprintf(text, sizeof text,
                 TANK "fluids:\n  b: {density: 900 kg/m3, viscosity: 1 mPa s, tension: 20 mN/m}\n"
                      "  a: {density: 900 kg/m3, viscosity: 1 mPa s, tension: 20 mN/m}\n%s" END,
                 fill[k]);
        built_make(&t, text, NULL);
        assert_int_equal(t.b.fluids, 2);
        assert_string_equal(t.b.fluid[0].name, "a");
        assert_string_equal(t.b.fluid[1].name, "b");
        built_free(&t);
    }
}

/* ---- files */

/* A folder and a file that is too large are no tables. */
static void no_tables(void **state)
{
    char path[600], text[1400];
    (void)state;
    for (int k = 0; k < 2; k++) {
        kit_here(path, sizeof path, k ? "corners_large.csv" : "corners_folder");
        if (k == 0) mkdir(path, 0777);
        FILE *file = k ? fopen(path, "wb") : NULL;
        if (k) assert_true(file && ftruncate(fileno(file), (off_t)1 << 30) == 0);
        if (file) fclose(file);
        snprintf(text, sizeof text, TANK WATER "motion: {file: %s, columns: {surge: x}}\n" END,
                 path);
        built_refused(text, 5,
                      k ? "a line of more than 16777216 bytes" : "corners_folder: it is a folder");
        remove(path);
    }
}

/* ---- output of a check */

static char *logged(const char *case_text)
{
    mps_case *c = NULL;
    char *text = NULL, *sketch = NULL;
    const mps_status status = kit_read(case_text, NULL, &c);
    if (status != MPS_OK || mps_case_check(c, &text, &sketch) != MPS_OK)
        fail_msg("%s", kit_messages(c));
    free(sketch);
    mps_case_destroy(c);
    return text;
}

static void tells(const char *case_text, const char *wanted)
{
    char *text = logged(case_text);
    if (!strstr(text, wanted)) fail_msg("wanted: %s\n%s", wanted, text);
    free(text);
}

/* Solids in the surface are ordered by position; a solid that does not extend from side to side
 * divides nothing. */
static void solids_in_the_surface(void **state)
{
    (void)state;
    tells(
        TANK WATER
        "solids:\n  right: {plate: [0.8 0 m, 0.8 0.5 m]}\n  block: {box: [0.3 0 m, 0.5 0.5 "
        "m]}\n  deep: {plate: [0.1 0 m, 0.1 0.1 m]}\n" END,
        "surface   solid 'block' stands in it, x = 0.3 .. 0.5 m\n          solid 'right' stands in "
        "it, x = 0.8 m\n");
    char *text = logged(
        "mps: 1\ndim: 3\ndp: 0.1 m\ntank: {size: 2 1 1 m}\nfill: [{water: {depth: 0.5 "
        "m}}]\nsolids:\n  post: {box: [1 0 0.3 m, 1.2 0.8 0.6 m]}\n" END);
    assert_non_null(strstr(text, "not from side to side"));
    assert_null(strstr(text, "longest open stretch"));
    free(text);
}

/* ---- motions */

/* A spectrum of which a part is within the 6000 harmonics that are the most. */
static void part_of_a_spectrum(void **state)
{
    char text[2000];
    (void)state;
    size_t used = (size_t)snprintf(text, sizeof text, TANK WATER "motion:\n  roll:\n");
    for (int k = 0; k < 7; k++)
        used += (size_t)snprintf(
            text + used, sizeof text - used,
            "    - {jonswap: {significant: 1 deg, peak: 1 s, components: 900}}\n");
    snprintf(text + used, sizeof text - used, END);
    built_refused(text, 13, "more than 6000 harmonics");
}

/* ---- rigid bodies */

#define BODY2 TANK WATER "body: {forward: z, "
#define BODY3                                                                             \
    "mps: 1\ndim: 3\ndp: 0.2 m\ntank: {size: 2 1 1 m}\nfill: [{water: {depth: 0.4 m}}]\n" \
    "body: {forward: x, "

static void wrong_bodies(void **state)
{
    char path[600], text[1600];
    (void)state;
    built_refused(BODY2 "mass: 1 kg, inertia: 1 2 3 kg m2, roll: {period: 1 s}}\n" END, 5,
                  "body.inertia: in 2-D it is one number");
    built_refused(BODY3 "mass: 1 kg, inertia: 1 2 kg m2, roll: {period: 1 s}}\n" END, 6,
                  "body.inertia: in 3-D it is three numbers");
    built_refused(BODY2 "mass: 1 kg, roll: {period: 1 s}}\n" END, 5,
                  "body.roll.period: needs a mass, or an inertia");
    built_refused(BODY2 "mass: 0 kg, sway: {stiffness: 1 kN/m, damping: 5 %}}\n" END, 5,
                  "body.sway.damping: a share needs a mass and a stiffness");
    built_refused(BODY2 "mass: 1 kg, sway: {damping: 5 %}}\n" END, 5,
                  "body.sway.damping: a share needs a mass and a stiffness");
    built_refused(BODY2 "mass: 1 kg}\n" END, 5,
                  "body: no degree is free; give surge, sway, heave, roll, pitch or yaw");
    kit_here(path, sizeof path, "corners_load.csv");
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int k = 0; k <= 8; k++) /* the first line names the columns */
        if (k == 0)
            fputs("t[s],Y[N],N[N m]\n", file);
        else
            fprintf(file, "%g,%d,0\n", 0.25 * (k - 1), k * k);
    assert_int_equal(fclose(file), 0);
    snprintf(text, sizeof text,
             BODY2
             "mass: 1 kg, sway: {stiffness: 1 kN/m}, load: {file: %s, columns: {sway: Y, roll: "
             "N}}}\n" END,
             path);
    built_refused(text, 5, "body.load: roll is not free; give 'body.roll'");
    /* between rows the load is linear, before and after them constant */
    built t;
    snprintf(text, sizeof text,
             BODY2
             "mass: 1 kg, sway: {stiffness: 1 kN/m}, load: {file: %s, columns: {sway: Y}}}\n" END,
             path);
    built_make(&t, text, NULL);
    const mps_body *body = &t.b.body->body;
    for (int k = 0; k <= 20; k++) {
        const double at = 0.1 * k, row = fmin(fmax(at / 0.25, 0), 7), low = floor(fmin(row, 6)),
                     wanted = (low + 1) * (low + 1) + (row - low) * (2 * low + 3);
        double load[6] = {0};
        assert_int_equal(body->load(body->user, at, NULL, load), 0);
        same_number(fabs(load[0] + load[2]), wanted, 1e-9 * wanted);
    }
    built_free(&t);
    remove(path);
}

/* The liquid as a rigid mass, with which a check reports the periods: in a chamfered tank by its
 * particles. */
static void frozen_liquid(void **state)
{
    static const char *const tank[] = {"size: 1 0.6 m", "size: 1 0.6 m, chamfer: {top: 0.1 0.1 m}"};
    double period[2];
    char text[600];
    (void)state;
    for (int k = 0; k < 2; k++) {
        snprintf(text, sizeof text,
                 TOP "tank: {%s}\n" WATER "body: {centre: 0.5 0 m, forward: z, mass: 100 kg, "
                     "inertia: 20 kg m2, roll: {stiffness: 4 kN m/rad}}\n" END,
                 tank[k]);
        char *all = logged(text);
        const char *found = strstr(all, "with the liquid frozen ");
        if (!found || sscanf(found, "with the liquid frozen %lf s", &period[k]) != 1)
            fail_msg("%s", all);
        assert_true(period[k] > 0);
        free(all);
    }
    same_number(period[1], period[0], 0.02 * period[0]);
}

/* ---- solids */

/* A solid from a file keeps the liquid away. */
static void solid_of_a_file(void **state)
{
    static const char text[] =
        "mps: 1\ndim: 3\ndp: 0.25 m\ntank: {size: 3 2 2 m}\nfill: [{water: {depth: 1.5 m}}]\n"
        "solids: {pump: {stl: " CASES "cube.stl, unit: m, shift: 1 0 0 m}}\n" END;
    built t;
    (void)state;
    built_make(&t, text, NULL);
    assert_int_equal(t.b.solids, 1);
    assert_true(t.b.solid[0].file);
    assert_true(mps_part_find(t.b.sim, "pump") >= 0);
    built_free(&t);
}

/* ---- jobs */

/* Options of a program apply in addition to the case. */
static void options_of_a_job(void **state)
{
    mps_case *c = NULL;
    mps_job *job = NULL;
    mps_sim *sim = NULL;
    mps_job_config config = config_of("corners");
    char error[1000] = "";
    (void)state;
    config.overwrite = config.profile = config.film = config.trace = 1;
    config.name = "given";
    config.error = error;
    config.error_size = sizeof error;
    assert_int_equal(kit_read(TANK WATER END "output: {frames: 0, page: 0 MB}\n", NULL, &c),
                     MPS_OK);
    if (mps_case_job(c, &config, &job, &sim) != MPS_OK) fail_msg("%s%s", error, kit_messages(c));
    assert_int_equal(mps_job_run(job, sim), MPS_EXIT_OK);
    ASSERT_SAID("no film: the run has no frames");
    ASSERT_SAID("given: t = 0.008 s, 2 steps");
    assert_non_null(strstr(text_of("corners", "summary.json"), "\"case\": \"given\""));
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    mps_case_destroy(c);
}

/* Measures that a simulation cannot have, and a box of which nothing is to the right of x = 0: it
 * has cells all the same. */
static void measures(void **state)
{
    const double box[6] = {-0.5, 0, 0, -0.1, 0.4, 0};
    mps_measure_info info = {0};
    mps_job_column column = {0};
    double value = 0;
    mps_measure m;
    const mps_job_config c = config_of("corners_measures");
    mps_job *job = job_of(&c);
    mps_sim *sim = water();
    (void)state;
    assert_int_equal(mps_measure_info_get(0, &info), MPS_E_ARG);
    assert_int_equal(mps_measure_init(&m, sizeof m), MPS_OK);
    m.measure = "front";
    m.name = "left";
    memcpy(m.box, box, sizeof box);
    assert_int_equal(mps_job_measure_add(job, sim, &m), MPS_OK);
    assert_int_equal(mps_job_column_get(job, 0, &column), MPS_E_ARG);
    assert_int_equal(mps_job_column_get(job, 0, NULL), MPS_E_ARG);
    assert_int_equal(mps_job_column_read(job, NULL, 0, &value), MPS_E_ARG);
    assert_int_equal(mps_job_column_read(job, sim, 0, NULL), MPS_E_ARG);
    assert_int_equal(mps_job_column_read(job, sim, -1, &value), MPS_E_ARG);
    assert_int_equal(mps_job_column_read(NULL, sim, 0, &value), MPS_E_ARG);
    assert_int_equal(mps_job_column_read(job, sim, 0, &value), MPS_OK);
    assert_true(value > 0 && value < 0.1); /* of the first cells, which are two spacings wide */
    m.name = "wrong";
    m.smoothing = 4;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "smoothing");
    m.smoothing = 2;
    m.phase = -1;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "phase");
    m.phase = 0;
    m.axis = -1;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "axis");
    m.axis = 0;
    m.box[3] = NAN;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "lo <= hi");
    m.box[3] = INFINITY;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "lo <= hi");
    m.box[3] = -1;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "lo <= hi");
    mps_sim_destroy(sim);
    mps_job_destroy(job);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(numbers),
                                       cmocka_unit_test(nearest_fluid),
                                       cmocka_unit_test(order_of_fluids),
                                       cmocka_unit_test(no_tables),
                                       cmocka_unit_test(solids_in_the_surface),
                                       cmocka_unit_test(part_of_a_spectrum),
                                       cmocka_unit_test(wrong_bodies),
                                       cmocka_unit_test(frozen_liquid),
                                       cmocka_unit_test(solid_of_a_file),
                                       cmocka_unit_test(options_of_a_job),
                                       cmocka_unit_test(measures)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
