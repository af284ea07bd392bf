/* SPDX-License-Identifier: BSD-3-Clause */
/** @file export.h  Visibility and language linkage of the public functions. */
#ifndef MPS_EXPORT_H
#define MPS_EXPORT_H

#if defined(__GNUC__)
#define MPS_API __attribute__((visibility("default")))
#else
#define MPS_API
#endif

#ifdef __cplusplus
#define MPS_BEGIN_DECLS extern "C" {
#define MPS_END_DECLS   }
#else
#define MPS_BEGIN_DECLS
#define MPS_END_DECLS
#endif

#endif
