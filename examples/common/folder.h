/* SPDX-License-Identifier: BSD-3-Clause */
/* The folder of a run's outputs: one run at a time, and no run over another one without being asked to. */
#ifndef MPS_EXAMPLES_FOLDER_H
#define MPS_EXAMPLES_FOLDER_H

#include "run.h"

/* Make the folder of --out and lock it against other programs until this one ends. Exits with CLI_USAGE and a message if files cannot be made
 * there, another run is in progress, or there are outputs of an earlier run and neither --resume nor --overwrite is given. */
void folder_open(const cli_options *o);
/* Remove what drivers write, and nothing else. Exits with CLI_USAGE and a message if that fails. */
void folder_clear(run *r);
/* What to do about this reason that a file cannot be written. */
const char *folder_advice(int error);

#endif
