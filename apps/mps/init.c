/* SPDX-License-Identifier: BSD-3-Clause */
/* mps init, mps schema. */
#include "cli.h"
#include "starts.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Refuse to overwrite a file, unless that is requested. */
static bool may_write(const choices *c, const char *path)
{
    if (c->overwrite || access(path, F_OK) != 0) return true;
    fprintf(stderr, "mps init: %s is there already; --overwrite replaces it\n", path);
    return false;
}

static int write_new(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    bool good = file != NULL;
    if (file) { /* a write error is kept until the end */
        fputs(text, file);
        good = !ferror(file);
        if (fclose(file) != 0) good = false;
    }
    if (!good) {
        fprintf(stderr, "mps init: %s: %s\n", path, strerror(errno));
        return MPS_EXIT_FAILED;
    }
    printf("%s\n", path);
    return MPS_EXIT_OK;
}

/* Whether it is a table that a case names. */
static bool is_table_of(const start *table, const start *owner)
{
    return table != owner && strchr(table->name, '.') && strstr(owner->text, table->name);
}

int verb_init(const choices *c)
{
    char path[1024];
    if (c->files == 0) {
        fprintf(stderr, "mps init: NAME is missing; cases to start from:\n");
        cli_list_cases(stderr);
        return MPS_EXIT_USAGE;
    }
    for (const start *s = starts; s->name; s++) {
        if (strcmp(s->name, c->file[0]) != 0) continue;
        snprintf(path, sizeof path, "%s%s", s->name, strchr(s->name, '.') ? "" : ".yaml");
        bool free_places = may_write(c, c->out ? c->out : path);
        for (const start *t = starts; t->name && free_places; t++)
            if (is_table_of(t, s)) free_places = may_write(c, t->name);
        if (!free_places) return MPS_EXIT_USAGE;
        int code = write_new(c->out ? c->out : path, s->text);
        for (const start *t = starts; t->name && code == MPS_EXIT_OK; t++)
            if (is_table_of(t, s)) code = write_new(t->name, t->text);
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
    if (!text) {
        fprintf(stderr, "mps schema: no memory\n");
        return MPS_EXIT_FAILED;
    }
    mps_case_schema_write(text, size);
    fputs(text, stdout);
    free(text);
    return cli_flush(c, MPS_EXIT_OK);
}
