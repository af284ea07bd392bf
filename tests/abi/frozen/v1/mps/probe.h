/* SPDX-License-Identifier: BSD-3-Clause */
/** @file probe.h  Pressure probes, free-surface gauges, forces and energies. Read them between
 *  steps or in the monitor.
 *
 *  Positions are in the frame of the tank and move with it. Pressures are gauge pressures [Pa]. */
#ifndef MPS_PROBE_H
#define MPS_PROBE_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** What a probe measures. */
enum {
    /** 1 value [Pa]: mean over a disc of `diameter` (2-D: a strip) on the face at `at`, linear
     *  between the wall particles; parts of the disc beyond the face are ignored. The face is the
     *  one whose plane is nearest to `at`; with `normal`, the nearest face with this direction. If
     *  the distance of another face is equal within dp/2 (knuckle, corner, plate), the log names
     *  the chosen face; mps_probe_info_get() always does. `at` may be in front of the face with a
     *  wall particle within 2 dp, at most dp/2 behind it, and at most dp/2 beyond its end. Dry
     *  walls, above the contact line, contribute 0; negative pressures of the liquid are included.
     *  Wall particles on an edge where the wall turns away from the liquid by more than about 50
     *  degrees belong to two faces. The probe uses for them the pressure on its own face: the
     *  median of their own pressure, of the mean of the adjacent face and of its pressure
     *  extrapolated linearly to the edge; their own pressure on a face with fewer than three rows.
     *  A linear pressure is exact on any flat face, also if its particles are not a lattice. On a
     *  curved face of radius R, with a diameter of dp, the value is that of a point at most dp^2/(3
     *  R) away. */
    MPS_PROBE_WALL_PRESSURE = 0,
    /** 1 value [Pa]: kernel-weighted; 0 outside the fluid. */
    MPS_PROBE_FLUID_PRESSURE = 1,
    /** 1 value [m]: distance from `at` along `direction` to the free surface, that is, to the
     *  centres of the top layer on a lattice; 0 if `at` is dry. Next to a wall the centre of the
     *  band is 2/3 diameter from the wall; from there to the wall the surface is extrapolated with
     *  its slope. One layer of particles is not a surface, two layers are. Below another phase: the
     *  interface, half a spacing above these centres, minus this half spacing. */
    MPS_PROBE_GAUGE = 2,
    /** dim + (1 in 2-D, 3 in 3-D) values [N, N m; per m in 2-D]: force of the fluid on solids and
     *  its moment about `at`, which moves with the tank; components along the axes of the lab. It
     *  is the sum of -P_i A_i over the wall particles, P_i the wall pressure, and of all that
     *  models report by mps_stage_reaction(): friction at walls (viscosity.laplacian,
     *  viscosity.pair, layer.history) and collisions with them (collision.pair), on the part next
     *  to the fluid; friction.history, part "sides"; plug-ins. Its integral over time is -(walls +
     *  reaction) of mps_momentum. It does not include droplets that thin plates stop, nor particle
     *  shifting. It is for output only: an averaged force (the default) is delayed; use
     *  mps_load_get() for the motion of a rigid body. A warning is logged once if
     *  mps_motion_pose_set() moves the tank without mps_load_watch(). */
    MPS_PROBE_FORCE = 3
};

/** For mps_probe.average: the shortest time that the spacing resolves, mps_step_info.crossing_time,
 *  from the speed of the fastest coherent liquid; spray does not shorten it. */
#define MPS_AVERAGE_AUTO (-1.0)

/** Definition of a probe. */
typedef struct mps_probe {
    /** Set by mps_probe_init(). */
    uint32_t struct_size;
    /** MPS_PROBE_... */
    int32_t type;
    /** Position in the frame of the tank [m]; gauge: foot of the line; force: centre of moments. */
    double at[3];
    /** Gauge: direction of the line; default +y. */
    double direction[3];
    /** Wall pressure: diameter of the sensor [m], default dp. Gauge: width of its band, default 3
     *  dp; minimum 2 dp. */
    double diameter;
    /** Gauge: length of the line [m]; default: to the end of the domain. */
    double length;
    /** Force: name of a part, a prefix ending in '.', or NULL for all solids. */
    const char *part;
    /** Gauge, 1: the topmost particle in the band, including droplets and films. */
    int32_t count_drops;
    /** Mean over the last `average` seconds [s], see mps_probe_series(); 0: instantaneous value.
     *  Default MPS_AVERAGE_AUTO: mps_step_info.crossing_time for pressures and forces, 0 for
     *  gauges. In impacts a pressure averaged over a shorter time depends on the time step; this is
     *  logged once as a warning. A mean is delayed by half its time. */
    double average;
    /** Sampling rate of mps_probe_series() [Hz], at most 1e9; default 0: no samples. */
    double rate;
    /** Gauge: phases below the surface, bit 1 << phase for each defined phase. Default 0: the
     *  liquid, all phases denser than the mean of the lightest and the densest phase. */
    uint32_t phases;
    /** Name in messages and in mps_probe_info, 1..31 characters, unique; NULL: none. */
    const char *name;
    /** Wall pressure: direction from the face into the liquid, of any length, in the frame of the
     *  tank. The face is the nearest one within 2 dp whose normal is within 30 degrees of it.
     *  Default 0: the nearest one. */
    double normal[3];
} mps_probe;

/** Set every entry to its default. @param size  sizeof(mps_probe) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_probe_init(mps_probe *probe, size_t size);

/** Add a probe. Add all solids before.
 *  @param id  out: 0, 1, ..., never used before
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | a value; outside the box of the solids; wall probe: no wall particle |
 *  | | within 2 dp, more than dp/2 behind the face or beyond its end (distance in the text), |
 *  | | or no face with the direction `normal` |
 *  | MPS_E_NAME | no part has this name; another probe has this name |
 *  | MPS_E_BUSY | called from a verb or a callback |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_probe_add(mps_sim *sim, const mps_probe *probe, int32_t *id);

/** Remove a probe and its samples, between steps or in the monitor; arrays of its
 *  mps_probe_series() become invalid. Numbers of other probes remain. Remove a wall probe with an
 *  average or a rate together with its walls: otherwise steps fail.
 *  @return MPS_E_ARG: no such probe */
MPS_API mps_status mps_probe_remove(mps_sim *sim, int32_t id);

/** Properties of a probe, and the face that it reads. */
typedef struct mps_probe_info {
    /** Set by mps_probe_info_init(). */
    uint32_t struct_size;
    /** MPS_PROBE_... */
    int32_t type;
    /** Its name; "": none. Valid until a probe is added or removed, like `part`. */
    const char *name;
    /** Wall pressure: part of the face. Force: its part or prefix. "": none, or all. */
    const char *part;
    /** Place in the frame of the tank [m]. */
    double at[3];
    /** Wall pressure: normal of the face into the liquid, of length 1, in the frame of the tank. */
    double normal[3];
    /** mps_probe.diameter, or its default [m]. */
    double diameter;
    /** Number of values, as mps_probe_size(). */
    int32_t values;
} mps_probe_info;

/** Set struct_size and zero. @param size  sizeof(mps_probe_info) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_probe_info_init(mps_probe_info *info, size_t size);

/** Properties of a probe. @param info  initialised by mps_probe_info_init(); out
 *  @return MPS_E_ARG: no such probe, or it was removed */
MPS_API mps_status mps_probe_info_get(const mps_sim *sim, int32_t id, mps_probe_info *info);

/** Number of values of a probe, or -1. */
MPS_API int32_t mps_probe_size(const mps_sim *sim, int32_t id);

/** Measure at the current time; with an average: the mean up to this time.
 *  @param values  [mps_probe_size()] out
 *  @return MPS_E_ARG, MPS_E_NOMEM, MPS_E_STATE (the walls of the probe were removed) */
MPS_API mps_status mps_probe_read(mps_sim *sim, int32_t id, double *values);

/** Samples of a probe with a `rate` since it was added or cleared: at t = k / rate, k an integer,
 *  up to the current time. The signal s is linear between steps. With an `average` T, sample(t) =
 *  (integral of s from t - T to t)/T; before the probe has the age T, the mean over its age. The
 *  value of a step is that of its final state, measured no later than the beginning of the next
 *  step; before the first step, pressures are those after it.
 *
 *  Samples need memory: if it is exhausted, mps_step() fails with MPS_E_NOMEM before any change,
 *  and can be called again.
 *  @param count   out, or NULL: number of samples
 *  @param t       out, or NULL: times [count], ascending [s]
 *  @param values  out, or NULL: [count][mps_probe_size()] Both arrays are owned by the library and
 *  valid until the next step, read, clear or mps_probe_series() of this probe.
 *  @return MPS_E_ARG, MPS_E_NOMEM, MPS_E_STATE (the rate is 0, or the walls were removed) */
MPS_API mps_status mps_probe_series(mps_sim *sim, int32_t id, int64_t *count, const double **t,
                                    const double **values);

/** Remove all samples, to free memory in a long run: 8 (1 + size) bytes per sample. Averages
 *  continue.
 *  @return MPS_E_ARG, MPS_E_STATE (the rate is 0) */
MPS_API mps_status mps_probe_series_clear(mps_sim *sim, int32_t id);

/** Energies and bulk quantities of the fluid (per metre of width in 2-D), and the energy budget
 *  since the first step.
 *
 *  Particles and half cells. `mass`, `volume`, `centre`, `momentum` and all energies are sums over
 *  the fluid particles, each with the mass rho dp^dim. The liquid between them and a wall, half a
 *  cell of dp/2, has no fluid particle: the wall particle represents it. In a tank of length L,
 *  filled to n dp, particles fill (L - dp) n dp: the fraction dp/L of the liquid is missing, in 3-D
 *  also dp over its width. Compare `mass_filled` and `volume_filled` with rho V and V: they add
 *  dp/2 times the area of wetted walls, and subtract dp/2 times the area of the free surface (the
 *  top half cells are above the level). A wall is wetted if there is fluid in front of it, within
 *  0.75 dp of its normal and 2 dp deep. The remaining error is of the order of dp^2: corners, the
 *  edge of the wetted part of walls, and half a cell at each tip of a plate. */
typedef struct mps_energy {
    /** Set by mps_energy_init(). */
    uint32_t struct_size;
    /** sum m u^2 / 2 [J] */
    double kinetic;
    /** -sum m g.x [J] */
    double potential;
    /** Work of the walls on the fluid [J]: by pressures, from their change of the momentum and
     *  angular momentum of the fluid, and by reactions (mps_stage_reaction()). It closes the
     *  budget. For an impulse: with the mean of the velocities of the walls before and after it. If
     *  models move solids in the tank (MPS_MOTION): plus the sum of P_i A_i.d_i over them, d_i
     *  their displacements, with their half cells. */
    double wall_work_momentum;
    /** Work of the walls on the fluid from the forces of force probes [J]: sum of P_i A_i.u_i dt
     *  over the wall particles, P_i their pressure, A_i their area, u_i their velocity, and by
     *  reactions. It is the work that a user computes from force probes. It includes the half cells
     *  at walls, which have no fluid particle (see above), and is not in the budget:
     *  docs/explanations/walls.md. */
    double wall_work_probes;
    /** Dissipated by the library's models of MPS_FORCE: viscosity, friction at walls, damping,
     *  tension [J]. Without those of the slots "friction" and "layer", see
     *  below. */
    double viscous;
    /** Loss by models of plug-ins, in MPS_FORCE and MPS_VELOCITY [J]. If they report the forces of
     *  solids (mps_stage_reaction()), it is the dissipation of these; < 0: gain, e.g. by a driving
     *  force. */
    double plugins;
    /** Loss by collisions, and by thin plates that stop droplets [J]. */
    double collision;
    /** Loss by particle shifting, kinetic and potential [J]. */
    double shift;
    /** Residual of the budget [J]: wall_work_momentum + gas + added - viscous - plugins - collision
     *  - shift - friction - d(kinetic + potential + layers), d: change since before the first
     *  step. */
    double numerical;
    /** Mass of the fluid particles [kg]. */
    double mass;
    /** Volume of the fluid particles [m3 or m2]: sum m/rho, divided by 1 + mean volume deviation of
     *  fluid below the first band of the surface. */
    double volume;
    /** This mean deviation in the first step minus its current value; > 0: expanded. */
    double volume_error;
    /** Centre of mass of the fluid particles, frame of the lab [m]. */
    double centre[3];
    /** [kg m/s] */
    double momentum[3];
    /** Kinetic + potential energy added from outside since before the first step [J]; < 0: removed.
     *  By particles added, removed and lost, densities set, fields written between steps, a tank
     *  moved by a new motion, and MPS_START_WITH_TANK. */
    double added;
    /** `volume` with the half cells at walls [m3 or m2]; compare it with the volume of the
     *  liquid. */
    double volume_filled;
    /** `mass` with the half cells at walls [kg]: the mean density times volume_filled. With several
     *  phases it is exact only if their wetted areas are proportional to their volumes. */
    double mass_filled;
    /** Dissipated by the library's models of the slots "friction", at walls that have no particles,
     *  and "layer", at walls whose layers are thin [J]. "layer" includes the kinetic energy of the
     *  layers. */
    double friction;
    /** Kinetic energy of the fluid in addition to `kinetic`, after the last step, as models report
     *  it by mps_stage_kinetic(): of layers at walls that have no particles [J]. */
    double layers;
    /** Work of trapped gas on the liquid [J]: sum of p A.u dt over the particles at the surface of
     *  a pocket, see mps_stage_gas(). Negative while a pocket is compressed. */
    double gas;
} mps_energy;

/** Set struct_size and zero. @param size  sizeof(mps_energy) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_energy_init(mps_energy *energy, size_t size);

/** Measure energies at the current time. @param energy  initialised by mps_energy_init(); out
 *  @return MPS_E_ARG, MPS_E_NOMEM, MPS_E_BUSY (called from a verb or a callback) */
MPS_API mps_status mps_energy_get(mps_sim *sim, mps_energy *energy);

/** Momentum of the fluid particles (per metre of width in 2-D) and its changes since the first step
 *  [kg m/s]:
 *    total = that before the first step + gravity + force + plugins + pressure + collision + shift
 *  + added + friction. */
typedef struct mps_momentum {
    /** Set by mps_momentum_init(). */
    uint32_t struct_size;
    /** sum m u at the current time */
    double total[3];
    /** Weight times time. */
    double gravity[3];
    /** By the library's models of MPS_FORCE: friction at walls; pairs inside the fluid contribute
     *  nothing. Without those of the slots "friction" and "layer". */
    double force[3];
    /** By models of plug-ins, in MPS_FORCE and MPS_VELOCITY. */
    double plugins[3];
    /** The part of force, friction, plugins and collision that solids exert, as models report it by
     *  mps_stage_reaction(). */
    double reaction[3];
    /** By pressure gradients, on the fluid particles. */
    double pressure[3];
    /** By the pressure of the walls, as in force probes: integral over time of the sum of P_i A_i,
     *  P_i the wall pressure. */
    double walls[3];
    /** pressure - walls: weight and inertia of the half cells at walls (of order dp), and the
     *  gradient, which is exact for linear pressures and does not conserve momentum. */
    double numerical[3];
    /** By collisions, also with walls, and by thin plates that stop droplets. */
    double collision[3];
    /** By velocities transported with shifted particles. */
    double shift[3];
    /** From outside, as in mps_energy. */
    double added[3];
    /** By the library's models of the slots "friction" and "layer", with the inertia of the
     *  layers. */
    double friction[3];
} mps_momentum;

/** Set struct_size and zero. @param size  sizeof(mps_momentum) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_momentum_init(mps_momentum *momentum, size_t size);

/** Measure the momentum at the current time. @param momentum  initialised by mps_momentum_init();
 *  out
 *  @return MPS_E_ARG, MPS_E_BUSY (called from a verb or a callback) */
MPS_API mps_status mps_momentum_get(mps_sim *sim, mps_momentum *momentum);

MPS_END_DECLS

#endif
