/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames of many ranks: pieces that together have the particles of one rank, each once; behaviour
 * if a rank cannot write its piece. */
#include "team.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <cmocka.h>

enum { TEXT = 300, MOST_RANKS = 4, FRAMES = 3, IDS = SCENE_MOST, PATH = 256 };

typedef struct run {
    const scene *scene;
    kit_engine_team *team;
    char folder[64];
    int32_t kinds;                         /* of mps_frames_open() */
    int frames;                            /* 0: FRAMES */
    bool blocked;                          /* rank 1 cannot write its piece of the second frame */
    mps_status status[MOST_RANKS][FRAMES]; /* of the frames */
    mps_status wrong[MOST_RANKS];          /* of a frame of collected particles */
    char error[MOST_RANKS][TEXT];
} run;

static void note(run *k, mps_sim *sim, int32_t rank, mps_status status)
{
    if (status < 0) snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
}

/* Before the first step, after it, and after particles were removed and added. */
static const int frame_step[FRAMES] = {0, 1, 13};

static void write_frames(run *k, mps_sim *sim, int32_t rank, mps_frames *frames)
{
    char path[PATH];
    mps_status status = MPS_OK;
    const int frame_count = k->frames > 0 ? k->frames : FRAMES;
    for (int s = 0, frame = 0; frame < frame_count && status >= 0; s++) {
        status = scene_change(sim, k->scene, s);
        if (s == frame_step[frame] && status >= 0) {
            snprintf(path, sizeof path, "%s/f/f_000001_0001.vtp", k->folder);
            if (k->blocked && rank == 1 && frame == 1) mkdir(path, 0777);
            k->status[rank][frame] = mps_frames_write(frames);
            note(k, sim, rank, k->status[rank][frame]);
            if (k->blocked && rank == 1 && frame == 1) remove(path);
            frame++;
        }
        if (status >= 0) status = mps_step(sim, 1, NULL);
    }
    note(k, sim, rank, status);
    if (!k->team || mps_particles_collect(sim) < 0) return;
    k->wrong[rank] = mps_frames_write(frames);
    mps_particles_collect_end(sim);
}

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_sim *sim = NULL;
    mps_frames *frames = NULL;
    mps_status status = scene_start(k->scene, k->team, rank, &sim);
    if (status == MPS_OK) status = mps_frames_open(sim, k->folder, "f", k->kinds, &frames);
    if (status == MPS_OK)
        write_frames(k, sim, rank, frames);
    else
        note(k, sim, rank, status);
    mps_frames_close(frames);
    mps_sim_destroy(sim);
}

static void take(run *k, int32_t ranks)
{
    k->scene = scene_named("changes_2d");
    if (!k->folder[0]) {
        strcpy(k->folder, "ranks_frames_XXXXXX");
        assert_non_null(mkdtemp(k->folder));
    }
    k->team = ranks > 1 ? kit_engine_create(ranks, 3) : NULL;
    if (k->team)
        kit_engine_run(k->team, run_rank, k);
    else
        run_rank(k, 0);
    if (k->team) kit_engine_destroy(k->team);
}

static void remove_folder(const run *k)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", k->folder);
    assert_int_equal(system(command), 0);
}

/* ---- reading ---- */

static char *slurp(const char *path)
{
    FILE *f = fopen(path, "rb");
    if (!f) fail_msg("no file %s", path);
    fseek(f, 0, SEEK_END);
    const long size = ftell(f);
    rewind(f);
    char *text = malloc((size_t)size + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)size, f), size);
    fclose(f);
    text[size] = 0;
    return text;
}

static const char *array_of(const char *text, const char *name)
{
    char tag[80];
    snprintf(tag, sizeof tag, "Name=\"%s\"", name);
    const char *at = strstr(text, tag), *data = strstr(text, "<AppendedData encoding=\"raw\">\n_");
    assert_non_null(at);
    assert_non_null(data);
    return strchr(data, '_') + 1 + strtoll(strstr(at, "offset=\"") + 8, NULL, 10) +
           sizeof(uint64_t);
}

/* Store the pressures of the particles of a file at the indices of their ids, which must be empty.
 * Returns their number. */
static int64_t collect(const char *path, float p[IDS])
{
    char *text = slurp(path);
    const char *count = strstr(text, "NumberOfPoints=\"");
    assert_non_null(count);
    const int64_t points = strtoll(count + 16, NULL, 10);
    const char *ids = array_of(text, "id"), *pressures = array_of(text, "pressure");
    for (int64_t k = 0; k < points; k++) {
        int64_t id;
        memcpy(&id, ids + k * (int64_t)sizeof id, sizeof id);
        assert_in_range(id, 0, IDS - 1);
        if (p[id] < 1e30F) fail_msg("%s: particle %d is there twice", path, (int)id);
        memcpy(&p[id], pressures + k * (int64_t)sizeof p[id], sizeof p[id]);
    }
    free(text);
    return points;
}

static void forget(float p[IDS])
{
    for (int k = 0; k < IDS; k++) p[k] = 1e31F;
}

static void clean(const run *k, int32_t ranks)
{
    for (int32_t r = 0; r < ranks; r++)
        if (k->error[r][0]) fail_msg("rank %d: %s", (int)r, k->error[r]);
}

/* ---- tests ---- */

static void pieces_have_all(void **state)
{
    (void)state;
    static float alone[IDS], many[IDS];
    char path[PATH], name[64];
    run one = {.kinds = MPS_FRAMES_PIECES}, four = {.kinds = MPS_FRAMES_PIECES};
    take(&one, 1);
    take(&four, MOST_RANKS);
    clean(&one, 1);
    for (int s = 0; s < FRAMES; s++) {
        int64_t n = 0;
        forget(alone);
        forget(many);
        snprintf(path, sizeof path, "%s/f/f_%06d.vtp", one.folder, s);
        const int64_t wanted = collect(path, alone);
        snprintf(path, sizeof path, "%s/f/f_%06d.pvtp", four.folder, s);
        char *list = slurp(path);
        for (int r = 0; r < MOST_RANKS; r++) {
            snprintf(name, sizeof name, "<Piece Source=\"f_%06d_%04d.vtp\"/>", s, r);
            assert_non_null(strstr(list, name));
            snprintf(path, sizeof path, "%s/f/f_%06d_%04d.vtp", four.folder, s, r);
            n += collect(path, many);
        }
        assert_int_equal(n, wanted);
        assert_memory_equal(alone, many, sizeof alone);
        assert_non_null(strstr(list, "<PDataArray type=\"Float32\" Name=\"pressure\""));
        free(list);
    }
    snprintf(path, sizeof path, "%s/f.pvd", four.folder);
    char *series = slurp(path);
    assert_non_null(strstr(series, "file=\"f/f_000002.pvtp\""));
    assert_null(strstr(series, "f_000003"));
    free(series);
    for (int r = 0; r < MOST_RANKS; r++) assert_int_equal(four.wrong[r], MPS_E_STATE);
    remove_folder(&one);
    remove_folder(&four);
}

static void one_rank_cannot(void **state)
{
    (void)state;
    run k = {.kinds = MPS_FRAMES_PIECES, .blocked = true};
    take(&k, 3);
    char path[PATH];
    for (int r = 0; r < 3; r++) {
        assert_int_equal(k.status[r][0], MPS_OK);
        assert_int_equal(k.status[r][1], MPS_E_IO);
        assert_int_equal(k.status[r][2], MPS_OK);
        assert_non_null(strstr(k.error[r], "f_000001_0001.vtp"));
    }
    snprintf(path, sizeof path, "%s/f.pvd", k.folder);
    char *series = slurp(path);
    assert_non_null(strstr(series, "f_000001.pvtp"));
    assert_null(strstr(series, "f_000002.pvtp"));
    free(series);
    remove_folder(&k);
}

static void whole_frames_need_all(void **state)
{
    (void)state;
    run k = {.kinds = 0};
    take(&k, 2);
    assert_int_equal(k.status[0][0], MPS_E_STATE);
    assert_non_null(strstr(k.error[0], "mps_particles_collect()"));
    assert_int_equal(k.wrong[0], MPS_OK);
    assert_int_equal(k.wrong[1], MPS_OK);
    remove_folder(&k);
}

/* ---- continued series ---- */

static int64_t files_in(const run *k, char names[TEXT])
{
    char command[160], line[64];
    int64_t count = 0;
    snprintf(command, sizeof command, "ls '%s/f'", k->folder);
    FILE *f = popen(command, "r");
    assert_non_null(f);
    for (names[0] = 0; fgets(line, sizeof line, f); count++)
        strncat(names, line, TEXT - 1 - strlen(names));
    pclose(f);
    return count;
}

/* The first frame of the same folder is written again on other numbers of ranks: no file of the
 * others is left. */
static void other_ranks_go_on(void **state)
{
    (void)state;
    static const struct {
        int32_t ranks, kinds;
        int64_t files;
    } turn[] = {{4, MPS_FRAMES_PIECES, 5},
                {2, MPS_FRAMES_PIECES, 3},
                {1, 0, 1},
                {3, MPS_FRAMES_PIECES, 4},
                {1, MPS_FRAMES_PIECES, 1}};
    static float p[IDS];
    char path[PATH], names[TEXT];
    run k = {.frames = 1};
    for (size_t t = 0; t < sizeof turn / sizeof turn[0]; t++) {
        k.kinds = turn[t].kinds | MPS_FRAMES_CONTINUE;
        take(&k, turn[t].ranks);
        clean(&k, turn[t].ranks);
        if (files_in(&k, names) != turn[t].files) fail_msg("turn %d leaves %s", (int)t, names);
        int64_t n = 0;
        forget(p);
        for (int r = 0; r < turn[t].ranks; r++) {
            snprintf(path, sizeof path, "%s/f/f_000000", k.folder);
            if (turn[t].ranks > 1)
                snprintf(path + strlen(path), sizeof path - strlen(path), "_%04d", r);
            strcat(path, ".vtp");
            n += collect(path, p);
        }
        assert_in_range(n, 300, 2000);
    }
    remove_folder(&k);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_have_all), cmocka_unit_test(one_rank_cannot),
        cmocka_unit_test(whole_frames_need_all), cmocka_unit_test(other_ranks_go_on)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
