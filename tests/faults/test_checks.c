/* SPDX-License-Identifier: BSD-3-Clause */
/* Cases of all kinds, read from their files, built and measured, while each call of the system and
 * of libmps fails in turn. The result is that of the check without a failure, or a status with a
 * message and no result. */
#include "../every.h"
#include "case_kit.h"
#include "fault_kit.h"
#include <mps/case.h>

/* Output of a check; the caller frees the texts. */
typedef struct answer {
    mps_status status;
    char *text, *sketch, messages[4000];
} answer;

static const char *check(const char *path, int32_t place, int32_t visit, answer *a)
{
    mps_case *c = NULL;
    *a = (answer){0};
    fault_arm(place, visit);
    a->status = mps_case_read(path, 0, NULL, &c);
    if (a->status == MPS_OK) a->status = mps_case_check(c, &a->text, &a->sketch);
    if (c) mps_case_messages_write(c, a->messages, sizeof a->messages);
    mps_case_destroy(c);
    return fault_disarm();
}

/* Read a case with `set` and `sweep`; instead of a check its text and the sets of its last run. */
static const char *read_sets(const char *path, int32_t place, int32_t visit, answer *a)
{
    static const char *const sets[] = {"fill.oil.depth=1 mm",
                                       "fluids.oil={density: 900 kg/m3}",
                                       "fill.1.depth=30 %",
                                       "fill.water={depth: 20 %, start: {velocity: 1 0 m/s}}",
                                       "fill.water.start.velocity=2 0 m/s",
                                       "sensors.P1.wall=0 50 mm",
                                       "motion.roll.amplitude=4 deg",
                                       "motion.roll.period=1 s",
                                       "settings.gas.sound=340 m/s"};
    mps_case *c = NULL;
    char last[200] = "";
    *a = (answer){0};
    fault_arm(place, visit);
    a->status = mps_case_read(path, sizeof sets / sizeof *sets, sets, &c);
    if (a->status == MPS_OK) a->status = mps_case_sweep_get(c, 5, 0, last, sizeof last);
    const char *failed = fault_disarm();
    if (a->status == MPS_OK) {
        a->text = strdup(mps_case_text(c));
        a->sketch = strdup(last);
    } else if (c)
        mps_case_messages_write(c, a->messages, sizeof a->messages);
    mps_case_destroy(c);
    return failed;
}

static void forget(answer *a)
{
    free(a->text);
    free(a->sketch);
}

/* The first line of a text that is not in another, except that of the wall-clock time; NULL:
 * none. */
static const char *other_line(const char *text, const char *in)
{
    char line[4000];
    for (const char *at = text; *at; at += strcspn(at, "\n"), at += *at != '\0') {
        snprintf(line, sizeof line, "%.*s\n", (int)strcspn(at, "\n"), at);
        if (strncmp(line, "cost ", 5) != 0 && !strstr(in, line)) return at;
    }
    return NULL;
}

/* Quantities that could not be measured are omitted: each line is one of the complete output. */
static int compare(const answer *a, const answer *whole, const char *failed)
{
    const char *other = a->text ? other_line(a->text, whole->text) : NULL;
    if (a->status == MPS_OK && a->text && a->sketch && !other) return 0;
    if (a->status != MPS_OK && !a->text && !a->sketch &&
        (a->status == MPS_E_NOMEM || a->messages[0]))
        return 0;
    print_error("%s: status %d, messages \"%s\", %.*s\n", failed, (int)a->status, a->messages,
                other ? (int)strcspn(other, "\n") : 0, other ? other : "");
    return 1;
}

typedef const char *(*reading)(const char *path, int32_t place, int32_t visit, answer *a);

/* With a sanitizer one of this number of call sites is tested, different ones for each case. */
enum { EACH = 4 };
static int32_t cases;

/* @return number of failures that ended it, times the call sites that one represents */
static int64_t in_turn(const char *path, reading try)
{
    answer whole, a;
    int wrong = 0, ended = 0, reached = 0;
    fault_forget();
    try(path, -1, 1, &whole);
    const int32_t places = fault_places();
    if (whole.status != MPS_OK) fail_msg("%s", whole.messages);
    for (int32_t k = 0; k < places; k++) {
        if (!has_turn(k, cases, EACH)) continue;
        const char *failed = try(path, k, 1, &a);
        wrong += compare(&a, &whole, failed ? failed : "no failure");
        reached += failed != NULL;
        ended += a.status != MPS_OK;
        if (!failed && a.status != MPS_OK) fail_msg("status %d without a failure", (int)a.status);
        forget(&a);
    }
    print_message("%s: %d calls failed, %d of which ended it\n", path, reached, ended);
    forget(&whole);
    assert_int_equal(wrong, 0);
    cases++;
    return ended * every(EACH);
}

static void write_file(const char *path, const char *text)
{
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    assert_true(fputs(text, out) >= 0 && fclose(out) == 0);
}

/* Write a case, check it, remove it. */
static int64_t of_text(const char *text)
{
    char path[600];
    write_file(kit_here(path, sizeof path, "faults.yaml"), text);
    const int64_t ended = in_turn(path, check);
    assert_int_equal(unlink(path), 0);
    return ended;
}

#define END "run: {until: 1 s, threads: 1}\n"

static void files(void **state)
{
    (void)state;
    assert_true(of_text("mps: 1\ndim: 3\ndp: 0.2 m\ntank: {stl: " CASES "cube.stl, unit: m}\n"
                        "fill: [{water: {depth: 40 %}}]\nmotion:\n  file: " CASES "voyage.csv\n"
                        "  axes: x forward, y port, z up\n  columns: {time: t, surge: XG, roll: "
                        "PHI}\n  units: {time: s, surge: m, roll: deg}\n  from: 1200 s\n" END) >
                20);
}

static void ships(void **state)
{
    (void)state;
    assert_true(
        of_text("mps: 1\ndim: 3\ndp: 0.1 m\ntank: {size: 1.2 0.8 0.6 m}\n"
                "fill: [{water: {depth: 50 %}}]\nsolids:\n"
                "  c: {cylinder: {from: 0.6 0 0.3 m, to: 0.6 0.8 0.3 m, radius: 0.1 m}}\n"
                "  p: {plate: [0.3 0 0 m, 0.3 0.3 0.6 m]}\n"
                "  b: {sphere: {centre: 0.9 0.2 0.3 m, radius: 0.12 m}}\n"
                "  w: {prism: [0 0 m, 0.2 0 m, 0 0.2 m], between: 0 0.2 m}\n"
                "motion:\n  axes: x forward, y port, z up\n  centre: 0.6 0.4 0.3 m\n"
                "  roll: {amplitude: 4 deg, period: 1 T1}\n"
                "  yaw: {jonswap: {significant: 1 deg, peak: 1.2 s}}\n"
                "sensors:\n  P: {panel: [0 0.2 0.1 m, 0 0.4 0.1 m, 0 0.2 0.4 m], cells: 2}\n"
                "  F: {force: tank, axes: ship, about: 0.6 0.4 0.3 m}\n"
                "  eta: {gauge: 0.2 0.3 m}\n  v: {measure: speed}\n" END) > 20);
}

static void waves(void **state)
{
    (void)state;
    assert_true(of_text("mps: 1\ndp: 50 mm\ntank: {size: 1 0.6 m}\n"
                        "fill: [{water: {depth: 0.3 m, start: {standing_wave: 20 mm}}}]\n"
                        "solids: {b: {plate: [0.5 0 m, 0.5 0.1 m], thickness: 1 dp}}\n"
                        "motion: {sway: {acceleration: 0.1 m/s2}}\n"
                        "use: [viscosity.pair]\nremove: [collision]\n" END) > 20);
    assert_true(of_text("mps: 1\ndp: 50 mm\ntank: {polygon: [0 0 m, 1 0 m, 1 0.6 m, 0 0.6 m]}\n"
                        "fill: [{water: {wave: {level: 0.3 m, amplitude: 50 mm, length: 1 m}}}]\n"
                        "kernel: {near: 2.1 dp, far: 3.1 dp}\n" END) > 20);
}

static void drops(void **state)
{
    (void)state;
    assert_true(of_text("mps: 1\ndp: 50 mm\ntank: {size: 1 1 m}\nmodel: mmps\n"
                        "settings: {tension.sigma: 72.7 mN/m}\nfill: [{water: {sphere: {centre: "
                        "0.5 0.5 m, radius: 0.2 m}, start: {oscillation: 5 %}}}, {air: rest}]\n"
                        "sensors:\n  a: {measure: half_axis}\n"
                        "  j: {measure: pressure_jump, radius: 0.2 m}\n" END) > 20);
}

static void bodies(void **state)
{
    char path[600], all[2000];
    (void)state;
    write_file(kit_here(path, sizeof path, "faults_load.csv"),
               "time[s],FX[N],MX[N m]\n0,0,0\n1,3,0.2\n2,-3,0.1\n");
    snprintf(all, sizeof all,
             "mps: 1\ndp: 50 mm\ntank: {size: 1 0.6 m}\nfill: [{water: {depth: 40 %%}}]\n"
             "body:\n  centre: 500 0 mm\n  forward: z\n  mass: 200 kg\n  inertia: 30 kg m2\n"
             "  centre_of_mass: 500 -100 mm\n"
             "  sway: {stiffness: 2 kN/m, damping: 5 %%}\n"
             "  roll: {period: 1 T1, damping: 3 N m s/rad, load: {jonswap: {significant: 2 N m, "
             "peak: 1.2 s}}}\n"
             "  load: {file: %s, columns: {sway: FX, roll: MX}, ramp: 1 s}\n"
             "sensors: {L: {load: momentum}, W: {load: walls}}\n" END,
             path);
    assert_true(of_text(all) > 20);
    assert_int_equal(unlink(path), 0);
    assert_true(of_text("mps: 1\ndim: 3\ndp: 0.1 m\ntank: {size: 1.2 0.8 0.6 m}\n"
                        "fill: [{water: {depth: 50 %}}]\n"
                        "body:\n  mass: 900 kg\n  inertia: 60 70 80 1 2 3 kg m2\n  gravity: no\n"
                        "  heave: {period: 0.9 s, damping: 10 %, load: [{amplitude: 3 N, omega: 4 "
                        "rad/s, phase: 20 deg}, {amplitude: 2 N, frequency: 1 Hz, ramp: 3}]}\n"
                        "  pitch: {stiffness: 3 kN m/rad}\n  yaw: {stiffness: 90 N m/rad}\n"
                        "sensors: {L: {load: momentum}}\n" END) > 20);
}

static void sets(void **state)
{
    char path[600], base[600];
    (void)state;
    write_file(kit_here(base, sizeof base, "faults_base.yaml"),
               "mps: 1\ndp: 4 mm\ntank: {size: 0.8 0.5 m}\n"
               "fill: [{water: {depth: 25 %}}, {air: rest}]\nmodel: mmps\nrun: {until: 5 s}\n");
    write_file(kit_here(path, sizeof path, "faults.yaml"),
               "mps: 1\nbase: faults_base.yaml\nset: {dp: 20 mm, run.until: 30 T1}\n"
               "run: {threads: 1}\nsweep: {fill.water.depth: 10 to 30 step 10 %, dp: 10 20 mm, "
               "model: [imps, mmps]}\n");
    assert_true(in_turn(path, read_sets) > 20);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(unlink(base), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(files),  cmocka_unit_test(ships),
                                       cmocka_unit_test(waves),  cmocka_unit_test(drops),
                                       cmocka_unit_test(bodies), cmocka_unit_test(sets)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
