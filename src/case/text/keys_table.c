/* SPDX-License-Identifier: BSD-3-Clause */
/* All keys of case files, in the order of the reference. */
#include "keys.h"
#include "units.h"

#define MAP(path, help)                                                \
    {                                                                  \
        path, SHAPE_MAP, 0, 0, 0, "", NULL, false, false, "", "", help \
    }
#define MAPS(path, help)                                                \
    {                                                                   \
        path, SHAPE_MAPS, 0, 0, 0, "", NULL, false, false, "", "", help \
    }
#define NAMES(path, help)                                                \
    {                                                                    \
        path, SHAPE_NAMES, 0, 0, 0, "", NULL, false, false, "", "", help \
    }
#define ITEM(path, help)                                               \
    {                                                                  \
        path, SHAPE_MAP, 0, 0, 0, "", NULL, false, false, "", "", help \
    }
/* a quantity, several quantities, and points */
#define ONE(path, units, range, otherwise, example, help)                                     \
    {                                                                                         \
        path, SHAPE_NUMBERS, units, 1, 1, range, NULL, false, false, otherwise, example, help \
    }
#define MUST(path, units, range, example, help)                                       \
    {                                                                                 \
        path, SHAPE_NUMBERS, units, 1, 1, range, NULL, true, false, "", example, help \
    }
#define MANY(path, units, few, many, range, otherwise, example, help)                              \
    {                                                                                              \
        path, SHAPE_NUMBERS, units, few, many, range, NULL, false, false, otherwise, example, help \
    }
#define WHOLE(path, range, otherwise, example, help)                                             \
    {                                                                                            \
        path, SHAPE_NUMBERS, UNIT_NONE, 1, 1, range, NULL, false, true, otherwise, example, help \
    }
#define POINTS(path, few, many, example, help)                                                \
    {                                                                                         \
        path, SHAPE_POINTS, UNIT_LENGTH, few, many, "", NULL, false, false, "", example, help \
    }
/* texts */
#define TEXT(path, otherwise, example, help)                                        \
    {                                                                               \
        path, SHAPE_TEXT, 0, 1, 1, "", NULL, false, false, otherwise, example, help \
    }
#define TEXTS(path, example, help)                                              \
    {                                                                           \
        path, SHAPE_TEXTS, 0, 1, 256, "", NULL, false, false, "", example, help \
    }
#define WORD(path, words, otherwise, help)                                             \
    {                                                                                  \
        path, SHAPE_WORD, 0, 1, 1, "", words, false, false, otherwise, otherwise, help \
    }
#define FLAG(path, otherwise, help)                                               \
    {                                                                             \
        path, SHAPE_FLAG, 0, 1, 1, "", NULL, false, false, otherwise, "yes", help \
    }
#define FILES(path, example, help)                                           \
    {                                                                        \
        path, SHAPE_FILE, 0, 1, 1, "", NULL, false, false, "", example, help \
    }
#define AUNIT(path, units, otherwise, example, help)                                    \
    {                                                                                   \
        path, SHAPE_UNIT, units, 1, 1, "", NULL, false, false, otherwise, example, help \
    }

#define MOVE      "motion.surge|sway|heave"
#define TURN      "motion.roll|pitch|yaw"
#define BOTH      "motion.surge|sway|heave|roll|pitch|yaw"
#define BODY_MOVE "body.surge|sway|heave"
#define BODY_TURN "body.roll|pitch|yaw"
#define BODY_LOAD "body.surge|sway|heave|roll|pitch|yaw.load"

/* clang-format off */
const mps__key mps__keys[] = {
    MAP("", "a case"),
    {"mps", SHAPE_NUMBERS, UNIT_NONE, 1, 1, "1 .. 1", NULL, true, true, "", "1", "version of the format"},
    TEXT("title", "", "Surge tank", "one line for people; default: the name of the file"),
    FILES("base", "lng.yaml", "a case that this one changes"),
    WHOLE("dim", "2 .. 3", "2", "3", "dimensions"),
    {"dp", SHAPE_NUMBERS, UNIT_LENGTH, 1, 1, "1e-9 m .. 1e6 m", NULL, true, false, "", "4 mm", "spacing of the particles"},
    ONE("gravity", UNIT_ACCEL, ">= 0", "9.81 m/s2", "9.81 m/s2", "acceleration of gravity, downwards"),

    {"tank", SHAPE_MAP, 0, 0, 0, "", NULL, true, false, "", "{size: 0.8 0.5 m}", "the tank; y is up"},
    MANY("tank.size", UNIT_LENGTH, COUNT_DIM, COUNT_DIM, "> 0", "", "0.8 0.5 m", "inner size of a box"),
    MANY("tank.at", UNIT_LENGTH, COUNT_DIM, COUNT_DIM, "", "0", "0 0 m", "lower corner of the box"),
    ONE("tank.between_rows", UNIT_LENGTH, "", "", "0.75 m",
        "level midway between two rows of the lattice; the floor moves by up to half a spacing"),
    MAP("tank.chamfer", "chamfers of the box"),
    MANY("tank.chamfer.bottom", UNIT_LENGTH, 1, 2, "> 0", "", "95 95 mm", "at the floor: width and height; one number is both"),
    MANY("tank.chamfer.top", UNIT_LENGTH, 1, 2, "> 0", "", "215 215 mm", "at the ceiling: width and height; one number is both"),
    WORD("tank.chamfer.across", "x|z", "x", "horizontal axis across which the chamfers are"),
    POINTS("tank.polygon", 3, 1000, "[0 0 m, 2 0 m, 1 1.5 m]", "outline in the plane x, y; in 3-D a prism of this `width`"),
    ONE("tank.width", UNIT_LENGTH, "> 0", "", "0.3 m", "of a polygon along z; 3-D"),
    MAP("tank.cylinder", "a cylinder whose ends may be elliptical heads; its lowest point is at y = 0"),
    MUST("tank.cylinder.radius", UNIT_LENGTH, "> 0", "0.25 m", "radius"),
    ONE("tank.cylinder.length", UNIT_LENGTH, "> 0", "", "0.6 m", "straight part; 3-D"),
    ONE("tank.cylinder.heads", UNIT_LENGTH, ">= 0", "0", "0.125 m", "depth of each head; 0: flat ends"),
    WORD("tank.cylinder.axis", "x|y|z", "x", "axis; 2-D: a circle"),
    MAP("tank.sphere", "a sphere; its lowest point is at y = 0"),
    MUST("tank.sphere.radius", UNIT_LENGTH, "> 0", "0.5 m", "radius"),
    FILES("tank.stl", "tank.stl", "closed surface of triangles; 3-D"),
    AUNIT("tank.unit", UNIT_LENGTH, "", "mm", "unit of the STL file"),
    WORD("tank.up", "x|y|z", "y", "axis of the STL file that points up"),
    MANY("tank.turn", UNIT_ANGLE, 3, 3, "", "0", "0 90 0 deg", "turns of the STL file about x, y, z, after `up`"),
    MANY("tank.shift", UNIT_LENGTH, 3, 3, "", "0", "0 0 1 m", "shift of the STL file, after its turns"),
    WORD("tank.open", "no|top|x0|x1|y0|z0|z1", "no", "side without a wall; a box: top"),
    WHOLE("tank.dummies", "1 .. 10", "2", "2", "layers of particles behind the walls"),
    POINTS("domain", 2, 2, "[-1 -1 m, 2 3 m]", "corners of the box beyond which particles are lost; default: by the solids"),

    NAMES("solids", "bodies that move with the tank"),
    ITEM("solids.*", "a body"),
    POINTS("solids.*.box", 2, 2, "[0.4 0 m, 0.41 0.2 m]", "corners of a box; one thinner than 3 dp is on the lattice, and may be a plate"),
    POINTS("solids.*.plate", 2, 3, "[475 0 mm, 475 250 mm]",
           "a plate without thickness, anywhere: its ends; in 3-D three corners, the first between the others"),
    ONE("solids.*.thickness", UNIT_LENGTH, "> 0", "", "6 mm", "of an upright plate: it gets whole columns of the lattice"),
    POINTS("solids.*.prism", 3, 1000, "[0 0 m, 1 0 m, 0 0.3 m]", "polygon in the plane x, y; in 3-D from side to side or `between`"),
    MANY("solids.*.between", UNIT_LENGTH, 2, 2, "", "", "0 0.2 m", "ends of a prism along z; 3-D"),
    MAP("solids.*.sphere", "a sphere, in 2-D a circle"),
    {"solids.*.sphere.centre", SHAPE_NUMBERS, UNIT_LENGTH, COUNT_DIM, COUNT_DIM, "", NULL, true, false, "", "0.5 0.5 m", "centre"},
    MUST("solids.*.sphere.radius", UNIT_LENGTH, "> 0", "50 mm", "radius"),
    MAP("solids.*.cylinder", "a cylinder with flat ends; 3-D"),
    {"solids.*.cylinder.from", SHAPE_NUMBERS, UNIT_LENGTH, 3, 3, "", NULL, true, false, "", "0.5 0 0.5 m", "middle of an end"},
    {"solids.*.cylinder.to", SHAPE_NUMBERS, UNIT_LENGTH, 3, 3, "", NULL, true, false, "", "0.5 1 0.5 m", "middle of the other end"},
    MUST("solids.*.cylinder.radius", UNIT_LENGTH, "> 0", "50 mm", "radius"),
    FILES("solids.*.stl", "pump.stl", "closed surface of triangles; 3-D"),
    AUNIT("solids.*.unit", UNIT_LENGTH, "", "mm", "unit of the STL file"),
    WORD("solids.*.up", "x|y|z", "y", "axis of the STL file that points up"),
    MANY("solids.*.turn", UNIT_ANGLE, 3, 3, "", "0", "0 90 0 deg", "turns of the STL file about x, y, z, after `up`"),
    MANY("solids.*.shift", UNIT_LENGTH, 3, 3, "", "0", "0 0 1 m", "shift of the STL file, after its turns"),
    MAP("solids.*.holes", "evenly spaced slots of a plate; in 3-D along its second side"),
    MUST("solids.*.holes.pitch", UNIT_LENGTH, "> 0", "60 mm", "distance of their middles"),
    MUST("solids.*.holes.open", UNIT_SHARE, "> 0, < 1", "40 %", "share of the plate that is open"),

    NAMES("fluids", "fluids; water and air are known: 1000 kg/m3, 1 mPa s and 1.29 kg/m3, 0.015 mPa s"),
    ITEM("fluids.*", "a fluid"),
    ONE("fluids.*.density", UNIT_DENSITY, "> 0", "", "450 kg/m3", "density; must be given but for water and air"),
    ONE("fluids.*.viscosity", UNIT_VISCOSITY, ">= 0", "1 mPa s", "0.13 mPa s", "dynamic or kinematic viscosity; default of air: 0.015 mPa s"),
    ONE("fluids.*.tension", UNIT_TENSION, ">= 0", "", "72.7 mN/m", "surface tension against the other fluids; default: that of the model"),

    {"fill", SHAPE_FILLS, 0, 1, 64, "", NULL, true, false, "", "[{water: {depth: 30 %}}, {air: rest}]",
     "fluids in the order in which they are filled in; each takes what is still free"},
    {"fill.*", SHAPE_MAP, 0, 0, 0, "", "rest", false, false, "", "rest", "a fluid by its name; `rest`: all that is free"},
    ONE("fill.*.depth", UNIT_LENGTH | UNIT_SHARE, "> 0", "", "30 %", "depth above the lowest point of the tank; share of its height"),
    FLAG("fill.*.whole_rows", "no", "the depth ends with the last whole row of the lattice; always so below another fluid"),
    POINTS("fill.*.box", 2, 2, "[0 0 m, 0.6 0.3 m]", "corners of a box"),
    POINTS("fill.*.polygon", 3, 1000, "[0 0 m, 1 0 m, 0 0.5 m]", "outline in the plane x, y"),
    MAP("fill.*.sphere", "a sphere, in 2-D a circle"),
    {"fill.*.sphere.centre", SHAPE_NUMBERS, UNIT_LENGTH, COUNT_DIM, COUNT_DIM, "", NULL, true, false, "", "0.5 0.5 m", "centre"},
    MUST("fill.*.sphere.radius", UNIT_LENGTH, "> 0", "0.25 m", "radius"),
    MAP("fill.*.wave", "what lies below y = level + amplitude sin(2 pi x/length + phase)"),
    MUST("fill.*.wave.level", UNIT_LENGTH, "", "1 m", "mean level"),
    MUST("fill.*.wave.amplitude", UNIT_LENGTH, "", "-0.15 m", "amplitude"),
    MUST("fill.*.wave.length", UNIT_LENGTH, "> 0", "1 m", "length of the wave"),
    ONE("fill.*.wave.phase", UNIT_ANGLE, "", "0", "90 deg", "phase at x = 0"),
    MAP("fill.*.start", "how the fluid moves at the start, at rest if this is not given"),
    MANY("fill.*.start.velocity", UNIT_VELOCITY, COUNT_DIM, COUNT_DIM, "", "0", "1 0 m/s", "velocity of all of it"),
    ONE("fill.*.start.standing_wave", UNIT_LENGTH, "", "", "20 mm",
        "amplitude a of the standing wave a cos(pi x/L); particles are displaced as in linear theory"),
    ONE("fill.*.start.oscillation", UNIT_SHARE | UNIT_NONE, "> -1, < 1", "", "5 %",
        "second mode of a drop, 2-D: amplitude over radius of `sphere`; velocities of potential flow"),

    MAP("motion", "how the tank moves; all its degrees of freedom together"),
    MANY("motion.centre", UNIT_LENGTH, COUNT_DIM, COUNT_DIM, "", "0", "475 0 mm", "centre of rotation, in the tank at rest"),
    WORD("motion.start", "rest|tank", "rest", "velocity of the liquid at the start: none, or that of the tank"),
    WORD("motion.axes", "x forward, y port, z up|x forward, y starboard, z down|x forward, y up, z starboard",
         "x forward, y up, z starboard", "axes of the ship in motions and loads; must be given for a file in 3-D"),
    WORD("motion.forward", "x|z|-x|-z", "x", "direction of the bow in the axes of the tank; 2-D: z, a section across the ship, or x, one along it"),
    TEXT("motion.order", "yaw pitch roll", "roll pitch yaw", "order of the angles, as rotations about axes that turn with the ship; 3-D"),
    MAPS(MOVE, "along the axes of the ship; 2-D: surge (along x) and heave. A list of such maps: their sum"),
    ONE(MOVE ".amplitude", UNIT_LENGTH, "", "", "20 mm", "amplitude"),
    ONE(MOVE ".slope", UNIT_ANGLE, "", "", "0.25 deg",
        "instead of the amplitude: the angle whose product with g is the amplitude of the acceleration"),
    ONE(MOVE ".acceleration", UNIT_ACCEL, "", "", "-19.62 m/s2", "constant acceleration from rest"),
    MAPS(TURN, "about the axes of the ship; 2-D: roll, counterclockwise; pitch with `forward: x`. A list: their sum"),
    ONE(TURN ".amplitude", UNIT_ANGLE, "", "", "4 deg", "amplitude"),
    ONE(TURN ".acceleration", UNIT_ANG_ACCEL, "", "", "0.1 rad/s2", "constant acceleration from rest"),
    ONE(BOTH ".omega", UNIT_OMEGA, "> 0", "", "6.469 rad/s", "angular frequency"),
    ONE(BOTH ".period", UNIT_TIME, "> 0", "", "0.95 T1", "period"),
    ONE(BOTH ".frequency", UNIT_FREQUENCY, "> 0", "", "0.496 Hz", "frequency"),
    ONE(BOTH ".phase", UNIT_ANGLE, "", "0", "90 deg", "phase at t = 0"),
    WORD(BOTH ".form", "sine|cosine", "sine", "a sin(w t + phase), or -a (1 - cos(w t))"),
    ONE(BOTH ".ramp", UNIT_TIME | UNIT_NONE, ">= 0", "0", "2", "over which the amplitude grows: a time, or a number of periods"),
    MAP(MOVE ".jonswap", "irregular motion: random phases, spectrum of JONSWAP"),
    MUST(MOVE ".jonswap.significant", UNIT_LENGTH, "> 0", "2 m", "significant amplitude: twice the standard deviation"),
    MAP(TURN ".jonswap", "irregular motion: random phases, spectrum of JONSWAP"),
    MUST(TURN ".jonswap.significant", UNIT_ANGLE, "> 0", "4 deg", "significant amplitude: twice the standard deviation"),
    MUST(BOTH ".jonswap.peak", UNIT_TIME, "> 0", "8 s", "period of the peak of the spectrum"),
    ONE(BOTH ".jonswap.gamma", UNIT_NONE, "1 .. 10", "3.3", "3.3", "peakedness"),
    WHOLE(BOTH ".jonswap.seed", "0 .. 1000000", "1", "7", "of the phases; the same seed, the same motion"),
    WHOLE(BOTH ".jonswap.components", "10 .. 1000", "100", "200", "harmonics"),
    TEXT("motion.plugin", "", "towing_carriage", "motion of a plug-in, by its name; axes of the lab"),
    FILES("motion.file", "voyage.csv", "table of motions: names in its first line, units in brackets, e.g. PHI[deg]"),
    MAP("motion.columns", "names of columns of the file"),
    TEXT("motion.columns.time", "time", "time", "column of the time"),
    TEXT("motion.columns.surge|sway|heave|roll|pitch|yaw", "", "XG", "column of this degree of freedom"),
    MAP("motion.units", "units of columns that have none in the file"),
    AUNIT("motion.units.time", UNIT_TIME, "", "s", "unit of the time"),
    AUNIT("motion.units.surge|sway|heave", UNIT_LENGTH, "", "m", "unit of this column"),
    AUNIT("motion.units.roll|pitch|yaw", UNIT_ANGLE, "", "deg", "unit of this column"),
    ONE("motion.from", UNIT_TIME, "", "", "1200 s", "time of the file at the start of the run; default: its first"),
    ONE("motion.ramp", UNIT_TIME, ">= 0", "0", "20 s", "over which the motion of the file grows: roll and pitch from 0, the others from where they begin"),
    ONE("motion.cutoff", UNIT_FREQUENCY, "> 0", "", "2 Hz", "of a low-pass filter without phase shift, for a file of coarse resolution or with noise"),

    MAP("body", "a rigid body that carries the tank, instead of a motion: the liquid and its loads move it; 2-D: all per metre of width"),
    MANY("body.centre", UNIT_LENGTH, COUNT_DIM, COUNT_DIM, "", "0", "475 0 mm", "centre of rotation, of degrees and of moments, in the tank at rest"),
    MUST("body.mass", UNIT_MASS, ">= 0", "100 kg", "mass of the body without the liquid"),
    MANY("body.centre_of_mass", UNIT_LENGTH, COUNT_DIM, COUNT_DIM, "", "", "475 200 mm", "centre of mass without the liquid; default: the centre"),
    MANY("body.inertia", UNIT_INERTIA, 1, 6, "", "0", "25 kg m2", "about the centre of mass; 3-D: about x, y, z of the tank, or these and xy, xz, yz"),
    FLAG("body.gravity", "yes", "the weight of the body acts; no: buoyancy takes it, and the stiffness holds all restoring"),
    WORD("body.axes", "x forward, y port, z up|x forward, y starboard, z down|x forward, y up, z starboard",
         "x forward, y up, z starboard", "axes of the ship"),
    WORD("body.forward", "x|z|-x|-z", "x", "direction of the bow in the axes of the tank; 2-D: z, a section across the ship, or x, one along it"),
    TEXT("body.order", "yaw pitch roll", "roll pitch yaw", "order of the angles, as rotations about axes that turn with the ship; 3-D"),
    MAP(BODY_MOVE, "this degree is free; others stay where they are. Axes as those of a motion"),
    ONE(BODY_MOVE ".stiffness", UNIT_STIFFNESS, "", "0 N/m", "4 kN/m", "of a spring to the place at rest"),
    MAP(BODY_TURN, "this degree is free; others stay where they are. Axes as those of a motion"),
    ONE(BODY_TURN ".stiffness", UNIT_TURN_STIFFNESS, "", "0 N m/rad", "300 N m/rad", "of a spring to the place at rest"),
    ONE("body.surge|sway|heave|roll|pitch|yaw.period", UNIT_TIME, "> 0", "", "1 T1",
        "instead of the stiffness: natural period of the body without liquid, with its weight"),
    ONE(BODY_MOVE ".damping", UNIT_DAMPING | UNIT_SHARE, ">= 0", "0", "5 %", "of a damper, or share of the critical one without liquid"),
    ONE(BODY_TURN ".damping", UNIT_TURN_DAMPING | UNIT_SHARE, ">= 0", "0", "5 %", "of a damper, or share of the critical one without liquid"),
    ONE(BODY_MOVE ".friction", UNIT_FORCE, ">= 0", "0 N", "12 N", "dry friction (Coulomb): it holds the degree at rest up to this force, and acts against its motion"),
    ONE(BODY_TURN ".friction", UNIT_MOMENT, ">= 0", "0 N m", "3 N m", "dry friction (Coulomb): it holds the degree at rest up to this moment, and acts against its motion"),
    MAPS(BODY_MOVE ".load", "force along the degree, of waves or of a rig. A list of such maps: their sum"),
    ONE(BODY_MOVE ".load.amplitude", UNIT_FORCE, "", "", "10 N", "amplitude"),
    MAPS(BODY_TURN ".load", "moment, of waves or of a rig. A list of such maps: their sum"),
    ONE(BODY_TURN ".load.amplitude", UNIT_MOMENT, "", "", "10 N m", "amplitude"),
    ONE(BODY_LOAD ".omega", UNIT_OMEGA, "> 0", "", "6.469 rad/s", "angular frequency"),
    ONE(BODY_LOAD ".period", UNIT_TIME, "> 0", "", "0.95 T1", "period"),
    ONE(BODY_LOAD ".frequency", UNIT_FREQUENCY, "> 0", "", "0.496 Hz", "frequency"),
    ONE(BODY_LOAD ".phase", UNIT_ANGLE, "", "0", "90 deg", "phase at t = 0"),
    ONE(BODY_LOAD ".ramp", UNIT_TIME | UNIT_NONE, ">= 0", "0", "2", "over which the amplitude grows: a time, or a number of periods"),
    MAP(BODY_MOVE ".load.jonswap", "irregular load: random phases, spectrum of JONSWAP"),
    MUST(BODY_MOVE ".load.jonswap.significant", UNIT_FORCE, "> 0", "10 N", "significant amplitude: twice the standard deviation"),
    MAP(BODY_TURN ".load.jonswap", "irregular load: random phases, spectrum of JONSWAP"),
    MUST(BODY_TURN ".load.jonswap.significant", UNIT_MOMENT, "> 0", "10 N m", "significant amplitude: twice the standard deviation"),
    MUST(BODY_LOAD ".jonswap.peak", UNIT_TIME, "> 0", "8 s", "period of the peak of the spectrum"),
    ONE(BODY_LOAD ".jonswap.gamma", UNIT_NONE, "1 .. 10", "3.3", "3.3", "peakedness"),
    WHOLE(BODY_LOAD ".jonswap.seed", "0 .. 1000000", "1", "7", "of the phases; the same seed, the same load"),
    WHOLE(BODY_LOAD ".jonswap.components", "10 .. 1000", "100", "200", "harmonics"),
    MAP("body.load", "loads from a table, linear between its rows, beside those of the degrees"),
    TEXT("body.load.plugin", "", "magnet", "load of a plug-in, by its name; axes of the lab"),
    {"body.load.file", SHAPE_FILE, 0, 1, 1, "", NULL, false, false, "", "waves.csv", "table: names in its first line, units in brackets, e.g. MX[N m]"},
    MAP("body.load.columns", "names of columns of the file"),
    TEXT("body.load.columns.time", "time", "time", "column of the time"),
    TEXT("body.load.columns.surge|sway|heave|roll|pitch|yaw", "", "MX", "column of the load along this degree"),
    MAP("body.load.units", "units of columns that have none in the file"),
    AUNIT("body.load.units.time", UNIT_TIME, "", "s", "unit of the time"),
    AUNIT("body.load.units.surge|sway|heave", UNIT_FORCE, "", "N", "unit of this column"),
    AUNIT("body.load.units.roll|pitch|yaw", UNIT_MOMENT, "", "N m", "unit of this column"),
    ONE("body.load.from", UNIT_TIME, "", "", "1200 s", "time of the file at the start of the run; default: its first"),
    ONE("body.load.ramp", UNIT_TIME, ">= 0", "0", "20 s", "over which the load of the file grows"),

    NAMES("sensors", "what is measured; each is a column, or several, of probes.csv"),
    ITEM("sensors.*", "a sensor; it moves with the tank"),
    MANY("sensors.*.wall", UNIT_LENGTH, COUNT_DIM, COUNT_DIM, "", "", "0 50 mm", "pressure at a place on a wall"),
    POINTS("sensors.*.panel", 2, 4, "[0 455 mm, 215 670 mm]", "mean pressure of a panel on a wall: 2 ends; in 3-D 3 or 4 corners in order, or 2 opposite ones"),
    POINTS("sensors.*.row", 2, 2, "[0 0 m, 0.5 0.3 m]", "sensors evenly along a line on a wall, of which one value is taken"),
    MANY("sensors.*.pressure", UNIT_LENGTH, COUNT_DIM, COUNT_DIM, "", "", "0.4 0.1 m", "pressure at a place in the fluid"),
    MANY("sensors.*.gauge", UNIT_LENGTH, 1, 3, "", "", "1 dp",
         "surface along a line up from the floor at x, in 3-D at x and z, or from a whole point"),
    TEXT("sensors.*.force", "", "tank", "force and moment on a part: tank, tank.x0, name of a solid; all: on all walls"),
    WORD("sensors.*.load", "momentum|walls", "momentum",
         "load of the liquid in each step, by degrees of the ship: of its momentum, or of wall pressures"),
    TEXT("sensors.*.measure", "", "trapped gas", "a quantity of the list of measures"),
    ONE("sensors.*.diameter", UNIT_LENGTH, "> 0", "1 dp", "10 mm", "of a wall sensor; of the band of a gauge, 3 dp there"),
    MANY("sensors.*.normal", UNIT_NONE, COUNT_DIM, COUNT_DIM, "", "", "1 0", "direction from the wall into the liquid, where two walls are near"),
    ONE("sensors.*.average", UNIT_TIME, ">= 0", "", "2 ms", "mean over the last time; 0: none; default: the shortest that dp resolves; gauges: 0"),
    ONE("sensors.*.rate", UNIT_FREQUENCY, "> 0, <= 1 kHz", "", "500 Hz", "samples a second that are kept for means"),
    {"sensors.*.cells", SHAPE_NUMBERS, UNIT_NONE, 1, 2, "1 .. 1000", NULL, false, true, "1", "3",
     "sensors of a row; cells of a panel, in 3-D along both sides"},
    WORD("sensors.*.take", "largest|mean|place", "largest", "of a row: largest value, mean, or place of the largest along it"),
    MANY("sensors.*.direction", UNIT_NONE, COUNT_DIM, COUNT_DIM, "", "", "0 1", "of a gauge; default: up"),
    ONE("sensors.*.length", UNIT_LENGTH, "> 0", "", "0.5 m", "of the line of a gauge; default: to the end of the domain"),
    FLAG("sensors.*.drops", "no", "a gauge counts drops and films"),
    ONE("sensors.*.level", UNIT_LENGTH, "", "", "0.25 m", "of a gauge: its zero, default the still level; of a measure: where it asks for one"),
    MANY("sensors.*.about", UNIT_LENGTH, COUNT_DIM, COUNT_DIM, "", "0", "475 0 mm", "centre of moments, or of a measure; of a load: default that of the motion"),
    WORD("sensors.*.component", "all|x|y|z|mx|my|mz", "all", "of a force"),
    WORD("sensors.*.axes", "lab|ship|body", "lab", "of a force: axes of the lab, of the ship at rest, axes that turn with the ship"),
    TEXT("sensors.*.fluid", "", "air", "of a measure or gauge: the fluid it asks for"),
    WORD("sensors.*.axis", "x|y|z", "y", "of a measure"),
    POINTS("sensors.*.box", 2, 2, "[0 0 m, 1 2 m]", "of a measure: where it looks; default: the tank"),
    ONE("sensors.*.radius", UNIT_LENGTH, "> 0", "", "5 mm", "of a measure"),
    ONE("sensors.*.smoothing", UNIT_LENGTH, "> 0", "", "1.5 dp", "of a measure of an interface"),
    TEXT("sensors.*.part", "", "tank.y0", "of a measure: the part it looks at"),
    FLAG("sensors.*.change", "no", "of a measure: less its value at the start"),
    FLAG("sensors.*.at_end", "no", "of a measure: a figure of summary.json, not a column"),

    NAMES("figures", "numbers of summary.json, from a column between two times"),
    ITEM("figures.*", "a figure"),
    {"figures.*.column", SHAPE_TEXT, 0, 1, 1, "", NULL, true, false, "", "P1", "name of a sensor; momentum_x, momentum_y, momentum_z: of the fluid"},
    {"figures.*.take", SHAPE_WORD, 0, 1, 1, "", "largest|least|mean|change|integral|slope", true, false, "", "largest", "what is taken of it"},
    ONE("figures.*.from", UNIT_TIME, ">= 0", "0 s", "0.1 s", "begin"),
    ONE("figures.*.until", UNIT_TIME, "> 0", "", "0.2 s", "end; default: that of the run"),
    ONE("figures.*.window", UNIT_TIME, ">= 0", "0 s", "5 ms", "largest and least of means over this time"),
    ONE("figures.*.over", UNIT_ANY, "", "1", "500 Pa", "the figure is divided by this"),

    TEXT("model", "imps", "mmps", "preset of models: imps, or mmps for liquid and gas"),
    TEXTS("use", "[viscosity.pair]", "models that replace those of their slots"),
    TEXTS("remove", "[collision]", "slots that are switched off"),
    NAMES("settings", "settings of models, by slot.key"),
    {"settings.*", SHAPE_NUMBERS, UNIT_ANY, 1, 1, "", NULL, false, false, "", "340 m/s", "a number with the unit of the setting"},
    {"plugins", SHAPE_MAPS, 0, 0, 0, "", "FILE", false, false, "", "[libscreen.so]",
     "shared libraries with further models, solvers, loads and motions; a name without / is looked for in MPS_PLUGIN_PATH too"},
    {"plugins.file", SHAPE_TEXT, 0, 1, 1, "", NULL, true, false, "", "libscreen.so", "the library"},
    TEXT("plugins.sha256", "", "9f86d081884c7d65..", "SHA-256 that its file must have: cases of runs have it"),
    MAP("kernel", "weights of neighbours"),
    TEXT("kernel.name", "improved", "original", "name of the kernel"),
    ONE("kernel.near", UNIT_LENGTH, "> 0", "2.1 dp", "2.1 dp", "radius of number density, gradient and divergence"),
    ONE("kernel.far", UNIT_LENGTH, "> 0", "", "4.1 dp", "radius of Laplacians; default: by model and dimension"),

    MAP("impacts", "statistics of pressure peaks"),
    ONE("impacts.threshold", UNIT_PRESSURE, "> 0", "", "1 kPa", "u: an event begins where the pressure reaches it; default: by `deviations`"),
    ONE("impacts.deviations", UNIT_NONE, "> 0", "2", "3", "u is the mean and this many standard deviations of the signal, for a first look"),
    ONE("impacts.window", UNIT_TIME, ">= 0", "0.2 T1", "0.2 T1", "w: an event ends where the pressure stays below u for this time"),
    TEXTS("impacts.sensors", "[P1, P2]", "sensors that are looked at; default: all pressures"),
    ONE("impacts.from", UNIT_TIME, "", "", "10 T1", "samples before are not used"),
    ONE("impacts.until", UNIT_TIME, "", "", "60 T1", "samples after are not used"),
    ONE("impacts.rate", UNIT_FREQUENCY, "> 0", "", "20 kHz", "samples a second, linear between steps; default: as they are"),
    ONE("impacts.high_pass", UNIT_FREQUENCY, "> 0", "", "1 Hz", "frequency of a filter; default: none"),
    ONE("impacts.share", UNIT_SHARE | UNIT_NONE, "> 0, < 1", "50 %", "50 %", "s: rise and decay are measured between this share of the peak and the peak"),
    ONE("impacts.exposure", UNIT_TIME, "> 0", "3 h", "3 h", "D: time at full scale for which the largest pressure is asked"),
    ONE("impacts.exposure_ratio", UNIT_NONE, "> 0", "3", "3", "a warning is given where D is longer than so many records"),
    ONE("impacts.scale", UNIT_NONE, "> 0", "1", "40", "L: length at full scale over that of the model, by Froude"),
    ONE("impacts.density_ratio", UNIT_NONE, "> 0", "1", "0.45", "density at full scale over that of the model"),
    WHOLE("impacts.least_events", "2 .. 1000000", "30", "30", "events below which no distribution is fitted"),
    ONE("impacts.confidence", UNIT_SHARE | UNIT_NONE, "> 0, < 1", "90 %", "90 %", "share of the resamples in a band"),
    WHOLE("impacts.resamples", "0 .. 1000000", "1000", "1000", "resamples of a band; 0: no bands"),
    WHOLE("impacts.seed", "0 .. 1000000", "1", "1", "of the resamples"),
    ONE("impacts.dependence", UNIT_NONE, "> 0", "2", "2", "peaks are dependent where the correlation exceeds this over sqrt(N)"),

    NAMES("reference", "known values beside the results"),
    MAPS("reference.*", "by the name of a sensor, or by any name with `column` or `unit`"),
    FILES("reference.*.file", "crests.csv", "table: names in its first line, units in brackets"),
    TEXTS("reference.*.columns", "[t, eta]", "columns of the time and of the value; default: the first two"),
    MANY("reference.*.times", UNIT_TIME, 1, COUNT_MOST, "", "", "1.1 2.1 3.2 s", "times, instead of a file"),
    MANY("reference.*.values", UNIT_ANY, 1, COUNT_MOST, "", "", "66 123 179 mm", "values at these times"),
    TEXT("reference.*.label", "reference", "potential flow", "what they are"),
    TEXT("reference.*.column", "", "eta_left", "sensor that they belong to; default: the name"),
    AUNIT("reference.*.unit", UNIT_ANY, "", "mm", "unit of values without one; without `column`: all sensors of this unit"),
    ONE("reference.*.shift", UNIT_TIME, "", "0 s", "-0.1 s", "added to the times"),
    WORD("reference.*.style", "marks|line", "marks", "how they are drawn"),

    {"run", SHAPE_MAP, 0, 0, 0, "", NULL, true, false, "", "{until: 60 T1}", "the run"},
    MUST("run.until", UNIT_TIME, "> 0", "60 T1", "time to simulate"),
    ONE("run.cfl", UNIT_NONE, "> 0, <= 1", "0.3", "0.3", "adaptive step: largest dt u/dp"),
    ONE("run.calm", UNIT_NONE, "> 0, <= 1", "", "0.06", "adaptive step: largest dt sqrt(g/dp); default: by model"),
    ONE("run.viscous", UNIT_NONE, "> 0", "0.2", "0.2", "adaptive step: largest dt nu/dp2"),
    ONE("run.growth", UNIT_NONE, "> 1", "1.1", "1.1", "largest ratio of a step to the one before"),
    ONE("run.dt", UNIT_TIME, "> 0", "", "0.5 ms", "a fixed step; default: adaptive"),
    ONE("run.step_factor", UNIT_NONE, "> 0, <= 2", "1", "0.998", "cfl, calm, viscous, dt and dt_max times this; varied by mps repeat"),
    ONE("run.dt_max", UNIT_TIME, "> 0", "", "1 ms", "longest step"),
    ONE("run.dt_min", UNIT_TIME, "> 0", "", "1 us", "shortest step, below which the run ends"),
    ONE("run.velocity_scale", UNIT_VELOCITY, "> 0", "", "0.1 m/s", "velocity of limits and of steps; default: sqrt(g dp)"),
    ONE("run.speed_limit", UNIT_VELOCITY, "> 0", "1000 m/s", "100 m/s", "a faster particle ends the run"),
    WORD("run.lost", "remove|error", "remove", "particles beyond the domain are removed, or end the run"),
    TEXT("run.solver", "sundials.pcg", "sundials.pcg", "pressure solver"),
    TEXT("run.preconditioner", "", "ic0", "preconditioner; default: that of the solver"),
    ONE("run.tolerance", UNIT_NONE, "> 0, < 1", "1e-6", "1e-6", "relative residual of the pressure equation"),
    ONE("run.divergence", UNIT_NONE, ">= 0", "1e-4", "1e-4", "largest divergence times dt that the solver leaves; 0: any"),
    WHOLE("run.iterations", "1 .. 1000000", "2000", "2000", "most iterations of the solver"),
    WHOLE("run.threads", "1 .. 1024", "2", "16", "threads; results do not depend on them"),
    ONE("run.average", UNIT_TIME, ">= 0", "", "0 s", "mean of pressures and forces of sensors that have no `average`"),
    ONE("run.checkpoint", UNIT_TIME, "> 0", "", "20 s", "simulated time between checkpoints, besides those by the clock"),
    ONE("run.checkpoint_clock", UNIT_TIME, ">= 0", "10 min", "30 min", "clock time between checkpoints; 0: none by the clock"),

    MAP("output", "what is written"),
    ONE("output.rate", UNIT_FREQUENCY, "> 0, <= 1e6 Hz", "1 kHz", "1 kHz", "rows a second of probes.csv"),
    WHOLE("output.frames", "0 .. 100000", "", "300",
          "frames besides the first; default: 20 a period (motion or T1), 50 or more, as the page has space"),
    WHOLE("output.peaks", "0 .. 10", "10", "3", "peaks of each pressure with finer frames about them; 0: none"),
    WORD("output.frame", "lab|tank", "lab", "axes of the frames"),
    FLAG("output.pieces", "no", "with several ranks: each writes its own part of a frame"),
    MANY("output.pictures", UNIT_TIME, 1, 24, "> 0", "", "2.2 2.3 s", "times of pictures; default: quarters of the run"),
    FLAG("output.film", "no", "a film, where ffmpeg is installed"),
    ONE("output.page", UNIT_BYTES, ">= 0", "12 MB", "12 MB", "most bytes of report.html, 500 kB or more; 0: none"),
    FLAG("output.trace", "no", "trace.csv: all columns after each step"),
    FLAG("output.profile", "no", "a table of what each pass of the steps costs"),

    {"set", SHAPE_PATHS, 0, 0, 0, "", NULL, false, false, "", "{run.until: 30 T1}", "values by path; they win over `base` and over this file"},
    {"sweep", SHAPE_PATHS, 0, 0, 0, "", NULL, false, false, "", "{motion.roll.period: 0.8 0.9 1 T1}",
     "values of a path, one run each: a list, or `1 to 2 step 0.1 s`; several paths: all combinations"},
    TEXTS("collect", "[P1.max, F.harmonic]", "statistics of the sweep's table, sensor.max, .min, .mean, .last, .p3h, .p3h_pareto, .harmonic"),
};

const mps__key_group mps__key_groups[] = {
    {"", "motion|body", false},
    {"body.surge|sway|heave|roll|pitch|yaw", "stiffness|period", false},
    {BODY_LOAD, "omega|period|frequency|jonswap", true},
    {BODY_LOAD, "amplitude|jonswap", true},
    {"motion", "file|plugin", false},
    {"tank", "size|polygon|cylinder|sphere|stl", true},
    {"solids.*", "box|plate|prism|sphere|cylinder|stl", true},
    {"fill.*", "depth|box|polygon|sphere|wave", true},
    {"fill.*.start", "velocity|standing_wave|oscillation", true},
    {BOTH, "omega|period|frequency|acceleration|jonswap", true},
    {MOVE, "amplitude|slope|acceleration|jonswap", true},
    {TURN, "amplitude|acceleration|jonswap", true},
    {"sensors.*", "wall|panel|row|pressure|gauge|force|load|measure", true},
    {"reference.*", "file|times", true},
};

/* Keys that need another key. */
const mps__key_group mps__key_needs[] = {
    {"tank", "stl|unit", true},          {"solids.*", "stl|unit", true},        
    {"reference.*", "times|values", true}, {"reference.*", "values|times", true},
};
/* clang-format on */

const int32_t mps__keys_count = sizeof mps__keys / sizeof mps__keys[0];
const int32_t mps__key_groups_count = sizeof mps__key_groups / sizeof mps__key_groups[0];
const int32_t mps__key_needs_count = sizeof mps__key_needs / sizeof mps__key_needs[0];
