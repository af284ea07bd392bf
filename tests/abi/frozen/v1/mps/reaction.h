/* SPDX-License-Identifier: BSD-3-Clause */
/** @file reaction.h  For models: forces that solids without particles exert on the fluid.
 *
 *  A model that applies the force of a solid to the fluid - a porous baffle, a screen, friction at
 *  walls - reports it here. Force probes and both budgets then include it.
 *
 *  mps_model_ops.parts lists such solids, e.g. "baffle", 1..31 characters each. From
 *  mps_model_use() on they are parts, and force probes may refer to them. A part of the tank may
 *  have the same name. */
#ifndef MPS_REACTION_H
#define MPS_REACTION_H

#include <mps/model.h>

MPS_BEGIN_DECLS

/** Report the force of a solid on the fluid: a porous baffle, a screen, friction at walls. A verb
 *  of MPS_FORCE or MPS_VELOCITY calls it once for each solid, and writes "acceleration" or
 *  "velocity" itself: this function does not change them. The force on the solid is -sum m_i
 *  acceleration_i, at the positions of the fluid particles i, m_i = density dp^dim. The library
 *  - adds force and moment to force probes (MPS_PROBE_FORCE) of the part and of all solids, and to
 *    mps_momentum.reaction;
 *  - adds their work, with the velocity of the tank, to both works of the walls in mps_energy. The
 *    budget line of the model then has the rest: the dissipated energy.
 *  Without this call force probes do not include the force, and the energy that it exchanges with
 *  the tank counts as dissipated by the model.
 *  @param part  a part of the tank, or one of mps_model_ops.parts. NULL: the force of each row acts
 *         on the part of its nearest solid particle; without a solid particle within the far
 *         radius, on the tank as a whole, which only probes of all solids include.
 *  @param acceleration  [n*dim] of fluid particles by this solid, mean over the step [m/s2]: a part
 *         of "acceleration", or in MPS_VELOCITY a change of velocity over dt. Other particles are
 *         not read.
 *  @return 0, or non-zero after a failure (the error is set): no such part, another hook, a
 *          non-finite sum, no memory */
MPS_API int mps_stage_reaction(mps_stage *s, const char *part, const double *acceleration);

/** Report kinetic energy of the fluid that its particles do not have, e.g. of a velocity profile
 *  across the width of which a particle has the mean. A model calls it once in MPS_FORCE, with the
 *  energy at the beginning of the step, and once in MPS_VELOCITY, with the energy after the model.
 *  The library
 *  - shows the second in mps_energy.layers;
 *  - subtracts the difference from the budget line of the model, which then is the dissipated
 *    energy;
 *  - adds changes between steps to mps_energy.added.
 *  @param kinetic  of all fluid, the same on all ranks, e.g. by mps_stage_sum(); >= 0 [J]
 *  @return 0, or non-zero after a failure (the error is set): another hook, negative, not finite */
MPS_API int mps_stage_kinetic(mps_stage *s, double kinetic);

MPS_END_DECLS

#endif
