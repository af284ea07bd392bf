/* SPDX-License-Identifier: BSD-3-Clause */
/* Common functions of the models of a compressible phase. */
#include "helpers.h"

typedef struct speeds {
    const double *velocity;
    double phase;
} speeds;

/* Maximum of |u|^2 over the gas, relative to the tank. */
MPS_ROW void raise_speed(const int dim, const mps_view *v, const speeds *f, int64_t i, double *most)
{
    if (!mps__is_gas(v, i, f->phase)) return;
    double u[3], square = 0;
    mps_view_relative(dim, v, v->x + i * dim, f->velocity + i * dim, u);
    for (int d = 0; d < dim; d++) square += u[d] * u[d];
    most[0] = mps_larger(most[0], square);
}
MPS_SUMS(raise_speed_rows, raise_speed, speeds)

int mps__gas_check(mps_stage *s, double phase, double sound, const double *velocity)
{
    double rho[MPS_PHASES], most;
    mps_stage_densities(s, rho, NULL);
    if (!(rho[(int)phase] > 0))
        return mps_stage_fail(
            s,
            "phase %d has no fluid particle: add the gas, or set gas.phase to it; "
            "with liquids alone remove the model \"gas\"; one liquid with a "
            "surface: preset \"imps\"",
            (int)phase);
    if (s->view->fastest < sound) return 0;
    mps_stage_max(s, 1, &raise_speed_rows, &(speeds){velocity, phase}, &most);
    const double fastest = sqrt(mps_larger(most, 0));
    if (!(fastest < sound))
        return mps_stage_fail(
            s,
            "a particle of phase %d moves at %g m/s in the tank, and the speed of sound there "
            "is %g m/s: it must be greater",
            (int)phase, fastest, sound);
    return 0;
}

typedef struct volumes {
    double *denser, *sum;
    double *volume_deviation, *number_density;
} volumes;

/* (n - n0)/n0 of the particle becomes the relative reduction of its volume. */
MPS_ROW void shrink(const int dim, const mps_view *v, const volumes *f, int64_t i)
{
    (void)dim, (void)v;
    f->denser[i] /= 1.0 + f->denser[i];
}
MPS_ROWS(shrink_rows, shrink, volumes)

MPS_ROW void subtract(const int dim, const mps_view *v, const volumes *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    f->volume_deviation[i] -= f->sum[i];
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const double less = f->denser[mps_stencil_column(t, p)];
        if (less != 0) f->number_density[i] -= less * mps_stencil_pair_dim(dim, t, i, p).w;
    }
}
MPS_ROWS(subtract_rows, subtract, volumes)

/* Each particle counts with its volume by the equation of state, 1/(1 + denser), also in the sums
 * over its neighbours: walls and liquid beside a compressed gas keep their own. */
int mps__gas_expect(mps_stage *s, double *denser, double *volume_deviation, double *number_density)
{
    volumes f = {denser, mps_stage_scratch(s, s->view->n), volume_deviation, number_density};
    if (!f.sum) return 1;
    mps_stage_rows(s, &shrink_rows, &f);
    if (mps_stage_refresh(s, 1, &(mps_shared){denser, 1, MPS_TYPE_REAL})) return 1;
    if (mps_op_volume_sum(&s->view->far, denser, f.sum) != MPS_OK)
        return mps_stage_fail(s, "the volumes of the gas cannot be summed");
    mps_stage_rows(s, &subtract_rows, &f);
    return 0;
}

/* Gas fraction in the cell of a wall particle: the fraction of the cell that the wall particle
 * represents, times the gas fraction of the fluid beside it. */
MPS_ROW double wall_share(const int dim, const mps_view *v, const int32_t *region, int64_t i,
                          double phase)
{
    const mps_stencil *t = &v->near;
    const double wall_factor = v->flux.wall_factor;
    double fluid = 0, gas = 0, walls = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (mps_region_of(region, j) >= MPS_REGION_SPRAY) continue;
        const double w = mps_stencil_pair_dim(dim, t, i, p).w;
        if (mps_is_fluid(v, j)) fluid += w;
        if (mps__is_gas(v, j, phase)) gas += w;
        if (mps_is_wall(v, j)) walls += wall_factor * w;
    }
    return fluid > 0 ? gas / fluid * (fluid + walls) / t->n0 : 0.0;
}

double mps__gas_fraction(const mps_view *v, const int32_t *region, int64_t i, double phase)
{
    if (mps_is_fluid(v, i)) return mps__is_gas(v, i, phase) ? 1.0 : 0.0;
    if (mps_is_dummy(v, i) || mps_region_of(region, i) >= MPS_REGION_SPRAY) return 0.0;
    if (v->flux.wall_factor == 0) return 0.0;
    return v->dim == 2 ? wall_share(2, v, region, i, phase) : wall_share(3, v, region, i, phase);
}

/* Amounts that mps__gas_conserve() subtracts: from the gas, from each row. */
typedef struct balance {
    mps__gas_rows rows;
    double gas, part;
} balance;

MPS_ROW void subtract_balance(const int dim, const mps_view *v, const balance *f, int64_t i)
{
    (void)dim;
    if (!mps__gas_in_equation(v, f->rows.region, i)) return;
    f->rows.source[i] += (mps__is_gas(v, i, f->rows.phase) ? f->gas : 0.0) - f->part;
}
MPS_ROWS(subtract_balance_rows, subtract_balance, balance)

/* The tank is rigid and the liquid keeps its volume, so the gas must keep its volume. But the sum
 * of the divergences over all rows is not exactly 0, and a gas integrates the residual: a mean
 * error of 0.1 1/s is 14 kPa a second in air.
 *  - A small residual, as in calm tanks, is subtracted from all rows. Subtracted from the gas alone
 *    it would add 0.2 % of rho g h to the pressure of the liquid.
 *  - A larger residual, as from a single row in an impact, is subtracted from the gas alone. As a
 *    source in the whole liquid it would give a pressure of many kPa for a step. */
void mps__gas_conserve(const mps_stage *s, const mps__gas_rows *rows, const double *sums)
{
    const mps_view *v = s->view;
    static const double share = 0.1; /* fraction of the surplus that a step removes */
    /* limit of the residual subtracted from all rows, in g/dp */
    static const double small = 0.005;
    const double bound = small * v->velocity_scale * v->velocity_scale / (v->dp * v->dp);
    const double all = sums[MPS__GAS_SOURCES], count = sums[MPS__GAS_ROWS];
    if (sums[MPS__GAS_FIXED] > 0 || sums[MPS__GAS_OWN] == 0) return;
    const double part = mps_smaller(mps_larger(all / count, -bound), bound);
    const double rest = all - part * count,
                 wanted = share * sums[MPS__GAS_SURPLUS] / (v->dt * v->dt);
    const double own = (wanted - rest) / sums[MPS__GAS_OWN];
    mps_stage_rows(s, &subtract_balance_rows, &(balance){*rows, own, part});
}
