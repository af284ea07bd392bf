/* SPDX-License-Identifier: BSD-3-Clause */
/* A step as a list of calls: the passes of the library and the verbs of the active models, in their order. What follows from their uses is
 * found here once: which channels live when, and which of them share memory. */
#ifndef MPS_CORE_PLAN_H
#define MPS_CORE_PLAN_H

#include "models.h"

enum { MPS__CALLS = 160 };

/* Where a pass stands in its hook. */
enum {
    MPS__BEFORE_MODELS,
    MPS__AFTER_MODELS,
    MPS__LAST_OF_STEP /* after all that may fail: what it writes need not be undone */
};

/* A pass of the library. */
typedef struct mps__pass {
    const char *name;
    int32_t hook, place;
    int32_t stage; /* MPS_STAGE_... that its time belongs to */
    bool
        everywhere; /* its loops go over ghosts too: what it writes is right there, if what it reads is */
    bool undeclared; /* it writes fields of particles that no use of it names */
    bool flat; /* its loops see the view and the arrays of its uses only: an engine may run them */
    int32_t use_count;
    const mps_use *uses;
    mps_status (*run)(mps_stage *s);
    bool (*idle)(
        const void *step); /* nothing to do, on no rank: not run, and no use is asked for */
} mps__pass;

/* What calls have cost since the plan was made, or since costs were cleared. */
typedef struct mps__cost {
    int64_t calls;
    double seconds, bytes; /* of the arrays that they declare */
} mps__cost;

/* Parts of a step that are no calls, in their order. */
enum { MPS__SEARCH, MPS__UNDO, MPS__OPEN, MPS__LIMITS, MPS__COMMIT, MPS__OUTSIDE };

/* A verb or a pass in its place. */
typedef struct mps__call {
    const char *name;        /* of the model or the pass */
    const mps__model *model; /* NULL: a pass */
    const mps_verb *verb;
    const mps__pass *pass; /* NULL: a verb */
    int32_t hook, use_count;
    const mps_use *uses;
    /* of each use; from MPS__CHANNELS on fields of the particles; -1: missing, as it may be */
    int32_t channel[MPS__USES];
    uint64_t begins; /* bits of the channels of models that get their first values before it */
    mps__cost cost;
} mps__call;

typedef struct mps__plan {
    const mps__pass *const *passes; /* of the library, in their order */
    int32_t pass_count;
    int64_t noted;   /* of which it was told what is missing; -1: none */
    int64_t changes; /* those of the models that it was made for; -1: none */
    int32_t begin[MPS_HOOK_COUNT + 1];
    mps__call call[MPS__CALLS]; /* those of hook m: begin[m] .. begin[m+1]-1 */
    mps__cost outside[MPS__OUTSIDE];
} mps__plan;

void mps__plan_init(mps__plan *p, const mps__pass *const *passes, int32_t count);
/* Make the plan of the active models, unless it is made. MPS_E_STATE: a channel that no model
 * brings, or verbs that wait for each other. */
mps_status mps__plan_make(mps__plan *p, const mps__models *m);
/* Log a warning for each part of the scheme that no active model does: once after models changed. */
void mps__plan_note(mps__plan *p, const mps__models *m);
/* Costs begin again at zero. */
void mps__plan_clear_costs(mps__plan *p);
/* Entry `index` of a step with all its parts: *call, or NULL and *part = MPS__SEARCH .. MPS__COMMIT. False: beyond the last. */
bool mps__plan_entry(const mps__plan *p, int32_t index, const mps__call **call, int *part);
/* Name of a part, e.g. "search". */
const char *mps__part_name(int part);
/* Name of a hook, e.g. "force". */
const char *mps__hook_name(int32_t hook);
/* Whether a verb of an active model writes a channel. */
bool mps__plan_has_writer(const mps__plan *p, int32_t channel);
/* Whether a call that may fail, or one before it, writes a field of the particles. */
bool mps__plan_writes(const mps__plan *p, mps__channels *c, mps__particles *s,
                      const mps__field *field);

/* Channels that mps_flux shows; -1: no model brings it. */
enum { MPS__FLUX_CHANNELS = 5 };
void mps__flux_channels(const mps__channels *c, int32_t channel[MPS__FLUX_CHANNELS]);

/* ---- lives.c ---- */

/* Which channels begin before which call, and their places in the arena: those that do not live at the same time may overlap. */
void mps__lives_make(mps__plan *p, mps__channels *c);

#endif
