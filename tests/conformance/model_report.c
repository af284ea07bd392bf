/* SPDX-License-Identifier: BSD-3-Clause */
/* What the kit of models prints. */
#include "model_scenes.h"
#include <stdarg.h>
#include <stdio.h>

static const char *name_of(const mps_model_ops *ops)
{
    return ops->name ? ops->name : "(no name)";
}

int kit_print(const mps_model_ops *ops, int bit, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    fprintf(stderr, "model_kit: %s: ", name_of(ops));
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
    va_end(list);
    return bit;
}

const char *kit_hook(int32_t hook)
{
    static const char *const names[MPS_HOOK_COUNT] = {
        "MPS_POPULATE", "MPS_LIMIT", "MPS_MOTION",   "MPS_CLASSIFY", "MPS_PREPARE",  "MPS_FORCE",
        "MPS_SOURCE",   "MPS_LEVEL", "MPS_GRADIENT", "MPS_LOAD",     "MPS_VELOCITY", "MPS_SHIFT"};
    return hook >= 0 && hook < MPS_HOOK_COUNT ? names[hook] : "unknown hook";
}

/* Names of the checks by their bits. */
static const char *const checks[] = {
    "KIT_TABLE",   "KIT_RUN",        "KIT_SETTINGS", "KIT_THREADS", "KIT_ORDER",      "KIT_WRITES",
    "KIT_OWN_ROW", "KIT_WRITE_ONLY", "KIT_MEMORY",   "KIT_HANDLES", "KIT_CHECKPOINT", "KIT_MIDRUN",
    "KIT_BUDGET",  "KIT_ADDS",       "KIT_SOLIDS",   "KIT_REPEAT",  "KIT_ACTS",       "KIT_RANKS"};
enum { CHECKS = sizeof checks / sizeof checks[0] };

static void print_failed(const mps_model_ops *ops, int failed)
{
    fprintf(stderr, "model_kit: %s: failed:", name_of(ops));
    for (int k = 0; k < CHECKS; k++)
        if (failed & 1 << k) fprintf(stderr, " %s", checks[k]);
    fputc('\n', stderr);
}

void kit_summary(const mps_model_ops *ops, int failed, int count, const kit_case *scene,
                 const bool acted[])
{
    if (failed) {
        print_failed(ops, failed);
        return;
    }
    for (int32_t v = 0; v < ops->verb_count; v++)
        if (!acted[v])
            printf("model_kit: %s: note: verb %d, %s, changes nothing in the scenes: it was not "
                   "tested\n",
                   name_of(ops), (int)v, kit_hook(ops->verbs[v].hook));
    printf("model_kit: %s: passed; checks: %d, verbs: %d, settings: %d, scenes:", name_of(ops),
           CHECKS, (int)ops->verb_count, (int)ops->setting_count);
    for (int n = 0; n < count; n++)
        printf("%s %s %d-D", n > 0 ? "," : "", scene[n].preset, (int)scene[n].dim);
    putchar('\n');
    fflush(stdout);
}
