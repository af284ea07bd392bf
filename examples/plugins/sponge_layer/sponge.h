/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of the model "sponge.layer". */
#ifndef SPONGE_H
#define SPONGE_H

#include <mps/model.h>

extern const mps_model_ops sponge_layer;

#endif
