/* SPDX-License-Identifier: BSD-3-Clause */
/* Settings, start of MPI, registration. */
#include "amg.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const mps_hypre_settings mps__hypre_defaults = {
    .struct_size = sizeof(mps_hypre_settings),
    .coarsening = 8,
    .interpolation = 6,
    .row_entries = 4,
    .relaxation = 18,
    .sweeps = 1,
    .aggressive_levels = 1,
    .threshold = 0.5,
};

__attribute__((format(printf, 3, 4))) static mps_status
fail(const mps_hypre_settings *s, mps_status status, const char *format, ...)
{
    if (!s || !s->error || !s->error_size) return status;
    va_list list;
    va_start(list, format);
    vsnprintf(s->error, s->error_size, format, list);
    va_end(list);
    return status;
}

static bool symmetric(int32_t relaxation)
{
    return (relaxation >= 6 && relaxation <= 8) || relaxation == 16 || relaxation == 18;
}

static mps_status check(const mps_hypre_settings *s)
{
    if (!s) return MPS_OK;
    /* the struct may be too small to contain `error` */
    if (s->struct_size < sizeof *s) return MPS_E_ARG;
    if (s->struct_size > sizeof *s)
        return fail(s, MPS_E_VERSION,
                    "mps_hypre_settings of %u bytes comes from a newer version; this one knows %zu",
                    s->struct_size, sizeof *s);
    const struct {
        const char *name;
        int32_t value, least, most;
    } ranges[] = {{"coarsening", s->coarsening, 0, 22},
                  {"interpolation", s->interpolation, 0, 18},
                  {"row_entries", s->row_entries, 0, 100},
                  {"sweeps", s->sweeps, 1, 16},
                  {"aggressive_levels", s->aggressive_levels, 0, 25}};
    for (size_t k = 0; k < sizeof ranges / sizeof ranges[0]; k++)
        if (ranges[k].value < ranges[k].least || ranges[k].value > ranges[k].most)
            return fail(s, MPS_E_ARG, "%s is %d; allowed: %d to %d", ranges[k].name,
                        ranges[k].value, ranges[k].least, ranges[k].most);
    if (s->comm && *(const MPI_Comm *)s->comm == MPI_COMM_NULL)
        return fail(s, MPS_E_ARG, "comm is MPI_COMM_NULL; allowed: NULL or an intracommunicator");
    if (!symmetric(s->relaxation))
        return fail(s, MPS_E_ARG, "relaxation is %d; allowed: 6, 7, 8, 16 and 18", s->relaxation);
    if (!(s->threshold >= 0 && s->threshold < 1))
        return fail(s, MPS_E_ARG, "threshold is %g; allowed: at least 0, below 1", s->threshold);
    return MPS_OK;
}

/* ---- MPI: finalised here only if initialised here ---- */

static void stop_mpi(void)
{
    int over = 0;
    MPI_Finalized(&over);
    if (over) return;
    HYPRE_Finalize();
    MPI_Finalize();
}

static mps_status start(const mps_hypre_settings *s)
{
    static bool hypre_runs;
    int running = 0, over = 0;
    MPI_Finalized(&over);
    if (over)
        return fail(s, MPS_E_STATE,
                    "MPI has ended already, and cannot be started twice in a program");
    MPI_Initialized(&running);
    if (!running) {
        if (MPI_Init(NULL, NULL) != MPI_SUCCESS) return fail(s, MPS_E_STATE, "MPI does not start");
        atexit(stop_mpi);
    }
    if (!hypre_runs && HYPRE_Init()) return fail(s, MPS_E_STATE, "hypre does not start");
    hypre_runs = true;
    return MPS_OK;
}

/* ---- ranks ---- */

MPI_Comm mps__hypre_comm(const mps_hypre_settings *settings)
{
    return settings && settings->comm ? *(const MPI_Comm *)settings->comm : MPI_COMM_SELF;
}

bool mps__hypre_place(MPI_Comm comm, int32_t rank, int32_t ranks)
{
    int at = 0, size = 1;
    MPI_Comm_rank(comm, &at);
    MPI_Comm_size(comm, &size);
    return at == rank && size == ranks;
}

/* Check that the ranks of a handle are those of the communicator. */
static mps_status check_place(const mps_sim *sim, const mps_hypre_settings *s)
{
    int32_t rank, ranks;
    int at = 0, size = 1;
    const MPI_Comm comm = mps__hypre_comm(s);
    const mps_status status = mps_sim_ranks(sim, &rank, &ranks);
    if (status < 0) return fail(s, status, "sim is NULL");
    if (mps__hypre_place(comm, rank, ranks)) return MPS_OK;
    MPI_Comm_rank(comm, &at);
    MPI_Comm_size(comm, &size);
    return fail(s, MPS_E_STATE,
                "the handle is rank %d of %d, %s has rank %d of %d: set settings.comm to the "
                "communicator of mps_mpi_attach(), and call that first",
                (int)rank, (int)ranks, s && s->comm ? "comm" : "MPI_COMM_SELF", at, size);
}

/* ---- public ---- */

mps_status mps_hypre_settings_init(mps_hypre_settings *settings, size_t size)
{
    if (!settings || size < sizeof *settings) return MPS_E_ARG;
    memset(settings, 0, size);
    *settings = mps__hypre_defaults;
    settings->struct_size = (uint32_t)size;
    return MPS_OK;
}

mps_status mps_hypre_solver(const mps_hypre_settings *settings, mps_solver_ops *ops)
{
    mps_status status = check(settings);
    if (!ops) status = fail(settings, MPS_E_ARG, "ops is NULL");
    if (status >= 0) status = start(settings);
    if (status < 0) return status;
    *ops = (mps_solver_ops){
        .struct_size = sizeof *ops,
        .api = MPS_PPE_API,
        .name = "hypre.boomeramg",
        .symmetric = 1,
        .create = mps__hypre_create,
        .solve = mps__hypre_solve,
        .destroy = mps__hypre_destroy,
        .user = (void *)(uintptr_t)settings, /* only read */
        .ranks = settings && settings->comm,
    };
    return MPS_OK;
}

mps_status mps_hypre_register(mps_sim *sim, const mps_hypre_settings *settings)
{
    mps_solver_ops ops;
    mps_status status = mps_hypre_solver(settings, &ops);
    if (status >= 0) status = check_place(sim, settings);
    return status < 0 ? status : mps_solver_register(sim, &ops);
}
