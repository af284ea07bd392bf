/* SPDX-License-Identifier: BSD-3-Clause */
/* Each text that a page reads from a folder, with markup, ends of elements, control characters and
 * bytes that are no UTF-8: the elements of the page are those of a page with plain texts, and each
 * of its data elements is valid JSON. */
#include "page_fixture.h"
#include "json.h"
#include "page_text.h"

/* What a text of a page must not do, with a mark that shows where it got to. */
static const char *const ATTACKS[] = {
    "Zq</script><script>x()</script>",
    "Zq<!-- <script>",
    "Zq<!--",
    "Zq]]>",
    "Zq\\\" onload=\\\"x()",
    "Zq' onload='x()",
    "Zq</title></style></textarea></pre></svg><img src=x onerror=x()>",
    "Zq&lt<b>&amp<i>",
    "Zq\\u0085\\u0001\\u009f\\u007f\\u202e\\u2028\\ufffe",
    "Zq\xff\xc3.\xed\xa0\x80\xf8\xc0\xaf"};
enum { COUNT = sizeof ATTACKS / sizeof ATTACKS[0] };

/* All keys of summary.json whose value is a text of a page, with %s for it. */
static const char SUMMARY[] =
    "{\"dim\": 2, \"dp\": 0.05, \"n_fluid\": 40, \"t_end\": 4.99, \"gravity\": 9.81, \"wall_s\": 7,"
    "\"tank_lo_x\": 0, \"tank_lo_y\": 0, \"tank_size_x\": 2, \"tank_size_y\": 1,\n"
    "\"case\": \"@\", \"title\": \"@\", \"status\": \"@\", \"error\": \"@\", \"version\": \"@\",\n"
    "\"build\": \"@\", \"machine\": \"@\", \"date\": \"@\", \"command\": \"@\", \"ppe_solver\": "
    "\"@\", \"model\": \"@\", \"preset\": \"@\",\n"
    "\"phases\": [{\"name\": \"@\", \"density\": 1000, \"viscosity\": 0.001}],\n"
    "\"solids\": [{\"name\": \"@\"}], \"notes\": [\"@\"], \"messages\": [\"@\"], \"models\": "
    "[\"@\"], "
    "\"plugins\": [{\"name\": \"@\", \"file\": \"@\"}],\n"
    "\"inputs\": [{\"key\": \"@\", \"value\": \"@\"}, {\"key\": \"impacts.share\", \"value\": "
    "\"@\"}],\n"
    "\"figures\": [{\"name\": \"t_end\", \"unit\": \"@\", \"about\": \"@\"}, {\"name\": \"@\"}],\n"
    "\"columns\": [{\"name\": \"P1\", \"unit\": \"Pa\", \"type\": \"wall_pressure\", \"at\": [2, "
    "0.1, 0], \"part\": \"@\", \"about\": \"@\"},\n"
    "{\"name\": \"@\", \"unit\": \"@\", \"type\": \"gauge\", \"at\": [0.1, 0, 0], \"about\": "
    "\"@\"},\n{\"name\": \"F\", \"unit\": \"<b>N\", \"type\": \"force\", \"about\": \"@\"}],\n"
    "\"references\": [{\"label\": \"@\", \"unit\": \"@\", \"column\": \"@\", \"points\": [[1, "
    "2]]}]}\n";

/* The summary with a text instead of each '@'. */
static void write_attacked(const scene *s, const char *text)
{
    char *all = calloc(1, sizeof SUMMARY + 64 * strlen(text)), *to = all;
    assert_non_null(all);
    for (const char *c = SUMMARY; *c; c++) {
        if (*c == '@')
            to += sprintf(to, "%s", text);
        else
            *to++ = *c;
    }
    text_write(s, "summary.json", all);
    free(all);
}

/* The text as bytes: what a CSV file or a case has. */
static void plain_text(const char *text, char out[160])
{
    json_error error;
    char quoted[200];
    snprintf(quoted, sizeof quoted, "\"%s\"", text);
    json_value *value = mps__json_read(quoted, &error);
    assert_non_null(value);
    snprintf(out, 160, "%s", mps__json_text(value));
    mps__json_free(value);
}

static void write_folder(const scene *s, const char *text)
{
    char plain[160], file[600];
    plain_text(text, plain);
    write_attacked(s, text);
    snprintf(file, sizeof file, "t[s],P1[Pa],%.150s[%.150s],F[N]\n0,1,2,3\n1,2,3,4\n2,1,2,3\n",
             plain, plain);
    text_write(s, "probes.csv", file);
    snprintf(file, sizeof file, "mps: 1\ntitle: %s\n", plain);
    text_write(s, "case.yaml", file);
}

/* Names of the elements of a page in their order, as in an HTML parser: the text of script and
 * style ends at its end tag, and "<!--" with "<script" in a script moves that end.
 * @return malloc'd */
static char *elements_of(const char *page)
{
    char *out = calloc(1, strlen(page) + 1), *to = out;
    assert_non_null(out);
    for (const char *c = page; (c = strchr(c, '<')) != NULL;) {
        const size_t length = strcspn(c + 1, " \n\t>/<");
        if (c[1] == '!') assert_true(strncmp(c, "<!DOCTYPE html>", 15) == 0);
        memcpy(to, c, length + 1);
        to += length + 1;
        if (strncmp(c, "<script", 7) != 0 && strncmp(c, "<style", 6) != 0) {
            c++;
            continue;
        }
        const char *begin = strchr(c, '>') + 1;
        const char *end = strstr(begin, c[2] == 'c' ? "</script" : "</style");
        assert_non_null(end);
        if (strstr(c, "json\"") && strstr(c, "json\"") < begin)
            assert_null(memchr(begin, '<', (size_t)(end - begin)));
        for (const char *at = begin; at + 4 < end; at++)
            if (memcmp(at, "<!--", 4) == 0) fail_msg("a script has '<!--': %.40s", at);
        c = end;
    }
    return out;
}

/* Every data element is JSON. @return their number */
static int read_data(const char *page)
{
    static const char begin[] = "<script type=\"application/json\"";
    int count = 0;
    for (const char *c = page; (c = strstr(c, begin)) != NULL; count++) {
        const char *from = strchr(c, '>') + 1, *end = strstr(from, "</script>");
        char *text = strndup(from, (size_t)(end - from));
        json_error error;
        json_value *value = mps__json_read(text, &error);
        if (!value) fail_msg("line %d: %s", error.line, error.why);
        mps__json_free(value);
        free(text);
        c = end;
    }
    return count;
}

/* No control character, and UTF-8 everywhere: U+FFFD is what others became. The exact text of
 * the case may have them. */
static void check_characters(const char *page)
{
    const char *exact = strstr(page, "id=\"case\">"), *end = strstr(exact, "</script>");
    assert_non_null(exact);
    for (const unsigned char *c = (const unsigned char *)page; *c; c++) {
        if ((const char *)c > exact && (const char *)c < end) continue;
        assert_false(*c < 0x20 && *c != '\n' && *c != '\t');
        assert_false(*c == 0x7f || *c == 0xff || (c[0] == 0xc2 && c[1] < 0xa0));
    }
    assert_null(strstr(page, "\xe2\x80\xae") > end ? strstr(page, "\xe2\x80\xae") : NULL);
}

static void every_text(void **unused)
{
    scene s = {.dim = 2, .fluid = 12, .frames = 1, .rows = 20};
    (void)unused;
    scene_create(&s);
    write_folder(&s, "Zq");
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
    char *page = text_read(&s, "report.html", NULL), *wanted = elements_of(page);
    int marks = 0;
    for (const char *c = page; (c = strstr(c, "Zq")) != NULL; c += 2) marks++;
    assert_true(marks > 40);
    const int data = read_data(page);
    assert_int_equal(data, 3);
    free(page);
    for (int k = 0; k < COUNT; k++) {
        write_folder(&s, ATTACKS[k]);
        if (page_of(&s, 0, NULL) != MPS_OK) fail_msg("%s: %s", ATTACKS[k], s.error);
        page = text_read(&s, "report.html", NULL);
        char *got = elements_of(page);
        /* quotes in a CSV header are those of the reader: the column has another name then */
        if (strcmp(got, wanted) != 0 && !strchr(ATTACKS[k], '"'))
            fail_msg("%s changes the elements of the page", ATTACKS[k]);
        assert_int_equal(read_data(page), data);
        check_characters(page);
        const char *quote = strstr(page, "Zq\" onload"), *exact = strstr(page, "id=\"case\">");
        assert_true(!quote || quote > exact); /* in an attribute it would end it */
        free(got);
        free(page);
    }
    free(wanted);
    scene_remove(&s);
}

/* What a function writes. */
static void writes(void (*write)(FILE *out, const char *text), const char *text, const char *wanted)
{
    char *out = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&out, &size);
    assert_non_null(file);
    write(file, text);
    assert_int_equal(fclose(file), 0);
    assert_string_equal(out, wanted);
    free(out);
}

#define NONE "\xef\xbf\xbd"

static void each_character(void **unused)
{
    (void)unused;
    writes(mps__html, "a<b>&\"'\n\t\r\nc", "a&lt;b&gt;&amp;&quot;&#39;\n\t\nc");
    writes(mps__html, "\x01\x7f\xc2\x85\r.", NONE NONE NONE NONE ".");
    writes(mps__html, "\xc3\xa9 \xe2\x82\xac \xf0\x9f\x9a\xa2",
           "\xc3\xa9 \xe2\x82\xac \xf0\x9f\x9a\xa2");
    writes(mps__html, "\xc3", NONE);
    writes(mps__html, "\xe2\x82", NONE NONE);
    writes(mps__html, "\xc0\xaf\xed\xa0\x80\xf4\x90\x80\x80",
           NONE NONE NONE NONE NONE NONE NONE NONE NONE);
    writes(mps__html, "\xe2\x80\xae\xe2\x80\xa8\xe2\x81\xa6\xef\xbf\xbf", NONE NONE NONE NONE);
    writes(mps__json, "a\"\\</script>&\n\t\x1f",
           "\"a\\\"\\\\\\u003c/script\\u003e\\u0026\\n\\t" NONE "\"");
}

/* The case is restored byte by byte. */
static void case_is_exact(void **unused)
{
    static const char text[] = "a: <\\/script> <!-- <script> <\\ <\xc2\x85\r\n\x01\xff</pre>\n";
    scene s = {.dim = 2, .fluid = 12, .frames = 0, .rows = 20};
    (void)unused;
    scene_create(&s);
    text_write(&s, "case.yaml", text);
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
    char *page = text_read(&s, "report.html", NULL);
    const char *c = strstr(page, "id=\"case\">") + strlen("id=\"case\">");
    for (const char *t = text; *t; t++) {
        assert_int_equal(*c++, *t);
        if (*t == '<') assert_int_equal(*c++, '\\');
    }
    assert_int_equal(strncmp(c, "</script>", 9), 0);
    free(page);
    scene_remove(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_text),
                                       cmocka_unit_test(each_character),
                                       cmocka_unit_test(case_is_exact)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
