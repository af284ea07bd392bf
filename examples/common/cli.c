/* SPDX-License-Identifier: BSD-3-Clause */
/* Command line of the drivers: one table, every value checked by name and range. */
#include "cli.h"
#include "listing.h"
#include "ranks.h"
#include <fcntl.h>
#include <math.h>
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CLI_THREADS_MAX = 1024, CLI_FRAMES_MAX = 100000 };

enum { CLI_OPTIONS = 48 };

/* A line for each option. */
/* clang-format off */
static int cli_table(cli_options *o, cli_option *table)
{
    const char *models = o->two_phases ? "imps, mmps (several phases), imps.paper or mmps.paper" : "imps or imps.paper";
    int n = 0;
    table[n++] = (cli_option){"--model", "NAME", models, TYPE_TEXT, &o->model, 0, 0, false};
    table[n++] = (cli_option){"--use", "SLOT.VARIANT", "replace the model of a slot; may be repeated", TYPE_LIST, &o->use, 0, 0, false};
    table[n++] = (cli_option){"--remove", "SLOT", "switch off the model of a slot; may be repeated", TYPE_LIST, &o->remove, 0, 0, false};
    table[n++] = (cli_option){"--set", "SLOT.KEY=X", "change a setting of a model; may be repeated", TYPE_LIST, &o->set, 0, 0, false};
    table[n++] = (cli_option){"--re-far", "X", "far radius [dp]; default: that of the preset", TYPE_REAL, &o->re_far, 2.1, 10, false};
    table[n++] = (cli_option){"--dp", "M", "particle spacing [m]", TYPE_REAL, &o->dp, o->dp_min, o->dp_max, false};
    table[n++] = (cli_option){"--dt", "S", "fixed time step [s]; default: adaptive", TYPE_REAL, &o->dt, 0, 0.1, false};
    table[n++] = (cli_option){"--cfl", "C", "adaptive step: largest dt u / dp", TYPE_REAL, &o->cfl, 0, 1, false};
    table[n++] = (cli_option){"--calm", "C", "adaptive step: largest dt sqrt(g / dp); default: that of the preset",
                              TYPE_REAL, &o->calm, 0, 1, false};
    table[n++] = (cli_option){"--t-end", "S", "time simulated [s]", TYPE_REAL, &o->t_end, 0, o->t_max, false};
    table[n++] = (cli_option){"--threads", "N", "threads of the simulation", TYPE_INT, &o->threads, 1, CLI_THREADS_MAX, false};
    table[n++] = (cli_option){"--mpi", NULL, "one run on the ranks that mpirun starts, one thread each unless --threads says more",
                              TYPE_FLAG, &o->mpi, 0, 0, true};
    table[n++] = (cli_option){"--solver", "NAME", "pressure solver, or solver/preconditioner", TYPE_TEXT, &o->solver, 0, 0, false};
    table[n++] = (cli_option){"--out", "DIR", "folder for all outputs", TYPE_TEXT, &o->out, 0, 0, false};
    table[n++] = (cli_option){"--frames", "N", "frames for ParaView besides the first; 0: none",
                              TYPE_INT, &o->frames, 0, CLI_FRAMES_MAX, false};
    table[n++] = (cli_option){"--tank-frame", NULL, "frames in the frame of the tank: its walls stand still", TYPE_FLAG, &o->tank_frame, 0, 0, true};
    table[n++] = (cli_option){"--pieces", NULL, "with --mpi: each rank writes its own .vtp of a frame, and a .pvtp names them", TYPE_FLAG, &o->pieces, 0, 0, true};
    table[n++] = (cli_option){"--checkpoint", "S", "a checkpoint every S simulated seconds and at the end; default: only at Ctrl-C",
                              TYPE_REAL, &o->checkpoint, 1e-6, o->t_max, false};
    table[n++] = (cli_option){"--resume", NULL, "go on from the checkpoint in the folder of --out", TYPE_FLAG, &o->resume, 0, 0, true};
    table[n++] = (cli_option){"--overwrite", NULL, "remove an earlier run from the folder of --out", TYPE_FLAG, &o->overwrite, 0, 0, true};
    table[n++] = (cli_option){"--probe-dt", "S", "interval of rows in probes.csv [s]", TYPE_REAL, &o->probe_dt, 0, 10, false};
    table[n++] = (cli_option){"--sensor-average", "S",
                              "wall pressures and forces: mean of the last S seconds; 0: no mean; default: dp/u",
                              TYPE_REAL, &o->sensor_average, -1, 10, false};
    table[n++] = (cli_option){"--pictures", "T,T,..", "times of the pictures [s]; default: quarters of the run",
                              TYPE_TIMES, o, 0, 0, false};
    if (o->has_dim) table[n++] = (cli_option){"--dim", "D", "2 or 3 dimensions", TYPE_INT, &o->dim, 2, 3, false};
    if (o->amplitude > 0)
        table[n++] = (cli_option){"--amplitude", "M", "amplitude of the motion [m]", TYPE_REAL, &o->amplitude, 0, 10, false};
    if (o->has_ramp)
        table[n++] = (cli_option){"--ramp", "N", "periods in which the motion grows to its amplitude; 0: it starts at once",
                                  TYPE_REAL, &o->ramp, -1, 100, false};
    if (o->has_layers)
        table[n++] = (cli_option){"--layers", "N", "columns of particles of the baffle; 0: by its thickness",
                              TYPE_INT, &o->layers, 0, 100, false};
    if (o->has_stl)
        table[n++] = (cli_option){"--stl", "FILE", "STL file of a closed tank, in place of the cylinder", TYPE_TEXT, &o->stl, 0, 0, false};
    if (o->has_stl)
        table[n++] = (cli_option){"--stl-scale", "M", "length of a unit of the STL file [m]", TYPE_REAL, &o->stl_scale, 0, 1e6, false};
    if (o->has_sigma)
        table[n++] = (cli_option){"--sigma", "N/M", "surface tension [N/m], for models that have it", TYPE_REAL, &o->sigma, -1, 100, false};
    for (int i = 0; i < o->owns; i++) table[n++] = o->own[i];
    table[n++] = (cli_option){"--no-report", NULL, "no report.html", TYPE_FLAG, &o->report, 0, 0, false};
    table[n++] = (cli_option){"--profile", NULL, "print a table of all passes of the steps: calls, seconds, bytes", TYPE_FLAG, &o->profile, 0, 0, true};
    table[n++] = (cli_option){"--quiet", NULL, "no progress", TYPE_FLAG, &o->quiet, 0, 0, true};
    table[n++] = (cli_option){"--list-models", NULL, "all models with settings, channels and solvers", TYPE_LISTING, NULL, 0, 0, false};
    table[n++] = (cli_option){"--version", NULL, "version of the library", TYPE_VERSION, NULL, 0, 0, false};
    table[n++] = (cli_option){"--help", NULL, "this text", TYPE_HELP, NULL, 0, 0, false};
    return n;
}
/* clang-format on */

/* Word `index` of "one|two"; its length, or 0 behind the last. */
static int cli_word(const char *words, int32_t index, const char **word)
{
    if (!words) words = ""; /* an option without an argument */
    for (; index > 0 && *words; index--) {
        words += strcspn(words, "|");
        words += *words == '|';
    }
    *word = words;
    return (int)strcspn(words, "|");
}

/* The default of an option as it is shown in --help. */
static void cli_default_text(const cli_option *e, char *text, size_t size)
{
    text[0] = '\0';
    if (e->type == TYPE_TEXT && *(const char **)e->value)
        snprintf(text, size, " (%s)", *(const char **)e->value);
    if (e->type == TYPE_INT) snprintf(text, size, " (%d)", *(int32_t *)e->value);
    if (e->type == TYPE_REAL &&
        (*(double *)e->value > 0 || (e->min < 0 && *(double *)e->value == 0)))
        snprintf(text, size, " (%g)", *(double *)e->value);
    if (e->type == TYPE_CHOICE) {
        const char *word;
        int length = cli_word(e->argument, *(int32_t *)e->value, &word);
        snprintf(text, size, " (%.*s)", length, word);
    }
}

static void cli_help(const cli_options *o, const cli_option *table, int n)
{
    if (!ranks_first()) ranks_exit(CLI_OK);
    printf("%s - %s\n\nusage: %s [options]\n\n", o->program, o->about, o->program);
    for (int i = 0; i < n; i++) {
        char left[64], initial[128];
        snprintf(left, sizeof left, "%s %s", table[i].name,
                 table[i].argument ? table[i].argument : "");
        cli_default_text(&table[i], initial, sizeof initial);
        printf("  %-18s %s%s\n", left, table[i].help, initial);
    }
    printf("\nWrites probes.csv, summary.json, frames.pvd with frames/, plots, pictures and "
           "report.html into the folder of --out.\n"
           "report.html and summary.json say what each column of probes.csv is, and where.\n"
           "A folder with an earlier run is refused unless --resume or --overwrite is given, and "
           "so is one that another run is writing to.\n"
           "Ctrl-C (or SIGTERM, SIGHUP) ends the run after its step with checkpoint.mps there as "
           "well; --resume and the same options go on "
           "from\n"
           "it, also to a later --t-end. What the files hold beyond the checkpoint is computed "
           "again.\n"
           "Progress is shown on stderr: a line that is kept up to date on a terminal, else every "
           "10 s a line\n"
           "  t=0.1234 step=567 dt=1.2e-04 wall=10.0 eta=34.5\n"
           "with time [s], number and length [s] of the step, seconds by the clock since the start "
           "and expected until the end.\n"
           "Exit: 0 done, 1 failed, 2 wrong value or folder, 3 diverged or beyond a model (outputs "
           "stay readable), 130 interrupted by "
           "Ctrl-C.\n");
    ranks_exit(CLI_OK);
}

void cli_refuse(const cli_options *o, const char *format, const char *a, const char *b)
{
    fprintf(ranks_messages(), "%s: ", o->program);
    fprintf(ranks_messages(), format, a, b);
    fprintf(ranks_messages(), "\n%s --help lists all options\n", o->program);
    ranks_exit(CLI_USAGE);
}

static void cli_refuse_value(const cli_options *o, const cli_option *e, const char *text)
{
    char allowed[128];
    if (e->type == TYPE_INT)
        snprintf(allowed, sizeof allowed, "a whole number, %g to %g", e->min, e->max);
    else if (e->min > 0)
        snprintf(allowed, sizeof allowed, "a number, %g to %g", e->min, e->max);
    else
        snprintf(allowed, sizeof allowed, "a number %s 0, at most %g",
                 e->min < 0 ? "not less than" : "greater than", e->max);
    fprintf(ranks_messages(), "%s: %s %s: must be %s\n", o->program, e->name, text, allowed);
    ranks_exit(CLI_USAGE);
}

static void cli_set_number(cli_options *o, const cli_option *e, const char *text)
{
    char *end;
    double value = strtod(text, &end);
    bool lower = e->type == TYPE_INT || e->min > 0 ? value >= e->min
                 : e->min < 0                      ? value >= 0
                                                   : value > 0;
    bool whole = e->type != TYPE_INT || value == floor(value);
    if (end == text || *end != '\0' || !isfinite(value) || !lower || value > e->max || !whole)
        cli_refuse_value(o, e, text);
    if (e->type == TYPE_INT)
        *(int32_t *)e->value = (int32_t)value;
    else
        *(double *)e->value = value;
    o->average_given = o->average_given || e->value == &o->sensor_average;
    o->sigma_given = o->sigma_given || e->value == &o->sigma;
}

static void cli_set_choice(const cli_options *o, const cli_option *e, const char *text)
{
    const char *word;
    int32_t index = 0;
    for (int length; (length = cli_word(e->argument, index, &word)) > 0; index++) {
        if ((int)strlen(text) != length || strncmp(text, word, (size_t)length) != 0) continue;
        *(int32_t *)e->value = index;
        return;
    }
    fprintf(ranks_messages(), "%s: %s %s: must be one of %s\n", o->program, e->name, text,
            e->argument);
    ranks_exit(CLI_USAGE);
}

/* Increasing times, e.g. "2.2,2.3". */
static void cli_set_times(cli_options *o, const cli_option *e, const char *text)
{
    const char *at = text;
    o->pictures = 0;
    for (bool more = true; more; at++) {
        char *end;
        double t = strtod(at, &end), before = o->pictures > 0 ? o->picture_t[o->pictures - 1] : 0;
        more = *end == ',';
        if (end == at || (*end && !more) || !isfinite(t) || t <= before || o->pictures == CLI_TIMES)
            cli_refuse(o, "%s %s: must be increasing times greater than 0, at most 24 of them",
                       e->name, text);
        o->picture_t[o->pictures++] = t;
        at = end;
    }
}

static void cli_add_text(const cli_options *o, const cli_option *e, const char *text)
{
    cli_list *list = e->value;
    if (list->count == CLI_LIST) cli_refuse(o, "%s %s: is one too many", e->name, text);
    list->text[list->count++] = text;
}

static cli_option *cli_find(cli_option *table, int n, const char *name, size_t length)
{
    for (int i = 0; i < n; i++)
        if (strlen(table[i].name) == length && strncmp(table[i].name, name, length) == 0)
            return &table[i];
    return NULL;
}

static void cli_set(cli_options *o, const cli_option *e, const char *text)
{
    if (e->type == TYPE_TEXT)
        *(const char **)e->value = text;
    else if (e->type == TYPE_LIST)
        cli_add_text(o, e, text);
    else if (e->type == TYPE_TIMES)
        cli_set_times(o, e, text);
    else if (e->type == TYPE_CHOICE)
        cli_set_choice(o, e, text);
    else
        cli_set_number(o, e, text);
}

/* Handle argv[*i]; both "--dp 0.01" and "--dp=0.01" are understood. */
static void cli_take(cli_options *o, cli_option *table, int n, int argc, char **argv, int *i)
{
    const char *name = argv[*i], *equals = strchr(name, '=');
    cli_option *e = cli_find(table, n, name, equals ? (size_t)(equals - name) : strlen(name));
    if (!e) cli_refuse(o, "unknown option %s%s", name, "");
    if (e->type == TYPE_HELP) cli_help(o, table, n);
    if (e->type == TYPE_LISTING) ranks_exit(ranks_first() ? listing_print() : CLI_OK);
    if (e->type == TYPE_VERSION) {
        if (ranks_first()) printf("%s, libmps %s\n", o->program, mps_version(NULL, NULL, NULL));
        ranks_exit(CLI_OK);
    }
    if (e->type == TYPE_FLAG) {
        if (equals) cli_refuse(o, "%s takes no value%s", e->name, "");
        *(bool *)e->value = e->flag;
        return;
    }
    const char *text = equals ? equals + 1 : *i + 1 < argc ? argv[++*i] : NULL;
    if (!text) cli_refuse(o, "%s needs a value: %s", e->name, e->argument);
    if (!text[0]) cli_refuse(o, "%s: must not be empty%s", e->name, "");
    cli_set(o, e, text);
}

/* Where a host starts a driver without standard streams, the first files would take their numbers, and messages would land in them. */
static void fill_streams(void)
{
    for (int fd = 0; fd <= 2; fd++)
        if (fcntl(fd, F_GETFD) == -1 && open("/dev/null", fd == 0 ? O_RDONLY : O_WRONLY) != fd)
            exit(2);
}

void cli_defaults(cli_options *o, const char *program, const char *about)
{
    fill_streams();
    *o = (cli_options){.program = program,
                       .about = about,
                       .model = "imps",
                       .solver = "sundials.pcg",
                       .out = "out",
                       .dp_min = 1e-5,
                       .dp_max = 1,
                       .cfl = 0.3,
                       .t_end = 1,
                       .t_max = 1e4,
                       .probe_dt = 1e-3,
                       .sensor_average = MPS_AVERAGE_AUTO,
                       .stl_scale = 1,
                       .gravity = 9.81,
                       .sigma = 7.27e-2, /* water and air */
                       .threads = 2,
                       .frames = 50,
                       .dim = 2,
                       .report = true};
}

void cli_own(cli_options *o, cli_option option)
{
    if (o->owns < CLI_OWN) o->own[o->owns++] = option;
}

void cli_parse(cli_options *o, int argc, char **argv)
{
    cli_option table[CLI_OPTIONS];
    if (ranks_begin(o->program, argc, argv)) o->threads = 1;
    o->both_phases = strncmp(o->model, "mmps", 4) == 0;
    o->two_phases = o->need || o->both_phases;
    int n = cli_table(o, table);
    for (int i = 1; i < argc; i++) cli_take(o, table, n, argc, argv, &i);
    if (o->t_end > 0 && o->dt > o->t_end) cli_refuse(o, "--dt is longer than --t-end%s%s", "", "");
    if (o->t_end > 0 && o->pictures > 0 && o->picture_t[o->pictures - 1] > o->t_end)
        cli_refuse(o, "--pictures has times later than --t-end%s%s", "", "");
}
