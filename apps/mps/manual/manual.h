/* SPDX-License-Identifier: BSD-3-Clause */
/* Texts generated from the tables of verbs, options and keys during the build. */
#ifndef MPS_APPS_MANUAL_H
#define MPS_APPS_MANUAL_H

#include <stdio.h>

/* Manual pages mps(1) and mps-case(5), in the format of scdoc. */
void manual_write_program(FILE *out);
void manual_write_case(FILE *out);
/* Words of the bash completion: arrays that precede the functions of completion.bash. */
void manual_write_words(FILE *out);

#endif
