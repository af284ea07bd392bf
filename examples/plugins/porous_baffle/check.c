/* SPDX-License-Identifier: BSD-3-Clause */
/* Test the porous baffle with the kit of models. */
#include "baffle.h"
#include <model_kit.h>
#include <mps/mps.h>

/* A baffle over the whole domain of the scenes of the kit, so that it is active in each. */
static mps_status prepare(void *user, mps_sim *sim)
{
    (void)user;
    if (mps_model_set(sim, "baffle", "from", -10) < 0) return MPS_E_NAME;
    if (mps_model_set(sim, "baffle", "to", 10) < 0) return MPS_E_NAME;
    return mps_model_set(sim, "baffle", "darcy", 2.0);
}

int main(void)
{
    return kit_check_model(&baffle_porous, prepare, NULL) != 0;
}
