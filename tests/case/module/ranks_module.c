/* SPDX-License-Identifier: BSD-3-Clause */
/* A communication module without messages, for tests/case/test_ranks.c: rank 2 of 5; with
 * MPS_TEST_OLD in the environment, of another version. */
#include <mps/job.h>
#include <stdlib.h>

mps_status mps_drivers_mpi(mps_job_ranks *ranks);
mps_status mps_drivers_mpi(mps_job_ranks *ranks)
{
    if (getenv("MPS_TEST_OLD")) return MPS_E_VERSION;
    ranks->rank = 2;
    ranks->count = 5;
    return MPS_OK;
}
