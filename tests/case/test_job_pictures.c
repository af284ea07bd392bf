/* SPDX-License-Identifier: BSD-3-Clause */
/* Pictures of a job: one colour scale that depends on the case only, so that an interrupted run has
 * the pictures of an uninterrupted one. */
#include "job_fixture.h"
#include "../post/picture_fixture.h"

enum { SPLASH = 1 << 20 };

/* A quantity that stops its job at a time. */
typedef struct stopper {
    mps_job *job;
    double at;
} stopper;

static double stop_at(void *user, mps_sim *sim)
{
    const stopper *s = user;
    double t = 0;
    mps_sim_time(sim, &t, NULL);
    if (t >= s->at) mps_job_stop(s->job);
    return t;
}

/* A column of water that falls: its pressures change with the time. */
static int32_t run_to(const char *folder, double stop, bool resume)
{
    const double lo[2] = {0}, hi[2] = {0.16, 0.36};
    mps_job_config c = config_of(folder);
    c.resume = resume;
    c.t_end = 0.2;
    mps_job *job = job_of(&c);
    mps_sim *sim = new_sim(2, 0.04);
    add_tank(sim, 0.4, 0.4, 0);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    stopper s = {job, stop};
    assert_int_equal(mps_job_value_add(job, "now", "s", "Time", 0, stop_at, &s), MPS_OK);
    const int32_t code = mps_job_run(job, sim);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    return code;
}

static size_t bytes_of(const char *folder, const char *name, unsigned char *out)
{
    char path[300];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *in = fopen(path, "rb");
    const size_t size = in ? fread(out, 1, SPLASH, in) : 0;
    if (in) fclose(in);
    return size;
}

static void stops_change_no_picture(void **state)
{
    (void)state;
    static const char *const names[] = {"picture_1.png", "picture_2.png", "picture_3.png",
                                        "picture_end.png"};
    static unsigned char whole[SPLASH], parts[SPLASH];
    assert_int_equal(run_to("whole", 1, false), MPS_EXIT_OK);
    assert_int_equal(run_to("parts", 0.01, false), MPS_EXIT_INTERRUPTED);
    const size_t early = bytes_of("parts", "picture_end.png", parts);
    assert_int_equal(run_to("parts", 0.12, true), MPS_EXIT_INTERRUPTED);
    assert_int_equal(run_to("parts", 1, true), MPS_EXIT_OK);
    for (int k = 0; k < 4; k++) {
        const size_t size = bytes_of("whole", names[k], whole);
        assert_true(size > 1000 && early > 1000);
        assert_int_equal(bytes_of("parts", names[k], parts), size);
        assert_memory_equal(whole, parts, size);
    }
    assert_non_null(strstr(text_of("whole", "summary.json"), "\"pressure_scale\": [0, 4500]"));
}

/* Pressures of a case, and the upper end of the scale. */
typedef struct colours {
    double gravity, speed, sigma, most;
} colours;

static void check_scale(const char *folder, const colours *c)
{
    const double lo[2] = {0.1, 0.1}, hi[2] = {0.26, 0.3};
    mps_lease u = {.struct_size = sizeof u};
    char wanted[64];
    mps_config config;
    mps_sim *sim = NULL;
    mps_job_config job_config = config_of(folder);
    job_config.gravity = c->gravity;
    job_config.t_end = 1e-4;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dp = 0.04;
    config.gravity[1] = -c->gravity;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    if (c->sigma > 0) {
        mps_phase air;
        ASSERT_OK(sim, mps_phase_init(&air, sizeof air));
        air.density = 1.2;
        ASSERT_OK(sim, mps_phase_set(sim, 1, &air));
        ASSERT_OK(sim, mps_preset_use(sim, "mmps"));
        ASSERT_OK(sim, mps_model_set(sim, "tension", "sigma", c->sigma));
        ASSERT_OK(sim, mps_model_remove(sim, "gas"));
        if (c->gravity == 0) ASSERT_OK(sim, mps_model_remove(sim, "reference"));
    }
    add_tank(sim, 0.4, 0.4, 0);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    for (int64_t i = 0; i < u.count; i++) u.data[i * u.stride] = c->speed;
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    mps_job *job = job_of(&job_config);
    if (mps_job_run(job, sim) != MPS_EXIT_OK)
        fail_msg("gravity %g, sigma %g: %s", c->gravity, c->sigma, said);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    snprintf(wanted, sizeof wanted, "\"pressure_scale\": [0, %.9g]", c->most);
    const char *found = strstr(text_of(folder, "summary.json"), "\"pressure_scale\"");
    if (!found || strncmp(found, wanted, strlen(wanted)) != 0)
        fail_msg("gravity %g, speed %g, sigma %g: %.40s, not %s", c->gravity, c->speed, c->sigma,
                 found ? found : "nothing", wanted);
}

/* A block of 0.16 x 0.2 m: 1.25 rho g h = 2452.5 Pa; rho u^2; rho 9.81 h = 1962 Pa; 1.25 times
 * sigma over half of its width. */
static void scale_follows_from_the_case(void **state)
{
    (void)state;
    static const colours c[] = {
        {9.81, 0, 0, 2500}, {9.81, 1, 0, 3500}, {0, 3, 0, 9000}, {0, 0, 0, 2000}, {0, 0, 16, 250}};
    char folder[16];
    for (size_t k = 0; k < sizeof c / sizeof *c; k++) {
        snprintf(folder, sizeof folder, "scale%d", (int)k);
        check_scale(folder, &c[k]);
    }
}

/* A number of summary.json. */
static double summary_number(const char *folder, const char *key)
{
    char text[64];
    snprintf(text, sizeof text, "\"%s\": ", key);
    const char *found = strstr(text_of(folder, "summary.json"), text);
    if (!found) fail_msg("summary.json has no '%s'", key);
    return strtod(found + strlen(text), NULL);
}

/* Pixels that differ by more than rounding of single precision, which may shift the bar on the
 * right by one. */
static int count_others(const char *first, const char *second)
{
    const sheet a = read_sheet(first), b = read_sheet(second);
    int others = 0;
    assert_true(a.width == b.width && a.height == b.height);
    for (int k = 0; k < a.width * a.height; k++)
        for (int c = 0; c < 24 && k % a.width < a.width * 7 / 8; c += 8)
            others += abs((int)(a.pixel[k] >> c & 255) - (int)(b.pixel[k] >> c & 255)) > 2;
    free(a.pixel);
    free(b.pixel);
    return others;
}

/* An initially displaced and rotated tank: positions, boxes and pictures are in its own frame, for
 * pictures of the state and of a frame. */
static void displaced_tanks_keep_their_marks(void **state)
{
    (void)state;
    const double lo[2] = {0}, hi[2] = {0.4, 0.2}, quarter = acos(0.0);
    const mps_harmonic moves[2] = {
        {.dof = MPS_MOVE_X, .amplitude = 0.3, .omega = 2, .phase = quarter},
        {.dof = MPS_ROTATE_Z, .amplitude = 0.2, .omega = 3, .phase = quarter}};
    char error[300], path[] = "displaced/again.png";
    mps_job_config c = config_of("displaced");
    mps_picture_config picture;
    mps_probe probe;
    c.frames = 2;
    c.report = 1;
    mps_job *job = job_of(&c);
    mps_sim *sim = new_sim(2, 0.04);
    add_tank(sim, 0.4, 0.4, 0);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
    probe.type = MPS_PROBE_WALL_PRESSURE;
    probe.at[1] = 0.12;
    assert_int_equal(mps_job_probe_add(job, sim, &probe, 0, 0, "P1", NULL), MPS_OK);
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 2, moves));
    assert_int_equal(mps_job_run(job, sim), MPS_EXIT_OK);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    ASSERT_NEAR(summary_number("displaced", "tank_lo_x"), 0, 1e-12);
    ASSERT_NEAR(summary_number("displaced", "tank_lo_y"), 0, 1e-12);
    ASSERT_NEAR(summary_number("displaced", "tank_size_x"), 0.4, 1e-12);
    ASSERT_NEAR(summary_number("displaced", "tank_size_y"), 0.4, 1e-12);
    ASSERT_NEAR(summary_number("displaced", "liquid_depth"), 0.2, 0.021);
    assert_int_equal(mps_picture_config_init(&picture, sizeof picture), MPS_OK);
    picture.error = error;
    picture.error_size = sizeof error;
    if (mps_picture_frame_save("displaced", -1, &picture, path) != MPS_OK) fail_msg("%s", error);
    assert_int_equal(count_others("displaced/picture_end.png", path), 0);
    /* the film of the page has the poses */
    const char *poses = strstr(text_of("displaced", "report.html"), "\"poses\": [");
    double turn, x;
    assert_non_null(poses);
    assert_int_equal(
        sscanf(poses, "\"poses\": [ [%lf, %*f, %*f, %*f, %*f, %*f, %*f, %*f, %*f, %lf", &turn, &x),
        2);
    ASSERT_NEAR(turn, cos(0.2), 1e-5);
    ASSERT_NEAR(x, 0.3, 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(stops_change_no_picture),
                                       cmocka_unit_test(displaced_tanks_keep_their_marks),
                                       cmocka_unit_test(scale_follows_from_the_case)};
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}
