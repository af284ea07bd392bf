/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions in a run: their largest values, their beginning, filtered tables, columns with the names
 * of a ship. */
#include "build_kit.h"
#include <unistd.h>

#define PLANE  "mps: 1\ndp: 0.1 m\ntank: {size: 0.8 0.6 m}\nfill: [{water: {depth: 0.3 m}}]\n"
#define SPACE  "mps: 1\ndim: 3\ndp: 0.2 m\ntank: {size: 2 1 1 m}\nfill: [{water: {depth: 0.4 m}}]\n"
#define AXES   "axes: 'x forward, y port, z up', "
#define SECOND "run: {until: 1 s}\n"

enum { ROWS_MOST = 4000, TEXT_MOST = 1400 };

static const double PI = 3.14159265358979323846, DEGREE = 3.14159265358979323846 / 180;

/* A table of one column in the file `name`; `value` of each row. */
static void write_rows(const char *name, const char *header, int rows, double step,
                       double (*value)(double t))
{
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    fprintf(file, "%s\n", header);
    for (int i = 0; i < rows; i++) fprintf(file, "%.9g,%.12g\n", i * step, value(i * step));
    fclose(file);
}

/* Build a case with the table, `more` behind its name: "ramp: 1 s". */
static void make(built *t, const char *head, const char *name, const char *more, const char *run)
{
    char path[600], text[TEXT_MOST];
    kit_here(path, sizeof path, name);
    snprintf(text, sizeof text, "%smotion: {%sfile: %s%s%s}\n%s", head,
             strstr(head, "dim: 3") ? AXES : "", path, more[0] ? ", " : "", more, run);
    built_make(t, text, NULL);
}

static void near(double value, double wanted, double share)
{
    if (!(fabs(value - wanted) <= share * fabs(wanted)))
        fail_msg("%.9g, not %.9g within %g", value, wanted, share);
}

/* ---- largest values ---- */

static double falling(double t)
{
    return 5 - t;
}

static double later(double t)
{
    return t < 1.5 ? 2 * t : 60;
}

static double drive(double t)
{
    return t < 1 ? t : 1;
}

/* The first row counts, rows behind the end do not; the spline passes the rows where a drive
 * stops. */
static void tables(void **state)
{
    built t;
    (void)state;
    write_rows("run_falling.csv", "time[s],roll[deg]", 4, 1, falling);
    make(&t, PLANE, "run_falling.csv", "", "run: {until: 3 s}\n");
    near(t.b.motion->largest[MPS_SHIP_ROLL][0], 5 * DEGREE, 1e-12);
    near(t.b.motion->largest[MPS_SHIP_ROLL][1], DEGREE, 1e-12);
    built_free(&t);
    write_rows("run_later.csv", "time[s],roll[deg]", 41, 0.05, later);
    make(&t, PLANE, "run_later.csv", "", SECOND);
    near(t.b.motion->largest[MPS_SHIP_ROLL][0], 2 * DEGREE, 1e-9);
    built_free(&t);
    write_rows("run_drive.csv", "time[s],surge[m]", 21, 0.1, drive);
    make(&t, PLANE, "run_drive.csv", "", "run: {until: 2 s}\n");
    double most[3] = {0};
    for (int i = 0; i <= 200000; i++) {
        mps_motion_state s = {.struct_size = sizeof s};
        assert_int_equal(mps_motion_state_at(t.b.sim, i * 1e-5, &s), MPS_OK);
        const double *q[3] = {s.value, s.rate, s.accel};
        for (int k = 0; k < 3; k++) most[k] = fmax(most[k], fabs(q[k][MPS_MOVE_X]));
    }
    assert_true(most[0] > 1.008);
    for (int k = 0; k < 3; k++) near(t.b.motion->largest[MPS_SHIP_SURGE][k], most[k], 1e-9);
    assert_true(
        kit_has(t.c, 0, 0, "surge: the velocity jumps by 1 m/s at t = 1 s|passes the rows"));
    built_free(&t);
}

/* Three angles in an unusual order, of a ship across the tank: the largest values are the requested
 * ones. */
static void orders(void **state)
{
    static const char *const name[] = {"surge", "roll", "pitch", "yaw"};
    static const int32_t degree[] = {MPS_SHIP_SURGE, MPS_SHIP_ROLL, MPS_SHIP_PITCH, MPS_SHIP_YAW};
    static const double most[] = {0.2, 7 * 3.14159265358979323846 / 180,
                                  11 * 3.14159265358979323846 / 180,
                                  3 * 3.14159265358979323846 / 180},
                        omega[] = {1.1, 2.3, 3.7, 5.3};
    char text[TEXT_MOST];
    built t;
    (void)state;
    size_t used = (size_t)snprintf(
        text, sizeof text,
        SPACE "motion:\n  axes: 'x forward, y port, z up'\n  forward: z\n  order: roll pitch "
              "yaw\n");
    for (int k = 0; k < 4; k++)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "  %s: {amplitude: %.17g %s, omega: %g rad/s}\n", name[k], most[k],
                                 degree[k] < MPS_SHIP_ROLL ? "m" : "rad", omega[k]);
    snprintf(text + used, sizeof text - used, "run: {until: 9 s}\n");
    built_make(&t, text, NULL);
    for (int k = 0; k < 4; k++)
        for (int d = 0; d < 3; d++)
            near(t.b.motion->largest[degree[k]][d], most[k] * pow(omega[k], d), 1e-7);
    built_free(&t);
}

/* ---- the beginning ---- */

static void begins(const char *motion, const char *words)
{
    char text[TEXT_MOST];
    built t;
    snprintf(text, sizeof text, PLANE "motion: %s\n" SECOND, motion);
    built_make(&t, text, NULL);
    char *all = kit_messages(t.c);
    if (words ? !kit_has(t.c, 0, 0, words) : all[0] != '\0')
        fail_msg("%s: wanted: %s; messages:\n%s", motion, words ? words : "none", all);
    free(all);
    built_free(&t);
}

static double fast(double t)
{
    return 82 * t;
}

static double tilted(double t)
{
    return 6 * cos(2 * t);
}

static double pushed(double t)
{
    return 0.1 * (1 - cos(4 * t));
}

static void beginnings(void **state)
{
    (void)state;
    write_rows("run_fast.csv", "time[s],surge[m]", 9, 0.25, fast);
    write_rows("run_tilted.csv", "time[s],roll[deg]", 60, 0.05, tilted);
    write_rows("run_pushed.csv", "time[s],surge[m]", 601, 0.005, pushed);
    char path[600], text[700];
    kit_here(path, sizeof path, "run_fast.csv");
    snprintf(text, sizeof text, "{file: %s}", path);
    begins(text, "begins with 82 m/s and the liquid at rest|MPa|'start: tank'|'ramp'|'from'");
    snprintf(text, sizeof text, "{file: %s, start: tank}", path);
    begins(text, NULL);
    kit_here(path, sizeof path, "run_tilted.csv");
    snprintf(text, sizeof text, "{file: %s}", path);
    begins(text, "a tilt of 6 deg|up to 0.042 m off the level|'ramp'|'from'");
    snprintf(text, sizeof text, "{file: %s, ramp: 1 s}", path);
    begins(text, NULL);
    kit_here(path, sizeof path, "run_pushed.csv");
    snprintf(text, sizeof text, "{file: %s}", path);
    begins(text, "an acceleration of 1.97 m/s2|437 Pa|'ramp'");
    snprintf(text, sizeof text, "{file: %s, ramp: 1 s}", path);
    begins(text, NULL);
    begins("{surge: {amplitude: 0.1 m, omega: 6 rad/s}}", "begins with 0.6 m/s|'ramp'");
    begins("{surge: {amplitude: 0.1 m, omega: 6 rad/s, ramp: 1}}", NULL);
    begins("{surge: {amplitude: 10 mm, omega: 6 rad/s}}", NULL); /* as in papers */
    begins("{roll: {amplitude: 5 deg, period: 2 s, phase: 90 deg}}", "a tilt of 5 deg");
    begins("{centre: 0.4 -8 m, roll: {amplitude: 5 deg, period: 2 s}}", "begins with 2.36 m/s");
}

/* A heading may pass 360 degrees; surge and yaw grow from where they are, roll from 0. */
static double heading(double t)
{
    return fmod(350 + 12 * t, 360);
}

static double far(double t)
{
    return 4000 + 0.1 * t;
}

static double list(double t)
{
    return 8 + 0 * t;
}

static void ramps(void **state)
{
    static const struct {
        const char *name, *header;
        double (*value)(double);
        int32_t degree;
        double most, rate; /* of the largest values: at most */
    } all[] = {
        {"run_heading.csv", "time[s],yaw[deg]", heading, MPS_SHIP_YAW, 374, 40},
        {"run_far.csv", "time[s],surge[m]", far, MPS_SHIP_SURGE, 4000.3, 0.4},
        {"run_list.csv", "time[s],roll[deg]", list, MPS_SHIP_ROLL, 8.001, 15.1},
    };
    (void)state;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        built t;
        const double f = all[k].degree < MPS_SHIP_ROLL ? 1 : DEGREE;
        mps_motion_state s = {.struct_size = sizeof s};
        write_rows(all[k].name, all[k].header, 41, 0.05, all[k].value);
        make(&t, SPACE, all[k].name, "ramp: 1 s", "run: {until: 2 s}\n");
        const double *most = t.b.motion->largest[all[k].degree];
        assert_true(most[0] <= all[k].most * f && most[1] <= all[k].rate * f);
        assert_int_equal(mps_motion_state_get(t.b.sim, &s), MPS_OK);
        if (all[k].degree == MPS_SHIP_ROLL)
            assert_true(s.value[MPS_ROTATE_X] == 0 && most[0] > 7.99 * f);
        built_free(&t);
    }
}

/* ---- coarse and noisy tables ---- */

static double smooth(double t)
{
    const double x = fmin(1, t / 0.5), f = x * x * x * (10 + x * (-15 + 6 * x));
    return 0.02 * f * sin(7 * t);
}

static double coarse(double t)
{
    return 1e-4 * round(smooth(t) / 1e-4);
}

/* Rows of 0.1 mm in 1 ms: accelerations of 100 m/s2 are reported, and the filter keeps those of the
 * motion. */
static void resolution(void **state)
{
    built t;
    (void)state;
    write_rows("run_smooth.csv", "time[s],surge[m]", 3001, 1e-3, smooth);
    write_rows("run_coarse.csv", "time[s],surge[m]", 3001, 1e-3, coarse);
    make(&t, PLANE, "run_smooth.csv", "", "run: {until: 3 s}\n");
    const double accel = t.b.motion->largest[MPS_SHIP_SURGE][2];
    assert_int_equal(mps_case_message_count(t.c), 0);
    assert_true(accel > 0.98 && accel < 2);
    built_free(&t);
    make(&t, PLANE, "run_coarse.csv", "", "run: {until: 3 s}\n");
    assert_true(t.b.motion->largest[MPS_SHIP_SURGE][2] > 100);
    assert_true(kit_has(t.c, 0, 0, "noise or the resolution of the file, 0.0001 m|'cutoff: "));
    assert_int_equal(mps_case_message_count(t.c), 1);
    built_free(&t);
    make(&t, PLANE, "run_coarse.csv", "cutoff: 11 Hz", "run: {until: 3 s}\n");
    assert_int_equal(mps_case_message_count(t.c), 0);
    near(t.b.motion->largest[MPS_SHIP_SURGE][2], accel, 0.04);
    const motion_filtered *change = &t.b.motion->change[MPS_SHIP_SURGE];
    /* those of the resolution: 0.1 mm/sqrt(12), 0.05 mm */
    near(change->rms, 1e-4 / sqrt(12), 0.1);
    /* largest where the smooth motion has a corner of its third derivative */
    assert_true(change->most > 4e-5 && change->most < 4e-4 && change->accel > 100);
    built_free(&t);
    make(&t, PLANE, "run_falling.csv", "", SECOND); /* few rows */
    assert_int_equal(t.b.motion->noisy, 0);
    built_free(&t);
}

static double tone(double t)
{
    return sin(2 * PI * 2 * t);
}

static double line(double t)
{
    return 3 * t - 1;
}

/* 1/(1 + (f/f_c)^4) without phase shift, also of uneven rows; what is linear stays. */
static void filter(void **state)
{
    static const double cutoff[] = {1, 2, 4, 16};
    built t;
    (void)state;
    for (int uneven = 0; uneven < 2; uneven++) {
        FILE *file = fopen("run_tone.csv", "w");
        assert_non_null(file);
        fprintf(file, "time[s],surge[m],heave[m]\n");
        for (int i = 0; i <= 2000; i++) {
            const double at = 0.005 * i + (uneven && i % 2 ? 0.002 : 0);
            fprintf(file, "%.9g,%.15g,%.15g\n", at, tone(at), line(at));
        }
        fclose(file);
        for (int k = 0; k < 4; k++) {
            char more[40];
            snprintf(more, sizeof more, "cutoff: %g Hz, start: tank", cutoff[k]);
            make(&t, PLANE, "run_tone.csv", more, "run: {until: 9 s}\n");
            const double share = 1 / (1 + pow(2 / cutoff[k], 4));
            for (int i = 800; i < 1200; i++) {
                const double *row = t.b.motion->column + 6 * i;
                same_number(row[MPS_SHIP_SURGE], share * tone(t.b.motion->t[i]), 5e-3);
                same_number(row[MPS_SHIP_HEAVE], line(t.b.motion->t[i]), 1e-6);
            }
            built_free(&t);
        }
    }
    char path[600], text[TEXT_MOST];
    kit_here(path, sizeof path, "run_tone.csv");
    snprintf(text, sizeof text, PLANE "motion:\n  file: %s\n  cutoff: 0.01 Hz\n" SECOND, path);
    built_refused(text, 7, "motion.cutoff: 0.01 Hz is too low for rows 0.005 s apart|at least");
}

/* ---- columns ---- */

static void quiet(void *user, int32_t kind, const char *text)
{
    (void)user, (void)kind, (void)text;
}

static double column_of(mps_job *job, mps_sim *sim, const char *name, const char *unit)
{
    mps_job_column c;
    double value = NAN;
    mps_job_column_init(&c, sizeof c);
    for (int32_t k = 0; mps_job_column_get(job, k, &c) == MPS_OK; k++) {
        if (strcmp(c.name, name) != 0) continue;
        assert_string_equal(c.unit, unit);
        assert_int_equal(c.flags, MPS_JOB_MOTION);
        assert_int_equal(mps_job_column_read(job, sim, k, &value), MPS_OK);
    }
    return value;
}

/* Each degree of freedom that is used, and no other, with the values of the user: a heading of more
 * than 360 degrees, bow across the tank, an unusual order. */
static void columns(void **state)
{
    static const struct {
        const char *text;
        double amplitude[6]; /* of sin(3 t), m or degrees; 0: no column */
    } all[] = {
        {SPACE "motion: {" AXES "surge: {amplitude: 20 mm, omega: 3 rad/s}, yaw: {amplitude: 500 "
               "deg, omega: 3 rad/s}}\n" SECOND,
         {0.02, 0, 0, 0, 0, 500}},
        {SPACE "motion: {" AXES
               "forward: z, order: roll pitch yaw, sway: {amplitude: 30 mm, omega: "
               "3 rad/s}, roll: {amplitude: 300 deg, omega: 3 rad/s}, pitch: {amplitude: -15 deg, "
               "omega: 3 rad/s}}\n" SECOND,
         {0, 0.03, 0, 300, -15, 0}},
        {PLANE
         "motion: {forward: z, sway: {amplitude: 10 mm, omega: 3 rad/s}, heave: {amplitude: 5 "
         "mm, omega: 3 rad/s}, roll: {amplitude: 4 deg, omega: 3 rad/s}}\n" SECOND,
         {0, 0.01, 0.005, 4, 0, 0}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        char error[1000] = "";
        mps_case *c;
        mps_job *job;
        mps_sim *sim;
        mps_job_config config;
        mps_job_config_init(&config, sizeof config);
        config.folder = "motion_columns";
        config.overwrite = 1;
        config.print = quiet;
        config.error = error;
        config.error_size = sizeof error;
        assert_int_equal(kit_read(all[i].text, NULL, &c), MPS_OK);
        if (mps_case_job(c, &config, &job, &sim) != MPS_OK)
            fail_msg("%s%s", error, kit_messages(c));
        for (int step = 0; step < 2; step++) {
            double t;
            assert_int_equal(mps_sim_time(sim, &t, NULL), MPS_OK);
            for (int32_t d = 0; d < 6; d++) {
                const double q = all[i].amplitude[d],
                             value = column_of(job, sim, mps__degrees[d], d < 3 ? "m" : "deg");
                if (q == 0)
                    assert_true(isnan(value));
                else
                    same_number(value, q * sin(3 * t), 1e-10 * fabs(q));
            }
            if (step == 0) assert_true(mps_step(sim, 1e-3, NULL) >= 0);
        }
        mps_sim_destroy(sim);
        mps_job_destroy(job);
        mps_case_destroy(c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(tables),     cmocka_unit_test(orders),
                                       cmocka_unit_test(beginnings), cmocka_unit_test(ramps),
                                       cmocka_unit_test(resolution), cmocka_unit_test(filter),
                                       cmocka_unit_test(columns)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
