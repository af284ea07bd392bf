/* SPDX-License-Identifier: BSD-3-Clause */
/* Impacts of the wall sensors: events, exceedance, value of an exposure, highest peaks. */
#include "page_exceedance.h"
#include "page_parts.h"
#include "page_text.h"
#include "statistics.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HIGHEST = 10, SENSORS_MOST = 24, FEW = 5 };

/* Impacts of a sensor. */
typedef struct sensor {
    const page_column *column;
    mps_impacts *impacts;
    double highest;
} sensor;

/* Evaluate the column as a signal of its own. */
static mps_status find_impacts(const page_run *r, const mps_stats_config *config, sensor *s)
{
    const mps__csv *t = &r->probes;
    mps_impact high;
    const mps_status status = mps_impacts_find(config, t->rows, t->value[0],
                                               t->value[s->column->place], &s->impacts);
    mps_impact_init(&high, sizeof high);
    s->highest = -INFINITY;
    if (status == MPS_OK && mps_impacts_highest(s->impacts, 0, &high) == MPS_OK)
        s->highest = high.peak;
    return status;
}

/* ---- texts ----------------------------------------------------------------------------------- */

/* Whether figures at model scale and at full scale differ. */
static bool is_scaled(const mps_impacts_info *info)
{
    return info->pressure_scale != 1 || info->time_scale != 1;
}

/* "3.59 kPa", or "3.59 kPa in the model, 144 kPa at full scale". */
static void write_both(FILE *out, double value, double factor, const char *unit,
                       const mps_impacts_info *info)
{
    char a[TEXT_NUMBER], b[TEXT_NUMBER];
    if (is_scaled(info))
        fprintf(out, "%s in the model, %s at full scale", mps__quantity(a, value, unit),
                mps__quantity(b, factor * value, unit));
    else
        fputs(mps__quantity(a, value, unit), out);
}

static void write_fit(FILE *out, const mps_impacts *impacts, int32_t kind, const char *name,
                      const mps_impacts_info *info)
{
    const double scale = info->pressure_scale;
    mps_fit fit;
    mps_fit_init(&fit, sizeof fit);
    if (mps_impacts_fit_get(impacts, kind, &fit) != MPS_OK || !isfinite(fit.value)) return;
    fprintf(out, "<li>%s: <b>", name);
    write_both(out, fit.value, scale, "Pa", info);
    fputs("</b>", out);
    if (isfinite(fit.value_band[0])) {
        fputs("; band from ", out);
        write_both(out, fit.value_band[0], scale, "Pa", info);
        fputs(is_scaled(info) ? ", to " : " to ", out);
        write_both(out, fit.value_band[1], scale, "Pa", info);
    }
    fputs("</li>\n", out);
}

/* End of a record that has as many events as a fit needs, at this rate, with two digits [s]. */
static double wanted_end(const mps_impacts_info *info, const mps_stats_config *c)
{
    const double end = info->t_first + c->least_events / info->rate,
                 digit = pow(10, floor(log10(end)) - 1);
    return digit * ceil(end / digit);
}

static void write_value(FILE *out, const mps_impacts *impacts, const mps_impacts_info *info,
                        const mps_stats_config *c)
{
    char exposure[TEXT_NUMBER], ratio[TEXT_NUMBER], events[TEXT_NUMBER];
    if (info->events < c->least_events) {
        fprintf(out,
                "<p>No distribution is fitted and no value for a longer time is given: that needs "
                "%d events, there %s %lld.",
                (int)c->least_events, info->events == 1 ? "is" : "are", (long long)info->events);
        if (info->events > 1)
            fprintf(out,
                    " At this rate a record of %s%s has so many: <code>mps resume</code> with the "
                    "folder and <code>--set run.until='%.9g s'</code> extends the run.",
                    mps__duration(exposure, c->least_events / info->rate),
                    is_scaled(info) ? " of the model" : "", wanted_end(info, c));
        fputs("</p>\n", out);
        return;
    }
    fprintf(out, "<p>Exceeded once in %s", mps__duration(exposure, c->exposure));
    if (is_scaled(info))
        fprintf(out, " at full scale, which is %s in the model",
                mps__duration(exposure, info->exposure));
    fprintf(out, " (%s events), <b>for screening</b>, not for design:</p>\n<ul>\n",
            mps__rounded(events, info->exposure_events));
    write_fit(out, impacts, MPS_FIT_WEIBULL, "Weibull", info);
    write_fit(out, impacts, MPS_FIT_PARETO, "generalised Pareto", info);
    fputs("</ul>\n", out);
    if (info->long_exposure)
        fprintf(out,
                "<p class=\"warning\">This time is more than %s lengths of the run: the values are "
                "extrapolated.</p>\n",
                mps__rounded(ratio, c->exposure_ratio));
    if (info->dependent)
        fputs("<p class=\"warning\">Successive peaks depend on each other: the bands are too "
              "narrow.</p>\n",
              out);
}

/* @param scale  of pressures; NAN: the run is at full scale */
static void write_row(FILE *out, int64_t rank, const mps_impact *e, double scale)
{
    char text[TEXT_NUMBER];
    fprintf(out, "<tr><td>%lld</td><td class=\"number\">%s</td>", (long long)rank + 1,
            mps__quantity(text, e->peak, "Pa"));
    if (isfinite(scale))
        fprintf(out, "<td class=\"number\">%s</td>", mps__quantity(text, scale * e->peak, "Pa"));
    fprintf(
        out,
        "<td class=\"number\"><button type=\"button\" class=\"moment\" data-time=\"%.9g\">%.4g s"
        "</button></td>",
        e->t, e->t);
    fprintf(out, "<td class=\"number\">%s%s</td>", mps__quantity(text, e->rise, "s"),
            e->unresolved ? " <span class=\"state\">not resolved</span>" : "");
    fprintf(out, "<td class=\"number\">%s</td>", mps__quantity(text, e->decay, "s"));
    fprintf(out, "<td class=\"number\">%s</td>", mps__quantity(text, e->duration, "s"));
    fprintf(out, "<td class=\"number\">%s</td></tr>\n", mps__quantity(text, e->impulse, "Pa s"));
}

static void write_highest(FILE *out, const sensor *s, const mps_impacts_info *info)
{
    const double scale = is_scaled(info) ? info->pressure_scale : NAN;
    mps_impact e;
    mps_impact_init(&e, sizeof e);
    fputs("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Highest peaks of ",
          out);
    mps__html(out, s->column->name);
    fputs("\"><table><thead><tr><th>rank</th><th>peak</th>", out);
    if (isfinite(scale)) fputs("<th>at full scale</th>", out);
    fputs("<th>time</th><th>rise</th><th>decay</th><th>duration</th><th>impulse</th></tr></thead>"
          "<tbody>\n",
          out);
    for (int64_t rank = 0; rank < HIGHEST; rank++)
        if (mps_impacts_highest(s->impacts, rank, &e) == MPS_OK) write_row(out, rank, &e, scale);
    fputs("</tbody></table></div>\n", out);
}

static void write_sensor(FILE *out, const sensor *s, const mps_stats_config *c, bool open,
                         bool plot)
{
    char u[TEXT_NUMBER], w[TEXT_NUMBER], rate[TEXT_NUMBER];
    mps_impacts_info info;
    mps_impacts_info_init(&info, sizeof info);
    mps_impacts_info_get(s->impacts, &info);
    fprintf(out, "<details%s class=\"impact\"><summary>", open ? " open" : "");
    mps__html(out, s->column->name);
    if (info.events == 0 && info.threshold == 0) { /* mean and deviation are 0 */
        fputs(": no pressure</summary>\n<p>No liquid came here.</p></details>\n", out);
        return;
    }
    fprintf(out, ": %lld event%s", (long long)info.events, info.events == 1 ? "" : "s");
    if (info.events > 0) {
        fputs(", highest ", out);
        write_both(out, s->highest, info.pressure_scale, "Pa", &info);
    }
    fputs("</summary>\n<div class=\"two\"><div>\n", out);
    if (is_scaled(&info))
        fprintf(out,
                "<p>The run is a model: at full scale pressures are %s times and times %s times as "
                "large. All that does not say 'at full scale' is of the model.</p>\n",
                mps__rounded(u, info.pressure_scale), mps__rounded(w, info.time_scale));
    fprintf(out, "<p>An event begins above %s and ends after %s below it. ",
            mps__quantity(u, info.threshold, "Pa"), mps__quantity(w, info.window, "s"));
    if (info.events >= FEW)
        fprintf(out, "%s come in a minute. ", mps__rounded(rate, 60 * info.rate));
    fprintf(out, "%lld of %lld rise%s or decay%s faster than the computation resolves.</p>\n",
            (long long)info.unresolved, (long long)info.events, info.events == 1 ? "s" : "",
            info.events == 1 ? "s" : "");
    if (info.cut > 0)
        fprintf(out, "<p>%lld more began before the record or ended after it.%s</p>\n",
                (long long)info.cut, info.events == 0 ? " A larger threshold may find peaks." : "");
    if (info.missing > 0)
        fprintf(out, "<p>%lld samples are not known.</p>\n", (long long)info.missing);
    write_value(out, s->impacts, &info, c);
    write_highest(out, s, &info);
    fputs("</div>\n", out);
    if (plot) mps__page_exceedance(out, s->impacts, s->column->name);
    fputs("</div></details>\n", out);
}

static const char *quantity_of(char out[TEXT_NUMBER], const mps_stats_constant *k)
{
    return isfinite(k->value) ? mps__quantity(out, k->value, k->unit) : "not given";
}

/* Write every constant as used, and that of the run if the page was made with another value. */
static void write_constants(FILE *out, const mps_stats_config *c, const mps_stats_config *of_run)
{
    char a[TEXT_NUMBER], b[TEXT_NUMBER];
    mps_stats_constant here = {.struct_size = sizeof here}, run = here;
    fputs("<details><summary>Constants of the statistics</summary><table class=\"facts\"><tbody>\n",
          out);
    for (int32_t k = 0; mps_stats_constant_get(c, k, &here) == MPS_OK &&
                        mps_stats_constant_get(of_run, k, &run) == MPS_OK;
         k++) {
        fprintf(out, "<tr><th scope=\"row\">%s</th><td>%s", here.about, quantity_of(a, &here));
        if (here.value != run.value && (isfinite(here.value) || isfinite(run.value)))
            fprintf(out, ", set for this page; the run: %s", quantity_of(b, &run));
        fputs("</td></tr>\n", out);
    }
    fputs("</tbody></table></details>\n", out);
}

/* ---- the section ----------------------------------------------------------------------------- */

static int compare(const void *a, const void *b)
{
    const sensor *x = a, *y = b;
    return (x->highest < y->highest) - (x->highest > y->highest);
}

/* Constants of the run, and the resolved time, which is that of the least one at a peak. */
static mps_status take_constants(const page_run *r, mps_stats_config *config)
{
    const mps_status status = mps__stats_take(r, mps__page_number(r, "t_end"), config);
    if (!(config->crossing_time > 0)) { /* of an older run, or one whose average is given as 0 */
        const double crossing = mps__page_crossing(r, mps__page_number(r, "t_end"));
        const double given = mps__page_number(r, "sensor_average_most");
        config->crossing_time = isfinite(given) ? given : isfinite(crossing) ? crossing : 0;
    }
    return status;
}

/* Constants given for the page override those of the run. */
static void take_given(const page_run *r, mps_stats_config *config)
{
    const mps_stats_config of_run = *config;
    if (!r->impacts) return;
    mps__stats_out(config, r->impacts, sizeof *config);
    config->error = of_run.error;
    config->error_size = of_run.error_size;
    if (!(config->crossing_time > 0)) config->crossing_time = of_run.crossing_time;
}

static mps_status find_all(const page_run *r, const mps_stats_config *config, sensor *all,
                           int *count)
{
    mps_status status = MPS_OK;
    for (int32_t k = 0; status == MPS_OK && k < r->columns && *count < SENSORS_MOST; k++) {
        const page_column *c = &r->column[k];
        if (strcmp(c->unit, "Pa") != 0 || c->place < 0) continue; /* also means of panels */
        if (!mps_stats_wants(config, c->name)) continue;
        all[*count] = (sensor){.column = c};
        status = find_impacts(r, config, &all[*count]);
        if (status == MPS_OK) ++*count;
    }
    qsort(all, (size_t)*count, sizeof *all, compare);
    return status;
}

mps_status mps__page_impacts(FILE *out, const page_run *r, int64_t bytes)
{
    sensor all[SENSORS_MOST];
    int count = 0;
    char text[256] = "";
    mps_stats_config config, of_run;
    if (!mps__page_has_impacts(r)) return MPS_OK;
    mps_status status = mps_stats_config_init(&config, sizeof config);
    config.error = text;
    config.error_size = sizeof text;
    if (status == MPS_OK) status = take_constants(r, &config);
    of_run = config;
    take_given(r, &config);
    if (status == MPS_OK) status = find_all(r, &config, all, &count);
    if (status == MPS_E_NOMEM) mps__page_fail(r->errors, status, "no memory for the page");
    if (status != MPS_E_NOMEM && (status != MPS_OK || count > 0)) {
        const long begin = ftell(out);
        fputs("<section id=\"impacts\" aria-labelledby=\"impacts-title\">\n<h2 "
              "id=\"impacts-title\">Impacts</h2>\n",
              out);
        if (status != MPS_OK) { /* the page does without these constants */
            fputs("<p class=\"warning\">There are no statistics: ", out);
            mps__html(out, text);
            fputs("</p>\n", out);
        }
        for (int k = 0; status == MPS_OK && k < count; k++)
            write_sensor(out, &all[k], &config, k == 0, ftell(out) - begin < bytes);
        write_constants(out, &config, &of_run);
        fputs("</section>\n", out);
    }
    for (int k = 0; k < count; k++) mps_impacts_destroy(all[k].impacts);
    return status == MPS_E_NOMEM ? status : MPS_OK;
}
