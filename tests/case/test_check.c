/* SPDX-License-Identifier: BSD-3-Clause */
/* Output of 'mps check' for a valid case: facts that a user would otherwise find only after the
 * run. */
#include "case_kit.h"
#include <fcntl.h>
#include <math.h>

/* after cmocka.h */
#include "../turns.h"

#define TANK                                                        \
    "mps: 1\ndp: 0.5 m\n"                                           \
    "tank: {size: 20 12 m, chamfer: {bottom: 3 3 m, top: 6 6 m}}\n" \
    "fill: [{water: {depth: 4 m}}]\n"
#define END "run: {until: 1 s}\n"

/* The text, and the messages behind it; the caller frees it. */
static char *checked(const char *case_text)
{
    mps_case *c = NULL;
    char *text = NULL, *sketch = NULL;
    const mps_status status = kit_read(case_text, NULL, &c);
    char *all = kit_messages(c);
    if (status != MPS_OK) fail_msg("%s\n%s", case_text, all);
    free(all);
    if (mps_case_check(c, &text, &sketch) != MPS_OK) fail_msg("%s\n%s", case_text, kit_messages(c));
    all = kit_messages(c);
    const size_t size = strlen(text) + strlen(all) + 1;
    char *both = malloc(size);
    assert_non_null(both);
    snprintf(both, size, "%s%s", text, all);
    free(all);
    free(text);
    free(sketch);
    mps_case_destroy(c);
    return both;
}

static void tells(const char *case_text, const char *wanted, const char *unwanted)
{
    char *text = checked(case_text);
    if (wanted && !strstr(text, wanted)) fail_msg("wanted: %s\n%s", wanted, text);
    if (unwanted && strstr(text, unwanted)) fail_msg("not wanted: %s\n%s", unwanted, text);
    free(text);
}

static void volumes(void **state)
{
    (void)state;
    tells(TANK END, "the tank alone holds 71 m2 up to the level", NULL);
    char *text = checked(TANK END);
    const char *fill = strstr(text, "fill of phase 0: ");
    double built = 0, wanted = 0;
    if (fill) sscanf(fill, "fill of phase 0: %lf m2 of %lf m2", &built, &wanted);
    if (!(fabs(built - 71) < 0.2 && fabs(wanted - 71) < 0.05)) fail_msg("%s", text);
    free(text);
    tells("mps: 1\ndp: 0.5 m\ntank: {size: 20 12 m, chamfer: {bottom: 3 3 m}}\n"
          "fill: [{water: {depth: 4 m}}, {air: rest}]\nmodel: mmps\n" END,
          "library", "fill of phase");
    tells("mps: 1\ndp: 0.5 m\ntank: {size: 10 5 m}\nfill: [{water: {depth: 3 m}}]\n" END,
          "the tank alone holds 30 m2 up to the level", NULL);
    tells("mps: 1\ndp: 0.5 m\ntank: {size: 10 5 m}\nfill: [{water: {box: [0 0 m, 5 3 m]}}]\n" END,
          "of 15 m2 requested", "holds");
    tells("mps: 1\ndp: 0.5 m\ntank: {size: 10 5 m}\nfill: [{water: {box: [0 0 m, 5 3 m]}}]\n" END,
          "of 15 m2 requested", "mps_");
}

/* The enclosed volume of a file: it reveals a wrong unit or axis. */
static void files(void **state)
{
    (void)state;
    tells("mps: 1\ndim: 3\ndp: 100 mm\ntank: {stl: cube.stl, unit: m}\nfill: [{water: {depth: 40 "
          "%}}]\n" END,
          "12 triangles enclose 1 m3 in a box of 1 x 1 x 1 m", "holds");
    tells("mps: 1\ndim: 3\ndp: 1 mm\ntank: {stl: cube.stl, unit: cm}\nfill: [{water: {depth: 40 "
          "%}}]\n" END,
          NULL, "enclose 1 m3");
}

static void plates(void **state)
{
    static const char divides[] = "solid 'b' stands in it, x = 10 m";
    (void)state;
    tells(TANK "solids:\n  b: {plate: [10 0 m, 10 6 m], holes: {pitch: 3 m, open: 40 %}}\n" END,
          "b: plate as built (10, 0) m to (10, 6) m, 2 slots from the first point at 1..2, 4..5 m, "
          "1 m wide = 2 dp, requested 1.2 m",
          NULL);
    /* whole pitches */
    tells(TANK "solids:\n  b: {plate: [10 0 m, 10 6 m], holes: {pitch: 9 m, open: 40 %}}\n" END,
          "1 slot from the first point at 2..4 m, 2 m wide = 4 dp, requested 2.4 m", NULL);
    /* 14 m in seven pitches of 2 m: rounding makes no slot narrower than 2 dp */
    tells("mps: 1\ndp: 0.2 m\ntank: {size: 20 20 m}\nfill: [{water: {depth: 2 m}}]\n"
          "solids:\n  b: {plate: [10 0 m, 10 14 m], holes: {pitch: 2 m, open: 20 %}}\n" END,
          "7 slots from the first point at 0.8..1.2, 2.8..3.2, 4.8..5.2, 6.8..7.2, .., 12.8..13.2 "
          "m, 0.4 m wide = 2 dp, requested 0.4 m",
          NULL);
    tells(TANK "solids:\n  b: {plate: [10 0 m, 10 4.5 m]}\n" END, divides, NULL);
    tells(TANK "solids:\n  b: {plate: [10 0 m, 10 3 m]}\n" END, NULL, divides);
}

/* A box off the lattice keeps its size; a thin one and a plate go to the nearest planes of the
 * lattice. */
static void as_built(void **state)
{
#define SMALL \
    "mps: 1\ndp: 20 mm\ntank: {size: 1 0.6 m}\nfill: [{water: {depth: 0.3 m}}]\nsolids:\n  b: "
    (void)state;
    tells(SMALL "{box: [0.405 0 m, 0.595 0.125 m]}\n" END,
          "b: box as built (0.405, 0) m to (0.595, 0.125) m\n", "requested (");
    tells(SMALL "{box: [0.41 0.1 m, 0.59 0.229 m]}\n" END,
          "b: box as built (0.41, 0.1) m to (0.59, 0.229) m\n", "requested (");
    tells(
        SMALL "{box: [0.401 0 m, 0.601 0.119 m]}\n" END,
        "b: box as built (0.4, 0) m to (0.6, 0.12) m, requested (0.401, 0) m to (0.601, 0.119) m\n",
        NULL);
    tells(
        SMALL "{box: [0.401 0 m, 0.432 0.115 m]}\n" END,
        "b: box as built (0.4, 0) m to (0.44, 0.12) m, requested (0.401, 0) m to (0.432, 0.115) m "
        "(boxes thinner than 3 dp are on the lattice)\n",
        NULL);
    tells(SMALL "{plate: [0.411 0 m, 0.411 0.119 m]}\n" END,
          "b: plate as built (0.42, 0) m to (0.42, 0.12) m, requested (0.411, 0) m to (0.411, "
          "0.119) m "
          "(plates along axes are on the lattice)\n",
          NULL);
#undef SMALL
}

static void sensors(void **state)
{
    (void)state;
    tells(TANK "sensors: {P: {wall: 0.3 4 m}}\n" END, "its place is 0.3 m off the wall", NULL);
    tells(TANK "sensors: {P: {wall: 0 4 m}}\n" END, "P: wall pressure", "off the wall");
    tells(TANK "sensors: {P: {wall: 1.5 1.5 m}}\n" END, "P: wall pressure", "off the wall");
    tells(TANK "sensors: {P: {wall: 0 3 m}}\n" END, ": 'normal' chooses", "probe.normal");
    tells(TANK "sensors: {P: {wall: 0 3 m, normal: 1 0}}\n" END, "P: wall pressure", "chooses");
}

/* Columns made of several probes, or in axes of the ship, are listed too. */
static void columns(void **state)
{
    static const char space[] =
        "mps: 1\ndim: 3\ndp: 1 m\ntank: {size: 20 12 16 m}\nfill: [{water: {depth: 4 m}}]\n"
        "motion: {roll: {amplitude: 1 deg, period: 5 s}}\n"
        "sensors: {F: {force: tank, axes: ship, component: mx}}\n" END;
    (void)state;
    tells(space, "F: Moment of the liquid, roll: along axes of the ship at rest", NULL);
    tells(TANK "sensors: {P: {row: [0 3.5 m, 0 5.5 m], cells: 4}}\n" END,
          "P: Largest wall pressure: of the sensors of a row", NULL);
}

/* A moment is no force: it is about an axis through a point. */
static void forces(void **state)
{
    static const char space[] =
        "mps: 1\ndim: 3\ndp: 1 m\ntank: {size: 20 12 16 m}\nfill: [{water: {depth: 4 m}}]\n"
        "sensors: {F: {force: tank, about: 10 3 8 m}}\n" END;
    (void)state;
    tells(
        TANK "sensors: {F: {force: tank, about: 10 3 m}}\n" END,
        "F_y: force along y on 'tank'\n          F_m: moment about z through (10, 3) m on 'tank'\n",
        "force about");
    tells(space,
          "F_z: force along z on 'tank.'\n          F_mx: moment about x through (10, 3, 8) m",
          "force about");
    tells(space, "F_mz: moment about z through (10, 3, 8) m", NULL);
}

/* A column of a motion with another name is ignored: this must be reported. */
static void motions(void **state)
{
    static const char table[] = "time[s],heave[m],PHI[deg]\n0,0,0\n1,1,1\n2,0,0\n";
    char path[600], text[1600];
    const int fd = open(kit_here(path, sizeof path, "check_motion.csv"),
                        O_CREAT | O_TRUNC | O_WRONLY, 0600);
    (void)state;
    assert_true(fd >= 0);
    assert_int_equal(write(fd, table, strlen(table)), strlen(table));
    close(fd);
    snprintf(text, sizeof text, TANK "motion: {file: %s}\n" END, path);
    tells(text, "; not used: PHI", "roll: at most");
    tells(text, "warning: ", NULL);
    tells(text, "columns that are no motion: PHI; 'columns' says what they are", NULL);
    /* set explicitly: no warning, but listed */
    snprintf(text, sizeof text, TANK "motion: {file: %s, columns: {heave: heave}}\n" END, path);
    tells(text, "; not used: PHI", "no motion");
    snprintf(text, sizeof text, TANK "motion: {file: %s, columns: {heave: heave, roll: PHI}}\n" END,
             path);
    tells(text, "roll: at most 1 deg", "not used");
    unlink(path);
}

/* A bare number gets the unit that is usual for this key. */
static void bare(void **state)
{
    (void)state;
    kit_refused("mps: 1\ndp: 0.2\ntank: {size: 1 1 m}\nfill: [{water: {depth: 30 %}}]\n" END, 2, 5,
                "e.g. '0.2 m' or '0.2 mm'");
    kit_refused("mps: 1\ndp: 0.2 m\ntank: {size: 1 1 m}\nfill: [{water: {depth: 30}}]\n" END, 4, 24,
                "e.g. '30 m' or '30 %'");
}

/* Both periods of a tank whose motion may have all degrees. */
static void periods(void **state)
{
    (void)state;
    tells("mps: 1\ndim: 3\ndp: 2 m\ntank: {size: 40 20 30 m}\nfill: [{water: {depth: 8 m}}]\n" END,
          "along z: T1 7.492 s, estimated by length 30 m and depth 8 m", NULL);
}

#define BOX "mps: 1\ndp: 10 mm\ntank: {size: 0.6 0.3 m}\n"

/* 59 particles are a row of this box, 18.4 rows are 184 mm. */
static void top_rows(void **state)
{
    (void)state;
    tells(BOX "fill: [{water: {depth: 180 mm}}]\n" END, "of all fluid", "the uppermost row");
    char *text = checked(BOX "fill: [{water: {depth: 184 mm}}]\n" END);
    const char *row = strstr(text, "the uppermost row has ");
    const char *off = row ? strstr(row, "half a spacing, ") : NULL;
    double share = 0, percent = 0;
    if (row) sscanf(row, "the uppermost row has %lf %% of the particles of the row below:", &share);
    if (off) sscanf(off, "half a spacing, %lf %% at the bottom", &percent);
    if (!(share > 35 && share < 45) || !(percent > 2.6 && percent < 2.8)) fail_msg("%s", text);
    free(text);
}

/* Steps of 1 ms have a row each; of 8 ms, eight. */
static void rates(void **state)
{
    (void)state;
    tells(BOX "fill: [{water: {depth: 180 mm}}]\nrun: {until: 1 s, dt: 1 ms}\n", "cost", "rows ");
    tells("mps: 1\ndp: 0.5 m\ntank: {size: 10 5 m}\nfill: [{water: {depth: 3 m}}]\nrun: {until: "
          "1 s, dt: 8 ms}\n",
          "1000 Hz: about 8 rows of probes.csv in each step, with the same values; 'output.rate: "
          "1.2e+02 Hz' has one",
          NULL);
}

static void shallow(void **state)
{
    (void)state;
    tells("mps: 1\ndp: 20 mm\ntank: {size: 1 0.6 m}\nfill: [{water: {depth: 3 mm}}]\n"
          "run: {until: 1 s}\n",
          "the liquid is only 0.15 spacings deep: no wave is resolved; give a finer dp", NULL);
    tells("mps: 1\ndp: 20 mm\ntank: {size: 1 0.6 m}\nfill: [{water: {depth: 60 mm}}]\n"
          "run: {until: 1 s}\n",
          NULL, "spacings deep");
    tells("mps: 1\ndp: 20 mm\ntank: {size: 1 0.6 m, chamfer: {bottom: 0.04 m}}\n"
          "fill: [{water: {depth: 100 mm}}]\n" END,
          "about 5 rows of particles: the pressures' level is off by up to half a spacing, 10 % at",
          NULL);
    tells("mps: 1\ndp: 20 mm\ntank: {size: 1 0.6 m}\nfill: [{water: {depth: 100 mm}}]\n" END, NULL,
          "rows of particles");
}

/* The period of frames, and the error of a static pressure below gas: half a spacing of 20 mm. */
static void frames_and_gas(void **state)
{
    static const char text[] =
        "mps: 1\ndp: 20 mm\ntank: {size: 1 0.6 m}\nfill: [{water: {depth: 0.2 m}}, {air: rest}]\n"
        "motion: {surge: {amplitude: 10 mm, period: 1 s, ramp: 1}}\n"
        "sensors: {P: {wall: 0 0.1 m}}\nrun: {until: 10 s}\n";
    (void)state;
    tells(text, "frames    200, every 0.05 s, 20 a period of the motion", NULL);
    tells(text, "static pressures in the liquid are 98 Pa too high: with gas above it", NULL);
}

/* Steps of the calm limit, 0.06 sqrt(dp/g); 0.3 dp over twice the speed of the tank and that of
 * a fall through it. */
static void costs(void **state)
{
    (void)state;
    const char *parts[] = {"motion: {surge: {amplitude: 15 mm, period: 1 s}}\n", ""};
    for (int k = 0; k < 2; k++) {
        char text[600];
        snprintf(text, sizeof text, "%s%sfill: [{water: {depth: 180 mm}}]\n" END, BOX, parts[k]);
        char *out = checked(text);
        const char *steps = strstr(out, "steps of about"), *cost = strstr(out, "cost  ");
        double calm = 0, fast = 0, speed = 0, least = 0, most = 0, took = 0;
        char unit[4] = ""; /* min on a slow machine */
        const double wanted = sqrt(2 * 9.81 * 0.3) + (k ? 0 : 2 * 0.015 * 2 * acos(-1.0));
        if (steps)
            sscanf(steps, "steps of about %lf s, %lf s in liquid of %lf", &calm, &fast, &speed);
        if (cost)
            sscanf(cost,
                   "cost      about %lf to %lf %3s of wall clock: calm to violent; outputs "
                   "apart (%lf s a step",
                   &least, &most, unit, &took);
        if (strcmp(unit, "min") == 0) {
            least *= 60;
            most *= 60;
        }
        if (!(fabs(calm - 0.0019) < 1e-9 && fabs(speed - wanted) < 0.06 &&
              fabs(fast - 0.003 / wanted) < 1e-4))
            fail_msg("%s", out);
        const double ratio = 1.75 * 0.0019157 / (0.003 / wanted);
        if (!(took > 0 && fabs(least / (took / 0.0019157) - 1) < 0.12 &&
              fabs(most / least / ratio - 1) < 0.12))
            fail_msg("%s", out);
        free(out);
    }
    tells(BOX "fill: [{water: {depth: 180 mm}}]\nrun: {until: 1 s, dt: 1 ms}\n",
          "steps of about 0.001 s\n", "in liquid of");
}

/* Steps that are forecast for a table of a surge of 0.1 m/s, with a uniform speed added. */
static void forecast_of(double speed, const char *start, double step[2])
{
    char path[600], text[1600];
    FILE *table = fopen(kit_here(path, sizeof path, "check_uniform.csv"), "w");
    assert_non_null(table);
    fprintf(table, "time[s],surge[m]\n");
    for (int k = 0; k <= 220; k++) {
        const double t = 0.005 * k;
        fprintf(table, "%g,%.15g\n", t, speed * t + 0.02 * sin(5 * t));
    }
    assert_int_equal(fclose(table), 0);
    snprintf(text, sizeof text,
             BOX "motion: {file: %s, start: %s}\nfill: [{water: {depth: 180 mm}}]\n" END, path,
             start);
    char *out = checked(text);
    const char *steps = strstr(out, "steps of about");
    const int found = steps ? sscanf(steps, "steps of about %lf s, %lf s in", &step[0], &step[1])
                            : 0;
    if (found == 1) step[1] = step[0]; /* both are one */
    if (found < 1) fail_msg("%s", out);
    free(out);
    unlink(path);
}

/* Steps use speeds relative to the tank: what tank and liquid have in common costs nothing. */
static void uniform_motions(void **state)
{
    double still[2], both[2], tank[2];
    (void)state;
    forecast_of(0, "tank", still);
    forecast_of(100, "tank", both);
    forecast_of(100, "rest", tank);
    if (!(fabs(both[0] - still[0]) < 1e-9 && fabs(both[1] - still[1]) < 1e-9))
        fail_msg("%g, %g s, at rest %g, %g s", both[0], both[1], still[0], still[1]);
    if (!(tank[1] < 0.05 * still[1])) fail_msg("liquid at rest: %g s", tank[1]);
}

/* The drawing; the caller frees it. */
static char *drawn(const char *case_text)
{
    mps_case *c = NULL;
    char *text = NULL, *sketch = NULL;
    assert_int_equal(kit_read(case_text, NULL, &c), MPS_OK);
    assert_int_equal(mps_case_check(c, &text, &sketch), MPS_OK);
    free(text);
    mps_case_destroy(c);
    return sketch;
}

/* The line of a gauge ends at the chamfer, 4 m above its begin at (0.5, 2.5) m; 560 units are 20 m
 * and four spacings. */
static void drawings(void **state)
{
    (void)state;
    char *svg = drawn(TANK "motion: {centre: 10 3 m, roll: {amplitude: 1 deg, period: 5 s}}\n"
                           "sensors: {eta: {gauge: 0.5 m}}\n" END);
    const char *line = strstr(svg, "stroke='#b00' stroke-dasharray");
    double x1, y1, x2, y2;
    assert_non_null(line);
    while (*line != '<') line--;
    assert_int_equal(sscanf(line, "<line x1='%lf' y1='%lf' x2='%lf' y2='%lf'", &x1, &y1, &x2, &y2),
                     4);
    const double length = (y1 - y2) * 22 / 560;
    if (!(length > 3.9 && length < 4.15)) fail_msg("%s: %g m", "the gauge", length);
    assert_non_null(strstr(svg, "centre of rotation: x 10 m, y 3 m"));
    assert_non_null(strstr(svg, ">centre</text>"));
    assert_null(strstr(svg, "section through"));
    free(svg);
    /* a centre outside of the picture is described in words only */
    svg = drawn(TANK "motion: {centre: 10 -9 m, roll: {amplitude: 1 deg, period: 5 s}}\n" END);
    assert_non_null(strstr(svg, "centre of rotation: x 10 m, y -9 m"));
    assert_null(strstr(svg, ">centre</text>"));
    free(svg);
    /* in 3-D both sections, each with the sensors on its own sides */
    svg = drawn(
        "mps: 1\ndim: 3\ndp: 1 m\ntank: {size: 20 12 16 m, chamfer: {bottom: 3 3 m, top: 4 4 "
        "m, across: z}}\nfill: [{water: {depth: 4 m}}]\n"
        "sensors: {P: {wall: 10 5 16 m}}\n" END);
    const char *across = strstr(svg, "section through the middle along z");
    assert_non_null(across);
    assert_non_null(strstr(across, "section through the middle along x"));
    assert_null(strstr(svg, "motion"));
    const char *polygon = strstr(svg, "<polygon"), *box = strstr(svg, "<g fill='none'");
    assert_true(polygon > across && box < across); /* chamfers are seen in the second one */
    const char *left = strstr(svg, "text-anchor='end'>P<"),
               *right = strstr(across, "text-anchor='start'>P<");
    assert_true(left && left < across && right);
    free(svg);
}

/* The largest distance between walls in a part of the drawing, from their middles, and where it
 * ends [m]. A wall of 20 mm is drawn 10 mm to both sides, in cells of 10 mm. */
static double gap_of(const char *svg, double x_lo, double x_hi, double y_lo, double y_hi,
                     double *end)
{
    bool dark[60] = {false};
    double most = 0, x, y, w, h, left = NAN, floor = NAN;
    for (const char *at = svg; (at = strstr(at, "<rect x='")); at++) {
        char colour[8];
        if (sscanf(at, "<rect x='%lf' y='%lf' width='%lf' height='%lf' fill='%7[^']'", &x, &y, &w,
                   &h, colour) != 5 ||
            strcmp(colour, "#444") != 0)
            continue;
        if (isnan(left)) left = x, floor = y + h; /* the first one is the whole floor */
        const double scale = 1.02 / 529.2, low = (floor - y - h) * scale - 0.01;
        const double from = (x - left) * scale - 0.01, to = from + w * scale;
        if (to < x_lo || from > x_hi || low < y_lo || low > y_hi) continue;
        dark[lround((low - y_lo) / 0.01)] = true;
    }
    int32_t begin = 0, cells = (int32_t)((y_hi - y_lo) / 0.01);
    for (int32_t k = 0; k < cells; k++) {
        if (!dark[k]) continue;
        if ((k - begin + 1) * 0.01 > most)
            most = (k - begin + 1) * 0.01, *end = y_lo + (k + 1) * 0.01;
        begin = k;
    }
    return most;
}

/* Slots and boxes are drawn as built, as the lines say it: slots at .08 .. .14 and .3 .. .36 m, a
 * box from .113 to .287 m. */
static void drawn_as_built(void **state)
{
    double end = 0;
    (void)state;
    char *svg = drawn("mps: 1\ndp: 20 mm\ntank: {size: 1 0.6 m}\n"
                      "solids:\n  wall: {plate: [0.5 0 m, 0.5 0.45 m], holes: {pitch: 0.2 m, open: "
                      "25 %}}\n  s: {box: [0.707 0.113 m, 0.853 0.287 m]}\n"
                      "fill: [{water: {depth: 0.3 m}}]\n" END);
    const double first = gap_of(svg, 0.49, 0.51, 0, 0.2, &end);
    if (!(fabs(first - 0.06) < 0.015 && fabs(end - 0.14) < 0.015))
        fail_msg("first slot: %g m to %g m", first, end);
    const double second = gap_of(svg, 0.49, 0.51, 0.2, 0.45, &end);
    if (!(fabs(second - 0.06) < 0.015 && fabs(end - 0.36) < 0.015))
        fail_msg("second slot: %g m to %g m", second, end);
    const double below = gap_of(svg, 0.75, 0.8, -0.01, 0.2, &end);
    if (!(fabs(below - 0.113) < 0.015 && fabs(end - 0.113) < 0.015))
        fail_msg("below the box: %g m to %g m", below, end);
    free(svg);
}

int main(void)
{
    struct CMUnitTest tests[] = {
        cmocka_unit_test(drawn_as_built), cmocka_unit_test(volumes),
        cmocka_unit_test(files),          cmocka_unit_test(plates),
        cmocka_unit_test(as_built),       cmocka_unit_test(sensors),
        cmocka_unit_test(columns),        cmocka_unit_test(forces),
        cmocka_unit_test(motions),        cmocka_unit_test(bare),
        cmocka_unit_test(periods),        cmocka_unit_test(top_rows),
        cmocka_unit_test(costs),          cmocka_unit_test(rates),
        cmocka_unit_test(frames_and_gas), cmocka_unit_test(shallow),
        cmocka_unit_test(drawings),       cmocka_unit_test(uniform_motions)};
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
