/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs verbs of models, and the loops that they ask for. */
#ifndef MPS_CORE_HOST_H
#define MPS_CORE_HOST_H

#include "densities.h"
#include "engine.h"
#include "later.h"
#include "motion.h"
#include "parallel.h"
#include "reaction.h"
#include "sets.h"
#include <mps/step.h>

/* A particle of fluid to come. */
typedef struct mps__entry {
    double x[3], u[3];
    int32_t phase;
} mps__entry;

/* Trapped gas, as a verb reported it: mps_stage_gas(). */
typedef struct mps__gas {
    int32_t pockets;
    double volume, pressure, work;
} mps__gas;

typedef struct mps__host {
    mps__context *context;
    mps__models *models;
    mps__channels *channels;
    mps__particles *particles;
    mps__scratch *scratch; /* lent to the verb in progress: */
    int32_t scratch_used;  /* so many blocks */
    const mps_parallel *parallel;
    mps__ghosts *ghosts;
    const bool *phase_defined; /* [MPS__PHASES] */
    mps__entry *entry;         /* fluid that verbs of MPS_POPULATE let in */
    int64_t entries, entry_capacity;
    uint8_t *leaves; /* [n] 1: a row that leaves; where `leaving` */
    int64_t leaves_capacity;
    bool leaving;
    mps__model *model;     /* of the verb in progress, NULL: a pass */
    const mps__call *call; /* in progress, */
    void **data;           /* and its arrays */
    bool taken, came;      /* it has gone on on the host; what it uses has come */
    bool everywhere;       /* loops go over ghosts too */
    int32_t line;          /* of the budget, of the verb in progress: MPS__LINE_... */
    bool no_memory;        /* a verb got no scratch */
    bool misused;          /* a verb asked for a loop that there is not */
    int32_t limiter;       /* place in the plan of the verb that lowered s->dt_limit last, or -1 */
    mps__sets sets;        /* bodies */
    mps__plan plan;
    mps__twins twins;
    mps__densities densities;       /* of the phases */
    mps__laters laters;             /* of the step in progress */
    const mps_view *view;           /* of the step in progress, with arrays of the host */
    mps__reactions reactions;       /* of the step in progress */
    bool wrong[MPS__MODELS_ACTIVE]; /* models that reported what is not finite, at a device */
    mps__gas gas;                   /* likewise */
    void *step;                     /* the step in progress, for passes; NULL before MPS_LIMIT */
    void (*before_call)(void *step, const mps__call *); /* what verbs see may have changed */
    double seconds[MPS_STAGE_COUNT];                    /* of the step, by MPS_STAGE_... */
    double clock;    /* when a part of the step was booked last, or the step began [s] */
    double in_calls; /* of calls since then [s] */
} mps__host;

/* A step begins: its costs add up to the time from here to the last part that is booked. */
void mps__host_begin(mps__host *h);
/* Book a part of the step outside of its calls: the time since the part before, without that of calls. @return it [s] */
double mps__host_book(mps__host *h, int part);

/* Ghosts are new: they have all fields of their owners. */
void mps__host_all_alike(mps__host *h);
/* Run the calls of a hook in their order. Of a verb MPS_E_PLUGIN, MPS_E_NOMEM with model and time in the text. */
mps_status mps__host_run(mps__host *h, mps_stage *s, mps_view *v, int32_t hook);
/* Loops over owned rows outside of calls, which only look at the particles as they are: mps__world_view(). stage.c */
void mps__host_rows(const mps__host *h, const mps_view *v, const mps_rows *rows,
                    const void *fields);
/* Exact sums, of all ranks. @param count  1..MPS_PARALLEL_VALUES */
void mps__host_sum(const mps__host *h, const mps_view *v, int32_t count, const mps_sums *add,
                   const void *fields, double *sums);
/* Maxima, of all ranks; `maxima` are lower bounds before. */
void mps__host_max(const mps__host *h, const mps_view *v, int32_t count, const mps_sums *raise,
                   const void *fields, double *maxima);
/* The same without waiting: `then` gets the values at mps__host_settle() at the latest, and maxima have no lower bounds. */
void mps__host_sum_later(mps__host *h, const mps_view *v, int32_t count, const mps_sums *add,
                         const void *fields, mps__then then);
void mps__host_max_later(mps__host *h, const mps_view *v, int32_t count, const mps_sums *raise,
                         const void *fields, mps__then then);
/* What needs no values, after all that waits. */
void mps__host_do_later(mps__host *h, mps__then then);
/* All that waits is done, with one copy from the device. If that has failed, it is dropped: the step fails. later.c */
void mps__host_settle(mps__host *h);
/* The same, with a number of at most 8 bytes that the copy brings too: `array` is of the device. */
void mps__host_settle_with(mps__host *h, const void *array, void *out, size_t bytes);
/* `then` gets the sums of a device, as mps__reactions.sum but rounded, or NULL: all of them are on the host. reaction.c */
void mps__host_reactions_later(mps__host *h, mps__then then);
/* Fail for reactions at a device that are not finite; known when all that waits is done. reaction.c */
mps_status mps__host_check_reactions(const mps__host *h, double t);
/* Places at the device for values to come. */
mps_exact *mps__laters_sums(mps__host *h, int32_t count, mps__then then);
double *mps__laters_maxima(mps__host *h, int32_t count, mps__then then);
/* What a call on a device does on the host, one row after the other: in between, the view has arrays of the host. @return the view of the device */
const mps_view *mps__host_begin_serial(mps_stage *s);
void mps__host_end_serial(mps_stage *s, const mps_view *there);
/* Run the rest of a verb of a device on the host: its loops, its scratch, s->data. It must not have written anything yet. Its channels are copied to the
 * host by the first of these loops; without such a loop nothing is copied. */
void mps__host_take(mps_stage *s);
/* Whether there are pairs in this hook; without, the error is set. stage.c */
int mps__stage_has_pairs(mps_stage *s, const char *call);
/* Call it before such a loop. If the copy fails, loops of the host have no rows. */
void mps__host_come(mps__host *h);
/* Line of the budget of a call's verb: of plug-ins and of the slots "friction" and "layer"; of others MPS__LINE_OF_HOOK. */
int32_t mps__host_line(const mps__host *h, const mps__call *call);
/* Log the names of the calls that run on the host, once after models or the device changed. */
void mps__host_tell_places(mps__host *h);
/* Name of the first model that writes a channel of the library, or NULL. */
const char *mps__host_writer(const mps__host *h, int32_t channel);

#endif
