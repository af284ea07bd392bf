/* SPDX-License-Identifier: BSD-3-Clause */
/* Folders unlike those that a run writes: results of a page, pictures and a film. */
#include "page_fixture.h"
#include <mps/picture.h>

/* A page of the folder with some texts, each once at least. */
static void has(scene *s, int count, const char *const *texts)
{
    if (page_of(s, 0, NULL) != MPS_OK) fail_msg("%s", s->error);
    char *page = text_read(s, "report.html", NULL);
    for (int k = 0; k < count; k++)
        if (!strstr(page, texts[k])) fail_msg("'%s' is not there", texts[k]);
    free(page);
}
#define HAS(s, ...)                                                            \
    has(s, (int)(sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *)), \
        (const char *const[]){__VA_ARGS__})

static void refused(scene *s, const char *words)
{
    assert_int_equal(page_of(s, 0, NULL), MPS_E_IO);
    if (!strstr(s->error, words)) fail_msg("'%s' is not in: %s", words, s->error);
}

/* Texts that would end an element or a text of JSON; references with nothing in them; a lattice of
 * boxes. */
static void texts(void **state)
{
    scene s = {.dim = 2, .fluid = 12, .frames = 0, .rows = 20};
    (void)state;
    scene_create(&s);
    text_write(&s, "summary.json",
               "{\"title\": \"T\", \"dim\": 2, \"dp\": 0.05, \"dp_requested\": 0.06, \"lattice\": "
               "[0.05, 0.048], \"columns\": [{\"name\": \"P1\", \"unit\": \"Pa\"}], \"inputs\": "
               "[{}, {\"key\": \"fill\"}, {\"key\": \"model\", \"value\": \"a & b\"}], "
               "\"references\": [{\"label\": \"a \\\"b\\\" \\\\ </script>\\u0007\", \"points\": "
               "[[0, 1], [null, 2], [3], [4, 5]]}, {\"column\": \"P1\"}]}");
    HAS(&s, "\"label\": \"a \\\"b\\\" \\\\ \\u003c/script\\u003e\xef\xbf\xbd\"", "[[0, 1], [4, 5]]",
        "{\"label\": \"reference\", \"unit\": \"\", \"column\": \"P1\", \"line\": false, "
        "\"points\": []}",
        "as requested</th><td>60 mm", "cells</th><td>50 mm x 48 mm", "model</th><td>a &amp; b");
    scene_remove(&s);
}

/* Lines that end as those of other systems do; a unit without an end; more columns than a table
 * has. */
static void tables(void **state)
{
    scene s = {.dim = 2, .fluid = 12, .frames = 0, .rows = 20};
    enum { COLUMNS = 4100 };
    char *many = calloc(2 * COLUMNS + 2, 1);
    (void)state;
    assert_non_null(many);
    scene_create(&s);
    text_write(&s, "probes.csv", "t[s],P1[Pa],h[m\r\n0,1,2\r\n1,7000,4\r\n2,3,4");
    HAS(&s, "\"rows\": 2,", "\"label\": \"h\", \"unit\": \"\",", "\"lo\": 1, \"hi\": 7000,");
    text_write(&s, "probes.csv", "t[s],P1[Pa]\n0,1\n1,2;\n2,3\n");
    refused(&s, "probes.csv:3: ");
    text_write(&s, "probes.csv", "t[s],P1[Pa]\n0,1\n1;2\n2,3\n");
    refused(&s, "probes.csv:3: ");
    for (int k = 0; k < COLUMNS; k++) memcpy(many + 2 * k, "a,", 2);
    many[2 * COLUMNS] = '\n';
    text_write(&s, "probes.csv", many);
    refused(&s, "probes.csv' has 4100 columns, at most 4096 are read");
    free(many);
    scene_remove(&s);
}

#define SERIES "<VTKFile type=\"Collection\"><Collection>\n"

static void series(void **state)
{
    scene s = {.dim = 2, .fluid = 12, .frames = 2, .rows = 20};
    char here[300], text[700];
    (void)state;
    scene_create(&s);
    assert_non_null(getcwd(here, sizeof here));
    snprintf(text, sizeof text,
             SERIES
             "<DataSet timestep=\"0.5\" file=\"%s/%s/frames/frames_000001.vtp\"/>\n<DataSet t",
             here, s.folder);
    text_write(&s, "frames.pvd", text); /* a name from the root; half a tag behind it */
    HAS(&s, "\"frames\": 1,", "\"t\": [0.5],");
    text_write(&s, "frames.pvd", SERIES "<DataSet timestep=\"0\"/>\n");
    refused(&s, "frame 0 has no time or no file");
    text_write(&s, "frames.pvd", SERIES "<DataSet timestep=\"0 file=/>\n");
    refused(&s, "frame 0 has no time or no file");
    text_write(&s, "frames.pvd", SERIES "<DataSet timestep=\"x\" file=\"a\"/>\n");
    refused(&s, "times of frames do not increase at 'x'");
    text_write(&s, "frames.pvd", SERIES "<DataSet timestep=\"inf\" file=\"a\"/>\n");
    refused(&s, "times of frames do not increase at 'inf'");
    scene_remove(&s);
}

/* Bytes of an array in frame 1, from item `first` on: 0 is the first array. */
static void patch(const scene *s, int array, int first, const void *data, size_t size)
{
    static const int item[7] = {12, 12, 4, 1, 1, 4, 8};
    char path[128];
    size_t whole = 0;
    char *text = text_read(s, "frames/frames_000001.vtp", &whole);
    assert_non_null(text);
    char *mark = strstr(text, "encoding=\"raw\">\n_");
    assert_non_null(mark);
    char *at = mark + strlen("encoding=\"raw\">\n_") + 8;
    for (int k = 0; k < array; k++) at += 8 + item[k] * (WALLS + s->fluid);
    memcpy(at + first * item[array], data, size);
    path_of(s, "frames/frames_000001.vtp", path);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, whole, file), whole);
    assert_int_equal(fclose(file), 0);
    free(text);
}

static void frames(void **state)
{
    scene s = {.dim = 2, .fluid = 12, .frames = 2, .rows = 20, .moves = true};
    const float nowhere[3] = {NAN, 0, 0};
    int64_t ids[WALLS];
    (void)state;
    scene_create(&s);
    patch(&s, 0, WALLS + 3, nowhere, sizeof nowhere); /* the others are shown */
    HAS(&s, "\"count\": 12, \"all\": 12,", "\"frames\": 2,");
    ids[0] = 77; /* a wall that the first frame has not */
    patch(&s, 6, WALLS / 2, ids, sizeof *ids);
    HAS(&s, "\"count\": 12, \"all\": 12,");
    for (int k = 0; k < WALLS; k++) ids[k] = 7000 + k;
    patch(&s, 6, 0, ids, sizeof ids);
    refused(&s, "frames_000001.vtp' lacks walls of the first one");
    scene_remove(&s);
}

/* A file larger than any case is not read. */
static void large_case(void **state)
{
    scene s = {.dim = 2, .fluid = 12, .frames = 0, .rows = 20};
    char path[128];
    (void)state;
    scene_create(&s);
    path_of(&s, "case.yaml", path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_int_equal(fseek(file, 4 << 20, SEEK_SET), 0);
    assert_int_equal(fputc('x', file), 'x');
    assert_int_equal(fclose(file), 0);
    refused(&s, "case.yaml' has 4194305 bytes, at most 4194304 are read");
    scene_remove(&s);
}

/* Peaks that grow and shrink slowly, with a sample that is not known. */
static void peaks_in_a_row(void **state)
{
    scene s = {.dim = 2, .fluid = 12, .frames = 0, .rows = 20};
    char *text = calloc(8000, 20);
    size_t used = 0;
    (void)state;
    assert_non_null(text);
    scene_create(&s);
    used += (size_t)sprintf(text, "t[s],P1[Pa]\n");
    for (int k = 0; k < 4000; k++) {
        const int phase = k % 50;
        const double peak = 20000 + 15000 * sin(0.1 * (k / 50));
        used += (size_t)sprintf(text + used, k == 30 ? "%g,nan\n" : "%g,%g\n", 0.01 * k,
                                phase < 3 ? peak * (phase == 1 ? 1 : 0.5) : 0);
    }
    text_write(&s, "probes.csv", text);
    free(text);
    HAS(&s, "Successive peaks depend on each other: the bands are too narrow",
        "<p>1 samples are not known.</p>", " come in a minute. ");
    scene_remove(&s);
}

/* A state for ParaView of a folder whose name is not a plain text of Python, from its root. */
static void names_of_folders(void **state)
{
    scene s = {.dim = 2, .fluid = 12, .frames = 2, .rows = 20};
    char here[300], whole[400], other[64];
    (void)state;
    scene_create(&s);
    snprintf(other, sizeof other, "%.40s's \\ \t", s.folder);
    assert_int_equal(rename(s.folder, other), 0);
    snprintf(s.folder, sizeof s.folder, "%s", other);
    assert_non_null(getcwd(here, sizeof here));
    snprintf(whole, sizeof whole, "%s/%s", here, s.folder);
    assert_int_equal(mps_paraview_save(whole, s.error, sizeof s.error), MPS_OK);
    char *text = text_read(&s, "paraview.py", NULL);
    assert_non_null(text);
    assert_non_null(strstr(text, "written_to = '/"));
    assert_non_null(strstr(text, "\\'s \\\\ \\x09"));
    free(text);
    assert_int_equal(mps_paraview_save("", s.error, sizeof s.error), MPS_E_ARG);
    assert_int_equal(mps_paraview_save("", s.error, 0), MPS_E_ARG);
    scene_remove(&s);
}

/* A film with 24 frames per second; a rate and a width out of range. */
static void films(void **state)
{
    scene s = {.dim = 2, .fluid = 12, .frames = 2, .rows = 20};
    char program[128], error[300] = "";
    mps_film_config config;
    (void)state;
    scene_create(&s);
    text_write(&s, "program",
               "#!/bin/sh\ncat >/dev/null\nfor last do :; done\necho \"$@\" >\"${last#file:}\"\n");
    path_of(&s, "program", program);
    assert_int_equal(chmod(program, 0755), 0);
    mps_film_config_init(&config, sizeof config);
    config.program = program;
    config.error = error;
    config.error_size = sizeof error;
    config.width = 400;
    config.rate = 24;
    if (mps_film_save(s.folder, &config, NULL) != MPS_OK) fail_msg("%s", error);
    char *text = text_read(&s, "film.mp4", NULL);
    assert_non_null(text);
    assert_non_null(strstr(text, "-framerate 24000/1000 "));
    free(text);
    config.rate = 121;
    assert_int_equal(mps_film_save(s.folder, &config, NULL), MPS_E_ARG);
    assert_non_null(strstr(error, "rate is 121"));
    config.rate = NAN;
    assert_int_equal(mps_film_save(s.folder, &config, NULL), MPS_E_ARG);
    config.rate = 0;
    config.width = 399;
    assert_int_equal(mps_film_save(s.folder, &config, NULL), MPS_E_ARG);
    assert_non_null(strstr(error, "width is 399"));
    config.program = NULL;
    config.width = 400;
    config.error_size = 0;
    assert_int_equal(mps_film_save(s.folder, &config, NULL), MPS_E_ARG);
    scene_remove(&s);
}

/* A link of a file of the folder to one that is not in it: of each file that a page, statistics
 * and pictures read. */
static void links_out(void **state)
{
    static const char *const files[] = {
        "summary.json", "probes.csv", "steps.csv",     "momentum.csv",
        "case.yaml",    "frames.pvd", "picture_1.png", "frames/frames_000001.vtp"};
    scene s = {.dim = 2, .fluid = 12, .frames = 2, .rows = 20}, other = s;
    (void)state;
    scene_create(&other);
    text_write(&other, "secret", "TOPSECRET");
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        char path[128], to[128], back[160];
        scene_create(&s);
        if (strncmp(files[k], "picture", 7) == 0) { /* pictures are looked at without frames */
            path_of(&s, "frames.pvd", path);
            remove(path);
        }
        path_of(&s, files[k], path);
        remove(path);
        path_of(&other, strstr(files[k], "vtp") ? files[k] : "secret", to);
        snprintf(back, sizeof back, "../%s%s", strchr(files[k], '/') ? "../" : "", to);
        assert_int_equal(symlink(back, path), 0);
        refused(&s, "it leads out of the folder of the run");
        assert_non_null(strstr(s.error, files[k]));
        scene_remove(&s);
    }
    scene_remove(&other);
}

/* A folder whose name is a link, and links within the folder, are accepted. Names with ".." and
 * absolute names are refused, a pipe does not block. */
static void links_in(void **state)
{
    scene s = {.dim = 2, .fluid = 12, .frames = 2, .rows = 20}, by_link = s;
    char from[128], to[128];
    (void)state;
    scene_create(&s);
    path_of(&s, "probes.csv", from);
    path_of(&s, "rows.csv", to);
    assert_int_equal(rename(from, to), 0);
    assert_int_equal(symlink("rows.csv", from), 0);
    snprintf(by_link.folder, sizeof by_link.folder, "%.50s_link", s.folder);
    assert_int_equal(symlink(s.folder, by_link.folder), 0);
    HAS(&by_link, "\"rows\": 20,");
    remove(by_link.folder);
    snprintf(to, sizeof to, "<DataSet timestep=\"0\" file=\"../%s_beside\"/>\n", s.folder);
    text_write(&s, "frames.pvd", to);
    snprintf(to, sizeof to, "%s_beside", s.folder);
    fclose(fopen(to, "w"));
    refused(&s, "it leads out of the folder of the run");
    text_write(&s, "frames.pvd", "<DataSet timestep=\"0\" file=\"/etc/passwd\"/>\n");
    refused(&s, "it leads out of the folder of the run");
    remove(to);
    remove(from);
    assert_int_equal(mkfifo(from, 0666), 0);
    refused(&s, "it is a pipe (FIFO), no regular file");
    scene_remove(&s);
}

/* What a page writes replaces a link; the file behind it stays as it is. */
static void links_of_outputs(void **state)
{
    static const char *const files[] = {"report.html", "report.html.tmp", "report.html.part"};
    scene s = {.dim = 2, .fluid = 12, .frames = 0, .rows = 20};
    char path[128];
    (void)state;
    scene_create(&s);
    text_write(&s, "precious", "as it was");
    for (int k = 0; k < 3; k++) {
        path_of(&s, files[k], path);
        remove(path);
        assert_int_equal(symlink("precious", path), 0);
    }
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
    char *text = text_read(&s, "precious", NULL);
    assert_string_equal(text, "as it was");
    free(text);
    scene_remove(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(links_out),
                                       cmocka_unit_test(links_in),
                                       cmocka_unit_test(links_of_outputs),

                                       cmocka_unit_test(texts),
                                       cmocka_unit_test(tables),
                                       cmocka_unit_test(series),
                                       cmocka_unit_test(frames),
                                       cmocka_unit_test(large_case),
                                       cmocka_unit_test(peaks_in_a_row),
                                       cmocka_unit_test(films),
                                       cmocka_unit_test(names_of_folders)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
