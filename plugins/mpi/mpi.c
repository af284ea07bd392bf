/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of the engine, and its creation and destruction. */
#include "mpi_engine.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const int64_t chunk = INT64_C(1) << 30;
static const double watchdog = 300;

/* Whether `well` is true on all ranks of a communicator. */
static bool agree(MPI_Comm comm, bool well)
{
    int wrong = !well, any = 1;
    return MPI_Allreduce(&wrong, &any, 1, MPI_INT, MPI_MAX, comm) == MPI_SUCCESS && !any;
}

/* Seconds of MPS_MPI_WATCHDOG. @return whether they are valid */
static bool read_watchdog(double *seconds, char *text, size_t size)
{
    const char *value = getenv("MPS_MPI_WATCHDOG");
    char *end = NULL;
    *seconds = watchdog;
    if (!value || !value[0]) return true;
    *seconds = strtod(value, &end);
    if (end != value && !*end && *seconds > 0) return true;
    snprintf(text, size,
             "environment variable MPS_MPI_WATCHDOG is '%.40s': must be a number of seconds > 0",
             value);
    return false;
}

/* The part of an engine that needs no other rank. */
static mps__mpi *make(const mps_allocator *allocator, const mps__mpi_start *start)
{
    mps__mpi empty = {.allocator = *allocator,
                      .data = MPI_COMM_NULL,
                      .notices = MPI_COMM_NULL,
                      .notice = MPI_REQUEST_NULL,
                      .chunk = start->chunk > 0 ? start->chunk : chunk};
    MPI_Comm_rank(start->comm, &empty.rank);
    MPI_Comm_size(start->comm, &empty.ranks);
    mps__mpi *e = mps__mpi_alloc(&empty, sizeof *e);
    if (!e) return NULL;
    *e = empty;
    e->gone = mps__mpi_alloc(e, (size_t)e->ranks);
    e->notifying.capacity = e->ranks + 1;
    e->notifying.request = mps__mpi_alloc(e, (size_t)e->notifying.capacity * sizeof(MPI_Request));
    if (e->gone) memset(e->gone, 0, (size_t)e->ranks);
    return e;
}

/* Memory that MPI may still use is not freed. */
static void release(mps__mpi *e)
{
    if (e->stuck) return;
    void *const blocks[] = {e->gone, e->notifying.request, e->exchange.request, e->other.request,
                            e->scratch};
    for (size_t k = 0; k < sizeof blocks / sizeof blocks[0]; k++) mps__mpi_release(e, blocks[k]);
    mps__mpi_release(e, e);
}

static int duplicate(mps__mpi *e, MPI_Comm comm)
{
    if (MPI_Comm_dup(comm, &e->data) != MPI_SUCCESS ||
        MPI_Comm_dup(comm, &e->notices) != MPI_SUCCESS)
        return 1;
    MPI_Comm_set_errhandler(e->data, MPI_ERRORS_RETURN);
    MPI_Comm_set_errhandler(e->notices, MPI_ERRORS_RETURN);
    return 0;
}

static const char *wrong_communicator(MPI_Comm comm)
{
    int running = 0, over = 0, inter = 0;
    MPI_Initialized(&running);
    MPI_Finalized(&over);
    if (!running) return "MPI is not running: call MPI_Init() first";
    if (over) return "MPI has ended already: attach before MPI_Finalize()";
    if (comm == MPI_COMM_NULL) return "the communicator is MPI_COMM_NULL";
    MPI_Comm_test_inter(comm, &inter);
    return inter ? "the communicator is an intercommunicator: must be an intracommunicator" : NULL;
}

static int create(const mps_allocator *allocator, void **self, char *text, size_t size)
{
    const mps__mpi_start *start = *self;
    const char *wrong = wrong_communicator(start->comm);
    if (wrong) {
        snprintf(text, size, "%s", wrong);
        return 1;
    }
    double seconds;
    const bool valid = read_watchdog(&seconds, text, size);
    mps__mpi *e = valid ? make(allocator, start) : NULL;
    if (!agree(start->comm, e && e->gone && e->notifying.request) || !e) {
        if (e && e->gone && e->notifying.request)
            snprintf(text, size, "another rank has no memory, or a wrong MPS_MPI_WATCHDOG");
        if (e) release(e);
        return 1;
    }
    e->watchdog = seconds;
    const bool ready = !duplicate(e, start->comm) && !mps__mpi_cuts_create(e) &&
                       !mps__mpi_listen_begin(e);
    *self = e;
    if (agree(start->comm, ready)) return 0;
    snprintf(text, size, "MPI or Zoltan does not start on %s rank", ready ? "another" : "this");
    return 1; /* objects of MPI and Zoltan are not freed */
}

/* After a failure the communicators are kept: messages may still arrive. */
static void destroy(const mps_allocator *allocator, void *self)
{
    mps__mpi *e = self;
    int over = 0;
    (void)allocator;
    MPI_Finalized(&over);
    if (!over) {
        mps__mpi_stop(e);
        const bool quiet = mps__mpi_finish(e);
        mps__mpi_cuts_destroy(e);
        if (quiet && !e->failed) {
            MPI_Comm_free(&e->data);
            MPI_Comm_free(&e->notices);
        }
    }
    release(e);
}

static void fail(void *self, const char *text)
{
    mps__mpi_fail(self, text);
    mps__mpi_stop(self);
}

static void place(void *self, int32_t *rank, int32_t *ranks)
{
    const mps__mpi *e = self;
    *rank = e->rank;
    *ranks = e->ranks;
}

mps_ranks_ops mps__mpi_table(const mps__mpi_start *start)
{
    return (mps_ranks_ops){.struct_size = sizeof(mps_ranks_ops),
                           .api = MPS_RANKS_API,
                           .name = "mpi.zoltan",
                           .create = create,
                           .destroy = destroy,
                           .place = place,
                           .partition = mps__mpi_partition,
                           .owner = mps__mpi_owner,
                           .overlap = mps__mpi_overlap,
                           .connect = mps__mpi_connect,
                           .disconnect = mps__mpi_disconnect,
                           .exchange_begin = mps__mpi_exchange_begin,
                           .exchange_end = mps__mpi_exchange_end,
                           .reduce = mps__mpi_reduce,
                           .gather = mps__mpi_gather,
                           .fail = fail,
                           .failure = mps__mpi_failure,
                           .user = (void *)(uintptr_t)start /* only read */};
}

mps_status mps_mpi_attach(mps_sim *sim, MPI_Comm comm)
{
    const mps__mpi_start start = {.comm = comm};
    const mps_ranks_ops ops = mps__mpi_table(&start);
    return mps_sim_ranks_set(sim, &ops);
}
