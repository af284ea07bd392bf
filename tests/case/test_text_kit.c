/* SPDX-License-Identifier: BSD-3-Clause */
/* The text kit: edit distance, escapes, arrays that grow, whole files. */
#include "build_kit.h"
#include "escape.h"
#include "grow.h"
#include "run_file.h"
#include "words.h"
#include <errno.h>
#include <unistd.h>

#define FILE_NAME "test_text_kit.txt"

static void distances(void **state)
{
    static const struct {
        const char *a, *b;
        size_t edits;
    } pairs[] = {
        {"", "", 0},          {"roll", "roll", 0},      {"", "roll", 4},     {"rol", "roll", 1},
        {"rolll", "roll", 1}, {"roll", "rool", 1},      {"rlol", "roll", 1}, {"lrlo", "roll", 3},
        {"surge", "sway", 4}, {"gravtiy", "gravity", 1}};
    char longer[80] = "", most[65] = "";
    (void)state;
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        assert_int_equal(mps__word_distance(pairs[k].a, pairs[k].b), pairs[k].edits);
        assert_int_equal(mps__word_distance(pairs[k].b, pairs[k].a), pairs[k].edits);
    }
    memset(longer, 'a', 65);
    memset(most, 'a', 64);
    assert_int_equal(mps__word_distance(longer, "aaa"), 65);
    assert_int_equal(mps__word_distance("aaa", longer), 65);
    assert_int_equal(mps__word_distance(most, "aaa"), 61);
}

static void expect_escaped(const char *text, mps__escape *escape, const char *wanted)
{
    char *written = NULL;
    size_t size;
    FILE *out = open_memstream(&written, &size);
    assert_non_null(out);
    mps__put_escaped(out, text, escape);
    assert_int_equal(fclose(out), 0);
    assert_string_equal(written, wanted);
    free(written);
}

static void escapes(void **state)
{
    static const char text[] = "a<b>&\"c'\\\xc3\xa9\r\n\t\x01\xff\xe2\x80\xae";
    (void)state;
    expect_escaped(text, mps__shown_character,
                   "a<b>&\"c'\\\xc3\xa9\n\t\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
    expect_escaped(text, mps__xml_character,
                   "a&lt;b&gt;&amp;&quot;c&#39;\\\xc3\xa9\n\t\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
    expect_escaped(text, mps__json_character,
                   "a\\u003cb>&\\\"c'\\\\\xc3\xa9\\u000d\\n\\t\\u0001\\ufffd\xe2\x80\xae");
    expect_escaped("\xf0\x9f\x98\x80\xc3", mps__json_character, "\xf0\x9f\x98\x80\\ufffd");
    expect_escaped("", mps__xml_character, "");
}

static void shell_words(void **state)
{
    static const char *const pairs[][2] = {{"run/01-a,b:c+d=e@f%g_h.x", "run/01-a,b:c+d=e@f%g_h.x"},
                                           {"", "\"\""},
                                           {"my tank", "\"my tank\""},
                                           {"it's", "\"it's\""},
                                           {"~", "\"~\""},
                                           {"a\"\\$`b", "\"a\\\"\\\\\\$\\`b\""},
                                           {"\xc3\xa9", "\"\xc3\xa9\""}};
    char word[40], cut[4] = "...";
    (void)state;
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        const size_t length = strlen(pairs[k][1]);
        assert_int_equal(mps__shell_word(pairs[k][0], word, sizeof word), length);
        assert_string_equal(word, pairs[k][1]);
        assert_int_equal(mps__shell_word(pairs[k][0], NULL, 0), length);
    }
    assert_int_equal(mps__shell_word("my tank", cut, sizeof cut), 9);
    assert_string_equal(cut, "\"my");
}

static void arrays(void **state)
{
    int32_t *all = NULL;
    (void)state;
    for (int32_t k = 0; k < 1000; k++) {
        int32_t *more = mps__grown(all, k, sizeof *more);
        assert_non_null(more);
        all = more;
        all[k] = k;
    }
    for (int32_t k = 0; k < 1000; k++) assert_int_equal(all[k], k);
    assert_null(mps__grown(all, 1024, SIZE_MAX / 1024));
    free(all);
}

static char *read_back(const char *bytes, size_t length, size_t most, size_t *size)
{
    FILE *file = fopen(FILE_NAME, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, length, file), length);
    assert_int_equal(fclose(file), 0);
    file = fopen(FILE_NAME, "rb");
    assert_non_null(file);
    char *data = mps__file_read(file, most, size);
    const int number = errno;
    assert_int_equal(fclose(file), 0);
    unlink(FILE_NAME);
    errno = number;
    return data;
}

static void files(void **state)
{
    size_t size = 1;
    (void)state;
    char *data = read_back("", 0, 0, &size);
    assert_non_null(data);
    assert_true(size == 0 && data[0] == '\0');
    free(data);
    data = read_back("one\0two", 7, 7, &size);
    assert_non_null(data);
    assert_int_equal(size, 7);
    assert_memory_equal(data, "one\0two", 8);
    free(data);
    assert_null(read_back("one\0two", 7, 6, &size));
    assert_int_equal(errno, EFBIG);
    assert_int_equal(size, 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(distances), cmocka_unit_test(escapes),
                                       cmocka_unit_test(shell_words), cmocka_unit_test(arrays),
                                       cmocka_unit_test(files)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
