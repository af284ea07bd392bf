/* SPDX-License-Identifier: BSD-3-Clause */
/* Test the sponge layer with the kit of models. */
#include "sponge.h"
#include <model_kit.h>
#include <mps/mps.h>

/* A rate > 0, so that the model is active in the scenes of the kit. */
static mps_status prepare(void *user, mps_sim *sim)
{
    (void)user;
    return mps_model_set(sim, "sponge", "rate", 3.0);
}

int main(void)
{
    return kit_check_model(&sponge_layer, prepare, NULL) != 0;
}
