/* SPDX-License-Identifier: BSD-3-Clause */
/* Plates whose layers are thinner than the spacing (layer.history): two plates far apart, all ends
 * of the liquid free. They start suddenly or oscillate. The momentum of the liquid is the time
 * integral of the drag; it is compared with the exact solution from rest at all times. */
#ifndef STOKES_PLATES_H
#define STOKES_PLATES_H

#include "../tags.h"
#include <math.h>
#include <mps/model.h>
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const double DP = 1, NU = 1, PI = 3.14159265358979;

#define OK(sim, call)                                               \
    do {                                                            \
        mps_status status_ = (call);                                \
        if (status_ < 0)                                            \
            fail_msg("%s: %s: %s", #call, mps_status_name(status_), \
                     (sim) ? mps_sim_error(sim) : "no handle");     \
    } while (0)

/* Plates of a velocity from t = 0 on (rate 0), or velocity sin(rate t). */
typedef struct plates {
    int dim, gap,
        length; /* gap: distance of the plates, length: of the liquid, in 3-D also its depth [dp] */
    double rate, t_end;
} plates;

/* Plates move by a hundredth of a spacing. */
static double speed_of(const plates *p)
{
    return 0.01 * DP / p->t_end;
}

/* Momentum of the liquid between both plates, over that of its moving with the plates; a mean over
 * the gap. */
static double exact(const plates *p, double t)
{
    enum { TERMS = 8000 };
    /* of the omitted terms, which follow the plates immediately */
    double sum = 4 / (PI * PI * TERMS) * (p->rate == 0 ? 1 : sin(p->rate * t));
    for (int n = 1; n < TERMS; n += 2) {
        const double k = n * PI / (p->gap * DP), l = NU * k * k, share = 8 / (n * PI * n * PI),
                     w = p->rate;
        const double decay = l * t < 700 ? exp(-l * t) : 0;
        if (w == 0)
            sum += share * (1 - decay);
        else
            sum += share * l * (l * sin(w * t) - w * cos(w * t) + w * decay) / (l * l + w * w);
    }
    return sum;
}

/* Velocity of the liquid without plates: in the frame of the plates. */
static double outer(const plates *p, double t)
{
    return p->rate == 0 ? speed_of(p) : speed_of(p) * sin(p->rate * t);
}

static int push(mps_stage *s)
{
    const mps_view *v = s->view;
    const plates *p = s->self;
    double *a = s->data[0];
    const double now = (outer(p, v->t + v->dt) - outer(p, v->t)) / v->dt;
    for (int64_t i = 0; i < v->n; i++)
        if (mps_is_fluid(v, i)) a[i * v->dim] += now;
    return 0;
}

static const mps_use push_uses[] = {{"acceleration", MPS_USE_CHANGE}};
static const mps_verb push_verbs[] = {
    {.hook = MPS_FORCE, .use_count = 1, .uses = push_uses, .run = push}};
static mps_model_ops pusher = {.struct_size = sizeof(mps_model_ops),
                               .api = MPS_MODEL_API,
                               .name = "push.test",
                               .help = "moves the liquid",
                               .verb_count = 1,
                               .verbs = push_verbs};

/* All liquid has its first velocity. */
static void set_moving(mps_sim *sim, const plates *p)
{
    const int32_t *kind;
    mps_lease u = {.struct_size = sizeof u};
    OK(sim, tags_peek(sim, NULL, &kind, NULL, NULL));
    OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    for (int64_t i = 0; i < u.count; i++)
        if (kind[i] == MPS_FLUID) u.data[i * p->dim] = outer(p, 0);
    OK(sim, mps_lease_end(sim, &u));
}

static mps_sim *begin(plates *p, double dt, bool layers)
{
    const double size[3] = {p->length + 8, p->gap, p->length + 8}, lo[3] = {4, 0, 4},
                 hi[3] = {4 + p->length, p->gap, 4 + p->length};
    mps_config config;
    mps_phase liquid;
    mps_tank tank;
    mps_time_control control;
    mps_sim *sim = NULL;
    OK(sim, mps_config_init(&config, sizeof config));
    config.dim = p->dim;
    config.dp = DP;
    for (int d = 0; d < 3; d++) config.gravity[d] = 0;
    OK(sim, mps_sim_create(&config, &sim));
    OK(sim, mps_threads_set(sim, 1));
    OK(sim, mps_time_control_init(&control, sizeof control));
    control.dt = dt;
    OK(sim, mps_time_control_set(sim, &control));
    OK(sim, mps_phase_init(&liquid, sizeof liquid));
    liquid.density = 1;
    liquid.viscosity = NU;
    OK(sim, mps_phase_set(sim, 0, &liquid));
    OK(sim, mps_tank_init(&tank, sizeof tank));
    for (int d = 0; d < p->dim; d++) tank.size[d] = size[d] * DP;
    OK(sim, mps_tank_add(sim, &tank, NULL));
    OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    set_moving(sim, p);
    while (mps_model_name(sim, 0)) OK(sim, mps_model_remove(sim, mps_model_name(sim, 0)));
    OK(sim, mps_model_use(sim, "viscosity.laplacian"));
    pusher.user = p;
    OK(sim, mps_model_register(sim, &pusher));
    OK(sim, mps_model_use(sim, "push.test"));
    if (layers) OK(sim, mps_model_use(sim, "layer.history"));
    return sim;
}

/* Velocity deficit of the particles against `whole`, columns in the middle. At the ends, where
 * neighbours are missing, layers grow more slowly; this affects a distance sqrt(4 nu t). */
static double momentum(mps_sim *sim, const plates *p, double whole)
{
    const int32_t *kind = NULL;
    mps_lease x = {.struct_size = sizeof x}, u = {.struct_size = sizeof u};
    const int dim = p->dim;
    const double middle = 4 + 0.5 * p->length;
    double sum = 0, columns = 0;
    OK(sim, tags_peek(sim, NULL, &kind, NULL, NULL));
    OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &u));
    for (int64_t i = 0; i < x.count && kind; i++) {
        const double *at = x.data + i * dim;
        if (kind[i] != MPS_FLUID || fabs(at[0] - middle) > 1.2 ||
            (dim == 3 && fabs(at[2] - middle) > 1.2))
            continue;
        sum += whole - u.data[i * dim];
        columns += 1.0 / (p->gap - 1);
    }
    OK(sim, mps_lease_end(sim, &u));
    OK(sim, mps_lease_end(sim, &x));
    return sum / columns / p->gap;
}

/* Largest deviation from the exact momentum after `from`, over the largest one so far. */
static double run(plates *p, double dt, double from, bool layers)
{
    mps_sim *sim = begin(p, dt, layers);
    double worst = 0, most = 0;
    for (int n = 1; n * dt < p->t_end; n++) {
        OK(sim, mps_step(sim, 1, NULL));
        const double wanted = exact(p, n * dt);
        most = fmax(most, fabs(wanted));
        if (n * dt >= from)
            worst = fmax(worst, fabs(momentum(sim, p, outer(p, n * dt)) / speed_of(p) - wanted));
    }
    mps_sim_destroy(sim);
    return worst / most;
}

#endif
