/* SPDX-License-Identifier: BSD-3-Clause */
/* Everything a time step works on. */
#ifndef MPS_CORE_WORLD_H
#define MPS_CORE_WORLD_H

#include "bounds.h"
#include "ghosts.h"
#include "host.h"
#include "motion.h"
#include "neighbours.h"
#include <math.h>
#include <mps/operators.h>
#include "particles.h"
#include "ppe.h"
#include <mps/probe.h>
#include <mps/step.h>

/* The state of the fluid as a whole. */
typedef struct mps__bulk {
    double kinetic, potential; /* potential: -m g.x [J] */
    double momentum[3];        /* [kg m/s] */
} mps__bulk;

/* Energies [J] and impulses since creation; see mps_energy and mps_momentum. */
typedef struct mps__budget {
    double wall_work, viscous, collision, shift, added;
    double start;          /* kinetic + potential before the first step */
    mps_momentum momentum; /* but for its `total` and `numerical` */
    mps__bulk last;        /* up to here all is booked: what the last step left */
    /* mean volume deviation of regions INNER and SECOND in the last step and the first */
    double deviation, deviation_start;
    int64_t started; /* 1: the first step has been made */
} mps__budget;

/* Arrays [n] or [n*dim] that live through one step. Those that verbs of models use are channels. */
typedef struct mps__work {
    int64_t capacity, turned_capacity;
    bool *gone; /* particles to be removed */
    double *tank_acceleration, *volume_deviation, *asymmetry, *pressure_density;
    double *turned;
    const double *area; /* wetted area vectors in the lab: in turned, or those of the particles */
    double *motion;     /* accelerations, then displacements */
    double *value, *source, *shift, *gas, *law; /* of the pressure equation; one block */
    int32_t *condition;                         /* of its rows */
    double *load;                               /* source: pressure on walls, from the load on */
    double *x0; /* shift: positions before particles move, from then on */
} mps__work;

/* When the velocity of the tank jumped last. */
typedef struct mps__jump {
    double accel;  /* largest |a| of the solids in the last step [m/s2] */
    int64_t since; /* steps */
} mps__jump;

/* What the user chose. The text of a checkpoint says it. */
typedef struct mps__setup {
    int32_t dim, lost_policy;
    double dp, g[3], velocity_scale, re_near, re_far, speed_limit;
    double domain_min[3], domain_max[3]; /* tank's frame */
    bool domain_given;
    mps_kernel kernel;
    bool phase_defined[MPS__PHASES];
    double phase_density[MPS__PHASES], phase_viscosity[MPS__PHASES];
    double tension[MPS__PHASES * MPS__PHASES]; /* < 0: not set */
    mps_time_control control;
    /* of dummies behind the walls, the fewest of all tanks and solids; 0: there is none */
    int32_t layers;
} mps__setup;

/* What the next step depends on, beside the fields of the particles, the motion and the probes. MPS__STATE lists all members: they
 * are stored in checkpoints. */
typedef struct mps__state {
    double t;     /* [s] */
    int64_t step; /* steps taken */
    int64_t lost; /* particles removed */
    double crossing_time;
    /* of the last step that the limits chose, not the caller; 0: none yet [s] */
    double dt_previous;
    double dt_before; /* length of the last step [s] */
    mps__pose before; /* of the tank at its beginning */
    mps__jump jump;   /* of the tank's velocity */
    /* time that a gain below 1 spreads pressures over, 0 before the first step [s] */
    double spread;
    mps__budget budget;
    int32_t start_pending; /* 1: the liquid gets its first velocity in the next step */
    int32_t level_told;    /* 1: the log was told that nothing fixes the level of the pressures */
    int32_t moves_told;    /* 1: that a fixed step is long for its speeds */
    int32_t window_told;   /* 1: that a probe averages over less than the resolution can tell */
} mps__state;

/* clang-format off */
#define MPS__STATE(MEMBER)                                                                \
    MEMBER(t)                                                                             \
    MEMBER(step) MEMBER(lost) MEMBER(crossing_time) MEMBER(dt_previous) MEMBER(dt_before) \
        MEMBER(before) MEMBER(jump) MEMBER(spread) MEMBER(budget) MEMBER(start_pending)   \
            MEMBER(level_told) MEMBER(moves_told) MEMBER(window_told)
/* clang-format on */

#define MPS__STATE_SIZE(member) +sizeof(((mps__state *)0)->member)
_Static_assert(sizeof(mps__state) == 0 MPS__STATE(MPS__STATE_SIZE),
               "MPS__STATE lists all members of mps__state");

/* Lists of neighbours; made again when particles have moved. */
typedef struct mps__lists {
    mps_neighbours neighbours;
    /* the same with the rows of solids without fluid about them, on demand; else empty */
    mps_neighbours complete;
    mps__screens screens; /* thin plates, in the tank's frame */
    /* NULL, or positions [n*dim] of the search whose candidates still hold, but are to be found
     * again */
    double *listed_at;
    int64_t aside;  /* lost particles that lie behind the others, until the next are looked for */
    int64_t gone;   /* the same of all ranks */
    int64_t linked; /* generation of the particles whose dummies know their walls */
    int64_t links;  /* how often dummies were linked to walls */
    int64_t orders; /* how often particles were put in order */
} mps__lists;

/* What stands aside while the store has particles of all ranks; gather.h. */
typedef struct mps__gathered {
    bool begun; /* by the user */
    bool swapped;
    void *array[MPS__FIELDS_MAX]; /* of the fields */
    int64_t n, capacity;
    uint8_t *ghost;
    double *listed; /* places of the last search */
} mps__gathered;

/* Work of this rank since ranks compared theirs; balance.c. */
typedef struct mps__balance {
    int32_t steps;
    double work;   /* of the steps since then [s] */
    double waited; /* mps__ranks.seconds when the step began */
    double cost;   /* of a particle of this rank over that of the mean rank */
} mps__balance;

typedef struct mps__world {
    mps__context *context;
    mps__setup setup;
    mps__state state;
    mps__lists lists;
    mps__work work;
    mps__particles particles; /* the state of each particle */
    mps__motion motion;       /* of the tank: chosen by the user, and its present pose */
    mps__pool pool;
    int32_t threads; /* of the pool */
    mps__ranks ranks;
    mps__ghosts ghosts;
    mps__gathered gathered;
    mps__balance balance;
    mps__models models;
    mps__channels channels;
    mps__host host;
    mps__solvers solvers;
    mps__ppe ppe;
    mps__bounds bounds;
    mps__scratch scratch; /* of searches, verbs and the equation */
    mps_step_info info;   /* of the last step */
    bool ending;          /* dt_max of a step is what is left of a run */
} mps__world;

mps_status mps__world_init(mps__world *w, mps__context *context, int32_t dim, double dp);
void mps__world_free(mps__world *w);
/* Lists at the present positions: search and sort if needed, then exact rows. Lost particles are handled here. */
mps_status mps__world_neighbours(mps__world *w);
/* Remove fluid outside of the domain, or behind walls, as the policy says. lost.c */
mps_status mps__world_leave_domain(mps__world *w);
mps_status mps__world_leave_tank(mps__world *w);
/* Those that were removed last come back, as long as nothing was added since. */
void mps__world_take_back(mps__world *w);
/* The same while the caller holds arrays: no particle is removed or moved to another place. */
mps_status mps__world_neighbours_kept(mps__world *w);
/* Exact rows at the present positions from lists that are fresh. */
void mps__world_rows(mps__world *w);
/* The stencil of one radius from those lists. */
mps_status mps__world_stencil(const mps__world *w, int32_t which, mps_stencil *stencil);
/* A stencil that has the rows of all particles, from lists that are fresh. */
mps_status mps__world_stencil_all(mps__world *w, int32_t which, mps_stencil *stencil);
/* Dummies find their walls, and walls without an area get one, from a search that left no particle out. links.c */
mps_status mps__world_link_walls(mps__world *w);
/* A tank or solid has so many layers of dummies. */
void mps__world_note_layers(mps__world *w, int32_t layers);
/* Tell the log of phases that were defined and have no fluid. */
void mps__world_note_phases(mps__world *w);
/* Largest mps_step_info.crossing_time [s]: below 5 U_g steps do not depend on the speed. */
static inline double mps__crossing_limit(const mps__world *w)
{
    return w->setup.dp / (5 * w->setup.velocity_scale);
}
/* mps_step_info.crossing_time after a step dt that ends with this speed. In calm liquid there are no impacts to be averaged, and a mean lags.
 * It changes slowly: a mean over a time that shrinks does not count all of an impulse. */
static inline double mps__crossing_time(const mps__world *w, double speed, double dt)
{
    const double last = w->state.crossing_time,
                 wanted = fmin(1, speed / w->setup.velocity_scale) *
                          fmin(w->setup.dp / speed, mps__crossing_limit(w));
    return w->state.step > 0 ? fmin(fmax(wanted, last - 0.1 * dt), last + 0.1 * dt) : wanted;
}
/* Largest speed of all particles [m/s]. */
double mps__world_speed(mps__world *w);
/* One step, undone if it fails. step.c */
mps_status mps__world_step(mps__world *w, double dt_max);
/* Fail for what is not finite or too fast, with the particle and its place, which is in work.x0 if particles arrived at new ones. Sets the
 * speeds of `info`. moves.c */
mps_status mps__world_check_result(mps__world *w, const mps_stage *s, bool arrived,
                                   mps_step_info *info);
/* Fluid that passes a wall in a step of dt that ends at a pose; the places before it are work.x0. moves.c */
mps_status mps__world_check_moves(mps__world *w, const mps__pose *next, double dt);
/* The step to take, in s->dt; `planned` is the one the limits chose, 0 if the caller cut it. They also differ where the last steps of a run
 * share what is left of it, so that none is a sliver: pressures of a tank that accelerates jump with dt, by half of its change. Rounding is
 * not something left. limits.c */
mps_status mps__world_limit_step(mps__world *w, mps_stage *s, double dt_max, double *planned);
/* Farthest way [m] of the walls from the present pose to another, and of the fluid as they see it if it keeps its velocity for dt. moves.c */
double mps__world_way_of_walls(mps__world *w, const mps__pose *pose, double dt);
/* Bounding box of the domain in the tank's frame. False without solids and without a given domain. */
bool mps__world_domain(mps__world *w, double lo[3], double hi[3]);

#endif
