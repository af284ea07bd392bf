/* SPDX-License-Identifier: BSD-3-Clause */
/* What the parts of mps_bench share. */
#ifndef MPS_BENCH_H
#define MPS_BENCH_H

#include <mps/mps.h>
#include <mps/ppe.h>
#include <stdbool.h>

enum { BENCH_LIST = 16, BENCH_NAME = 64 };

/* ---- measures (measures.c) ---- */

double bench_wall(void); /* monotonic [s] */
double bench_cpu(void);  /* of all threads of the process [s] */
double
bench_triad(void); /* a = b + s c on one thread, the best of several runs over 3 x 64 MiB [GB/s] */

/* An allocator that counts what is held. */
typedef struct bench_memory {
    size_t held, peak;
} bench_memory;
mps_allocator bench_allocator(bench_memory *memory);

/* ---- cases (cases.c) ---- */

/* "kind/dp in mm", e.g. "dam2d/2.5"; kinds are dam2d, dam3d, air2d, air3d, static2d, breaking, breaking_air. */
typedef struct bench_case {
    char name[BENCH_NAME];
    const struct bench_kind *kind;
    double dp; /* [m] */
} bench_case;

/* NULL, or what is wrong with the name. */
const char *bench_case_find(const char *name, bench_case *c);
/* A simulation at t = 0; what fails is printed and ends the program. */
mps_sim *bench_case_make(const bench_case *c, int32_t threads, double re_far, bench_memory *memory);

/* ---- systems (systems.c) ---- */

/* A solver "bench.record" that writes each pressure equation it is given to the file, over the one before, and leaves the solution to
 * sundials.pcg with the preconditioner. */
void bench_record(mps_sim *sim, const char *file);
/* Register what a plug-in library brings, if the name of the solver asks for one. */
void bench_plugin(mps_sim *sim, const char *pair);
/* Solve the equation of a file by "solver/preconditioner" `repeats` times and print the least times. */
int bench_replay(const char *file, const char *pair, int32_t threads, double tolerance,
                 int repeats);

_Noreturn void bench_fail(const char *what, const char *why);

#endif
