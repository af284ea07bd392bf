/* SPDX-License-Identifier: BSD-3-Clause */
/* SHA-256 of a file, FIPS 180-4, so that users can compare it with what sha256sum prints. */
#ifndef MPS_CASE_SHA256_H
#define MPS_CASE_SHA256_H

#include <stdbool.h>
#include <stdio.h>

enum { SHA256_TEXT = 65 };

/* Of all that can be read from a file, as 64 hexadecimal digits. @return false: an error of reading, errno */
bool mps__sha256(FILE *file, char out[SHA256_TEXT]);

#endif
