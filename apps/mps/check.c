/* SPDX-License-Identifier: BSD-3-Clause */
/* mps check. */
#include "cli.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int save(const choices *c, const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    bool good = file != NULL;
    if (file) { /* an error of a write stays until the end */
        fputs(text, file);
        good = !ferror(file);
        if (fclose(file) != 0) good = false;
    }
    if (good) return MPS_EXIT_OK;
    fprintf(stderr, "mps %s: %s: %s\n", c->verb, path, strerror(errno));
    return MPS_EXIT_FAILED;
}

int verb_check(const choices *c)
{
    char *text, *sketch, stem[900], path[1024];
    int code = MPS_EXIT_FAILED;
    mps_case *tank = cli_case(c, &code);
    if (!tank) return code;
    const int32_t before = mps_case_message_count(tank);
    const mps_status status = mps_case_check(tank, &text, &sketch);
    if (mps_case_message_count(tank) > before) cli_print_messages(c, tank);
    if (status != MPS_OK) {
        if (status != MPS_E_ARG) fprintf(stderr, "mps %s: %s\n", c->verb, mps_status_text(status));
        mps_case_destroy(tank);
        return status == MPS_E_ARG ? MPS_EXIT_USAGE : MPS_EXIT_FAILED;
    }
    cli_stem(c->file[0], stem, sizeof stem);
    snprintf(path, sizeof path, "%s.svg", stem);
    if (c->out) snprintf(path, sizeof path, "%s", c->out);
    if (!c->quiet) fputs(text, stdout);
    code = save(c, path, sketch);
    if (code == MPS_EXIT_OK && !c->quiet) printf("%-9s %s\n", "drawing", path);
    free(text);
    free(sketch);
    mps_case_destroy(tank);
    return code;
}
