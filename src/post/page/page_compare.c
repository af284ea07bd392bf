/* SPDX-License-Identifier: BSD-3-Clause */
/* Compares columns of the run with the reference values of its case. */
#include "page_parts.h"
#include "page_text.h"
#include "statistics.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A reference and a column of the run. */
typedef struct against {
    const page_run *run;
    const mps_table *reference;
    mps_stats_config config;
    char error[256];
} against;

static void write_figures(FILE *out, const mps_comparison *c, const char *unit, bool points,
                          int64_t all)
{
    char a[TEXT_NUMBER], b[TEXT_NUMBER];
    fputs("<td class=\"number\">", out);
    mps__html(out, mps__quantity(a, c->rms, unit));
    fputs("</td><td class=\"number\">", out);
    mps__html(out, mps__quantity(a, c->rms_first, unit));
    fprintf(out, "</td><td class=\"number\">%s</td><td class=\"number\">%s</td>",
            mps__rounded(a, c->correlation), mps__quantity(b, c->shift, "s"));
    if (points)
        fprintf(out, "<td>%lld of %lld points, ", (long long)c->points, (long long)all);
    else
        fputs("<td>", out);
    fprintf(out, "%s to %s</td>", mps__quantity(a, c->t_first, "s"),
            mps__quantity(b, c->t_last, "s"));
}

/* A row of the table. @return MPS_E_NOMEM, or MPS_OK */
static mps_status write_row(FILE *out, against *g, int32_t column)
{
    const mps__csv *t = &g->run->probes;
    const int64_t n = mps_table_rows(g->reference);
    const mps_series first = {.struct_size = sizeof first,
                              .n = n,
                              .t = mps_table_values(g->reference, -1),
                              .p = mps_table_values(g->reference, 0)};
    const mps_series second = {
        .struct_size = sizeof second, .n = t->rows, .t = t->value[0], .p = t->value[column]};
    mps_comparison c;
    mps_comparison_init(&c, sizeof c);
    const bool points = mps_table_is_points(g->reference);
    const mps_status status = points ? mps_points_compare(&g->config, &first, &second, &c)
                                     : mps_series_compare(&g->config, &first, &second, &c);
    if (status == MPS_E_NOMEM)
        return mps__page_fail(g->run->errors, status, "no memory for the page");
    fputs("<tr><th scope=\"row\">", out);
    mps__html(out, t->name[column]);
    fputs("</th><td>", out);
    mps__html(out, mps_table_label(g->reference));
    fputs("</td>", out);
    if (status == MPS_OK) {
        write_figures(out, &c, t->unit[column], points, n);
    } else {
        fputs("<td colspan=\"5\">", out);
        mps__html(out, g->error);
        fputs("</td>", out);
    }
    fputs("</tr>\n", out);
    return MPS_OK;
}

/* Rows for the column of its name, or for all columns of its unit. */
static mps_status write_rows(FILE *out, against *g)
{
    const mps__csv *t = &g->run->probes;
    const char *name = mps_table_name(g->reference, 0), *unit = mps_table_unit(g->reference, 0);
    mps_status status = MPS_OK;
    for (int32_t k = 1; status == MPS_OK && k < t->columns; k++)
        if (name[0] ? strcmp(name, t->name[k]) == 0 : strcmp(unit, t->unit[k]) == 0)
            status = write_row(out, g, k);
    return status;
}

mps_status mps__page_comparison(FILE *out, const page_run *r)
{
    const json_value *list = mps__json_get(r->summary, "references");
    mps_status status = MPS_OK;
    if (mps__json_count(list) == 0 || r->probes.rows < 2) return MPS_OK;
    against g = {.run = r};
    mps_stats_config_init(&g.config, sizeof g.config);
    if (mps__stats_take(r, mps__page_number(r, "t_end"), &g.config) != MPS_OK)
        mps_stats_config_init(&g.config, sizeof g.config);
    g.config.error = g.error;
    g.config.error_size = sizeof g.error;
    fputs("<section id=\"comparison\" aria-labelledby=\"comparison-title\">\n<h2 "
          "id=\"comparison-title\">Run against known values</h2>\n<div class=\"scroll\" "
          "tabindex=\"0\" role=\"region\" aria-label=\"Differences from known values\">"
          "<table><thead><tr><th>column</th><th>known values</th><th>rms difference</th>"
          "<th>rms of the known values about their mean</th><th>correlation</th>"
          "<th>run is later by</th><th>compared</th></tr></thead><tbody>\n",
          out);
    for (const json_value *one = list->first; status == MPS_OK && one; one = one->next) {
        mps_table *table = NULL;
        if (mps__stats_reference(one, &table)) {
            g.reference = table;
            status = write_rows(out, &g);
        } else
            status = mps__page_fail(r->errors, MPS_E_NOMEM, "no memory for the page");
        mps_table_destroy(table);
    }
    fputs(
        "</tbody></table></div>\n<p class=\"quiet\">The correlation is the largest one within the "
        "shifts that are looked at, half a period T1 to each side. Single points are compared at "
        "their times alone.</p>\n</section>\n",
        out);
    return status;
}
