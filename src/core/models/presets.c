/* SPDX-License-Identifier: BSD-3-Clause */
/* Presets: lists of models and settings. */
#include "built_in.h"
#include <stddef.h>

/* W22 (1)-(12), Z14 (9)-(17), literally (W22: Wen, Zhao & Wan 2022; Z14: Zhang, Wan & Hino
 * 2014). */
static const mps__preset_line imps_paper[] = {{"surface.asymmetry", NULL, 0},
                                              {"surface.asymmetry", "spray", 0},
                                              {"surface.asymmetry", "walls", 1},
                                              {"surface.asymmetry", "complete", 0},
                                              {"surface.asymmetry", "contact", 0},
                                              {"surface.asymmetry", "film", 100},
                                              {"surface.asymmetry", "lone", 0.8},
                                              {"wall.extrapolate", NULL, 0},
                                              {"viscosity.laplacian", NULL, 0},
                                              {"viscosity.laplacian", "mirror", 0},
                                              {"source.mixed", NULL, 0},
                                              {"gradient.conservative", NULL, 0},
                                              {"collision.pair", NULL, 0},
                                              {"collision.pair", "distance", 0.9},
                                              {NULL, NULL, 0}};

/* Stable and accurate: docs/explanations/scheme.md. */
static const mps__preset_line imps[] = {
    {"surface.asymmetry", NULL, 0},   {"wall.half", NULL, 0},
    {"body.free", NULL, 0},           {"moments.bounded", NULL, 0},
    {"viscosity.laplacian", NULL, 0}, {"dissipation.radial", NULL, 0},
    {"source.volume", NULL, 0},       {"separation.void", NULL, 0},
    {"gradient.corrected", NULL, 0},  {"load.reaction", NULL, 0},
    {"collision.pair", NULL, 0},      {"collision.pair", "restitution", 0},
    {"shift.tangential", NULL, 0},    {NULL, NULL, 0}};

/* Several phases, phase 1 a gas: the operators of imps, stable and accurate at a density ratio of
 * 1000 : 1. docs/explanations/two_phases.md. */
static const mps__preset_line mmps[] = {
    {"surface.detached", NULL, 0},    {"wall.half", NULL, 0},
    {"density.interface", NULL, 0},   {"moments.bounded", NULL, 0},
    {"moments.bounded", "torn", 0.7}, {"viscosity.pair", NULL, 0},
    {"viscosity.pair", "stress", 1},  {"dissipation.radial", NULL, 0},
    {"tension.jump", NULL, 0},        {"source.volume", NULL, 0},
    {"source.volume", "clip", 0.5},   {"source.volume", "rapid", 3},
    {"gas.compressible", NULL, 0},    {"reference.lid", NULL, 0},
    {"cavitation.vapour", NULL, 0},   {"gradient.corrected", NULL, 0},
    {"load.reaction", NULL, 0},       {"drag.lone", NULL, 0},
    {"collision.pair", NULL, 0},      {"collision.pair", "restitution", 0},
    {"shift.tangential", NULL, 0},    {NULL, NULL, 0}};

/* W22 (10)-(26) literally; settings define what the paper leaves open: the weight of a particle's
 * own density, the collision distance. */
static const mps__preset_line mmps_paper[] = {{"wall.extrapolate", NULL, 0},
                                              {"density.smooth", NULL, 0},
                                              {"viscosity.pair", NULL, 0},
                                              {"viscosity.pair", "mirror", 0},
                                              {"tension.csf", NULL, 0},
                                              {"source.mixed", NULL, 0},
                                              {"gas.compressible", NULL, 0},
                                              {"gas.compressible", "printed", 1},
                                              {"reference.gas", NULL, 0},
                                              {"gradient.density", NULL, 0},
                                              {"collision.pair", NULL, 0},
                                              {"collision.pair", "distance", 0.8},
                                              {NULL, NULL, 0}};

const mps__preset mps__presets[MPS__PRESETS] = {
    {"imps", "one liquid with a free surface: stable and accurate; the default", imps},
    {"imps.paper", "one liquid by W22 (1)-(12), as published; for comparison", imps_paper},
    {"mmps", "several phases that fill the tank, phase 1 a gas: stable and accurate", mmps},
    {"mmps.paper", "several phases by W22 (10)-(26), as published; for comparison", mmps_paper}};
