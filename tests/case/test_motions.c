/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions of cases with the degrees of freedom of a ship, against matrices. */
#include "build_kit.h"
#include <unistd.h>

#define HEAD "mps: 1\ndim: 3\ndp: 0.2 m\ntank: {size: 2 1 1 m}\nfill: [{water: {depth: 0.4 m}}]\n"

static const double PI = 3.14159265358979323846;

/* Rotation by an angle about an axis (Rodrigues), row by row. */
static void rotation(const double *axis, double angle, double *r)
{
    const double n = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]),
                 c = cos(angle), s = sin(angle);
    const double u[3] = {axis[0] / n, axis[1] / n, axis[2] / n};
    const double cross[9] = {0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r[3 * i + j] = (i == j ? c : 0) + s * cross[3 * i + j] + (1 - c) * u[i] * u[j];
}

/* Roll, pitch, yaw of a matrix in the ship's own axes, x forward, y port, z up: R = Rz(yaw)
 * Ry(pitch) Rx(roll). */
static void angles(const double *r, double *roll, double *pitch, double *yaw)
{
    *pitch = asin(-r[6]);
    *roll = atan2(r[7], r[8]);
    *yaw = atan2(r[3], r[0]);
}

/* Axes of the ship in those of the lab: forward x, port -z, up y. */
static void to_lab(const double *v, double *out)
{
    const double lab[3] = {v[0], v[2], -v[1]};
    memcpy(out, lab, sizeof lab);
}

static double turned_by(int row)
{
    return 0.4 * sin(0.9 * row);
}

static void write_table(const char *path, const double *axis)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "# a rotation about a skew axis\nt (s); ROLL [rad];PITCH[rad]; YAW[rad]; "
                  "X[m];Y[mm];Z[cm]\n");
    for (int i = 0; i < 12; i++) {
        double r[9], roll, pitch, yaw;
        rotation(axis, turned_by(i), r);
        angles(r, &roll, &pitch, &yaw);
        fprintf(file, "%d;%.17g;%.17g;%.17g;%.17g;%.17g;%.17g\n", i, roll, pitch, yaw, 0.1 * i,
                -20.0 * i, 3.0 * i);
    }
    fclose(file);
}

/* The pose at each row of the file is the rotation about the axis, to 1e-12. */
static void skew_axis(void **state)
{
    const double axis[3] = {0.6, -0.5, 0.8};
    double lab_axis[3];
    char path[600];
    (void)state;
    const int fd = mkstemp(kit_here(path, sizeof path, "mps_skew_XXXXXX"));
    assert_true(fd >= 0);
    close(fd);
    write_table(path, axis);
    to_lab(axis, lab_axis);
    for (int row = 0; row < 10; row++) {
        char text[1400];
        built t;
        mps_motion_state s = {.struct_size = sizeof s};
        mps_motion_pose pose;
        double wanted[9];
        snprintf(text, sizeof text,
                 HEAD
                 "motion:\n  file: %s\n  columns: {time: t, surge: X, sway: Y, heave: Z, roll: "
                 "roll, pitch: PITCH, yaw: YAW}\n  axes: x forward, y port, z up\n  centre: 1 0.3 "
                 "0.2 m\n  from: %d s\nrun: {until: 1 s}\n",
                 path, row);
        built_make(&t, text, NULL);
        mps_motion_pose_init(&pose, sizeof pose);
        assert_int_equal(mps_motion_state_get(t.b.sim, &s), MPS_OK);
        assert_int_equal(mps_motion_pose_from_state(&s, &pose), MPS_OK);
        rotation(lab_axis, turned_by(row), wanted);
        for (int k = 0; k < 9; k++) assert_true(fabs(pose.rotation[k] - wanted[k]) < 1e-12);
        assert_true(fabs(pose.translation[0] - 0.1 * row) < 1e-12);
        assert_true(fabs(pose.translation[1] - 0.03 * row) < 1e-12);
        assert_true(fabs(pose.translation[2] - 0.02 * row) < 1e-12);
        built_free(&t);
    }
    unlink(path);
}

/* A harmonic of one degree, seen as a displacement of the lab at a quarter of its period, by a
 * callback or by harmonics. */
static void degrees_of_freedom(void **state)
{
    static const struct {
        const char *axes, *degree;
        int32_t dof;
        double sign;
    } all[] = {{"x forward, y port, z up", "surge", MPS_MOVE_X, 1},
               {"x forward, y port, z up", "sway", MPS_MOVE_Z, -1},
               {"x forward, y port, z up", "heave", MPS_MOVE_Y, 1},
               {"x forward, y port, z up", "roll", MPS_ROTATE_X, 1},
               {"x forward, y port, z up", "pitch", MPS_ROTATE_Z, -1},
               {"x forward, y port, z up", "yaw", MPS_ROTATE_Y, 1},
               {"x forward, y starboard, z down", "sway", MPS_MOVE_Z, 1},
               {"x forward, y starboard, z down", "heave", MPS_MOVE_Y, -1},
               {"x forward, y starboard, z down", "pitch", MPS_ROTATE_Z, 1},
               {"x forward, y starboard, z down", "yaw", MPS_ROTATE_Y, -1},
               {"x forward, y up, z starboard", "sway", MPS_MOVE_Z, 1},
               {"x forward, y up, z starboard", "pitch", MPS_ROTATE_Z, 1}};
    (void)state;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        char text[600];
        built t;
        mps_motion_state s = {.struct_size = sizeof s};
        const bool turn = all[i].dof >= MPS_ROTATE_X;
        snprintf(text, sizeof text,
                 HEAD "motion: {axes: '%s', %s: {amplitude: 0.1 %s, period: 4 s, phase: 90 deg}}\n"
                      "run: {until: 1 s}\n",
                 all[i].axes, all[i].degree, turn ? "rad" : "m");
        built_make(&t, text, NULL);
        assert_int_equal(mps_motion_state_get(t.b.sim, &s), MPS_OK);
        for (int32_t d = 0; d < 6; d++)
            same_number(s.value[d], d == all[i].dof ? 0.1 * all[i].sign : 0, 1e-15);
        built_free(&t);
    }
}

#define PLANE "mps: 1\ndp: 20 mm\ntank: {size: 1 0.6 m}\nfill: [{water: {depth: 0.3 m}}]\n"

/* In 2-D: what the same degree does in 3-D, as a section along the ship or across it; without
 * `forward` surge is along x too. */
static void degrees_of_the_plane(void **state)
{
    static const struct {
        const char *keys, *degree;
        int32_t dof;
        double sign;
    } all[] = {{"", "surge", MPS_MOVE_X, 1},
               {"", "sway", MPS_MOVE_X, -1},
               {"", "heave", MPS_MOVE_Y, 1},
               {"", "roll", MPS_ROTATE_Z, 1},
               {"axes: 'x forward, y port, z up', ", "sway", MPS_MOVE_X, 1},
               {"axes: 'x forward, y starboard, z down', ", "heave", MPS_MOVE_Y, -1},
               {"axes: 'x forward, y starboard, z down', ", "roll", MPS_ROTATE_Z, 1},
               {"forward: -z, ", "roll", MPS_ROTATE_Z, -1},
               {"forward: x, ", "surge", MPS_MOVE_X, 1},
               {"forward: -x, ", "surge", MPS_MOVE_X, -1},
               {"forward: x, ", "heave", MPS_MOVE_Y, 1},
               {"forward: x, axes: 'x forward, y port, z up', ", "pitch", MPS_ROTATE_Z, -1},
               {"forward: x, axes: 'x forward, y starboard, z down', ", "pitch", MPS_ROTATE_Z, 1},
               {"forward: x, ", "pitch", MPS_ROTATE_Z, 1}};
    (void)state;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        char text[600];
        built t;
        mps_motion_state s = {.struct_size = sizeof s};
        snprintf(text, sizeof text,
                 PLANE
                 "motion: {%s%s: {amplitude: 0.1 %s, period: 4 s, phase: 90 deg}}\nrun: {until: 1 "
                 "s}\n",
                 all[i].keys, all[i].degree, all[i].dof >= MPS_ROTATE_X ? "rad" : "m");
        built_make(&t, text, NULL);
        assert_int_equal(mps_motion_state_get(t.b.sim, &s), MPS_OK);
        for (int32_t d = 0; d < 6; d++)
            same_number(s.value[d], d == all[i].dof ? 0.1 * all[i].sign : 0, 1e-15);
        built_free(&t);
    }
}

/* Roll and pitch together with the bow along z: no sum of harmonics of the lab. R = T(e2, pitch)
 * T(e1, roll), e1 = z, e2 = x. */
static void two_rotations(void **state)
{
    const double roll = 0.3, pitch = 0.2, z[3] = {0, 0, 1}, x[3] = {1, 0, 0};
    double a[9], b[9];
    built t;
    mps_motion_state s = {.struct_size = sizeof s};
    mps_motion_pose pose;
    (void)state;
    built_make(&t,
               HEAD
               "motion: {forward: z, axes: 'x forward, y port, z up', roll: {amplitude: 0.3 rad, "
               "omega: 2 rad/s, phase: 90 deg}, pitch: {amplitude: 0.2 rad, omega: 3 rad/s, phase: "
               "90 deg}}\nrun: {until: 1 s}\n",
               NULL);
    mps_motion_pose_init(&pose, sizeof pose);
    assert_int_equal(mps_motion_state_get(t.b.sim, &s), MPS_OK);
    assert_int_equal(mps_motion_pose_from_state(&s, &pose), MPS_OK);
    rotation(x, pitch, a);
    rotation(z, roll, b);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double sum = 0;
            for (int k = 0; k < 3; k++) sum += a[3 * i + k] * b[3 * k + j];
            assert_true(fabs(pose.rotation[3 * i + j] - sum) < 1e-12);
        }
    assert_true(t.b.motion->dt_max > 0);
    built_free(&t);
}

/* ---- spectra ---- */

/* Variance over many periods is (significant/2)^2 within its sampling band, and its rate of zero
 * crossings that of the band; the same seed gives the same bytes, another one others. */
static void spectrum(void **state)
{
    double first[2] = {0}, before[2] = {0};
    (void)state;
    for (int seed = 1; seed <= 3; seed++) {
        char text[500];
        built t;
        double sum = 0, energy = 0, q[3];
        snprintf(text, sizeof text,
                 PLANE
                 "motion: {roll: {jonswap: {peak: 2 s, significant: 4 deg, seed: %d, components: "
                 "200}}}\nrun: {until: 10 s}\n",
                 seed == 3 ? 1 : seed);
        built_make(&t, text, NULL);
        const build_motion *m = t.b.motion;
        assert_int_equal(m->count, 200);
        for (int i = 0; i < m->count; i++) {
            energy += 0.5 * m->harmonic[i].amplitude * m->harmonic[i].amplitude;
            assert_true(m->harmonic[i].omega > 0.5 * PI && m->harmonic[i].omega < 3 * PI);
        }
        const double wanted = pow(2 * PI / 180, 2);
        assert_true(fabs(energy / wanted - 1) < 1e-12);
        const int samples = 100000; /* of 5000 s: 2500 periods, scatter of the variance 2 to 3 % */
        for (int i = 0; i < samples; i++) {
            mps__harmonics_at(m, MPS_SHIP_ROLL, 0.05 * i, q);
            sum += q[0] * q[0];
        }
        printf("JONSWAP, seed %d: variance over 5000 s %+.2f %%\n", seed,
               100 * (sum / samples / wanted - 1));
        assert_true(fabs(sum / samples / wanted - 1) < 0.08);
        first[0] = m->harmonic[7].omega;
        first[1] = m->harmonic[7].phase;
        if (seed == 1) memcpy(before, first, sizeof first);
        if (seed == 2) assert_true(first[0] != before[0] && first[1] != before[1]);
        if (seed == 3) assert_memory_equal(first, before, sizeof first);
        built_free(&t);
    }
}

/* Value, rate and acceleration agree by differences, with a ramp and with both forms. */
static void derivatives(void **state)
{
    built t;
    (void)state;
    built_make(
        &t,
        PLANE
        "motion: {surge: [{amplitude: 20 mm, period: 2 s, phase: 30 deg, ramp: 3}, {amplitude: "
        "5 mm, frequency: 1.5 Hz, form: cosine, ramp: 4 s}], heave: {acceleration: 0.1 m/s2}}\n"
        "run: {until: 10 s}\n",
        NULL);
    const build_motion *m = t.b.motion;
    const double h = 1e-4;
    for (double at = 0.3; at < 8; at += 0.37)
        for (int32_t d = 0; d < 3; d += 2) {
            double q[3], a[3], b[3];
            mps__harmonics_at(m, d, at, q);
            mps__harmonics_at(m, d, at - h, a);
            mps__harmonics_at(m, d, at + h, b);
            assert_true(fabs((b[0] - a[0]) / (2 * h) - q[1]) < 1e-7);
            assert_true(fabs((b[1] - a[1]) / (2 * h) - q[2]) < 1e-5);
        }
    built_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(skew_axis),
                                       cmocka_unit_test(degrees_of_freedom),
                                       cmocka_unit_test(degrees_of_the_plane),
                                       cmocka_unit_test(two_rotations),
                                       cmocka_unit_test(spectrum),
                                       cmocka_unit_test(derivatives)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
