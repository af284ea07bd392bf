/* SPDX-License-Identifier: BSD-3-Clause */
/* Collective failure. A rank that fails sends its text to rank 0. Rank 0 broadcasts the first text
 * that it receives, so that all ranks report the same one. All waiting loops test for these
 * notices, which have their own communicator. */
#include "mpi_engine.h"
#include <stdio.h>
#include <string.h>

enum { FAILED = 1, GOODBYE };
/* Time that a failed rank waits for the text of rank 0, and at the end for messages of others
 * [s]. */
static const double patience_text = 1, patience_end = 2;

static void notify(mps__mpi *e, int32_t rank, int tag)
{
    MPI_Request *request = &e->notifying.request[e->notifying.count];
    const int bytes = tag == FAILED ? (int)strlen(e->own) + 1 : 0;
    if (e->notifying.count < e->notifying.capacity &&
        MPI_Isend(e->own, bytes, MPI_CHAR, rank, tag, e->notices, request) == MPI_SUCCESS)
        e->notifying.count++;
}

int mps__mpi_listen_begin(mps__mpi *e)
{
    return MPI_Irecv(e->received, MPS__MPI_TEXT, MPI_CHAR, e->rank == 0 ? MPI_ANY_SOURCE : 0,
                     MPI_ANY_TAG, e->notices, &e->notice) != MPI_SUCCESS;
}

/* Rank 0: adopt this text for all ranks. */
static void agree(mps__mpi *e, const char *text)
{
    if (e->agreed) return;
    snprintf(e->own, sizeof e->own, "%s", text);
    e->text = e->own;
    e->failed = e->agreed = true;
    for (int32_t k = 1; k < e->ranks; k++)
        if (!e->gone[k]) notify(e, k, FAILED);
}

/* Receive a notice. */
static void receive(mps__mpi *e, const MPI_Status *status)
{
    e->received[MPS__MPI_TEXT - 1] = '\0';
    if (e->rank > 0) {
        e->text = e->received;
        e->failed = e->agreed = true;
        return;
    }
    if (status->MPI_TAG == GOODBYE)
        e->gone[status->MPI_SOURCE] = 1;
    else
        agree(e, e->received);
    if (mps__mpi_listen_begin(e)) agree(e, "MPI does not receive messages any more");
}

bool mps__mpi_failed(mps__mpi *e)
{
    MPI_Status status;
    int here = 1;
    while (here && e->notice != MPI_REQUEST_NULL) {
        if (MPI_Test(&e->notice, &here, &status) != MPI_SUCCESS) break;
        if (here) receive(e, &status);
    }
    return e->failed;
}

void mps__mpi_fail(void *engine, const char *text)
{
    mps__mpi *e = engine;
    if (mps__mpi_failed(e)) return;
    if (e->rank == 0) {
        agree(e, text);
        return;
    }
    snprintf(e->own, sizeof e->own, "%s", text);
    e->text = e->own;
    e->failed = true;
    notify(e, 0, FAILED);
}

const char *mps__mpi_failure(void *engine)
{
    mps__mpi *e = engine;
    if (!mps__mpi_failed(e)) return NULL;
    const double end = mps__mpi_now() + patience_text;
    for (int64_t turn = 0; !e->agreed && mps__mpi_now() < end; turn++) {
        mps__mpi_failed(e);
        mps__mpi_rest(turn);
    }
    return e->text;
}

int mps__mpi_error(mps__mpi *e, const char *call, int code)
{
    char text[MPS__MPI_TEXT], why[MPI_MAX_ERROR_STRING] = "";
    int length = 0;
    MPI_Error_string(code, why, &length);
    snprintf(text, sizeof text, "rank %d of %d: MPI failed in '%s': %.300s", (int)e->rank,
             (int)e->ranks, call, why);
    mps__mpi_fail(e, text);
    return 1;
}

static bool all_gone(const mps__mpi *e)
{
    for (int32_t k = 1; k < e->ranks && e->rank == 0; k++)
        if (!e->gone[k]) return false;
    return true;
}

/* Rank 0 waits until all others have left: one of them may still fail and send a notice. */
bool mps__mpi_finish(mps__mpi *e)
{
    if (e->rank > 0) notify(e, 0, GOODBYE);
    const double begin = mps__mpi_now();
    int sent = 0;
    for (int64_t turn = 0;; turn++) {
        const double limit = mps__mpi_failed(e) || e->rank > 0 ? patience_end : e->watchdog;
        MPI_Testall(e->notifying.count, e->notifying.request, &sent, MPI_STATUSES_IGNORE);
        if ((sent && all_gone(e)) || mps__mpi_now() - begin > limit) break;
        mps__mpi_rest(turn);
    }
    if (e->notice != MPI_REQUEST_NULL) {
        MPI_Cancel(&e->notice);
        MPI_Wait(&e->notice, MPI_STATUS_IGNORE);
    }
    if (!sent) e->stuck = true;
    return sent && all_gone(e);
}
