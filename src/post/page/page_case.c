/* SPDX-License-Identifier: BSD-3-Clause */
/* Inputs of a run, the models and solver used, and the case itself. */
#include "page_parts.h"
#include "page_text.h"
#include <math.h>
#include <string.h>

const char *mps__page_title(const page_run *r)
{
    const char *title = mps__page_string(r, "title"), *name = mps__page_string(r, "case");
    return title[0] ? title : name[0] ? name : "A run of libmps";
}

static void row(FILE *out, const char *name, const char *value)
{
    if (!value[0]) return;
    fputs("<tr><th scope=\"row\">", out);
    mps__html(out, name);
    fputs("</th><td>", out);
    mps__html(out, value);
    fputs("</td></tr>\n", out);
}

static void row_number(FILE *out, const page_run *r, const char *name, const char *key,
                       const char *unit)
{
    char text[TEXT_NUMBER];
    const double value = mps__page_number(r, key);
    if (isfinite(value)) row(out, name, mps__quantity(text, value, unit));
}

static void row_whole(FILE *out, const page_run *r, const char *name, const char *key)
{
    char text[TEXT_NUMBER];
    const double value = mps__page_number(r, key);
    if (isfinite(value)) row(out, name, mps__whole(text, (int64_t)value));
}

static void table_begin(FILE *out, const char *title)
{
    fprintf(out, "<div><h3>%s</h3>\n<table class=\"facts\"><tbody>\n", title);
}

static void table_end(FILE *out)
{
    fputs("</tbody></table></div>\n", out);
}

static void write_fluids(FILE *out, const page_run *r)
{
    const json_value *list = mps__json_get(r->summary, "phases");
    for (size_t k = 0; k < mps__json_count(list); k++) {
        const json_value *phase = mps__json_at(list, k);
        const char *name = mps__json_text(mps__json_get(phase, "name"));
        char density[TEXT_NUMBER], viscosity[TEXT_NUMBER], label[64], text[160];
        snprintf(label, sizeof label, "fluid %d%s%.40s", (int)k, name ? ", " : "",
                 name ? name : "");
        snprintf(
            text, sizeof text, "%s, %s%s",
            mps__quantity(density, mps__json_number(mps__json_get(phase, "density")), "kg/m3"),
            mps__quantity(viscosity, mps__json_number(mps__json_get(phase, "viscosity")), "Pa s"),
            mps__json_true(mps__json_get(phase, "gas")) ? ", gas" : "");
        row(out, label, text);
    }
}

/* The spacing as requested, and along each axis, if these differ from the one as built. */
static void row_spacing(FILE *out, const page_run *r)
{
    const json_value *list = mps__json_get(r->summary, "lattice");
    const double dp = mps__page_number(r, "dp"), asked = mps__page_number(r, "dp_requested");
    char text[160] = "", one[TEXT_NUMBER];
    bool cubes = true;
    if (isfinite(asked) && fabs(asked - dp) > 1e-6 * dp)
        row_number(out, r, "as requested", "dp_requested", "m");
    for (size_t d = 0; d < mps__json_count(list) && d < 3; d++) {
        const double h = mps__json_number(mps__json_at(list, d));
        const size_t used = strlen(text);
        cubes = cubes && fabs(h - dp) <= 1e-6 * dp;
        snprintf(text + used, sizeof text - used, "%s%s", used ? " x " : "",
                 mps__quantity(one, h, "m"));
    }
    if (!cubes) row(out, "cells", text);
}

/* "0.8 x 0.5 m" */
static void row_size(FILE *out, const page_run *r)
{
    static const char *const key[] = {"tank_size_x", "tank_size_y", "tank_size_z"};
    char text[160] = "", one[TEXT_NUMBER];
    for (int d = 0; d < 3; d++) {
        const double size = mps__page_number(r, key[d]);
        const size_t used = strlen(text);
        if (isfinite(size))
            snprintf(text + used, sizeof text - used, "%s%s", used ? " x " : "",
                     mps__rounded(one, size));
    }
    if (text[0]) {
        strncat(text, " m", sizeof text - strlen(text) - 1);
        row(out, "inner size of the tank", text);
    }
}

static void write_inputs(FILE *out, const page_run *r)
{
    const json_value *list = mps__json_get(r->summary, "inputs");
    table_begin(out, "Inputs");
    if (!mps__page_input(r, "model")) row(out, "model", mps__page_string(r, "model"));
    row_number(out, r, "spacing of the particles", "dp", "m");
    row_spacing(out, r);
    row_size(out, r);
    row_number(out, r, "depth of the liquid", "liquid_depth", "m");
    if (!mps__page_input(r, "phase 0")) write_fluids(out, r);
    for (const json_value *one = list ? list->first : NULL; one; one = one->next) {
        const char *key = mps__json_text(mps__json_get(one, "key"));
        const char *value = mps__json_text(mps__json_get(one, "value"));
        if (key && value && strcmp(key, "title") != 0) row(out, key, value);
    }
    table_end(out);
}

/* Models that took part in the steps, including those of plug-ins. */
static void row_models(FILE *out, const page_run *r)
{
    const json_value *list = mps__json_get(r->summary, "models");
    if (mps__json_count(list) == 0) return;
    fputs("<tr><th scope=\"row\">models in use</th><td>", out);
    for (const json_value *one = list->first; one; one = one->next) {
        const char *name = mps__json_text(one);
        if (one != list->first) fputs(", ", out);
        mps__html(out, name ? name : "-");
    }
    fputs("</td></tr>\n", out);
}

static void cell_text(FILE *out, const json_value *from, const char *key)
{
    const char *text = mps__json_text(mps__json_get(from, key));
    mps__html(out, text ? text : "-");
}

/* Plug-ins of the case: what each provides, its version, file and hash. */
static void rows_plugins(FILE *out, const page_run *r)
{
    const json_value *list = mps__json_get(r->summary, "plugins");
    for (const json_value *one = list ? list->first : NULL; one; one = one->next) {
        const json_value *items = mps__json_get(one, "items");
        fputs("<tr><th scope=\"row\">plug-in ", out);
        cell_text(out, one, "name");
        fputs("</th><td>", out);
        for (const json_value *item = items ? items->first : NULL; item; item = item->next) {
            cell_text(out, item, "kind");
            fputc(' ', out);
            cell_text(out, item, "name");
            fputs(item->next ? ", " : "; ", out);
        }
        fputs("version ", out);
        cell_text(out, one, "version");
        fputs(", file ", out);
        cell_text(out, one, "file");
        fputs(", SHA-256 ", out);
        cell_text(out, one, "sha256");
        fputs("</td></tr>\n", out);
    }
}

static void write_run(FILE *out, const page_run *r)
{
    char text[TEXT_NUMBER];
    table_begin(out, "Run");
    row_models(out, r);
    rows_plugins(out, r);
    row_number(out, r, "time reached", "t_end", "s");
    row_whole(out, r, "particles of fluid", "n_fluid");
    row_whole(out, r, "particles of walls", "n_wall");
    row_whole(out, r, "particles behind walls", "n_dummy");
    row_whole(out, r, "steps", "steps");
    row_number(out, r, "mean step", "dt_mean", "s");
    row_number(out, r, "largest speed", "max_speed", "m/s");
    row(out, "pressure solver", mps__page_string(r, "ppe_solver"));
    row_number(out, r, "its iterations a step", "ppe_iterations_mean", "");
    row(out, "by the clock", mps__duration(text, mps__page_number(r, "wall_s")));
    row(out, "of the processors", mps__duration(text, mps__page_number(r, "cpu_s")));
    row_whole(out, r, "threads", "threads");
    row_whole(out, r, "ranks", "ranks");
    const double memory = mps__page_number(r, "peak_rss_bytes") / 1e6;
    if (isfinite(memory)) {
        mps__quantity(text, memory, "MB");
        row(out, "largest memory", text);
    }
    table_end(out);
}

static void write_origin(FILE *out, const page_run *r)
{
    table_begin(out, "Origin");
    row(out, "libmps", mps__page_string(r, "version"));
    row(out, "built by", mps__page_string(r, "build"));
    row(out, "machine", mps__page_string(r, "machine"));
    row(out, "date", mps__page_string(r, "date"));
    row(out, "command", mps__page_string(r, "command"));
    table_end(out);
}

/* Figures that the case defines. */
static void write_figures(FILE *out, const page_run *r)
{
    const json_value *list = mps__json_get(r->summary, "figures");
    if (mps__json_count(list) == 0) return;
    table_begin(out, "Numbers of this case");
    for (size_t k = 0; k < mps__json_count(list); k++) {
        const json_value *one = mps__json_at(list, k);
        const char *name = mps__json_text(mps__json_get(one, "name"));
        const char *about = mps__json_text(mps__json_get(one, "about"));
        const char *unit = mps__json_text(mps__json_get(one, "unit"));
        char number[TEXT_NUMBER], text[320];
        if (!name) continue;
        const double value = mps__page_number(r, name);
        if (isfinite(value))
            mps__quantity(number, value, unit ? unit : "");
        else
            snprintf(number, sizeof number, "not reached");
        snprintf(text, sizeof text, "%s%s%.240s", number, about ? ": " : "", about ? about : "");
        row(out, name, text);
    }
    table_end(out);
}

/* @param common  columns that each run has, or those of this case */
static void write_some(FILE *out, const page_run *r, const char *title, bool common)
{
    char name[160];
    bool any = false;
    for (int32_t k = 0; k < r->columns; k++) {
        const page_column *c = &r->column[k];
        if (mps__is_common(c->name) != common) continue;
        if (!any)
            fprintf(out, "<details><summary>%s</summary>\n<table class=\"facts\"><tbody>\n", title);
        any = true;
        snprintf(name, sizeof name, c->unit[0] ? "%.100s [%.40s]" : "%.100s", c->name, c->unit);
        row(out, name, c->about);
    }
    if (any) fputs("</tbody></table></details>\n", out);
}

static void write_columns(FILE *out, const page_run *r)
{
    if (r->columns == 0) return;
    fputs("<details><summary>All columns of probes.csv</summary>\n", out);
    write_some(out, r, "Columns of this case", false);
    write_some(out, r, "Columns of every run: energies, the tank", true);
    if (mps__page_number(r, "dim") == 2)
        fputs("<p class=\"quiet\">Forces and energies are those of 1 m of width.</p>\n", out);
    fputs("</details>\n", out);
}

/* The case as run, which a program can read back: in the text of the element "<\" represents
 * "<". */
static void write_text(FILE *out, const page_run *r)
{
    if (!r->text) return;
    fputs(
        "<details open><summary>Case file</summary>\n<pre tabindex=\"0\" aria-label=\"Case file\">",
        out);
    mps__html(out, r->text);
    fputs("</pre></details>\n<script type=\"text/yaml\" id=\"case\">", out);
    for (const char *c = r->text; *c; c++) fputs(*c == '<' ? "<\\" : (char[]){*c, 0}, out);
    fputs("</script>\n", out);
}

void mps__page_about(FILE *out, const page_run *r)
{
    fputs(
        "<section id=\"about\" aria-labelledby=\"about-title\">\n<h2 id=\"about-title\">Case</h2>\n"
        "<div class=\"columns\">\n",
        out);
    write_inputs(out, r);
    write_run(out, r);
    write_figures(out, r);
    write_origin(out, r);
    fputs("</div>\n", out);
    write_text(out, r);
    write_columns(out, r);
    fputs("</section>\n", out);
}
