/* SPDX-License-Identifier: BSD-3-Clause */
/* Head, stage, forces, budget and pictures of a page. */
#include "page_parts.h"
#include "page_text.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool mps__page_is_unfinished(const page_run *r)
{
    return strcmp(mps__page_string(r, "status"), "unfinished") == 0;
}

/* Written first, because figures and checks then cover only a part of the run. */
static void write_unfinished(FILE *out, const page_run *r)
{
    char a[TEXT_NUMBER], b[TEXT_NUMBER];
    const double until = mps__page_number(r, "until");
    if (!mps__page_is_unfinished(r)) return;
    fprintf(out, "<p class=\"warning\">This run is not finished: it has come to t = %s",
            mps__quantity(a, mps__page_number(r, "t_end"), "s"));
    if (isfinite(until)) fprintf(out, " of %s", mps__quantity(b, until, "s"));
    fputs(". All figures are of this part; mps report makes the page again.</p>\n", out);
}

void mps__page_head(FILE *out, const page_run *r)
{
    char a[TEXT_NUMBER], b[TEXT_NUMBER], c[TEXT_NUMBER], d[TEXT_NUMBER];
    const double fluid = mps__page_number(r, "n_fluid"), t = mps__page_number(r, "t_end");
    fputs("<header><div><h1>", out);
    mps__html(out, mps__page_title(r));
    fputs("</h1>\n<p class=\"facts\">", out);
    fprintf(out,
            "%s-D, <span>%s simulated</span>, <span>%s particles of fluid</span>, <span>%s apart"
            "</span>, <span>computed in %s</span>",
            mps__page_number(r, "dim") == 3 ? "3" : "2", mps__quantity(a, t, "s"),
            mps__whole(b, isfinite(fluid) ? (int64_t)fluid : 0),
            mps__quantity(c, mps__page_number(r, "dp"), "m"),
            mps__duration(d, mps__page_number(r, "wall_s")));
    fputs("</p>", out);
    write_unfinished(out, r);
    fputs("</div>\n<button id=\"theme\" type=\"button\">Dark</button></header>\n", out);
}

/* ---- film and curves ------------------------------------------------------------------------- */

static const char controls[] =
    "<div class=\"controls\" role=\"group\" aria-label=\"Film\">\n"
    "<button id=\"play\" type=\"button\" class=\"strong\">Play</button>\n"
    "<button id=\"back\" type=\"button\" aria-label=\"One frame back\">&#8592;</button>\n"
    "<button id=\"on\" type=\"button\" aria-label=\"One frame on\">&#8594;</button>\n"
    "<input id=\"time\" type=\"range\" min=\"0\" value=\"0\" step=\"1\" aria-label=\"Time\">\n"
    "<output id=\"now\" for=\"time\"></output>\n"
    "</div>\n<div class=\"controls\" role=\"group\" aria-label=\"View\">\n"
    "<label>Colour <select id=\"colour\"><option value=\"pressure\">pressure</option>"
    "<option value=\"speed\">speed</option><option "
    "value=\"phase\">phase</option></select></label>\n"
    "<label>Pace <select id=\"pace\"></select></label>\n"
    "<label id=\"frame-choice\">Seen from <select id=\"seen\"><option value=\"tank\">the "
    "tank</option>"
    "<option value=\"lab\">the lab</option></select></label>\n"
    "<label><input id=\"walls-on\" type=\"checkbox\" checked> walls</label>\n"
    "<label><input id=\"marks-on\" type=\"checkbox\" checked> sensors</label>\n"
    "</div>\n";
static const char screen[] =
    "<figure class=\"film\"><div id=\"screen\"><canvas id=\"canvas\" tabindex=\"0\" role=\"img\" "
    "aria-label=\"Film of the particles\"></canvas><svg id=\"marks\" aria-hidden=\"true\"></svg>"
    "<div class=\"zoom\"><button id=\"closer\" type=\"button\" aria-label=\"Zoom in\">+</button>"
    "<button id=\"farther\" type=\"button\" aria-label=\"Zoom out\">&#8722;</button>"
    "<button id=\"whole\" type=\"button\">All</button></div>"
    "<p id=\"picked\" aria-live=\"polite\"></p><p id=\"waiting\">Unpacking the film</p></div>\n"
    "<div id=\"scale\"></div>\n";

void mps__page_stage(FILE *out, const page_run *r, bool has_film, const char *note)
{
    fputs("<section id=\"film\" aria-labelledby=\"film-title\">\n<h2 id=\"film-title\">", out);
    fputs(has_film ? "Film and curves</h2>\n" : "Curves</h2>\n", out);
    fprintf(out, "<div class=\"%s\">\n", has_film ? "stage" : "stage alone");
    if (has_film) {
        fputs(screen, out);
        fputs(controls, out);
        fputs("<figcaption>", out);
        mps__html(out, note);
        fprintf(
            out,
            " <span class=\"hint\">%s Click a particle to follow it. Keys: space plays, comma and "
            "point step, + and - zoom, 0 shows all.</span></figcaption>\n</figure>\n",
            mps__page_number(r, "dim") == 3 ? "Drag to turn, with Shift to move; arrows turn."
                                            : "Drag to move the picture; Ctrl and wheel zoom.");
    }
    if (!has_film && note[0]) {
        fputs("<p>", out);
        mps__html(out, note);
        fputs("</p>\n", out);
    }
    fputs("<div class=\"curves\"><div class=\"controls\" role=\"group\" aria-label=\"Curves\">"
          "<button type=\"button\" id=\"all-time\">Whole run</button>"
          "<span class=\"hint\">Drag in a plot to zoom, click to set the time.</span></div>\n"
          "<div class=\"charts\" data-place=\"main\"></div></div>\n</div>\n</section>\n",
          out);
}

/* ---- forces ---------------------------------------------------------------------------------- */

static bool is_force(const page_column *c)
{
    return strcmp(c->type, "force") == 0 || strcmp(c->type, "moment") == 0;
}

void mps__page_forces(FILE *out, const page_run *r)
{
    bool any = false;
    for (int32_t k = 0; k < r->columns; k++)
        any = any || (is_force(&r->column[k]) && r->column[k].place >= 0);
    if (!any) return;
    fputs("<section id=\"forces\" aria-labelledby=\"forces-title\">\n<h2 "
          "id=\"forces-title\">Forces and "
          "moments</h2>\n<div class=\"two\"><div class=\"charts\" data-place=\"forces\"></div>\n",
          out);
    mps__page_extremes(out, r, "Extremes of forces and moments", is_force);
    fputs("</div>\n</section>\n", out);
}

/* ---- energy budget --------------------------------------------------------------------------- */

static double last_of(const page_run *r, const char *name)
{
    return mps__page_table_last(&r->probes, mps__page_table_find(&r->probes, name));
}

static double change_of(const page_run *r, const char *name)
{
    const int32_t k = mps__page_table_find(&r->probes, name);
    return k >= 0 && r->probes.rows > 0 ? last_of(r, name) - r->probes.value[k][0] : NAN;
}

/* "- 2.3 J/m went to viscosity and dissipation." Omitted below a thousandth of `all`. */
static void item(FILE *out, const page_run *r, double value, double all, const char *text[2])
{
    char number[TEXT_NUMBER];
    if (!isfinite(value) || fabs(value) < 1e-3 * all || value == 0) return;
    fprintf(out, "<li><b>%s</b> %s</li>\n",
            mps__quantity(number, fabs(value), mps__page_number(r, "dim") == 3 ? "J" : "J/m"),
            text[value < 0]);
}

/* The line `viscous` of the budget is the sum of both. */
#define FRICTION                                                                              \
    "was taken by friction in the liquid and at walls: numerical dissipation, which keeps "   \
    "particles in order, and the liquid's own viscosity in one sum. In a tank of metres the " \
    "viscosity of water, LNG or LPG is a small part of it."

static const struct budget_part {
    const char *name;
    bool change;
    bool comes;          /* counted as an input of energy */
    const char *text[2]; /* of positive and negative values */
} budget_parts[] = {
    {"wall_work_momentum", false, true, {"came from the walls.", "went to the walls."}},
    {"added", false, true, {"came with new particles.", "left with lost particles."}},
    {"ke",
     true,
     false,
     {"more is in motion than at the start.", "less is in motion than at the start."}},
    {"pe",
     true,
     false,
     {"is stored because the liquid stands higher than at the start.",
      "was set free because the liquid stands lower than at the start."}},
    {"viscous", false, false, {FRICTION, "came from friction in the liquid: an error."}},
    {"friction", false, false, {"was taken by layers at walls.", "came from layers at walls."}},
    {"layers",
     true,
     false,
     {"more is in layers at side walls.", "less is in layers at side walls."}},
    {"plugins",
     false,
     false,
     {"was taken by models of plug-ins.", "came from models of plug-ins."}},
    {"collision", false, false, {"was taken by collisions of particles.", "came from collisions."}},
    {"shift",
     false,
     false,
     {"was taken by the shift that keeps particles even.", "came from the shift."}},
    {"numerical",
     false,
     false,
     {"was lost without a physical reason (numerical).",
      "was gained without a physical reason (numerical)."}},
};

/* A term as listed. */
static double part_of(const page_run *r, const struct budget_part *p)
{
    return p->change ? change_of(r, p->name) : last_of(r, p->name);
}

void mps__page_budget(FILE *out, const page_run *r)
{
    static const char *const gas[2] = {"came from trapped gas.", "went to trapped gas."};
    double all = 0, rest = 0;
    const int count = sizeof budget_parts / sizeof budget_parts[0];
    if (!isfinite(last_of(r, "numerical"))) return;
    for (int k = 0; k < count; k++) {
        const double v = part_of(r, &budget_parts[k]);
        if (isfinite(v)) all = fmax(all, fabs(v));
        rest += budget_parts[k].comes ? -v : v;
    }
    fputs(
        "<section id=\"budget\" aria-labelledby=\"budget-title\">\n<h2 id=\"budget-title\">Where "
        "the "
        "energy went</h2>\n<div class=\"two\"><div>\n<p>From the start to the end of the run:</p>\n"
        "<ul>\n",
        out);
    for (int k = 0; k < count; k++) {
        const double v = part_of(r, &budget_parts[k]);
        const char *text[2] = {budget_parts[k].text[0], budget_parts[k].text[1]};
        item(out, r, v, all, text);
    }
    item(out, r, rest, all, (const char *[2]){gas[0], gas[1]}); /* no column has it; 0 without */
    fputs("</ul>\n<p class=\"quiet\">What came is what is stored plus what was taken or lost; "
          "rounding "
          "aside, the sum is exact.</p></div>\n<div class=\"charts\" "
          "data-place=\"budget\"></div></div>\n",
          out);
    fputs("<details><summary>How it was computed: momentum, steps, pressure solver</summary>\n"
          "<div class=\"charts\" data-place=\"steps\"></div></details>\n</section>\n",
          out);
}

/* ---- pictures -------------------------------------------------------------------------------- */

/* Write a picture if it exists and fits into the rest of `bytes`. */
static mps_status write_picture(FILE *out, const page_run *r, const char *name, int64_t *bytes)
{
    static const char head[] = "<section id=\"pictures\" aria-labelledby=\"pictures-title\">\n<h2 "
                               "id=\"pictures-title\">Pictures</h2>\n<div class=\"pictures\">\n";
    char *path = mps__page_path(r->folder, name), *data = NULL;
    size_t size = 0;
    if (!path) return mps__page_fail(r->errors, MPS_E_NOMEM, "no memory for the page");
    mps_status status = mps__page_file(r, path, 64 << 20, &data, &size);
    const int64_t needed = (int64_t)size * 4 / 3 + 300;
    free(path);
    if (status != MPS_OK || needed > *bytes) {
        free(data);
        return status == MPS_OK ? MPS_E_NAME : status;
    }
    const codec_bytes all = {.data = (unsigned char *)data, .size = size};
    fprintf(out,
            "%s<figure><img loading=\"lazy\" alt=\"The flow, %s\" src=\"data:image/png;base64,",
            strcmp(name, "picture_1.png") == 0 ? head : "", name);
    mps__codec_base64(out, &all);
    fprintf(out, "\"><figcaption>%s</figcaption></figure>\n", name);
    free(data);
    *bytes -= needed;
    return MPS_OK;
}

mps_status mps__page_pictures(FILE *out, const page_run *r, int64_t bytes)
{
    char name[48];
    int written = 0;
    mps_status status = MPS_OK;
    for (int k = 1; status == MPS_OK && k <= 100; k++) {
        snprintf(name, sizeof name, "picture_%d.png", k);
        status = write_picture(out, r, name, &bytes);
        written += status == MPS_OK;
    }
    if (status == MPS_E_NAME && written > 0)
        status = write_picture(out, r, "picture_end.png", &bytes);
    if (written > 0) fputs("</div>\n</section>\n", out);
    return status == MPS_E_NAME ? MPS_OK : status;
}
