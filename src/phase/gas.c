/* SPDX-License-Identifier: BSD-3-Clause */
/* What the models of a compressible phase have in common. */
#include "builtin.h"

int mps__gas_check(mps_stage *s, double phase, double sound)
{
    double most = 0;
    int64_t count = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (!mps__is_gas(s, i, phase)) continue;
        double square = 0;
        for (int d = 0; d < s->dim; d++) square += s->u[i * s->dim + d] * s->u[i * s->dim + d];
        most = fmax(most, square);
        count++;
    }
    if (phase != floor(phase)) return mps_stage_fail(s, "gas.phase is %g: must be a whole number", phase);
    if (count == 0)
        return mps_stage_fail(s,
                              "phase %d has no fluid particle: add the gas, or set gas.phase to it; with liquids alone remove the model "
                              "\"gas\"; one liquid with a surface: preset \"imps\"",
                              (int)phase);
    if (!(sqrt(most) < sound))
        return mps_stage_fail(s, "a particle of phase %d moves at %g m/s, and the speed of sound there is %g m/s: it must be greater",
                              (int)phase, sqrt(most), sound);
    return 0;
}

/* Each particle counts with the volume that the equation of state gives it, 1/(1 + denser), in the sums about its neighbours too: walls and
 * liquid beside a compressed gas keep their own. */
int mps__gas_expect(mps_stage *s, double *denser)
{
    double *sum = mps_stage_scratch(s, s->n);
    if (!sum) return 1;
    for (int64_t i = 0; i < s->n; i++) denser[i] /= 1.0 + denser[i];
    if (mps_op_volume_sum(s->far, denser, sum) != MPS_OK) return mps_stage_fail(s, "the volumes of the gas cannot be summed");
    for (int64_t i = 0; i < s->n; i++) s->volume[i] -= sum[i];
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        for (int64_t p = s->near->begin[i]; p < s->near->end[i]; p++)
            if (denser[s->near->col[p]] != 0) s->number_density[i] -= denser[s->near->col[p]] * mps_stencil_pair(s->near, i, p).w;
    return 0;
}

/* Share of the cell of a wall particle that holds gas: of the part of a cell that it stands for, as much as there is gas among the fluid
 * beside it. */
MPS__ROW double wall_share(const int dim, const mps_stage *s, int64_t i, double phase, double wall_factor)
{
    const mps_stencil *t = s->near;
    double fluid = 0, gas = 0, walls = 0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->region[j] >= MPS_REGION_SPRAY) continue;
        const double w = mps_stencil_pair_dim(dim, t, i, p).w;
        if (s->kind[j] == MPS_FLUID) fluid += w;
        if (mps__is_gas(s, j, phase)) gas += w;
        if (s->kind[j] == MPS_WALL) walls += wall_factor * w;
    }
    return fluid > 0 ? gas / fluid * (fluid + walls) / t->n0 : 0.0;
}

double mps__gas_share(const mps_stage *s, int64_t i, double phase, double wall_factor)
{
    if (s->kind[i] == MPS_FLUID) return mps__is_gas(s, i, phase) ? 1.0 : 0.0;
    if (s->kind[i] == MPS_DUMMY || s->region[i] >= MPS_REGION_SPRAY || wall_factor == 0) return 0.0;
    return MPS__ROW_CALL(s, wall_share, s, i, phase, wall_factor);
}

static inline bool in_equation(const mps_stage *s, int64_t i)
{
    return s->kind[i] != MPS_DUMMY && s->region[i] < MPS_REGION_SURFACE;
}

/* The tank is rigid and the liquid keeps its volume, so the gas keeps its own, whatever happens. But divergences that are summed over all
 * rows leave a rest, and a gas integrates it: a mean error of 0.1 1/s is 14 kPa a second in air. All rows share it while it is small, as in
 * calm tanks, where the gas alone would press 0.2 % of rho g h into the liquid. What one row asks for in an impact is for the gas alone:
 * as a source in the whole of the liquid it would be a pressure of many kPa for a step. */
void mps__gas_conserve(const mps_stage *s, mps_ppe_terms *terms, double phase, double surplus)
{
    static const double share = 0.1;   /* of the surplus that a step takes away */
    static const double small = 0.005; /* of g/dp: the rest of which each row takes its part */
    const double bound = small * s->velocity_scale * s->velocity_scale / (s->dp * s->dp);
    double sum = 0;
    int64_t rows = 0, gas = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (terms->fixed[i] == MPS_ROW_FIXED) return;
        if (!in_equation(s, i)) continue;
        sum += terms->rhs[i];
        rows++;
        gas += mps__is_gas(s, i, phase);
    }
    if (gas == 0) return;
    const double part = fmin(fmax(sum / (double)rows, -bound), bound);
    const double own = (share * surplus / (s->dt * s->dt) - (sum - part * (double)rows)) / (double)gas;
    for (int64_t i = 0; i < s->n; i++)
        if (in_equation(s, i)) terms->rhs[i] += (mps__is_gas(s, i, phase) ? own : 0.0) - part;
}
