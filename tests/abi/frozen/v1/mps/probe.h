/* SPDX-License-Identifier: BSD-3-Clause */
/** @file probe.h  Pressure probes, free-surface gauges, forces and energies. Read between steps or in the monitor.
 *
 *  Places are given in the tank's frame and move with it. Pressures are gauge [Pa]. */
#ifndef MPS_PROBE_H
#define MPS_PROBE_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** What a probe measures. */
enum {
    MPS_PROBE_WALL_PRESSURE = 0,  /**< 1 value [Pa]: mean over a disc of `diameter` (2-D: a strip) on the face at `at`, linear between the
                                      wall particles; what reaches beyond the face does not count. A linear pressure is exact on any flat
                                      face, also where its particles are no lattice; on a curved one of radius R, with a diameter of dp, it
                                      is that of a place at most dp^2/(3 R) away. The face is the one whose plane is nearest to `at`. `at`
                                      may be before the face with a wall particle within 2 dp, at most dp/2 behind it, and at most dp/2
                                      beyond its end */
    MPS_PROBE_FLUID_PRESSURE = 1, /**< 1 value [Pa]: kernel-weighted, 0 outside the fluid */
    MPS_PROBE_GAUGE = 2,          /**< 1 value [m]: distance from `at` along `direction` to the free surface: the centres of the top layer
                                      on a lattice; 0 if `at` is dry. Beside a wall the band's centre is 2/3 diameter off it, from there
                                      the surface goes on straight. A film one particle thick is no surface, two are.
                                      Below another phase: the interface, half a spacing above these centres, less that half spacing */
    MPS_PROBE_FORCE = 3           /**< dim + (1 in 2-D, 3 in 3-D) values [N, N m; per m in 2-D]: pressure force and moment about `at`,
                                      which moves with the tank; components along the axes of the lab, not of the tank */
};

/** For mps_probe.average: what the resolution can tell, mps_step_info.crossing_time. */
#define MPS_AVERAGE_AUTO (-1.0)

/** Definition of a probe. */
typedef struct mps_probe {
    uint32_t struct_size; /**< set by mps_probe_init() */
    int32_t type;         /**< MPS_PROBE_... */
    double at[3];         /**< place in the tank's frame [m]; gauge: foot of the line; force: centre of moments */
    double direction[3];  /**< gauge: along the line; default +y */
    double diameter;      /**< wall pressure: sensor diameter [m], default dp; gauge: width of its band, default 3 dp; less
                               than 2 dp is taken for 2 dp */
    double length;        /**< gauge: length of the line [m]; default: to the domain's end */
    const char *part;     /**< force: name of a part, a prefix ending in '.', or NULL for all solids */
    int32_t count_drops;  /**< gauge: 1: the topmost particle in the band, drops and films included */
    double average;       /**< mean over the last `average` seconds [s], see mps_probe_series(); 0: the value now. Default MPS_AVERAGE_AUTO:
                               pressures and forces over mps_step_info.crossing_time, gauges 0. A pressure that is averaged over less
                               depends on the time step in impacts; a warning with the values is logged once. A mean lags by half its time */
    double rate;          /**< samples a second [Hz] kept for mps_probe_series(), at most 1e9; default 0: none */
    uint32_t
        phases; /**< gauge: the phases that are below the surface, defined before, bit 1 << phase for each; default 0: the liquid, all that are
                               denser than the mean of the lightest and the densest there */
} mps_probe;

/** Defaults. */
MPS_API mps_status mps_probe_init(mps_probe *probe, size_t size);

/** Add a probe. Solids must be there before.
 *  @param id  out: 0, 1, ..., never one that was there before
 *  @return MPS_E_ARG (outside the solids' bounding box; a wall probe with no wall particle within 2 dp, or more than dp/2 behind the
 *          face of its wall or beyond the end of that face; says how far), MPS_E_NAME, MPS_E_NOMEM */
MPS_API mps_status mps_probe_add(mps_sim *sim, const mps_probe *probe, int32_t *id);

/** Remove a probe and its samples, between steps or in the monitor; arrays of its mps_probe_series() are gone. Numbers of other probes
 *  stay. A wall probe with an average or a rate must go with its walls: without them no further step is done.
 *  @return MPS_E_ARG: there is no such probe, or it was removed */
MPS_API mps_status mps_probe_remove(mps_sim *sim, int32_t id);

/** Number of values of a probe, or -1. */
MPS_API int32_t mps_probe_size(const mps_sim *sim, int32_t id);

/** Measure now; with an average: the mean up to now.
 *  @param values  [mps_probe_size()] out
 *  @return MPS_E_ARG, MPS_E_NOMEM, MPS_E_STATE (the walls are gone) */
MPS_API mps_status mps_probe_read(mps_sim *sim, int32_t id, double *values);

/** Samples of a probe with a `rate` since it was added or cleared: at t = k / rate, k whole, up to the present time.
 *  Between steps the signal s is linear; with an `average` T, sample(t) = integral of s from t - T to t, over T, and over what there
 *  is while the probe is younger than T. Each step counts with the state it left, seen at the latest when the next step begins;
 *  before the first step of a simulation pressures are those after it.
 *  Steps need memory for this: mps_step() fails with MPS_E_NOMEM before anything moved, and can be called again.
 *  @param count   out, or NULL: samples
 *  @param t       out, or NULL: times [count], ascending [s]
 *  @param values  out, or NULL: [count][mps_probe_size()]; both arrays are the library's, valid until the next step, read,
 *                 clear or mps_probe_series() of this probe
 *  @return MPS_E_ARG, MPS_E_NOMEM, MPS_E_STATE (the rate is 0, or the walls are gone) */
MPS_API mps_status mps_probe_series(mps_sim *sim, int32_t id, int64_t *count, const double **t, const double **values);

/** Forget the samples so far, so that a long run needs no endless memory: 8 (1 + size) bytes a sample. Averages go on.
 *  @return MPS_E_ARG, MPS_E_STATE (the rate is 0) */
MPS_API mps_status mps_probe_series_clear(mps_sim *sim, int32_t id);

/** Energies and bulk quantities of the fluid (per metre of width in 2-D) and the budget since creation. */
typedef struct mps_energy {
    uint32_t struct_size; /**< set by mps_energy_init() */
    double kinetic;       /**< sum m u^2 / 2 [J] */
    double potential;     /**< -sum m g.x [J] */
    double wall_work;     /**< work done by the walls on the fluid [J], by pressure; of an impulse, with the mean of their velocities before
                               and after it */
    double viscous;       /**< lost in force models (viscosity), >= 0 when dissipating; < 0: they drive the fluid, as moving walls do that
                               drag it along [J] */
    double collision;     /**< lost in collisions, and of drops stopped by thin plates [J] */
    double shift;         /**< lost in shifting, kinetic and potential [J] */
    double numerical;     /**< the rest: wall_work + added - viscous - collision - shift - d(kinetic + potential) [J], d: since before the
                               first step */
    double mass;          /**< [kg] */
    double volume;        /**< sum m/rho, over 1 + mean volume deviation of fluid below the surface's first band [m3 or m2] */
    double volume_error;  /**< that mean deviation in the first step minus now, > 0: expanded */
    double centre[3];     /**< centre of mass, lab frame [m] */
    double momentum[3];   /**< [kg m/s] */
    double added;         /**< kinetic + potential that came from outside since before the first step, < 0: that went [J]: with particles
                               added, removed and lost, densities set anew, fields written between steps, a tank put elsewhere by a new
                               motion, and MPS_START_WITH_TANK */
} mps_energy;

/** Set struct_size and zero. */
MPS_API mps_status mps_energy_init(mps_energy *energy, size_t size);

/** Measure energies now. Mass and volume are those of the particles: the half cells of liquid that walls stand for are none. The liquid
 *  has dp/2 times the area (in 2-D the length) of its wetted walls more volume than said here. On a lattice the half cells above the
 *  centres of the top layer make up for those at the floor, so that fluid between the side walls of a tank of length L lacks dp/L of it,
 *  in 3-D also dp over its width. */
MPS_API mps_status mps_energy_get(mps_sim *sim, mps_energy *energy);

/** Momentum of the fluid (per metre of width in 2-D) and what has changed it since creation [kg m/s]:
 *  total = that before the first step + gravity + force + pressure + collision + shift + added. */
typedef struct mps_momentum {
    uint32_t struct_size; /**< set by mps_momentum_init() */
    double total[3];      /**< sum m u, now */
    double gravity[3];    /**< weight times time */
    double force[3];      /**< by force models: friction at walls; pairs inside the fluid add nothing */
    double pressure[3];   /**< by pressure gradients, */
    double walls[3];      /**< of that what the walls gave: the integral of their sum p A over time */
    double numerical[3];  /**< and the rest, pressure - walls: weight and inertia of the half cells that walls stand for, which are no
                                 particles (of order dp), and that a gradient exact for linear pressures does not conserve momentum */
    double collision[3];  /**< by collisions, those with walls, and thin plates that stop drops */
    double shift[3];      /**< by velocities transported with shifted particles */
    double added[3];      /**< from outside, as in mps_energy */
} mps_momentum;

/** Set struct_size and zero. */
MPS_API mps_status mps_momentum_init(mps_momentum *momentum, size_t size);

/** Measure the momentum now. */
MPS_API mps_status mps_momentum_get(mps_sim *sim, mps_momentum *momentum);

MPS_END_DECLS

#endif
