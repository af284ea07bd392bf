/* SPDX-License-Identifier: BSD-3-Clause */
/* Test the temperature model with the kit of models. */
#include "temperature.h"
#include <math.h>
#include <model_kit.h>
#include <mps/mps.h>

/* Non-uniform temperatures, a law of viscosity and warm walls: all parts of the model are
 * active. */
static mps_status prepare(void *user, mps_sim *sim)
{
    mps_lease x = {.struct_size = sizeof x}, temperature = {.struct_size = sizeof temperature};
    (void)user;
    if (mps_model_set(sim, "temperature", "kappa", 1e-3) < 0 ||
        mps_model_set(sim, "temperature", "arrhenius", 500) < 0 ||
        mps_model_set(sim, "temperature", "adiabatic", 0) < 0)
        return MPS_E_NAME;
    mps_status status = mps_lease_begin(sim, "position", MPS_READ, &x);
    if (status < 0) return status;
    status = mps_lease_begin(sim, "temperature", MPS_WRITE, &temperature);
    for (int64_t i = 0; status >= 0 && i < temperature.count; i++)
        temperature.data[i] = 300 + 20 * sin(20 * x.data[i * x.stride]);
    mps_lease_end(sim, &x);
    return status < 0 ? status : mps_lease_end(sim, &temperature);
}

int main(void)
{
    return kit_check_model(&temperature_conduction, prepare, NULL) != 0;
}
