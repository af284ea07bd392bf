/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef STUB_NVECTOR_SERIAL_H
#define STUB_NVECTOR_SERIAL_H
#include <sundials/sundials_nvector.h>
N_Vector N_VMake_Serial(sunindextype n, sunrealtype *data, SUNContext context);
#endif
