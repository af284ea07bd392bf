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
#include "rigid.h"
#include "voids.h"
#include <mps/probe.h>
#include <mps/step.h>

/* The state of the fluid as a whole. */
typedef struct mps__bulk {
    double kinetic, potential; /* potential: -m g.x [J] */
    double momentum[3];        /* [kg m/s] */
} mps__bulk;

/* Energies [J] and impulses since creation; see mps_energy and mps_momentum. */
typedef struct mps__budget {
    double wall_work_momentum, wall_work_probes, viscous, plugins, collision, shift, added;
    double friction, gas;
    double layers;         /* kinetic energy of fluid beside that of its particles */
    double start;          /* kinetic + potential before the first step */
    mps_momentum momentum; /* but for its `total` and `numerical` */
    mps__bulk last;        /* up to here all is booked: what the last step left */
    /* mean volume deviation of regions INNER and SECOND in the last step and the first */
    double deviation, deviation_start;
    int64_t started; /* 1: the first step has been made */
} mps__budget;

/* Force of a solid on the fluid that verbs reported, besides pressures, and its moment about the centre of motion, in the frame of the
 * tank. */
typedef struct mps__reaction {
    double force[3], moment[3];
} mps__reaction;

/* Arrays of a step that are no channels. */
typedef struct mps__work {
    int64_t capacity, turned_capacity, placed_capacity;
    bool bodies; /* a model moves solids in the tank */
    bool *gone;  /* [n] particles to be removed */
    double *turned;
    double *
        placed; /* [2*n*dim] with bodies: places and areas of solids at the end of the step, tank's frame */
    const double
        *area; /* [n*dim] wetted area vectors in the lab: in turned, or those of the particles */
} mps__work;

/* When the velocity of the tank jumped last. */
typedef struct mps__jump {
    double accel;  /* largest |a| of the solids in the last step [m/s2] */
    int64_t since; /* steps */
} mps__jump;

/* What the user chose. The text of a checkpoint says it. */
typedef struct mps__setup {
    int32_t dim, lost_policy;
    double dp_given; /* by the user; dp is that of the first tank's cells */
    double dp, g[3], velocity_scale, re_near, re_far, speed_limit;
    double domain_min[3], domain_max[3]; /* tank's frame */
    bool domain_given, scale_given;
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
    mps__reaction reaction[1 + MPS__PARTS_MAX]; /* of the last step: the tank as a whole, parts */
    int32_t start_pending; /* 1: the liquid gets its first velocity in the next step */
    int32_t level_told;    /* 1: the log was told that nothing fixes the level of the pressures */
    int32_t moves_told;    /* 1: that a fixed step is long for its speeds */
    int32_t window_told;   /* 1: that a probe averages over less than the resolution can tell */
} mps__state;

/* clang-format off */
#define MPS__STATE(MEMBER)                                                                \
    MEMBER(t)                                                                             \
    MEMBER(step) MEMBER(lost) MEMBER(crossing_time) MEMBER(dt_previous) MEMBER(dt_before) \
        MEMBER(before) MEMBER(jump) MEMBER(spread) MEMBER(budget) MEMBER(reaction) MEMBER(start_pending)   \
            MEMBER(level_told) MEMBER(moves_told) MEMBER(window_told)
/* clang-format on */

#define MPS__STATE_SIZE(member) +sizeof(((mps__state *)0)->member)
_Static_assert(sizeof(mps__state) == 0 MPS__STATE(MPS__STATE_SIZE),
               "MPS__STATE lists all members of mps__state");

/* Lists of neighbours; made again when particles have moved. */
typedef struct mps__lists {
    mps_neighbours neighbours;
    /* the same with the rows of solids without fluid about them, on demand; empty during a step */
    mps_neighbours complete;
    mps__screens screens; /* thin plates, in the tank's frame */
    /* NULL, or positions [n*dim] of the search whose candidates still hold, but are to be found
     * again */
    double *listed_at;
    int64_t aside;  /* lost particles that lie behind the others, until the next are looked for */
    int64_t gone;   /* the same of all ranks */
    int64_t lost;   /* those of them that count as lost */
    int64_t linked; /* mps__particles.solids of those whose dummies know their walls */
    int64_t listed; /* mps__particles.generation of those that the lists have */
    int64_t first_new; /* id from which on particles came in this step */
    int64_t links;     /* how often dummies were linked to walls */
    int64_t orders;    /* how often particles were put in order */
} mps__lists;

/* What a step on a device tells the next one, in its last copy: whether fluid is outside of the domain, whether any is behind a wall, the square of
 * the longest way since the search, the square of the largest speed. It holds for the same particles and the same search. */
enum {
    MPS__AHEAD_OUTSIDE,
    MPS__AHEAD_SPILLED, /* -INFINITY: not known */
    MPS__AHEAD_WAY,
    MPS__AHEAD_SPEED,
    MPS__AHEADS
};
typedef struct mps__ahead {
    double most[MPS__AHEADS];
    int64_t changes,
        searches; /* of the particles, of the lists, at the end of the step; -1: nothing is told */
    bool holds;   /* in the step in progress */
} mps__ahead;

/* The store of this rank while rank 0 has the particles of all ranks; gather.h. */
typedef struct mps__collected {
    bool begun; /* by the user */
    bool swapped;
    void *array[MPS__FIELDS_MAX]; /* of the fields */
    int64_t n, capacity;
    uint8_t *ghost;
    double *listed; /* places of the last search */
} mps__collected;

/* Work of this rank since ranks compared theirs; balance.c. */
typedef struct mps__balance {
    int32_t steps;
    double work;   /* of the steps since then [s] */
    double waited; /* mps__ranks.seconds when the step began */
    double cost;   /* of a particle of this rank over that of the mean rank */
} mps__balance;

/* Load of the liquid on the tank in the last step, and its added mass; mps_load. */
typedef struct mps__load {
    int32_t watch; /* MPS_LOAD_..., of the user */
    int32_t what;  /* of this step: a body needs all */
    bool known, has_mass;
    int32_t iterations; /* of all columns of the added mass */
    double dt, at[3];   /* place of the centre of motion at the beginning of the step */
    double force[6], accel[6], mass[36]; /* about it */
} mps__load;

/* What the added mass is computed with. */
typedef struct mps__mass {
    /* field [n*dofs]: change of the pressure by each degree of freedom in the last step; NULL: never asked for */
    double *guess;
    double *next;              /* [n*count] by each column of the step in progress */
    double *moments, *rhs, *p; /* [n*dim], [rows], [columns] */
    double *a;                 /* [n*count*dim] change of accelerations */
    int64_t next_capacity, moment_capacity, rhs_capacity, p_capacity, a_capacity;
} mps__mass;

typedef struct mps__world {
    mps__context *context;
    mps__setup setup;
    mps__state state;
    mps__lists lists;
    mps__work work;
    mps__particles particles; /* the state of each particle */
    mps__motion motion;       /* of the tank: chosen by the user, and its present pose */
    mps__body body;           /* that carries it, if mps__body_carries() */
    mps__pool pool;
    int32_t threads; /* of the pool */
    mps__ranks ranks;
    mps__ghosts ghosts;
    mps__collected gathered;
    mps__balance balance;
    mps__models models;
    mps__channels channels;
    mps__host host;
    mps__solvers solvers;
    mps__ppe ppe;
    mps__bounds bounds;
    mps__voids voids;
    mps__scratch scratch; /* of searches, verbs and the equation */
    mps_step_info info;   /* of the last step */
    mps__load load;
    mps__mass mass;
    bool ending; /* dt_max of a step is what is left of a run */
    mps__ahead ahead;
    int64_t booked; /* mps__particles.changes when the last step summed state.budget.last */
} mps__world;

/* `passes` are those of a step, in their order. */
mps_status mps__world_init(mps__world *w, mps__context *context, int32_t dim, double dp,
                           const mps__pass *const *passes, int32_t pass_count);
void mps__world_free(mps__world *w);
/* The field that carries first guesses of the added mass with the particles, if there is none. */
mps_status mps__world_add_guess(mps__world *w);
/* Another spacing, before the first particle: radii keep their multiples of it. */
void mps__world_spacing(mps__world *w, double dp);
/* Lists at the present positions: search and sort if needed, then exact rows. Lost particles are handled here. */
mps_status mps__world_neighbours(mps__world *w);
/* The same after mps__world_populate(). */
mps_status mps__world_neighbours_populated(mps__world *w);
/* All fields of the particles are on the host, or one of them; the candidates of the last search; the places of that search. To be called before anything on the host reads
 * them outside of the calls of a step. MPS_E_PLUGIN: a device has them alone and does not give them. world_fields.c */
mps_status mps__world_fetch(const mps__world *w);
mps_status mps__world_fetch_field(const mps__world *w, const void *array);
/* A public function writes one field: it is on the host, and a device has old values from now on.
 * MPS_E_PLUGIN: nothing has changed. world_fields.c */
mps_status mps__world_write_field(mps__world *w, const void *array);
mps_status mps__world_fetch_lists(const mps__world *w);
mps_status mps__world_fetch_searched(const mps__world *w);
/* Whether loops run on the device of a step that begins; whether it has the lists of the last search, too. world_rows.c */
bool mps__world_there(const mps__world *w);
bool mps__world_rows_there(const mps__world *w);
/* Whether the candidates of the last search still hold. world_rows.c */
mps_status mps__world_fresh(mps__world *w, bool *fresh);
/* What rows see of the particles as they are, without pairs. */
void mps__world_view(const mps__world *w, mps_view *v);
/* Move `count` particles with `gone` behind the others, where they are no more, but may come back. They do not count as lost. lost.c */
mps_status mps__world_part(mps__world *w, const bool *gone, int64_t count);
/* Room for all particles in arrays of a step that are no channels. */
mps_status mps__world_reserve(mps__world *w);
/* Ask for what the next step wants to know, with the tank at a pose; known after mps__host_settle(). lost.c */
void mps__world_look_ahead(mps__world *w, const mps__pose *pose, double most[MPS__AHEADS]);
/* Remove fluid outside of the domain, or behind walls, as the policy says. lost.c */
mps_status mps__world_leave_domain(mps__world *w);
mps_status mps__world_leave_tank(mps__world *w);
/* Those that were removed last come back, as long as nothing was added since. */
void mps__world_take_back(mps__world *w);
/* The same while the caller holds arrays: no particle is removed or moved to another place. */
mps_status mps__world_neighbours_kept(mps__world *w);
/* Exact rows at the present positions from lists that are fresh; at the device of a step, if it has them. world_rows.c */
mps_status mps__world_rows(mps__world *w);
/* The order of the cells: in the list, and where a device made it, in `there`; NULL: the host did. world_rows.c */
mps_status mps__world_order(mps__world *w, const int32_t **there);
/* Candidates of particles that are in the order of their cells, found at the device of a step; `found` is false if they are to be found on the
 * host. Plates hide nothing yet. world_rows.c */
mps_status mps__world_search_there(mps__world *w, bool *found);
mps_status mps__world_hide_there(mps__world *w);
/* The stencil of one radius from those lists. */
mps_status mps__world_stencil(const mps__world *w, int32_t which, mps_stencil *stencil);
/* The arrays of those lists, and wetted areas that have turned, at the device of a step that begins. */
mps_status mps__world_lists_twins(mps__world *w);
/* Address of an array of a field or list where loops run now, for loops that read it; for loops that write all of it. */
static inline void *mps__seen(const mps__world *w, const void *array)
{
    return mps__twins_seen((mps__twins *)&w->host.twins, array);
}
static inline void *mps__given(mps__world *w, void *array)
{
    return mps__twins_given(&w->host.twins, array, true);
}
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
/* Largest speed of all particles relative to the tank [m/s]. */
double mps__world_speed(mps__world *w);
/* Box of the solids of all ranks in the tank's frame: upper corner, negative of the lower one; -INFINITY without any. */
void mps__world_box_of_solids(mps__world *w, double corner[6]);
/* Places farther from the origin are refused [dp]: rounding is below the millionth of a spacing by which lattice points are told apart. */
#define MPS__FARTHEST 1e9
/* Bounding box of the domain in the tank's frame. False without solids and without a given domain. */
bool mps__world_domain(mps__world *w, double lo[3], double hi[3]);

#endif
