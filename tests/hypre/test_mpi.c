/* SPDX-License-Identifier: BSD-3-Clause */
/* A program that runs MPI itself: libmps_hypre neither initialises nor finalises it, and reports an
 * error after MPI_Finalize(). */
#include <mpi.h>
#include <mps/hypre.h>
#include <stdio.h>
#include <string.h>

static int failures;

static void expect(int met, const char *what)
{
    if (met) return;
    failures++;
    printf("not so: %s\n", what);
}

int main(void)
{
    char error[128] = "";
    int over = 1;
    mps_hypre_settings settings;
    mps_solver_ops ops;
    expect(MPI_Init(NULL, NULL) == MPI_SUCCESS, "MPI starts");
    expect(mps_hypre_settings_init(&settings, sizeof settings) == MPS_OK, "settings");
    settings.error = error;
    settings.error_size = sizeof error;
    expect(mps_hypre_solver(&settings, &ops) == MPS_OK, "the solver is there");
    expect(ops.user == &settings, "the table leads to the settings");
    MPI_Finalized(&over);
    expect(!over, "MPI is not ended by the library");
    expect(MPI_Finalize() == MPI_SUCCESS, "the program ends MPI");
    expect(mps_hypre_solver(&settings, &ops) == MPS_E_STATE, "no solver without MPI");
    expect(strstr(error, "MPI has ended already") != NULL, "the text says why");
    return failures;
}
