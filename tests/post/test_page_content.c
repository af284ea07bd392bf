/* SPDX-License-Identifier: BSD-3-Clause */
/* Contents of a page for runs of all kinds: valid and failed ones, thinned curves, pieces of ranks,
 * rigid bodies, pictures. */
#include "page_fixture.h"

/* The page of a scene has, or has not, each of some texts. */
static void check_page(scene *s, const char *const *wanted, size_t count)
{
    assert_int_equal(page_of(s, 0, NULL), MPS_OK);
    char *page = text_read(s, "report.html", NULL);
    for (size_t k = 0; k < count; k++) {
        const bool absent = wanted[k][0] == '!';
        if ((strstr(page, wanted[k] + absent) != NULL) == absent)
            fail_msg("'%s' is %s", wanted[k] + absent, absent ? "there" : "not there");
    }
    free(page);
}
#define CHECK_PAGE(s, ...)                            \
    check_page(s, (const char *const[]){__VA_ARGS__}, \
               sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *))

static void all_that_a_summary_may_say(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 2, .rows = 500};
    (void)unused;
    scene_create(&s);
    write_summary(
        &s,
        ", \"phases\": [{\"name\": \"water\", \"density\": 998, \"viscosity\": 0.001, \"gas\": "
        "false}, {\"density\": 1.2, \"viscosity\": 1.8e-5, \"gas\": true}], \"inputs\": [{\"key\": "
        "\"tank.size\", \"value\": \"2 1 m\"}, {\"key\": \"title\", \"value\": \"twice\"}], "
        "\"front\": "
        "1.25, \"gone\": null, \"figures\": [{\"name\": \"front\", \"about\": \"place of the "
        "front\", "
        "\"unit\": \"m\"}, {\"name\": \"gone\", \"about\": \"when it left\"}, {}], "
        "\"peak_rss_bytes\": "
        "24800000, \"outline\": [[[0, 0], [2, 0], [2, 1]]], \"repeats\": {\"count\": 5, "
        "\"scatter\": "
        "0.12}, \"pressure_scale\": [-100, 1500], \"machine\": \"a <machine>\", \"model\": "
        "\"imps\"");
    CHECK_PAGE(&s, "fluid 0, water</th><td>998 kg/m3, 1 mPa s</td>",
               "fluid 1</th><td>1.2 kg/m3, 0.018 mPa s, gas</td>", "tank.size</th><td>2 1 m",
               "!twice", "front</th><td>1.25 m: place of the front",
               "gone</th><td>not reached: when it left", "largest memory</th><td>24.8 MB",
               "<polygon class=\"tank\" points=\"", "clip-path=\"url(#inside-tank)\"", "5 runs",
               "scatter by 12 %", "\"pressure\": {\"lo\": -100, \"hi\": 1500,", "a &lt;machine&gt;",
               "model</th><td>imps", "\"label\": \"measured\"", "[[0.5, 0.02], [1.005, -0.03]]");
    scene_remove(&s);
}

/* Outlines that are not the tank clip nothing; values that rounding left are 0, and others stay. */
static void sketches(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 0, .rows = 20};
    (void)unused;
    scene_create(&s);
    write_summary(&s, ", \"outline\": [[[1, 0], [1, 0.5]]]");
    CHECK_PAGE(&s, "!Seen along");
    text_write(&s, "probes.csv", "t[s],P1[Pa],eta[m]\n0,0,0\n1,5000,2\n2,-0.001,-0.001\n");
    CHECK_PAGE(&s, "<polygon class=\"tank\" points=\"", "!clip-path", "5 kPa</td>", "0 Pa</td>",
               "!1 mPa",
               "\xe2\x88\x92"
               "1 mm</td>");
    scene_remove(&s);
}

/* In 3-D the view direction of the sketch is the axis with the smaller spread of the sensors. */
static void sides(void **unused)
{
    static const char *const place[][3] = {
        {"[1, 0.5, -2]", "Seen along x: z to the right", ">4 m<"},
        {"[0, 0.5, 2]", "Seen along -z.", ">3 m<"},
        {"[1, 0.5, 2]", "Seen along -z.", ">3 m<"}};
    scene s = {.dim = 3, .fluid = 20, .frames = 0, .rows = 20};
    (void)unused;
    scene_create(&s);
    for (int i = 0; i < 3; i++) {
        char text[1024];
        snprintf(
            text, sizeof text,
            "{\"dim\": 3, \"t_end\": 1, \"tank_lo_x\": 0, \"tank_lo_y\": 0, \"tank_lo_z\": -2, "
            "\"tank_size_x\": 3, \"tank_size_y\": 2, \"tank_size_z\": 4, \"still_level\": 0.5, "
            "\"columns\": [{\"name\": \"P1\", \"unit\": \"Pa\", \"type\": \"wall_pressure\", "
            "\"at\": %s}, {\"name\": \"P2\", \"unit\": \"Pa\", \"type\": "
            "\"wall_pressure\", \"at\": [1, 0.5, 2]}]}",
            place[i][0]);
        text_write(&s, "summary.json", text);
        text_write(&s, "probes.csv", "t[s],P1[Pa],P2[Pa]\n0,0,0\n1,5,2\n");
        CHECK_PAGE(&s, place[i][1], place[i][2]);
    }
    scene_remove(&s);
}

/* A long forced motion: what is lost or gained without a reason is measured by the energy of the
 * walls, where that is the larger one. */
static void energy_of_walls(void **unused)
{
    static const struct {
        double work;
        const char *state, *value, *of;
    } run[] = {
        {0, "Energy <span class=\"state\">poor", "200 %", "largest energy of the motion (4 J"},
        {3, "Energy <span class=\"state\">poor", "200 %", "largest energy of the motion (4 J"},
        {20, "Energy <span class=\"state\">poor", "40 %", "energy that the walls gave (20 J"},
        {-50, "Energy <span class=\"state\">check", "16 %", "energy that the walls gave (50 J"},
        {100, "Energy <span class=\"state\">good", "8 %", "energy that the walls gave (100 J"}};
    scene s = {.dim = 2, .fluid = 20, .frames = 0, .rows = 20};
    (void)unused;
    scene_create(&s);
    for (size_t i = 0; i < sizeof run / sizeof run[0]; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "t[s],ke[J],pe[J],wall_work_momentum[J],numerical[J],shift[J],viscous[J]\n"
                 "0,0,10,0,0,0,0\n1,4,10,%g,-4,0,40\n2,4,10,%g,-8,0,80\n",
                 run[i].work / 2, run[i].work);
        text_write(&s, "probes.csv", text);
        CHECK_PAGE(&s, run[i].state, run[i].value, run[i].of);
    }
    scene_remove(&s);
}

/* A light of each colour. */
static void verdicts(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 0, .rows = 500};
    static const char head[] =
        "t[s],P1[Pa],ke[J],pe[J],numerical[J],shift[J],viscous[J],volume_error\n";
    char text[2048];
    (void)unused;
    scene_create(&s);
    CHECK_PAGE(&s, "checks needs a look", "complete", "0.0499 %",
               "Particles lost <span class=\"state\">good",
               "Resolution of impacts <span class=\"state\">good",
               "One run of an impact is no answer", "Repeats <span class=\"state\">check",
               "crossing times had a standard deviation of 28 %");
    snprintf(text, sizeof text,
             "%s0,0,0,10,0,0,0,0\n1,5,4,12,1,0.5,0.5,-0.03\n2,5,4,12,2.5,1,0.5,0.06\n", head);
    text_write(&s, "probes.csv", text);
    CHECK_PAGE(&s, "Volume <span class=\"state\">poor", "6 %", "Use a finer spacing",
               "Energy <span class=\"state\">poor", "too low", "!id=\"impacts\"");
    snprintf(text, sizeof text,
             "%s0,0,0,10,0,0,0,0\n1,5,4,12,-1,0,0.1,-0.03\n2,5,4,12,-1.2,0,0.1,0.03\n", head);
    text_write(&s, "probes.csv", text);
    CHECK_PAGE(&s, "Volume <span class=\"state\">check", "Energy <span class=\"state\">check",
               "too high");
    text_write(
        &s, "summary.json",
        "{\"status\": \"MPS_W_STOPPED\", \"t_end\": 2, \"n_fluid\": 999, \"particles_lost\": 1}");
    CHECK_PAGE(&s, "interrupted", "mps resume", "Particles lost <span class=\"state\">check",
               "of 1000");
    text_write(&s, "summary.json",
               "{\"status\": \"MPS_E_DIVERGED\", \"error\": \"too fast\", \"n_fluid\": 10, "
               "\"particles_lost\": 1}");
    CHECK_PAGE(&s, "checks are poor", "MPS_E_DIVERGED", "too fast", "try a shorter step");
    text_write(&s, "summary.json", "{}");
    CHECK_PAGE(&s, "Particles lost <span class=\"state\">not known", "A run of libmps");
    scene_remove(&s);
}

/* A smooth pressure is no impact, and an unresolved steep one is reported. */
static void steep_or_not(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 0, .rows = 300};
    char path[128];
    (void)unused;
    scene_create(&s);
    path_of(&s, "probes.csv", path);
    for (int steep = 0; steep < 2; steep++) {
        FILE *file = fopen(path, "w");
        assert_non_null(file);
        fputs("t[s],P1[Pa]\n", file);
        for (int i = 0; i < 3000; i++)
            fprintf(file, "%g,%g\n", 0.001 * i,
                    steep ? (i == 1500) * 1e4 : 500 - 400 * cos(0.005 * i));
        assert_int_equal(fclose(file), 0);
        if (steep)
            CHECK_PAGE(&s, "Resolution of impacts <span class=\"state\">poor",
                       "This peak depends on the spacing", "id=\"impacts\"",
                       "Repeats <span class=\"state\">check", "standard deviation of 36 %");
        else
            CHECK_PAGE(&s, "no steep peak", "Repeats <span class=\"state\">good",
                       "!id=\"impacts\"");
    }
    scene_remove(&s);
}

/* A dry sensor is reported; two events are too few, and the page states the necessary length of the
 * record. */
static void dry(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 0, .rows = 20};
    char path[128];
    (void)unused;
    scene_create(&s);
    text_write(&s, "summary.json",
               "{\"dim\": 2, \"t_end\": 3, \"columns\": [{\"name\": \"P1\", \"unit\": \"Pa\", "
               "\"type\": \"wall_pressure\", \"at\": [0, 0, 0]}, {\"name\": \"P2\", \"unit\": "
               "\"Pa\", \"type\": \"wall_pressure\", \"at\": [0, 1, 0]}]}");
    path_of(&s, "probes.csv", path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("t[s],P1[Pa],P2[Pa]\n", file);
    for (int i = 0; i <= 3000; i++)
        fprintf(file, "%g,%g,0\n", 0.001 * i, (i == 1000 || i == 2000) * 1e4);
    assert_int_equal(fclose(file), 0);
    CHECK_PAGE(&s, "P1: 2 events, highest 10 kPa</summary>", "P2: no pressure</summary>",
               "No liquid came here.", "!highest -",
               "that needs 30 events, there are 2. At this rate a record of 44.8 s has so many: "
               "<code>mps resume</code>");
    scene_remove(&s);
}

/* Of many rows the least and the largest value of each bucket stay. */
static void thinned_curves(void **unused)
{
    enum { ROWS = 50001, PEAK = 31234 };
    scene s = {.dim = 2, .fluid = 20, .frames = 0, .rows = 10};
    char path[128];
    size_t size;
    (void)unused;
    scene_create(&s);
    path_of(&s, "probes.csv", path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("t[s],eta[m]\n", file);
    for (int i = 0; i < ROWS; i++)
        fprintf(file, "%.9g,%.17g\n", 0.001 * i + (i % 2) * 1e-4,
                i == PEAK       ? 7
                : i == PEAK + 3 ? -1
                                : 0.001 * (i % 5));
    assert_int_equal(fclose(file), 0);
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
    char *page = text_read(&s, "report.html", NULL),
         *table = strstr(page, "{\"table\": \"probes.csv\"");
    assert_non_null(table);
    const int points = atoi(strstr(table, "\"points\": ") + 10),
              bucket = atoi(strstr(table, "\"bucket\": ") + 10);
    assert_true(points <= 20000 && bucket == 6 && points == 2 * ((ROWS + bucket - 1) / bucket));
    unsigned char *t = unpacked(strstr(table, "\"t\": {\"data\": \"") + 15, 8 * (size_t)points,
                                &size);
    assert_int_equal(size, 8 * (size_t)points); /* times are not even */
    const char *column = strstr(table, "\"name\": \"eta\"");
    unsigned char *raw = unpacked(strstr(column, "\"data\": \"") + 9, 2 * (size_t)points, &size);
    uint16_t code = 0, most = 0;
    int at = 0;
    for (int i = 0; i < points; i++) {
        code = (uint16_t)(code + raw[i] + 256 * raw[points + i]);
        if (code > most) {
            most = code;
            at = i;
        }
    }
    double time;
    memcpy(&time, t + 8 * at, sizeof time);
    assert_int_equal(most, 65534);
    assert_true(fabs(time - 0.001 * PEAK) <= 0.001 * bucket);
    assert_non_null(strstr(column, "\"lo\": -1, \"hi\": 7,"));
    free(raw);
    free(t);
    free(page);
    scene_remove(&s);
}

/* Pieces of two ranks give the same page as one file. */
static void pieces_of_ranks(void **unused)
{
    scene s = {.dim = 2, .fluid = 50, .frames = 1, .rows = 20};
    char from[128], to[128];
    size_t size, other;
    (void)unused;
    scene_create(&s);
    text_write(&s, "frames.pvd", "<DataSet timestep=\"0\" file=\"frames/a&amp;b.pvtp\"/>\n");
    path_of(&s, "frames/frames_000000.vtp", from);
    path_of(&s, "frames/a_0000.vtp", to);
    assert_int_equal(rename(from, to), 0);
    text_write(&s, "frames/a&b.pvtp", "<Piece Source=\"a_0000.vtp\"/>\n");
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
    char *one = text_read(&s, "report.html", &size);
    scene rest = s;
    rest.fluid = 0; /* a rank with walls alone */
    write_frame(&rest, 0);
    path_of(&s, "frames/a_0001.vtp", to);
    assert_int_equal(rename(from, to), 0);
    text_write(&s, "frames/a&b.pvtp",
               "<Piece Source=\"a_0000.vtp\"/>\n<Piece Source=\"a_0001.vtp\"/>\n");
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
    char *two = text_read(&s, "report.html", &other);
    assert_non_null(strstr(two, "\"count\": 50, \"all\": 50,"));
    assert_non_null(strstr(one, "\"count\": 50, \"all\": 50,"));
    text_write(&s, "frames/a&b.pvtp", "");
    assert_int_equal(page_of(&s, 0, NULL), MPS_E_IO);
    assert_non_null(strstr(s.error, "names no piece"));
    remove(to);
    text_write(&s, "frames/a&b.pvtp", "<Piece Source=\"a_0001.vtp\"/>\n");
    assert_int_equal(page_of(&s, 0, NULL), MPS_E_IO);
    assert_non_null(strstr(s.error, "a_0001.vtp"));
    free(one);
    free(two);
    scene_remove(&s);
}

/* Change a text in a frame by one of the same length. */
static void change_frame(const scene *s, const char *name, const char *from, const char *to)
{
    char path[128];
    size_t size = 0;
    char *data = text_read(s, name, &size), *at = NULL;
    assert_int_equal(strlen(from), strlen(to));
    for (size_t i = 0; !at && i + strlen(from) < size; i++)
        if (memcmp(data + i, from, strlen(from)) == 0) at = data + i;
    assert_non_null(at);
    memcpy(at, to, strlen(to));
    path_of(s, name, path);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    free(data);
}

static void frames_of_others(void **unused)
{
    static const struct {
        const char *from, *to, *error;
    } row[] = {{"LittleEndian", "BigBigEndian", "another order of bytes"},
               {"header_type=\"UInt64\"", "header_type=\"UInt32\"", "another order of bytes"},
               {"NumberOfPoints=\"4", "NumberOfPoints=\"-", "number of points"},
               {"NumberOfComponents=\"3\"", "NumberOfComponents=\"0\"", "an array cannot be read"},
               {"\"UInt8\"", "\"UInt7\"", "an array cannot be read"},
               {"Name=\"velocity\"", "Name=\"velocitx\"", "has no 'velocity' of 3 numbers"},
               {"Name=\"id\"", "Name=\"ix\"", "has no 'id' of 1 numbers"}};
    scene s = {.dim = 2, .fluid = 20, .frames = 2, .rows = 20};
    (void)unused;
    scene_create(&s);
    for (size_t k = 0; k < sizeof row / sizeof row[0]; k++) {
        write_frame(&s, 1);
        change_frame(&s, "frames/frames_000001.vtp", row[k].from, row[k].to);
        assert_int_equal(page_of(&s, 0, NULL), MPS_E_IO);
        if (!strstr(s.error, row[k].error)) fail_msg("'%s' is not in: %s", row[k].error, s.error);
    }
    text_write(&s, "frames/frames_000001.vtp", "nothing");
    assert_int_equal(page_of(&s, 0, NULL), MPS_E_IO);
    scene_remove(&s);
}

/* Frames around peaks are in the film in the order of time, once each; if the page is too small for
 * all, others are omitted. */
static void frames_about_peaks(void **unused)
{
    scene s = {.dim = 2, .fluid = 400, .frames = 9, .rows = 900};
    mps_page_info info;
    char path[128];
    (void)unused;
    scene_create(&s);
    path_of(&s, "peaks", path);
    assert_int_equal(symlink("frames", path), 0);
    text_write(&s, "peaks.pvd",
               "<DataSet timestep=\"2.25\" file=\"peaks/frames_000002.vtp\"/>\n"
               "<DataSet timestep=\"2.5\" file=\"peaks/frames_000003.vtp\"/>\n"
               "<DataSet timestep=\"6\" file=\"peaks/frames_000006.vtp\"/>\n");
    assert_int_equal(page_of(&s, 0, &info), MPS_OK);
    assert_int_equal(info.frames, 11);
    char *page = text_read(&s, "report.html", NULL);
    assert_non_null(strstr(page, "\"t\": [0, 1, 2, 2.25, 2.5, 3, 4, 5, 6, 7, 8]"));
    assert_non_null(strstr(page, "About the highest peaks the film has 2 frames more."));
    free(page);
    mps_page_config config;
    mps_page_config_init(&config, sizeof config);
    config.frames = 6;
    assert_int_equal(mps_page_write(s.folder, &config, &info), MPS_OK);
    page = text_read(&s, "report.html", NULL);
    assert_non_null(strstr(page, "\"t\": [0, 2, 4, 6, 8]"));
    free(page);
    remove(path);
    scene_remove(&s);
}

/* The page of a run in progress states this at the top; models in use and plug-ins are named. */
static void unfinished(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 0, .rows = 20};
    (void)unused;
    scene_create(&s);
    text_write(&s, "summary.json",
               "{\"dim\": 2, \"dp\": 0.05, \"t_end\": 0.19, \"until\": 7, \"status\": "
               "\"unfinished\", \"models\": [\"source.volume\", \"screen.mine\"], \"plugins\": [{"
               "\"name\": \"screen\", \"version\": \"1.2\", \"file\": \"a&b.so\", \"sha256\": "
               "\"0f\", \"items\": [{\"kind\": \"model\", \"name\": \"screen.mine\"}, {\"kind\": "
               "\"load\", \"name\": \"wind\"}]}]}");
    CHECK_PAGE(&s, "This run is not finished: it has come to t = 0.19 s of 7 s.",
               "plug-in screen</th><td>model screen.mine, load wind; version 1.2, file a&amp;b.so, "
               "SHA-256 0f</td>",
               "not finished</p>", "models in use</th><td>source.volume, screen.mine</td>",
               "!complete</p>");
    write_summary(&s, "");
    CHECK_PAGE(&s, "!This run is not finished", "!models in use", "!plug-in ");
    scene_remove(&s);
}

/* Reference values in the plots of their columns, with figures. */
static void known_values(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 0, .rows = 300};
    (void)unused;
    scene_create(&s);
    CHECK_PAGE(&s, "id=\"comparison\"", "<th scope=\"row\">eta</th><td>measured</td>",
               "2 of 2 points, 0.5 s to 1 s");
    text_write(
        &s, "summary.json",
        "{\"dim\": 2, \"dp\": 0.05, \"t_end\": 2.99, \"references\": [{\"label\": \"theory\", "
        "\"unit\": \"m\", \"line\": true, \"points\": [[0, 0], [3, 0]]}, {\"label\": \"late\", "
        "\"unit\": \"m\", \"points\": [[9, 0]]}]}");
    CHECK_PAGE(&s, "<th scope=\"row\">eta</th><td>theory</td><td class=\"number\">71.",
               "<td>late</td><td colspan=\"5\">no common time");
    scene_remove(&s);
}

/* A part whose walls move is a body in the film; the tank itself is at rest. */
static void bodies_move(void **unused)
{
    scene s = {.dim = 2, .fluid = 30, .frames = 3, .rows = 20};
    mps_page_info info;
    (void)unused;
    scene_create(&s);
    s.body = true;
    for (int32_t k = 0; k < s.frames; k++) write_frame(&s, k);
    assert_int_equal(page_of(&s, 0, &info), MPS_OK);
    assert_int_equal(info.particles, 30 + 4);
    char *page = text_read(&s, "report.html", NULL);
    assert_non_null(strstr(page, "id=\"walls\">{\"count\": 20,"));
    assert_non_null(strstr(page, "\"poses\": []"));
    free(page);
    scene_remove(&s);
}

/* Pictures replace the film if there are no frames. */
static void pictures(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 0, .rows = 20};
    (void)unused;
    scene_create(&s);
    text_write(&s, "picture_1.png", "foob");
    text_write(&s, "picture_2.png", "foo");
    text_write(&s, "picture_end.png", "fo");
    CHECK_PAGE(&s, "data:image/png;base64,Zm9vYg==\"", "data:image/png;base64,Zm9v\"",
               "data:image/png;base64,Zm8=\"", "id=\"pictures\"", "!id=\"canvas\"");
    scene_remove(&s);
}

/* Texts that leave no bytes for a film, and texts longer than the limit of the page. */
static void too_large(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 3, .rows = 20};
    mps_page_info info;
    char *text = malloc(300001);
    (void)unused;
    assert_non_null(text);
    memset(text, 'x', 300000);
    scene_create(&s);
    text[110000] = '\0';
    text_write(&s, "case.yaml", text);
    int length = 110000;
    for (; page_of(&s, 500000, &info) == MPS_OK && info.frames > 0; length += 200) {
        memset(text, 'x', 300000);
        text[length] = '\0';
        text_write(&s, "case.yaml", text);
    }
    assert_int_equal(info.frames, 0);
    assert_non_null(strstr(info.left_out, "There is no film"));
    memset(text, 'x', 300000);
    text[300000] = '\0';
    text_write(&s, "case.yaml", text);
    assert_int_equal(page_of(&s, 500000, NULL), MPS_E_ARG);
    assert_non_null(strstr(s.error, "without a film the page has"));
    free(text);
    scene_remove(&s);
}

/* A folder that cannot be written. */
static void nothing_to_write_to(void **unused)
{
    scene s = {.dim = 2, .fluid = 20, .frames = 2, .rows = 20};
    char path[128];
    (void)unused;
    scene_create(&s);
    path_of(&s, "report.html", path);
    assert_int_equal(mkdir(path, 0777), 0);
    assert_int_equal(page_of(&s, 0, NULL), MPS_E_IO);
    assert_non_null(strstr(s.error, "cannot replace"));
    assert_null(text_read(&s, "report.html.tmp", NULL));
    path_of(&s, "report.html.tmp", path);
    assert_int_equal(mkdir(path, 0777), 0);
    assert_int_equal(page_of(&s, 0, NULL), MPS_E_IO);
    assert_non_null(strstr(s.error, "cannot create"));
    rmdir(path);
    path_of(&s, "report.html.part", path);
    assert_int_equal(mkdir(path, 0777), 0);
    assert_int_equal(page_of(&s, 0, NULL), MPS_E_IO);
    assert_non_null(strstr(s.error, "cannot write a part of the page"));
    rmdir(path);
    path_of(&s, "report.html", path);
    rmdir(path);
    FILE *file = fopen((path_of(&s, "summary.json", path), path), "ab");
    assert_non_null(file);
    fputc(0, file);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(page_of(&s, 0, NULL), MPS_E_IO);
    assert_non_null(strstr(s.error, "byte 0"));
    scene_remove(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_that_a_summary_may_say),
                                       cmocka_unit_test(verdicts),
                                       cmocka_unit_test(sketches),
                                       cmocka_unit_test(dry),
                                       cmocka_unit_test(sides),
                                       cmocka_unit_test(energy_of_walls),
                                       cmocka_unit_test(steep_or_not),
                                       cmocka_unit_test(thinned_curves),
                                       cmocka_unit_test(pieces_of_ranks),
                                       cmocka_unit_test(frames_of_others),
                                       cmocka_unit_test(bodies_move),
                                       cmocka_unit_test(unfinished),
                                       cmocka_unit_test(known_values),
                                       cmocka_unit_test(frames_about_peaks),
                                       cmocka_unit_test(pictures),
                                       cmocka_unit_test(too_large),
                                       cmocka_unit_test(nothing_to_write_to)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
