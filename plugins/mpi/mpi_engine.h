/* SPDX-License-Identifier: BSD-3-Clause */
/* An engine of ranks on MPI. Except in Zoltan, no call blocks in MPI: each waits in a loop that
 * also tests for failures. */
#ifndef MPS_MPI_ENGINE_H
#define MPS_MPI_ENGINE_H

#include <mps/mpi.h>
#include <stdbool.h>

enum { MPS__MPI_TEXT = 512 };

/* Data that mps_ranks_ops.user points to when create is called. */
typedef struct mps__mpi_start {
    MPI_Comm comm;
    int64_t chunk; /* most bytes of a message; 0: 2^30 */
} mps__mpi_start;

/* Pending messages. */
typedef struct mps__mpi_list {
    MPI_Request *request;
    int32_t count, capacity;
} mps__mpi_list;

typedef struct mps__mpi {
    mps_allocator allocator;
    MPI_Comm data, notices;
    int32_t rank, ranks;
    int64_t chunk;
    double watchdog; /* [s] */

    /* collective failure: rank 0 decides which text counts */
    bool failed, agreed; /* a rank failed; `received` is the text of rank 0 */
    bool stuck;          /* messages did not complete: MPI may still use their memory */
    char own[MPS__MPI_TEXT], received[MPS__MPI_TEXT];
    const char *text;
    MPI_Request notice; /* receive of the next notice */
    mps__mpi_list notifying;
    uint8_t *gone; /* [ranks] rank 0: ranks that have left */

    /* messages */
    /* those between exchange_begin and _end; those of a single call */
    mps__mpi_list exchange, other;
    char *scratch;
    size_t scratch_bytes;

    /* cuts */
    struct Zoltan_Struct *zoltan;
    bool cut;
    int32_t dim; /* from here on: of the partition in progress */
    int64_t n;
    const double *x;
    const float *weight;
} mps__mpi;

mps_ranks_ops mps__mpi_table(const mps__mpi_start *start);

/* ---- failing.c ---- */
int mps__mpi_listen_begin(mps__mpi *e);
/* Whether a rank is known to have failed. */
bool mps__mpi_failed(mps__mpi *e);
void mps__mpi_fail(void *engine, const char *text);
const char *mps__mpi_failure(void *engine);
/* Fail with a code of MPI. @return 1 */
int mps__mpi_error(mps__mpi *e, const char *call, int code);
/* Leave the ranks. @return whether no other rank sends any more */
bool mps__mpi_finish(mps__mpi *e);

/* ---- wait.c ---- */
void *mps__mpi_alloc(mps__mpi *e, size_t size);
void mps__mpi_release(mps__mpi *e, void *block);
/* Memory valid until the next call; NULL: the ranks have failed. */
void *mps__mpi_scratch(mps__mpi *e, size_t bytes);
/* Begin to send or receive. @return non-zero: the ranks have failed */
int mps__mpi_send(mps__mpi *e, mps__mpi_list *list, int tag, int32_t rank, const void *data,
                  int64_t bytes);
int mps__mpi_receive(mps__mpi *e, mps__mpi_list *list, int tag, int32_t rank, void *data,
                     int64_t bytes);
/* Wait for all messages of a list; a timeout reports the name `call`. */
int mps__mpi_wait(mps__mpi *e, mps__mpi_list *list, const char *call);
/* Cancel all messages after a failure: arrays of the library are not accessed any more. */
void mps__mpi_stop(mps__mpi *e);
double mps__mpi_now(void);
/* Yield the processor; sleep in later iterations of a waiting loop. */
void mps__mpi_rest(int64_t turn);

/* ---- messages.c ---- */
int mps__mpi_connect(void *engine, int32_t count, const int32_t *to, const int64_t *sent,
                     mps_route *route);
void mps__mpi_disconnect(void *engine, mps_route *route);
int mps__mpi_exchange_begin(void *engine, const mps_route *route, size_t bytes, const void *out,
                            void *in);
int mps__mpi_exchange_end(void *engine, const mps_route *route);
int mps__mpi_reduce(void *engine, int32_t count, size_t bytes, void *values,
                    mps_combine_fn combine);
int mps__mpi_gather(void *engine, const void *own, const int64_t *bytes, void *all);

/* ---- cuts.c ---- */
int mps__mpi_cuts_create(mps__mpi *e);
void mps__mpi_cuts_destroy(mps__mpi *e);
int mps__mpi_partition(void *engine, int32_t dim, int64_t n, const double *x, const float *weight);
int mps__mpi_owner(void *engine, int64_t n, const double *x, int32_t *rank);
int mps__mpi_overlap(void *engine, const double *lo, const double *hi, int32_t *rank,
                     int32_t *count);

#endif
