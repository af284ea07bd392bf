/* SPDX-License-Identifier: BSD-3-Clause */
/* FMUs of a tank in an importer: the loads of a plain simulation, states, derivatives, two tanks on
 * a rigid body.
 * usage: test_fmu FOLDER, which has the unpacked FMUs 2 and 3, solid/3 in 3-D, and a folder for a
 * plain run, plain */
#include "scene.h"
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static int loads_derivative(tank *t, const uint32_t *known, size_t count, const double *seed,
                            double *out)
{
    return tank_derivative(t, load_refs, OUTPUTS, known, count, seed, out);
}

/* ---- the same loads as a plain simulation ---- */

/* Of a step of the library the loads are its bytes; over several they are means over time. */
static void loads_of_the_library(void **state)
{
    (void)state;
    for (int k = 0; k < MODULES; k++) {
        plain p = {.length = 0};
        tank t;
        double time = 0, q[INPUTS], expected[OUTPUTS], got[OUTPUTS];
        plain_open(&p);
        open_tank(&t, modules[k]);
        OK(&t, tank_start(&t, 0));
        for (int step = 0; step < STEPS; step++) {
            const int parts = step < STEPS / 2 ? 1 : 3;
            mps_load one;
            pose_at(time + parts * LENGTH, q);
            move(&t, time, parts * LENGTH, q, got);
            time += parts * LENGTH;
            plain_move(&p, time, expected);
            mps_load_init(&one, sizeof one);
            assert_int_equal(mps_load_get(p.sim, NULL, &one), MPS_OK);
            const double last[OUTPUTS] = {one.force[0], one.force[1], one.force[5],
                                          one.rest[0],  one.rest[1],  one.rest[5]};
            if (parts == 1) assert_memory_equal(got, last, sizeof got);
            for (int i = 0; i < OUTPUTS; i++)
                assert_true(fabs(got[i] - expected[i]) <= 1e-9 * fabs(expected[i]) + 1e-9);
            if (parts == 3) assert_true(fabs(got[0] - last[0]) > 1e-6 * fabs(last[0]));
        }
        assert_true(fabs(got[0]) > 1 && fabs(got[1]) > 1000);
        tank_close(&t);
        plain_close(&p);
    }
}

/* ---- states ---- */

static void back_and_again(void **state)
{
    (void)state;
    for (int k = 0; k < MODULES; k++) {
        tank t;
        void *kept = NULL;
        double first[STEPS][OUTPUTS], again[STEPS][OUTPUTS], other[OUTPUTS], q[INPUTS], clock_time;
        const uint32_t clock = 0;
        origin = 3;
        open_tank_at(&t, modules[k], origin);
        OK(&t, tank_start(&t, 3));
        const double time = go(&t, 3, 4, first[0]);
        OK(&t, tank_state_take(&t, &kept));
        go(&t, time, STEPS, first[0]);
        OK(&t, tank_state_put(&t, kept));
        OK(&t, tank_get(&t, &clock, 1, &clock_time));
        assert_true(clock_time == time);
        pose_at(time + LENGTH, q);
        q[0] += 1e-5; /* another way, taken back */
        move(&t, time, LENGTH, q, other);
        assert_memory_not_equal(other, first[0], sizeof other);
        OK(&t, tank_state_put(&t, kept));
        go(&t, time, STEPS, again[0]);
        assert_memory_equal(first, again, sizeof first);
        OK(&t, tank_state_free(&t, &kept));
        assert_null(kept);
        /* from the beginning, too */
        OK(&t, tank_reset(&t));
        origin = 0;
        pose_at(0, q);
        OK(&t, tank_set(&t, pose_refs, INPUTS, q));
        OK(&t, tank_start(&t, 0));
        go(&t, 0, STEPS, first[0]);
        tank_close(&t);
        open_tank(&t, modules[k]);
        OK(&t, tank_start(&t, 0));
        go(&t, 0, STEPS, again[0]);
        assert_memory_equal(first, again, sizeof first);
        tank_close(&t);
    }
}

static void null_instances(void **state)
{
    (void)state;
    for (int k = 0; k < MODULES; k++) module_null(modules[k]);
}

/* An importer sums step lengths to its stop time: its last step may be a rounding error. The loads
 * remain those of the previous step. */
static void steps_to_a_stop_time(void **state)
{
    (void)state;
    for (int k = 0; k < MODULES; k++) {
        tank t;
        double q[INPUTS], load[OUTPUTS], last[OUTPUTS], clock_time, time = 0;
        const uint32_t clock = 0;
        open_tank(&t, modules[k]);
        OK(&t, tank_start(&t, 0));
        time = go(&t, 0, 1, last);
        const double stops[] = {time + 4e-16, time + 8e-16, time + 8e-16 + LENGTH};
        for (int i = 0; i < 3; i++) {
            pose_at(stops[i], q);
            move(&t, time, stops[i] - time, q, load);
            time = stops[i];
            OK(&t, tank_get(&t, &clock, 1, &clock_time));
            assert_true(clock_time == time);
            for (int o = 0; o < OUTPUTS; o++) assert_true(isfinite(load[o]));
            if (i < 2) assert_memory_equal(load, last, sizeof load);
        }
        tank_close(&t);
    }
}

/* What another program may put into the folders of the instances: a FIFO that has the name of the
 * file of the state. Opening it would block forever; the alarm ends the test then. */
static void place_pipes(void)
{
    char pattern[1024];
    glob_t found;
    snprintf(pattern, sizeof pattern, "%s/mps_fmu_*", getenv("TMPDIR"));
    assert_int_equal(glob(pattern, 0, NULL, &found), 0);
    for (size_t k = 0; k < found.gl_pathc; k++) {
        snprintf(pattern, sizeof pattern, "%s/state.mps", found.gl_pathv[k]);
        assert_int_equal(mkfifo(pattern, 0600), 0);
    }
    globfree(&found);
    alarm(120);
}

static void bytes_to_another_tank(void **state)
{
    (void)state;
    for (int k = 0; k < MODULES; k++) {
        tank a, b;
        void *kept = NULL, *read = NULL, *bad = NULL;
        size_t size = 0;
        double first[STEPS][OUTPUTS], again[STEPS][OUTPUTS], own[OUTPUTS], same[OUTPUTS];
        open_tank(&a, modules[k]);
        OK(&a, tank_start(&a, 0));
        const double time = go(&a, 0, 5, first[0]);
        OK(&a, tank_state_take(&a, &kept));
        go(&a, time, STEPS, first[0]);
        OK(&a, tank_state_size(&a, kept, &size));
        char *bytes = malloc(size);
        assert_non_null(bytes);
        OK(&a, tank_state_write(&a, kept, bytes, size));
        assert_int_equal(tank_state_write(&a, kept, bytes, size - 1), 3);
        /* asking for bytes moves nothing */
        OK(&a, tank_get(&a, load_refs, OUTPUTS, own));
        assert_memory_equal(own, first[STEPS - 1], sizeof own);
        tank_close(&a);
        open_tank(&b, modules[k]);
        OK(&b, tank_start(&b, 0));
        go(&b, 0, 1, own);
        place_pipes();
        OK(&b, tank_state_read(&b, bytes, size, &read));
        alarm(0);
        /* nor does reading them */
        OK(&b, tank_get(&b, load_refs, OUTPUTS, same));
        assert_memory_equal(same, own, sizeof own);
        OK(&b, tank_state_put(&b, read));
        go(&b, time, STEPS, again[0]);
        assert_memory_equal(first, again, sizeof first);
        bytes[size / 2] ^= 1;
        assert_int_equal(tank_state_read(&b, bytes, size, &bad), 3);
        assert_int_equal(tank_state_read(&b, bytes, 100, &bad), 3);
        assert_non_null(strstr(b.text, "cut short"));
        assert_null(bad);
        /* and the tank continues without their effect */
        OK(&b, tank_state_put(&b, read));
        go(&b, time, STEPS, again[0]);
        assert_memory_equal(first, again, sizeof first);
        tank_close(&b); /* frees its states */
        free(bytes);
    }
}

/* ---- derivatives ---- */

/* F over the acceleration, by two trials of a step; A by the library: forces by momentum and by
 * pressures on walls differ. */
static void derivatives_of_trials(void **state)
{
    (void)state;
    for (int k = 0; k < MODULES; k++) {
        tank t;
        void *kept = NULL;
        double loads[5][OUTPUTS], q[INPUTS], trial[2][OUTPUTS], slope[OUTPUTS];
        const double seed = 1, change = 0.5; /* [m/s2] */
        open_tank(&t, modules[k]);
        assert_int_equal(loads_derivative(&t, pose_refs, 1, &seed, slope), 3);
        OK(&t, tank_start(&t, 0));
        const double time = go(&t, 0, 5, loads[0]);
        OK(&t, tank_state_take(&t, &kept));
        for (int d = 0; d < 2; d++) {
            for (int side = 0; side < 2; side++) {
                OK(&t, tank_state_put(&t, kept));
                pose_at(time + LENGTH, q);
                q[d] += (side ? 1 : -1) * change * LENGTH * LENGTH;
                move(&t, time, LENGTH, q, trial[side]);
            }
            OK(&t, loads_derivative(&t, &pose_refs[6 + d], 1, &seed, slope));
            const double found = (trial[1][d] - trial[0][d]) / (2 * change);
            print_message("degree %d: by trials %.3f, by the FMU %.3f kg/m\n", d, found, slope[d]);
            assert_true(slope[d] < -1);
            assert_true(fabs(slope[d] - found) < 0.01 * fabs(found));
            for (int i = 3; i < OUTPUTS; i++) assert_true(slope[i] == 0); /* F0 */
            assert_true(fabs(trial[1][3 + d] - trial[0][3 + d]) < 0.03 * fabs(2 * change * found));
        }
        OK(&t, loads_derivative(&t, pose_refs, 1, &seed, slope));
        assert_true(slope[0] == 0); /* of the pose at the same acceleration */
        const double both[2] = {2, -1};
        double one[OUTPUTS], two[OUTPUTS];
        OK(&t, loads_derivative(&t, &pose_refs[6], 2, both, slope));
        OK(&t, loads_derivative(&t, &pose_refs[6], 1, &seed, one));
        OK(&t, loads_derivative(&t, &pose_refs[7], 1, &seed, two));
        for (int i = 0; i < 3; i++)
            assert_true(fabs(slope[i] - 2 * one[i] + two[i]) <= 1e-9 * (1 + fabs(slope[i])));
        tank_close(&t);
    }
}

/* In 3-D the axes of angles rotate too: a rotated tank, trials in the second derivative of each
 * angle. */
static void derivatives_of_a_turned_tank(void **state)
{
    static const uint32_t angle[3] = {19, 20, 21}, turn[3] = {51, 52, 53},
                          six[6] = {64, 65, 66, 67, 68, 69};
    const double stand[3] = {0.1, 0.5, -0.3}, seed = 1, change = 0.5, length = 4e-3;
    tank t;
    void *kept = NULL;
    (void)state;
    if (!tank_open(&t, solid, NULL)) fail_msg("%s", t.text);
    OK(&t, tank_set(&t, angle, 3, stand));
    OK(&t, tank_start(&t, 0));
    for (int k = 0; k < 4; k++) OK(&t, tank_step(&t, k * length, length));
    OK(&t, tank_state_take(&t, &kept));
    for (int d = 0; d < 3; d++) {
        double trial[2][6], slope[6], found[6], most = 0, worst = 0;
        for (int side = 0; side < 2; side++) {
            const double q = stand[d] + (side ? 1 : -1) * change * length * length;
            OK(&t, tank_state_put(&t, kept));
            OK(&t, tank_set(&t, &angle[d], 1, &q));
            OK(&t, tank_step(&t, 4 * length, length));
            OK(&t, tank_get(&t, six, 6, trial[side]));
        }
        OK(&t, tank_derivative(&t, six, 6, &turn[d], 1, &seed, slope));
        for (int i = 0; i < 6; i++) {
            found[i] = (trial[1][i] - trial[0][i]) / (2 * change);
            most = fmax(most, fabs(found[i]));
            worst = fmax(worst, fabs(found[i] - slope[i]));
        }
        print_message("angle %d: differ by %.2g of %.3g\n", d, worst / most, most);
        assert_true(worst < 0.05 * most);
    }
    tank_close(&t);
}

/* ---- two tanks on a rigid body ---- */

/* A body of mass M free along x with a tank of each version, released with a speed. Each step uses
 * the acceleration from the loads and derivatives of the previous step, then it is repeated from
 * the same state with the new loads. */
static void two_tanks_on_a_body(void **state)
{
    (void)state;
    const double mass = 30, seed = 1; /* less than half of the liquid that moves with it */
    tank t[MODULES];
    void *kept[MODULES] = {NULL, NULL};
    double x = 0, v = 0, a = 0, push = 40, worst = 0, loads[MODULES][OUTPUTS], slope[OUTPUTS];
    for (int k = 0; k < MODULES; k++) {
        if (!tank_open(&t[k], modules[k], NULL)) fail_msg("%s", t[k].text);
        OK(&t[k], tank_start(&t[k], 0));
    }
    for (int step = 0; step < 3 * STEPS; step++) {
        double added = 0, next = a;
        for (int k = 0; k < MODULES; k++) OK(&t[k], tank_state_take(&t[k], &kept[k]));
        for (int trial = 0; trial < 2; trial++) {
            double force = push, q[INPUTS] = {0};
            q[3] = v + next * LENGTH;
            q[0] = x + q[3] * LENGTH;
            q[6] = next;
            for (int k = 0; k < MODULES; k++) {
                if (trial > 0) OK(&t[k], tank_state_put(&t[k], kept[k]));
                move(&t[k], step * LENGTH, LENGTH, q, loads[k]);
                force += loads[k][0];
                OK(&t[k], loads_derivative(&t[k], &pose_refs[6], 1, &seed, slope));
                added += trial == 0 ? -slope[0] : 0;
            }
            const double residual = force - mass * next;
            if (trial == 1) worst = fmax(worst, fabs(residual));
            if (trial == 0) next += residual / (mass + added);
        }
        a = next;
        v += a * LENGTH;
        x += v * LENGTH;
        assert_memory_equal(loads[0], loads[1],
                            sizeof loads[0]); /* tanks side by side do the same */
    }
    print_message(
        "body: x = %.4g m, v = %.4g m/s, a = %.3g m/s2; a force is left of %.2g N/m of %g\n", x, v,
        a, worst, push);
    assert_true(isfinite(x) && v > 0 && a > 0 && a < push / mass);
    assert_true(worst < 0.05 * push);
    for (int k = 0; k < MODULES; k++) tank_close(&t[k]);
}

/* ---- refusals ---- */

static void refusals(void **state)
{
    (void)state;
    for (int k = 0; k < MODULES; k++) {
        tank t, other;
        double value[2] = {0.25, NAN}, load[OUTPUTS];
        const uint32_t unknown = 999, known[2] = {16, 17};
        void *kept = NULL;
        assert_false(tank_open(&t, modules[k], "{00000000-0000-0000-0000-000000000000}"));
        assert_non_null(strstr(t.text, module_token(modules[k])));
        open_tank(&t, modules[k]);
        open_tank(&other, modules[k]);
        assert_int_equal(tank_step(&t, 0, LENGTH), 3); /* not initialised */
        assert_int_equal(tank_set(&t, known, 2, value), 3);
        assert_non_null(strstr(t.text, "pose.y"));
        OK(&t, tank_get(&t, known, 1, value));
        assert_true(value[0] == 0); /* all or none */
        value[1] = 0;
        assert_int_equal(tank_set(&t, &unknown, 1, value), 3);
        assert_int_equal(tank_set(&t, load_refs, 1, value), 3);
        assert_int_equal(tank_get(&t, &unknown, 1, value), 3);
        OK(&t, tank_start(&t, 0));
        assert_int_equal(tank_start(&t, 0), 3);
        OK(&t, tank_get(&t, load_refs, OUTPUTS, load));
        assert_true(load[0] == 0);
        assert_int_equal(tank_step(&t, 1, LENGTH), 3); /* from another time */
        assert_int_equal(tank_step(&t, 0, -LENGTH), 3);
        assert_int_equal(tank_step(&t, 0, NAN), 3);
        value[0] = 1e300; /* the library refuses it, with its text */
        OK(&t, tank_set(&t, known, 1, value));
        assert_true(tank_step(&t, 0, LENGTH) >= 2);
        assert_non_null(strstr(t.text, "step: "));
        OK(&other, tank_start(&other, 0));
        OK(&other, tank_state_take(&other, &kept));
        assert_int_equal(tank_state_put(&t, kept), 3); /* of another tank */
        /* after all that it is as new */
        double first[STEPS][OUTPUTS], again[STEPS][OUTPUTS];
        go(&t, 0, STEPS, first[0]);
        go(&other, 0, STEPS, again[0]);
        assert_memory_equal(first, again, sizeof first);
        OK(&t, tank_terminate(&t));
        assert_int_equal(tank_step(&t, STEPS * LENGTH, LENGTH), 3);
        tank_close(&t);
        tank_close(&other);
    }
}

int main(int argc, char **argv)
{
    char place[1100];
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loads_of_the_library),         cmocka_unit_test(back_and_again),
        cmocka_unit_test(steps_to_a_stop_time),         cmocka_unit_test(null_instances),
        cmocka_unit_test(bytes_to_another_tank),        cmocka_unit_test(derivatives_of_trials),
        cmocka_unit_test(two_tanks_on_a_body),          cmocka_unit_test(refusals),
        cmocka_unit_test(derivatives_of_a_turned_tank), cmocka_unit_test(sensors)};
    if (argc != 2) return 2;
    folder = argv[1];
    for (int k = 0; k < MODULES; k++) modules[k] = module_load(folder, 2 + k);
    snprintf(place, sizeof place, "%s/solid", folder);
    solid = module_load(place, 3);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
