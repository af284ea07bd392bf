/* SPDX-License-Identifier: BSD-3-Clause */
/* The text of --list-models, which is also docs/reference/models.md. */
#ifndef MPS_EXAMPLES_LISTING_H
#define MPS_EXAMPLES_LISTING_H

/* Print presets, models with settings, channels, orders of verbs, solvers and kernels as Markdown. Returns an exit code. */
int listing_print(void);

#endif
