/* SPDX-License-Identifier: BSD-3-Clause */
/* Available pressure solvers and preconditioners, and the selected pair. */
#ifndef MPS_CORE_SOLVERS_H
#define MPS_CORE_SOLVERS_H

#include "base.h"
#include "device.h"
#include <mps/ppe.h>
#include <mps/sim.h>

enum { MPS__SOLVERS_KNOWN = 16 };

typedef struct mps__solvers {
    mps__context *context;
    int32_t solvers, preconditioners;
    /* of these the built-in ones come first; built-in solvers check their own results */
    int32_t built_in_solvers, built_in_preconditioners;
    mps_solver_ops solver[MPS__SOLVERS_KNOWN];
    mps_preconditioner_ops preconditioner[MPS__SOLVERS_KNOWN];
    char solver_name[MPS__SOLVERS_KNOWN][MPS__NAME_SIZE];
    char preconditioner_name[MPS__SOLVERS_KNOWN][MPS__NAME_SIZE];
    /* default preconditioner of each solver */
    char default_name[MPS__SOLVERS_KNOWN][MPS__NAME_SIZE];
    const mps_solver_ops *use;        /* selected */
    const mps_preconditioner_ops *pc; /* selected, or NULL */
    void *use_self, *pc_self;
    const mps_preconditioner_ops
        *fallback; /* of `pc`, or NULL; its state is created on first use */
    void *fallback_self;
    bool fallback_made;
    mps_solver_limits limits;
    bool again; /* mps__effort.again of the present call */
    bool ready; /* the preconditioner is set up for the present series */
    /* of the step in progress; NULL: none. Used for solutions with device loops */
    mps__device *device;
    mps__device_block buffer; /* for equations copied to the device */
    /* it contains the arrays that all solutions of the present series share */
    bool sent;
    mps_ppe_hint hint; /* for solutions on the device */
    /* the equation being solved, and its copy on the device: a preconditioner may keep the address
     * during a series */
    mps_ppe_problem problem, sent_problem;
} mps__solvers;

/* Parameters of one solution in a series. */
typedef struct mps__effort {
    double looser; /* factor of the tolerances, >= 1 */
    /* not the first: rows and diagonal are those of the previous one, whose preconditioner is
     * reused */
    bool again;
} mps__effort;

/* Registers the built-ins, selects the first solver. */
mps_status mps__solvers_init(mps__solvers *s, mps__context *context);
void mps__solvers_free(mps__solvers *s);
mps_status mps__solvers_register(mps__solvers *s, const mps_solver_ops *ops);
mps_status mps__solvers_register_preconditioner(mps__solvers *s, const mps_preconditioner_ops *ops);
mps_status mps__solvers_use(mps__solvers *s, const char *solver, const char *preconditioner);
mps_status mps__solvers_set_limits(mps__solvers *s, const mps_solver_limits *limits);
/* Solve with the selected pair, to the limits of `s`, not those of `problem`. MPS_OK,
 * MPS_W_NOT_CONVERGED, or MPS_E_SOLVER / MPS_E_NOMEM with the numbers in the text. */
mps_status mps__solvers_solve(mps__solvers *s, const mps_ppe_problem *problem, double *p,
                              mps_ppe_result *result);
/* The solution itself: by the selected pair, and by the fallback if the preconditioner fails. */
void mps__solvers_run(mps__solvers *s, const mps_ppe_problem *problem, double *p,
                      mps_ppe_result *result);
mps_status mps__solvers_solve_series(mps__solvers *s, const mps_ppe_problem *problem,
                                     const mps__effort *effort, double *p, mps_ppe_result *result);

/* ---- on a device (solvers_device.c) ---- */

/* Whether solver and preconditioner support the device of the step; whether this equation is solved
 * on the device. */
bool mps__solvers_support_device(const mps__solvers *s);
bool mps__solvers_on_device(const mps__solvers *s, const mps_ppe_problem *problem);
/* Solve s->problem on the device. Its arrays and `p` are in the memory space of its parallel-for:
 * host or device. MPS_E_NOMEM, MPS_E_PLUGIN */
mps_status mps__solvers_solve_device(mps__solvers *s, double *p, mps_ppe_result *result);
/* Release the device memory; before the device is detached. */
void mps__solvers_release_device(mps__solvers *s, mps__device *d);

#endif
