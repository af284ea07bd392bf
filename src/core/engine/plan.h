/* SPDX-License-Identifier: BSD-3-Clause */
/* A step as an ordered list of calls: passes of the library and verbs of the active models. The
 * memory plan (live ranges of channels, shared memory) is computed here once from their declared
 * uses. */
#ifndef MPS_CORE_PLAN_H
#define MPS_CORE_PLAN_H

#include "models.h"

enum { MPS__CALLS = 160 };

/* Position of a pass in its hook. */
enum {
    MPS__BEFORE_MODELS,
    MPS__AFTER_MODELS,
    MPS__LAST_OF_STEP /* after everything that may fail: its writes need no restore */
};

/* A pass of the library. */
typedef struct mps__pass {
    const char *name;
    int32_t hook, place;
    int32_t stage; /* MPS_STAGE_... of its time */
    /* loops include ghosts: ghost results are valid if the inputs are */
    bool with_ghosts;
    bool undeclared; /* it writes fields of particles that its uses do not declare */
    /* its loops access only the view and the arrays of its uses: they may run on a device */
    bool device;
    int32_t use_count;
    const mps_use *uses;
    mps_status (*run)(mps_stage *s);
    /* nothing to do, on any rank: the pass is skipped, its uses are not prepared */
    bool (*idle)(const void *step);
} mps__pass;

/* Costs of calls since the plan was made or the costs were reset. */
typedef struct mps__cost {
    int64_t calls;
    double seconds, bytes; /* of the declared arrays */
} mps__cost;

/* Parts of a step outside of calls, in order. */
enum { MPS__SEARCH, MPS__UNDO, MPS__OPEN, MPS__LIMITS, MPS__COMMIT, MPS__OUTSIDE };

/* A verb or a pass of the plan. */
typedef struct mps__call {
    const char *name;        /* of the model or the pass */
    const mps__model *model; /* NULL: a pass */
    const mps_verb *verb;
    const mps__pass *pass; /* NULL: a verb */
    int32_t hook, use_count;
    const mps_use *uses;
    /* of each use; from MPS__CHANNELS on fields of the particles; -1: missing optional channel */
    int32_t channel[MPS__USES];
    uint64_t begins; /* bits of the models' channels that are initialised before it */
    mps__cost cost;
} mps__call;

typedef struct mps__plan {
    const mps__pass *const *passes; /* of the library, in order */
    int32_t pass_count;
    int64_t noted;   /* value of `changes` for which warnings were logged; -1: none */
    int64_t changes; /* mps__models.changes of the plan; -1: none */
    int32_t begin[MPS_HOOK_COUNT + 1];
    mps__call call[MPS__CALLS]; /* calls of hook m: begin[m] .. begin[m+1]-1 */
    mps__cost outside[MPS__OUTSIDE];
} mps__plan;

void mps__plan_init(mps__plan *p, const mps__pass *const *passes, int32_t count);
/* Make the plan of the active models, unless it is up to date. MPS_E_STATE: a channel that no model
 * provides, or a cyclic order of verbs. */
mps_status mps__plan_make(mps__plan *p, const mps__models *m);
/* Log a warning for each part of the scheme without an active model: once after each change of
 * models. */
void mps__plan_note(mps__plan *p, const mps__models *m);
/* Reset the costs. */
void mps__plan_clear_costs(mps__plan *p);
/* Entry `index` of a step with all its parts: *call, or NULL and *part = MPS__SEARCH ..
 * MPS__COMMIT. False: index too large. */
bool mps__plan_entry(const mps__plan *p, int32_t index, const mps__call **call, int *part);
/* Name of a part, e.g. "search". */
const char *mps__part_name(int part);
/* Name of a hook, e.g. "force". */
const char *mps__hook_name(int32_t hook);
/* Whether a verb of an active model writes a channel. */
bool mps__plan_has_writer(const mps__plan *p, int32_t channel);
/* Whether a call that may fail, or a call before it, writes a field of the particles. */
bool mps__plan_writes(const mps__plan *p, mps__channels *c, mps__particles *s,
                      const mps__field *field);

/* Channels that mps_flux reads; -1: no model provides it. */
enum { MPS__FLUX_CHANNELS = 5 };
void mps__flux_channels(const mps__channels *c, int32_t channel[MPS__FLUX_CHANNELS]);

/* ---- liveness.c ---- */

/* Memory plan: which channels are initialised before which call, and their offsets in the arena;
 * channels with disjoint live ranges may overlap. */
void mps__liveness_make(mps__plan *p, mps__channels *c);

#endif
