/* SPDX-License-Identifier: BSD-3-Clause */
/* Test the eddy viscosity with the kit of models. */
#include "eddy.h"
#include <model_kit.h>

int main(void)
{
    return kit_check_model(&eddy_smagorinsky, NULL, NULL) != 0;
}
