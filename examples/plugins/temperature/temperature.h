/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of the model "temperature.conduction". */
#ifndef TEMPERATURE_H
#define TEMPERATURE_H

#include <mps/model.h>

extern const mps_model_ops temperature_conduction;

#endif
