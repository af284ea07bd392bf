/* SPDX-License-Identifier: BSD-3-Clause */
/* The command line of the drivers, and their exit. */
#include "driver.h"
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { THREADS_MOST = 1024, FRAMES_MOST = 100000, OPTIONS = 48 };

/* ---- the end ---- */

void driver_finish(driver *d)
{
    mps_sim_destroy(d->sim);
    mps_job_destroy(d->job);
    if (d->ranks.end) d->ranks.end(d->ranks.user);
}

/* exit() on all ranks; one rank prints its text. */
static _Noreturn void leave(driver *d, int code, const char *text)
{
    int32_t speak;
    const int32_t all = mps_job_ranks_exit(d->ranks.end ? &d->ranks : NULL, code, &speak);
    if (speak) fputs(text, stderr);
    if (all < 0) d->ranks.abort(d->ranks.user, code);
    driver_finish(d);
    exit(all);
}

_Noreturn void driver_exit(driver *d, int code, const char *format, ...)
{
    char text[1200];
    va_list values;
    int used = snprintf(text, sizeof text, "%s: ", d->program);
    va_start(values, format);
    vsnprintf(text + used, sizeof text - (size_t)used - 1, format, values);
    va_end(values);
    memcpy(text + strlen(text), "\n", 2);
    leave(d, code, text);
}

_Noreturn void driver_refuse(driver *d, const char *format, ...)
{
    char text[900];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    driver_exit(d, MPS_EXIT_USAGE, "%s\n%s --help lists all options", text, d->program);
}

void driver_check(driver *d, mps_status status, const char *what)
{
    if (status >= 0) return;
    /* the geometry is fixed: the error is an option, usually --dp */
    driver_exit(d, status == MPS_E_ARG ? MPS_EXIT_USAGE : MPS_EXIT_FAILED, "%s: %s: %s", what,
                mps_status_name(status), mps_sim_error(d->sim));
}

void driver_check_job(driver *d, mps_status status)
{
    if (status >= 0) return;
    driver_exit(d, status == MPS_E_ARG ? MPS_EXIT_USAGE : MPS_EXIT_FAILED, "%s: %s",
                mps_status_name(status), mps_job_error(d->job));
}

/* ---- ranks ---- */

/* Rank variables that mpirun of Open MPI, or of MPICH and others, sets for each process. */
static int started_with(const char *openmpi, const char *pmi)
{
    const char *text = getenv(openmpi);
    if (!text) text = getenv(pmi);
    return text ? atoi(text) : 0;
}

/* Processes that mpirun starts without --mpi would all write to the same folder. */
static void check_alone(driver *d)
{
    const int count = started_with("OMPI_COMM_WORLD_SIZE", "PMI_SIZE");
    if (count < 2) return;
    if (started_with("OMPI_COMM_WORLD_RANK", "PMI_RANK") == 0)
        driver_exit(
            d, MPS_EXIT_USAGE,
            "mpirun started %d processes: --mpi makes one run of them; without it start one "
            "process",
            count);
    sleep(1); /* mpirun then ends all processes */
    leave(d, MPS_EXIT_USAGE, "");
}

/* Search --mpi and initialise MPI before any output. */
static void begin_ranks(driver *d, int argc, char **argv)
{
    char error[600];
    for (int i = 1; i < argc; i++) d->mpi = d->mpi || strcmp(argv[i], "--mpi") == 0;
    if (!d->mpi) {
        check_alone(d);
        return;
    }
    d->threads = 1;
    if (mps_job_ranks_load(&d->ranks, error, sizeof error) != MPS_OK)
        driver_exit(d, MPS_EXIT_USAGE,
                    "--mpi: %s; it is built with the drivers where there are MPI and Zoltan "
                    "(Debian: libopenmpi-dev, libtrilinos-zoltan-dev): cmake -DMPS_WITH_MPI=ON; of "
                    "the packages of libmps --mpi needs libmps-mpi1",
                    error);
}

/* ---- the command line ---- */

/* A line for each option. */
/* clang-format off */
static int make_table(driver *d, option *table)
{
    const char *models = d->two_phases ? "imps, mmps (several phases), imps.paper or mmps.paper" : "imps or imps.paper";
    int n = 0;
    table[n++] = (option){"--model", "NAME", models, TYPE_TEXT, &d->model, 0, 0, false, NULL};
    table[n++] = (option){"--use", "SLOT.VARIANT", "replace the model of a slot; may be repeated", TYPE_LIST, &d->use, 0, 0, false, NULL};
    table[n++] = (option){"--remove", "SLOT", "switch off the model of a slot; may be repeated", TYPE_LIST, &d->remove, 0, 0, false, NULL};
    table[n++] = (option){"--set", "SLOT.KEY=X", "change a setting of a model; may be repeated", TYPE_LIST, &d->set, 0, 0, false, NULL};
    table[n++] = (option){"--re-far", "X", "far radius [dp]; default: that of the preset", TYPE_REAL, &d->re_far, 2.1, 10, false, NULL};
    table[n++] = (option){"--dp", "M", "particle spacing [m]", TYPE_REAL, &d->dp, d->dp_min, d->dp_max, false, NULL};
    table[n++] = (option){"--dt", "S", "fixed time step [s]; default: adaptive", TYPE_REAL, &d->dt, 0, 0.1, false, NULL};
    table[n++] = (option){"--cfl", "C", "adaptive step: largest dt u / dp", TYPE_REAL, &d->cfl, 0, 1, false, NULL};
    table[n++] = (option){"--calm", "C", "adaptive step: largest dt sqrt(g / dp); default: that of the preset", TYPE_REAL, &d->calm, 0, 1, false, NULL};
    table[n++] = (option){"--t-end", "S", "time simulated [s]", TYPE_REAL, &d->t_end, 0, d->t_max, false, NULL};
    table[n++] = (option){"--threads", "N", "threads of the simulation", TYPE_INT, &d->threads, 1, THREADS_MOST, false, NULL};
    table[n++] = (option){"--mpi", NULL, "one run on the ranks that mpirun starts, one thread each unless --threads says more", TYPE_FLAG, &d->mpi, 0, 0, true, NULL};
    table[n++] = (option){"--device", "NAME", "device of the time steps: cuda, or cuda:1; default: the host", TYPE_TEXT, &d->device, 0, 0, false, NULL};
    table[n++] = (option){"--solver", "NAME", "pressure solver, or solver/preconditioner", TYPE_TEXT, &d->solver, 0, 0, false, NULL};
    table[n++] = (option){"--out", "DIR", "folder for all outputs", TYPE_TEXT, &d->out, 0, 0, false, NULL};
    table[n++] = (option){"--frames", "N", "frames for ParaView besides the first; 0: none", TYPE_INT, &d->frames, 0, FRAMES_MOST, false, NULL};
    table[n++] = (option){"--tank-frame", NULL, "frames in the frame of the tank: its walls stand still", TYPE_FLAG, &d->tank_frame, 0, 0, true, NULL};
    table[n++] = (option){"--pieces", NULL, "with --mpi: each rank writes its own .vtp of a frame, and a .pvtp names them", TYPE_FLAG, &d->pieces, 0, 0, true, NULL};
    table[n++] = (option){"--checkpoint", "S", "a checkpoint every S simulated seconds, besides those every 10 minutes by the clock", TYPE_REAL, &d->checkpoint, 1e-6, d->t_max, false, NULL};
    table[n++] = (option){"--resume", NULL, "go on from the checkpoint in the folder of --out", TYPE_FLAG, &d->resume, 0, 0, true, NULL};
    table[n++] = (option){"--overwrite", NULL, "remove an earlier run from the folder of --out", TYPE_FLAG, &d->overwrite, 0, 0, true, NULL};
    table[n++] = (option){"--probe-dt", "S", "interval of rows in probes.csv [s]", TYPE_REAL, &d->probe_dt, 0, 10, false, NULL};
    table[n++] = (option){"--sensor-average", "S", "wall pressures and forces: mean of the last S seconds; 0: no mean; default: dp/u", TYPE_REAL, &d->sensor_average, -1, 10, false, &d->average_given};
    table[n++] = (option){"--pictures", "T,T,..", "times of the pictures [s]; default: quarters of the run", TYPE_TIMES, &d->pictures, 0, 0, false, NULL};
    if (d->has_dim) table[n++] = (option){"--dim", "D", "2 or 3 dimensions", TYPE_INT, &d->dim, 2, 3, false, NULL};
    if (d->amplitude > 0) table[n++] = (option){"--amplitude", "M", "amplitude of the motion [m]", TYPE_REAL, &d->amplitude, 0, 10, false, NULL};
    if (d->has_ramp) table[n++] = (option){"--ramp", "N", "periods in which the motion grows to its amplitude; 0: it starts at once", TYPE_REAL, &d->ramp, -1, 100, false, NULL};
    if (d->has_layers) table[n++] = (option){"--layers", "N", "columns of particles of the baffle; 0: by its thickness", TYPE_INT, &d->layers, 0, 100, false, NULL};
    if (d->has_sigma) table[n++] = (option){"--sigma", "N/M", "surface tension [N/m], for models that have it", TYPE_REAL, &d->sigma, -1, 100, false, &d->sigma_given};
    for (int i = 0; i < d->owns; i++) table[n++] = d->own[i];
    table[n++] = (option){"--no-report", NULL, "no report.html", TYPE_FLAG, &d->report, 0, 0, false, NULL};
    table[n++] = (option){"--profile", NULL, "print a table of all passes of the steps: calls, seconds, bytes", TYPE_FLAG, &d->profile, 0, 0, true, NULL};
    table[n++] = (option){"--quiet", NULL, "no progress", TYPE_FLAG, &d->quiet, 0, 0, true, NULL};
    table[n++] = (option){"--list-models", NULL, "all models with settings, channels and solvers", TYPE_ASK, NULL, 0, 0, false, NULL};
    table[n++] = (option){"--version", NULL, "version of the library", TYPE_ASK, NULL, 0, 0, false, NULL};
    table[n++] = (option){"--help", NULL, "this text", TYPE_ASK, NULL, 0, 0, false, NULL};
    return n;
}
/* clang-format on */

static void print_help(const driver *d, const option *table, int count)
{
    printf("%s - %s\n\nusage: %s [options]\n\n", d->program, d->about, d->program);
    options_help(stdout, table, count);
    printf("\nWrites probes.csv, summary.json, frames.pvd with frames/, pictures and "
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
}

/* --help, --version, --list-models */
static _Noreturn void answer(driver *d, const option *asked, const option *table, int count)
{
    char *text = NULL;
    if (d->ranks.rank == 0 && strcmp(asked->name, "--help") == 0) print_help(d, table, count);
    if (d->ranks.rank == 0 && strcmp(asked->name, "--version") == 0)
        printf("%s, libmps %s\n", d->program, mps_version(NULL, NULL, NULL));
    if (d->ranks.rank == 0 && strcmp(asked->name, "--list-models") == 0) {
        if (mps_job_models_text(&text) != MPS_OK) driver_exit(d, MPS_EXIT_FAILED, "out of memory");
        fputs(text, stdout);
    }
    free(text);
    leave(d, MPS_EXIT_OK, "");
}

/* If a driver is started without standard streams, the first opened files would get their
 * descriptors and receive messages. */
static void fill_streams(void)
{
    for (int fd = 0; fd <= 2; fd++)
        if (fcntl(fd, F_GETFD) == -1 && open("/dev/null", fd == 0 ? O_RDONLY : O_WRONLY) != fd)
            exit(2);
}

void driver_defaults(driver *d, const char *program, const char *about)
{
    fill_streams();
    *d = (driver){.program = program,
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
                  .gravity = 9.81,
                  .sigma = 7.27e-2, /* water and air */
                  .threads = 2,
                  .frames = 50,
                  .dim = 2,
                  .report = true};
}

void driver_own(driver *d, option own)
{
    if (d->owns < DRIVER_OWN) d->own[d->owns++] = own;
}

/* The command line as text. */
static void keep_command(driver *d, int argc, char **argv)
{
    size_t used = 0;
    for (int i = 0; i < argc && used < sizeof d->command; i++)
        used += (size_t)snprintf(d->command + used, sizeof d->command - used, "%s%s", i ? " " : "",
                                 i ? argv[i] : d->program);
}

void driver_parse(driver *d, int argc, char **argv)
{
    option table[OPTIONS];
    char message[OPTION_MESSAGE];
    begin_ranks(d, argc, argv);
    keep_command(d, argc, argv);
    d->both_phases = driver_has_gas(d);
    d->two_phases = d->need || d->both_phases;
    const int count = make_table(d, table);
    const option *asked = options_parse(table, count, argc, argv, message);
    if (asked) answer(d, asked, table, count);
    if (message[0]) driver_refuse(d, "%s", message);
    if (d->t_end > 0 && d->dt > d->t_end) driver_refuse(d, "--dt is longer than --t-end");
    if (d->t_end > 0 && d->pictures.count > 0 && d->pictures.t[d->pictures.count - 1] > d->t_end)
        driver_refuse(d, "--pictures has times later than --t-end");
}
