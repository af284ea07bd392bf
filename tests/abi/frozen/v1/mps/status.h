/* SPDX-License-Identifier: BSD-3-Clause */
/** @file status.h  Status codes: 0: done; positive: succeeded with a warning; negative: failed, the
 *  state is unchanged. */
#ifndef MPS_STATUS_H
#define MPS_STATUS_H

#include <mps/export.h>
#include <stdint.h>

/** Result of every function that can fail; one of the MPS_... constants below. */
typedef int32_t mps_status;

/** The one list of status codes: X(constant, value, meaning). */
#define MPS_STATUS_LIST(X)                                                                      \
    X(MPS_OK, 0, "done")                                                                        \
    X(MPS_W_NOT_CONVERGED, 1, "advanced, but the pressure residual stayed above its tolerance") \
    X(MPS_W_STOPPED, 2, "the monitor asked to stop")                                            \
    X(MPS_E_ARG, -1, "an argument is out of its range")                                         \
    X(MPS_E_NOMEM, -2, "an allocation failed")                                                  \
    X(MPS_E_BUSY, -3, "a lease is open, or the call is not allowed now")                        \
    X(MPS_E_NAME, -4, "no model, solver, field or part has this name")                          \
    X(MPS_E_STATE, -5, "the call is not allowed now")                                           \
    X(MPS_E_DIVERGED, -6, "a value became NaN or left every physical range")                    \
    X(MPS_E_LOST, -7, "a particle left the domain or is behind a wall")                         \
    X(MPS_E_SOLVER, -8, "the pressure solver broke down")                                       \
    X(MPS_E_PLUGIN, -9, "a plug-in reported a failure")                                         \
    X(MPS_E_IO, -10, "a file could not be read or written")                                     \
    X(MPS_E_VERSION, -11, "a struct or a table comes from a newer version")                     \
    X(MPS_E_RANKS, -12, "another rank failed, or the messages between ranks did")

#define MPS_STATUS_ENUM(name, value, meaning) name = (value),
enum { MPS_STATUS_LIST(MPS_STATUS_ENUM) };
#undef MPS_STATUS_ENUM

MPS_BEGIN_DECLS

/** Name of a status code, "MPS_E_ARG"; "MPS_E_UNKNOWN" for any other number. Static text. */
MPS_API const char *mps_status_name(mps_status status);

/** One-line meaning of a status code. Static text. */
MPS_API const char *mps_status_text(mps_status status);

MPS_END_DECLS

#endif
