/* SPDX-License-Identifier: BSD-3-Clause */
/* Manual pages in the language of scdoc(5): a tab indents the text that belongs to a bold line. */
#include "cli.h"
#include "manual.h"
#include <ctype.h>
#include <mps/mps.h>
#include <string.h>

/* Write a text with its markup characters escaped. */
static void put(FILE *out, const char *text)
{
    bool first = false;
    for (; *text; text++) {
        if (strchr("\\*_#|[]", *text) || (*text == '-' && first)) fputc('\\', out);
        first = *text == '\n'; /* a line that begins with - is an entry of a list */
        fputc(*text, out);
    }
}

static void put_bold(FILE *out, const char *text)
{
    fputc('*', out);
    put(out, text);
    fputc('*', out);
}

/* Write a text with an initial capital. */
static void put_sentence(FILE *out, const char *text)
{
    fputc(toupper((unsigned char)text[0]), out);
    put(out, text + 1);
    fputs(".\n", out);
}

static void put_head(FILE *out, const char *name, const char *section, const char *what)
{
    fprintf(out, "%s(%s) \"libmps %s\" \"%s\"\n\n", name, section, mps_version(NULL, NULL, NULL),
            what);
}

/* ---- mps(1) */

static void put_option(FILE *out, const option *o)
{
    char letter[4] = {'-', o->letter, 0};
    if (o->letter) {
        put_bold(out, letter);
        fputs(", ", out);
    }
    put_bold(out, o->name);
    if (o->argument) fprintf(out, " _%s_", o->argument);
    fputs("\n\t", out);
    put_sentence(out, o->help);
    fputc('\n', out);
}

static void put_verb(FILE *out, const verb *v)
{
    fprintf(out, "## %s\n\n*mps %s* ", v->name, v->name);
    put(out, v->arguments);
    fputs(v->options ? " [options]\n\n" : "\n\n", out);
    put(out, v->help);
    fputs(v->options ? "\n\nOptions:" : "\n", out);
    for (int32_t i = 0, n = 0; i < cli_option_count; i++) {
        if (!(v->options & cli_options[i].bit)) continue;
        fputs(n++ ? ", " : " ", out);
        put_bold(out, cli_options[i].name);
    }
    if (v->options) fputs(".\n", out);
    fputc('\n', out);
    if (!v->more) return;
    put(out, v->more);
    fputc('\n', out);
}

static const char PROGRAM_END[] =
    "# EXIT STATUS\n\n"
    "*0*\n\tDone.\n\n*1*\n\tFailed.\n\n*2*\n\tA wrong line, case or folder.\n\n"
    "*3*\n\tThe run diverged; its outputs stay readable.\n\n*130*\n\tInterrupted; a checkpoint was "
    "written.\n\n"
    "# FILES\n\n"
    "_DIR/probes.csv_\n\tA row a sample: time, pressures, heights, forces.\n\n"
    "_DIR/summary.json_\n\tFigures of the whole run, and all inputs.\n\n"
    "_DIR/case.yaml_\n\tThe case as it was run: 'mps run DIR/case.yaml' gives the same bytes.\n\n"
    "_DIR/report.html_\n\tThe page: film, curves, impacts, inputs; it needs no network.\n\n"
    "_DIR/frames.pvd_\n\tFrames for ParaView.\n\n"
    "_DIR/checkpoint.mps_\n\tWhere an interrupted run continues.\n\n"
    "# EXAMPLES\n\n"
    "A case to start from, what it means, and its run on two threads:\n\n"
    "```\nmps init tank\nmps check tank.yaml\nmps run tank.yaml -j 2\n```\n\n"
    "A finer spacing, without a change of the file:\n\n"
    "```\nmps run tank.yaml --set 'dp=5 mm' -o tank\\_5\n```\n\n"
    "# SEE ALSO\n\n*mps-case*(5)\n";

void manual_write_program(FILE *out)
{
    put_head(out, "mps", "1", "User Commands");
    fputs("# NAME\n\nmps - sloshing in tanks, from case files\n\n# SYNOPSIS\n\n", out);
    fputs("*mps* _VERB_ [arguments] [options]\n\n*mps* _VERB_ *--help*\n\n*mps* *--version*\n\n",
          out);
    fputs("# DESCRIPTION\n\n", out);
    fputs("A case file says what is in a tank, how it moves, and what is measured: see "
          "*mps-case*(5).\n"
          "*mps* checks a case, runs it by the moving particle semi-implicit method, and makes "
          "tables\n"
          "and a page of it. The same case gives the same bytes with any number of threads and "
          "ranks.\n\n",
          out);
    fputs("# VERBS\n\n", out);
    for (int32_t i = 0; i < cli_verb_count; i++) put_verb(out, &cli_verbs[i]);
    fputs("# OPTIONS\n\nEach verb names those that it has.\n\n", out);
    for (int32_t i = 0; i < cli_option_count; i++) put_option(out, &cli_options[i]);
    fputs("*-h*, *--help*\n\tPrint what a verb does and its options.\n\n", out);
    fputs(PROGRAM_END, out);
}

/* ---- mps-case(5) */

static const char CASE_BEGIN[] =
    "A case is a file in YAML: maps of keys, lists, texts. JSON is accepted too. A quantity is a\n"
    "number with its unit: *10 mm*, *4 deg*, *1 kPa*. The unit of several numbers stands once: "
    "*0.8\n"
    "0.5 m*. A number without a unit is an error, and so is a key that is not in the table below.\n"
    "All errors are shown at once, with line and column.\n\n"
    "*dp* is also a unit of length, the spacing of the particles; *T1* one of time, the first\n"
    "natural period of the liquid at rest; *%* a share.\n\n"
    "'mps run CASE --set PATH=VALUE' changes the value of a path: *--set fill.water.depth=40%*.\n"
    "Names of sensors, solids and liquids that are chosen in the file are part of a path.\n\n";

static const char CASE_EXAMPLE[] =
    "# EXAMPLE\n\n```\nmps: 1\ntitle: Tank in surge\ndp: 4 mm\ntank: {size: 0.8 0.5 m}\n"
    "fill: [{water: {depth: 0.25 m}}]\nmotion: {surge: {amplitude: 20 mm, omega: 6.469 rad/s}}\n"
    "sensors:\n  P1: {wall: 0 50 mm}\n  eta\\_left: {gauge: 1 dp}\nrun: {until: 5.4 s}\n```\n\n"
    "More of them: 'mps list cases', 'mps init NAME'.\n\n";

/* A kind of quantity that has units of its own: of "inertia, 1 to 6" and "damping or a share" the
 * first word.
 * @return false: none */
static bool find_kind(int32_t index, mps_case_key *k)
{
    static const char share[] = " or a share", percent[] = ", %";
    if (mps_case_key_get(index, k) != MPS_OK) return false;
    k->kind[strcspn(k->kind, ",")] = '\0';
    char *at = strstr(k->kind, share);
    const size_t length = strlen(k->units);
    if (at && length > strlen(percent)) {
        *at = '\0';
        k->units[length - strlen(percent)] = '\0';
    }
    if (!k->units[0] || strcmp(k->units, "any") == 0) return false;
    if (strcmp(k->kind, "unit") == 0 || strcmp(k->kind, "points") == 0) return false;
    return !strstr(k->kind, " or ") || strstr(k->kind, "viscosity");
}

/* Write each kind once. */
static void put_units(FILE *out)
{
    mps_case_key k = {.struct_size = sizeof k}, earlier = {.struct_size = sizeof earlier};
    for (int32_t i = 0; mps_case_key_get(i, &k) == MPS_OK; i++) {
        bool known = !find_kind(i, &k);
        for (int32_t j = 0; j < i && !known; j++)
            known = find_kind(j, &earlier) && strcmp(earlier.kind, k.kind) == 0;
        if (known) continue;
        put_bold(out, k.kind);
        fputs("\n\t", out);
        put(out, k.units);
        fputs("\n\n", out);
    }
}

static void put_key(FILE *out, const mps_case_key *k)
{
    put_bold(out, k->path);
    fputs("\n\t", out);
    put_sentence(out, k->help);
    if (k->kind[0] || k->range[0]) {
        fputs("\tHolds: ", out);
        put(out, k->kind);
        fputs(k->kind[0] && k->range[0] ? ", " : "", out);
        put(out, k->range);
        fputs(".\n", out);
    }
    if (k->required) fputs("\tRequired.\n", out);
    if (k->otherwise[0]) {
        fputs("\tDefault: ", out);
        put(out, k->otherwise);
        fputs(".\n", out);
    }
    if (k->example[0] && strcmp(k->example, k->otherwise) != 0) {
        fputs("\tExample: ", out);
        put(out, k->example);
        fputc('\n', out);
    }
    fputc('\n', out);
}

void manual_write_case(FILE *out)
{
    mps_case_key k = {.struct_size = sizeof k};
    put_head(out, "mps-case", "5", "File Formats");
    fputs("# NAME\n\nmps-case - case files of mps(1)\n\n# DESCRIPTION\n\n", out);
    fputs(CASE_BEGIN, out);
    fputs(CASE_EXAMPLE, out);
    fputs("# UNITS\n\n", out);
    put_units(out);
    fputs("# KEYS\n\nA path names a key and those above it. *\\** stands for a name that you "
          "choose, *a|b* for\none of two words. Ranges are in SI units.\n\n",
          out);
    for (int32_t i = 0; mps_case_key_get(i, &k) == MPS_OK; i++)
        if (k.path[0]) put_key(out, &k);
    fputs("# SEE ALSO\n\n*mps*(1)\n", out);
}
