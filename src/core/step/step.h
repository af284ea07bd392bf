/* SPDX-License-Identifier: BSD-3-Clause */
/* The step in progress, and its parts besides step.c.
 * W22: Wen, Zhao & Wan 2022. Z14: Zhang, Wan & Hino 2014. */
#ifndef MPS_CORE_STEP_H
#define MPS_CORE_STEP_H

#include "budget.h"

/* ---- for other modules ---- */

/* One step, undone if it fails. step.c */
mps_status mps__world_step(mps__world *w, double dt_max);
/* Fail with `refusal` if a motion moves the tank farther than MPS__FARTHEST. moves.c */
mps_status mps__world_check_pose(const mps__world *w, const mps__motion *m, const mps__pose *pose,
                                 mps_status refusal);

/* ---- a step in progress ---- */

/* Momentum of the liquid, its moment about a point, mass, and mass times arm. */
enum { MPS__MOMENTUM = 10 };

/* Columns of the added mass that a step computes, as indices into mps__step_freedom(), in ascending
 * order. */
typedef struct mps__mass_columns {
    int32_t count, degree[6];
} mps__mass_columns;

/* Result of a step: velocities relative to the tank, pressures and positions. */
typedef struct mps__outcome {
    double fastest; /* speed [m/s] */
    /* negative of the least id of a particle that is not finite or too fast; -INFINITY: none */
    double failed;
} mps__outcome;

typedef struct mps__step {
    mps__world *w;
    /* What a successful step hands over: it replaces the state of the world. Until then
     * w->state and w->motion.now are those at the beginning. */
    mps__state next;
    mps__pose pose; /* of the tank at the end of the step */
    mps_step_info info;
    mps__load load;
    mps__body_state body; /* of the body that carries the tank, at the end */
    mps__next_flags next_flags;
    /* work of the step */
    mps_stage stage;
    mps_view view; /* of the stage */
    mps_flux flux; /* flux of the view from MPS_FORCE on */
    mps__ppe_terms terms;
    double momentum[3];    /* of the prediction */
    mps__bulk bulk;        /* for the velocities at the last entry in the budget */
    mps__outcome outcome;  /* at the end */
    double speeds[2];      /* squares, for the crossing time */
    bool nearly;           /* search only pieces nearly as fast as the previous one */
    double body_work;      /* of solids that models move */
    double lift;           /* potential energy lost by displacements */
    mps__push before_line; /* values before the verbs of `line` in the present hook */
    int32_t line;          /* budget line of the last call: MPS__LINE_... */
    int32_t line_hook;     /* hook of that call */
    double setup_seconds;  /* of the solver */
    bool not_converged;
    double momentum_before[MPS__MOMENTUM]; /* of the liquid at the beginning */
    mps__mass_columns columns;
    double felt[6];       /* load of the liquid that the body has received in this step */
    const double *before; /* positions before particles moved; NULL: they have not moved yet */
    bool kept;            /* the fields have backup copies */
    double begin;         /* by mps__clock() [s] */
} mps__step;

/* ---- passes.c: all passes, in their order within a hook ---- */

extern const mps__pass *const mps__step_passes[];
extern const int32_t mps__step_pass_count;

/* The step that a pass belongs to. */
static inline mps__step *mps__step_of(const mps_stage *s)
{
    return s->self;
}

/* ---- the transaction around a step: transaction.c ---- */

/* Begin the step; a failure leaves nothing to undo. */
mps_status mps__step_begin(mps__step *q);
/* Back up the state, after the particles were sorted: from here on all changes can be undone. */
mps_status mps__step_keep(mps__step *q);
/* Commit the step, or undo it if `status` is negative. @return the status of the step */
mps_status mps__step_end(mps__step *q, mps_status status);

/* ---- limits and checks: limits.c, moves.c ---- */

/* Set the length of the step, q->view.dt. If the last steps of a run share the remaining time
 * equally, it is less than the limits allow, so that no step is tiny: pressures of an accelerated
 * tank jump with dt, by half of its change. A remainder within rounding is ignored. */
mps_status mps__step_limit(mps__step *q, double dt_max);
/* Largest displacement [m] of the walls from the present pose to another, and of the fluid relative
 * to them if it keeps its velocity for dt. Deferred: valid after mps__runner_flush(). */
void mps__world_way_of_walls(mps__world *w, const mps__pose *pose, double dt, double *way);
/* Set q->outcome. Deferred: valid after mps__runner_flush(). */
void mps__step_ask_result(mps__step *q);
/* Fail if a value is not finite or too fast, with the particle and its position before it moved, if
 * it `has_moved`. Sets the largest speed of q->info. */
mps_status mps__step_check_result(mps__step *q, bool has_moved);
/* Whether fluid may move too far in a step; check for fluid that passes a wall. `before`: the
 * positions before the step, in the memory space of the loops. */
bool mps__world_may_jump(const mps__world *w);
mps_status mps__step_check_moves(mps__step *q, const double *before);

/* ---- the stage: step_stage.c ---- */

/* Set up the arrays of the step, on a device too, then the stage and its view. */
mps_status mps__step_open(mps__step *q);
/* Run the calls of a hook. */
mps_status mps__step_run(mps__step *q, int32_t hook);
/* Number density and asymmetry at the present positions, and the volume deviation; first values of
 * the channels of a step. */
extern const mps__pass mps__pass_weights, mps__pass_volumes, mps__pass_first_values;
/* First values of the pressure equation. */
extern const mps__pass mps__pass_clear_equation, mps__pass_first_conditions;

/* ---- the tank: step_tank.c ---- */

/* Allocate area vectors of the walls at the beginning of the step; compute them, in the memory
 * space of the loops. */
mps_status mps__step_rotate_areas(mps__world *w);
void mps__step_find_areas(mps__world *w);
/* Arrays of the channels "solid_place" and "solid_area" in this step; copy them to the particles
 * after it. */
mps_status mps__step_place_solids(mps__world *w);
void mps__step_keep_places(mps__world *w, const double *place, const double *area);
/* Velocities of the solids over this step and accelerations of the tank; jumps of its velocity. */
extern const mps__pass mps__pass_tank, mps__pass_jump;
/* Whether the tank's velocity jumps, by accelerations of all particles; may be called again.
 * Deferred: valid after mps__runner_flush(). */
void mps__step_note_jump(mps_stage *s, const double *acceleration);

/* ---- the fluid: step_fluid.c ---- */

/* Near rows of the neighbours. */
extern const mps__pass mps__pass_neighbours;
/* u* = u + dt (a + g); u = u* + dt a(p); r = r + dt u + shift. Z14 (9)(12)(13). */
extern const mps__pass mps__pass_clear_forces, mps__pass_predict, mps__pass_clear_gradient,
    mps__pass_first_loads, mps__pass_push, mps__pass_clear_displacement, mps__pass_move,
    mps__pass_check, mps__pass_exchange, mps__pass_keep;

/* ---- a body that carries the tank: step_body.c ---- */

/* The motion by the accelerations of the step: an mps_motion_fn, user: the world. */
int mps__body_motion(void *user, double t, mps_motion_state *state);
static inline bool mps__body_carries(const mps__world *w)
{
    return w->motion.fn == mps__body_motion;
}
/* When all pressures for the accelerations of the last step are known: correct them for those of
 * the body. */
extern const mps__pass mps__pass_body;
void mps__step_body_end(mps__step *q);

/* ---- the crossing time: crossing.c ---- */

/* mps_step_info.crossing_time, from the speeds at the end of the step; on a device the speeds are
 * valid after mps__runner_flush(). */
extern const mps__pass mps__pass_crossing;
void mps__step_crossing_end(mps_stage *s);

/* ---- the pressures: step_pressure.c ---- */

/* <lap p> = source: sources, equation and solution. W22 (10). */
extern const mps__pass mps__pass_equation, mps__pass_matrix, mps__pass_unknowns, mps__pass_solve,
    mps__pass_pressures;

/* ---- the load of the liquid: step_load.c; its added mass: step_mass.c ---- */

/* Before velocities change; in MPS_LOAD; at the end of the step. */
extern const mps__pass mps__pass_begin_load, mps__pass_half_cells;
void mps__step_load_close(mps__step *q); /* velocities are those at the end */
void mps__step_load_end(mps__step *q);
/* Arrays of a stage for the load. */
typedef struct mps__load_arrays {
    const double *acceleration, *tank, *density;
    const int32_t *region;
} mps__load_arrays;
/* The load of the step if velocities change by these accelerations, and by nothing else. */
void mps__step_load_now(mps_stage *s, const mps__load_arrays *a, double force[6]);
/* Change of the tank's velocity over dt, of its centre and angular. */
void mps__step_acceleration(const mps__step *q, double accel[6]);
/* Before the matrix of the step is assembled; after the solution of its equation; at the end of the
 * step. */
mps_status mps__step_mass_begin(mps__step *q);
mps_status mps__step_mass(mps__step *q);
void mps__step_mass_end(mps__step *q);
/* The degrees of freedom of the tank: x, y and the rotation about z in 2-D. Returns their
 * number. */
int32_t mps__step_freedom(int32_t dim, int32_t freedom[6]);

/* ---- the budget: step_books.c ---- */

/* Add changes of the fluid by others since the last step. Fails if its energy overflows: that could
 * never be subtracted again. */
mps_status mps__step_book_between(mps__world *w);
/* Effect of verbs of MPS_FORCE or MPS_VELOCITY with a line of their own, q->line: call it before
 * and after them. */
void mps__step_book_line(mps__step *q, bool after);
/* Predicted effect of force models and gravity; effects of pressures, collisions and displacements;
 * droplets stopped at plates. */
extern const mps__pass mps__pass_book_forces, mps__pass_book_pressure, mps__pass_book_collisions,
    mps__pass_book_reactions, mps__pass_book_shift, mps__pass_plates;

#endif
