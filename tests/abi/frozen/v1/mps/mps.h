/* SPDX-License-Identifier: BSD-3-Clause */
/** @file mps.h  All headers for users of libmps. Authors of plug-ins also include model.h or
 *  ppe.h. */
#ifndef MPS_MPS_H
#define MPS_MPS_H

#include <mps/body.h>
#include <mps/couple.h>
#include <mps/exact.h>
#include <mps/geometry.h>
#include <mps/list.h>
#include <mps/motion.h>
#include <mps/operators.h>
#include <mps/output.h>
#include <mps/parallel.h>
#include <mps/particles.h>
#include <mps/probe.h>
#include <mps/ranks.h>
#include <mps/ship.h>
#include <mps/sim.h>
#include <mps/status.h>
#include <mps/step.h>
#include <mps/types.h>
#include <mps/version.h>

#endif
