/* SPDX-License-Identifier: BSD-3-Clause */
/* Cuts of space: recursive coordinate bisection of Zoltan. Each rank stores all cuts, so that
 * owners are found without messages. */
#include "mpi_engine.h"
#include <stdio.h>
#include <string.h>
#include <zoltan.h>

static int count_places(void *engine, int *failed)
{
    *failed = ZOLTAN_OK;
    return (int)((const mps__mpi *)engine)->n;
}

static int count_axes(void *engine, int *failed)
{
    *failed = ZOLTAN_OK;
    return ((const mps__mpi *)engine)->dim;
}

/* Global ids of positions: rank and index, as unsigned numbers of 32 bits. */
static void list_places(void *engine, int entries, int local_entries, ZOLTAN_ID_PTR name,
                        ZOLTAN_ID_PTR local, int weights, float *weight, int *failed)
{
    const mps__mpi *e = engine;
    (void)local_entries, (void)local, (void)weights;
    for (int64_t k = 0; k < e->n; k++) {
        name[k * entries] = (ZOLTAN_ID_TYPE)e->rank;
        name[k * entries + 1] = (ZOLTAN_ID_TYPE)k;
        weight[k] = e->weight[k];
    }
    *failed = ZOLTAN_OK;
}

static void set_position(void *engine, int entries, int local_entries, ZOLTAN_ID_PTR name,
                         ZOLTAN_ID_PTR local, double *x, int *failed)
{
    const mps__mpi *e = engine;
    (void)entries, (void)local_entries, (void)local;
    memcpy(x, e->x + (size_t)name[1] * (size_t)e->dim, (size_t)e->dim * sizeof *x);
    *failed = ZOLTAN_OK;
}

int mps__mpi_cuts_create(mps__mpi *e)
{
    /* Cuts are between two positions, never through several with the same coordinate. */
    static char *const settings[][2] = {
        {"DEBUG_LEVEL", "0"},     {"LB_METHOD", "RCB"},      {"KEEP_CUTS", "1"},
        {"NUM_GID_ENTRIES", "2"}, {"NUM_LID_ENTRIES", "0"},  {"OBJ_WEIGHT_DIM", "1"},
        {"RETURN_LISTS", "NONE"}, {"RCB_OUTPUT_LEVEL", "0"}, {"RCB_RECTILINEAR_BLOCKS", "1"},
        {"AVERAGE_CUTS", "1"},
    };
    float version;
    if (e->ranks == 1) return 0;
    if (Zoltan_Initialize(0, NULL, &version) != ZOLTAN_OK) return 1;
    e->zoltan = Zoltan_Create(e->data);
    if (!e->zoltan) return 1;
    for (size_t k = 0; k < sizeof settings / sizeof settings[0]; k++)
        if (Zoltan_Set_Param(e->zoltan, settings[k][0], settings[k][1]) != ZOLTAN_OK) return 1;
    return Zoltan_Set_Num_Obj_Fn(e->zoltan, count_places, e) != ZOLTAN_OK ||
           Zoltan_Set_Obj_List_Fn(e->zoltan, list_places, e) != ZOLTAN_OK ||
           Zoltan_Set_Num_Geom_Fn(e->zoltan, count_axes, e) != ZOLTAN_OK ||
           Zoltan_Set_Geom_Fn(e->zoltan, set_position, e) != ZOLTAN_OK;
}

void mps__mpi_cuts_destroy(mps__mpi *e)
{
    if (e->zoltan) Zoltan_Destroy(&e->zoltan);
}

static void add(void *into, const void *from)
{
    int64_t a, b;
    memcpy(&a, into, sizeof a);
    memcpy(&b, from, sizeof b);
    a += b;
    memcpy(into, &a, sizeof a);
}

static int cut_places(mps__mpi *e)
{
    int changes, gids, lids, ins, outs, *in_rank, *in_part, *out_rank, *out_part;
    ZOLTAN_ID_PTR in_name, in_local, out_name, out_local;
    char text[MPS__MPI_TEXT];
    const int code = Zoltan_LB_Partition(e->zoltan, &changes, &gids, &lids, &ins, &in_name,
                                         &in_local, &in_rank, &in_part, &outs, &out_name,
                                         &out_local, &out_rank, &out_part);
    if (code == ZOLTAN_OK || code == ZOLTAN_WARN) return 0;
    snprintf(text, sizeof text, "rank %d of %d: Zoltan cannot cut space: %s", (int)e->rank,
             (int)e->ranks, code == ZOLTAN_MEMERR ? "no memory" : "its message tells why");
    mps__mpi_fail(e, text);
    return 1;
}

/* All ranks agree before they call Zoltan, whose messages cannot be cancelled. Without positions
 * the cuts do not change. */
int mps__mpi_partition(void *engine, int32_t dim, int64_t n, const double *x, const float *weight)
{
    mps__mpi *e = engine;
    int64_t all = n;
    if (n > INT32_MAX) mps__mpi_fail(e, "a rank has more than 2^31 - 1 particles: use more ranks");
    if (mps__mpi_reduce(e, 1, sizeof all, &all, add)) return 1;
    e->dim = dim;
    if (e->ranks == 1 || all == 0) return 0;
    e->n = n;
    e->x = x;
    e->weight = weight;
    const int failed = cut_places(e);
    e->cut = !failed;
    return mps__mpi_reduce(e, 1, sizeof all, &all, add) || failed;
}

int mps__mpi_owner(void *engine, int64_t n, const double *x, int32_t *rank)
{
    mps__mpi *e = engine;
    int found = 0, part;
    if (e->failed) return 1;
    for (int64_t k = 0; k < n; k++) {
        double place[3] = {0};
        for (int d = 0; d < e->dim && e->cut; d++) place[d] = x[k * e->dim + d];
        if (e->cut && Zoltan_LB_Point_PP_Assign(e->zoltan, place, &found, &part) != ZOLTAN_OK) {
            mps__mpi_fail(e, "Zoltan cannot tell which rank owns a place");
            return 1;
        }
        rank[k] = found;
    }
    return 0;
}

static void sort(int32_t *rank, int32_t count)
{
    for (int32_t k = 1; k < count; k++) {
        const int32_t r = rank[k];
        int32_t at = k;
        for (; at > 0 && rank[at - 1] > r; at--) rank[at] = rank[at - 1];
        rank[at] = r;
    }
}

int mps__mpi_overlap(void *engine, const double *lo, const double *hi, int32_t *rank,
                     int32_t *count)
{
    mps__mpi *e = engine;
    double a[3] = {0}, b[3] = {0};
    int found = 0;
    if (e->failed) return 1;
    rank[0] = 0;
    *count = 1;
    if (!e->cut) return 0;
    for (int d = 0; d < e->dim; d++) {
        a[d] = lo[d];
        b[d] = hi[d];
    }
    /* parts and ranks have the same numbers */
    if (Zoltan_LB_Box_Assign(e->zoltan, a[0], a[1], a[2], b[0], b[1], b[2], rank, &found) !=
        ZOLTAN_OK) {
        mps__mpi_fail(e, "Zoltan cannot tell which ranks own places of a box");
        return 1;
    }
    sort(rank, found);
    *count = found;
    return 0;
}
