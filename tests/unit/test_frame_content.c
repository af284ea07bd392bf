/* SPDX-License-Identifier: BSD-3-Clause */
/* Contents of a frame, read with a small parser of the format. */
#include "frame_fixture.h"

static void frames_read_back(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int32_t kinds = 0; kinds < 8; kinds++) {
            mps_sim *sim = prepared(dim);
            mps_frames *frames;
            ASSERT_OK(sim, mps_frames_open(sim, folder, "run", kinds, &frames));
            ASSERT_OK(sim, mps_frames_write(frames));
            check_frame(sim, "run/run_000000.vtp",
                        kinds ? kinds : MPS_FRAMES_FLUID | MPS_FRAMES_WALL);
            mps_frames_close(frames);
            mps_sim_destroy(sim);
        }
}

/* The names of the parts, as codes of their characters. */
static void frames_name_parts(void **state)
{
    (void)state;
    mps_sim *sim = prepared(2);
    mps_frames *frames;
    size_t size;
    ASSERT_OK(sim, mps_frames_open(sim, folder, "parts", 0, &frames));
    ASSERT_OK(sim, mps_frames_write(frames));
    char *text = slurp("parts/parts_000000.vtp", &size);
    const char *at = strstr(text, "<DataArray type=\"String\" Name=\"part_names\" "
                                  "NumberOfTuples=\"4\" format=\"ascii\">");
    assert_non_null(at);
    at = strchr(at, '>') + 1;
    for (int32_t k = 0; k < 4; k++) {
        const char *name = sim->world.particles.part_name[k];
        for (size_t c = 0; c <= strlen(name); c++) {
            char *end;
            assert_int_equal(strtol(at, &end, 10), name[c]);
            at = end;
        }
    }
    assert_true(strncmp(at, " </DataArray>", 13) == 0);
    free(text);
    mps_frames_close(frames);
    mps_sim_destroy(sim);
}

static int swing(void *user, double t, mps_motion_state *s)
{
    (void)user, (void)t;
    for (int k = 0; k < 6; k++) {
        const int used = k == MPS_MOVE_X || k == MPS_MOVE_Y || k == MPS_ROTATE_Z;
        s->value[k] = used ? 0.3 + 0.1 * k : 0;
        s->rate[k] = used ? 2 + k : 0;
    }
    return 0;
}

/* In the frame of the tank the walls have their built positions and are at rest; so is the
 * fluid. */
static void frame_of_the_tank(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = prepared(dim);
        const mps__particles *s = &sim->world.particles;
        const mps__motion *m = &sim->world.motion;
        mps_frames *frames;
        size_t size;
        ASSERT_OK(sim, mps_motion_callback_set(sim, swing, NULL));
        mps_lease u = {.struct_size = sizeof u};
        ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
        for (int64_t i = 0; i < s->n;
             i++) { /* all rotate with the tank, fluid 1 m/s faster along X */
            double X[3], fast[3] = {s->kind[i] == MPS_FLUID, 0, 0}, more[3];
            mps__motion_to_tank(m, &m->now, s->x + i * dim, X);
            mps__motion_point(m, &m->now, X, NULL, u.data + i * dim, NULL);
            mps__motion_rotate(m, &m->now, fast, more);
            for (int d = 0; d < dim; d++) u.data[i * dim + d] += more[d];
        }
        ASSERT_OK(sim, mps_lease_end(sim, &u));
        ASSERT_OK(sim, mps_frames_open(sim, folder, "own", MPS_FRAMES_TANK, &frames));
        ASSERT_OK(sim, mps_frames_write(frames));
        char *text = slurp("own/own_000000.vtp", &size);
        const uint64_t n = (uint64_t)(mps_particles_count(sim, MPS_FLUID) +
                                      mps_particles_count(sim, MPS_WALL));
        const char *x = find_array(text, size, "position", "Float32", 3, n * 12),
                   *v = find_array(text, size, "velocity", "Float32", 3, n * 12);
        int64_t k = 0;
        for (int64_t i = 0; i < s->n; i++) {
            float got[2][3];
            if (s->kind[i] == MPS_DUMMY) continue;
            memcpy(got[0], x + 12 * k, 12);
            memcpy(got[1], v + 12 * k++, 12);
            for (int d = 0; d < 3; d++) {
                ASSERT_NEAR(got[1][d], s->kind[i] == MPS_FLUID && d == 0, 1e-5);
                if (s->kind[i] == MPS_WALL)
                    ASSERT_NEAR(got[0][d], d < dim ? s->ref[i * dim + d] : 0, 1e-6);
                else /* the lattice of the tank, with spacing 0.1 */
                    ASSERT_NEAR(got[0][d], 0.1 * round(got[0][d] / 0.1), 1e-6);
            }
        }
        free(text);
        mps_frames_close(frames);
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_read_back),
        cmocka_unit_test(frames_name_parts),
        cmocka_unit_test(frame_of_the_tank),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
