/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of the model "baffle.porous". */
#ifndef BAFFLE_H
#define BAFFLE_H

#include <mps/model.h>

extern const mps_model_ops baffle_porous;

#endif
