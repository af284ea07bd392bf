/* SPDX-License-Identifier: BSD-3-Clause */
/* The model of temperature through the kit of models. */
#include "temperature.h"
#include <model_kit.h>
#include <mps/mps.h>

/* Temperatures that differ, a law of viscosity and warm walls: all parts of the model act. */
static mps_status prepare(void *user, mps_sim *sim)
{
    const int64_t *id;
    mps_lease temperature;
    (void)user;
    mps_model_set(sim, "temperature", "kappa", 1e-3);
    mps_model_set(sim, "temperature", "arrhenius", 500);
    mps_model_set(sim, "temperature", "adiabatic", 0);
    mps_particles_tags(sim, &id, NULL, NULL, NULL);
    const mps_status status = mps_lease_begin(sim, "temperature", MPS_WRITE, &temperature);
    if (status < 0) return status;
    for (int64_t i = 0; i < temperature.count; i++) temperature.data[i] = 280 + (double)(id[i] % 37);
    return mps_lease_end(sim, &temperature);
}

int main(void)
{
    return kit_check_model(&temperature_conduction, prepare, NULL) != 0;
}
