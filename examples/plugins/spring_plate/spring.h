/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of the model "body.spring". */
#ifndef SPRING_H
#define SPRING_H

#include <mps/model.h>

extern const mps_model_ops body_spring;

#endif
