/* SPDX-License-Identifier: BSD-3-Clause */
/* Two fluids at rest, Wen, Zhao & Wan 2022 section 4.1: 0.75 m of 1000 kg/m3 below 0.75 m of 1 kg/m3 in a closed tank 1 m wide. */
#include "common/tank.h"
#include "common/view.h"
#include <math.h>

static const double SIZE[] = {1, 1.5, 0}, LAYER = 0.75, HEAVY = 1000, LIGHT = 1, VISCOSITY = 1e-3;

static void build(run *r)
{
    double lo[3], hi[3];
    run_phase(r, 0, HEAVY, VISCOSITY);
    run_phase(r, 1, LIGHT, VISCOSITY);
    tank_walls_about(r, SIZE, LAYER, lo, hi);
    run_check(r, mps_fill_box_add(r->sim, 0, lo, (const double[]){hi[0], LAYER}, NULL, NULL),
              "heavy fluid");
    run_check(r, mps_fill_box_add(r->sim, 1, lo, hi, NULL, NULL), "light fluid");
}

/* How far a fluid reaches beyond the interface [m]. */
static double trespass(void *user, mps_sim *sim)
{
    view v;
    double most = -INFINITY;
    (void)user;
    if (!view_open(sim, &v)) return NAN;
    for (int64_t i = 0; i < v.x.count; i++) {
        const double above = v.x.data[i * v.x.stride + 1] - LAYER;
        if (v.kind.integers[i] == MPS_FLUID)
            most = fmax(most, v.phase.integers[i] == 0 ? above : -above);
    }
    return view_close(sim, &v) ? most : NAN;
}

static void add_columns(run *r)
{
    static const char *const name[] = {"P1", "P2", "P3"};
    for (int i = 0; i < 3; i++) run_wall_pressure(r, name[i], 0, 0.25 * (i + 1), 0);
    run_particle_figure(r, "trespass",
                        "how far a fluid reaches beyond the interface at the end [m]", trespass,
                        NULL);
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    cli_defaults(&o, "static_two_fluid",
                 "two fluids at rest, Wen, Zhao & Wan 2022, section 4.1: 1000 kg/m3 below 1 kg/m3");
    o.model = "mmps";
    o.need = "reference.lid";
    o.dp = 0.02;
    o.dp_min = 0.001;
    o.dp_max = 0.1;
    o.t_end = 5;
    o.has_sigma = true;
    cli_parse(&o, argc, argv);
    run_open(&r, &o);
    build(&r);
    add_columns(&r);
    return run_finish(&r);
}
