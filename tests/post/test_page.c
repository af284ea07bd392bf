/* SPDX-License-Identifier: BSD-3-Clause */
/* report.html from a folder: its contents, its limit, and damaged folders. */
#include "page_fixture.h"
#include <mps/stats.h>

static double number_in(const char *text, const char *key)
{
    char name[48];
    snprintf(name, sizeof name, "\"%s\": ", key);
    const char *found = strstr(text, name);
    assert_non_null(found);
    return strtod(found + strlen(name), NULL);
}

/* The three numbers of a list. */
static void vector_in(const char *text, const char *key, double out[3])
{
    char name[48], *end = NULL;
    snprintf(name, sizeof name, "\"%s\": [", key);
    const char *found = strstr(text, name);
    assert_non_null(found);
    found += strlen(name);
    for (int d = 0; d < 3; d++) {
        out[d] = strtod(found, &end);
        found = end + 1;
    }
}

/* All frames of the film in a page. */
typedef struct reel {
    int32_t count, dim, values, bits, frames;
    double lo[3], quantum, p_hi;
    int32_t *q;
    unsigned char *value, *ids;
} reel;

static reel reel_read(const char *page)
{
    reel r;
    const char *head = strstr(page, "id=\"film-data\""), *block = head;
    size_t size = 0;
    assert_non_null(head);
    r.count = (int32_t)number_in(head, "count");
    r.dim = (int32_t)number_in(head, "dim");
    r.values = number_in(head, "pockets") > 0 ? 3 : 2;
    r.bits = (int32_t)number_in(head, "bits");
    r.frames = (int32_t)number_in(head, "frames");
    r.quantum = number_in(head, "quantum");
    r.p_hi = number_in(strstr(head, "\"pressure\": {"), "hi");
    vector_in(head, "lo", r.lo);
    const size_t n = (size_t)r.count, most = n * (size_t)(r.frames * (2 * r.dim + r.values));
    r.q = calloc(n * (size_t)(r.frames * r.dim), sizeof *r.q);
    r.value = calloc(n * (size_t)(r.values * r.frames), 1);
    assert_true(r.q && r.value);
    int32_t done = 0;
    while ((block = strstr(block, "class=\"film-block\"")) != NULL) {
        block = strchr(block, '>') + 1;
        unsigned char *raw = unpacked(block, most, &size);
        done += undo_block(raw, size, r.count, r.dim, r.values, r.bits, done, r.q, r.value);
        free(raw);
    }
    assert_int_equal(done, r.frames);
    r.ids = unpacked(strchr(strstr(page, "class=\"film-ids\""), '>') + 1, 5 * n, &size);
    assert_int_equal(size, 5 * n);
    return r;
}

static void reel_free(reel *r)
{
    free(r->q);
    free(r->value);
    free(r->ids);
}

/* Each particle is within half a quantum (and the float of the frame) of where it is in the tank,
 * in each frame, under its own id. */
static void check_reel(const scene *s, const reel *r)
{
    assert_int_equal(r->count, s->fluid);
    assert_int_equal(r->frames, s->frames);
    for (int32_t place = 0; place < r->count; place++) {
        const unsigned char *b = r->ids + 4 * place;
        const int64_t id = b[0] | b[1] << 8 | b[2] << 16 | (int64_t)b[3] << 24;
        const int32_t i = s->fluid - (int32_t)(id / 3);
        assert_true(id % 3 == 0 && i >= 0 && i < s->fluid);
        for (int32_t k = 0; k < r->frames; k++) {
            double X[3];
            place_in_tank(s, i, k, X);
            for (int32_t d = 0; d < r->dim; d++) {
                const double x = r->lo[d] + r->quantum * r->q[(k * r->dim + d) * r->count + place];
                assert_true(fabs(x - X[d]) <= 0.5 * r->quantum + 2e-6);
            }
            const int code = r->value[r->values * k * r->count + place];
            const double p = pressure_of(i, k);
            assert_true(code >= 1);
            if (p <= r->p_hi && code <= 224)
                assert_true(fabs(r->p_hi * (code - 1) / 223 - p) <= 0.51 * r->p_hi / 223);
            if (r->values > 2)
                assert_int_equal(r->value[(r->values * k + 2) * r->count + place],
                                 (int32_t)fmin(pocket_of(s, i, k), 255));
        }
    }
}

static void film_of(int32_t dim, bool moves, int32_t pockets)
{
    scene s = {
        .dim = dim, .fluid = 300, .frames = 13, .rows = 500, .moves = moves, .pockets = pockets};
    mps_page_info info;
    size_t size = 0;
    scene_create(&s);
    assert_int_equal(page_of(&s, 0, &info), MPS_OK);
    char *page = text_read(&s, "report.html", &size);
    assert_int_equal(size, info.bytes);
    assert_int_equal(info.frames, 13);
    assert_int_equal(info.particles, 300);
    assert_string_equal(info.left_out, "");
    reel r = reel_read(page);
    assert_int_equal(r.values, pockets ? 3 : 2);
    check_reel(&s, &r);
    assert_true(moves == (strstr(page, "\"poses\": []") == NULL));
    reel_free(&r);
    free(page);
    scene_remove(&s);
}

static void film_comes_back(void **unused)
{
    (void)unused;
    film_of(2, false, 0);
    film_of(2, true, 6);
    film_of(3, true, 0);
    film_of(3, false, 300); /* numbers above 255 are 255 */
}

/* Sections in their order, escaped texts, no address of a network. */
static void sections_and_texts(void **unused)
{
    static const char *const wanted[] = {
        "<title>Tank &lt;1&gt; &amp; &quot;half&quot; full</title>",
        "id=\"verdict\"",
        "id=\"film\"",
        "id=\"sensors\"",
        "id=\"impacts\"",
        "id=\"forces\"",
        "id=\"budget\"",
        "id=\"about\"",
        "id=\"case\"",
        "id=\"curve-data\"",
        "id=\"film-data\""};
    scene s = {.dim = 2, .fluid = 40, .frames = 3, .rows = 500};
    (void)unused;
    scene_create(&s);
    text_write(&s, "case.yaml", "mps: 1\ntitle: </script><b>&\n");
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
    char *page = text_read(&s, "report.html", NULL);
    const char *at = page;
    for (size_t k = 0; k < sizeof wanted / sizeof wanted[0]; k++) {
        at = strstr(at, wanted[k]);
        if (!at) fail_msg("'%s' is not there, or not in its order", wanted[k]);
    }
    assert_non_null(strstr(
        page,
        "<script type=\"text/yaml\" id=\"case\">mps: 1\ntitle: <\\/script><\\b>&\n</script>"));
    assert_null(strstr(page, "src=\"http"));
    assert_null(strstr(page, "href=\"http"));
    assert_null(strstr(page, "\nimport "));
    assert_non_null(strstr(page, "P1: 4 events"));
    free(page);
    scene_remove(&s);
}

/* Constants of the case are used; invalid ones are reported, and the rest of the page is
 * complete. */
static void constants_of_impacts(void **unused)
{
    static const struct {
        const char *inputs, *wanted;
    } row[] = {{"", "P1: 4 events"},
               {"{\"key\": \"impacts.threshold\", \"value\": \"11500 Pa\"}", "P1: 3 events"},
               {"{\"key\": \"impacts.sensors\", \"value\": \"P2; P1\"}", "P1: 4 events"},
               {"{\"key\": \"impacts.scale\", \"value\": \"40\"}", " kPa in the model, "},
               {"{\"key\": \"impacts.scale\", \"value\": \"40\"}",
                "at full scale pressures are 40 times and times 6.32 times as large"},
               {"{\"key\": \"impacts.scale\", \"value\": \"40\"}, {\"key\": "
                "\"impacts.least_events\", \"value\": \"3\"}",
                "Exceeded once in 3 h at full scale, which is 28 min in the model"},
               {"{\"key\": \"impacts.least_events\", \"value\": \"3\"}", "for screening"},
               {"{\"key\": \"impacts.threshold\", \"value\": \"-1 Pa\"}",
                "1 more began before the record or ended after it. A larger threshold may find"},
               {"{\"key\": \"impacts.share\", \"value\": \"2\"}",
                "There are no statistics: &#39;share&#39; is 2"}};
    scene s = {.dim = 2, .fluid = 20, .frames = 0, .rows = 500};
    char more[200];
    (void)unused;
    scene_create(&s);
    for (size_t k = 0; k < sizeof row / sizeof row[0]; k++) {
        snprintf(more, sizeof more, ", \"inputs\": [%s]", row[k].inputs);
        write_summary(&s, more);
        assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
        char *page = text_read(&s, "report.html", NULL);
        if (!strstr(page, row[k].wanted)) fail_msg("%s: no '%s'", row[k].inputs, row[k].wanted);
        assert_non_null(strstr(page, "id=\"curve-data\""));
        free(page);
    }
    write_summary(&s, ", \"inputs\": [{\"key\": \"impacts.sensors\", \"value\": \"P\"}]");
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
    char *page = text_read(&s, "report.html", NULL);
    assert_null(strstr(page, "P1: "));
    free(page);
    scene_remove(&s);
}

/* Constants of the caller are used instead of those of the run; the page lists the differences. An
 * explicit crossing time is kept. */
static void other_constants(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 0, .rows = 500};
    char error[300] = "";
    mps_page_config config;
    mps_stats_config impacts;
    (void)unused;
    scene_create(&s);
    write_summary(&s, ", \"inputs\": [{\"key\": \"impacts.least_events\", \"value\": \"40\"}]");
    assert_int_equal(mps_page_config_init(&config, sizeof config), MPS_OK);
    assert_null(config.impacts);
    config.error = error;
    config.error_size = sizeof error;
    config.impacts = &impacts;
    impacts.struct_size = 3;
    assert_int_equal(mps_page_write(s.folder, &config, NULL), MPS_E_ARG);
    assert_non_null(strstr(error, "impacts: call mps_stats_config_init() first"));
    assert_int_equal(mps_stats_config_init(&impacts, sizeof impacts), MPS_OK);
    assert_int_equal(mps_stats_config_read(s.folder, &impacts), MPS_OK);
    impacts.threshold = 11500;
    assert_int_equal(mps_page_write(s.folder, &config, NULL), MPS_OK);
    char *page = text_read(&s, "report.html", NULL);
    assert_non_null(strstr(page, "P1: 3 events"));
    assert_non_null(
        strstr(page, ">threshold</th><td>11.5 kPa, set for this page; the run: not given"));
    assert_non_null(strstr(page, ">least events of a fit</th><td>40</td>"));
    free(page);
    impacts.share = 2;
    assert_int_equal(mps_page_write(s.folder, &config, NULL), MPS_OK);
    page = text_read(&s, "report.html", NULL);
    assert_non_null(strstr(page, "There are no statistics: &#39;share&#39; is 2"));
    free(page);
    scene_remove(&s);
}

/* The page is below its limit, states what was omitted, and does not move any particle that it
 * shows. */
static void limit_holds(void **unused)
{
    static const int64_t limit[] = {2000000, 700000, 600000, 500000};
    scene s = {.dim = 3, .fluid = 12000, .frames = 40, .rows = 200, .moves = true};
    int64_t before = INT64_MAX;
    (void)unused;
    scene_create(&s);
    for (int k = 0; k < 4; k++) {
        mps_page_info info;
        size_t size = 0;
        assert_int_equal(page_of(&s, limit[k], &info), MPS_OK);
        char *page = text_read(&s, "report.html", &size);
        assert_true((int64_t)size <= limit[k] && (int64_t)size == info.bytes);
        assert_true(info.bytes <= before);
        before = info.bytes;
        if (k > 0) {
            assert_true(strlen(info.left_out) > 40);
            assert_non_null(strstr(page, info.left_out));
        }
        if (k == 3)
            assert_true(info.particles < 12000 && info.particles >= 1000 && info.frames >= 2);
        free(page);
    }
    scene_remove(&s);
}

static void frames_wanted(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 10, .rows = 20};
    mps_page_config config;
    mps_page_info info;
    (void)unused;
    scene_create(&s);
    mps_page_config_init(&config, sizeof config);
    mps_page_info_init(&info, sizeof info);
    config.frames = 4;
    assert_int_equal(mps_page_write(s.folder, &config, &info), MPS_OK);
    assert_int_equal(info.frames, 4);
    assert_string_equal(info.left_out, "");
    scene_remove(&s);
}

/* A run without frames, of one row, or cut off in its last row still has a page. */
static void little_to_show(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 0, .rows = 1};
    mps_page_info info;
    (void)unused;
    scene_create(&s);
    assert_int_equal(page_of(&s, 0, &info), MPS_OK);
    assert_int_equal(info.frames, 0);
    text_write(&s, "probes.csv", "t[s],P1[Pa]\n0,1\n0.1,2\n0.2,");
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
    text_write(&s, "probes.csv", "t[s],P1[Pa]\n");
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
    text_write(&s, "summary.json", "{}");
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
    scene_remove(&s);
}

/* ---- what is refused ------------------------------------------------------------------------- */

static void expect(scene *s, mps_status status, const char *text)
{
    char *page;
    text_write(s, "report.html", "an earlier page");
    assert_int_equal(page_of(s, 0, NULL), status);
    if (!strstr(s->error, text)) fail_msg("'%s' is not in: %s", text, s->error);
    page = text_read(s, "report.html", NULL);
    assert_string_equal(page, "an earlier page");
    free(page);
    assert_null(text_read(s, "report.html.tmp", NULL));
}

static void broken_tables(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 3, .rows = 50};
    char path[128];
    (void)unused;
    scene_create(&s);
    text_write(&s, "probes.csv", "t[s],P1[Pa]\n0,1\nx,2\n0.2,3\n");
    expect(&s, MPS_E_IO, "probes.csv:3: ");
    text_write(&s, "probes.csv", "");
    expect(&s, MPS_E_IO, "probes.csv: has no line of names");
    path_of(&s, "probes.csv", path);
    remove(path);
    expect(&s, MPS_E_IO, "there is no '");
    write_tables(&s);
    text_write(&s, "summary.json", "{\"dim\": 2,\n\"dim\": 3}");
    expect(&s, MPS_E_IO, "summary.json', line 2: a key stands twice");
    text_write(&s, "summary.json", "[1]");
    expect(&s, MPS_E_IO, "an object is wanted");
    text_write(&s, "summary.json", "{\"dim\": 2");
    expect(&s, MPS_E_IO, "summary.json', line 1");
    text_write(&s, "summary.json", "{}");
    expect(&s, MPS_E_IO, "'dp' or 'dim' is missing");
    path_of(&s, "summary.json", path);
    remove(path);
    expect(&s, MPS_E_IO, "needs the folder of a run");
    scene_remove(&s);
    assert_int_equal(page_of(&s, 0, NULL), MPS_E_IO);
}

static void broken_frames(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 3, .rows = 50};
    char path[128];
    (void)unused;
    scene_create(&s);
    path_of(&s, "frames/frames_000001.vtp", path);
    assert_int_equal(truncate(path, 1500), 0);
    expect(&s, MPS_E_IO, "frames_000001.vtp");
    assert_int_equal(truncate(path, 100), 0);
    expect(&s, MPS_E_IO, "is no frame of this library");
    text_write(&s, "frames/frames_000001.vtp", "");
    expect(&s, MPS_E_IO, "is no frame of this library");
    remove(path);
    expect(&s, MPS_E_IO, "cannot open '");
    s.fluid = 0;
    write_frame(&s, 1);
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK); /* all of them missing in a frame */
    text_write(&s, "frames.pvd",
               "<DataSet timestep=\"0\" file=\"frames/frames_000000.vtp\"/>\n"
               "<DataSet timestep=\"0\" file=\"frames/frames_000002.vtp\"/>\n");
    expect(&s, MPS_E_IO, "times of frames do not increase");
    text_write(&s, "frames.pvd", "<DataSet timestep=\"0\"/>\n");
    expect(&s, MPS_E_IO, "has no time or no file");
    scene_remove(&s);
}

static void arguments(void **unused)
{
    mps_page_config config;
    mps_page_info info = {0};
    char error[128];
    (void)unused;
    assert_int_equal(mps_page_config_init(NULL, sizeof config), MPS_E_ARG);
    assert_int_equal(mps_page_config_init(&config, 3), MPS_E_ARG);
    assert_int_equal(mps_page_info_init(NULL, sizeof info), MPS_E_ARG);
    assert_int_equal(mps_page_info_init(&info, 3), MPS_E_ARG);
    assert_int_equal(mps_page_config_init(&config, sizeof config), MPS_OK);
    config.error = error;
    config.error_size = sizeof error;
    assert_int_equal(mps_page_write(NULL, &config, NULL), MPS_E_ARG);
    assert_non_null(strstr(error, "folder is NULL"));
    assert_int_equal(mps_page_write(NULL, NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_page_write("/nowhere", &config, &info), MPS_E_ARG);
    assert_non_null(strstr(error, "mps_page_info_init()"));
    config.bytes = 499999;
    assert_int_equal(mps_page_write("/nowhere", &config, NULL), MPS_E_ARG);
    assert_non_null(strstr(error, "bytes is 499999: 500000 or more"));
    config.bytes = 500000;
    config.frames = -1;
    assert_int_equal(mps_page_write("/nowhere", &config, NULL), MPS_E_ARG);
    assert_non_null(strstr(error, "frames is -1"));
    config.frames = 0;
    assert_int_equal(mps_page_write("/nowhere", &config, NULL), MPS_E_IO);
    config.struct_size = 0;
    assert_int_equal(mps_page_write("/nowhere", &config, NULL), MPS_E_ARG);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(film_comes_back),      cmocka_unit_test(sections_and_texts),
        cmocka_unit_test(constants_of_impacts), cmocka_unit_test(other_constants),
        cmocka_unit_test(limit_holds),          cmocka_unit_test(frames_wanted),
        cmocka_unit_test(little_to_show),       cmocka_unit_test(broken_tables),
        cmocka_unit_test(broken_frames),        cmocka_unit_test(arguments)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
