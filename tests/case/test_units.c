/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers with units: values to the last bit, lists, and what is refused. */
#include "case_kit.h"
#include "units.h"
#include <math.h>
#include "locale_kit.h"

static mps__numbers read_all(const char *text, uint64_t kinds, double *out)
{
    mps__numbers n = {
        .text = text, .kinds = kinds, .scale = {1, 0.004, 1.25, 0.5}, .most = 4, .out = out};
    if (!mps__numbers_read(&n)) n.count = -1;
    return n;
}

static void is(const char *text, uint64_t kinds, double value)
{
    double out[4];
    const mps__numbers n = read_all(text, kinds, out);
    if (n.count != 1 || out[0] != value)
        fail_msg("'%s' is %d numbers, the first %.17g, not %.17g: %s", text, (int)n.count, out[0],
                 value, n.why);
}

/* The same bits as the number in C. */
static void values(void **state)
{
    (void)state;
    is("20 mm", UNIT_LENGTH, 20e-3);
    is("9 mm", UNIT_LENGTH, 0.009);
    is("395 mm", UNIT_LENGTH, 0.395);
    is("1.5m", UNIT_LENGTH, 1.5);
    is("  -3 km ", UNIT_LENGTH, -3000);
    is(".5 cm", UNIT_LENGTH, 0.005);
    is("5. um", UNIT_LENGTH, 5e-6);
    is("+1e3 mm", UNIT_LENGTH, 1);
    is("1E-3 km", UNIT_LENGTH, 1);
    is("2 dp", UNIT_LENGTH, 2 * 0.004);
    is("30 %", UNIT_LENGTH | UNIT_SHARE, 0.3 * 0.5);
    is("30 %", UNIT_SHARE, 0.3);
    is("0.3", UNIT_SHARE | UNIT_NONE, 0.3);
    is("0.85 T1", UNIT_TIME, 0.85 * 1.25);
    is("3 h", UNIT_TIME, 10800);
    is("2 min", UNIT_TIME, 120);
    is("4 deg", UNIT_ANGLE, 4 * acos(-1.0) / 180);
    is("90 deg/s", UNIT_OMEGA, 90 * acos(-1.0) / 180);
    is("36 km/h", UNIT_VELOCITY, 10);
    is("0.13 mPa s", UNIT_VISCOSITY, 0.13e-3);
    is("0.13 mPa  s", UNIT_VISCOSITY, 0.13e-3);
    is("1 cSt", UNIT_VISCOSITY, 1e-6);
    is("1 cP", UNIT_VISCOSITY, 1e-3);
    is("72.7 mN/m", UNIT_TENSION, 72.7e-3);
    is("5 kN/m", UNIT_STIFFNESS, 5000);
    is("5 N m/rad", UNIT_TURN_STIFFNESS, 5);
    is("5 MN m s/rad", UNIT_TURN_DAMPING, 5e6);
    is("5 kN s/m", UNIT_DAMPING | UNIT_SHARE, 5000);
    is("1 g/cm3", UNIT_DENSITY, 1000);
    is("1 kg/m^3", UNIT_DENSITY, 1);
    is("12 MB", UNIT_BYTES, 12e6);
    is("2 l", UNIT_VOLUME, 2e-3);
    is("0", UNIT_LENGTH, 0);
    is("-0.0", UNIT_TIME, 0);
    is("7", UNIT_NONE, 7);
}

/* Each unit: ten of it, against its factor. */
static void all_units(void **state)
{
    (void)state;
    const mps__unit *u;
    int32_t count = 0;
    for (; (u = mps__unit_get(count)) != NULL; count++) {
        char text[40];
        double out[4];
        snprintf(text, sizeof text, "10 %s", u->name);
        const mps__numbers n = read_all(text, u->kinds, out);
        assert_int_equal(n.count, 1);
        assert_ptr_equal(mps__unit_find(u->name, strlen(u->name)), u);
        if (u->scale == SCALE_NONE)
            assert_true(fabs(out[0] / (10 * mps__unit_value(u)) - 1) < 1e-15);
    }
    assert_true(count >= 40);
    assert_null(mps__unit_find("furlong", 7));
    assert_null(mps__unit_get(-1));
}

static void lists(void **state)
{
    double x[4];
    (void)state;
    assert_int_equal(read_all("0 50 mm", UNIT_LENGTH, x).count, 2);
    assert_true(x[0] == 0 && x[1] == 0.05);
    assert_int_equal(read_all("20 dp 1 m 3 4 mm", UNIT_LENGTH, x).count, 4);
    assert_true(x[0] == 20 * 0.004 && x[1] == 1 && x[2] == 0.003 && x[3] == 0.004);
    assert_int_equal(read_all("0 mm -0.5 dp", UNIT_LENGTH, x).count, 2);
    assert_true(x[1] == -0.5 * 0.004);
    assert_int_equal(read_all("0 0 0", UNIT_LENGTH, x).count, 3);
    assert_int_equal(read_all("1 2 3", UNIT_NONE, x).count, 3);
}

/* Which kind of unit a number had. */
static void kinds(void **state)
{
    double x[4];
    (void)state;
    assert_true(read_all("2", UNIT_TIME | UNIT_NONE, x).found == UNIT_NONE);
    assert_true(read_all("2 s", UNIT_TIME | UNIT_NONE, x).found == UNIT_TIME);
    assert_true(read_all("1 mm2/s", UNIT_VISCOSITY, x).found == UNIT_KINEMATIC);
    assert_true(read_all("2 dp", UNIT_LENGTH, x).relative);
    assert_false(read_all("2 m", UNIT_LENGTH, x).relative);
}

static void no(const char *text, uint64_t kinds, const char *why)
{
    double x[4];
    const mps__numbers n = read_all(text, kinds, x);
    if (n.count != -1 || !strstr(n.why, why))
        fail_msg("'%s': %d numbers, '%s', not '%s'", text, (int)n.count, n.why, why);
}

static void refused(void **state)
{
    (void)state;
    no("60", UNIT_TIME, "'60' has no unit; a time is wanted, e.g. '60 s' or '60 T1'");
    no("1 2", UNIT_LENGTH, "'1' has no unit");
    no("1 m 2", UNIT_LENGTH, "'2' has no unit");
    no("1,5 m", UNIT_LENGTH, "decimal point as '.'");
    no("1, 5 m", UNIT_LENGTH, "a list with blanks");
    no("1-3 m", UNIT_LENGTH, "a list with blanks");
    no("1.2.3 m", UNIT_LENGTH, "a list with blanks");
    no("5 MM", UNIT_LENGTH, "did you mean 'mm'?");
    no("5 furlong", UNIT_LENGTH, "units of a length: m, cm, mm");
    no("5 kg", UNIT_LENGTH, "'kg' is the unit of a mass; a length is wanted");
    no("5 s", UNIT_NONE, "'s' is the unit of a time; a number is wanted");
    no("long", UNIT_LENGTH, "'long' is no number");
    no("", UNIT_LENGTH, "is no number");
    no("- 3 m", UNIT_LENGTH, "is no number");
    no("nan m", UNIT_LENGTH, "is no number");
    no("inf", UNIT_LENGTH, "is no number");
    no("0x10 m", UNIT_LENGTH, "no unit");
    no("1e999 m", UNIT_LENGTH, "too large");
    no("1 2 3 4 5 m", UNIT_LENGTH, "more than 4 numbers");
    no("2*3 m", UNIT_LENGTH, "'*3 m' is no unit");
    no("1111111111111111111111111111111111111111111111111111111111111111111 m", UNIT_LENGTH,
       "is no number");
}

static void unknown_scales(void **state)
{
    double x;
    mps__numbers n = {
        .text = "2 T1", .kinds = UNIT_TIME, .scale = {1, NAN, NAN, NAN}, .most = 1, .out = &x};
    (void)state;
    assert_true(mps__numbers_read(&n));
    assert_true(isnan(x));
    assert_string_equal(n.missing, "T1");
}

static void ranges(void **state)
{
    (void)state;
    assert_true(mps__range_holds("", -1, false));
    assert_true(mps__range_holds("> 0", 1, false));
    assert_false(mps__range_holds("> 0", 0, false));
    assert_true(mps__range_holds(">= 0", 0, false));
    assert_false(mps__range_holds(">= 0", -1, false));
    assert_true(mps__range_holds("1 .. 16", 16, false));
    assert_false(mps__range_holds("1 .. 16", 17, false));
    assert_false(mps__range_holds("> 0, < 1", 1, false));
    assert_true(mps__range_holds("> 0, <= 1 kHz", 1000, false));
    assert_false(mps__range_holds("> 0, <= 1 kHz", 1001, false));
    assert_true(mps__range_holds("> 0, < 1", 5, true)); /* 5 dp: only its sign is known */
    assert_false(mps__range_holds("> 0, < 1", -5, true));
}

/* Elements of lists as texts, for sweeps. */
static void split(void **state)
{
    char text[40];
    (void)state;
    assert_true(mps__numbers_split("0.8 0.9 T1 3 s", 1, text, sizeof text));
    assert_string_equal(text, "0.9 T1");
    assert_true(mps__numbers_split("0.8 0.9 T1 3 s", 0, text, sizeof text));
    assert_string_equal(text, "0.8 T1");
    assert_true(mps__numbers_split("0.8 0.9 T1 3 s", 2, text, sizeof text));
    assert_string_equal(text, "3 s");
    assert_false(mps__numbers_split("0.8 0.9 T1 3 s", 3, text, sizeof text));
    assert_true(mps__numbers_split("2 3", 1, text, sizeof text));
    assert_string_equal(text, "3");
    assert_false(mps__numbers_split("2 3 mm", 0, text, 3));
}

/* An application may have another decimal point. */
static void other_locale(void **state)
{
    (void)state;
    locale_begin("de_DE.UTF-8");
    is("1.5 m", UNIT_LENGTH, 1.5);
    no("1,5 m", UNIT_LENGTH, "decimal point");
    locale_end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values),         cmocka_unit_test(all_units),
        cmocka_unit_test(lists),          cmocka_unit_test(kinds),
        cmocka_unit_test(refused),        cmocka_unit_test(ranges),
        cmocka_unit_test(unknown_scales), cmocka_unit_test(split),
        cmocka_unit_test(other_locale)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
