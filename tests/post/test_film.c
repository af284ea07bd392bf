/* SPDX-License-Identifier: BSD-3-Clause */
/* Post-processing of the folder of a run: pictures of frames, films, the state for ParaView. */
#include "picture_fixture.h"

static const char folder[] = "test_film_run";

static mps_film_config film_config(char *error, size_t size)
{
    mps_film_config config;
    assert_int_equal(mps_film_config_init(&config, sizeof config), MPS_OK);
    config.error = error;
    config.error_size = size;
    return config;
}

static int run_quietly(const char *command)
{
    char whole[600];
    snprintf(whole, sizeof whole, "%s >/dev/null 2>&1 </dev/null", command);
    return system(whole);
}

static void need_ffmpeg(void)
{
    if (run_quietly("command -v ffmpeg") != 0) skip();
}

/* The picture of a frame is bitwise that of the written state, also in a tank that moves and
 * rotates. */
static void frame_is_state(void **state)
{
    (void)state;
    const mps_harmonic moves[2] = {{.dof = MPS_MOVE_X, .amplitude = 0.1, .omega = 6},
                                   {.dof = MPS_ROTATE_Z, .amplitude = 0.3, .omega = 5}};
    char error[300];
    long size[2];
    for (int moving = 0; moving < 2; moving++) {
        mps_sim *sim = wet_tank(2);
        mps_picture_config config = new_config(error, sizeof error);
        config.pressure_hi = 2500;
        config.title = "Tank";
        add_sensor(sim, MPS_PROBE_WALL_PRESSURE, "P1", 0, 0.4, 0);
        if (moving) ASSERT_OK(sim, mps_motion_harmonics_set(sim, 2, moves));
        write_folder(folder, sim, 3, "");
        assert_int_equal(mps_picture_save(sim, &config, "test_film_state.png"), MPS_OK);
        assert_int_equal(mps_picture_frame_save(folder, -1, &config, "test_film_frame.png"),
                         MPS_OK);
        if (!moving) { /* moved, a rounding of a frame's single precision may be seen in a pixel */
            char *a = read_whole("test_film_state.png", &size[0]),
                 *b = read_whole("test_film_frame.png", &size[1]);
            assert_int_equal(size[0], size[1]);
            assert_memory_equal(a, b, (size_t)size[0]);
            free(a);
            free(b);
        }
        const sheet a = read_sheet("test_film_state.png"), b = read_sheet("test_film_frame.png");
        int others = 0;
        for (int k = 0; k < a.width * a.height; k++)
            for (int c = 0; c < 24; c += 8)
                others += abs((int)(a.pixel[k] >> c & 255) - (int)(b.pixel[k] >> c & 255)) > 2;
        assert_int_equal(others, 0);
        free(a.pixel);
        free(b.pixel);
        mps_sim_destroy(sim);
    }
    remove("test_film_state.png");
    remove("test_film_frame.png");
    remove_folder(folder);
}

/* Scale, title and gravity are those of the folder if the config has none. */
static void folder_completes(void **state)
{
    (void)state;
    char error[300];
    mps_sim *sim = wet_tank(2);
    mps_picture_config config = new_config(error, sizeof error);
    write_folder(folder, sim, 2, "\"pressure_scale\": [-100, 4400],");
    assert_int_equal(mps_picture_frame_save(folder, 0, &config, "test_film_frame.png"), MPS_OK);
    assert_true(config.pressure_lo == -100 && config.pressure_hi == 4400);
    config.pressure_lo = 0;
    assert_int_equal(mps_picture_frame_save(folder, 1, &config, "test_film_frame.png"), MPS_OK);
    assert_true(config.pressure_lo == 0 && config.pressure_hi == 4400);
    assert_int_equal(mps_picture_frame_save(folder, 2, &config, "x.png"), MPS_E_ARG);
    assert_non_null(strstr(error, "frame 2"));
    assert_int_equal(mps_picture_frame_save(folder, -2, &config, "x.png"), MPS_E_ARG);
    assert_int_equal(mps_picture_frame_save(NULL, 0, &config, "x.png"), MPS_E_ARG);
    assert_int_equal(mps_picture_frame_save("no_such_run", 0, &config, "x.png"), MPS_E_IO);
    assert_non_null(strstr(error, "no_such_run"));
    assert_int_equal(truncate("test_film_run/frames/frames_000001.vtp", 3000), 0);
    assert_int_equal(mps_picture_frame_save(folder, 1, &config, "x.png"), MPS_E_IO);
    assert_non_null(strstr(error, "frames_000001"));
    assert_false(exists("x.png"));
    mps_sim_destroy(sim);
    remove("test_film_frame.png");
    remove_folder(folder);
}

/* As many pictures as frames, and what they show. */
static void film_has_all_frames(void **state)
{
    (void)state;
    need_ffmpeg();
    char error[500];
    long size;
    mps_sim *sim = wet_tank(2);
    mps_film_config config = film_config(error, sizeof error);
    mps_picture_config still = new_config(error, sizeof error);
    config.width = 641; /* players need even numbers */
    still.width = 641;
    write_folder(folder, sim, 4, "");
    const mps_status status = mps_film_save(folder, &config, NULL);
    if (status != MPS_OK) fail_msg("%s", error);
    assert_false(exists("test_film_run/film.mp4.tmp"));
    assert_int_equal(run_quietly("ffmpeg -y -i test_film_run/film.mp4 -f rawvideo -pix_fmt rgb24 "
                                 "test_film_run/all.rgb"),
                     0);
    assert_int_equal(mps_picture_frame_save(folder, 3, &still, "test_film_run/still.png"), MPS_OK);
    char *rgb = read_whole("test_film_run/all.rgb", &size);
    const sheet s = read_sheet("test_film_run/still.png");
    assert_int_equal(size, 4L * 3 * s.width * s.height);
    const unsigned char *last = (const unsigned char *)rgb + 3L * 3 * s.width * s.height;
    double sum = 0;
    for (int k = 0; k < s.width * s.height; k++)
        for (int c = 0; c < 3; c++)
            sum += fabs((double)last[3 * k + c] - (double)(s.pixel[k] >> (16 - 8 * c) & 255));
    assert_true(sum / (3.0 * s.width * s.height) < 6); /* of 255; the codec has losses */
    free(rgb);
    free(s.pixel);
    mps_sim_destroy(sim);
    remove_folder(folder);
}

static void assert_no_film(const mps_film_config *config, const char *path, mps_status wanted,
                           const char *word)
{
    assert_int_equal(mps_film_save(folder, config, path), wanted);
    if (!strstr(config->error, word)) fail_msg("'%s' does not mention '%s'", config->error, word);
    assert_false(exists("test_film_run/film.mp4"));
    assert_false(exists("test_film_run/film.mp4.tmp"));
}

/* The program is missing, fails, or stops reading: a text, no file, and no signal for the
 * application. */
static void programs_that_fail(void **state)
{
    (void)state;
    char error[500];
    mps_sim *sim = wet_tank(2);
    mps_film_config config = film_config(error, sizeof error);
    write_folder(folder, sim, 3, "");
    config.program = "no_such_ffmpeg";
    assert_no_film(&config, NULL, MPS_E_IO, "please install");
    config.program = "false";
    assert_no_film(&config, NULL, MPS_E_IO, "'false' failed with exit code 1");
    config.program = "true";
    assert_no_film(&config, NULL, MPS_E_IO, "'true' stopped before the end");
    write_text(folder, "talks",
               "#!/bin/sh\nhead -c 1000 >/dev/null\necho one >&2\necho two >&2\nexit 3\n");
    assert_int_equal(chmod("test_film_run/talks", 0755), 0);
    config.program = "test_film_run/talks";
    assert_no_film(&config, NULL, MPS_E_IO, "failed: one two");
    write_text(folder, "killed", "#!/bin/sh\nkill -9 $$\n");
    assert_int_equal(chmod("test_film_run/killed", 0755), 0);
    config.program = "test_film_run/killed";
    assert_no_film(&config, NULL, MPS_E_IO, "signal 9");
    write_text(folder, "takes", "#!/bin/sh\ncat >/dev/null\n");
    assert_int_equal(chmod("test_film_run/takes", 0755), 0);
    config.program = "test_film_run/takes"; /* is content, but writes no film */
    assert_no_film(&config, NULL, MPS_E_IO, "film.mp4");
    config = film_config(error, sizeof error);
    if (run_quietly("command -v ffmpeg") == 0)
        assert_no_film(&config, "no/such/folder.mp4", MPS_E_IO, "no/such/folder");
    mps_sim_destroy(sim);
    remove_folder(folder);
}

static void refusals(void **state)
{
    (void)state;
    char error[300];
    mps_sim *sim = wet_tank(2);
    mps_film_config config = film_config(error, sizeof error), bare = {0};
    assert_int_equal(mps_film_config_init(NULL, sizeof config), MPS_E_ARG);
    assert_int_equal(mps_film_config_init(&config, 8), MPS_E_VERSION);
    assert_int_equal(mps_film_save(folder, &bare, NULL), MPS_E_ARG);
    assert_int_equal(mps_film_save(NULL, &config, NULL), MPS_E_ARG);
    assert_int_equal(mps_film_save("", NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_film_save("no_such_run", NULL, NULL), MPS_E_IO);
    write_folder(folder, sim, 1, "");
    config.width = 4001;
    assert_no_film(&config, NULL, MPS_E_ARG, "width");
    config = film_config(error, sizeof error);
    config.rate = 0.5;
    assert_no_film(&config, NULL, MPS_E_ARG, "rate");
    config = film_config(error, sizeof error);
    config.program = "";
    assert_no_film(&config, NULL, MPS_E_ARG, "program");
    config = film_config(error, sizeof error);
    assert_int_equal(remove("test_film_run/frames.pvd"), 0);
    assert_no_film(&config, NULL, MPS_E_ARG, "no frame");
    assert_int_equal(mps_paraview_save(folder, error, sizeof error), MPS_E_ARG);
    assert_int_equal(mps_paraview_save(NULL, error, sizeof error), MPS_E_ARG);
    assert_int_equal(mps_paraview_save("no_such_run", NULL, 0), MPS_E_IO);
    mps_sim_destroy(sim);
    remove_folder(folder);
}

/* Python understands it, and it has the scale of the folder and an absolute path to it. */
static void paraview_state(void **state)
{
    (void)state;
    char error[300];
    long size;
    mps_sim *sim = wet_tank(2);
    write_folder(folder, sim, 2, "\"pressure_scale\": [0, 4400],");
    assert_int_equal(mps_paraview_save(folder, error, sizeof error), MPS_OK);
    char *text = read_whole("test_film_run/paraview.py", &size);
    assert_non_null(strstr(text, "scale = [0, 4400]"));
    assert_non_null(strstr(text, "written_to = '/"));
    assert_non_null(strstr(text, "test_film_run'"));
    assert_non_null(strstr(text, "flat = True"));
    free(text);
    if (run_quietly("command -v python3") == 0)
        assert_int_equal(run_quietly("python3 -m py_compile test_film_run/paraview.py"), 0);
    remove("test_film_run/paraview.py");
    assert_int_equal(mkdir("test_film_run/paraview.py", 0777), 0);
    assert_int_equal(mps_paraview_save(folder, error, sizeof error), MPS_E_IO);
    assert_non_null(strstr(error, "paraview.py"));
    mps_sim_destroy(sim);
    remove_folder(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frame_is_state),
        cmocka_unit_test(folder_completes),
        cmocka_unit_test(film_has_all_frames),
        cmocka_unit_test(programs_that_fail),
        cmocka_unit_test(refusals),
        cmocka_unit_test(paraview_state),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
