/* SPDX-License-Identifier: BSD-3-Clause */
/* One step in progress, and its parts beside the flow in step.c. */
#ifndef MPS_CORE_STEP_H
#define MPS_CORE_STEP_H

#include "budget.h"

/* ---- what other rooms call ---- */

/* One step, undone if it fails. step.c */
mps_status mps__world_step(mps__world *w, double dt_max);
/* What velocities relative to the tank in a pose, pressures and places are like. */
typedef struct mps__outcome {
    double fastest; /* speed [m/s] */
    double
        failed; /* negative of the least id of what is not finite or too fast; -INFINITY: all are sound */
} mps__outcome;
/* Known after mps__host_settle(). moves.c */
void mps__world_ask_result(mps__world *w, const mps_view *s, const mps__pose *pose,
                           mps__outcome *v);
/* Fail for what is not finite or too fast, with the particle and its place before it moved, if it `has_moved`. Sets the largest speed of `info`. moves.c */
mps_status mps__world_check_result(mps__world *w, const mps_view *s, bool has_moved,
                                   const mps__outcome *v, mps_step_info *info);
/* Whether fluid may move farther in a step than it should; fluid that passes a wall in a step of dt that ends at a pose; the places before it, where loops run, are `before`. moves.c */
bool mps__world_may_jump(const mps__world *w);
mps_status mps__world_check_moves(mps__world *w, const mps__pose *next, const double *before,
                                  double dt);
/* The step to take, in s->dt; `planned` is the one the limits chose, 0 if the caller cut it. They also differ where the last steps of a run
 * share what is left of it, so that none is a sliver: pressures of a tank that accelerates jump with dt, by half of its change. Rounding is
 * not something left. limits.c */
mps_status mps__world_limit_step(mps__world *w, mps_stage *s, mps_view *v, double dt_max,
                                 double *planned, const char **name);
/* Fail with `refusal` where a motion carries the tank farther. moves.c */
mps_status mps__world_check_pose(const mps__world *w, const mps__motion *m, const mps__pose *pose,
                                 mps_status refusal);
/* Farthest way [m] of the walls from the present pose to another, and of the fluid as they see it if it keeps its velocity for dt; there after
 * mps__host_settle(). moves.c */
void mps__world_way_of_walls(mps__world *w, const mps__pose *pose, double dt, double *way);

/* ---- a step in progress ---- */

/* Momentum of the liquid, its moment about a place, mass, and mass times arm. */
enum { MPS__MOMENTUM = 10 };

/* Columns of the added mass that a step finds: which of the degrees of freedom of mps__step_freedom(), in ascending order. */
typedef struct mps__mass_columns {
    int32_t count, degree[6];
} mps__mass_columns;

/* What one step carries along; committed to the world only when all went well. */
typedef struct mps__step {
    mps__world *w;
    mps_stage stage;
    mps_view view; /* of the stage */
    mps_flux flux; /* that of the view from MPS_FORCE on */
    mps__ppe_terms terms;
    mps__pose pose; /* of the tank at the end of the step */
    mps_step_info info;
    mps__budget budget;
    double momentum[3];   /* of the prediction */
    mps__bulk bulk;       /* of the velocities that were booked last */
    mps__bulk last;       /* at the end */
    mps__outcome outcome; /* likewise */
    double speeds[2];     /* squares, for the crossing time; */
    bool nearly;          /* of pieces nearly as fast as the one before only */
    double ahead[MPS__AHEADS];
    double body_work;      /* of solids that models move */
    double lift;           /* potential energy lost by displacements */
    mps__push before_line; /* what was so before the verbs of `line` in the hook in progress */
    int32_t line;          /* of the budget, of the last call: MPS__LINE_..., */
    int32_t line_hook;     /* in this hook */
    mps__reaction reaction[1 + MPS__PARTS_MAX];
    mps__jump jump;
    double deviation;     /* mean volume deviation */
    double setup_seconds; /* of the solver */
    double spread;        /* time that a gain below 1 spreads pressures over [s] */
    bool not_converged;
    double momentum_before[MPS__MOMENTUM]; /* of the liquid at the beginning */
    mps__load load;
    mps__mass_columns columns;
    mps__body_state body; /* of the body that carries the tank, at the end */
    double felt[6];       /* load of the liquid that it felt, of this step alone */
    const double *before; /* positions before particles moved; NULL: they have not */
} mps__step;

/* ---- passes.c: all passes, in their order within a hook ---- */

extern const mps__pass *const mps__step_passes[];
extern const int32_t mps__step_pass_count;

/* The step that a pass belongs to. */
static inline mps__step *mps__step_of(const mps_stage *s)
{
    return s->self;
}

/* ---- the stage: step_stage.c ---- */

/* What verbs see, and where the channels of the library are. */
void mps__step_open(mps__step *q);
/* Run the calls of a hook. */
mps_status mps__step_run(mps__step *q, int32_t hook);
/* Number density and asymmetry at the present positions, and the volume deviation; first values of what lives for a step. */
extern const mps__pass mps__pass_weights, mps__pass_volumes, mps__pass_first_values;
/* First values of the pressure equation. */
extern const mps__pass mps__pass_clear_equation, mps__pass_first_conditions;

/* ---- the tank: step_tank.c ---- */

/* Room for area vectors of the walls at the beginning of the step; the vectors, where the loops of the step run. */
mps_status mps__step_turn_areas(mps__world *w);
void mps__step_find_areas(mps__world *w);
/* Where the channels "solid_place" and "solid_area" are in this step; and after it. */
mps_status mps__step_place_solids(mps__world *w);
void mps__step_keep_places(mps__world *w, const double *place, const double *area);
/* Velocities of the solids over this step and accelerations of the tank; whether its velocity jumped. */
extern const mps__pass mps__pass_tank, mps__pass_jump;
/* Whether it jumps, by accelerations of all particles; may be asked again. Known after mps__host_settle(). */
void mps__step_note_jump(mps_stage *s, const double *acceleration);

/* ---- the fluid: step_fluid.c ---- */

/* Near rows of the neighbours. */
extern const mps__pass mps__pass_neighbours;
/* u* = u + dt (a + g); u = u* + dt a(p); r = r + dt u + shift. Z14 (9)(12)(13). */
extern const mps__pass mps__pass_clear_forces, mps__pass_predict, mps__pass_clear_gradient,
    mps__pass_first_loads, mps__pass_push, mps__pass_clear_displacement, mps__pass_move,
    mps__pass_check, mps__pass_share, mps__pass_keep;

/* ---- a body that carries the tank: step_body.c ---- */

/* Where the accelerations of the step carry the tank: a motion, user: the world. */
int mps__body_motion(void *user, double t, mps_motion_state *state);
static inline bool mps__body_carries(const mps__world *w)
{
    return w->motion.fn == mps__body_motion;
}
/* With accelerations of the last step all pressures are known: the step gets those of the body. */
extern const mps__pass mps__pass_body;
void mps__step_body_end(mps__step *q);

/* ---- what the resolution contains: crossing.c ---- */

/* mps_step_info.crossing_time, from the speeds at the end of the step; on a device all are known after mps__host_settle(). */
extern const mps__pass mps__pass_crossing;
void mps__step_crossing_end(mps_stage *s);

/* ---- the pressures: step_pressure.c ---- */

/* <lap p> = source: sources, equation and solution. W22 (10). */
extern const mps__pass mps__pass_equation, mps__pass_matrix, mps__pass_unknowns, mps__pass_solve,
    mps__pass_pressures;

/* ---- the load of the liquid: step_load.c; its added mass: step_mass.c ---- */

/* Before velocities change; in MPS_LOAD; when all has been done. */
extern const mps__pass mps__pass_begin_load, mps__pass_half_cells;
void mps__step_load_close(mps__step *q); /* velocities are those at the end */
void mps__step_load_end(mps__step *q);
/* What a load is found from, arrays of a stage. */
typedef struct mps__load_arrays {
    const double *acceleration, *tank, *density;
    const int32_t *region;
} mps__load_arrays;
/* The load of the step if velocities get these accelerations, and nothing else happens to them. */
void mps__step_load_now(mps_stage *s, const mps__load_arrays *a, double force[6]);
/* Change of the velocity of the tank over dt, of its centre and angular. */
void mps__step_acceleration(const mps__step *q, double accel[6]);
/* Before the matrix of the step is made; right after the solution of its equation; when all has been done. */
mps_status mps__step_mass_begin(mps__step *q);
mps_status mps__step_mass(mps__step *q);
void mps__step_mass_end(mps__step *q);
/* The degrees of freedom of the tank: x, y and the rotation about z in 2-D. Returns how many. */
int32_t mps__step_freedom(int32_t dim, int32_t freedom[6]);

/* ---- the books: step_books.c ---- */

/* What others have done to the fluid since the last step. Fails where its energy overflows: that could never be taken away again. */
mps_status mps__step_book_between(mps__world *w);
/* What verbs of MPS_FORCE or MPS_VELOCITY with a line of their own, q->line, do: call it before and after them. */
void mps__step_book_line(mps__step *q, bool after);
/* What force models and gravity are about to do; what pressures, collisions and displacements have done; drops stopped at plates. */
extern const mps__pass mps__pass_book_forces, mps__pass_book_pressure, mps__pass_book_collisions,
    mps__pass_book_reactions, mps__pass_book_shift, mps__pass_plates;

#endif
