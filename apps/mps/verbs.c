/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of verbs: source of `mps --help`, the manual page and the shell completion. */
#include "cli.h"
#include <stddef.h>

static const char RUN_TEXT[] =
    "Writes probes.csv, summary.json, frames.pvd with frames/, pictures and report.html into the "
    "folder.\n"
    "A folder with an earlier run is refused unless --overwrite or --resume is given, and so is "
    "one\n"
    "that another run is writing to.\n"
    "A checkpoint is written every 10 minutes (run.checkpoint_clock) and shortly before the end.\n"
    "Ctrl-C, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2 and SIGXCPU end the run after its step with a\n"
    "checkpoint. 'mps resume DIR' continues a run after any end, also to a later one:\n"
    "--set run.until='10 s'. 'mps report' and 'mps stats' work on a run that is not finished.\n"
    "Progress in a log, every 10 s: t=0.123 step=567 dt=1.2e-04 wall=10.0 left=34.5; t and dt are\n"
    "simulated time [s], wall the time since the start and left the time until the end by the "
    "clock [s].\n"
    "A case of a page loads no plug-ins without --allow-plugins: a plug-in is a program that runs "
    "with\n"
    "your rights.\n"
    "Exit: 0 done, 1 failed, 2 wrong case or folder, 3 diverged (outputs stay readable),\n"
    "130 interrupted by one of these signals, with a checkpoint.\n";

static const char RESUME_TEXT[] =
    "After any end: done, a signal, kill -9, a failure, a full disk. The files have the bytes of "
    "a\n"
    "run without a stop. To a later end: --set run.until='10 s'; give output.frames the same\n"
    "interval then. A run that was killed before its first checkpoint begins again.\n"
    "--set may change run.until, run.threads, run.checkpoint, run.checkpoint_clock, title, "
    "impacts,\n"
    "collect, reference and output, but its rate, frame, trace and pieces; others are refused.\n";

static const char STATS_TEXT[] =
    "Without columns: all pressures of probes.csv, or impacts.sensors of the case. Constants are\n"
    "those of the case as it ran (impacts.*, T1), which summary.json has; they are printed. --set\n"
    "changes one without another run: --set impacts.threshold='6 kPa'. Writes statistics.json and\n"
    "statistics.csv into the folder.\n"
    "Values for a longer time are for screening, not for design.\n";

static const char REPORT_TEXT[] =
    "A constant of the statistics of impacts can be changed for this page, which names it: with\n"
    "mps report DIR --set impacts.threshold='6 kPa'. Other changes of a case need another run.\n";

static const char COMPARE_TEXT[] =
    "One run is compared with the known values of its case (key 'reference'). Of several, each is\n"
    "compared with the first one, and with a table where the last argument is a file. Columns of\n"
    "the same name are compared; --map P1=pressure compares column P1 of the run with 'pressure'.\n"
    "A single column of a table needs no --map where one column of the run has its kind of unit.\n"
    "Units are converted to those of the first. Without the first 0.5 % of the time that both "
    "have\n"
    "(the impulse of the start): rms of the difference, rms of the first about its mean, highest\n"
    "values with times, by how much the second is later at the largest correlation, this\n"
    "correlation, and the time as degrees of T1 of the first run that has it. Marks of a "
    "reference\n"
    "are compared at their times alone, lines all along.\n";

static const char SERIES_TEXT[] =
    "All runs are checked before the first one. Each has a folder of its own, DIR/001 and so on.\n"
    "The same command again skips runs that are done and continues those that were interrupted.\n"
    "Several processes, also of several machines with the same disk, may work in one folder: each\n"
    "skips the runs that another one has in progress. --jobs N makes N processes; --part I/N\n"
    "takes every N-th run, as a task of a queue's array. Without --threads the processes of "
    "--jobs\n"
    "share the processors. Ctrl-C ends the present runs with checkpoints, and no other begins. A\n"
    "run that fails does not stop the others.\n"
    "The table is DIR/sweep.csv, repeat.csv or converge.csv; 'mps collect DIR' makes that of a\n"
    "sweep again. It has the values of 'sweep' as texts and in SI (NAME.si), the exit code (nan: "
    "not\n"
    "done, or in progress in another process), and what a sweep collects: the largest value\n"
    "of each column, or what 'collect' of the case names: P1.max, .min, .mean, .last; P1.p3h, the\n"
    "pressure at full scale that is exceeded once in impacts.exposure, by Weibull; P1.p3h_pareto,\n"
    "by a generalised Pareto distribution; F.harmonic, the amplitude at the frequency of the\n"
    "motion. These are found between impacts.from and .until; nan: too few events; no frequency,\n"
    "or less than one period.\n"
    "Exit: 0 all are done, else the largest exit code of the runs.\n";

static const char COEFFICIENTS_TEXT[] =
    "F = -A a - B v - C x: loads of the liquid in small oscillations, one degree at a time, after\n"
    "a ramp, about motion.centre, axes of the lab. A contains the mass of the liquid: the ship "
    "must\n"
    "not contain it. C is from a slow tilt, by pressures of walls, and contains the weight of the\n"
    "liquid. Bands are 90 %, by the scatter from period to period. Loads are by the momentum of\n"
    "the liquid (sensors.*.load); 'A walls' is by the pressures of the walls.\n"
    "Periods are 1/0.5 to 1/1.5 T1 if none are given; T1 itself is left out. Each run has a "
    "folder\n"
    "of its own, DIR/001 and so on. The same command again skips runs that are done and continues\n"
    "an interrupted one. The tables: DIR/coefficients.csv, and coefficients.dat with plain "
    "columns\n"
    "for seakeeping programs: period [s], i, j, A_ij, B_ij; load i by motion j, 1 surge to 6 yaw.\n"
    "Exit: 0 all are done, else the largest exit code of the runs.\n";

/* Options of verbs that build a case. */
enum { HAS_CASE = HAS_SET | HAS_PLUGIN | HAS_TRUST };

static const char COLLECT_TEXT[] =
    "A folder is that of a run, or one with the folders of runs, as a sweep leaves it. The table\n"
    "has a row for each run: the texts of the inputs that differ, the same in SI (NAME.si), the\n"
    "exit code, and what 'collect' of the case names, as in sweep.csv. nan: a run is not done.\n"
    "It is DIR/sweep.csv of one folder of runs, else collected.csv here, or --out.\n";

enum {
    SERIES_OPTIONS = HAS_CASE | HAS_OUT | HAS_THREADS | HAS_OVERWRITE | HAS_QUIET | HAS_DEVICE |
                     HAS_JOBS | HAS_PART
};

static const char LIST_TEXT[] =
    "With --plugin FILE the lists have what the plug-in brings, too. 'mps list plugins' lists the\n"
    "plug-ins of --plugin, or those in the folders of MPS_PLUGIN_PATH, with what they bring.\n";

const verb cli_verbs[] = {
    {"run", "CASE", "Run a case: a YAML file, or a report.html with its case.", 1, 1,
     HAS_CASE | HAS_OUT | HAS_THREADS | HAS_OVERWRITE | HAS_RESUME | HAS_QUIET | HAS_PROFILE |
         HAS_MPI | HAS_DEVICE,
     verb_run, RUN_TEXT},
    {"resume", "DIR", "Continue the run in a folder from its checkpoint.", 1, 1,
     HAS_CASE | HAS_THREADS | HAS_QUIET | HAS_PROFILE | HAS_MPI | HAS_DEVICE, verb_resume,
     RESUME_TEXT},
    {"sweep", "CASE", "Run all combinations of the case's 'sweep'; a table of 'collect'.", 1, 1,
     SERIES_OPTIONS, verb_sweep, SERIES_TEXT},
    {"repeat", "CASE",
     "Run a case several times, spacing and steps within 0.5 %: bands of the largest values.", 1, 1,
     SERIES_OPTIONS | HAS_COUNT, verb_repeat, SERIES_TEXT},
    {"converge", "CASE", "Run a case with spacings of 2, sqrt(2) and 1 dp: order of convergence.",
     1, 1, SERIES_OPTIONS, verb_converge, SERIES_TEXT},
    {"coefficients", "CASE",
     "Added mass A(w) and damping B(w) of the liquid, by forced oscillations.", 1, 1,
     HAS_CASE | HAS_OUT | HAS_THREADS | HAS_OVERWRITE | HAS_QUIET | HAS_DEVICE | HAS_FREQUENCIES,
     verb_coefficients, COEFFICIENTS_TEXT},
    {"collect", "DIR ..", "Make the table of the runs in folders: inputs that differ, 'collect'.",
     1, CLI_FILES, HAS_OUT, verb_collect, COLLECT_TEXT},
    {"report", "DIR", "Make report.html of a run again, from its folder.", 1, 1, HAS_SET,
     verb_report, REPORT_TEXT},
    {"stats", "DIR [COLUMN ..]", "Impacts in the pressures of a run: events, peaks, fits.", 1,
     CLI_FILES, HAS_SET, verb_stats, STATS_TEXT},
    {"compare", "DIR [DIR ..] [reference.csv]",
     "Tell how the columns of runs differ, or a run from its reference.", 1, CLI_FILES, HAS_MAP,
     verb_compare, COMPARE_TEXT},
    {"check", "CASE",
     "Tell what a case means, without a run: counts, volumes, periods, time; draw it as SVG.", 1, 1,
     HAS_CASE | HAS_OUT | HAS_QUIET | HAS_JOBS, verb_check, NULL},
    {"fmu", "CASE",
     "Make CASE.fmu, a tank as a module for programs that couple models by the FMI standard.", 1, 1,
     HAS_CASE | HAS_OUT | HAS_QUIET | HAS_FMI, verb_fmu, NULL},
    {"init", "NAME",
     "Write a case with comments to start from into NAME.yaml; without NAME: list the names.", 0, 1,
     HAS_OUT | HAS_OVERWRITE, verb_init, NULL},
    {"list", "[cases|keys [NAME]|models|settings|solvers|units|measures|plugins]",
     "List names that cases use; 'mps list keys holes' lists the keys with 'holes' in name or "
     "text.",
     0, 2, HAS_PLUGIN, verb_list, LIST_TEXT},
    {"info", "FILE", "Tell what a file is: case, checkpoint, frame, table, page, surface.", 1, 1, 0,
     verb_info, NULL},
    {"schema", "", "Print the JSON Schema of case files, for editors.", 0, 0, 0, verb_schema,
     NULL}};

const int32_t cli_verb_count = sizeof cli_verbs / sizeof *cli_verbs;
