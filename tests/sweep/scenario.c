/* SPDX-License-Identifier: BSD-3-Clause */
/* Random sloshing tanks: ranges of practical cases, and some beyond. */
#include "scenario.h"
#include <math.h>

static const double PI = 3.14159265358979323846, GRAVITY = 9.81;

/* ---- numbers --------------------------------------------------------------------------------- */

/* splitmix64 of Steele, Lea & Flood 2014. */
static uint64_t next_bits(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

static double uniform(uint64_t *state, double lo, double hi)
{
    return lo + (hi - lo) * (double)(next_bits(state) >> 11) * 0x1p-53;
}

static double log_uniform(uint64_t *state, double lo, double hi)
{
    return exp(uniform(state, log(lo), log(hi)));
}

static int32_t chance(uint64_t *state, double share)
{
    return uniform(state, 0, 1) < share;
}

static int32_t whole(uint64_t *state, int32_t count)
{
    return (int32_t)uniform(state, 0, count);
}

/* ---- tank ------------------------------------------------------------------------------------ */

/* A side in 0.2..2 m, at most four times as long or short as the first. */
static double draw_side(uint64_t *state, double first)
{
    double side;
    do side = first * log_uniform(state, 0.25, 4);
    while (side < 0.2 || side > 2);
    return side;
}

static void draw_sizes(scenario *s, uint64_t *state)
{
    s->size[0] = log_uniform(state, 0.2, 2);
    s->size[1] = draw_side(state, s->size[0]);
    s->size[2] = s->dim == 3 ? draw_side(state, s->size[0]) : 0;
    s->depth = uniform(state, 0.05, 0.95) * s->size[1];
    double particles = chance(state, 0.9) ? log_uniform(state, 500, 2000)
                                          : log_uniform(state, 2000, 5000);
    double volume = s->size[0] * s->depth * (s->dim == 3 ? s->size[2] : 1);
    s->dp = pow(volume / particles, 1.0 / s->dim);
}

/* Liquid at least three layers deep, sides long enough for the lattice, and not mainly walls. */
static int sizes_fit(const scenario *s)
{
    double shortest = fmin(s->size[0], s->size[1]), faces = 2 * (s->size[0] + s->size[1]) / s->dp;
    if (s->dim == 3) {
        shortest = fmin(shortest, s->size[2]);
        faces = 2 * (s->size[0] * s->size[1] + s->size[1] * s->size[2] + s->size[2] * s->size[0]) /
                (s->dp * s->dp);
    }
    return s->depth >= 3 * s->dp && shortest >= 5 * s->dp && faces < 5000;
}

static void draw_tank(scenario *s, uint64_t *state)
{
    do draw_sizes(s, state);
    while (!sizes_fit(s));
    s->open_top = chance(state, 0.2);
}

/* Mostly straight down, else up to 30 degrees off it. */
static void draw_gravity(scenario *s, uint64_t *state)
{
    double tilt = uniform(state, 0, PI / 6),
           round = s->dim == 3 ? uniform(state, 0, 2 * PI) : PI * whole(state, 2);
    if (!chance(state, 0.25)) tilt = 0;
    s->gravity[0] = GRAVITY * sin(tilt) * cos(round);
    s->gravity[1] = -GRAVITY * cos(tilt);
    s->gravity[2] = s->dim == 3 ? GRAVITY * sin(tilt) * sin(round) : 0;
}

/* A vertical baffle of one to five columns, on the floor, hanging or in between, from wall to wall
 * across z. */
static void draw_baffle(scenario *s, uint64_t *state)
{
    double bottom = uniform(state, 0, 0.6) * s->size[1],
           top = bottom + uniform(state, 0.1, 0.5) * s->size[1];
    double first = floor(uniform(state, 0.2, 0.8) * s->size[0] / s->dp); /* column of the lattice */
    s->lo[0] = (first - 0.1) * s->dp;
    s->hi[0] = (first + whole(state, 5) + 0.1) * s->dp;
    s->lo[1] = chance(state, 0.5) ? 0 : bottom;
    s->hi[1] = fmin(top, s->size[1] - 2 * s->dp) + 3 * s->dp * chance(state, 0.2);
    s->lo[2] = 0;
    s->hi[2] = s->size[2];
}

/* A plate up to 50 degrees off the vertical; lo: lower end, hi: from there to the upper end. */
static void draw_plate(scenario *s, uint64_t *state)
{
    double slope = uniform(state, -50, 50) * PI / 180,
           length = fmax(3 * s->dp, uniform(state, 0.1, 0.5) * s->size[1]);
    s->lo[0] = uniform(state, 0.3, 0.7) * s->size[0];
    s->lo[1] = chance(state, 0.5) ? 0 : uniform(state, 0.1, 0.3) * s->size[1];
    length = fmin(length, fmax(3 * s->dp, 0.25 * s->size[0] / fmax(fabs(sin(slope)), 1e-3)));
    s->lo[2] = 0;
    s->hi[0] = length * sin(slope);
    s->hi[1] = length * cos(slope);
    s->hi[2] = 0;
}

static void draw_obstacle(scenario *s, uint64_t *state)
{
    double kind = uniform(state, 0, 1);
    s->obstacle = kind < 0.15 ? OBSTACLE_BAFFLE : kind < 0.3 ? OBSTACLE_PLATE : OBSTACLE_NONE;
    if (s->obstacle == OBSTACLE_BAFFLE) draw_baffle(s, state);
    if (s->obstacle == OBSTACLE_PLATE) draw_plate(s, state);
}

/* ---- motion ---------------------------------------------------------------------------------- */

/* First natural frequency of the tank along x without obstacles [rad/s]. */
static double natural(const scenario *s)
{
    double k = PI / s->size[0];
    return sqrt(GRAVITY * k * tanh(k * s->depth));
}

/* One to three harmonics of one degree of freedom, together within the largest amplitude. */
static void draw_harmonics(scenario *s, uint64_t *state, int32_t dof)
{
    int32_t count = 1 + whole(state, 3);
    double amplitude = dof < MPS_ROTATE_X ? log_uniform(state, 0.01, 3) * s->depth
                                          : log_uniform(state, 1, 60) * PI / 180;
    for (int32_t k = 0; k < count; k++) {
        mps_harmonic *h = &s->harmonic[s->harmonics++];
        h->dof = dof;
        h->form = chance(state, 0.25);
        h->amplitude = amplitude / count;
        h->omega = uniform(state, 0.05, 2) * natural(s);
        h->phase = chance(state, 0.5) ? uniform(state, 0, 2 * PI) : 0;
    }
}

static void draw_motion(scenario *s, uint64_t *state)
{
    static const int32_t plane[] = {MPS_MOVE_X, MPS_MOVE_Y, MPS_ROTATE_Z};
    int32_t count = s->dim == 3 ? MPS_DOF_COUNT : 3, chosen = 1 + whole(state, (1 << count) - 1);
    for (int d = 0; d < s->dim; d++) s->centre[d] = uniform(state, -0.2, 1.2) * s->size[d];
    s->start = chance(state, 0.5) ? MPS_START_WITH_TANK : MPS_START_AT_REST;
    for (int32_t k = 0; k < count; k++)
        if (chosen >> k & 1) draw_harmonics(s, state, s->dim == 3 ? k : plane[k]);
}

/* ---- building -------------------------------------------------------------------------------- */

static mps_status build_obstacle(const scenario *s, mps_sim *sim, const double *built)
{
    const double edge2[3] = {0, 0, built[2]};
    if (s->obstacle == OBSTACLE_BAFFLE) return mps_baffle_add(sim, "baffle", s->lo, s->hi, NULL);
    if (s->obstacle == OBSTACLE_PLATE)
        return mps_plate_add(sim, "plate", s->lo, s->hi, s->dim == 3 ? edge2 : NULL);
    return MPS_OK;
}

static mps_status build_solids(const scenario *s, mps_sim *sim, double *built)
{
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    for (int d = 0; d < s->dim; d++) tank.size[d] = s->size[d];
    tank.open_top = s->open_top;
    mps_status status = mps_tank_add(sim, &tank, built);
    return status ? status : build_obstacle(s, sim, built);
}

void scenario_draw(scenario *s, uint64_t seed, int32_t dim)
{
    uint64_t state = seed;
    *s = (scenario){.seed = seed};
    int32_t drawn = chance(&state, 0.75)
                        ? 2
                        : 3; /* drawn in any case, so that what follows is the same */
    s->dim = dim ? dim : drawn;
    draw_tank(s, &state);
    draw_gravity(s, &state);
    draw_motion(s, &state);
    draw_obstacle(s, &state);
}

mps_status scenario_build(const scenario *s, const char *model, mps_sim **sim, double *built)
{
    const double lo[3] = {0, 0, 0};
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dim = s->dim;
    config.dp = s->dp;
    for (int d = 0; d < 3; d++) config.gravity[d] = s->gravity[d];
    mps_status status = mps_sim_create(&config, sim);
    if (!status) status = mps_preset_use(*sim, model);
    if (!status) status = build_solids(s, *sim, built);
    const double hi[3] = {built[0], s->depth, built[2]};
    if (!status) status = mps_fill_box_add(*sim, 0, lo, hi, NULL, NULL);
    if (!status) status = mps_motion_centre_set(*sim, s->centre, s->start);
    if (!status) status = mps_motion_harmonics_set(*sim, s->harmonics, s->harmonic);
    return status;
}

void scenario_print(const scenario *s, FILE *out)
{
    static const char *const dof[] = {"x", "y", "z", "rotate_x", "rotate_y", "rotate_z"},
                             *const obstacle[] = {"none", "baffle", "plate"};
    fprintf(out, "seed=%llu dim=%d size=%.3gx%.3g", (unsigned long long)s->seed, (int)s->dim,
            s->size[0], s->size[1]);
    if (s->dim == 3) fprintf(out, "x%.3g", s->size[2]);
    fprintf(out, " top=%s fill=%.2f dp=%.3g tilt=%.0f obstacle=%s start=%s motion=",
            s->open_top ? "open" : "closed", s->depth / s->size[1], s->dp,
            acos(fmin(1, -s->gravity[1] / GRAVITY)) * 180 / PI, obstacle[s->obstacle],
            s->start == MPS_START_WITH_TANK ? "tank" : "rest");
    for (int32_t k = 0; k < s->harmonics; k++) {
        const mps_harmonic *h = &s->harmonic[k];
        if (k == 0 || h->dof != h[-1].dof) fprintf(out, "%s%s:", k ? "," : "", dof[h->dof]);
        fprintf(out, "%s%.3g%s@%.3g", k && h->dof == h[-1].dof ? "+" : "",
                h->dof < MPS_ROTATE_X ? h->amplitude : h->amplitude * 180 / PI,
                h->dof < MPS_ROTATE_X ? "m" : "deg", h->omega);
    }
}
