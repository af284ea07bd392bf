/* SPDX-License-Identifier: BSD-3-Clause */
/* Everything a time step works on. */
#ifndef MPS_CORE_WORLD_H
#define MPS_CORE_WORLD_H

#include "bounds.h"
#include "ghosts.h"
#include "runner.h"
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

/* Totals of the fluid. */
typedef struct mps__bulk {
    double kinetic, potential; /* potential: -m g.x [J] */
    double momentum[3];        /* [kg m/s] */
} mps__bulk;

/* Energies [J] and impulses since creation; see mps_energy and mps_momentum. */
typedef struct mps__budget {
    double wall_work_momentum, wall_work_probes, viscous, plugins, collision, shift, added;
    double friction, gas;
    double layers;         /* kinetic energy of the fluid besides that of its particles */
    double start;          /* kinetic + potential before the first step */
    mps_momentum momentum; /* without its `total` and `numerical` */
    /* state at the end of the last step: all changes up to it are accounted for */
    mps__bulk last;
    /* mean volume deviation of regions INNER and SECOND in the last step and in the first */
    double deviation, deviation_start;
    int64_t started; /* 1: the first step has been made */
} mps__budget;

/* Force of a solid on the fluid that verbs reported, without pressures, and its moment about the
 * centre of motion, in the frame of the tank. */
typedef struct mps__reaction {
    double force[3], moment[3];
} mps__reaction;

/* Arrays of a step that are not channels. */
typedef struct mps__work {
    int64_t capacity, turned_capacity, placed_capacity;
    bool bodies; /* a model moves solids in the tank */
    bool *gone;  /* [n] particles to be removed */
    double *turned;
    /* [2*n*dim] if bodies: positions and areas of solids at the end of the step, tank's frame */
    double *placed;
    /* [n*dim] wetted area vectors in the lab: `turned`, or those of the particles */
    const double *area;
} mps__work;

/* Last jump of the tank's velocity. */
typedef struct mps__jump {
    double accel;  /* largest |a| of the solids in the last step [m/s2] */
    int64_t since; /* steps */
} mps__jump;

/* Settings of the user. A checkpoint stores them as text, except control, speed_limit and
 * lost_policy. */
typedef struct mps__setup {
    int32_t dim, lost_policy;
    double dp_given; /* by the user; dp is adjusted to the cells of the first tank */
    double dp, g[3], velocity_scale, re_near, re_far, speed_limit;
    double domain_min[3], domain_max[3]; /* tank's frame */
    bool domain_given, scale_given;
    mps_kernel kernel;
    bool phase_defined[MPS__PHASES];
    double phase_density[MPS__PHASES], phase_viscosity[MPS__PHASES];
    double tension[MPS__PHASES * MPS__PHASES]; /* < 0: not set */
    mps_time_control control;
    /* of dummies behind walls, the minimum over all tanks and solids; 0: not set */
    int32_t layers;
} mps__setup;

/* State that determines the next step, besides the fields of the particles, the motion and the
 * probes. MPS__STATE lists all members: they are stored in checkpoints. */
typedef struct mps__state {
    double t;     /* [s] */
    int64_t step; /* steps taken */
    int64_t lost; /* particles removed */
    double crossing_time;
    /* of the last step chosen by the limits, not by the caller; 0: none yet [s] */
    double dt_previous;
    double dt_before; /* length of the last step [s] */
    mps__pose before; /* of the tank at the beginning of the last step */
    mps__jump jump;   /* of the tank's velocity */
    /* time over which a gain below 1 spreads pressures, 0 before the first step [s] */
    double spread;
    mps__budget budget;
    mps__reaction reaction[1 + MPS__PARTS_MAX]; /* of the last step: the tank as a whole, parts */
    int32_t start_pending; /* 1: the next step sets the initial velocity of the liquid */
    int32_t level_told;    /* 1: the log has the message that the pressures have no datum */
    /* 1: the log has the warning that a fixed step is too long for the speeds */
    int32_t moves_told;
    /* 1: the log has the warning that a probe's averaging time is below the resolution */
    int32_t window_told;
} mps__state;

/* clang-format off */
#define MPS__STATE(MEMBER)                                                                \
    MEMBER(t)                                                                             \
    MEMBER(step) MEMBER(lost) MEMBER(crossing_time) MEMBER(dt_previous) MEMBER(dt_before) \
        MEMBER(before) MEMBER(jump) MEMBER(spread) MEMBER(budget) MEMBER(reaction)        \
            MEMBER(start_pending) MEMBER(level_told) MEMBER(moves_told) MEMBER(window_told)
/* clang-format on */

#define MPS__STATE_SIZE(member) +sizeof(((mps__state *)0)->member)
_Static_assert(sizeof(mps__state) == 0 MPS__STATE(MPS__STATE_SIZE),
               "MPS__STATE lists all members of mps__state");

/* Neighbour lists, rebuilt when particles have moved. */
typedef struct mps__lists {
    mps_neighbours neighbours;
    /* includes rows of solids without fluid in reach; built on demand, empty during a step */
    mps_neighbours complete;
    mps__occluders occluders; /* thin plates, in the tank's frame */
    /* NULL, or positions [n*dim] of a search whose candidates are valid, but have to be
     * recomputed */
    double *listed_at;
    int64_t aside;     /* lost particles kept in memory behind the others, until the next check */
    int64_t gone;      /* sum of `aside` over all ranks */
    int64_t lost;      /* those of them that count as lost */
    int64_t linked;    /* value of mps__particles.solids when dummies were linked to walls */
    int64_t listed;    /* value of mps__particles.generation of the lists */
    int64_t first_new; /* particles added in this step have ids from this one on */
    int64_t links;     /* how often dummies were linked to walls */
    int64_t orders;    /* how often particles were reordered */
} mps__lists;

/* Next-step flags, computed in a step's last reduction on a device: whether fluid is outside of the
 * domain, whether any is behind a wall, the square of the largest displacement since the search,
 * the square of the largest speed. Valid for the same particles and the same search. */
enum {
    MPS__NEXT_OUTSIDE,
    MPS__NEXT_SPILLED, /* -INFINITY: not known */
    MPS__NEXT_WAY,
    MPS__NEXT_SPEED,
    MPS__NEXT_FLAGS
};
typedef struct mps__next_flags {
    double most[MPS__NEXT_FLAGS];
    /* mps__particles_flow() and mps_neighbours.searches at the end of the step; flow -1: no
     * flags */
    int64_t flow, searches;
    bool holds; /* the flags are valid in the step in progress */
} mps__next_flags;

/* The store of this rank while rank 0 has the particles of all ranks; collect.h. */
typedef struct mps__collected {
    bool begun; /* the user called mps_particles_collect() */
    bool swapped;
    void *array[MPS__FIELDS_MAX]; /* of the fields */
    int64_t n, capacity;
    uint8_t *ghost;
    double *listed; /* positions of the last search */
} mps__collected;

/* Work of this rank since the last comparison of ranks; balance.c. */
typedef struct mps__balance {
    int32_t steps;
    double work;   /* of the steps since then [s] */
    double waited; /* mps__ranks.seconds when the step began */
    double cost;   /* of a particle of this rank, relative to the mean rank */
} mps__balance;

/* Load of the liquid on the tank in the last step, and its added mass; mps_load. */
typedef struct mps__load {
    int32_t watch; /* MPS_LOAD_..., of the user */
    int32_t what;  /* in this step: a body needs all */
    bool known, has_mass;
    int32_t iterations; /* of all columns of the added mass */
    double dt, at[3];   /* at: position of the centre of motion at the beginning of the step */
    double force[6], accel[6], mass[36]; /* about `at` */
} mps__load;

/* Data of the added mass. */
typedef struct mps__mass {
    /* field [n*dofs]: change of the pressure by each degree of freedom in the last step; NULL:
     * never requested */
    double *guess;
    double *next;              /* [n*count] by each column, in the step in progress */
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
    mps__body body;           /* that carries the tank, if mps__body_carries() */
    mps__pool pool;
    int32_t threads; /* of the pool */
    mps__ranks ranks;
    mps__ghosts ghosts;
    mps__collected collected;
    mps__balance balance;
    mps__models models;
    mps__channels channels;
    mps__runner runner;
    mps__solvers solvers;
    mps__ppe ppe;
    mps__bounds bounds;
    mps__voids voids;
    mps__scratch scratch; /* of searches, verbs and the equation */
    mps_step_info info;   /* of the last step */
    mps__load load;
    mps__mass mass;
    bool ending; /* dt_max of a step is the rest of a run */
    mps__next_flags next_flags;
    /* mps__particles_flow() when the last step summed state.budget.last */
    int64_t booked;
} mps__world;

/* `passes`: those of a step, in order. */
mps_status mps__world_init(mps__world *w, mps__context *context, int32_t dim, double dp,
                           const mps__pass *const *passes, int32_t pass_count);
void mps__world_free(mps__world *w);
/* Add the field of first guesses of the added mass, if there is none. */
mps_status mps__world_add_guess(mps__world *w);
/* Set another spacing, before the first particle is added: radii scale with it. */
void mps__world_spacing(mps__world *w, double dp);
/* Lists at the present positions: search and sort if needed, then exact rows. Includes the removal
 * of lost particles. */
mps_status mps__world_neighbours(mps__world *w);
/* mps__world_neighbours() after mps__world_populate(). */
mps_status mps__world_neighbours_populated(mps__world *w);
/* Copy to the host, unless up to date: all fields of the particles; one of them; the candidates of
 * the last search; the positions of that search. To be called before the host reads them outside of
 * the calls of a step. MPS_E_PLUGIN: only a device has them, and the copy failed. world_fields.c */
mps_status mps__world_fetch(const mps__world *w);
mps_status mps__world_fetch_field(const mps__world *w, int32_t field);
/* Before a public function writes a field: copy it to the host, and invalidate the device's copy.
 * MPS_E_PLUGIN: nothing has changed. world_fields.c */
mps_status mps__world_write_field(mps__world *w, int32_t field);
mps_status mps__world_fetch_lists(const mps__world *w);
mps_status mps__world_fetch_searched(const mps__world *w);
/* Whether a step begins on the device; whether the device also has the lists of the last search.
 * world_rows.c */
bool mps__world_on_device(const mps__world *w);
bool mps__world_rows_on_device(const mps__world *w);
/* Whether the candidates of the last search are still valid. world_rows.c */
mps_status mps__world_fresh(mps__world *w, bool *fresh);
/* The view of the present particles, without pairs. */
void mps__world_view(const mps__world *w, mps_view *v);
/* Move `count` particles marked in `gone` behind the others: they are removed, but can be restored.
 * They do not count as lost. lost.c */
mps_status mps__world_part(mps__world *w, const bool *gone, int64_t count);
/* Capacity for all particles in the arrays of a step that are not channels. */
mps_status mps__world_reserve(mps__world *w);
/* Request the next-step flags, with the tank at a pose, at the end of a step; valid after
 * mps__runner_flush(). lost.c */
void mps__world_request_flags(mps__world *w, const mps__pose *pose, mps__next_flags *next);
/* Remove fluid outside of the domain, or behind walls, by the policy. lost.c */
mps_status mps__world_leave_domain(mps__world *w);
mps_status mps__world_leave_tank(mps__world *w);
/* Restore the particles removed last, as long as none were added since. */
void mps__world_take_back(mps__world *w);
/* mps__world_neighbours() while the caller holds arrays: no particle is removed or reordered. */
mps_status mps__world_neighbours_kept(mps__world *w);
/* Exact rows at the present positions from valid candidates; on the device of the step, if it has
 * them. world_rows.c */
mps_status mps__world_rows(mps__world *w);
/* The order by cells: in the list, and, if a device made it, in its memory, `on_device`; NULL:
 * made on the host. world_rows.c */
mps_status mps__world_order(mps__world *w, const int32_t **on_device);
/* Search on the device of the step, for particles in cell order; `found` false: search on the host.
 * The second function applies occlusion. world_rows.c */
mps_status mps__world_search_device(mps__world *w, bool *found);
mps_status mps__world_hide_device(mps__world *w);
/* The stencil of one radius from those lists. */
mps_status mps__world_stencil(const mps__world *w, int32_t which, mps_stencil *stencil);
/* Mirror the arrays of those lists, and rotated wetted areas, on the device of a step that
 * begins. */
mps_status mps__world_mirror_lists(mps__world *w);
/* Address of a field, MPS__FIELD_..., in the memory space of the loops, for loops that read it; for
 * loops that overwrite all of it. */
static inline void *mps__seen(const mps__world *w, int32_t field)
{
    return mps__memory_read((mps__memory *)&w->runner.memory, field);
}
static inline void *mps__given(mps__world *w, int32_t field)
{
    return mps__memory_write(&w->runner.memory, field);
}
/* Address of a list, MPS__ROWS_... and so on, whose array on the host is `host`. */
static inline void *mps__seen_list(const mps__world *w, int32_t list, const void *host)
{
    return mps__memory_list_seen((mps__memory *)&w->runner.memory, list, host);
}
static inline void *mps__given_list(mps__world *w, int32_t list, void *host)
{
    return mps__memory_list_given(&w->runner.memory, list, host, true);
}
/* A stencil with the rows of all particles, from valid lists. */
mps_status mps__world_stencil_all(mps__world *w, int32_t which, mps_stencil *stencil);
/* Link dummies to walls, and estimate missing wall areas, from a search with all particles.
 * links.c */
mps_status mps__world_link_walls(mps__world *w);
/* Note the number of layers of dummies of a tank or solid. */
void mps__world_note_layers(mps__world *w, int32_t layers);
/* Log phases that are defined but have no fluid. */
void mps__world_note_phases(mps__world *w);
/* Largest mps_step_info.crossing_time [s]: below 5 U_g it does not depend on the speed. */
static inline double mps__crossing_limit(const mps__world *w)
{
    return w->setup.dp / (5 * w->setup.velocity_scale);
}
/* Largest speed of all particles relative to the tank [m/s]. */
double mps__world_speed(mps__world *w);
/* Box of the solids of all ranks in the tank's frame: upper corner, negative of the lower one;
 * -INFINITY without any. */
void mps__world_box_of_solids(mps__world *w, double corner[6]);
/* Largest distance from the origin [dp]: rounding is then below the millionth of a spacing that
 * separates lattice points. */
#define MPS__FARTHEST 1e9
/* Bounding box of the domain in the tank's frame. False without solids and without a given
 * domain. */
bool mps__world_domain(mps__world *w, double lo[3], double hi[3]);

#endif
