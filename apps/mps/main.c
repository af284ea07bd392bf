/* SPDX-License-Identifier: BSD-3-Clause */
/* mps: tanks, liquids and motions from case files. */
#include "cli.h"
#include <fcntl.h>
#include <mps/mps.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char RUN_TEXT[] =
    "Writes probes.csv, summary.json, frames.pvd with frames/, pictures and report.html into the "
    "folder.\n"
    "A folder with an earlier run is refused unless --overwrite or --resume is given, and so is "
    "one\n"
    "that another run is writing to.\n"
    "Ctrl-C (or SIGTERM, SIGHUP) ends the run after its step with a checkpoint; 'mps resume DIR'\n"
    "continues from it, also to a later end: --set run.until='10 s'.\n"
    "Exit: 0 done, 1 failed, 2 wrong case or folder, 3 diverged (outputs stay readable),\n"
    "130 interrupted.\n";

static const char STATS_TEXT[] =
    "Without columns: all pressures of probes.csv, or impacts.sensors of the case. Constants are\n"
    "those of the case (impacts.*, T1). Writes statistics.json and statistics.csv into the "
    "folder.\n"
    "Values for a longer time are for screening, not for design.\n";

static const char COMPARE_TEXT[] =
    "Each run is compared with the first one, and with a table where the last argument is a file.\n"
    "Columns of the same name are compared in the time that both have, without its first 0.5 %\n"
    "(the impulse of the start): rms of the difference, rms of the first about its mean, highest\n"
    "values with times, by how much the run is later, and this as degrees of T1 of\n"
    "the first run that has it.\n";

static const char SERIES_TEXT[] =
    "Each run has a folder of its own, DIR/001 and so on. The same line again skips the runs that\n"
    "are done and continues an interrupted one. Ctrl-C ends the present run with a checkpoint, "
    "and\n"
    "no other begins. A run that fails does not stop the others.\n"
    "Exit: 0 all are done, else the largest exit code of the runs.\n";

static const verb VERBS[] = {
    {"run", "CASE", "Run a case: a YAML file, or a report.html with its case.", 1, 1,
     HAS_SET | HAS_OUT | HAS_THREADS | HAS_OVERWRITE | HAS_RESUME | HAS_QUIET | HAS_PROFILE |
         HAS_MPI,
     verb_run, RUN_TEXT},
    {"resume", "DIR", "Continue the run in a folder from its checkpoint.", 1, 1,
     HAS_SET | HAS_THREADS | HAS_QUIET | HAS_PROFILE | HAS_MPI, verb_resume, NULL},
    {"sweep", "CASE", "Run all combinations of the case's 'sweep'; a table of 'collect'.", 1, 1,
     HAS_SET | HAS_OUT | HAS_THREADS | HAS_OVERWRITE | HAS_QUIET, verb_sweep, SERIES_TEXT},
    {"repeat", "CASE", "Run a case with dp within 0.5 %; mean and band of the largest values.", 1,
     1, HAS_SET | HAS_OUT | HAS_THREADS | HAS_OVERWRITE | HAS_QUIET | HAS_COUNT, verb_repeat,
     SERIES_TEXT},
    {"converge", "CASE", "Run a case with dp times 2, sqrt(2), 1; order of the largest values.", 1,
     1, HAS_SET | HAS_OUT | HAS_THREADS | HAS_OVERWRITE | HAS_QUIET, verb_converge, SERIES_TEXT},
    {"report", "DIR", "Make report.html of a run again, from its folder.", 1, 1, 0, verb_report,
     NULL},
    {"stats", "DIR [COLUMN ..]", "Impacts in the pressures of a run: events, peaks, fits.", 1,
     CLI_FILES, 0, verb_stats, STATS_TEXT},
    {"compare", "DIR DIR .. [reference.csv]", "Say how the columns of runs differ.", 2, CLI_FILES,
     0, verb_compare, COMPARE_TEXT},
    {"check", "CASE",
     "Say what a case amounts to, without running it, and draw tank and sensors as SVG.", 1, 1,
     HAS_SET | HAS_OUT | HAS_QUIET, verb_check, NULL},
    {"init", "NAME",
     "Write a commented case to start from into NAME.yaml; 'mps list cases' shows the names.", 1, 1,
     HAS_OUT | HAS_OVERWRITE, verb_init, NULL},
    {"list", "[cases|keys [NAME]|models|settings|solvers|units|measures]",
     "List what there is; of the keys those with a name, e.g. 'mps list keys holes'.", 0, 2, 0,
     verb_list, NULL},
    {"info", "FILE", "Say what a file is: case, checkpoint, frame, table, page, surface.", 1, 1, 0,
     verb_info, NULL},
    {"schema", "", "Print the JSON Schema of case files, for editors.", 0, 0, 0, verb_schema,
     NULL}};

enum { VERB_COUNT = sizeof VERBS / sizeof *VERBS };

static void print_all(FILE *out)
{
    fprintf(out, "usage: mps VERB ...\n\n");
    for (int i = 0; i < VERB_COUNT; i++) fprintf(out, "  %-8s %s\n", VERBS[i].name, VERBS[i].help);
    fprintf(out, "\n'mps VERB --help' explains a verb. 'mps --version' prints the version.\n");
}

/* Where a host starts a program without standard streams, the first files would take their numbers, and messages would land in them. */
static void fill_streams(void)
{
    for (int fd = 0; fd <= 2; fd++)
        if (fcntl(fd, F_GETFD) == -1 && open("/dev/null", fd == 0 ? O_RDONLY : O_WRONLY) != fd)
            exit(MPS_EXIT_USAGE);
}

static const verb *find_verb(const char *name)
{
    for (int i = 0; i < VERB_COUNT; i++)
        if (strcmp(VERBS[i].name, name) == 0) return &VERBS[i];
    return NULL;
}

int main(int argc, char **argv)
{
    static choices c;
    fill_streams();
    signal(SIGPIPE, SIG_IGN); /* a reader of stderr that goes away does not end the run */
    if (argc < 2 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "help") == 0) {
        print_all(argc < 2 ? stderr : stdout);
        return argc < 2 ? MPS_EXIT_USAGE : MPS_EXIT_OK;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("mps, libmps %s\n", mps_version(NULL, NULL, NULL));
        return MPS_EXIT_OK;
    }
    const verb *v = find_verb(argv[1]);
    if (!v) {
        fprintf(stderr, "mps: '%s' is no verb\n", argv[1]);
        print_all(stderr);
        return MPS_EXIT_USAGE;
    }
    c.program = argv[0];
    c.verb = v->name;
    const int code = cli_read(&c, v, argc, argv);
    return code >= 0 ? code : v->run(&c);
}
