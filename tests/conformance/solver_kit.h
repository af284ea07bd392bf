/* SPDX-License-Identifier: BSD-3-Clause */
/* Conformance kit of pressure solvers. It builds systems like those of MPS, solves them and reports
 * violated requirements of <mps/ppe.h>. Needs libmps and the C library with POSIX threads.
 *
 * The last check runs the tables in a small dam break on one rank and on two, which are threads.
 * With `ranks` 1 both solutions must agree to 1e-9; with `ranks` 0 the library must refuse the
 * table on two ranks. The other checks use the tables without registering them. */
#ifndef SOLVER_KIT_H
#define SOLVER_KIT_H

#include <mps/ppe.h>
#include <stdbool.h>

/* A system that owns its arrays, with its solution. */
typedef struct kit_system {
    mps_ppe_problem problem;
    int64_t *row;
    int32_t *col, *component;
    float *val;
    double *diagonal, *rhs, *shift, *weight, *x;
    double *exact; /* [n] solution, of mean zero over each singular component */
} kit_system;

/* Jittered lattices of particles in separate boxes. */
typedef struct kit_lattice {
    int dim, nx, ny, nz; /* particles along each side of a box; nz = 1 in 2-D */
    int boxes;           /* 1.. */
    /* the first `open` boxes have a free surface on top (Dirichlet), the others are singular */
    int open;
    double re;           /* kernel radius [dp] */
    double contrast;     /* density of the upper half of a box is 1000 / contrast */
    double compressible; /* fraction of the mean diagonal added to every row as a shift */
} kit_lattice;

/* NULL when out of memory. */
kit_system *kit_lattice_system(const kit_lattice *options);
/* A small system from dense rows [n*n]; rhs = A exact. */
kit_system *kit_dense_system(int n, const double *a, const double *exact);
void kit_system_free(kit_system *system);

/* An allocator that counts. It fails the fail_at-th allocation (1..; 0: never) and those after. */
typedef struct kit_memory {
    mps_allocator allocator;
    int64_t live, count, fail_at;
} kit_memory;

void kit_memory_init(kit_memory *memory);

/* One solution from p with fresh states. @return the solver's reason */
int kit_solve(const mps_solver_ops *solver, const mps_preconditioner_ops *pc, kit_memory *memory,
              const mps_ppe_problem *problem, double *p, mps_ppe_result *result);

/* A parallel-for that makes its threads anew at each call, for mps_ppe_problem.parallel. */
mps_parallel kit_parallel(int threads);

/* |a - b| / |b| */
double kit_difference(const double *a, const double *b, int64_t n);

/* Run all checks. @param pc NULL for none. 
 * @return number of failed checks; each is printed on stderr */
int kit_check_solver(const mps_solver_ops *solver, const mps_preconditioner_ops *pc);
/* Checks of a single preconditioner: linear, finite, no leak; symmetric and positive definite if
 * its table says so. */
int kit_check_preconditioner(const mps_preconditioner_ops *pc);

#endif
