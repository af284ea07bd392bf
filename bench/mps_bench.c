/* SPDX-License-Identifier: BSD-3-Clause */
/* Speed and memory of the step on real cases, and of the pressure solvers on equations recorded there. */
#include "bench.h"
#include <math.h>
#include <mps/job.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct list {
    int count;
    const char *text[BENCH_LIST];
} list;

typedef struct options {
    list cases, solvers, threads, replay;
    int64_t steps, warm;
    int repeats;
    double skip, t_end, re_far, tolerance;
    const char *json, *record;
    bool profile;
} options;

/* One measured run. */
typedef struct outcome {
    char name[BENCH_NAME], solver[BENCH_NAME];
    int32_t dim, threads;
    double dp, triad, t, wall, cpu, iterations, unknowns, seconds[MPS_STAGE_COUNT], peak, bytes;
    int64_t particles, steps, not_converged;
    int32_t most_iterations;
} outcome;

static const char usage[] =
    "usage: mps_bench [options]\n"
    "  --case kind/dp     dam2d, dam3d, air2d, air3d, static2d, breaking or breaking_air, dp in "
    "mm; may be given\n"
    "                     several times (default dam2d/5 dam2d/2.5 dam2d/1.25 dam3d/10 dam3d/5 "
    "breaking/10\n"
    "                     static2d/10 breaking_air/10)\n"
    "  --threads n        may be given several times (default 1)\n"
    "  --solver s/p       solver and preconditioner, may be given several times (default: the "
    "library's;\n"
    "                     also hypre.boomeramg, if built with hypre)\n"
    "  --steps n          steps measured (default 40)\n"
    "  --warm n           steps before them (default 10)\n"
    "  --skip t           physical time before them [s] (default 0)\n"
    "  --t-end t          measure until this time [s], instead of --steps\n"
    "  --repeats n        whole list of runs n times, one after the other (default 1)\n"
    "  --re-far r         far radius [dp]\n"
    "  --tolerance x      relative residual (default 1e-6)\n"
    "  --profile          a table of all passes of the measured steps, before the line of each "
    "run\n"
    "  --json file        all figures\n"
    "  --record file      write the pressure equation of the last step\n"
    "  --replay file      solve a recorded equation with every solver and number of threads; may "
    "be given several times\n";

static void list_add(list *l, const char *text)
{
    if (l->count == BENCH_LIST) bench_fail(text, "too many");
    l->text[l->count++] = text;
}

static double number(const char *option, const char *text)
{
    char *end;
    const double v = strtod(text, &end);
    if (*end || !(v >= 0) || v > 1e9) bench_fail(option, "needs a number that is not negative");
    return v;
}

static void parse(options *o, int argc, char **argv)
{
    struct {
        const char *name;
        list *texts;
        double *value;
    } number_or_list[] = {{"--case", &o->cases, NULL},     {"--threads", &o->threads, NULL},
                          {"--solver", &o->solvers, NULL}, {"--replay", &o->replay, NULL},
                          {"--skip", NULL, &o->skip},      {"--t-end", NULL, &o->t_end},
                          {"--re-far", NULL, &o->re_far},  {"--tolerance", NULL, &o->tolerance}};
    for (int k = 1; k < argc; k++) {
        const char *name = argv[k];
        bool known = false;
        if (strcmp(name, "--profile") == 0) {
            o->profile = true;
            continue;
        }
        const char *text = k + 1 < argc ? argv[++k] : NULL;
        if (!text) {
            fputs(usage, stdout);
            exit(strcmp(name, "--help") ? 2 : 0);
        }
        for (size_t m = 0; m < sizeof number_or_list / sizeof number_or_list[0]; m++) {
            if (strcmp(name, number_or_list[m].name) != 0) continue;
            known = true;
            if (number_or_list[m].texts)
                list_add(number_or_list[m].texts, text);
            else
                *number_or_list[m].value = number(name, text);
        }
        if (known) continue;
        if (strcmp(name, "--steps") == 0)
            o->steps = (int64_t)number(name, text);
        else if (strcmp(name, "--warm") == 0)
            o->warm = (int64_t)number(name, text);
        else if (strcmp(name, "--repeats") == 0)
            o->repeats = (int)number(name, text);
        else if (strcmp(name, "--json") == 0)
            o->json = text;
        else if (strcmp(name, "--record") == 0)
            o->record = text;
        else
            bench_fail(name, "no such option; see --help");
    }
}

/* ---- a run ---- */

static void use_solver(mps_sim *sim, const char *pair)
{
    char solver[BENCH_NAME];
    const char *slash = strchr(pair, '/');
    if (!pair[0]) return;
    bench_plugin(sim, pair);
    snprintf(solver, sizeof solver, "%.*s", slash ? (int)(slash - pair) : (int)strlen(pair), pair);
    if (mps_solver_use(sim, solver, slash ? slash + 1 : NULL) < 0)
        bench_fail(pair, mps_sim_error(sim));
}

static void set_tolerance(mps_sim *sim, double tolerance)
{
    mps_solver_limits limits;
    mps_solver_limits_init(&limits, sizeof limits);
    limits.tolerance = tolerance;
    if (mps_solver_limits_set(sim, &limits) < 0) bench_fail("--tolerance", mps_sim_error(sim));
}

static void step(mps_sim *sim, double dt_max, mps_step_info *info)
{
    mps_step_info_init(info, sizeof *info);
    if (mps_step(sim, dt_max, info) < 0) bench_fail("step", mps_sim_error(sim));
}

static bool more(const options *o, const outcome *r, double t)
{
    return o->t_end > 0 ? t < o->t_end - 1e-12 : r->steps < o->steps;
}

static void measure(const options *o, mps_sim *sim, outcome *r)
{
    double t;
    mps_step_info info = {0};
    for (mps_sim_time(sim, &t, NULL); t < o->skip - 1e-12; t = info.t)
        step(sim, o->skip - t, &info);
    for (int64_t k = 0; k < o->warm; k++) step(sim, 1.0, &info);
    mps_sim_time(sim, &t, NULL);
    mps_profile_reset(sim);
    const double wall = bench_wall(), cpu = bench_cpu(), begin = t;
    while (more(o, r, t)) {
        step(sim, o->t_end > 0 ? o->t_end - t : 1.0, &info);
        t = info.t;
        r->steps++;
        r->iterations += info.ppe_iterations;
        r->unknowns += (double)info.ppe_unknowns;
        if (info.ppe_iterations > r->most_iterations) r->most_iterations = info.ppe_iterations;
        for (int k = 0; k < MPS_STAGE_COUNT; k++) r->seconds[k] += info.seconds[k];
    }
    r->wall = bench_wall() - wall;
    r->cpu = bench_cpu() - cpu;
    r->t = t - begin;
}

static void print_profile(mps_sim *sim, const outcome *r)
{
    double seconds = 0;
    for (int k = 0; k < MPS_STAGE_COUNT; k++) seconds += r->seconds[k];
    char *text;
    if (mps_job_profile_text(sim, seconds, &text) != MPS_OK) return;
    fputs(text, stdout);
    fflush(stdout);
    free(text);
}

static outcome run(const options *o, const char *name, const char *solver, int32_t threads)
{
    outcome r = {.threads = threads};
    bench_case c;
    bench_memory memory;
    mps_lease x = {.struct_size = sizeof x};
    const char *why = bench_case_find(name, &c), *used[2];
    if (why) bench_fail(name, why);
    mps_sim *sim = bench_case_make(&c, threads, o->re_far, &memory);
    use_solver(sim, solver);
    set_tolerance(sim, o->tolerance);
    if (o->record) bench_record(sim, o->record);
    mps_solver_name(sim, &used[0], &used[1]);
    mps_sim_shape(sim, &r.dim, &r.dp);
    snprintf(r.name, sizeof r.name, "%s", name);
    snprintf(r.solver, sizeof r.solver, "%s/%s", used[0], used[1] ? used[1] : "none");
    r.triad = bench_triad();
    measure(o, sim, &r);
    if (o->profile) print_profile(sim, &r);
    if (mps_lease_begin(sim, "position", MPS_READ, &x) < 0) bench_fail(name, mps_sim_error(sim));
    r.particles = x.count;
    mps_lease_end(sim, &x);
    r.bytes = (double)memory.held / (double)r.particles;
    r.peak = (double)memory.peak / (double)r.particles;
    mps_sim_destroy(sim);
    return r;
}

/* ---- output ---- */

static void print(const outcome *r)
{
    const double steps = (double)r->steps, rows = r->unknowns * 1e-6, total = r->wall;
    printf("%-13s %-20s %d thr %8lld particles %8.2f ms/step %6.3f M/s(cpu) %6.3f M/s(wall) | it "
           "%5.1f most %3d | PPE %.3f + %.3f s/M |",
           r->name, r->solver, r->threads, (long long)r->particles, 1e3 * r->wall / steps,
           1e-6 * (double)r->particles * steps / r->cpu,
           1e-6 * (double)r->particles * steps / r->wall, r->iterations / steps, r->most_iterations,
           r->seconds[MPS_STAGE_PPE_SETUP] / rows, r->seconds[MPS_STAGE_PPE_SOLVE] / rows);
    for (int k = 0; k < MPS_STAGE_COUNT; k++) printf(" %.0f", 100 * r->seconds[k] / total);
    printf(" %% | %.0f peak %.0f B | triad %.1f GB/s | %.0f cpu s/s\n", r->bytes, r->peak, r->triad,
           r->cpu / r->t);
    fflush(stdout);
}

static void print_json(FILE *f, const outcome *r, bool last)
{
    static const char *const stage[MPS_STAGE_COUNT] = {"neighbours", "operators", "ppe_setup",
                                                       "ppe_solve", "correct"};
    const double steps = (double)r->steps;
    fprintf(f,
            "  {\"case\": \"%s\", \"solver\": \"%s\", \"threads\": %d, \"dim\": %d, \"dp\": %g, "
            "\"particles\": %lld, \"steps\": %lld,\n"
            "   \"physical_s\": %.9g, \"wall_s\": %.6g, \"cpu_s\": %.6g, "
            "\"particle_steps_per_cpu_s\": %.6g, "
            "\"particle_steps_per_wall_s\": %.6g,\n"
            "   \"ppe_iterations\": %.4g, \"ppe_iterations_most\": %d, \"ppe_unknowns\": %.0f, "
            "\"bytes_per_particle\": %.1f,\n"
            "   \"peak_bytes_per_particle\": %.1f, \"triad_GB_per_s\": %.4g, \"stage_s\": {",
            r->name, r->solver, r->threads, r->dim, r->dp, (long long)r->particles,
            (long long)r->steps, r->t, r->wall, r->cpu, (double)r->particles * steps / r->cpu,
            (double)r->particles * steps / r->wall, r->iterations / steps, r->most_iterations,
            r->unknowns / steps, r->bytes, r->peak, r->triad);
    for (int k = 0; k < MPS_STAGE_COUNT; k++)
        fprintf(f, "%s\"%s\": %.6g", k ? ", " : "", stage[k], r->seconds[k]);
    fprintf(f, "}}%s\n", last ? "" : ",");
}

static void run_all(const options *o)
{
    FILE *json = o->json ? fopen(o->json, "w") : NULL;
    if (o->json && !json) bench_fail(o->json, "cannot be written");
    const int runs = o->cases.count * o->threads.count * o->solvers.count * o->repeats;
    if (json) fputs("[\n", json);
    for (int k = 0; k < runs; k++) { /* neighbours in time are those that are compared */
        const int solver = k % o->solvers.count, rest = k / o->solvers.count,
                  threads = rest % o->threads.count;
        const char *name = o->cases.text[rest / o->threads.count % o->cases.count];
        const outcome r = run(o, name, o->solvers.text[solver],
                              (int32_t)number("--threads", o->threads.text[threads]));
        print(&r);
        if (json) print_json(json, &r, k == runs - 1);
    }
    if (json) fputs("]\n", json);
    if (json && fclose(json) != 0) bench_fail(o->json, "cannot be written");
}

static void replay_all(const options *o)
{
    for (int f = 0; f < o->replay.count; f++)
        for (int s = 0; s < o->solvers.count; s++)
            for (int t = 0; t < o->threads.count; t++) {
                const char *pair = o->solvers.text[s][0] ? o->solvers.text[s] : "sundials.pcg";
                bench_replay(o->replay.text[f], pair,
                             (int32_t)number("--threads", o->threads.text[t]), o->tolerance,
                             o->repeats);
            }
}

int main(int argc, char **argv)
{
    static const char *const usual[] = {"dam2d/5", "dam2d/2.5",   "dam2d/1.25",  "dam3d/10",
                                        "dam3d/5", "breaking/10", "static2d/10", "breaking_air/10"};
    options o = {.steps = 40, .warm = 10, .repeats = 1, .tolerance = 1e-6};
    parse(&o, argc, argv);
    const bool chosen = o.cases.count > 0;
    for (size_t k = 0; !chosen && k < sizeof usual / sizeof usual[0]; k++)
        list_add(&o.cases, usual[k]);
    if (o.threads.count == 0) list_add(&o.threads, "1");
    if (o.solvers.count == 0) list_add(&o.solvers, "");
    if (o.replay.count > 0)
        replay_all(&o);
    else
        run_all(&o);
    return 0;
}
