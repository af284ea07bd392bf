/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of the model "inflow.jet". */
#ifndef INFLOW_H
#define INFLOW_H

#include <mps/model.h>

extern const mps_model_ops inflow_jet;

#endif
