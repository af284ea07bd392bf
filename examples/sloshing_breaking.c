/* SPDX-License-Identifier: BSD-3-Clause */
/* Breaking wave of Wen, Zhao & Wan 2022 section 5.3 (experiment of Rafiee et al. 2011): a tank 1.3 x 0.9 m, in 3-D 0.1 m wide,
 * 0.18 m of water, moved by x = a sin(2 pi f t), f = 0.496 Hz. */
#include "common/cavity.h"
#include "common/tank.h"
#include <math.h>

static const double FREQUENCY = 0.496;
static tank_case tank = {
    .size = {1.3, 0.9, 0.1}, .depth = 0.18, .motion = {.dof = MPS_MOVE_X, .amplitude = 0.1}};

/* The cavity under the plunging crest: a model with air keeps it, one without lets it fall in. */
static double air_volume(void *user, mps_sim *sim)
{
    return cavities_volume(user, sim);
}

static void add_columns(run *r, const tank_case *c)
{
    static const char *const name[] = {"P1", "P2", "P3"};
    static cavities below;
    double level = run_level(r), dp = r->options.dp, middle = c->size[2] / 2;
    for (int i = 0; i < 3; i++)
        run_wall_pressure(r, name[i], c->size[0], 0.165 + 0.015 * i, middle);
    run_gauge(r, "eta_left", dp, middle, level);
    run_gauge(r, "eta_right", c->size[0] - dp, middle, level);
    if (!cavities_create(&below, r->sim, c->size)) run_check(r, MPS_E_NOMEM, "cavities");
    run_particle_value(r, "air_volume", r->options.dim == 3 ? "m3" : "m2",
                       "Volume of trapped air: of cavities that liquid encloses", air_volume,
                       &below);
}

int main(int argc, char **argv)
{
    cli_options o;
    cli_defaults(
        &o, "sloshing_breaking",
        "breaking wave of Wen, Zhao & Wan 2022, section 5.3: x = 0.1 m sin(2 pi 0.496/s t)");
    o.dp = 0.01;
    o.dp_min = 0.0005;
    o.dp_max = 0.03;
    o.t_end = 4.5;
    o.has_dim = true;
    cli_own(&o, (cli_option){"--width", "M", "width of the tank in 3-D [m]", TYPE_REAL,
                             &tank.size[2], 0.01, 2, false});
    tank.motion.omega = 2 * acos(-1.0) * FREQUENCY;
    return tank_main(&o, &tank, add_columns, argc, argv);
}
