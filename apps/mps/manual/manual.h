/* SPDX-License-Identifier: BSD-3-Clause */
/* Texts that are made from the tables of verbs, options and keys while the program is built. */
#ifndef MPS_APPS_MANUAL_H
#define MPS_APPS_MANUAL_H

#include <stdio.h>

/* Manual pages mps(1) and mps-case(5), as scdoc reads them. */
void manual_write_program(FILE *out);
void manual_write_case(FILE *out);
/* What the completion of bash knows: arrays ahead of the functions of completion.bash. */
void manual_write_words(FILE *out);

#endif
