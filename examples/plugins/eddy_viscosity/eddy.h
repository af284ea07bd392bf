/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of the model "eddy.smagorinsky". */
#ifndef EDDY_H
#define EDDY_H

#include <mps/model.h>

extern const mps_model_ops eddy_smagorinsky;

#endif
