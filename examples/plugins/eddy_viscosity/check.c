/* SPDX-License-Identifier: BSD-3-Clause */
/* The eddy viscosity through the kit of models. */
#include "eddy.h"
#include <model_kit.h>

int main(void)
{
    return kit_check_model(&eddy_smagorinsky, NULL, NULL) != 0;
}
