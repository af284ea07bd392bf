/* SPDX-License-Identifier: BSD-3-Clause */
/* One run of the sweep: draw a tank from a seed, step it to the end, print the result in one line.
 * scripts/sweep runs many of them. Exit code 0: ok, 1: something is wrong, 2: bad command line. */
#include "../tags.h"
#include <mps/picture.h>
#include "scenario.h"
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { CHECK_EVERY = 50, PATH_SIZE = 512, CHANGES = 16 };

static const double LEAK = 0.5;       /* [dp] beyond a wall of a closed tank */
static const double TOO_FAST = 5;     /* times the speed of the tank and of a fall through it */
static const double TOO_DENSE = 0.05; /* mean volume deviation */

/* A change of the preset: what to do, and with what. */
typedef struct change {
    char what; /* 'u'se, 'r'emove, 's'et */
    const char *text;
} change;

typedef struct options {
    scenario what;
    change change[CHANGES];
    int changes;
    const char *model, *pictures; /* pictures: NULL, or the beginning of their paths */
    double t_end, every;          /* [s] */
    double refine;                /* the spacing is what was drawn, over this */
} options;

/* What was seen so far. */
typedef struct findings {
    mps_status status;
    const char *wrong; /* NULL: nothing */
    double built[3];
    int64_t fluid, missing, bad,
        not_converged; /* initial particles, lost without notice, non-finite; steps */
    double outside;    /* furthest of a fluid particle beyond a wall [dp], < 0: inside */
    double tank_speed, max_speed, min_dt; /* [m/s], [s] */
    double volume_error, volume_worst;    /* at the last check, largest */
    mps_step_info info;
} findings;

static volatile sig_atomic_t stop_asked;

static void ask_stop(int number)
{
    (void)number;
    stop_asked = 1;
}

/* ---- checks ---------------------------------------------------------------------------------- */

/* Columns of the tank's axes in the lab and its origin; notes how fast its corners are. */
static void tank_frame(mps_sim *sim, findings *f, int32_t dim, double origin[3], double axes[3][3])
{
    for (int corner = (1 << dim) - 1; corner >= 0; corner--) {
        double tank[3], speed = 0, velocity[3];
        for (int d = 0; d < dim; d++) tank[d] = corner >> d & 1 ? f->built[d] : 0;
        mps_motion_to_lab(sim, tank, origin, velocity);
        for (int d = 0; d < dim; d++) speed += velocity[d] * velocity[d];
        f->tank_speed = fmax(f->tank_speed, sqrt(speed));
    }
    for (int axis = 0; axis < dim; axis++) {
        double tank[3] = {0, 0, 0};
        tank[axis] = 1;
        mps_motion_to_lab(sim, tank, axes[axis], NULL);
        for (int d = 0; d < dim; d++) axes[axis][d] -= origin[d];
    }
}

/* Distance of a position in the lab beyond the nearest wall [m]; the top of an open tank is no
 * wall. */
static double beyond(const options *o, const findings *f, const double *x, const double *origin,
                     double axes[3][3])
{
    double furthest = -INFINITY;
    for (int axis = 0; axis < o->what.dim; axis++) {
        double at = 0;
        for (int d = 0; d < o->what.dim; d++) at += (x[d] - origin[d]) * axes[axis][d];
        furthest = fmax(furthest, -at);
        if (axis != 1 || !o->what.open_top) furthest = fmax(furthest, at - f->built[axis]);
    }
    return furthest;
}

static int64_t count_bad(const mps_lease *v, const int32_t *kind)
{
    int64_t bad = 0;
    for (int64_t i = 0; i < v->count * v->stride; i++)
        bad += kind[i / v->stride] == MPS_FLUID && !isfinite(v->data[i]);
    return bad;
}

static void check_field(mps_sim *sim, findings *f, const char *name, const int32_t *kind)
{
    mps_lease v = {.struct_size = sizeof v};
    if (mps_lease_begin(sim, name, MPS_READ, &v) != MPS_OK) return;
    f->bad += count_bad(&v, kind);
    mps_lease_end(sim, &v);
}

static void check_places(const options *o, mps_sim *sim, findings *f, const int32_t *kind)
{
    double origin[3], axes[3][3];
    mps_lease x = {.struct_size = sizeof x};
    tank_frame(sim, f, o->what.dim, origin, axes);
    if (mps_lease_begin(sim, "position", MPS_READ, &x) != MPS_OK) return;
    for (int64_t i = 0; i < x.count; i++)
        if (kind[i] == MPS_FLUID)
            f->outside = fmax(f->outside,
                              beyond(o, f, x.data + i * x.stride, origin, axes) / o->what.dp);
    mps_lease_end(sim, &x);
}

static void check(const options *o, mps_sim *sim, findings *f)
{
    const int32_t *kind;
    mps_energy energy;
    mps_energy_init(&energy, sizeof energy);
    if (tags_peek(sim, NULL, &kind, NULL, NULL) != MPS_OK || mps_energy_get(sim, &energy) != MPS_OK)
        return;
    check_field(sim, f, "position", kind);
    check_field(sim, f, "velocity", kind);
    check_field(sim, f, "pressure", kind);
    check_places(o, sim, f, kind);
    f->missing = f->fluid - mps_particles_count(sim, MPS_FLUID) - f->info.lost;
    f->volume_error = energy.volume_error;
    if (fabs(energy.volume_error) > fabs(f->volume_worst)) f->volume_worst = energy.volume_error;
}

/* The most severe first; particles that leave an open tank are no error. */
static const char *verdict(const options *o, const findings *f)
{
    double fall = 0;
    for (int d = 0; d < o->what.dim; d++) fall += f->built[d] * f->built[d];
    if (f->status < 0) return mps_status_name(f->status);
    if (f->bad) return "nan";
    if (f->missing) return "silent_loss";
    if (stop_asked) return "stopped";
    if (f->info.lost && !o->what.open_top) return "lost";
    if (f->outside > LEAK && !o->what.open_top) return "leak";
    if (f->max_speed > TOO_FAST * (f->tank_speed + sqrt(2 * 9.81 * sqrt(fall)))) return "too_fast";
    if (!(fabs(f->volume_error) < TOO_DENSE)) return "volume";
    return NULL;
}

/* ---- models ---------------------------------------------------------------------------------- */

/* "slot.key=number" */
static mps_status set_model(mps_sim *sim, const char *text)
{
    char slot[96];
    const char *equals = strchr(text, '=');
    snprintf(slot, sizeof slot, "%.*s", equals ? (int)(equals - text) : 0, text);
    char *key = strrchr(slot, '.'), *end;
    const double value = equals ? strtod(equals + 1, &end) : 0;
    if (!key || end == equals + 1 || *end) return MPS_E_ARG;
    *key++ = '\0';
    return mps_model_set(sim, slot, key, value);
}

/* In the order of the command line. */
static mps_status change_models(const options *o, mps_sim *sim)
{
    mps_status status = MPS_OK;
    for (int k = 0; k < o->changes && status == MPS_OK; k++) {
        const change *c = &o->change[k];
        status = c->what == 'u'   ? mps_model_use(sim, c->text)
                 : c->what == 'r' ? mps_model_remove(sim, c->text)
                                  : set_model(sim, c->text);
        if (status != MPS_OK)
            fprintf(stderr, "sweep: cannot apply '%s': %s\n", c->text, mps_sim_error(sim));
    }
    return status;
}

/* ---- the run --------------------------------------------------------------------------------- */

static void take_picture(const options *o, mps_sim *sim, int number)
{
    char path[PATH_SIZE], error[400];
    mps_picture_config config;
    if (!o->pictures) return;
    if (number >= 0)
        snprintf(path, sizeof path, "%s_%03d.png", o->pictures, number);
    else
        snprintf(path, sizeof path, "%s_end.png", o->pictures);
    mps_picture_config_init(&config, sizeof config);
    config.error = error;
    config.error_size = sizeof error;
    if (mps_picture_save(sim, &config, path) != MPS_OK) fprintf(stderr, "%s\n", error);
}

static void step(const options *o, mps_sim *sim, findings *f)
{
    mps_step_info info;
    mps_step_info_init(&info, sizeof info);
    f->status = mps_step(sim, fmax(o->t_end - f->info.t, 1e-12), &info);
    if (f->status < 0) return;
    f->info = info;
    f->not_converged += f->status == MPS_W_NOT_CONVERGED;
    f->max_speed = fmax(f->max_speed, info.max_speed);
    if (info.t < o->t_end) f->min_dt = fmin(f->min_dt, info.dt); /* the last one is cut */
}

static void run(const options *o, mps_sim *sim, findings *f)
{
    int pictures = 0;
    f->fluid = mps_particles_count(sim, MPS_FLUID);
    while (f->info.t < o->t_end * (1 - 1e-12) && f->status >= 0 && !stop_asked && !f->bad) {
        if (mps_particles_count(sim, MPS_FLUID) == 0) break; /* an open tank may lose all */
        if (o->every > 0 && f->info.t >= pictures * o->every) take_picture(o, sim, pictures++);
        step(o, sim, f);
        if (f->info.step % CHECK_EVERY == 0 || f->status < 0) check(o, sim, f);
    }
    check(o, sim, f);
    take_picture(o, sim, -1);
}

static void report(const options *o, const findings *f, const char *error)
{
    scenario_print(&o->what, stdout);
    printf(" fluid=%lld result=%s t=%.4g steps=%lld lost=%lld outside=%.2f volume=%.4f "
           "volume_worst=%.4f max_speed=%.3g tank_speed=%.3g "
           "min_dt=%.2e loose=%lld cpu=%.1f",
           (long long)f->fluid, f->wrong ? f->wrong : "ok", f->info.t, (long long)f->info.step,
           (long long)f->info.lost, f->outside, f->volume_error, f->volume_worst, f->max_speed,
           f->tank_speed, f->min_dt, (long long)f->not_converged, (double)clock() / CLOCKS_PER_SEC);
    if (f->status < 0) printf(" error=%s", error); /* the last: it has blanks */
    printf("\n");
}

/* ---- command line ---------------------------------------------------------------------------- */

static int usage(const char *what)
{
    fprintf(stderr,
            "sweep: %s\nusage: sweep --seed N [--dim 2|3] [--refine X] [--t-end S] [--model NAME] "
            "[--pictures PATH [--every S]]\n"
            "  [--use SLOT.VARIANT] [--remove SLOT] [--set SLOT.KEY=X]\n"
            "--refine: the spacing drawn, over X; --pictures: PATH_end.png, and PATH_000.png ... "
            "every S seconds\n",
            what);
    return 2;
}

static int parse_number(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && !*end && isfinite(*value) && *value > 0;
}

static int parse_seed(const char *text, uint64_t *seed)
{
    char *end;
    errno = 0;
    *seed = strtoull(text, &end, 10);
    return *text >= '0' && *text <= '9' && !*end && !errno;
}

/* --use, --remove and --set may be repeated. */
static int parse_change(options *o, const char *name, const char *value)
{
    if (o->changes == CHANGES || !*value) return 0;
    o->change[o->changes++] = (change){name[2], value};
    return 1;
}

/* @return NULL, or what is wrong */
static const char *parse(options *o, int argc, char **argv)
{
    uint64_t seed = 0;
    double dim = 0;
    int good = 1, seeded = 0;
    for (int k = 1; k < argc && good; k += 2) {
        const char *name = argv[k], *value = k + 1 < argc ? argv[k + 1] : "";
        if (!strcmp(name, "--seed"))
            good = seeded = parse_seed(value, &seed);
        else if (!strcmp(name, "--dim"))
            good = parse_number(value, &dim) && (dim == 2 || dim == 3);
        else if (!strcmp(name, "--refine"))
            good = parse_number(value, &o->refine);
        else if (!strcmp(name, "--t-end"))
            good = parse_number(value, &o->t_end);
        else if (!strcmp(name, "--every"))
            good = parse_number(value, &o->every);
        else if (!strcmp(name, "--model"))
            good = *(o->model = value) != 0;
        else if (!strcmp(name, "--pictures"))
            good = *(o->pictures = value) != 0;
        else if (!strcmp(name, "--use") || !strcmp(name, "--remove") || !strcmp(name, "--set"))
            good = parse_change(o, name, value);
        else
            return "unknown option";
    }
    if (good && seeded) scenario_draw(&o->what, seed, (int32_t)dim);
    o->what.dp /= o->refine;
    return !good ? "a value is missing or bad" : seeded ? NULL : "--seed is needed";
}

int main(int argc, char **argv)
{
    options o = {.model = "imps", .t_end = 5, .refine = 1};
    findings f = {.outside = -INFINITY, .min_dt = INFINITY};
    mps_sim *sim = NULL;
    const char *problem = parse(&o, argc, argv);
    if (problem) return usage(problem);
    signal(SIGTERM, ask_stop);
    f.status = scenario_build(&o.what, o.model, &sim, f.built);
    if (f.status >= 0) f.status = change_models(&o, sim);
    if (f.status >= 0) run(&o, sim, &f);
    f.wrong = verdict(&o, &f);
    report(&o, &f, sim ? mps_sim_error(sim) : "no handle");
    mps_sim_destroy(sim);
    return f.wrong != NULL;
}
