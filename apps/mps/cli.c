/* SPDX-License-Identifier: BSD-3-Clause */
/* Parses the command line. */
#include "cli.h"
#include "escape.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT_MOST = 1024 };

const option cli_options[] = {
    {HAS_SET, "--set", 's', "PATH=VALUE", "change a value of the case; may be repeated", OPTION_SET,
     0},
    {HAS_MAP, "--map", 'm', "COLUMN=NAME",
     "a column of the run is that of this name in the other table; may be repeated", OPTION_SET, 0},
    {HAS_OUT, "--out", 'o', "PLACE", "folder or file of the outputs; default: the name of the case",
     OPTION_TEXT, offsetof(choices, out)},
    {HAS_PLUGIN, "--plugin", 0, "FILE",
     "load a plug-in, or this one instead of that of the case; may be repeated", OPTION_PLUGIN, 0},
    {HAS_TRUST, "--allow-plugins", 0, NULL, "load the plug-ins that a page names, too", OPTION_FLAG,
     offsetof(choices, allow_plugins)},
    {HAS_THREADS, "--threads", 'j', "N", "threads; results do not depend on them", OPTION_COUNT,
     offsetof(choices, threads)},
    {HAS_JOBS, "--jobs", 0, "N", "processes, each with a run at a time; default 1", OPTION_COUNT,
     offsetof(choices, jobs)},
    {HAS_PART, "--part", 0, "PART", "I/N: part I of N of the runs, e.g. of a task of a queue",
     OPTION_TEXT, offsetof(choices, part)},
    {HAS_COUNT, "--count", 'n', "N", "number of runs, 2 to 100; default 5", OPTION_COUNT,
     offsetof(choices, count)},
    {HAS_FMI, "--fmi", 0, "N", "version of FMI, 2 or 3; default 3", OPTION_COUNT,
     offsetof(choices, fmi)},
    {HAS_FREQUENCIES, "--degrees", 0, "NAMES",
     "degrees of freedom, 'surge roll'; default: those that the case moves", OPTION_TEXT,
     offsetof(choices, degrees)},
    {HAS_FREQUENCIES, "--period", 0, "LIST", "periods, '0.8 0.9 T1' or '0.7 to 2 step 0.1 T1'",
     OPTION_TEXT, offsetof(choices, period)},
    {HAS_FREQUENCIES, "--omega", 0, "LIST",
     "angular frequencies instead of periods, '4 to 8 step 0.5 rad/s'", OPTION_TEXT,
     offsetof(choices, omega)},
    {HAS_FREQUENCIES, "--amplitude", 0, "VALUE",
     "of the motion; for a shift, an angle s means s g/w^2; default 0.25 deg", OPTION_TEXT,
     offsetof(choices, amplitude)},
    {HAS_FREQUENCIES, "--periods", 0, "N",
     "periods that are measured; default 8 to 24, most near resonance", OPTION_COUNT,
     offsetof(choices, periods)},
    {HAS_OVERWRITE, "--overwrite", 0, NULL, "replace what is there", OPTION_FLAG,
     offsetof(choices, overwrite)},
    {HAS_RESUME, "--resume", 0, NULL, "continue from the checkpoint in the folder", OPTION_FLAG,
     offsetof(choices, resume)},
    {HAS_QUIET, "--quiet", 'q', NULL, "print failures only", OPTION_FLAG, offsetof(choices, quiet)},
    {HAS_PROFILE, "--profile", 0, NULL, "print the time that each part of a step takes",
     OPTION_FLAG, offsetof(choices, profile)},
    {HAS_DEVICE, "--device", 0, "NAME", "device of the time steps: cuda, cuda:1; default: the host",
     OPTION_TEXT, offsetof(choices, device)},
    {HAS_MPI, "--mpi", 0, NULL, "one run on all processes that mpirun starts", OPTION_FLAG,
     offsetof(choices, mpi)}};

const int32_t cli_option_count = sizeof cli_options / sizeof *cli_options;

void cli_print_help(const verb *v)
{
    printf("usage: mps %s %s%s\n\n%s\n", v->name, v->arguments, v->options ? " [options]" : "",
           v->help);
    if (v->options) printf("\n");
    for (int i = 0; i < cli_option_count; i++) {
        char left[48], letter[8] = "    ";
        if (!(v->options & cli_options[i].bit)) continue;
        if (cli_options[i].letter) snprintf(letter, sizeof letter, "-%c, ", cli_options[i].letter);
        snprintf(left, sizeof left, "%s%s %s", letter, cli_options[i].name,
                 cli_options[i].argument ? cli_options[i].argument : "");
        printf("  %-24s %s\n", left, cli_options[i].help);
    }
    if (v->more) printf("\n%s", v->more);
}

static int refuse(const choices *c, const char *what, const char *why)
{
    cli_print(c, "mps %s: %s: %s\n'mps %s --help' lists all options\n", c->verb, what, why,
              c->verb);
    return MPS_EXIT_USAGE;
}

/* Find the option of an argument, and its value: "--out x", "--out=x", "-o x", "-ox".
 * @return NULL: not found */
static const option *find(int32_t bits, const char *argument, const char **value)
{
    const char *equals = strchr(argument, '=');
    const size_t length = equals ? (size_t)(equals - argument) : strlen(argument);
    *value = NULL;
    for (int i = 0; i < cli_option_count; i++) {
        const option *o = &cli_options[i];
        if (!(bits & o->bit)) continue;
        if (strlen(o->name) == length && strncmp(o->name, argument, length) == 0) {
            *value = equals ? equals + 1 : NULL;
            return o;
        }
        if (o->letter && argument[0] == '-' && argument[1] == o->letter) {
            *value = argument[2] ? argument + 2 : NULL;
            return o;
        }
    }
    return NULL;
}

static int take(choices *c, const option *o, const char *value)
{
    char *end;
    void *place = (char *)c + o->place;
    if (o->kind == OPTION_TEXT) *(const char **)place = value;
    if (o->kind == OPTION_SET) {
        char why[48];
        snprintf(why, sizeof why, "is one %s too many", o->name); /* --set or --map */
        if (c->sets == CLI_SETS) return refuse(c, value, why);
        c->set[c->sets++] = value;
    }
    if (o->kind == OPTION_PLUGIN) {
        if (c->plugins == CLI_PLUGINS) return refuse(c, value, "is one --plugin too many");
        c->plugin[c->plugins++] = value;
    }
    if (o->kind == OPTION_COUNT) {
        const long count = strtol(value, &end, 10);
        if (end == value || *end || count < 1 || count > COUNT_MOST) {
            char what[48];
            snprintf(what, sizeof what, "%s %.16s", o->name, value);
            return refuse(c, what, "must be a whole number, 1 to 1024");
        }
        *(int32_t *)place = (int32_t)count;
    }
    return -1;
}

static void keep_command(choices *c, int argc, char **argv)
{
    size_t used = 0;
    for (int i = 0; i < argc && used + 1 < sizeof c->command; i++) {
        if (i > 0) c->command[used++] = ' ';
        used += mps__shell_word(argv[i], c->command + used, sizeof c->command - used);
    }
}

int cli_read(choices *c, const verb *v, int argc, char **argv)
{
    keep_command(c, argc, argv);
    for (int i = 2; i < argc; i++) {
        const char *value, *argument = argv[i];
        if (strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0) {
            if (!c->kept || c->kept->ranks.rank == 0) cli_print_help(v);
            return MPS_EXIT_OK;
        }
        if (argument[0] != '-' || !argument[1]) {
            if (c->files == CLI_FILES || c->files == v->many)
                return refuse(c, argument, "is one argument too many");
            c->file[c->files++] = argument;
            continue;
        }
        const option *o = find(v->options, argument, &value);
        if (!o) return refuse(c, argument, "unknown option");
        if (o->kind == OPTION_FLAG) {
            if (value) return refuse(c, argument, "takes no value");
            *(bool *)((char *)c + o->place) = true;
            continue;
        }
        if (!value) value = i + 1 < argc ? argv[++i] : NULL;
        if (!value || !value[0]) return refuse(c, argument, "needs a value");
        const int code = take(c, o, value);
        if (code >= 0) return code;
    }
    if (c->files < v->few) return refuse(c, v->arguments, "is missing");
    return -1;
}

int cli_flush(const choices *c, int code)
{
    const int before = errno; /* of an earlier write */
    errno = 0;
    const bool good = fflush(stdout) == 0 && !ferror(stdout);
    if (good || code != MPS_EXIT_OK) return code;
    const int reason = errno ? errno : before ? before : EIO;
    if (reason != EPIPE) /* a reader such as head has what it wants */
        cli_print(c, "mps %s: cannot write to stdout: %s\n", c->verb, strerror(reason));
    return reason == EPIPE ? MPS_EXIT_OK : MPS_EXIT_FAILED;
}

void cli_stem(const char *path, char *out, size_t size)
{
    const char *slash = strrchr(path, '/'), *begin = slash ? slash + 1 : path,
               *dot = strrchr(begin, '.');
    snprintf(out, size, "%.*s", (int)(dot && dot > begin ? dot - begin : (int)strlen(begin)),
             begin);
}

size_t cli_messages(const mps_case *tank)
{
    return mps_case_messages_write(tank, NULL, 0);
}

void cli_print_messages(const choices *c, const mps_case *tank, size_t before)
{
    const size_t size = cli_messages(tank) + 1;
    if (size <= before + 1) return;
    char *text = malloc(size);
    if (!text) return;
    mps_case_messages_write(tank, text, size);
    cli_print(c, "%s", text + before);
    free(text);
}

mps_status cli_open(const choices *c, mps_case **out)
{
    mps_case_options o;
    mps_case_options_init(&o, sizeof o);
    o.load = c->allow_plugins ? MPS_CASE_PLUGINS_ALL : MPS_CASE_PLUGINS_FILES;
    o.set_count = c->sets;
    o.set = c->set;
    o.plugin_count = c->plugins;
    o.plugin = c->plugin;
    return mps_case_open(c->file[0], &o, out);
}

mps_case *cli_case(const choices *c, int *code)
{
    mps_case *out = NULL;
    const mps_status status = cli_open(c, &out);
    if (out) cli_print_messages(c, out, 0);
    if (status == MPS_OK) return out;
    if (!out) cli_print(c, "mps %s: %s: %s\n", c->verb, c->file[0], mps_status_text(status));
    *code = status == MPS_E_ARG || status == MPS_E_IO ? MPS_EXIT_USAGE : MPS_EXIT_FAILED;
    mps_case_destroy(out);
    return NULL;
}
