/* SPDX-License-Identifier: BSD-3-Clause */
/* Words of the completion: arrays of bash. No word contains a quote or a blank. */
#include "cli.h"
#include "manual.h"
#include "starts.h"
#include <string.h>

static void put_options(FILE *out)
{
    fprintf(out, "declare -gA _mps_options=(\n");
    for (int32_t v = 0; v < cli_verb_count; v++) {
        fprintf(out, "    [%s]='", cli_verbs[v].name);
        for (int32_t i = 0; i < cli_option_count; i++) {
            const option *o = &cli_options[i];
            if (!(cli_verbs[v].options & o->bit)) continue;
            fprintf(out, "%s ", o->name);
            if (o->letter) fprintf(out, "-%c ", o->letter);
        }
        fprintf(out, "--help'\n");
    }
    fprintf(out, ")\n");
}

/* Write the arguments of options: PATH=VALUE, PLACE, N. */
static void put_values(FILE *out)
{
    fprintf(out, "declare -gA _mps_values=(\n");
    for (int32_t i = 0; i < cli_option_count; i++) {
        const option *o = &cli_options[i];
        if (!o->argument) continue;
        fprintf(out, "    [%s]='%s'\n", o->name, o->argument);
        if (o->letter) fprintf(out, "    [-%c]='%s'\n", o->letter, o->argument);
    }
    fprintf(out, ")\n");
}

/* Write a path with each of its alternatives: "solids.*.plate|box" as two. */
static void put_paths(FILE *out, const char *done, const char *rest)
{
    char text[256];
    const size_t length = strcspn(rest, ".");
    const char *word = rest, *end = rest + length;
    while (word <= end && *rest) {
        const size_t size = strcspn(word, "|.");
        snprintf(text, sizeof text, "%s%s%.*s", done, done[0] ? "." : "", (int)size, word);
        if (*end)
            put_paths(out, text, end + 1);
        else
            fprintf(out, "    '%s'\n", text);
        word += size + 1;
    }
}

void manual_write_words(FILE *out)
{
    mps_case_key k = {.struct_size = sizeof k};
    fprintf(out, "# Made from the tables of mps: verbs, options, keys.\n_mps_verbs='");
    for (int32_t v = 0; v < cli_verb_count; v++) fprintf(out, "%s ", cli_verbs[v].name);
    fprintf(out, "--help --version'\n");
    put_options(out);
    put_values(out);
    fprintf(out, "declare -gA _mps_arguments=(\n");
    for (int32_t v = 0; v < cli_verb_count; v++)
        fprintf(out, "    [%s]='%s'\n", cli_verbs[v].name, cli_verbs[v].arguments);
    fprintf(out, ")\n_mps_cases='");
    for (const start *s = starts; s->name; s++)
        if (!strchr(s->name, '.')) fprintf(out, "%s ", s->name);
    fprintf(out, "'\n_mps_keys=(\n");
    for (int32_t i = 0; mps_case_key_get(i, &k) == MPS_OK; i++)
        if (k.path[0]) put_paths(out, "", k.path);
    fprintf(out, ")\n");
}
