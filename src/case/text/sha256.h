/* SPDX-License-Identifier: BSD-3-Clause */
/* SHA-256 of a file, FIPS 180-4, so that users can compare it with the output of sha256sum. */
#ifndef MPS_CASE_SHA256_H
#define MPS_CASE_SHA256_H

#include <stdbool.h>
#include <stdio.h>

enum { SHA256_TEXT = 65 };

/* Hash the rest of a file into 64 hexadecimal digits. @return false: a read error, errno */
bool mps__sha256(FILE *file, char out[SHA256_TEXT]);

#endif
