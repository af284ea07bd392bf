/* SPDX-License-Identifier: BSD-3-Clause */
/** @file reaction.h  For models: forces that solids without particles exert on the fluid.
 *
 *  A model that pushes fluid on behalf of a solid - a porous baffle, a screen, friction at walls -
 *  says so here. Then force probes and both budgets know of it.
 *
 *  mps_model_ops.parts names such solids, e.g. "baffle", 1..31 characters each. From
 *  mps_model_use() on they are parts, and force probes may name them. A part of the tank may have
 *  the same name. */
#ifndef MPS_REACTION_H
#define MPS_REACTION_H

#include <mps/model.h>

MPS_BEGIN_DECLS

/** Report how a solid pushes the fluid: a porous baffle, a screen, friction at walls. A verb of
 *  MPS_FORCE or MPS_VELOCITY calls it once for each solid, beside writing "acceleration" or
 *  "velocity", which it does not change. The force on the solid is -sum m_i acceleration_i, at the
 *  places of the fluid particles i, m_i = density dp^dim. The library
 *  - adds force and moment to force probes (MPS_PROBE_FORCE) of the part and of all solids, and to
 *    mps_momentum.reaction;
 *  - adds their work, with the velocity of the tank, to both works of the walls in mps_energy. The
 *    line of the model then has what is left: the energy dissipated.
 *  Without the call force probes do not show the push, and energy that it exchanges with the tank
 *  counts as lost in the model.
 *  @param part  a part of the tank, or one of mps_model_ops.parts. NULL: each row pushes the part
 *         of its nearest solid particle; without one within the far radius, the tank as a whole,
 *         which only probes of all solids show.
 *  @param acceleration  [n*dim] of fluid rows by this solid, mean over the step [m/s2]: a share of
 *         "acceleration", or in MPS_VELOCITY a change of velocity over dt. Other rows are not read.
 *  @return 0, or non-zero after a failure (the error is set): no such part, another hook, a sum
 *          that is not finite, no memory */
MPS_API int mps_stage_reaction(mps_stage *s, const char *part, const double *acceleration);

/** Report kinetic energy that the fluid has beside that of its particles, which a model knows: e.g.
 *  of a velocity profile across the width, of which a particle has the mean. A model calls it once
 *  in MPS_FORCE, with the energy at the beginning of the step, and once in MPS_VELOCITY, with the
 *  energy that it leaves. The library
 *  - shows the second in mps_energy.layers;
 *  - takes the difference off the line of the model, which then has what is dissipated;
 *  - books what changes between steps as mps_energy.added.
 *  @param kinetic  of all fluid, the same on all ranks, e.g. by mps_stage_sum(); >= 0 [J]
 *  @return 0, or non-zero after a failure (the error is set): another hook, negative, not finite */
MPS_API int mps_stage_kinetic(mps_stage *s, double kinetic);

MPS_END_DECLS

#endif
