/* SPDX-License-Identifier: BSD-3-Clause */
/* Series of frames: valid after every frame, continued; other files in the folder remain. */
#include "frame_fixture.h"
#include <sys/stat.h>
#include "locale_kit.h"

static void series_names_all_frames(void **state)
{
    (void)state;
    mps_sim *sim = prepared(2);
    mps_frames *frames;
    size_t size;
    ASSERT_OK(sim, mps_frames_open(sim, folder, "series", 0, &frames));
    for (int k = 0; k < 12; k++) {
        char name[64], wanted[128];
        char *text = slurp("series.pvd", &size);
        snprintf(wanted, sizeof wanted, "series_%06d.vtp", k);
        assert_null(strstr(text, wanted));
        free(text);
        sim->world.state.t = 0.1 * k;
        ASSERT_OK(sim, mps_frames_write(frames));
        text = slurp("series.pvd", &size);
        snprintf(wanted, sizeof wanted,
                 "<DataSet timestep=\"%.17g\" part=\"0\" file=\"series/series_%06d.vtp\"/>",
                 0.1 * k, k);
        assert_non_null(strstr(text, wanted));
        assert_string_equal(text + size - strlen("</Collection>\n</VTKFile>\n"),
                            "</Collection>\n</VTKFile>\n");
        free(text);
        snprintf(name, sizeof name, "series/series_%06d.vtp", k);
        text = slurp(name, &size);
        snprintf(wanted, sizeof wanted, "format=\"ascii\">%.17g</DataArray>", 0.1 * k);
        assert_non_null(strstr(text, wanted));
        free(text);
    }
    mps_frames_close(frames);
    mps_sim_destroy(sim);
}

static void touch(const char *name)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fclose(f);
}

static bool there(const char *name)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return access(path, F_OK) == 0;
}

/* A shorter series in the folder of a longer one removes all old frames, and no other file. */
static void old_frames_go(void **state)
{
    (void)state;
    static const char *const kept[] = {"again/again_notes.txt",     "again/again_00000.vtp",
                                       "again/again_000001.vtp.gz", "again/other_000001.vtp",
                                       "again/again_00000x.vtp",    "again/again_1_000001.vtp",
                                       "again/again-000001.vtp.tmp"};
    mps_sim *sim = prepared(2);
    mps_frames *frames;
    ASSERT_OK(sim, mps_frames_open(sim, folder, "again", 0, &frames));
    for (int k = 0; k < 3; k++) ASSERT_OK(sim, mps_frames_write(frames));
    mps_frames_close(frames);
    for (size_t k = 0; k < sizeof kept / sizeof *kept; k++) touch(kept[k]);
    touch("again/again_1000000.vtp");
    ASSERT_OK(sim, mps_frames_open(sim, folder, "again", 0, &frames));
    ASSERT_OK(sim, mps_frames_write(frames));
    mps_frames_close(frames);
    assert_true(there("again/again_000000.vtp"));
    assert_false(there("again/again_000001.vtp"));
    assert_false(there("again/again_000002.vtp"));
    assert_false(there("again/again_1000000.vtp"));
    for (size_t k = 0; k < sizeof kept / sizeof *kept; k++) assert_true(there(kept[k]));
    mps_sim_destroy(sim);
}

/* A series of four frames at 0, 0.1, 0.2, 0.3 s, together with other files. */
static mps_sim *four_frames(const char *name)
{
    char other[64];
    mps_sim *sim = prepared(2);
    mps_frames *frames;
    ASSERT_OK(sim, mps_frames_open(sim, folder, name, 0, &frames));
    for (int k = 0; k < 4; k++) {
        sim->world.state.t = 0.1 * k;
        ASSERT_OK(sim, mps_frames_write(frames));
    }
    mps_frames_close(frames);
    snprintf(other, sizeof other, "%s/notes.vtp", name);
    touch(other);
    return sim;
}

/* The .pvd lists frames at exactly these times, they exist, and the next one does not. */
static void check_series(const char *name, int count, const double *t)
{
    char file[64], wanted[4096] = "<Collection>\n";
    size_t size;
    for (int k = 0; k < count; k++) {
        size = strlen(wanted);
        snprintf(wanted + size, sizeof wanted - size,
                 "<DataSet timestep=\"%.17g\" part=\"0\" file=\"%s/%s_%06d.vtp\"/>\n", t[k], name,
                 name, k);
        snprintf(file, sizeof file, "%s/%s_%06d.vtp", name, name, k);
        assert_true(there(file));
    }
    snprintf(file, sizeof file, "%s/%s_%06d.vtp", name, name, count);
    assert_false(there(file));
    strcat(wanted, "</Collection>\n");
    snprintf(file, sizeof file, "%s.pvd", name);
    char *text = slurp(file, &size);
    assert_non_null(strstr(text, wanted));
    free(text);
    snprintf(file, sizeof file, "%s/notes.vtp", name);
    assert_true(there(file));
}

static void series_goes_on(void **state)
{
    (void)state;
    mps_frames *frames;
    for (int at = 0; at < 2; at++) { /* between two frames, and, but for rounding, at one */
        mps_sim *sim = four_frames("on");
        sim->world.state.t = at ? 0.2 * (1 - 1e-15) : 0.25;
        ASSERT_OK(sim, mps_frames_open(sim, folder, "on", MPS_FRAMES_CONTINUE | MPS_FRAMES_WALL,
                                       &frames));
        check_series("on", 3, (const double[]){0, 0.1, 0.2});
        sim->world.state.t = 0.26;
        ASSERT_OK(sim, mps_frames_write(frames));
        check_series("on", 4, (const double[]){0, 0.1, 0.2, 0.26});
        check_frame(sim, "on/on_000000.vtp", 3);
        check_frame(sim, "on/on_000003.vtp", MPS_FRAMES_WALL);
        mps_frames_close(frames);
        mps_sim_destroy(sim);
    }
}

static char path_capacity[256];

static int at_even_steps(void *user, double t)
{
    (void)user;
    return (int)(10 * t + 0.5) % 2 == 0;
}

/* Files with the number of the step: frames are removed, also before a checkpoint from which the
 * series continues. */
static void frames_are_removed(void **state)
{
    mps_frames *frames;
    char *text;
    size_t size;
    (void)state;
    mps_sim *sim = prepared(2);
    ASSERT_OK(sim, mps_frames_open(sim, folder, "steps", MPS_FRAMES_STEPS, &frames));
    for (int k = 3; k < 8; k++) {
        sim->world.state.t = 0.1 * k;
        sim->world.state.step = 10 * k;
        ASSERT_OK(sim, mps_frames_write(frames));
    }
    ASSERT_OK(sim, mps_frames_remove(frames, at_even_steps, NULL));
    mps_frames_close(frames);
    text = slurp("steps.pvd", &size);
    assert_non_null(strstr(text, "steps/steps_000040.vtp"));
    assert_null(strstr(text, "steps/steps_000050.vtp"));
    assert_non_null(strstr(text, "steps/steps_000060.vtp"));
    free(text);
    assert_true(there("steps/steps_000040.vtp") && !there("steps/steps_000050.vtp"));
    assert_true(there("steps/steps_000060.vtp") && !there("steps/steps_000070.vtp"));
    sim->world.state.t = 0.5; /* continues from here; a frame was removed later */
    assert_int_equal(
        remove((snprintf(path_capacity, sizeof path_capacity, "%s/steps/steps_000040.vtp", folder),
                path_capacity)),
        0);
    ASSERT_OK(sim, mps_frames_open(sim, folder, "steps", MPS_FRAMES_STEPS | MPS_FRAMES_CONTINUE,
                                   &frames));
    text = slurp("steps.pvd", &size);
    assert_null(strstr(text, "DataSet"));
    free(text);
    assert_false(there("steps/steps_000060.vtp"));
    mps_frames_close(frames);
    ASSERT_OK(sim, mps_frames_open(sim, folder, "plain", 0, &frames));
    assert_int_equal(mps_frames_remove(frames, at_even_steps, NULL), MPS_E_ARG);
    assert_int_equal(mps_frames_remove(NULL, at_even_steps, NULL), MPS_E_ARG);
    mps_frames_close(frames);
    mps_sim_destroy(sim);
}

/* A frame written at the time of the last frame replaces it. */
static void no_time_twice(void **state)
{
    (void)state;
    mps_frames *frames;
    mps_sim *sim = four_frames("twice");
    ASSERT_OK(sim, mps_frames_open(sim, folder, "twice", MPS_FRAMES_CONTINUE | MPS_FRAMES_DUMMY,
                                   &frames));
    for (int k = 0; k < 2; k++) ASSERT_OK(sim, mps_frames_write(frames));
    check_series("twice", 4, (const double[]){0, 0.1, 0.2, 0.1 * 3});
    check_frame(sim, "twice/twice_000003.vtp", MPS_FRAMES_DUMMY);
    check_frame(sim, "twice/twice_000002.vtp", 3);
    sim->world.state.t = 0.4;
    for (int k = 0; k < 2; k++) ASSERT_OK(sim, mps_frames_write(frames));
    check_series("twice", 5, (const double[]){0, 0.1, 0.2, 0.1 * 3, 0.4});
    mps_frames_close(frames);
    mps_sim_destroy(sim);
}

static void nothing_to_go_on_with(void **state)
{
    (void)state;
    mps_frames *frames;
    mps_sim *sim = prepared(2);
    ASSERT_OK(sim, mps_frames_open(sim, folder, "fresh", MPS_FRAMES_CONTINUE, &frames));
    touch("fresh/notes.vtp");
    check_series("fresh", 0, NULL);
    ASSERT_OK(sim, mps_frames_write(frames));
    check_series("fresh", 1, (const double[]){0});
    check_frame(sim, "fresh/fresh_000000.vtp", 3);
    mps_frames_close(frames);
    sim->world.state.t = -1; /* before all frames */
    ASSERT_OK(sim, mps_frames_open(sim, folder, "fresh", MPS_FRAMES_CONTINUE, &frames));
    check_series("fresh", 0, NULL);
    mps_frames_close(frames);
    mps_sim_destroy(sim);
}

static void put(const char *name, const char *text, size_t size)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(text, 1, size, f), size);
    fclose(f);
}

/* A .pvd that is truncated anywhere, or has a changed character, is refused and all frames
 * remain. */
static void foreign_series_stays(void **state)
{
    (void)state;
    mps_frames *frames;
    mps_sim *sim = four_frames("alien");
    size_t size;
    char *text = slurp("alien.pvd", &size);
    sim->world.state.t = 0.15;
    for (size_t k = 0; k < size; k++)
        for (int how = 0; how < 2; how++) {
            const char was = text[k];
            text[k] = '~';
            put("alien.pvd", text, how ? size : k);
            text[k] = was;
            ASSERT_REFUSED(sim, mps_frames_open(sim, folder, "alien", MPS_FRAMES_CONTINUE, &frames),
                           MPS_E_IO, "alien.pvd\": it is not as");
            assert_null(frames);
        }
    put("alien.pvd", text, size + 1); /* something behind it */
    ASSERT_REFUSED(sim, mps_frames_open(sim, folder, "alien", MPS_FRAMES_CONTINUE, &frames),
                   MPS_E_IO, "it is not as");
    put("alien.pvd", text, size);
    check_series("alien", 4, (const double[]){0, 0.1, 0.2, 0.1 * 3});
    ASSERT_OK(sim, mps_frames_open(sim, folder, "alien", MPS_FRAMES_CONTINUE, &frames));
    check_series("alien", 2, (const double[]){0, 0.1});
    mps_frames_close(frames);
    free(text);
    mps_sim_destroy(sim);
}

/* The locale of the application has a decimal comma. */
static void series_goes_on_with_a_comma(void **state)
{
    (void)state;
    locale_begin("de_DE.UTF-8");
    mps_frames *frames;
    mps_sim *sim = four_frames("comma");
    sim->world.state.t = 0.25;
    mps_status status = mps_frames_open(sim, folder, "comma", MPS_FRAMES_CONTINUE, &frames);
    locale_end();
    ASSERT_OK(sim, status);
    check_series("comma", 3, (const double[]){0, 0.1, 0.2});
    mps_frames_close(frames);
    mps_sim_destroy(sim);
}

static void no_particle_of_a_kind(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    mps_frames *frames;
    size_t size;
    ASSERT_OK(sim, mps_frames_open(sim, folder, "empty", MPS_FRAMES_FLUID, &frames));
    ASSERT_OK(sim, mps_frames_write(frames));
    char *text = slurp("empty/empty_000000.vtp", &size);
    assert_non_null(strstr(text, "NumberOfPoints=\"0\" NumberOfVerts=\"0\""));
    find_array(text, size, "position", "Float32", 3, 0);
    find_array(text, size, "offsets", "Int32", 1, 0);
    free(text);
    mps_frames_close(frames);
    mps_sim_destroy(sim);
}

static void refusals(void **state)
{
    (void)state;
    mps_sim *sim = prepared(2);
    mps_frames *frames;
    char path[160];
    ASSERT_REFUSED(sim, mps_frames_open(sim, "/nowhere/at/all", "run", 0, &frames), MPS_E_IO,
                   "/nowhere/at/all/run\": No such file");
    assert_null(frames);
    ASSERT_REFUSED(sim, mps_frames_open(sim, folder, "a/b", 0, &frames), MPS_E_ARG, "a/b");
    ASSERT_REFUSED(sim, mps_frames_open(sim, folder, "", 0, &frames), MPS_E_ARG, "1..47");
    ASSERT_REFUSED(sim, mps_frames_open(sim, folder, "..", 0, &frames), MPS_E_ARG,
                   "begin with a dot");
    ASSERT_REFUSED(sim, mps_frames_open(sim, folder, NULL, 0, &frames), MPS_E_ARG, "name");
    ASSERT_REFUSED(sim, mps_frames_open(sim, "", "run", 0, &frames), MPS_E_ARG, "folder");
    ASSERT_REFUSED(sim, mps_frames_open(sim, NULL, "run", 0, &frames), MPS_E_ARG, "folder");
    ASSERT_REFUSED(sim, mps_frames_open(sim, folder, "run", 128, &frames), MPS_E_ARG,
                   "kinds is 128");
    ASSERT_REFUSED(sim, mps_frames_open(sim, folder, "run", 0, NULL), MPS_E_ARG, "frames is NULL");
    assert_int_equal(mps_frames_open(NULL, folder, "run", 0, &frames), MPS_E_ARG);
    assert_int_equal(mps_frames_write(NULL), MPS_E_ARG);
    mps_frames_close(NULL);
    /* the folder of the frames is removed during a series */
    ASSERT_OK(sim, mps_frames_open(sim, folder, "gone", 0, &frames));
    snprintf(path, sizeof path, "%s/gone", folder);
    assert_int_equal(rmdir(path), 0);
    ASSERT_REFUSED(sim, mps_frames_write(frames), MPS_E_IO, "gone_000000.vtp.tmp\": No such file");
    assert_int_equal(mkdir(path, 0777), 0);
    ASSERT_OK(sim, mps_frames_write(frames));
    check_frame(sim, "gone/gone_000000.vtp", 3);
    mps_frames_close(frames);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(series_names_all_frames), cmocka_unit_test(old_frames_go),
        cmocka_unit_test(frames_are_removed),      cmocka_unit_test(series_goes_on),
        cmocka_unit_test(no_time_twice),           cmocka_unit_test(nothing_to_go_on_with),
        cmocka_unit_test(foreign_series_stays),    cmocka_unit_test(series_goes_on_with_a_comma),
        cmocka_unit_test(no_particle_of_a_kind),   cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
