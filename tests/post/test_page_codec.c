/* SPDX-License-Identifier: BSD-3-Clause */
/* Packing of films and curves, undone by code of its own. */
#include "page_fixture.h"
#include "page_codec.h"
#include "page_scale.h"
#include "page_text.h"

static uint32_t random_next(uint32_t *state)
{
    return *state = *state * 1664525u + 1013904223u;
}

/* base64 as text. */
static char *text_of(const codec_bytes *bytes)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    mps__codec_base64(out, bytes);
    assert_int_equal(fclose(out), 0);
    return text;
}

/* Random integers of all sizes are restored exactly, across blocks. */
static void round_trip(int32_t dim, int32_t values, int32_t bits, int32_t count)
{
    enum { FRAMES = 9 };
    const int32_t block[] = {1, 3, 5};
    codec c;
    uint32_t state = 7;
    uint16_t *q = calloc((size_t)(FRAMES * dim * count), sizeof *q);
    int32_t *back = calloc((size_t)(FRAMES * dim * count), sizeof *back);
    unsigned char *value = calloc((size_t)(FRAMES * values * count), 2),
                  *undone = value + FRAMES * values * count;
    assert_true(q && back && value && mps__codec_create(&c, count, dim, values, bits));
    for (int32_t i = 0; i < FRAMES * dim * count; i++)
        q[i] = (uint16_t)(random_next(&state) >> (32 - bits));
    for (int32_t i = 0; i < FRAMES * values * count; i++)
        value[i] = (unsigned char)(random_next(&state) >> 24);
    for (int32_t b = 0, k = 0, done = 0; b < 3; b++) {
        codec_bytes bytes = {0};
        size_t size;
        for (int32_t n = 0; n < block[b]; n++, k++)
            assert_true(
                mps__codec_frame(&c, q + k * dim * count, value + values * k * count, &bytes));
        assert_true(mps__codec_end(&c, &bytes));
        char *text = text_of(&bytes);
        unsigned char *raw = unpacked(text, (size_t)(FRAMES * (2 * dim + values) * count), &size);
        assert_int_equal(undo_block(raw, size, count, dim, values, bits, done, back, undone),
                         block[b]);
        done += block[b];
        free(raw);
        free(text);
        free(bytes.data);
    }
    for (int32_t i = 0; i < FRAMES * dim * count; i++) assert_int_equal(back[i], q[i]);
    assert_memory_equal(undone, value, (size_t)(FRAMES * values * count));
    mps__codec_free(&c);
    free(q);
    free(back);
    free(value);
}

static void frames_come_back(void **unused)
{
    (void)unused;
    round_trip(2, 2, 12, 501);
    round_trip(3, 3, 12, 333);
    round_trip(3, 2, 10, 97);
    round_trip(2, 2, 16, 64);
    round_trip(2, 3, 12, 1);
}

/* Half a step of 1/65534 of the range; what is not a number stays none. */
static void curves_come_back(void **unused)
{
    enum { N = 1000 };
    double value[N];
    codec_bytes bytes = {0};
    size_t size;
    uint16_t code = 0;
    (void)unused;
    for (int i = 0; i < N; i++) value[i] = i % 97 == 5 ? NAN : -3 + 7 * sin(0.1 * i * i);
    assert_true(mps__codec_curve(value, N, 1, -10, 4, &bytes));
    char *text = text_of(&bytes);
    unsigned char *raw = unpacked(text, 2 * N, &size);
    assert_int_equal(size, 2 * N);
    for (int i = 0; i < N; i++) {
        code = (uint16_t)(code + raw[i] + 256 * raw[N + i]);
        if (isnan(value[i]))
            assert_int_equal(code, 65535);
        else
            assert_true(fabs(-10 + 14.0 * code / 65534 - value[i]) <= 7.0 / 65534 * (1 + 1e-9));
    }
    free(raw);
    free(text);
    free(bytes.data);
}

/* RFC 4648, section 10. */
static void base64_of_the_standard(void **unused)
{
    static const char *const pair[][2] = {{"", ""},
                                          {"f", "Zg=="},
                                          {"fo", "Zm8="},
                                          {"foo", "Zm9v"},
                                          {"foob", "Zm9vYg=="},
                                          {"fooba", "Zm9vYmE="},
                                          {"foobar", "Zm9vYmFy"}};
    (void)unused;
    for (size_t k = 0; k < sizeof pair / sizeof pair[0]; k++) {
        char in[8];
        snprintf(in, sizeof in, "%s", pair[k][0]);
        const codec_bytes bytes = {.data = (unsigned char *)in, .size = strlen(in)};
        char *text = text_of(&bytes);
        assert_string_equal(text, pair[k][1]);
        free(text);
    }
}

/* Bytes increase with the value, are never 0, and represent values of the scale with an error of
 * half of 1/223. */
static void bytes_of_a_scale(void **unused)
{
    page_scale s = {0};
    (void)unused;
    for (int i = 0; i <= 1000; i++) assert_true(mps__scale_take(&s, i < 995 ? i : 40000));
    assert_true(mps__scale_take(&s, NAN));
    mps__scale_end(&s, 1, false);
    assert_true(s.lo == 0 && s.hi == 990 && s.most == 40000);
    for (int i = 0; i <= 990; i++) {
        const int code = mps__scale_code(&s, i);
        assert_true(code >= 1 && code <= 224);
        assert_true(fabs(990.0 * (code - 1) / 223 - i) <= 990.0 / 223 / 2 * (1 + 1e-9));
        assert_true(code <= mps__scale_code(&s, i + 1));
    }
    assert_int_equal(mps__scale_code(&s, 40000), 255);
    assert_int_equal(mps__scale_code(&s, 1e9), 255);
    assert_int_equal(mps__scale_code(&s, -5), 1);
    assert_int_equal(mps__scale_code(&s, NAN), 1);
}

/* Of several phases the scale begins at the 1 % quantile where that is negative; noise is no
 * scale. */
static void ends_of_a_scale(void **unused)
{
    page_scale s = {0}, quiet = {0};
    (void)unused;
    for (int i = -500; i <= 500; i++) assert_true(mps__scale_take(&s, i));
    mps__scale_end(&s, 1, true);
    assert_true(s.lo == -490 && s.hi == 490);
    for (int i = 0; i < 100; i++) assert_true(mps__scale_take(&quiet, 1e-9));
    mps__scale_end(&quiet, 0.123, true);
    assert_true(quiet.lo == 0 && fabs(quiet.hi - 0.13) < 1e-12);
}

static void numbers_as_a_person_rounds(void **unused)
{
    static const struct {
        double value;
        const char *unit, *text;
    } row[] = {{14001.17, "Pa", "14 kPa"},
               {999.6, "Pa", "1 kPa"},
               {-106.2, "Pa",
                "\xe2\x88\x92"
                "106 Pa"},
               {0.0654, "m", "65.4 mm"},
               {0.8, "m", "0.8 m"},
               {5.4000000000000004, "s", "5.4 s"},
               {0.00321, "s", "3.21 ms"},
               {2.3e6, "N m", "2.3 MN m"},
               {0.7523, "J/m", "0.752 J/m"},
               {12437, "", "12,400"},
               {0, "Pa", "0 Pa"},
               {NAN, "Pa", "-"},
               {1e-9, "", "1.0e-09"},
               {0.004, "J/m", "4 mJ/m"}};
    char out[TEXT_NUMBER];
    (void)unused;
    for (size_t k = 0; k < sizeof row / sizeof row[0]; k++)
        assert_string_equal(mps__quantity(out, row[k].value, row[k].unit), row[k].text);
    assert_string_equal(mps__whole(out, 12437), "12,437");
    assert_string_equal(mps__whole(out, 1234567), "1,234,567");
    assert_string_equal(mps__whole(out, 999), "999");
    assert_string_equal(mps__duration(out, 10800), "3 h");
    assert_string_equal(mps__duration(out, 7500), "2 h 5 min");
    assert_string_equal(mps__duration(out, 300), "5 min");
    assert_string_equal(mps__duration(out, 75), "75 s");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_come_back),       cmocka_unit_test(curves_come_back),
        cmocka_unit_test(base64_of_the_standard), cmocka_unit_test(bytes_of_a_scale),
        cmocka_unit_test(ends_of_a_scale),        cmocka_unit_test(numbers_as_a_person_rounds)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
