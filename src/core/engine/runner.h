/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs verbs of models and their loops. */
#ifndef MPS_CORE_RUNNER_H
#define MPS_CORE_RUNNER_H

#include "densities.h"
#include "device_memory.h"
#include "deferred.h"
#include "motion.h"
#include "parallel.h"
#include "reaction.h"
#include "sets.h"
#include <mps/step.h>

/* Fluid particle to be added. */
typedef struct mps__entry {
    double x[3], u[3];
    int32_t phase;
} mps__entry;

/* Trapped gas reported by a verb: mps_stage_gas(). */
typedef struct mps__gas {
    int32_t pockets;
    double volume, pressure, work;
} mps__gas;

typedef struct mps__runner {
    mps__context *context;
    mps__models *models;
    mps__channels *channels;
    mps__particles *particles;
    mps__scratch *scratch; /* for the verb in progress */
    int32_t scratch_used;  /* its used blocks */
    const mps_parallel *parallel;
    mps__ghosts *ghosts;
    const bool *phase_defined; /* [MPS__PHASES] */
    mps__entry *entry;         /* inflow particles of verbs of MPS_POPULATE */
    int64_t entries, entry_capacity;
    uint8_t *leaves; /* [n] 1: particle to be removed; valid if `leaving` */
    int64_t leaves_capacity;
    bool leaving;
    mps__model *model;     /* of the verb in progress; NULL: a pass */
    const mps__call *call; /* in progress */
    void **data;           /* its arrays */
    bool switched, copied; /* the verb continues on the host; its arrays were copied */
    bool with_ghosts;      /* loops include ghosts */
    int32_t line;          /* energy budget line of the verb in progress: MPS__LINE_... */
    bool no_memory;        /* scratch allocation failed in a verb */
    bool misused;          /* a verb requested a loop that is not allowed */
    int32_t limiter;       /* index in the plan of the verb that lowered s->dt_limit last, or -1 */
    mps__sets sets;        /* droplets */
    mps__plan plan;
    mps__memory memory;
    mps__densities densities;       /* of the phases */
    mps__deferred_list deferred;    /* deferred reductions of the step in progress */
    const mps_view *view;           /* of the step in progress, with host arrays */
    mps__reactions reactions;       /* of the step in progress */
    bool wrong[MPS__MODELS_ACTIVE]; /* models that reported non-finite values on a device */
    mps__gas gas;                   /* reported in the step in progress */
    void *step;                     /* the step in progress, for passes; NULL before MPS_LIMIT */
    /* notifies that the data of verbs may have changed */
    void (*before_call)(void *step, const mps__call *);
    double seconds[MPS_STAGE_COUNT]; /* of the step, by MPS_STAGE_... */
    double clock;                    /* end of the last timed part, or start of the step [s] */
    double in_calls;                 /* time of calls since then [s] */
} mps__runner;

/* Begin the timing of a step: its costs add up to the time from here to the last timed part. */
void mps__runner_begin(mps__runner *h);
/* Add the time since the previous part, without that of calls, to a part of the step. @return it
 * [s] */
double mps__runner_book(mps__runner *h, int part);

/* Ghosts are new: all their fields are valid. */
void mps__runner_all_alike(mps__runner *h);
/* Run the calls of a hook in order. MPS_E_PLUGIN and MPS_E_NOMEM of a verb have model and time in
 * the text. */
mps_status mps__runner_run(mps__runner *h, mps_stage *s, mps_view *v, int32_t hook);
/* Loops over owned particles outside of calls that only read the particles: mps__world_view().
 * stage.c */
void mps__runner_rows(const mps__runner *h, const mps_view *v, const mps_rows *rows,
                      const void *fields);
/* Exact sums over all ranks. @param count 1..MPS_PARALLEL_VALUES */
void mps__runner_sum(const mps__runner *h, const mps_view *v, int32_t count, const mps_sums *add,
                     const void *fields, double *sums);
/* Maxima over all ranks; `maxima` are lower bounds on entry. */
void mps__runner_max(const mps__runner *h, const mps_view *v, int32_t count, const mps_sums *raise,
                     const void *fields, double *maxima);
/* Deferred sums and maxima: `then` gets the values at mps__runner_flush() at the latest; maxima
 * have no lower bounds. */
void mps__runner_sum_deferred(mps__runner *h, const mps_view *v, int32_t count, const mps_sums *add,
                              const void *fields, mps__then then);
void mps__runner_max_deferred(mps__runner *h, const mps_view *v, int32_t count,
                              const mps_sums *raise, const void *fields, mps__then then);
/* Run `then` without values, after all deferred reductions. */
void mps__runner_defer(mps__runner *h, mps__then then);
/* Flush the deferred reductions with one copy from the device. If the device failed they are
 * dropped: the step fails. deferred.c */
void mps__runner_flush(mps__runner *h);
/* Flush, and copy `bytes` <= 8 of the device array `array` in the same transfer. */
void mps__runner_flush_with(mps__runner *h, const void *array, void *out, size_t bytes);
/* `then` gets the sums of a device as mps__reactions.sum, rounded, or NULL: all sums are on the
 * host. reaction.c */
void mps__runner_reactions_deferred(mps__runner *h, mps__then then);
/* Fail if reactions on a device are not finite; valid after the flush. reaction.c */
mps_status mps__runner_check_reactions(const mps__runner *h, double t);
/* Device addresses for deferred values. */
mps_exact *mps__deferred_sums(mps__runner *h, int32_t count, mps__then then);
double *mps__deferred_maxima(mps__runner *h, int32_t count, mps__then then);
/* Begin serial work on the host in a call on a device: until the end the view has host arrays.
 * @return the device view */
const mps_view *mps__runner_begin_serial(mps_stage *s);
void mps__runner_end_serial(mps_stage *s, const mps_view *device_view);
/* Run the rest of a device verb on the host: its loops, scratch and s->data. The verb must not have
 * written anything yet. The first host loop copies its channels to the host; without such a loop
 * nothing is copied. */
void mps__runner_switch_to_host(mps_stage *s);
/* Whether pairs are available in this hook; else set the error. stage.c */
int mps__stage_has_pairs(mps_stage *s, const char *call);
/* Call it before a host loop of such a verb. If the copy fails, host loops have no rows. */
void mps__runner_to_host(mps__runner *h);
/* Energy budget line of a call's verb: plug-ins and the slots "friction" and "layer" have their
 * own; others MPS__LINE_OF_HOOK. */
int32_t mps__runner_line(const mps__runner *h, const mps__call *call);
/* Log the names of the calls that run on the host, once after each change of models or device. */
void mps__runner_log_spaces(mps__runner *h);
/* Name of the first model that writes a channel of the library, or NULL. */
const char *mps__runner_writer(const mps__runner *h, int32_t channel);

#endif
