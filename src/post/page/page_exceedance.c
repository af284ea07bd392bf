/* SPDX-License-Identifier: BSD-3-Clause */
#include "page_exceedance.h"
#include "page_text.h"
#include <math.h>
#include <stdbool.h>

enum {
    WIDTH = 520,
    HEIGHT = 320,
    LEFT = 62,
    RIGHT = 18,
    TOP = 16,
    FOOT = 46,
    TICKS = 5,
    CURVE = 80,
    RANKS = 1024
};

/* Maps pressure and fraction to the drawing. */
typedef struct axes {
    FILE *out;
    double lo, hi, least; /* pressures; smallest fraction */
    bool model;           /* full scale is a different scale */
} axes;

static double at_x(const axes *a, double p)
{
    return LEFT + (WIDTH - LEFT - RIGHT) * (p - a->lo) / (a->hi - a->lo);
}

static double at_y(const axes *a, double share)
{
    return TOP + (HEIGHT - TOP - FOOT) * log(share) / log(a->least);
}

/* Ranks to draw: if there are many peaks, those distinguishable on a logarithmic axis.
 * @return their number */
static int choose_ranks(int64_t count, int64_t rank[RANKS])
{
    int n = 0;
    for (int64_t k = 0; k < count && n < RANKS; k += 1 + k / 64) rank[n++] = k;
    return n;
}

/* A step of 1, 2 or 5 times a power of ten. */
static double round_step(double range)
{
    const double power = pow(10, floor(log10(range / TICKS))), rest = range / TICKS / power;
    return power * (rest > 5 ? 10 : rest > 2 ? 5 : rest > 1 ? 2 : 1);
}

static bool range_of(axes *a, const mps_impacts *impacts, int64_t count)
{
    mps_exceedance e;
    mps_exceedance_init(&e, sizeof e);
    a->lo = INFINITY;
    a->hi = -INFINITY;
    for (int64_t k = 0; k < count; k++) {
        mps_impacts_exceedance(impacts, k, &e);
        a->lo = fmin(a->lo, e.peak);
        a->hi = fmax(a->hi, e.peak);
    }
    if (!(a->hi > a->lo)) return false;
    const double step = round_step(a->hi - a->lo);
    a->lo = step * floor(a->lo / step);
    a->hi = step * ceil(a->hi / step);
    a->least = pow(10, floor(log10(1.0 / (double)(count + 1))));
    return true;
}

static void write_axes(const axes *a)
{
    char text[TEXT_NUMBER];
    const double step = round_step(a->hi - a->lo);
    fputs("<g class=\"grid\">", a->out);
    for (double p = a->lo; p < a->hi + 0.5 * step; p += step)
        fprintf(a->out, "<path d=\"M%.1f %dV%d\"/><text x=\"%.1f\" y=\"%d\">%s</text>\n",
                at_x(a, p), TOP, HEIGHT - FOOT, at_x(a, p), HEIGHT - FOOT + 16,
                mps__rounded(text, a->hi >= 2000 ? p / 1000 : p));
    for (double share = 1; share > 0.9 * a->least; share /= 10)
        fprintf(a->out,
                "<path d=\"M%d %.1fH%d\"/><text class=\"end\" x=\"%d\" y=\"%.1f\">%s %%</text>\n",
                LEFT, at_y(a, share), WIDTH - RIGHT, LEFT - 6, at_y(a, share) + 4,
                mps__rounded(text, 100 * share));
    fprintf(a->out, "<text x=\"%d\" y=\"%d\">peak%s [%s]</text></g>\n", (LEFT + WIDTH - RIGHT) / 2,
            HEIGHT - 8, a->model ? " in the model" : "", a->hi >= 2000 ? "kPa" : "Pa");
}

static bool write_band(const axes *a, const mps_impacts *impacts, const int64_t *rank, int count)
{
    mps_exceedance e;
    mps_exceedance_init(&e, sizeof e);
    if (mps_impacts_exceedance(impacts, 0, &e) != MPS_OK || !isfinite(e.band[0])) return false;
    fputs("<polygon class=\"band\" points=\"", a->out);
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < count; k++) {
            mps_impacts_exceedance(impacts, rank[side ? count - 1 - k : k], &e);
            fprintf(a->out, "%.1f,%.1f ", at_x(a, e.peak), at_y(a, fmax(e.band[side], a->least)));
        }
    fputs("\"/>\n", a->out);
    return true;
}

static void write_points(const axes *a, const mps_impacts *impacts, const int64_t *rank, int count)
{
    mps_exceedance e;
    mps_exceedance_init(&e, sizeof e);
    for (int k = 0; k < count; k++) {
        mps_impacts_exceedance(impacts, rank[k], &e);
        fprintf(a->out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\"/>", at_x(a, e.peak),
                at_y(a, e.share));
    }
    fputc('\n', a->out);
}

static bool write_fit(const axes *a, const mps_impacts *impacts, int32_t kind)
{
    mps_fit fit;
    bool pen = false;
    mps_fit_init(&fit, sizeof fit);
    if (mps_impacts_fit_get(impacts, kind, &fit) != MPS_OK || !isfinite(fit.scale)) return false;
    fprintf(a->out, "<path class=\"fit%d\" d=\"", (int)kind);
    for (int k = 0; k <= CURVE; k++) {
        const double p = a->lo + (a->hi - a->lo) * k / CURVE, share = mps_fit_exceedance(&fit, p);
        if (!(share >= a->least)) continue;
        fprintf(a->out, "%c%.1f %.1f", pen ? 'L' : 'M', at_x(a, p), at_y(a, share));
        pen = true;
    }
    fputs("\"/>\n", a->out);
    return true;
}

void mps__page_exceedance(FILE *out, const mps_impacts *impacts, const char *name)
{
    axes a = {.out = out};
    int64_t rank[RANKS];
    mps_impacts_info info;
    mps_impacts_info_init(&info, sizeof info);
    mps_impacts_info_get(impacts, &info);
    a.model = info.pressure_scale != 1;
    if (info.events < 2 || !range_of(&a, impacts, info.events)) return;
    const int count = choose_ranks(info.events, rank);
    fprintf(
        out,
        "<figure><svg class=\"plot\" viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"Share of the "
        "peaks of ",
        WIDTH, HEIGHT);
    mps__html(out, name);
    fputs(" above a pressure\">\n", out);
    write_axes(&a);
    const bool banded = write_band(&a, impacts, rank, count);
    const bool weibull = write_fit(&a, impacts, MPS_FIT_WEIBULL);
    const bool pareto = write_fit(&a, impacts, MPS_FIT_PARETO);
    write_points(&a, impacts, rank, count);
    fputs("</svg>\n<figcaption>Share of the peaks that are higher than a pressure.", out);
    if (weibull) fputs(" Full line: Weibull.", out);
    if (pareto) fputs(" Dashed: generalised Pareto.", out);
    if (banded) fputs(" Shaded: band of the shares.", out);
    fputs("</figcaption></figure>\n", out);
}
