/* SPDX-License-Identifier: BSD-3-Clause */
/* density.smooth, gradient.density and the models of a compressible phase against their
 * equations. */
#include "phase_fixture.h"
#include <stdbool.h>

static const double rho[3] = {1000, 1.2, 800};

/* A jittered block of layers of three phases. */
typedef struct block {
    cloud c;
    int32_t *phase;
    mps_sim *sim;
    mps_kernel kernel;
    double n0, re;
} block;

static block block_make_with(int dim, double jitter, const char *kernel)
{
    block b = {.c = dim == 2 ? cloud_lattice(2, 18, 21, 1, jitter, 6)
                             : cloud_lattice(3, 8, 12, 8, jitter, 6),
               .kernel = {.struct_size = sizeof b.kernel},
               .re = 2.1 * CLOUD_DP};
    b.phase = cloud_phases(b.c.n);
    for (int64_t i = 0; i < b.c.n; i++)
        b.phase[i] = (int32_t)fmin(2, b.c.x[i * dim + 1] / ((dim == 2 ? 7 : 4) * CLOUD_DP));
    b.sim = bare_sim(dim, CLOUD_DP, 3.1, 1e-6);
    for (int p = 0; p < 3; p++) set_phase(b.sim, p, rho[p], 0);
    assert_int_equal(mps_kernel_find(kernel, &b.kernel), MPS_OK);
    ASSERT_OK(b.sim, mps_kernel_use(b.sim, &b.kernel));
    add_cloud(b.sim, &b.c, b.phase, NULL);
    assert_int_equal(mps_lattice_constants(&b.kernel, dim, CLOUD_DP, b.re, &b.n0, NULL), MPS_OK);
    return b;
}

static block block_make(int dim, double jitter)
{
    return block_make_with(dim, jitter, "improved");
}

static void block_free(block *b)
{
    mps_sim_destroy(b->sim);
    cloud_free(&b->c);
    free(b->phase);
}

/* W22 (13) by a sum over all particles. */
static double smoothed(const block *b, int64_t i, double self)
{
    double sum = self * rho[b->phase[i]], weight = self;
    for (int64_t j = 0; j < b->c.n; j++) {
        if (j == i) continue;
        const double w = mps_kernel_value(&b->kernel, sqrt(cloud_distance2(&b->c, i, j)), b->re);
        sum += w * rho[b->phase[j]];
        weight += w;
    }
    return sum / weight;
}

static void smoothing(void **state)
{
    (void)state;
    static const double self[] = {1, 100, 0};
    for (int dim = 2; dim <= 3; dim++) {
        block b = block_make(dim, 0.2);
        ASSERT_OK(b.sim,
                  mps_step(b.sim, 1, NULL)); /* without the model: the densities themselves */
        for (int64_t i = 0; i < b.c.n; i++) assert_true(spy.density[i] == rho[b.phase[i]]);
        ASSERT_OK(b.sim, mps_model_use(b.sim, "density.smooth"));
        for (int k = 0; k < 3; k++) {
            int64_t same = 0;
            ASSERT_OK(b.sim, mps_model_set(b.sim, "density", "self", self[k]));
            ASSERT_OK(b.sim, mps_step(b.sim, 1, NULL));
            for (int64_t i = 0; i < b.c.n; i++) {
                const double own = rho[b.phase[i]],
                             wanted = smoothed(&b, i,
                                               self[k] * mps_kernel_value(&b.kernel, 0, b.re));
                ASSERT_NEAR(spy.density[i] / wanted, 1, 1e-10);
                same += spy.density[i] == own;
            }
            assert_true(same > b.c.n / 5 && same < b.c.n * 4 / 5); /* only near interfaces */
        }
        double *density = field_by_id(b.sim, "density");
        for (int64_t i = 0; i < b.c.n; i++)
            assert_true(density[i] == rho[b.phase[i]]); /* the mass of no particle changes */
        free(density);
        block_free(&b);
    }
}

/* A kernel that is infinite at 0: a particle's own density has the weight of one half a spacing
 * away. */
static void smoothing_by_original_kernel(void **state)
{
    (void)state;
    block b = block_make_with(2, 0.2, "original");
    const double self = mps_kernel_value(&b.kernel, 0.5 * CLOUD_DP, b.re);
    ASSERT_OK(b.sim, mps_model_use(b.sim, "density.smooth"));
    ASSERT_OK(b.sim, mps_model_set(b.sim, "density", "self", 1));
    ASSERT_OK(b.sim, mps_step(b.sim, 1, NULL));
    for (int64_t i = 0; i < b.c.n; i++)
        ASSERT_NEAR(spy.density[i] / smoothed(&b, i, self), 1, 1e-10);
    block_free(&b);
}

/* ---- gradient.density ------------------------------------------------------------------------ */

static double wavy(const double *x, int dim)
{
    double p = 1000;
    for (int d = 0; d < dim; d++) p += 300 * sin((40 + 10 * d) * x[d] + d);
    return p;
}

static double linear(const double *x, int dim)
{
    return 50 - 2000 * x[0] + 700 * x[1] + (dim == 3 ? 300 * x[2] : 0);
}

/* W22 (18) by sums over all particles. */
static void literal(const block *b, const double *density, int64_t i, double a[3])
{
    const int dim = b->c.dim;
    const double *x = b->c.x, pi = wavy(x + i * dim, dim);
    double least = pi;
    for (int pass = 0; pass < 2; pass++)
        for (int64_t j = 0; j < b->c.n; j++) {
            const double r2 = cloud_distance2(&b->c, i, j), pj = wavy(x + j * dim, dim);
            if (j == i || r2 >= b->re * b->re) continue;
            if (pass == 0) {
                if (b->phase[j] == b->phase[i]) least = fmin(least, pj);
                continue;
            }
            const double w = dim / b->n0 * mps_kernel_value(&b->kernel, sqrt(r2), b->re) / r2;
            const double share = 2 * (pj - pi) / (density[i] + density[j]) +
                                 (pi - least) / density[i];
            for (int d = 0; d < dim; d++) a[d] -= w * share * (x[j * dim + d] - x[i * dim + d]);
        }
}

static void gradient_to_the_letter(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int smooth = 0; smooth < 2; smooth++) {
            block b = block_make(dim, 0.2);
            ASSERT_OK(b.sim, mps_model_use(b.sim, "gradient.density"));
            if (smooth) ASSERT_OK(b.sim, mps_model_use(b.sim, "density.smooth"));
            spy.pressure = wavy;
            ASSERT_OK(b.sim, mps_step(b.sim, 1, NULL));
            for (int64_t i = 0; i < b.c.n; i++) {
                double a[3] = {0}, size = 0;
                literal(&b, spy.density, i, a);
                for (int d = 0; d < dim; d++) size = fmax(size, fabs(a[d]));
                for (int d = 0; d < dim; d++)
                    ASSERT_NEAR(spy.dp_a[i * dim + d], a[d], 1e-10 * size);
            }
            block_free(&b);
        }
}

/* Inside a lattice, also between walls and dummies, a linear pressure gives its gradient over rho:
 * the second sum vanishes. */
static void gradient_of_linear(void **state)
{
    (void)state;
    static const double slope[3] = {-2000, 700, 300};
    for (int dim = 2; dim <= 3; dim++) {
        const double dp = 0.05, lo[3] = {0}, hi[3] = {0.4, 0.4, 0.4};
        mps_sim *sim = bare_sim(dim, dp, 3.1, 1e-6);
        set_phase(sim, 0, 1.2, 0); /* density of the solids: no wall model sets that of the fluid */
        set_phase(sim, 1, 1.2, 0);
        add_tank(sim, 0.4, 0.4, 0.4);
        ASSERT_OK(sim, mps_fill_box_add(sim, 1, lo, hi, NULL, NULL));
        ASSERT_OK(sim, mps_model_use(sim, "gradient.density"));
        double *x = field_by_id(sim, "position");
        const int64_t *ids;
        const int32_t *kinds;
        const int64_t n = mps_particles_count(sim, -1);
        spy.pressure = linear;
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        ASSERT_OK(sim, tags_peek(sim, &ids, &kinds, NULL, NULL));
        int64_t checked = 0;
        for (int64_t k = 0; k < n; k++) {
            const int64_t i = ids[k];
            if (kinds[k] != MPS_FLUID || x[i * dim + 1] > 0.3) continue;
            for (int d = 0; d < dim; d++) ASSERT_NEAR(spy.dp_a[i * dim + d] * -1.2, slope[d], 1e-8);
            checked++;
        }
        assert_true(checked > 20);
        free(x);
        mps_sim_destroy(sim);
    }
}

/* ---- gas ------------------------------------------------------------------------------------- */

static const double cs = 340, dt = 1e-4, swollen = 1e-3, ambient = 1e5, exponent = 1.4;

/* Water and, apart from it, gas. */
static mps_sim *gas(const char *model)
{
    cloud c = cloud_lattice(2, 12, 12, 1, 0, 1);
    int32_t phase[144];
    for (int i = 0; i < 144; i++) {
        phase[i] = i / 12 >= 6;
        if (phase[i]) c.x[2 * i + 1] += 1;
    }
    mps_sim *sim = bare_sim(2, CLOUD_DP, 2.1, dt);
    set_phase(sim, 1, rho[1], 0);
    add_cloud(sim, &c, phase, NULL);
    ASSERT_OK(sim, mps_model_use(sim, model));
    ASSERT_OK(sim, mps_model_set(sim, "gas", "conserve", 0));
    if (strcmp(model, "gas.compressible") == 0) {
        ASSERT_OK(sim, mps_model_set(sim, "gas", "sound", cs));
    } else {
        ASSERT_OK(sim, mps_model_set(sim, "gas", "ambient", ambient));
        ASSERT_OK(sim, mps_solver_use(sim, "sundials.kinsol", NULL));
    }
    cloud_free(&c);
    return sim;
}

/* (n - n0)/n0 of the gas at a pressure, from the law. */
static double wanted_deviation(bool law, double p)
{
    return law ? pow(1 + p / ambient, 1 / exponent) - 1 : p / (rho[1] * cs * cs);
}

/* Only the gas has terms: those of W22 (26) over rho, less the old pressure; and its deviations are
 * those from the law. */
static void gas_terms(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) { /* compressible, as printed, isentropic */
        const bool law = kind == 2;
        const double stiff = 1 / ((law ? exponent * ambient : rho[1] * cs * cs) * dt * dt);
        mps_sim *sim = gas(law ? "gas.isentropic" : "gas.compressible");
        if (kind == 1) ASSERT_OK(sim, mps_model_set(sim, "gas", "printed", 1));
        spy.given_rhs = 1e6;
        spy.given_deviation = swollen;
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        double *before = field_by_id(sim, "pressure");
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        assert_true(before[100] > 1000);
        for (int64_t i = 0; i < 144; i++) {
            const bool own = i >= 72;
            const double p = law ? ambient * log(1 + before[i] / ambient) : before[i];
            assert_true(spy.shift[i] == 0 && spy.law[i] == (own && law ? ambient : 0));
            ASSERT_NEAR(spy.gas[i], own ? stiff : 0, 1e-12 * stiff);
            ASSERT_NEAR(spy.rhs[i], spy.given_rhs + (own && kind != 1 ? stiff * p : 0),
                        1e-9 * spy.given_rhs);
            const double expected = own && kind != 1 ? wanted_deviation(law, before[i]) : 0;
            ASSERT_NEAR(spy.volume[i], spy.wide_sum[i] * (swollen - expected / (1 + expected)),
                        1e-8); /* neighbours' p is the same to the solver's limit */
            ASSERT_NEAR(spy.number[i], 1 + spy.near_sum[i] * (swollen - expected / (1 + expected)),
                        1e-8);
        }
        free(before);
        mps_sim_destroy(sim);
    }
}

/* At rest the pressure is that of the equation of state, for any source and weight; with the
 * printed equation gamma (0.1) times it. */
static void equation_of_state(void **state)
{
    (void)state;
    static const char *const models[] = {"gas.compressible", "gas.isentropic", "gas.compressible"};
    for (int kind = 0; kind < 6; kind++) {
        const bool mixed = kind % 2, printed = kind >= 4;
        if (printed && !mixed) continue;
        mps_sim *sim = gas(models[kind / 2]);
        const double strain = kind / 2 == 1 ? 0.05 : swollen; /* larger than by a linear law */
        mps_solver_limits limits;
        assert_int_equal(mps_solver_limits_init(&limits, sizeof limits), MPS_OK);
        limits.tolerance =
            1e-10; /* the right side is mostly the old pressure: its last changes are small against
                      it */
        ASSERT_OK(sim, mps_solver_limits_set(sim, &limits));
        ASSERT_OK(sim, mps_model_use(sim, mixed ? "source.mixed" : "source.volume"));
        ASSERT_OK(sim, mps_model_set(sim, "source", mixed ? "gamma" : "tau", 0.1));
        if (!mixed) ASSERT_OK(sim, mps_model_use(sim, "moments.bounded")); /* brings "correction" */
        if (!mixed) ASSERT_OK(sim, mps_model_set(sim, "source", "start", 0));
        if (printed) ASSERT_OK(sim, mps_model_set(sim, "gas", "printed", 1));
        spy.given_deviation = strain;
        for (int k = 0; k < (mixed ? 200 : 4000); k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
        for (int64_t i = 72; i < 144; i++) {
            const double denser = wanted_deviation(kind / 2 == 1, spy.p[i]);
            if (printed) {
                assert_true(denser < 0.15 * strain);
            } else {
                ASSERT_NEAR(denser / (1 + denser), strain, 1e-3 * strain);
                ASSERT_NEAR(spy.number[i], 1, 1e-3 * strain);
                ASSERT_NEAR(spy.volume[i], 0, 1e-3 * strain);
            }
        }
        mps_sim_destroy(sim);
    }
}

/* In a closed tank the sources of all rows cancel, at the expense of the gas but for 0.005 g/dp in
 * each row; the gas returns to the pressures at which it has its volume; not so if one row is
 * fixed. */
static void conserved(void **state)
{
    (void)state;
    static const char *const models[] = {"gas.compressible", "gas.isentropic"};
    for (int kind = 0; kind < 4; kind++) {
        const bool open = kind / 2;
        mps_sim *sim = gas(models[kind % 2]);
        ASSERT_OK(sim, mps_model_set(sim, "gas", "conserve", 1));
        if (open) {
            ASSERT_OK(sim, mps_model_use(sim, "surface.original"));
            ASSERT_OK(sim,
                      mps_model_set(sim, "surface", "beta", 0.5)); /* the corners of the blocks */
        }
        spy.given_rhs = 1e6;
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        double sum = 0;
        for (int64_t i = 0; i < 144; i++) sum += spy.rhs[i] / 144;
        ASSERT_NEAR(sum, open ? 1e6 : 0, 1e-6);
        for (int64_t i = 0; i < 72 && !open; i++)
            ASSERT_NEAR(spy.rhs[i], 1e6 - 0.005 * 9.81 / CLOUD_DP, 1e-6);
        if (!open) {
            mps_lease p = {.struct_size = sizeof p};
            spy.given_rhs = 0;
            ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_WRITE, &p));
            for (int64_t i = 0; i < p.count; i++)
                p.data[i] = 5000; /* compressed more than the tank allows */
            ASSERT_OK(sim, mps_lease_end(sim, &p));
            for (int k = 0; k < 150; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
            for (int64_t i = 72; i < 144; i++) ASSERT_NEAR(spy.p[i], 0, 1);
        }
        mps_sim_destroy(sim);
    }
}

/* No gas, gas faster than its sound, and a solver that cannot do it. */
static void gas_refused(void **state)
{
    (void)state;
    static const char *const models[] = {"gas.compressible", "gas.isentropic"};
    for (int m = 0; m < 2; m++) {
        mps_sim *sim = gas(models[m]);
        mps_lease u = {.struct_size = sizeof u};
        ASSERT_REFUSED(sim, mps_model_set(sim, "gas", "phase", 16), MPS_E_ARG, "phase is 16");
        ASSERT_OK(sim, mps_model_set(sim, "gas", "phase", 2));
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "phase 2 has no fluid particle");
        ASSERT_OK(sim, mps_model_set(sim, "gas", "phase", 1));
        ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
        for (int64_t i = 0; i < u.count; i++) u.data[2 * i] = 345;
        ASSERT_OK(sim, mps_lease_end(sim, &u));
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "345 m/s");
        mps_sim_destroy(sim);
    }
    mps_sim *sim = gas("gas.compressible");
    ASSERT_REFUSED(sim, mps_model_set(sim, "gas", "sound", 0), MPS_E_ARG, "sound is 0");
    mps_sim_destroy(sim);
    sim = gas("gas.isentropic");
    ASSERT_REFUSED(sim, mps_model_set(sim, "gas", "ambient", -1), MPS_E_ARG, "ambient is -1");
    static const char *const linear[] = {"sundials.pcg", "sundials.bicgstab", "sundials.gmres",
                                         "sundials.klu"};
    for (int k = 0; k < 4; k++) {
        ASSERT_OK(sim, mps_solver_use(sim, linear[k], NULL));
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE, "gas.isentropic");
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE, linear[k]);
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE, "sundials.kinsol");
    }
    ASSERT_OK(sim, mps_solver_use(sim, "sundials.kinsol", NULL));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
}

/* ---- density.interface ----------------------------------------------------------------------- */

static double heavy_distance; /* "interface_distance" of id 0 */

static int keep_distance(mps_stage *s)
{
    const double *distance = s->data[0];
    for (int64_t i = 0; i < s->view->n; i++)
        if (s->view->id[i] == 0) heavy_distance = distance[i] / s->view->dp;
    return 0;
}

/* Distance [dp] of a heavy particle from the interface, with two light ones at an angle whose
 * cosine is `alignment` from the x axis, 1.2 dp away. */
static double distance_between_two(double alignment)
{
    static const mps_use uses[] = {{"interface_distance", MPS_USE_READ}};
    static const mps_verb verb = {
        .hook = MPS_FORCE, .use_count = 1, .uses = uses, .run = keep_distance};
    static const mps_model_ops keeper = {.struct_size = sizeof keeper,
                                         .api = MPS_MODEL_API,
                                         .name = "keeper.distance",
                                         .help = "keeps a distance",
                                         .verb_count = 1,
                                         .verbs = &verb};
    const double r = 1.2 * CLOUD_DP, up = r * sqrt(1 - alignment * alignment);
    double x[6] = {0, 0, r * alignment, up, r * alignment, -up};
    const int32_t phase[3] = {0, 1, 1};
    const cloud c = {2, 3, x};
    mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, 1e-9);
    set_phase(sim, 0, 1000, 0);
    set_phase(sim, 1, 1, 0);
    add_cloud(sim, &c, phase, NULL);
    ASSERT_OK(sim, mps_model_use(sim, "density.interface"));
    ASSERT_OK(sim, mps_model_register(sim, &keeper));
    ASSERT_OK(sim, mps_model_use(sim, "keeper.distance"));
    heavy_distance = NAN;
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
    return heavy_distance;
}

/* Up to an alignment of 0.5 the interface has no plane: half a spacing. From 0.7 on it is the plane
 * through the middles. Between them the one passes into the other evenly. */
static void plane_takes_over(void **state)
{
    (void)state;
    for (double alignment = 0.45; alignment < 1.0; alignment += 0.02) {
        const double plane = 0.6 * alignment;
        const double trust = fmin(1, fmax(0, (alignment - 0.5) / 0.2));
        ASSERT_NEAR(distance_between_two(alignment), trust * plane + (1 - trust) * 0.5, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(smoothing),
                                       cmocka_unit_test(smoothing_by_original_kernel),
                                       cmocka_unit_test(gradient_to_the_letter),
                                       cmocka_unit_test(gradient_of_linear),
                                       cmocka_unit_test(gas_terms),
                                       cmocka_unit_test(equation_of_state),
                                       cmocka_unit_test(gas_refused),
                                       cmocka_unit_test(conserved),
                                       cmocka_unit_test(plane_takes_over)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
