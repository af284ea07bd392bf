/* SPDX-License-Identifier: BSD-3-Clause */
/* Registered models, active models, and their settings. */
#ifndef MPS_CORE_MODELS_H
#define MPS_CORE_MODELS_H

#include "channels.h"
#include <mps/model.h>

enum {
    MPS__MODELS_KNOWN = 64,
    MPS__MODELS_ACTIVE = 32,
    MPS__SETTINGS = 16,
    MPS__BROUGHT = 8,
    MPS__VERBS = 16,
    MPS__USES = 24
};

/* Numbers of a model that belong to no particle (its state). */
typedef struct mps__numbers {
    double *value;
    int64_t count, capacity;
    bool touched; /* a verb of the step may have changed them */
    double *kept; /* values before the step */
    int64_t kept_count, kept_capacity;
} mps__numbers;

typedef struct mps__model {
    const mps_model_ops *ops; /* in the registry */
    void *self;
    double k[MPS__SETTINGS];
    mps__numbers state;
} mps__model;

typedef struct mps__models {
    mps__context *context;
    mps__particles *particles; /* store of the models' fields */
    mps__channels *channels;
    int32_t known, active, built_in; /* the first `built_in` known models are built in */
    int64_t changes;                 /* incremented when models are activated or deactivated */
    mps_model_ops registry[MPS__MODELS_KNOWN];
    char name[MPS__MODELS_KNOWN][MPS__NAME_SIZE];
    mps__model on[MPS__MODELS_ACTIVE]; /* in the order of the registry */
} mps__models;

/* Register the built-in models, none active. Channels and particles are those of the handle. */
mps_status mps__models_init(mps__models *m, mps__context *context, mps__channels *channels,
                            mps__particles *particles);
void mps__models_free(mps__models *m);
mps_status mps__models_register(mps__models *m, const mps_model_ops *ops);
mps_status mps__models_use(mps__models *m, const char *name);
mps_status mps__models_preset(mps__models *m, const char *name);
mps_status mps__models_remove(mps__models *m, const char *slot);
/* Whether an active model is a plug-in. */
bool mps__models_foreign(const mps__models *m, const mps__model *model);
/* Whether an active model reads rows of dummies. */
bool mps__models_dummy_rows(const mps__models *m);
/* Whether an active model reads rows of neighbours. */
bool mps__models_neighbour_rows(const mps__models *m);
/* Whether an active model moves solids in the tank. */
bool mps__models_move_solids(const mps__models *m);
/* Largest distance at which an active model reads particles, if it declares one; else 0 [m]. */
double mps__models_reach(const mps__models *m, double dp);
/* The setting `key` of the model in a slot; NULL with the error set. `setting` may be NULL. */
double *mps__models_value(mps__models *m, const char *slot, const char *key,
                          const mps_setting **setting);
/* The numbers of the model in a slot. MPS_E_NAME */
mps_status mps__models_state(mps__models *m, const char *slot, const mps__numbers **state);
/* Resize to `count` numbers: existing values stay, new ones are 0. model_state.c */
mps_status mps__numbers_resize(mps__context *c, mps__numbers *s, int64_t count);
void mps__numbers_free(mps__context *c, mps__numbers *s);
/* At the start of a step; after a failed step: restore the numbers of all active models. */
void mps__models_keep(mps__models *m);
void mps__models_restore(mps__models *m);
/* First active model with a non-finite number, or NULL; `place`: index of the number. */
const mps__model *mps__models_not_finite(const mps__models *m, int64_t *place);
/* Preset number k; false if k is too large. */
bool mps__models_preset_info(int32_t k, const char **name, const char **help);
/* Whether `slot`, a slot or a full name, is the slot of `name`. */
bool mps__same_slot(const char *name, const char *slot);

#endif
