/* SPDX-License-Identifier: BSD-3-Clause */
/* Trapped gas: a void enclosed by liquid has the pressure of the gas in it,
 *
 *   p = P [(V0/V)^e - 1],   dV/dt = integral of u.n over the surface of the liquid,
 *
 * P the ambient pressure, V0 the volume of the gas at that pressure, u relative to the tank. Voids
 * are the components of mps_stage_voids(). Splitting, merging and opening of pockets:
 * gas_pocket_follow.c. Volumes, films and faces: gas_pocket_faces.c.
 *
 * Pressures. Surface particles are rows with the pressure of the gas in front of them; a particle
 * without own face has the mean of its neighbours. Walls in a pocket have its pressure, which also
 * increases the lower bound of walls beside it. In a film of one layer the moment matrix M has no
 * inverse along the normal: the part of the gradient G that B M lacks is added, a_i -= (1 - B
 * M)(G/rho - b), b = g - a_tank as in mps/flux.h. */
#include "gas_pocket.h"

static const mps_setting settings[] = {
    [MPS__POCKET_AMBIENT] = {"ambient", "Pa", "Pressure of the ambient gas", MPS_TYPE_REAL,
                             101325.0, 1.0, 1e9},
    [MPS__POCKET_EXPONENT] = {"exponent", "-", "Exponent of the gas law; 1.4: air, 1: isothermal",
                              MPS_TYPE_REAL, 1.4, 1.0, 10.0},
    [MPS__POCKET_LEAST] = {"least", "dp", "Side of the smallest square or cube of gas that closes",
                           MPS_TYPE_REAL, 4.0, 2.0, 100.0},
    [MPS__POCKET_ULLAGE] = {"ullage", "m3",
                            "Volume of all gas in a closed tank, m2 in 2-D; 0: the tank is vented",
                            MPS_TYPE_REAL, 0.0, 0.0, 1e9}};
enum { SETTINGS = sizeof settings / sizeof *settings };

static const mps_channel channels[] = {
    {.name = "pocket_pressure",
     .unit = "Pa",
     .help = "Pressure of the gas before a particle; its faces; 1: in a film between two voids",
     .components = MPS__POCKET_ROW,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_STEP},
    {.name = "pocket_slope",
     .unit = "Pa/m",
     .help = "Pressure gradient in a film between two voids",
     .components = MPS_VECTOR,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_STEP},
    {.name = "pocket",
     .unit = "-",
     .help = "Number of the pocket of gas that a particle borders, from 1 in the order of closing; "
             "0: none",
     .components = 1,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_PARTICLE}};
enum { CHANNELS = sizeof channels / sizeof *channels };

/* Relaxation time of volumes, in dp/U_g. */
static const double RELAXATION = 20;

/* ---- steps ---- */

/* Whether there is no pocket: pressures and slopes of the step are then 0. */
static bool is_idle(const mps_stage *s)
{
    const mps__pocket_old old = mps__pocket_read(s);
    return !old.head || old.head->pockets == 0;
}

static int limit_step(mps_stage *s)
{
    const mps__pocket_old old = mps__pocket_read(s);
    const int32_t pockets = old.head ? (int32_t)old.head->pockets : 0;
    for (int32_t k = 0; k < pockets; k++)
        if (old.pocket[k].rate > 0) s->dt_limit = mps_smaller(s->dt_limit, 1 / old.pocket[k].rate);
    return 0;
}

/* ---- pockets ---- */

enum { FIND_VELOCITY, FIND_REGION, FIND_ROW, FIND_SLOPE, FIND_NUMBER, FIND_USES };
static const mps_use find_uses[FIND_USES] = {[FIND_VELOCITY] = {"velocity", MPS_USE_READ},
                                             [FIND_REGION] = {"region", MPS_USE_NEIGHBOURS},
                                             [FIND_ROW] = {"pocket_pressure", MPS_USE_WRITE},
                                             [FIND_SLOPE] = {"pocket_slope", MPS_USE_WRITE},
                                             [FIND_NUMBER] = {"pocket", MPS_USE_CHANGE}};

/* Ambient gas of a closed tank: amount, volume. */
static void sum_ullage(const double *setting, const mps__pocket *pocket, int32_t count, double *gas,
                       double *volume)
{
    *gas = *volume = setting[MPS__POCKET_ULLAGE];
    for (int32_t k = 0; k < count; k++) {
        *gas -= pocket[k].gas;
        *volume -= pocket[k].volume;
    }
}

static double ambient_pressure(const double *setting, const mps__pocket *pocket, int32_t count)
{
    double gas, volume;
    sum_ullage(setting, pocket, count, &gas, &volume);
    return gas != volume ? mps__pocket_pressure(setting, gas, volume) : 0;
}

/* Pressures and frequencies of the pockets. pressure: [count] out, by component
 *
 * Steps. The inertia of a pocket is at least that of one layer of its surface, so that its natural
 * frequency is at most omega^2 = e (P + p) S/(V rho dp), S its surface; dt <= 1/omega. */
static void find_pressures(mps_stage *s, const mps__pocket_faces *f, const mps__pocket_now *now,
                           mps__pocket_head *head, double *pressure)
{
    const double *k = s->view->setting, dp = s->view->dp;
    const mps_voids *v = &f->voids;
    double rho[2], *area = pressure + v->count;
    mps__density_range(s, rho);
    mps__pocket_areas(f, area);
    for (int32_t c = 0; c < v->count; c++) {
        mps__pocket *q = &now->pocket[c];
        if (!(q->gas > 0)) continue;
        const double stiff = k[MPS__POCKET_EXPONENT] *
                             (k[MPS__POCKET_AMBIENT] + mps__pocket_pressure(k, q->gas, q->volume));
        const double size = 2 * v->size[c] / now->least - 1;
        q->rate = sqrt(mps_larger(0, stiff * area[c] / (q->volume * rho[0] * dp)));
        q->pressure = mps__pocket_pressure(k, q->gas, q->volume) *
                      mps_smaller(1, mps_larger(0, size));
        pressure[c] = q->pressure;
    }
    head->ambient = pressure[now->open] = ambient_pressure(k, now->pocket, v->count);
}

/* Gas of the components of this step, and their volumes. */
static int follow(mps_stage *s, const mps__pocket_faces *f, mps__pocket_now *now, double *geometry,
                  mps__pocket_head *head)
{
    const mps_voids *v = &f->voids;
    mps__pocket_old old = mps__pocket_read(s);
    if (old.head) *head = *old.head;
    for (int d = 0; d < 3; d++)
        if (old.head && old.head->cells[d] != v->cells[d]) old.head = NULL;
    const int32_t pockets = old.head ? (int32_t)old.head->pockets : 0;
    const double *k = s->view->setting, relax = RELAXATION * s->view->dp / s->view->velocity_scale;
    const double dt = head->dt,
                 least = mps__pocket_power(k[MPS__POCKET_LEAST] * s->view->dp, v->dim);
    now->pocket = (mps__pocket *)(void *)mps_stage_scratch(
        s, (int64_t)v->count * (int64_t)(sizeof *now->pocket / sizeof(double)));
    now->overlap = mps_stage_scratch_integers(s, (int64_t)v->count * (2 + pockets));
    if (!now->pocket || !now->overlap) return 1;
    now->geometry = geometry;
    now->least = least / mps__pocket_power(v->side, v->dim);
    now->t = s->view->t;
    now->ambient = 1;
    if (pockets > 0) {
        const double p = ambient_pressure(k, old.pocket, pockets);
        now->ambient = mps_pow(1 + p / k[MPS__POCKET_AMBIENT], 1 / k[MPS__POCKET_EXPONENT]);
    }
    mps__pocket_follow(v, &old, now, head);
    head->work = 0;
    for (int32_t c = 0; c < v->count; c++) {
        mps__pocket *q = &now->pocket[c];
        if (!(q->gas > 0)) continue;
        q->volume += mps_smaller(1, dt / relax) * (geometry[c] - q->volume);
    }
    return 0;
}

static int find_pockets(mps_stage *s)
{
    mps__pocket_head head = {0};
    mps__pocket_now now = {0};
    mps__pocket_faces f = {0};
    bool waits, any = false, had = !is_idle(s);
    if (mps__pocket_wait(s, s->data[FIND_VELOCITY], s->data[FIND_REGION], &waits)) return 1;
    if (waits) return 0;
    if (mps__pocket_look(s, &f)) return 1;
    f.region = s->data[FIND_REGION];
    f.row = s->data[FIND_ROW];
    f.slope = s->data[FIND_SLOPE];
    f.number = s->data[FIND_NUMBER];
    double *geometry = mps_stage_scratch(s, f.voids.count + 1);
    double *pressure = mps_stage_scratch(s, 2 * (int64_t)f.voids.count + 1);
    if (!geometry || !pressure) return 1;
    if (f.voids.count > 1) {
        if (mps__pocket_sort(s, &f)) return 1;
        mps__pocket_volumes(s, &f, geometry);
    }
    if (follow(s, &f, &now, geometry, &head)) return 1;
    if (f.voids.count > 1) {
        find_pressures(s, &f, &now, &head, pressure);
        for (int32_t c = 0; c < f.voids.count; c++) any = any || now.pocket[c].gas > 0;
        f.pressure = pressure;
        f.pocket = now.pocket;
        if (any) mps__pocket_press(s, &f);
    }
    if (had && !any) mps__pocket_clear(s, &f);
    if (!any) head.flux = 0;
    return mps__pocket_write(s, &f.voids, &now, &head);
}

/* ---- pressures of rows ---- */

enum { SET_REGION, SET_ROW, SET_SLOPE, SET_CONDITION, SET_VALUE, SET_USES };
static const mps_use set_uses[SET_USES] = {[SET_REGION] = {"region", MPS_USE_NEIGHBOURS},
                                           [SET_ROW] = {"pocket_pressure", MPS_USE_NEIGHBOURS},
                                           [SET_SLOPE] = {"pocket_slope", MPS_USE_NEIGHBOURS},
                                           [SET_CONDITION] = {"pressure_condition", MPS_USE_READ},
                                           [SET_VALUE] = {"pressure_value", MPS_USE_CHANGE}};

typedef struct fields {
    const int32_t *region, *condition;
    const double *row, *slope, *correction, *density, *tank;
    double *value, *acceleration, *wall_pressure;
} fields;

/* Mean over the neighbours on the surface with gas in front of them. */
MPS_ROW double beside(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    double sum = 0, weight = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(v, j) || mps_region_of(f->region, j) != MPS_REGION_SURFACE) continue;
        if (f->row[j * MPS__POCKET_ROW + MPS__ROW_WEIGHT] == 0) continue;
        const double w = mps_stencil_pair_dim(dim, t, i, p).w;
        sum += w * f->row[j * MPS__POCKET_ROW];
        weight += w;
    }
    return weight > 0 ? sum / weight : 0;
}

/* Lower bound of the pressure of a film beside a wall at the wall: that of its surface particles,
 * extrapolated with the gradient of the film. */
MPS_ROW double film_pressure(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    double least = INFINITY;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        const double *row = f->row + j * MPS__POCKET_ROW;
        if (!mps_is_fluid(v, j) || mps_region_of(f->region, j) != MPS_REGION_SURFACE) continue;
        if (row[MPS__ROW_FILM] == 0) continue;
        double here = row[MPS__ROW_PRESSURE];
        for (int d = 0; d < dim; d++)
            here += f->slope[j * dim + d] * (v->x[i * dim + d] - v->x[j * dim + d]);
        least = mps_smaller(least, here);
    }
    return least;
}

MPS_ROW void set_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const bool own = f->row[i * MPS__POCKET_ROW + MPS__ROW_WEIGHT] > 0;
    if (mps_is_fluid(v, i) && mps_region_of(f->region, i) == MPS_REGION_SURFACE)
        f->value[i] += own ? f->row[i * MPS__POCKET_ROW] : beside(dim, v, f, i);
    else if (mps_is_wall(v, i) && f->condition[i] == MPS_ROW_LEAST && own)
        f->value[i] = mps_smaller(f->value[i] + f->row[i * MPS__POCKET_ROW],
                                  film_pressure(dim, v, f, i));
}
MPS_ROWS(set_rows, set_row, fields)

static int set_pressures(mps_stage *s)
{
    if (is_idle(s)) return 0;
    fields f = {.region = s->data[SET_REGION],
                .row = s->data[SET_ROW],
                .slope = s->data[SET_SLOPE],
                .condition = s->data[SET_CONDITION],
                .value = s->data[SET_VALUE]};
    mps_stage_rows(s, &set_rows, &f);
    return 0;
}

/* ---- films ---- */

enum {
    FILM_REGION,
    FILM_DENSITY,
    FILM_ROW,
    FILM_SLOPE,
    FILM_CORRECTION,
    FILM_TANK,
    FILM_ACCELERATION,
    FILM_USES
};
static const mps_use film_uses[FILM_USES] = {
    [FILM_REGION] = {"region", MPS_USE_NEIGHBOURS},
    [FILM_DENSITY] = {"density", MPS_USE_READ},
    [FILM_ROW] = {"pocket_pressure", MPS_USE_READ},
    [FILM_SLOPE] = {"pocket_slope", MPS_USE_READ},
    [FILM_CORRECTION] = {"correction", MPS_USE_READ},
    [FILM_TANK] = {"tank_acceleration", MPS_USE_READ},
    [FILM_ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

/* (1 - B M)(G/rho - b) */
MPS_ROW void push_film(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    const double *b = f->correction + i * dim * dim;
    double slope[3] = {0}, seen[3] = {0};
    if (!mps_is_fluid(v, i) || f->row[i * MPS__POCKET_ROW + MPS__ROW_FILM] == 0) return;
    if (mps_region_of(f->region, i) == MPS_REGION_SPRAY) return;
    for (int d = 0; d < dim; d++)
        slope[d] = f->slope[i * dim + d] / f->density[i] -
                   (v->flux.body ? v->g[d] - f->tank[i * dim + d] : 0);
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (mps_region_of(f->region, mps_stencil_column(t, p)) >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double rise = 0;
        for (int d = 0; d < dim; d++) rise += slope[d] * q.d[d];
        for (int d = 0; d < dim; d++) seen[d] += dim / t->n0 * q.w_r2 * rise * q.d[d];
    }
    for (int d = 0; d < dim; d++) {
        double rest = slope[d];
        for (int e = 0; e < dim; e++) rest -= b[d * dim + e] * seen[e];
        f->acceleration[i * dim + d] -= rest;
    }
}
MPS_ROWS(push_film_rows, push_film, fields)

static int push_films(mps_stage *s)
{
    if (is_idle(s)) return 0;
    fields f = {.region = s->data[FILM_REGION],
                .density = s->data[FILM_DENSITY],
                .row = s->data[FILM_ROW],
                .slope = s->data[FILM_SLOPE],
                .correction = s->data[FILM_CORRECTION],
                .tank = s->data[FILM_TANK],
                .acceleration = s->data[FILM_ACCELERATION]};
    mps_stage_rows(s, &push_film_rows, &f);
    return 0;
}

/* ---- walls ---- */

enum { LOAD_REGION, LOAD_ROW, LOAD_WALL, LOAD_USES };
static const mps_use load_uses[LOAD_USES] = {[LOAD_REGION] = {"region", MPS_USE_READ},
                                             [LOAD_ROW] = {"pocket_pressure", MPS_USE_READ},
                                             [LOAD_WALL] = {"wall_pressure", MPS_USE_CHANGE}};

MPS_ROW void load_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (!mps_is_wall(v, i) || mps_region_of(f->region, i) != MPS_REGION_DRY) return;
    if (f->row[i * MPS__POCKET_ROW + MPS__ROW_WEIGHT] > 0)
        f->wall_pressure[i] += f->row[i * MPS__POCKET_ROW];
}
MPS_ROWS(load_rows, load_row, fields)

static int load_walls(mps_stage *s)
{
    if (is_idle(s)) return 0;
    fields f = {.region = s->data[LOAD_REGION],
                .row = s->data[LOAD_ROW],
                .wall_pressure = s->data[LOAD_WALL]};
    mps_stage_rows(s, &load_rows, &f);
    return 0;
}

/* ---- volumes after the step ---- */

enum { BOOK_VELOCITY, BOOK_REGION, BOOK_CORRECTION, BOOK_USES };
static const mps_use book_uses[BOOK_USES] = {
    [BOOK_VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS},
    [BOOK_REGION] = {"region", MPS_USE_NEIGHBOURS},
    [BOOK_CORRECTION] = {"correction", MPS_USE_NEIGHBOURS}};

/* New volumes by the flux. The works of all forces add up to the change of kinetic energy if each
 * uses the mean of the velocities before and after the step. So the work of the gas is p dt times
 * the mean of the fluxes, and the liquid gains what the gas loses.
 *
 * Volume. The sum over faces of a raster is exact neither for volume nor for flux. The flux is more
 * accurate over the time of an impact, the volume over longer times: V relaxes to the latter over
 * 20 dp/U_g, as the volume deviation of the liquid does. Both agree where the surface only moves,
 * so that a static compression is kept. */
static int add_fluxes(mps_stage *s, mps__pocket_head *head, mps__pocket *pocket)
{
    mps__pocket_faces f = {0};
    if (mps__pocket_look(s, &f)) return 1;
    f.region = s->data[BOOK_REGION];
    f.velocity = s->data[BOOK_VELOCITY];
    f.correction = s->data[BOOK_CORRECTION];
    /* the ambient does no work */
    f.aside = s->view->setting[MPS__POCKET_ULLAGE] > 0 ? -1 : (int32_t)head->open;
    double *flux = mps_stage_scratch(s, f.voids.count + 1);
    double *fluid = mps_stage_scratch(s, f.voids.count + 1);
    if (!flux || !fluid || mps__pocket_sort(s, &f)) return 1;
    mps__pocket_fluxes(s, &f, flux, fluid);
    const double half = 0.5 * s->view->dt, open = fluid[(int32_t)head->open];
    head->work = half * head->ambient * (head->flux + open);
    head->flux = open;
    for (int32_t k = 0; k < (int32_t)head->pockets; k++) {
        const int32_t place = (int32_t)pocket[k].place;
        pocket[k].volume += s->view->dt * flux[place];
        head->work += half * pocket[k].pressure * (pocket[k].flux + fluid[place]);
        pocket[k].flux = fluid[place];
    }
    return 0;
}

static int book_gas(mps_stage *s)
{
    double volume = 0, most = 0;
    mps__pocket *pocket = NULL;
    if (is_idle(s)) return mps_stage_gas(s, 0, 0, 0, 0);
    mps__pocket_head *head = mps__pocket_open(s, &pocket);
    if (!head) return 1;
    if (add_fluxes(s, head, pocket)) return 1;
    for (int32_t k = 0; k < (int32_t)head->pockets; k++) {
        volume += pocket[k].volume;
        if (fabs(pocket[k].pressure) > fabs(most)) most = pocket[k].pressure;
    }
    return mps_stage_gas(s, (int32_t)head->pockets, volume, most, head->work);
}

static double reach(const double *setting, double dp)
{
    (void)setting;
    return 2.2 * dp;
}

static const mps_verb verbs[] = {
    {.hook = MPS_LIMIT, .run = limit_step, .device = 1},
    {.hook = MPS_PREPARE,
     .use_count = FIND_USES,
     .uses = find_uses,
     .run = find_pockets,
     .device = 1},
    {.hook = MPS_SOURCE,
     .use_count = SET_USES,
     .uses = set_uses,
     .after = "separation",
     .run = set_pressures,
     .device = 1},
    {.hook = MPS_GRADIENT,
     .use_count = FILM_USES,
     .uses = film_uses,
     .after = "gradient",
     .run = push_films,
     .device = 1},
    {.hook = MPS_LOAD,
     .use_count = LOAD_USES,
     .uses = load_uses,
     .after = "load",
     .run = load_walls,
     .device = 1},
    {.hook = MPS_SHIFT, .use_count = BOOK_USES, .uses = book_uses, .run = book_gas, .device = 1}};

const mps_model_ops mps__gas_pocket = {.struct_size = sizeof(mps_model_ops),
                                       .api = MPS_MODEL_API,
                                       .name = "gas.pocket",
                                       .help = "Gas in voids that the liquid encloses",
                                       .setting_count = SETTINGS,
                                       .settings = settings,
                                       .channel_count = CHANNELS,
                                       .channels = channels,
                                       .verb_count = sizeof verbs / sizeof *verbs,
                                       .verbs = verbs,
                                       .reach = reach,
                                       .check = mps__pocket_check};
