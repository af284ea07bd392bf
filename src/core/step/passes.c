/* SPDX-License-Identifier: BSD-3-Clause */
/* The passes of a step, W22 section 2.5 and Fig. 2: predict, pressure equation, correct. Verbs of
 * models run between them, by their hooks.
 * W22: Wen, Zhao & Wan 2022. */
#include "step.h"

const mps__pass *const mps__step_passes[] = {
    /* MPS_MOTION */
    &mps__pass_tank, &mps__pass_jump,
    /* MPS_CLASSIFY: quantities at r^k */
    &mps__pass_neighbours, &mps__pass_weights, &mps__pass_volumes, &mps__pass_first_values,
    /* MPS_FORCE */
    &mps__pass_clear_forces, &mps__pass_begin_load, &mps__pass_book_forces, &mps__pass_predict,
    /* MPS_SOURCE */
    &mps__pass_clear_equation, &mps__pass_first_conditions, &mps__pass_equation, &mps__pass_matrix,
    &mps__pass_unknowns, &mps__pass_solve, &mps__pass_pressures,
    /* MPS_GRADIENT, MPS_LOAD */
    &mps__pass_clear_gradient, &mps__pass_body, &mps__pass_first_loads, &mps__pass_half_cells,
    &mps__pass_push, &mps__pass_book_pressure,
    /* MPS_VELOCITY, MPS_SHIFT */
    &mps__pass_book_collisions, &mps__pass_book_reactions, &mps__pass_clear_displacement,
    &mps__pass_book_shift, &mps__pass_move, &mps__pass_plates, &mps__pass_check,
    &mps__pass_exchange, &mps__pass_crossing, &mps__pass_keep};

const int32_t mps__step_pass_count = sizeof mps__step_passes / sizeof mps__step_passes[0];
