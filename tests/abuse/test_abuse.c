/* SPDX-License-Identifier: BSD-3-Clause */
/* Set-ups of extreme values. Each must end in a given status, with a given text if it is refused,
 * and within physical bounds: finite fields, no fluid particle lost without notice, and no fluid
 * faster than a multiple of the speed of the set-up. */
#include "setups.h"

static mps_sim *created; /* destroyed after each test, also a failed one */
static char creation[300];

static int clean(void **state)
{
    (void)state;
    mps_sim_destroy(created);
    created = NULL;
    return 0;
}

/* ---- building -------------------------------------------------------------------------------- */

static mps_status create(const setup *s)
{
    mps_config config;
    creation[0] = '\0';
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = s->dim ? s->dim : 2;
    config.dp = s->dp ? s->dp : 0.05;
    for (int d = 0; d < 3; d++) config.gravity[d] = s->g[d];
    config.re_near = s->re_near;
    config.re_far = s->re_far;
    config.threads = s->threads;
    config.error = creation;
    config.error_size = sizeof creation;
    return mps_sim_create(&config, &created);
}

static mps_status set_phases(const setup *s, mps_sim *sim)
{
    mps_phase p;
    assert_int_equal(mps_phase_init(&p, sizeof p), MPS_OK);
    if (s->density) p.density = s->density;
    if (s->viscosity) p.viscosity = s->viscosity > 0 ? s->viscosity : 0; /* -1: none */
    mps_status status = mps_phase_set(sim, 0, &p);
    if (status || !s->gas) return status;
    p.density = s->gas;
    p.viscosity = 1.8e-5;
    return mps_phase_set(sim, 1, &p);
}

static mps_status build_tank(const setup *s, mps_sim *sim, double dp)
{
    mps_tank tank;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    for (int d = 0; d < 3; d++) tank.size[d] = dp * (s->size[d] ? s->size[d] : 8);
    tank.open_top = s->open_top;
    return mps_tank_add(sim, &tank, NULL);
}

static mps_status fill(const setup *s, mps_sim *sim, double dp)
{
    const double lo[3] = {0, 0, 0};
    double hi[3];
    for (int d = 0; d < 3; d++) hi[d] = dp * (s->size[d] ? s->size[d] : 8);
    const double top[3] = {hi[0], hi[1], hi[2]};
    hi[1] = dp * (s->depth ? s->depth : 4);
    if (s->depth < 0) return MPS_OK;
    mps_status status = mps_fill_box_add(sim, 0, lo, hi, NULL, NULL);
    return status || !s->gas ? status : mps_fill_box_add(sim, 1, lo, top, NULL, NULL);
}

static void push_fluid(mps_sim *sim, double velocity)
{
    mps_lease u = {.struct_size = sizeof u};
    const int32_t *kinds;
    assert_int_equal(tags_peek(sim, NULL, &kinds, NULL, NULL), MPS_OK);
    assert_int_equal(mps_lease_begin(sim, "velocity", MPS_WRITE, &u), MPS_OK);
    for (int64_t i = 0; i < u.count; i++)
        if (kinds[i] == MPS_FLUID) u.data[i * u.stride] = velocity;
    assert_int_equal(mps_lease_end(sim, &u), MPS_OK);
}

static mps_status build(const setup *s)
{
    mps_status status = create(s);
    if (status) return status;
    double dp;
    assert_int_equal(mps_sim_shape(created, NULL, &dp), MPS_OK);
    if (s->preset) status = mps_preset_use(created, s->preset);
    if (status == MPS_OK) status = set_phases(s, created);
    if (status == MPS_OK) status = build_tank(s, created, dp);
    if (status == MPS_OK) status = fill(s, created, dp);
    if (status == MPS_OK && s->dt) {
        mps_time_control control;
        assert_int_equal(mps_time_control_init(&control, sizeof control), MPS_OK);
        control.dt = s->dt;
        status = mps_time_control_set(created, &control);
    }
    if (status == MPS_OK && s->velocity) push_fluid(created, s->velocity);
    if (status == MPS_OK && s->before) s->before(created);
    return status;
}

/* ---- checks ---------------------------------------------------------------------------------- */

static void check_finite(mps_sim *sim)
{
    static const char *const fields[] = {"position", "velocity", "pressure", "number_density",
                                         "density"};
    for (size_t f = 0; f < sizeof fields / sizeof fields[0]; f++) {
        mps_lease lease = {.struct_size = sizeof lease};
        assert_int_equal(mps_lease_begin(sim, fields[f], MPS_READ, &lease), MPS_OK);
        for (int64_t i = 0; i < lease.count * lease.stride; i++)
            if (!isfinite(lease.data[i]))
                fail_msg("%s: number %lld is %g", fields[f], (long long)i, lease.data[i]);
        assert_int_equal(mps_lease_end(sim, &lease), MPS_OK);
    }
}

/* A fall through the tank, or what the fluid began with. */
static double speed_of(const setup *s)
{
    const double dp = s->dp ? s->dp : 0.05,
                 g = sqrt(s->g[0] * s->g[0] + s->g[1] * s->g[1] + s->g[2] * s->g[2]);
    return fmax(fabs(s->velocity),
                sqrt(2 * (g > 0 ? g : 9.81) * dp * (s->size[1] ? s->size[1] : 8)));
}

static void run_setup(void **state)
{
    const setup *s = *state;
    mps_step_info info;
    double fastest = 0;
    mps_status status = build(s);
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    for (int k = 0; k < (s->steps ? s->steps : 40) && status >= 0; k++) {
        status = mps_step(created, 1e9, &info);
        fastest = fmax(fastest, info.max_speed);
        if (s->between && status >= 0) s->between(created, k);
    }
    const char *text = created ? mps_sim_error(created) : creation;
    if ((status < 0 || s->status < 0) && status != s->status)
        fail_msg("%s instead of %s after %lld steps: %s", mps_status_name(status),
                 mps_status_name(s->status), (long long)info.step, text);
    if (s->text && !strstr(text, s->text)) fail_msg("\"%s\" does not say \"%s\"", text, s->text);
    if (created) check_finite(created);
    const double most = (s->speed ? s->speed : 3) * speed_of(s);
    if (!(fastest <= most)) fail_msg("fluid at %g m/s: at most %g m/s", fastest, most);
}

/* The same bytes with 1 to 8 threads. */
static void threads_agree(void **state)
{
    static double one[20000];
    const setup s = {
        .dim = 3, .dp = 0.05, .g = DOWN, .size = {10, 8, 8}, .steps = 6, .before = violent};
    (void)state;
    for (int32_t threads = 1; threads <= 8; threads++) {
        setup with = s;
        mps_lease x = {.struct_size = sizeof x};
        with.threads = threads;
        assert_int_equal(build(&with), MPS_OK);
        for (int k = 0; k < s.steps; k++) assert_true(mps_step(created, 1, NULL) >= 0);
        assert_int_equal(mps_lease_begin(created, "position", MPS_READ, &x), MPS_OK);
        assert_true(x.count * x.stride <= 20000);
        if (threads == 1)
            memcpy(one, x.data, (size_t)(x.count * x.stride) * sizeof *one);
        else
            assert_memory_equal(one, x.data, (size_t)(x.count * x.stride) * sizeof *one);
        clean(NULL);
    }
}

int main(void)
{
    struct CMUnitTest tests[SETUPS + 1] = {cmocka_unit_test_teardown(threads_agree, clean)};
    for (int k = 0; k < SETUPS; k++)
        tests[k + 1] = (struct CMUnitTest){setups[k].name, run_setup, NULL, clean,
                                           (void *)&setups[k]};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
