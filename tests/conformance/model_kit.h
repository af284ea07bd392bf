/* SPDX-License-Identifier: BSD-3-Clause */
/* Conformance kit of models. It runs a model in small tanks and reports violated rules of
 * <mps/model.h>. Needs libmps and the C library with threads. It writes small checkpoint files to
 * the working folder and removes them. It is not thread-safe.
 *
 * A verb runs more than once per step, on copies of its arrays, except in MPS_POPULATE, where
 * particles would be added twice: it may depend on its stage and its channels only. A model whose
 * result depends on a counter in `self` fails.
 *
 * Without a failure the kit prints on stdout in which scenes the model ran, and which of its verbs
 * changed nothing there and so were not tested. */
#ifndef MODEL_KIT_H
#define MODEL_KIT_H

#include <mps/model.h>

MPS_BEGIN_DECLS

/* Checks; kit_check_model() returns the sum of the failed ones. */
enum {
    /* Registration; help, units and keys exist; mps_model_info_get() lists the model. */
    KIT_TABLE = 1,
    /* Runs in at least one scene, and with finite fields in all scenes that accept it. A scene does
     * not accept it if the step returns MPS_E_STATE (a channel is missing) or MPS_E_PLUGIN. */
    KIT_RUN = 2,
    /* Runs with each setting at its smallest and its largest value, or reports why not. */
    KIT_SETTINGS = 4,
    /* Same bytes with 1, 2 and 4 threads. */
    KIT_THREADS = 8,
    /* Same result within rounding if the particles are added in another order. */
    KIT_ORDER = 16,
    /* A verb writes no channel that it only reads. */
    KIT_WRITES = 32,
    /* A channel used with MPS_USE_READ only affects its own row, not neighbours. Verbs that use
     * workspace are skipped: workspace may transfer values to neighbours. */
    KIT_OWN_ROW = 64,
    /* Values before a pure MPS_USE_WRITE do not matter. */
    KIT_WRITE_ONLY = 128,
    /* Each failure of an allocation is reported, and no memory leaks. */
    KIT_MEMORY = 256,
    /* Two handles in two threads give the same bytes as one. */
    KIT_HANDLES = 512,
    /* Checkpoint and resume give the same bytes as an uninterrupted run. */
    KIT_CHECKPOINT = 1024,
    /* It can be switched on and off between steps. */
    KIT_MIDRUN = 2048,
    /* Energy is finite and the momentum budget closes. */
    KIT_BUDGET = 4096,
    /* A verb adds to sums of several models and keeps what is in them: "acceleration" in MPS_FORCE
     * and MPS_GRADIENT, "displacement" in MPS_SHIFT, "pressure_source", "pressure_shift" and
     * "gas_shift" in MPS_SOURCE. A verb that has an entry `after` may depend on what is in them,
     * but may not overwrite it. */
    KIT_ADDS = 8192,
    /* A verb does not change "acceleration", "velocity" or "displacement" of walls and dummies. */
    KIT_SOLIDS = 16384,
    /* The same values give the same result: in two runs of a verb, and in two runs of a scene. If
     * two runs of a scene differ, KIT_THREADS, KIT_ORDER, KIT_CHECKPOINT and KIT_RANKS are
     * skipped. */
    KIT_REPEAT = 32768,
    /* At least one verb changes something in at least one scene: a channel, the limit of the time
     * step or a scalar of the pressure equation. Else nothing was tested. For a model that acts
     * only in states that the callback cannot make, take this bit out of the result. */
    KIT_ACTS = 65536,
    /* Same bytes on one rank and on two, which are threads (<mps/ranks.h>): all fields of all
     * particles after each step, in the 2-D scenes that accept the model and in the first one.
     * Usual reasons: its own loop over all rows, with ghosts, instead of mps_stage_sum(); workspace
     * read at neighbours without mps_stage_refresh(); a channel read at neighbours without
     * MPS_USE_NEIGHBOURS; reads beyond the far radius without mps_model_ops.reach; different calls
     * of mps_stage_... on the ranks. Skipped: scenes with a solver that works on one rank only. */
    KIT_RANKS = 131072
};

/* Called in each scene after the model is activated: change settings, write initial values of
 * fields, activate other models. Values must be functions of positions: ids differ between scenes.
 * MPS_E_STATE skips the scene; any other negative status fails the check. */
typedef mps_status (*kit_prepare_fn)(void *user, mps_sim *sim);

/* Run all checks. @param prepare  NULL, or the callback
 * @return 0, or the sum of KIT_... of failed checks. Each failure is printed on stderr, with its
 * reason; the last line names the checks that failed */
int kit_check_model(const mps_model_ops *ops, kit_prepare_fn prepare, void *user);

MPS_END_DECLS

#endif
