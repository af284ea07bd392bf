/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks that a run continues with the case it began with: a record of two tanks or two motions is
 * useless. */
#include "build.h"
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { VALUE_SHOWN = 60 };

/* Keys that may differ: they change no value in the files of rows. */
static bool is_free(const char *path)
{
    static const char *const all[] = {"title",          "impacts",
                                      "collect",        "reference",
                                      "run.until",      "run.threads",
                                      "run.checkpoint", "run.checkpoint_clock",
                                      "output"},
                             *const not [] = {"output.rate", "output.frame", "output.trace",
                                              "output.pieces"};
    for (size_t k = 0; k < sizeof not / sizeof *not ; k++)
        if (strcmp(path, not [k]) == 0) return false;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        const size_t length = strlen(all[k]);
        if (strncmp(path, all[k], length) == 0 && (!path[length] || path[length] == '.'))
            return true;
    }
    return false;
}

static bool may_hold_free(const tree_node *n)
{
    return n && n->kind == TREE_MAP && n->key &&
           (strcmp(n->key, "run") == 0 || strcmp(n->key, "output") == 0);
}

/* A difference: the value that differs; NULL on the side that has none. */
typedef struct difference {
    const tree_node *before, *now;
} difference;

static bool differ(const tree_node *before, const tree_node *now, difference *d);

/* Compare children of two maps, which may be given on one side only. */
static bool maps_differ(const tree_node *before, const tree_node *now, difference *d)
{
    for (const tree_node *a = before ? before->first : NULL; a; a = a->next)
        if (differ(a, now ? mps__tree_find(now, a->key) : NULL, d)) return true;
    for (const tree_node *b = now ? now->first : NULL; b; b = b->next)
        if (!(before && mps__tree_find(before, b->key)) && differ(NULL, b, d)) return true;
    return false;
}

static bool differ(const tree_node *before, const tree_node *now, difference *d)
{
    char path[PATH_CAPACITY];
    *d = (difference){before, now};
    if (may_hold_free(before ? before : now) && (!before || !now || before->kind == now->kind))
        return maps_differ(before, now, d);
    if (is_free(mps__tree_path(before ? before : now, path, sizeof path))) return false;
    if (!before || !now || before->kind != now->kind) return true;
    if (before->kind == TREE_TEXT) return strcmp(before->text, now->text) != 0;
    if (before->kind == TREE_MAP) return maps_differ(before, now, d);
    if (before->count != now->count) return true;
    const tree_node *b = now->first;
    for (const tree_node *a = before->first; a; a = a->next, b = b->next)
        if (differ(a, b, d)) return true;
    return false;
}

/* A value for a message. */
static const char *shown(const tree_node *n, char out[VALUE_SHOWN + 8])
{
    if (!n) return "not given";
    if (n->kind != TREE_TEXT) return n->kind == TREE_LIST ? "a list" : "given";
    snprintf(out, VALUE_SHOWN + 8, "'%.*s'", VALUE_SHOWN, n->text);
    return out;
}

static mps_status refuse(const mps_job_config *o, const difference *d)
{
    char path[PATH_CAPACITY], before[VALUE_SHOWN + 8], now[VALUE_SHOWN + 8];
    mps__tree_path(d->before ? d->before : d->now, path, sizeof path);
    if (o->error && o->error_size > 0)
        snprintf(o->error, o->error_size,
                 "%s is %s, in the run of '%.200s' it is %s; only run.until, run.threads, "
                 "run.checkpoint, run.checkpoint_clock, title, impacts, collect, reference and "
                 "output (not its rate, frame, trace and pieces) may change; run another case in "
                 "another folder with --out",
                 path, shown(d->now, now), o->folder, shown(d->before, before));
    return MPS_E_STATE;
}

mps_status mps__build_resumed(const mps_case *c, const mps_job_config *options)
{
    char path[BUILD_TEXT + 1024];
    struct stat there;
    mps_case *before = NULL, *now = NULL;
    difference d;
    snprintf(path, sizeof path, "%s/case.yaml", options->folder ? options->folder : "");
    if (!options->resume || stat(path, &there) != 0) return MPS_OK;
    /* both as run, with file names relative to the same folder */
    const char *text = mps_case_text(c);
    mps_status status = mps_case_read(path, 0, NULL, &before);
    if (status == MPS_OK) status = mps_case_read_text(text, strlen(text), path, 0, NULL, &now);
    if (status != MPS_OK && status != MPS_E_NOMEM && options->error && options->error_size > 0) {
        char why[600] = "";
        mps_case_messages_write(now ? now : before, why, sizeof why);
        snprintf(options->error, options->error_size,
                 "%.300s is not the case of a run; mend it, or start anew with --overwrite, "
                 "which deletes the run\n%s",
                 path, why);
    }
    if (status == MPS_OK && maps_differ(before->root, now->root, &d)) status = refuse(options, &d);
    mps_case_destroy(before);
    mps_case_destroy(now);
    return status;
}
