/* SPDX-License-Identifier: BSD-3-Clause */
/* Texts of an FMU. */
#ifndef MPS_APPS_FMU_H
#define MPS_APPS_FMU_H

#include "variables.h"
#include <stdio.h>

typedef struct fmu_about {
    int32_t version; /* 2 or 3, of FMI */
    fmu_model model;
    char name[256];       /* of the case */
    char identifier[256]; /* the name as an identifier of C */
    char token[FMU_TOKEN];
} fmu_about;

/* modelDescription.xml */
void fmu_write_description(FILE *out, const fmu_about *a);
/* documentation/index.html */
void fmu_write_page(FILE *out, const fmu_about *a);
/* The licence of the library, generated from LICENSE. */
extern const char fmu_licence[];

#endif
