/* SPDX-License-Identifier: BSD-3-Clause */
/* Source of the pressure equation for the scheme "imps":
 *   gain (delta/tau - Div(v))/dt,  Div_i = D/n0 sum w (v_j - v_i).B_i r_ij,  w = W/r^2,
 * v the velocities relative to the reference motion. Gravity and the acceleration of the tank are
 * in the body force b = g - a_tank, so that fluid at rest or rigidly accelerated is exact on any
 * arrangement of particles. Walls are free-slip: no-slip walls double the noise. tau_g = dp/U_g,
 * U_g the mps_view.velocity_scale.
 *
 * gain: gradient and divergence are not exact inverses. In films of one or two particles on a wall,
 * where B is large in both, a full step overshoots by more than a factor of two, and the error
 * grows from step to step with alternating sign; hence the gain below 1. A steady pressure does not
 * depend on the gain; a change is delayed by 1/gain steps.
 *
 * Beside another density the velocities of neighbours are weighted by mass: the face between water
 * and air moves with the water. */
#include "helpers.h"

enum { TAU, CLIP, STRAIN, GAIN, FIRM, RAPID, TORN, FORWARD, PACE, ASIDE, START, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [TAU] = {"tau", "tau_g", "Relaxation time of small volume deviations", MPS_TYPE_REAL, 20.0, 0.1,
             1e6},
    [CLIP] = {"clip", "-", "Largest volume deviation that counts", MPS_TYPE_REAL, 0.1, 0.0, 1.0},
    [STRAIN] = {"strain", "-", "Share of the strain of the flow that the source corrects",
                MPS_TYPE_REAL, 1.0, 0.0, 1.0},
    [GAIN] = {"gain", "-", "Share of the divergence that a step removes", MPS_TYPE_REAL, 0.7, 0.05,
              1.0},
    [FIRM] = {"firm", "-", "Volume deviation beyond which the relaxation time falls to tau_g",
              MPS_TYPE_REAL, 0.03, 1e-3, 1.0},
    [RAPID] = {"rapid", "-", "Rate of recovery beyond torn, in U/dp of the denser fluid",
               MPS_TYPE_REAL, 0.0, 0.0, 3.0},
    [TORN] = {"torn", "-", "Volume deviation beyond which rapid acts", MPS_TYPE_REAL, 0.15, 1e-3,
              10.0},
    [FORWARD] = {"forward", "-", "Share of the strain that is corrected in full despite the gain",
                 MPS_TYPE_REAL, 0.0, 0.0, 1.0},
    [PACE] = {"pace", "-", "1: scale the dense fluid's source by dt over the dt of its own speed",
              MPS_TYPE_REAL, 1.0, 0.0, 1.0},
    [ASIDE] = {"aside", "-", "1: no slow relaxation where half of the volume about is solid",
               MPS_TYPE_REAL, 1.0, 0.0, 1.0},
    [START] = {"start", "tau_g", "Time over which the relaxation sets in after the start",
               MPS_TYPE_REAL, 5.0, 0.0, 1e6}};

enum {
    VELOCITY,
    DENSITY,
    REGION,
    TANK_ACCELERATION,
    VOLUME_DEVIATION,
    PRESSURE_DENSITY,
    CORRECTION,
    SOURCE,
    USES
};
static const mps_use uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_READ},
                                   [DENSITY] = {"density", MPS_USE_NEIGHBOURS},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS},
                                   [TANK_ACCELERATION] = {"tank_acceleration", MPS_USE_READ},
                                   [VOLUME_DEVIATION] = {"volume_deviation", MPS_USE_READ},
                                   [PRESSURE_DENSITY] = {"pressure_density", MPS_USE_READ},
                                   [CORRECTION] = {"correction", MPS_USE_READ},
                                   [SOURCE] = {"pressure_source", MPS_USE_CHANGE}};

/* Scale of the source by density: 1 for the lightest fluid, `heavy` for the heaviest. span:
 * difference of their densities. drive: largest speed of all fluid except the lightest, at least
 * U_g [m/s].
 *
 * pace: a velocity that must vanish within a step needs a pressure ~ 1/dt. Gas squeezed out of a
 * closing gap is ten times as fast as the water that drives it, and the steps are shorter by that
 * factor. So the source of the dense fluid is scaled by dt over the dt that its own speed would
 * allow. Its pressures are then those of steps of that length. */
typedef struct pacing {
    double lightest, span, heavy, drive;
} pacing;

typedef struct fields {
    const double *velocity, *density, *tank_acceleration, *volume_deviation, *pressure_density;
    const double *correction;
    const int32_t *region;
    double *source;
    double *is_solid, *solid; /* [n] 1 for solids; their volume fraction around a particle */
    double *delta;            /* [n] clipped volume deviation */
    double *relative;         /* [n*dim] relative velocity */
    double *v;                /* [n*dim] the same with slip at walls */
    int32_t whole;            /* last region with a full far kernel */
    double strain;            /* factor of dt T */
    double own;               /* weight of a particle's own delta in the kernel mean */
    double rate, over, on;    /* 1/tau_g, 1/dt, fraction of the relaxation at the start */
    pacing pace;
} fields;

/* delta of a fluid particle; not negative near the surface, where the kernel is truncated. The
 * region SECOND has no surface particle within the near radius: there a kernel that extends at most
 * half a spacing farther is complete. */
MPS_ROW double clipped_deviation(const mps_view *view, const fields *f, int64_t i)
{
    const double clip = view->setting[CLIP];
    double v = f->volume_deviation[i];
    if (mps_region_of(f->region, i) > f->whole && v < 0) v = 0;
    return mps_smaller(clip, mps_larger(-clip, v));
}

/* Sets is_solid, delta, and relative: for fluid the velocity as if it moved with the tank during
 * this step, without gravity and pressure; for walls their velocity in this step. */
MPS_ROW void prepare(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    const bool fluid = mps_is_fluid(view, i);
    f->is_solid[i] = !fluid;
    if (fluid && mps_region_of(f->region, i) < MPS_REGION_SURFACE)
        f->delta[i] = clipped_deviation(view, f, i);
    for (int d = 0; d < dim; d++) {
        const int64_t k = i * dim + d;
        const double body = view->g[d] - f->tank_acceleration[k];
        f->relative[k] = f->velocity[k] - (fluid ? view->dt * body : 0.0);
    }
}
MPS_ROWS(prepare_rows, prepare, fields)

/* Weight of a neighbour's velocity in that of the face between both: by mass, so that water does
 * not respond to the air beside it. With this weight the divergence is the adjoint of a pressure
 * gradient over rho_ij. */
static inline double face_share(const mps_view *view, const double *rho, int64_t i, int64_t j)
{
    if (view->phase[i] == view->phase[j] || !mps_is_fluid(view, j)) return 1.0;
    return 2.0 * rho[j] / (rho[i] + rho[j]);
}

/* Free slip: a wall particle keeps its velocity along its normal and has that of the fluid around
 * it along the face. */
MPS_ROW void slip_wall(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    const mps_stencil *t = &view->near;
    const double *v = f->relative, *area = view->area + i * dim;
    double sum[3] = {0}, weight = 0, size = 0, largest = 0, normal = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (!mps_is_fluid(view, mps_stencil_column(t, p))) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double mass = q.w * f->density[q.j];
        weight += mass;
        for (int d = 0; d < dim; d++) sum[d] += mass * (v[q.j * dim + d] - v[i * dim + d]);
    }
    for (int d = 0; d < dim; d++) size += area[d] * area[d];
    for (int d = 0; d < dim; d++) largest = mps_larger(largest, fabs(area[d]));
    if (weight == 0 || size == 0) return;
    for (int d = 0; d < dim; d++) normal += sum[d] / weight * area[d] / sqrt(size);
    /* where faces of the lattice meet (half a cell of each), no direction is tangential in 2-D, and
     * only the edge in 3-D */
    if (dim == 2 && size > 1.5 * largest * largest && size < 0.6 * view->dp * view->dp) return;
    for (int d = 0; d < dim; d++)
        f->v[i * dim + d] += sum[d] / weight - normal * area[d] / sqrt(size);
}

MPS_ROW void slip(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    for (int d = 0; d < dim; d++) f->v[i * dim + d] = f->relative[i * dim + d];
    if (mps_is_wall(view, i) && mps_region_of(f->region, i) != MPS_REGION_DRY)
        slip_wall(dim, view, f, i);
}
MPS_ROWS(slip_rows, slip, fields)

/* B_i with the weights of faces, for a particle beside another density. */
MPS_ROW void face_correction(const int dim, const mps_view *view, const fields *f, int64_t i,
                             double *b)
{
    const mps_stencil *t = &view->near;
    double m[9] = {0};
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (mps_region_of(f->region, mps_stencil_column(t, p)) >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double share = dim / t->n0 * face_share(view, f->density, i, q.j) * q.w_r2;
        for (int d = 0; d < dim; d++)
            for (int e = 0; e < dim; e++) m[d * dim + e] += share * q.d[d] * q.d[e];
    }
    mps_matrix_inverse_bounded(dim, m, 0.5, b);
}

/* Divergence less `strain` dt T, from g = sum w (v_j - v_i) (x) r_ij and B_i. */
MPS_ROW double strained_divergence(const int dim, const mps_stencil *t, const double *g,
                                   const double *b, double strain)
{
    double a[9] = {0}, sum = 0, square = 0; /* a = grad v */
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++)
            for (int f = 0; f < dim; f++)
                a[d * dim + e] += dim / t->n0 * g[d * dim + f] * b[f * dim + e];
    for (int d = 0; d < dim; d++) {
        sum += a[d * dim + d];
        for (int e = 0; e < dim; e++) square += a[d * dim + e] * a[e * dim + d];
    }
    return sum - strain * square;
}

/* Divergence of a fluid particle less `strain` dt T. Moving particles from x to x + dt v changes
 * volumes by dt div v - dt^2 T/2 + ..., so that div v must be dt T/2 after the step. Before the
 * step, strain = 1/gain - 1/2 compensates the gain for T as well. With strain 0 strained particles
 * are compressed at the rate (1/gain - 1/2) dt T, and delta expands them again against the
 * pressure.
 * deviation: out, kernel mean of delta over the fluid: noise of delta at the scale of the lattice
 * must not affect the pressure.
 *
 * strain, forward: the strain of the flow adds -dt T to Div(v) in every step, T = tr((grad v)^2).
 * If the gain delays that too, strained particles are compressed at the rate (1/gain - 1) dt T, and
 * delta expands them again against the pressure of another time and position. T is known in
 * advance, so the source contains the fraction `forward` of it without the gain. */
MPS_ROW double fluid_divergence(const int dim, const mps_view *view, const fields *f, int64_t i,
                                double *deviation)
{
    const mps_stencil *t = &view->near;
    const double *v = f->v, *delta = f->delta, self = f->own;
    double g[9] = {0}, own[9];
    double deltas = self * delta[i], weight = self;
    bool mixed = false;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const bool fluid = mps_is_fluid(view, mps_stencil_column(t, p));
        const bool apart = mps_region_of(f->region, mps_stencil_column(t, p)) >= MPS_REGION_SPRAY;
        if (apart && !fluid) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (fluid) {
            deltas += q.w * delta[q.j];
            weight += q.w;
        }
        if (apart) continue;
        const double share = face_share(view, f->density, i, q.j), w = share * q.w_r2;
        mixed = mixed || share != 1.0;
        for (int d = 0; d < dim; d++) {
            const double rate = w * (v[q.j * dim + d] - v[i * dim + d]);
            for (int e = 0; e < dim; e++) g[d * dim + e] += rate * q.d[e];
        }
    }
    *deviation = deltas / weight;
    const double *b = f->correction + i * dim * dim;
    if (mixed) {
        face_correction(dim, view, f, i, own);
        b = own;
    }
    return strained_divergence(dim, t, g, b, f->strain * view->dt);
}

/* Speed below which a step is 0.06 tau_g; above it a step is 0.3 dp/u. */
static inline double calm_speed(const mps_view *view)
{
    return 0.3 / 0.06 * view->velocity_scale;
}

/* True for fluid that is much lighter than the row of wall particle i. */
static inline bool lighter(const mps_view *view, const fields *f, int64_t i, int64_t j)
{
    return mps_is_fluid(view, j) && f->density[j] < 0.5 * f->pressure_density[i];
}

/* Largest speed, relative to wall particle i, of the fluid around it that is as dense as its row;
 * at least that of calm water. */
MPS_ROW double wall_speed(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    const mps_stencil *t = &view->near;
    const double *v = f->v;
    double most = calm_speed(view) * calm_speed(view);
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(view, j) || lighter(view, f, i, j)) continue;
        if (mps_region_of(f->region, j) >= MPS_REGION_SPRAY) continue;
        double square = 0;
        for (int d = 0; d < dim; d++) {
            const double rate = v[j * dim + d] - v[i * dim + d];
            square += rate * rate;
        }
        most = mps_larger(most, square);
    }
    return sqrt(most);
}

/* Divergence of the half cell of a wall particle, with the weights of its row of the pressure
 * equation. Where gas and water are in one cell, the speed of the gas is limited to that of the
 * water: otherwise fast gas along the wall would determine the pressure of the water there. */
MPS_ROW double wall_divergence(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    const mps_stencil *t = &view->near;
    const double *v = f->v;
    double sum = 0, limit = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (mps_region_of(f->region, mps_stencil_column(t, p)) >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double flux = 0, square = 0, share = 1.0;
        for (int d = 0; d < dim; d++) {
            const double rate = v[q.j * dim + d] - v[i * dim + d];
            flux += rate * q.d[d];
            square += rate * rate;
        }
        if (lighter(view, f, i, q.j)) {
            if (limit == 0) limit = wall_speed(dim, view, f, i);
            if (square > limit * limit) share = limit / sqrt(square);
        }
        if (mps_is_wall(view, q.j)) share = mps_flux_wall_fraction(&view->flux, i, q.j);
        sum += q.w_r2 * flux * share;
    }
    return dim / t->n0 * sum;
}

/* tau_g over the relaxation time of delta: tau_g/tau (times `open`), plus up to 1 for delta beyond
 * `firm`, plus up to `most` for delta beyond `torn`.
 *
 * delta is the volume deviation of mps_op_volume_deviation(), clipped and averaged.
 *  - tau: the error of delta follows the waves, and a short tau amplifies them; so it is 20 tau_g.
 *  - firm: compression by some per cent, after an impact, must vanish before the next impact.
 *    Beyond `firm` tau decreases to tau_g.
 *  - torn, rapid: gas that is expanded or compressed by tens of per cent recovers in dp/(U rapid),
 *    U the largest speed of the denser fluid, which drives it, and at least U_g. A time
 *    proportional to the step would be unstable: fast gas makes short steps.
 *  - start: initially delta is not 0 beside walls that are not on the lattice, 10 % at slopes of 45
 *    degrees. Its correction at once took twice the hydrostatic pressure in the first step. The
 *    correction increases over the first `start` tau_g instead. */
static inline double relaxation(const double *k, double delta, double open, double most)
{
    const double firm = delta * delta / (k[FIRM] * k[FIRM]);
    const double torn = delta * delta / (k[TORN] * k[TORN]);
    return mps_smaller(1.0, (open + firm * firm) / k[TAU]) + mps_smaller(1.0, torn * torn) * most;
}

/* Maxima of |u|^2, relative to the tank: of fluid denser than the lightest, of all fluid. */
MPS_ROW void raise_speed(const int dim, const mps_view *view, const fields *f, int64_t i,
                         double *most)
{
    if (!mps_is_fluid(view, i) || mps_region_of(f->region, i) >= MPS_REGION_SURFACE) return;
    double u[3], square = 0;
    mps_view_relative(dim, view, view->x + i * dim, f->velocity + i * dim, u);
    for (int d = 0; d < dim; d++) square += u[d] * u[d];
    most[1] = mps_larger(most[1], square);
    if (f->density[i] > f->pace.lightest) most[0] = mps_larger(most[0], square);
}
MPS_SUMS(raise_speed_rows, raise_speed, fields)

static void set_pace(const mps_stage *s, fields *f)
{
    const mps_view *view = s->view;
    double rho[2], fastest[2];
    mps__density_range(s, rho);
    const bool several = rho[1] > rho[0];
    f->pace = (pacing){rho[0], rho[1] - rho[0], 1.0, view->velocity_scale};
    if (!several && view->setting[RAPID] == 0) return;
    mps_stage_max(s, 2, &raise_speed_rows, f, fastest);
    const double dense = sqrt(mps_larger(0, fastest[0])), any = sqrt(mps_larger(0, fastest[1]));
    f->pace.drive = mps_larger(several ? dense : any, view->velocity_scale);
    if (!several) return;
    const double share = mps_larger(dense, calm_speed(view)) / mps_larger(any, calm_speed(view));
    f->pace.heavy = 1.0 - view->setting[PACE] * (1.0 - share);
}

static inline double row_pace(const mps_view *view, const fields *f, int64_t i)
{
    if (f->pace.heavy == 1.0) return 1.0;
    const double rho = mps_is_fluid(view, i) ? f->density[i] : f->pressure_density[i];
    return 1.0 - (1.0 - f->pace.heavy) * (rho - f->pace.lightest) / f->pace.span;
}

MPS_ROW void add_source(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    if (mps_region_of(f->region, i) >= MPS_REGION_SURFACE) return;
    const double *k = view->setting, share = row_pace(view, f, i);
    if (mps_is_fluid(view, i)) {
        double mean;
        const double divergence = fluid_divergence(dim, view, f, i, &mean);
        const double open = mps_larger(0.0, 1.0 - 2.0 * k[ASIDE] * f->solid[i]);
        const double rapid = k[RAPID] * f->pace.drive / view->velocity_scale;
        const double back = f->on * f->rate * relaxation(k, mean, open, rapid) * mean;
        f->source[i] += share * f->over * (back - divergence);
    } else {
        f->source[i] -= share * f->over * wall_divergence(dim, view, f, i);
    }
}
MPS_ROWS(add_source_rows, add_source, fields)

enum { EQUATION_GAIN, EQUATION_RADIUS, EQUATION_BODY, EQUATION_USES };
static const mps_use equation_uses[EQUATION_USES] = {
    [EQUATION_GAIN] = {"equation_gain", MPS_USE_WRITE},
    [EQUATION_RADIUS] = {"equation_radius", MPS_USE_WRITE},
    [EQUATION_BODY] = {"equation_body", MPS_USE_WRITE}};

static int set_equation(mps_stage *s)
{
    *(double *)s->data[EQUATION_GAIN] = s->view->setting[GAIN];
    *(int32_t *)s->data[EQUATION_RADIUS] = MPS_NEAR;
    *(int32_t *)s->data[EQUATION_BODY] = 1;
    return 0;
}

static int add_sources(mps_stage *s)
{
    const mps_view *view = s->view;
    const double *k = view->setting, rate = view->velocity_scale / view->dp;
    const mps_stencil *t = &view->near;
    const double r = t->kernel.id == MPS_KERNEL_IMPROVED ? 0.0 : 0.5 * view->dp;
    const bool far = view->far.re > t->re + 0.5 * view->dp;
    fields f = {.velocity = s->data[VELOCITY],
                .density = s->data[DENSITY],
                .tank_acceleration = s->data[TANK_ACCELERATION],
                .volume_deviation = s->data[VOLUME_DEVIATION],
                .pressure_density = s->data[PRESSURE_DENSITY],
                .correction = s->data[CORRECTION],
                .region = s->data[REGION],
                .source = s->data[SOURCE],
                .is_solid = mps_stage_scratch(s, view->n),
                .solid = mps_stage_scratch(s, view->n),
                .delta = mps_stage_scratch(s, view->n),
                .relative = mps_stage_scratch(s, view->n * view->dim),
                .v = mps_stage_scratch(s, view->n * view->dim),
                .whole = far ? MPS_REGION_INNER : MPS_REGION_SECOND,
                .strain = k[STRAIN] * (0.5 + k[FORWARD] * (1.0 / k[GAIN] - 1.0)),
                .own = 0.5 * mps_kernel_weight(&t->kernel, r, t->re),
                .rate = rate,
                .over = 1.0 / view->dt,
                .on = k[START] > 0 ? mps_smaller(1.0, view->t * rate / k[START]) : 1.0};
    if (!f.is_solid || !f.solid || !f.delta || !f.relative || !f.v) return 1;
    const mps_shared first[] = {{f.is_solid, 1, MPS_TYPE_REAL},
                                {f.delta, 1, MPS_TYPE_REAL},
                                {f.relative, view->dim, MPS_TYPE_REAL}};
    set_pace(s, &f);
    mps_stage_rows(s, &prepare_rows, &f);
    if (mps_stage_refresh(s, 3, first)) return 1;
    if (mps_op_volume_sum(&view->far, f.is_solid, f.solid) != MPS_OK)
        return mps_stage_fail(s, "the volumes of the solids cannot be summed");
    mps_stage_rows(s, &slip_rows, &f);
    if (mps_stage_refresh(s, 1, &(mps_shared){f.v, view->dim, MPS_TYPE_REAL})) return 1;
    mps_stage_rows(s, &add_source_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_CLASSIFY,
     .use_count = EQUATION_USES,
     .uses = equation_uses,
     .run = set_equation,
     .device = 1},
    {.hook = MPS_SOURCE, .use_count = USES, .uses = uses, .run = add_sources, .device = 1}};

const mps_model_ops mps__source_volume = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "source.volume",
    .help = "Source of the pressure equation by divergence and volume deviation",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 2,
    .verbs = verbs};
