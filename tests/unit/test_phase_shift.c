/* SPDX-License-Identifier: BSD-3-Clause */
/* shift.tangential: displacements and transported velocities against a loop over all particles. */
#include "phase_fixture.h"
#include <stdbool.h>

enum { CAPACITY = 1000 };
static const double FILTER = 0.7, STRENGTH = 1.3;

enum { VELOCITY, DENSITY, REGION, ASYMMETRY, DISPLACEMENT, USES };
static const mps_use uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS},
                                   [DENSITY] = {"density", MPS_USE_NEIGHBOURS},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS},
                                   [ASYMMETRY] = {"asymmetry", MPS_USE_NEIGHBOURS},
                                   [DISPLACEMENT] = {"displacement", MPS_USE_READ}};

/* Of the last step, by row; worst: largest difference from what is expected over the largest. */
static struct {
    double limit; /* setting */
    double velocity[3 * CAPACITY], displacement[3 * CAPACITY], even[3 * CAPACITY];
    double shift, worst_shift, change, worst_change;
    int64_t limited, bounded, surface, near, spray, beside, bent;
} seen;

typedef struct pair {
    double d[3], r, w, w_r2;
} pair;

static bool pair_of(const mps_view *v, int64_t i, int64_t j, pair *q)
{
    static mps_kernel kernel = {.struct_size = sizeof kernel};
    const int dim = v->dim;
    if (!kernel.id) assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    *q = (pair){0};
    for (int d = 0; d < dim; d++) q->d[d] = v->x[j * dim + d] - v->x[i * dim + d];
    q->r = sqrt(q->d[0] * q->d[0] + q->d[1] * q->d[1] + q->d[2] * q->d[2]);
    if (i == j || q->r >= v->near.re) return false;
    q->w = mps_kernel_value(&kernel, q->r, v->near.re);
    q->w_r2 = q->w / (q->r * q->r);
    return true;
}

static int keep(mps_stage *s)
{
    const mps_view *v = s->view;
    const double *u = s->data[VELOCITY], *x = s->data[DISPLACEMENT];
    const size_t bytes = (size_t)(v->n * v->dim) * sizeof *u;
    const int32_t *region = s->data[REGION];
    assert_true(v->n <= CAPACITY);
    memcpy(seen.velocity, u, bytes);
    memcpy(seen.displacement, x, bytes);
    memset(seen.even, 0, sizeof seen.even);
    for (int64_t i = 0; i < v->n; i++)
        for (int64_t j = 0; j < v->n; j++) {
            pair q;
            if (region[i] == MPS_REGION_SPRAY || !pair_of(v, i, j, &q)) continue;
            for (int d = 0; d < v->dim; d++) seen.even[i * v->dim + d] += q.w_r2 * q.d[d];
        }
    return 0;
}

static double dot(int dim, const double *a, const double *b)
{
    double sum = 0;
    for (int d = 0; d < dim; d++) sum += a[d] * b[d];
    return sum;
}

/* v minus `share` times its component along n. */
static void remove_along(int dim, const double *n, double share, double *v)
{
    const double n2 = dot(dim, n, n), along = dot(dim, n, v);
    for (int d = 0; d < dim && n2 > 0; d++) v[d] -= share * along / n2 * n[d];
}

/* Largest |u_j - u_i|; mean: of sum w r over the fluid inside. */
static double strain_and_mean(const mps_stage *s, int64_t i, double *mean)
{
    const int dim = s->view->dim;
    const int32_t *region = s->data[REGION];
    double most = 0, weight = 0, sum[3] = {0};
    for (int64_t j = 0; j < s->view->n; j++) {
        pair q;
        double du[3];
        if (!pair_of(s->view, i, j, &q)) continue;
        for (int d = 0; d < dim; d++)
            du[d] = seen.velocity[j * dim + d] - seen.velocity[i * dim + d];
        most = fmax(most, sqrt(dot(dim, du, du)));
        if (region[j] >= MPS_REGION_SURFACE) continue;
        weight += q.w;
        for (int d = 0; d < dim; d++) sum[d] += q.w * seen.even[j * dim + d];
    }
    for (int d = 0; d < dim; d++) mean[d] = weight > 0 ? sum[d] / weight : 0;
    return most;
}

/* Sum W r over fluid of another density; the fraction of the normal component that is removed. */
static double interface_of(const mps_stage *s, int64_t i, double *n)
{
    const double *rho = s->data[DENSITY];
    const int32_t *region = s->data[REGION];
    double length = 0;
    for (int64_t j = 0; j < s->view->n; j++) {
        pair q;
        if (rho[j] == rho[i] || region[j] == MPS_REGION_SPRAY || !pair_of(s->view, i, j, &q))
            continue;
        length += q.w * q.r;
        for (int d = 0; d < s->view->dim; d++) n[d] += q.w * q.d[d];
    }
    return length > 0 ? fmin(1, 2 * sqrt(dot(s->view->dim, n, n)) / length) : 0;
}

static void surface_of(const mps_stage *s, int64_t i, double *n)
{
    const mps_view *v = s->view;
    const double *a = s->data[ASYMMETRY];
    const int32_t *region = s->data[REGION];
    pair q;
    for (int d = 0; d < v->dim && region[i] == MPS_REGION_SURFACE; d++) n[d] = a[i * v->dim + d];
    for (int64_t j = 0; j < v->n && region[i] == MPS_REGION_NEAR; j++)
        if (region[j] == MPS_REGION_SURFACE && pair_of(v, i, j, &q))
            for (int d = 0; d < v->dim; d++) n[d] += q.w * a[j * v->dim + d];
    seen.surface += region[i] == MPS_REGION_SURFACE;
    seen.near += region[i] == MPS_REGION_NEAR;
}

static void expected_shift(const mps_stage *s, int64_t i, double *v)
{
    const mps_view *view = s->view;
    const int dim = view->dim;
    const double c = -STRENGTH * view->dt * view->dp * dim / view->near.n0,
                 *even = seen.even + i * dim;
    double mean[3] = {0}, between[3] = {0}, up[3] = {0}, calm[3] = {0};
    const double rate = strain_and_mean(s, i, mean), share = interface_of(s, i, between);
    for (int d = 0; d < dim; d++) calm[d] = c * view->velocity_scale * (even[d] - FILTER * mean[d]);
    remove_along(dim, between, share, calm);
    for (int d = 0; d < dim; d++) v[d] = calm[d] + c * rate * even[d];
    surface_of(s, i, up);
    remove_along(dim, up, 1, v);
    const double length = sqrt(dot(dim, v, v)), most = seen.limit * view->dp;
    for (int d = 0; d < dim && length > most; d++) v[d] *= most / length;
    seen.limited += length > most;
    seen.beside += share > 0;
    seen.bent += share > 0 && share < 1;
}

/* s.grad u over the same phase, within the range of its velocities. */
static void expected_change(const mps_stage *s, int64_t i, const double *shift, double *du)
{
    const mps_view *view = s->view;
    const int dim = view->dim;
    const double c = dim / view->near.n0, *u = seen.velocity;
    const int32_t *region = s->data[REGION];
    double m[9] = {0}, b[9], low[3] = {0}, high[3] = {0}, g[9] = {0};
    for (int64_t j = 0; j < view->n; j++) {
        pair q;
        if (view->phase[j] != view->phase[i] || region[j] == MPS_REGION_SPRAY ||
            !pair_of(view, i, j, &q))
            continue;
        for (int d = 0; d < dim; d++) {
            const double rate = u[j * dim + d] - u[i * dim + d];
            low[d] = fmin(low[d], rate);
            high[d] = fmax(high[d], rate);
            for (int e = 0; e < dim; e++) m[d * dim + e] += c * q.w_r2 * q.d[d] * q.d[e];
            for (int e = 0; e < dim; e++) g[d * dim + e] += c * q.w_r2 * rate * q.d[e];
        }
    }
    mps_matrix_inverse_bounded(dim, m, 0.25, b);
    for (int d = 0; d < dim; d++) {
        double v = 0;
        for (int e = 0; e < dim; e++) v += g[d * dim + e] * dot(dim, b + e * dim, shift);
        seen.bounded += v < low[d] || v > high[d];
        du[d] = fmin(fmax(v, low[d]), high[d]);
    }
}

static int compare(mps_stage *s)
{
    const double *u = s->data[VELOCITY], *x = s->data[DISPLACEMENT];
    const int32_t *region = s->data[REGION];
    for (int64_t i = 0; i < s->view->n; i++) {
        double v[3] = {0}, du[3] = {0};
        if (region[i] != MPS_REGION_SPRAY) {
            expected_shift(s, i, v);
            expected_change(s, i, v, du);
        }
        seen.spray += region[i] == MPS_REGION_SPRAY;
        for (int d = 0; d < s->view->dim; d++) {
            const int64_t k = i * s->view->dim + d;
            const double moved = x[k] - seen.displacement[k], change = u[k] - seen.velocity[k];
            seen.shift = fmax(seen.shift, fabs(moved));
            seen.change = fmax(seen.change, fabs(change));
            seen.worst_shift = fmax(seen.worst_shift, fabs(moved - v[d]));
            seen.worst_change = fmax(seen.worst_change, fabs(change - du[d]));
        }
    }
    return 0;
}

static const mps_verb before_verbs[] = {
    {.hook = MPS_SHIFT, .use_count = USES, .uses = uses, .before = "*", .run = keep}};
static const mps_model_ops before_shift = {.struct_size = sizeof(mps_model_ops),
                                           .api = MPS_MODEL_API,
                                           .name = "before.shift",
                                           .help = "keeps what the shift changes",
                                           .verb_count = 1,
                                           .verbs = before_verbs};
static const mps_verb after_verbs[] = {
    {.hook = MPS_SHIFT, .use_count = USES, .uses = uses, .after = "*", .run = compare}};
static const mps_model_ops after_shift = {.struct_size = sizeof(mps_model_ops),
                                          .api = MPS_MODEL_API,
                                          .name = "after.shift",
                                          .help = "compares what the shift has changed",
                                          .verb_count = 1,
                                          .verbs = after_verbs};

/* A jittered block with a free surface on all sides, its lower half of another density, and
 * droplets near it; one step with shifting only. */
static void shift_block(int dim, double ratio, double limit, double speed)
{
    const int side = dim == 2 ? 14 : 8;
    cloud c = cloud_lattice(dim, side, side, dim == 3 ? side : 1, 0.2, 31);
    int32_t *phase = cloud_phases(c.n);
    double *u = cloud_field(c.n * dim, 7);
    mps_sim *sim = bare_sim(dim, CLOUD_DP, 3.1, 1e-3);
    for (int64_t k = 0; k < c.n * dim; k++) u[k] *= speed;
    for (int64_t i = 0; i < c.n; i++) phase[i] = c.x[i * dim + 1] < 0.45 * side * CLOUD_DP;
    phase[c.n - side * side / 3] = 1; /* amid the others */
    for (int64_t i = 0; i < 3; i++) { /* the drops */
        c.x[i * dim] = (3 + 4 * (double)i) / 14 * side * CLOUD_DP;
        c.x[i * dim + 1] = -1.6 * CLOUD_DP;
    }
    memset(&seen, 0, sizeof seen);
    seen.limit = limit;
    set_phase(sim, 0, 1000, 0);
    set_phase(sim, 1, 1000 / ratio, 0);
    add_cloud(sim, &c, phase, u);
    ASSERT_OK(sim, mps_model_register(sim, &before_shift));
    ASSERT_OK(sim, mps_model_register(sim, &after_shift));
    ASSERT_OK(sim, mps_model_use(sim, "before.shift"));
    ASSERT_OK(sim, mps_model_use(sim, "after.shift"));
    ASSERT_OK(sim, mps_model_use(sim, "surface.asymmetry"));
    ASSERT_OK(sim, mps_model_use(sim, "shift.tangential"));
    ASSERT_OK(sim, mps_model_set(sim, "shift", "limit", limit));
    ASSERT_OK(sim, mps_model_set(sim, "shift", "filter", FILTER));
    ASSERT_OK(sim, mps_model_set(sim, "shift", "strength", STRENGTH));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
    cloud_free(&c);
    free(phase);
    free(u);
}

/* With one density and two, limited or not, in calm water and in a flow with strain. */
static void sum_over_the_fluid(void **state)
{
    (void)state;
    for (int k = 0; k < 16; k++) {
        const int dim = 2 + k / 8, two = k / 4 % 2, limited = k / 2 % 2;
        shift_block(dim, two ? 3 : 1, limited ? 1e-3 : 0.5, k % 2 ? 2 : 0.01);
        print_message(
            "%d-D: shift to %.2g, change to %.2g; %lld limited, %lld bounded, %lld on the "
            "surface, %lld near, %lld beside, %lld spray\n",
            dim, seen.worst_shift / seen.shift, seen.worst_change / seen.change,
            (long long)seen.limited, (long long)seen.bounded, (long long)seen.surface,
            (long long)seen.near, (long long)seen.beside, (long long)seen.spray);
        assert_true(seen.surface > 10 && seen.near > 10 && seen.spray > 0);
        assert_true(two == (seen.beside > 10) && two == (seen.bent > 0));
        assert_true(limited == (seen.limited > 10));
        assert_true(seen.shift > 0 && seen.worst_shift < 1e-9 * seen.shift);
        assert_true(seen.change > 0 && seen.worst_change < 1e-9 * seen.change);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sum_over_the_fluid)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
