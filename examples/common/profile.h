/* SPDX-License-Identifier: BSD-3-Clause */
/* Where the time of steps goes: the table of --profile. */
#ifndef MPS_EXAMPLES_PROFILE_H
#define MPS_EXAMPLES_PROFILE_H

#include <mps/mps.h>

/* Print a line for each pass of the steps since mps_profile_reset(), and their sum. @param measured  mps_step_info.seconds of these steps,
 * summed [s] */
void profile_print(mps_sim *sim, double measured);

#endif
