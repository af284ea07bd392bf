/* SPDX-License-Identifier: BSD-3-Clause */
/* Plug-ins whose loops run on a device. plugins.c includes public headers only. */
#ifndef SHADOW_PLUGINS_H
#define SHADOW_PLUGINS_H

#include <mps/model.h>
#include <mps/ppe.h>

/* "test.neumann": z = (2 D^-1 - D^-1 A D^-1) r. */
extern const mps_preconditioner_ops plugin_neumann;
/* "test.cg": conjugate gradients. */
extern const mps_solver_ops plugin_cg;
/* "drag.mean": pulls fluid towards the mean velocity, and each particle towards its neighbours. */
extern const mps_model_ops plugin_drag;
/* "mark.region": gives a particle a region that does not exist if its setting "bad" is 1. */
extern const mps_model_ops plugin_mark;

#endif
