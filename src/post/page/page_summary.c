/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks of a page: whether the run can be trusted, and if not, what to do. Limits are those of
 * docs/explanations/accuracy.md and impacts.md. */
#include "page_parts.h"
#include "page_text.h"
#include "tables.h"
#include <math.h>
#include <string.h>

/* A rise of more crossing times is not an impact. */
enum { SMOOTH = 25 };

/* Scatter of impact peaks between repeats, by their rise in crossing times: standard deviation of a
 * run. Measured in 20 moved tanks with three spacings by scripts/impacts;
 * docs/explanations/impacts.md has the table. */
static const struct {
    double rise, deviation;
} scatter_of[] = {{1.5, 0.36}, {INFINITY, 0.28}};

/* Scatter of repeats below which a peak is good, and above which it is poor. */
static const double SCATTER_GOOD = 0.2, SCATTER_POOR = 0.5;

typedef enum state { GOOD, LOOK, POOR, UNKNOWN } state;

/* A check. */
typedef struct light {
    const char *name;
    state state;
    char value[64], text[320], advice[320];
} light;

static state by_limits(double value, double good, double poor)
{
    if (!isfinite(value)) return UNKNOWN;
    return value <= good ? GOOD : value <= poor ? LOOK : POOR;
}

/* ---- the run as a whole ---- */

static light light_end(const page_run *r)
{
    light l = {.name = "End of the run"};
    char t[TEXT_NUMBER], until[TEXT_NUMBER];
    const char *status = mps__page_string(r, "status"), *error = mps__page_string(r, "error");
    const bool ok = strcmp(status, "ok") == 0, stopped = strcmp(status, "MPS_W_STOPPED") == 0;
    const bool unfinished = mps__page_is_unfinished(r), part = stopped || unfinished;
    l.state = ok ? GOOD : part ? LOOK : POOR;
    snprintf(l.value, sizeof l.value, "%.40s",
             ok           ? "complete"
             : stopped    ? "interrupted"
             : unfinished ? "not finished"
             : status[0]  ? status
                          : "not known");
    mps__quantity(t, mps__page_number(r, "t_end"), "s");
    mps__quantity(until, mps__page_number(r, "until"), "s");
    if (part)
        snprintf(l.text, sizeof l.text, "Unfinished, at t = %s of %s.", t, until);
    else
        snprintf(l.text, sizeof l.text, "The run reached t = %s.%s%.200s", t, error[0] ? " " : "",
                 error);
    if (part)
        snprintf(l.advice, sizeof l.advice,
                 "What is shown ends there. If the run is not in progress, 'mps resume' with its "
                 "folder continues it.");
    else if (!ok)
        snprintf(l.advice, sizeof l.advice,
                 "Nothing after the last row is known. Look at the last frames of the film, then "
                 "try a shorter step or a finer spacing.");
    return l;
}

static double largest(const mps__csv *t, const char *name)
{
    const int32_t k = mps__page_table_find(t, name);
    double most = NAN;
    for (int64_t i = 0; k >= 0 && i < t->rows; i++) {
        const double v = fabs(t->value[k][i]);
        if (isfinite(v) && !(most >= v)) most = v;
    }
    return most;
}

static light light_volume(const page_run *r)
{
    light l = {.name = "Volume"};
    char number[TEXT_NUMBER];
    const double most = largest(&r->probes, "volume_error");
    l.state = by_limits(most, VOLUME_GOOD, 0.05);
    snprintf(l.value, sizeof l.value, "%s %%", mps__rounded(number, 100 * most));
    snprintf(l.text, sizeof l.text,
             "Largest change of the liquid's volume since the first step. Below %g %% is good.",
             100 * VOLUME_GOOD);
    if (l.state == LOOK || l.state == POOR)
        snprintf(l.advice, sizeof l.advice,
                 "Levels and static pressures are off by about as much. Use a finer spacing or a "
                 "shorter step.");
    return l;
}

static light light_lost(const page_run *r)
{
    light l = {.name = "Particles lost"};
    char number[TEXT_NUMBER], all[TEXT_NUMBER];
    const double lost = mps__page_number(r, "particles_lost"), n = mps__page_number(r, "n_fluid");
    l.state = by_limits(lost / fmax(n + lost, 1), 0, 1e-3);
    snprintf(l.value, sizeof l.value, "%s",
             isfinite(lost) ? mps__whole(number, (int64_t)lost) : "-");
    snprintf(l.text, sizeof l.text, "Removed because they left the domain, of %s.",
             mps__whole(all, isfinite(n) ? (int64_t)(n + fmax(lost, 0)) : 0));
    if (l.state == LOOK || l.state == POOR)
        snprintf(l.advice, sizeof l.advice,
                 "In a closed tank none may be lost: look for a gap in the walls, or use a shorter "
                 "step. An open tank may spill.");
    return l;
}

/* ---- energy ---- */

/* Mean horizontal velocity of the liquid in the run, along x and z. Energies are relative to it:
 * the uniform motion of a tank is not energy of its waves. */
typedef struct inertial_frame {
    const mps__csv *momentum;
    double mass, velocity[2];
    int64_t from; /* first row behind the first step */
} inertial_frame;

static const char *const along[2] = {"x", "z"};

/* A value of momentum.csv along an axis in a row; 0 if there is no such column. */
static double momentum_at(const inertial_frame *f, const char *name, int axis, int64_t row)
{
    char column[32];
    snprintf(column, sizeof column, "%s_%s", name, along[axis]);
    const int32_t k = f->velocity[axis] != 0 ? mps__page_table_find(f->momentum, column) : -1;
    return k >= 0 ? f->momentum->value[k][row] : 0;
}

/* The weight times the time is a column: it gives the mass. Zero velocity if there is none. Liquid
 * that begins with its tank takes its velocity in the first step, and rows in it are between both
 * values. */
static inertial_frame frame_of(const page_run *r)
{
    const mps__csv *t = &r->momentum;
    const int32_t weight = mps__page_table_find(t, "gravity_y");
    inertial_frame f = {.momentum = t};
    if (weight < 0 || t->rows < 2 || t->rows != r->probes.rows) return f;
    const int64_t last = t->rows - 1;
    const double first_step = r->steps.rows > 0 ? r->steps.value[0][0] : 0;
    while (f.from < last && t->value[0][f.from] < first_step) f.from++;
    f.mass = fabs(t->value[weight][last]) / (mps__page_number(r, "gravity") * t->value[0][last]);
    for (int axis = 0; axis < 2 && isfinite(f.mass) && f.mass > 0; axis++) {
        f.velocity[axis] = 1; /* for momentum_at() */
        double sum = 0;
        for (int64_t i = f.from; i < t->rows; i++) sum += momentum_at(&f, "momentum", axis, i);
        f.velocity[axis] = isfinite(sum) ? sum / (double)(t->rows - f.from) / f.mass : 0;
    }
    return f;
}

/* Energy in the wave: the largest kinetic energy and change of the potential one. */
static double wave_energy(const mps__csv *t, const inertial_frame *f)
{
    const int32_t ke = mps__page_table_find(t, "ke"), pe = mps__page_table_find(t, "pe");
    double most = NAN;
    if (ke < 0 || pe < 0) return NAN;
    for (int64_t i = f->from; i < t->rows; i++) {
        double e = t->value[ke][i] + fabs(t->value[pe][i] - t->value[pe][0]);
        for (int axis = 0; axis < 2; axis++)
            e += f->velocity[axis] *
                 (0.5 * f->mass * f->velocity[axis] - momentum_at(f, "momentum", axis, i));
        if (isfinite(e) && !(most >= e)) most = e;
    }
    return most;
}

/* Largest work of the walls. */
static double wall_work(const mps__csv *t, const inertial_frame *f)
{
    const int32_t k = mps__page_table_find(t, "wall_work_momentum");
    double most = NAN;
    for (int64_t i = 0; k >= 0 && i < t->rows; i++) {
        double work = t->value[k][i];
        for (int axis = 0; axis < 2; axis++)
            work -= f->velocity[axis] *
                    (momentum_at(f, "pressure", axis, i) + momentum_at(f, "reaction", axis, i));
        if (isfinite(work) && !(most >= fabs(work))) most = fabs(work);
    }
    return most;
}

static double last_of(const page_run *r, const char *name)
{
    const double v = mps__page_table_last(&r->probes, mps__page_table_find(&r->probes, name));
    return isfinite(v) ? v : 0;
}

/* A forced motion passes energy through the liquid during the whole run, and dissipation scales
 * with it: the reference is the larger of the energy of the wave and the work of the walls. */
static double measure_of_energy(const page_run *r, const inertial_frame *f, bool *walls)
{
    const double wave = wave_energy(&r->probes, f), work = wall_work(&r->probes, f);
    *walls = work > wave;
    return *walls ? work : wave;
}

/* An energy gain becomes random motion, which dissipation and shift remove: their sum shows whether
 * the wave keeps its energy. If the liquid is viscous, only the numerical part is checked. */
static light light_energy(const page_run *r)
{
    light l = {.name = "Energy"};
    char share[TEXT_NUMBER], base[TEXT_NUMBER], rest[TEXT_NUMBER];
    const char *unit = mps__page_number(r, "dim") == 3 ? "J" : "J/m";
    bool walls = false;
    const inertial_frame f = frame_of(r);
    const double all = measure_of_energy(r, &f, &walls), numerical = last_of(r, "numerical");
    double sum = numerical + last_of(r, "shift") + last_of(r, "viscous");
    for (int axis = 0; axis < 2; axis++)
        sum += f.velocity[axis] * momentum_at(&f, "shift", axis, f.momentum->rows - 1);
    const double open = fmin(fabs(numerical), fabs(sum));
    l.state = by_limits(all > 0 ? open / all : NAN, 0.1, 0.3);
    snprintf(l.value, sizeof l.value, "%s %%", mps__rounded(share, 100 * open / all));
    snprintf(l.text, sizeof l.text,
             "Energy that came or went without a physical reason (%s), of the %s (%s). Below 10 %% "
             "is good.",
             mps__quantity(rest, open, unit),
             walls ? "energy that the walls gave" : "largest energy of the motion",
             mps__quantity(base, all, unit));
    if (l.state == UNKNOWN) snprintf(l.text, sizeof l.text, "The liquid did not move.");
    if (l.state == LOOK || l.state == POOR)
        snprintf(l.advice, sizeof l.advice,
                 "The wave may be too %s. Repeat the run with half the spacing and compare crests.",
                 sum > 0 ? "low" : "high");
    return l;
}

/* ---- impacts ---- */

/* Rise of the largest value of a column as a triangle: twice the time from half of it to it [s];
 * NAN if the record has no half value. */
static double rise_of(const mps__csv *t, int32_t k, double start, double *at)
{
    const double *time = t->value[0], *value = t->value[k];
    int64_t peak = -1;
    for (int64_t i = 0; i < t->rows; i++) {
        if (time[i] < start || !isfinite(value[i])) continue;
        if (peak < 0 || value[i] > value[peak]) peak = i;
    }
    if (peak < 0) return NAN;
    const double half = value[peak] / 2;
    *at = time[peak];
    for (int64_t i = peak; i > 0; i--) {
        const double p = value[i - 1], next = value[i];
        if (time[i - 1] < start) return NAN;
        if (!(p < half)) continue;
        const double cross = time[i - 1] + (time[i] - time[i - 1]) * (half - p) / (next - p);
        return 2 * (*at - cross);
    }
    return NAN;
}

double mps__page_crossing(const page_run *r, double t)
{
    const mps__csv *s = &r->steps;
    const int32_t k = mps__page_table_find(s, "crossing_time");
    int64_t lo = 0, hi = s->rows;
    if (k < 0 || s->rows == 0) return NAN;
    while (hi - lo > 1) {
        const int64_t middle = (lo + hi) / 2;
        if (s->value[0][middle] <= t)
            lo = middle;
        else
            hi = middle;
    }
    return s->value[k][lo];
}

/* @param steepest  out: least rise of a peak in crossing times; INFINITY: no sensor has a rise */
static light light_impacts(const page_run *r, double *steepest)
{
    light l = {.name = "Resolution of impacts", .state = UNKNOWN};
    char number[TEXT_NUMBER], rise_text[TEXT_NUMBER], cross_text[TEXT_NUMBER];
    const double start = 0.005 * mps__page_number(r, "t_end");
    double least = INFINITY;
    for (int32_t k = 0; k < r->columns; k++) {
        const page_column *c = &r->column[k];
        double at = 0, rise, crossing;
        if (strcmp(c->type, "wall_pressure") != 0 || c->place < 0) continue;
        rise = rise_of(&r->probes, c->place, start, &at);
        crossing = mps__page_crossing(r, at);
        if (!(rise > 0) || !(crossing > 0) || rise / crossing >= least) continue;
        least = rise / crossing;
        l.state = least >= 2.5 ? GOOD : least >= 1 ? LOOK : POOR;
        if (least > SMOOTH)
            snprintf(l.value, sizeof l.value, "no steep peak");
        else
            snprintf(l.value, sizeof l.value, "%s x", mps__rounded(number, least));
        snprintf(l.text, sizeof l.text,
                 "The steepest of the highest peaks (%.40s) rises in %s; liquid crosses a spacing "
                 "in %s. The rise should take 2.5 times as long.",
                 c->name, mps__quantity(rise_text, rise, "s"),
                 mps__quantity(cross_text, crossing, "s"));
    }
    *steepest = least;
    if (l.state == UNKNOWN)
        snprintf(l.text, sizeof l.text, "No wall sensor has a peak whose rise is in the record.");
    if (l.state == LOOK || l.state == POOR)
        snprintf(l.advice, sizeof l.advice,
                 "This peak depends on the spacing. Use its impulse, or refine until the rise is "
                 "2.5 times as long (mps converge).");
    return l;
}

bool mps__page_has_impacts(const page_run *r)
{
    double steepest = INFINITY;
    light_impacts(r, &steepest);
    return steepest <= SMOOTH;
}

/* A single run of an impact: the expected scatter of repeats. Never good, because one run does not
 * show it. */
static void expect_scatter(light *l, double steepest)
{
    char number[TEXT_NUMBER], rise[TEXT_NUMBER];
    int k = 0;
    while (!(steepest < scatter_of[k].rise)) k++;
    l->state = by_limits(scatter_of[k].deviation, 0, SCATTER_POOR);
    snprintf(l->value, sizeof l->value, "one run");
    snprintf(l->text, sizeof l->text,
             "Peaks of impacts differ from run to run, also in experiments. In 20 tanks those that "
             "rise in %s crossing times had a standard deviation of %s %%.",
             mps__rounded(rise, steepest), mps__rounded(number, 100 * scatter_of[k].deviation));
    snprintf(l->advice, sizeof l->advice,
             "One run of an impact is no answer: run five with slightly different spacings "
             "(mps repeat). Crests and mean forces need no repeats.");
}

static light light_repeats(const page_run *r, double steepest)
{
    light l = {.name = "Repeats", .state = GOOD};
    char number[TEXT_NUMBER];
    const json_value *repeats = mps__json_get(r->summary, "repeats");
    const double count = mps__json_number(mps__json_get(repeats, "count"));
    const double scatter = mps__json_number(mps__json_get(repeats, "scatter"));
    if (count > 1) {
        l.state = by_limits(scatter, SCATTER_GOOD, SCATTER_POOR);
        snprintf(l.value, sizeof l.value, "%.0f runs", count);
        snprintf(l.text, sizeof l.text, "Their highest peaks scatter by %s %%.",
                 mps__rounded(number, 100 * scatter));
    } else if (steepest <= SMOOTH) {
        expect_scatter(&l, steepest);
    } else {
        snprintf(l.value, sizeof l.value, "one run");
        snprintf(l.text, sizeof l.text,
                 "No sensor shows an impact. Crests, smooth pressures and mean forces need no "
                 "repeats.");
    }
    return l;
}

/* ---- HTML ---- */

static const char *const class_of[] = {"good", "look", "poor", "unknown"};
static const char *const mark_of[] = {"&#10003;", "!", "&#10005;", "?"};
static const char *const word_of[] = {"good", "check", "poor", "not known"};

static void write_light(FILE *out, const light *l)
{
    fprintf(
        out,
        "<li class=\"light %s\"><span class=\"mark\" aria-hidden=\"true\">%s</span><div>\n<h3>%s "
        "<span class=\"state\">%s</span></h3>\n<p class=\"value\">",
        class_of[l->state], mark_of[l->state], l->name, word_of[l->state]);
    mps__html(out, l->value);
    fputs("</p>\n<p>", out);
    mps__html(out, l->text);
    fputs("</p>\n", out);
    if (l->advice[0]) {
        fputs("<p class=\"advice\">", out);
        mps__html(out, l->advice);
        fputs("</p>\n", out);
    }
    fputs("</div></li>\n", out);
}

void mps__page_summary(FILE *out, const page_run *r)
{
    double steepest = INFINITY;
    const light impacts = light_impacts(r, &steepest);
    const light all[] = {light_end(r),    light_volume(r), light_lost(r),
                         light_energy(r), impacts,         light_repeats(r, steepest)};
    const int count = sizeof all / sizeof all[0];
    int poor = 0, look = 0;
    for (int k = 0; k < count; k++) {
        poor += all[k].state == POOR;
        look += all[k].state == LOOK;
    }
    fputs("<section id=\"verdict\" aria-labelledby=\"verdict-title\">\n<h2 id=\"verdict-title\">",
          out);
    if (poor > 0)
        fprintf(out, "%d of %d checks %s poor", poor, count, poor == 1 ? "is" : "are");
    else if (look > 0)
        fprintf(out, "%d of %d checks need%s a look", look, count, look == 1 ? "s" : "");
    else
        fputs("All checks are good", out);
    fputs("</h2>\n<ul class=\"lights\">\n", out);
    for (int k = 0; k < count; k++) write_light(out, &all[k]);
    fputs("</ul>\n</section>\n", out);
}
