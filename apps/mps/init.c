/* SPDX-License-Identifier: BSD-3-Clause */
/* mps init, mps schema. */
#include "cli.h"
#include "starts.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A file that is there stays, unless it may be replaced. */
static int write_new(const choices *c, const char *path, const char *text)
{
    if (!c->overwrite && access(path, F_OK) == 0) {
        fprintf(stderr, "mps init: %s is there already; --overwrite replaces it\n", path);
        return MPS_EXIT_USAGE;
    }
    FILE *file = fopen(path, "w");
    bool good = file && fputs(text, file) >= 0;
    if (file) good = fclose(file) == 0 && good;
    if (!good) {
        fprintf(stderr, "mps init: %s: %s\n", path, strerror(errno));
        return MPS_EXIT_FAILED;
    }
    printf("%s\n", path);
    return MPS_EXIT_OK;
}

int verb_init(const choices *c)
{
    char path[1024];
    for (const start *s = starts; s->name; s++) {
        if (strcmp(s->name, c->file[0]) != 0) continue;
        snprintf(path, sizeof path, "%s%s", s->name, strchr(s->name, '.') ? "" : ".yaml");
        int code = write_new(c, c->out ? c->out : path, s->text);
        for (const start *t = starts; t->name && code == MPS_EXIT_OK;
             t++) /* tables that it names */
            if (t != s && strchr(t->name, '.') && strstr(s->text, t->name))
                code = write_new(c, t->name, t->text);
        return code;
    }
    fprintf(stderr, "mps init: there is no case with the name '%s'; 'mps list cases' shows all\n",
            c->file[0]);
    return MPS_EXIT_USAGE;
}

int verb_schema(const choices *c)
{
    const size_t size = mps_case_schema_write(NULL, 0) + 1;
    char *text = malloc(size);
    (void)c;
    if (!text) return MPS_EXIT_FAILED;
    mps_case_schema_write(text, size);
    const bool good = fputs(text, stdout) >= 0 && fflush(stdout) == 0;
    free(text);
    return good ? MPS_EXIT_OK : MPS_EXIT_FAILED;
}
