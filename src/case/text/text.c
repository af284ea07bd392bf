/* SPDX-License-Identifier: BSD-3-Clause */
#include <mps/case.h>
