/* SPDX-License-Identifier: BSD-3-Clause */
/* The list of channels and their arrays. */
#include "channels.h"
#include <math.h>
#include <string.h>

/* Bits of hooks. */
enum {
    ALL = (1 << MPS_HOOK_COUNT) - 1,
    BROUGHT = ALL & ~(1 << MPS_POPULATE | 1 << MPS_LIMIT),
    STEP = BROUGHT & ~(1 << MPS_MOTION),
    MOTION = 1 << MPS_MOTION,
    SORTING = 1 << MPS_CLASSIFY | 1 << MPS_PREPARE,
    SOURCE = 1 << MPS_SOURCE,
    LEVEL = 1 << MPS_LEVEL,
    PUSH = 1 << MPS_FORCE | 1 << MPS_GRADIENT,
    EQUATION = SORTING | 1 << MPS_FORCE | SOURCE,
    NEVER = 0,
    LOAD = 1 << MPS_LOAD,
    MOVE = 1 << MPS_VELOCITY | 1 << MPS_SHIFT,
    SHIFT = 1 << MPS_SHIFT
};

/* A channel of the library. */
typedef struct own_channel {
    const char *name, *unit, *help;
    int32_t components, type;
    uint32_t reads, writes;
    int32_t where;
} own_channel;

static const own_channel own[MPS__OWN_CHANNELS] = {
    [MPS__VELOCITY] = {"velocity", "m/s",
                       "Velocity; for solids that of the tank over this step; in MPS_SOURCE u*",
                       MPS_VECTOR, MPS_TYPE_REAL, ALL, MOVE, MPS__IN_FIELD},
    [MPS__PRESSURE] = {"pressure", "Pa", "Pressure; from MPS_LEVEL on the new one", 1,
                       MPS_TYPE_REAL, ALL, LEVEL, MPS__IN_FIELD},
    [MPS__DENSITY] = {"density", "kg/m3", "Density of the particle's phase", 1, MPS_TYPE_REAL, ALL,
                      NEVER, MPS__IN_FIELD},
    [MPS__NUMBER_DENSITY] = {"number_density", "-", "Sum of W over near pairs, W22 (7)", 1,
                             MPS_TYPE_REAL, ALL, SORTING, MPS__IN_FIELD},
    [MPS__REGION] = {"region", "-", "MPS_REGION_...; initially INNER, for dummies DRY", 1,
                     MPS_TYPE_INTEGER, STEP, 1 << MPS_CLASSIFY, MPS__IN_FIELD},
    [MPS__TANK_ACCELERATION] = {"tank_acceleration", "m/s2",
                                "Acceleration of the rigid tank at the particle over this step",
                                MPS_VECTOR, MPS_TYPE_REAL, STEP, SORTING, MPS__IN_ARENA},
    [MPS__VOLUME_DEVIATION] = {"volume_deviation", "-",
                               "Volume deviation, mps_op_volume_deviation() over far pairs", 1,
                               MPS_TYPE_REAL, STEP, SORTING, MPS__IN_ARENA},
    [MPS__ASYMMETRY] = {"asymmetry", "-",
                        "Asymmetry A over near pairs, points out of the fluid, W22 (11)",
                        MPS_VECTOR, MPS_TYPE_REAL, STEP, 0, MPS__IN_ARENA},
    [MPS__PRESSURE_DENSITY] = {"pressure_density", "kg/m3",
                               "Density in operators of the pressure; initially as density", 1,
                               MPS_TYPE_REAL, STEP, SORTING, MPS__IN_ARENA},
    [MPS__ACCELERATION] = {"acceleration", "m/s2",
                           "Sum of the accelerations of this hook; initially 0 in MPS_FORCE and "
                           "MPS_GRADIENT",
                           MPS_VECTOR, MPS_TYPE_REAL, PUSH | LOAD, PUSH, MPS__IN_ARENA},
    [MPS__DISPLACEMENT] = {"displacement", "m", "Displacement in addition to dt u; initially 0",
                           MPS_VECTOR, MPS_TYPE_REAL, SHIFT, SHIFT, MPS__IN_ARENA},
    [MPS__PRESSURE_SOURCE] = {"pressure_source", "1/s2",
                              "Right side of the pressure equation; initially 0", 1, MPS_TYPE_REAL,
                              SOURCE, SOURCE, MPS__IN_ARENA},
    [MPS__PRESSURE_SHIFT] = {"pressure_shift", "1/(Pa s2)", "Compressibility of a row, >= 0", 1,
                             MPS_TYPE_REAL, SOURCE, SOURCE, MPS__IN_ARENA},
    [MPS__PRESSURE_VALUE] = {"pressure_value", "Pa", "Given or least pressure of a row", 1,
                             MPS_TYPE_REAL, SOURCE | LOAD, SOURCE, MPS__IN_ARENA},
    [MPS__PRESSURE_CONDITION] = {"pressure_condition", "-", "Condition on a row, MPS_ROW_...", 1,
                                 MPS_TYPE_INTEGER, SOURCE | LOAD, SOURCE, MPS__IN_ARENA},
    [MPS__GAS_SHIFT] = {"gas_shift", "1/(Pa s2)", "Compressibility of a row of gas, >= 0", 1,
                        MPS_TYPE_REAL, SOURCE, SOURCE, MPS__IN_ARENA},
    [MPS__GAS_LAW] = {"gas_law", "Pa", "P of a nonlinear law of a gas; 0: linear", 1, MPS_TYPE_REAL,
                      SOURCE, SOURCE, MPS__IN_ARENA},
    [MPS__WALL_PRESSURE] = {"wall_pressure", "Pa",
                            "Pressure that probes and forces see; initially as pressure", 1,
                            MPS_TYPE_REAL, LOAD, LOAD, MPS__IN_ARENA},
    [MPS__SOLID_PLACE] = {"solid_place", "m",
                          "Place of a solid in the frame of the tank at the end of the step; "
                          "initially where it is",
                          MPS_VECTOR, MPS_TYPE_REAL, BROUGHT, MOTION, MPS__IN_FIELD},
    [MPS__SOLID_AREA] = {"solid_area", "m2",
                         "Area vector of a wall in the frame of the tank at the end of the step "
                         "[m^(dim-1)]; initially what it is",
                         MPS_VECTOR, MPS_TYPE_REAL, BROUGHT, MOTION, MPS__IN_FIELD},
    [MPS__EQUATION_RADIUS] = {"equation_radius", "-",
                              "Pairs of the Laplacian: MPS_NEAR or MPS_FAR; initially MPS_FAR",
                              MPS_SCALAR, MPS_TYPE_INTEGER, EQUATION, EQUATION, MPS__IN_FIELD},
    [MPS__EQUATION_COMPLETE] = {"equation_complete", "-",
                                "1: surface pairs carry the flux that the surface cuts off; "
                                "initially 0",
                                MPS_SCALAR, MPS_TYPE_INTEGER, EQUATION, EQUATION, MPS__IN_FIELD},
    [MPS__EQUATION_BODY] = {"equation_body", "-",
                            "1: pressures are those beyond a fluid that moves with the tank; "
                            "initially 0",
                            MPS_SCALAR, MPS_TYPE_INTEGER, EQUATION, EQUATION, MPS__IN_FIELD},
    [MPS__EQUATION_WALL_FACTOR] = {"equation_wall_factor", "-",
                                   "Weight of wall-wall pairs, >= 0; initially 0", MPS_SCALAR,
                                   MPS_TYPE_REAL, EQUATION, EQUATION, MPS__IN_FIELD},
    [MPS__EQUATION_GAIN] = {"equation_gain", "-",
                            "Share of the divergence that a step takes away, > 0, <= 1; initially "
                            "1",
                            MPS_SCALAR, MPS_TYPE_REAL, EQUATION, EQUATION, MPS__IN_FIELD},
    [MPS__POSITION] = {"position", "m", "Position", MPS_VECTOR, MPS_TYPE_REAL, NEVER, NEVER,
                       MPS__IN_FIELD},
    [MPS__POSITION_BEFORE] = {"position_before", "m", "Position at the beginning of the step",
                              MPS_VECTOR, MPS_TYPE_REAL, NEVER, NEVER, MPS__IN_ARENA},
    [MPS__UNKNOWN_NUMBERS] = {"unknown_numbers", "-", "Numbers of the unknowns, by row", 3,
                              MPS_TYPE_REAL, NEVER, NEVER, MPS__IN_ARENA},
    [MPS__UNKNOWN_PLACES] = {"unknown_places", "m", "Positions of the unknowns, by row", MPS_VECTOR,
                             MPS_TYPE_REAL, NEVER, NEVER, MPS__IN_ARENA},
};

static int32_t numbers(const mps__channels *c, int32_t components)
{
    if (components == MPS_VECTOR) return c->dim;
    if (components == MPS_SCALAR) return 0;
    return components == MPS_MATRIX ? c->dim * c->dim : components;
}

size_t mps__channel_element(const mps__channel *k)
{
    return (size_t)k->components *
           (k->spec.type == MPS_TYPE_INTEGER ? sizeof(int32_t) : sizeof(double));
}

void mps__channels_init(mps__channels *c, mps__context *context, int32_t dim)
{
    *c = (mps__channels){.context = context, .dim = dim, .count = MPS__OWN_CHANNELS};
    for (int32_t k = 0; k < MPS__OWN_CHANNELS; k++)
        c->list[k] = (mps__channel){.spec = {.name = own[k].name,
                                             .unit = own[k].unit,
                                             .help = own[k].help,
                                             .components = own[k].components,
                                             .type = own[k].type},
                                    .reads = own[k].reads,
                                    .writes = own[k].writes,
                                    .components = numbers(c, own[k].components),
                                    .where = own[k].where,
                                    .offset = -1};
}

void mps__channels_free(mps__channels *c)
{
    mps__free(c->context, c->arena);
    c->arena = NULL;
    c->held = 0;
    c->count = c->count < MPS__OWN_CHANNELS ? c->count : MPS__OWN_CHANNELS;
}

int32_t mps__channels_find(const mps__channels *c, const char *name)
{
    for (int32_t k = 0; k < c->count; k++)
        if (!(k >= MPS__PUBLIC_CHANNELS && k < MPS__OWN_CHANNELS) &&
            strcmp(c->list[k].spec.name, name) == 0)
            return k;
    return -1;
}

int32_t mps__channels_find_own(const char *name)
{
    int32_t k = MPS__OWN_CHANNELS - 1;
    while (k >= 0 && strcmp(own[k].name, name) != 0) k--;
    return k;
}

mps_status mps__channel_check(mps__context *c, const char *model, const mps_channel *s)
{
    MPS__CHECK(c, s->name && s->name[0] && strnlen(s->name, 32) < 32,
               "model '%s': a channel's name has 1..31 characters", model);
    MPS__CHECK(c, s->unit && s->help, "model '%s': channel '%s' has no unit or no help", model,
               s->name);
    MPS__CHECK(c,
               (s->components >= 1 && s->components <= 9) || s->components == MPS_VECTOR ||
                   s->components == MPS_MATRIX || s->components == MPS_SCALAR,
               "model '%s': channel '%s' has %d components: 1..9, MPS_VECTOR, MPS_MATRIX or "
               "MPS_SCALAR",
               model, s->name, (int)s->components);
    MPS__CHECK(c, s->components != MPS_SCALAR || s->life == MPS_LIFE_STEP,
               "model '%s': channel '%s' is a scalar: it must live for a step", model, s->name);
    MPS__CHECK(
        c, s->type == MPS_TYPE_REAL || (s->type == MPS_TYPE_INTEGER && s->life == MPS_LIFE_STEP),
        "model '%s': channel '%s' has type %d and life %d: real, or integer for a step", model,
        s->name, (int)s->type, (int)s->life);
    MPS__CHECK(c, s->life == MPS_LIFE_STEP || s->life == MPS_LIFE_PARTICLE,
               "model '%s': channel '%s' has life %d: MPS_LIFE_STEP or MPS_LIFE_PARTICLE", model,
               s->name, (int)s->life);
    MPS__CHECK(c, isfinite(s->initial), "model '%s': channel '%s' begins with %g: must be finite",
               model, s->name, s->initial);
    MPS__CHECK(
        c,
        s->type == MPS_TYPE_REAL ||
            (fabs(s->initial) <= INT32_MAX && s->initial == floor(s->initial)),
        "model '%s': channel '%s' of integers begins with %g: must be a whole number of 32 bits",
        model, s->name, s->initial);
    for (int32_t k = 0; k < MPS__PUBLIC_CHANNELS; k++)
        MPS__CHECK(c, strcmp(own[k].name, s->name) != 0,
                   "model '%s' brings channel '%s', which is the library's own", model, s->name);
    return MPS_OK;
}

static bool same_spec(const mps_channel *a, const mps_channel *b)
{
    return strcmp(a->unit, b->unit) == 0 && a->components == b->components && a->type == b->type &&
           a->life == b->life && a->initial == b->initial;
}

/* A channel with the lifetime of a particle is a field. An existing user field of this name is
 * used. */
static mps_status bring_field(mps__channels *c, mps__particles *s, const char *model,
                              const mps_channel *spec)
{
    const int32_t components = numbers(c, spec->components);
    mps__field *f = mps__particles_field(s, spec->name);
    if (f) {
        MPS__CHECK(
            c->context, f->is_public && f->data == &f->own && f->components == components,
            "model '%s' needs field '%s' of %d components, and there is another one of this name",
            model, spec->name, (int)components);
        return MPS_OK;
    }
    MPS__TRY(mps__particles_field_add(s, spec->name, components, sizeof(double), true, NULL));
    mps__particles_field_begin(s, spec->name, spec->initial);
    return MPS_OK;
}

static bool brings(const mps_model_ops *ops, const char *name)
{
    for (int32_t k = 0; ops && k < ops->channel_count; k++)
        if (strcmp(ops->channels[k].name, name) == 0) return true;
    return false;
}

/* `leaving`: NULL, or the model to be deactivated. A channel that only this model has, with another
 * description, coexists with the new one. */
static mps_status bring(mps__channels *c, mps__particles *s, const char *model,
                        const mps_channel *spec, const mps_model_ops *leaving)
{
    const int32_t k = mps__channels_find(c, spec->name);
    if (k >= 0 && !(!same_spec(&c->list[k].spec, spec) && c->list[k].users == 1 &&
                    brings(leaving, spec->name))) {
        MPS__CHECK(
            c->context, same_spec(&c->list[k].spec, spec),
            "model '%s' and another active one bring channel '%s', and describe it differently",
            model, spec->name);
        c->list[k].users++;
        return MPS_OK;
    }
    MPS__CHECK(c->context, c->count < MPS__CHANNELS,
               "channel '%s' of model '%s' is one too many: at most %d", spec->name, model,
               MPS__CHANNELS);
    mps__channel fresh = {.spec = *spec,
                          .reads = BROUGHT,
                          .writes = BROUGHT,
                          .components = numbers(c, spec->components),
                          .users = 1,
                          .where = MPS__IN_ARENA,
                          .offset = -1};
    if (spec->life == MPS_LIFE_PARTICLE) {
        MPS__TRY(bring_field(c, s, model, spec));
        fresh.reads = ALL;
        fresh.writes = ALL & ~(1 << MPS_POPULATE);
        fresh.where = MPS__IN_FIELD;
    } else {
        MPS__CHECK(c->context, !mps__particles_field(s, spec->name),
                   "model '%s' brings channel '%s', and a field has this name", model, spec->name);
    }
    c->list[c->count++] = fresh;
    return MPS_OK;
}

static void drop(mps__channels *c, int32_t k)
{
    if (k < MPS__OWN_CHANNELS || --c->list[k].users > 0) return;
    mps__array_release(&c->list[k].array);
    memmove(&c->list[k], &c->list[k + 1], (size_t)(c->count - k - 1) * sizeof c->list[0]);
    c->count--;
}

/* Index of the channel of this name that was added last. */
static int32_t find_last(const mps__channels *c, const char *name)
{
    int32_t k = c->count - 1;
    while (k >= 0 && strcmp(c->list[k].spec.name, name) != 0) k--;
    return k;
}

mps_status mps__channels_bring(mps__channels *c, mps__particles *s, const mps_model_ops *ops,
                               const mps_model_ops *leaving)
{
    const int32_t fields = s->fields;
    for (int32_t k = 0; k < ops->channel_count; k++) {
        const mps_status status = bring(c, s, ops->name, &ops->channels[k], leaving);
        if (status == MPS_OK) continue;
        while (k-- > 0) drop(c, find_last(c, ops->channels[k].name));
        while (s->fields > fields) mps__particles_field_drop(s);
        return status;
    }
    /* new particles get the first value, also in fields that already existed */
    for (int32_t k = 0; k < ops->channel_count; k++)
        if (ops->channels[k].life == MPS_LIFE_PARTICLE)
            mps__particles_field(s, ops->channels[k].name)->begin = ops->channels[k].initial;
    return MPS_OK;
}

void mps__channels_drop(mps__channels *c, const mps_model_ops *ops)
{
    for (int32_t k = 0; k < ops->channel_count; k++)
        drop(c, mps__channels_find(c, ops->channels[k].name));
}

/* Nothing in the arena outlives a step. An even number of particles keeps eight-byte numbers
 * aligned. */
mps_status mps__channels_reserve(mps__channels *c, int64_t n)
{
    const int64_t even = n + n % 2, had = c->stride > 0 ? (int64_t)c->held / c->stride : 0;
    if (even > had) {
        const int64_t wanted = mps__capacity_for(even, had) + 1;
        mps__free(c->context, c->arena);
        c->held = 0;
        c->arena = mps__alloc(c->context, wanted - wanted % 2, (size_t)c->stride);
        if (!c->arena) return MPS_E_NOMEM;
        c->held = (size_t)(wanted - wanted % 2) * (size_t)c->stride;
    }
    for (int32_t k = 0; k < c->count; k++) {
        mps__channel *own_array = &c->list[k];
        if (own_array->where != MPS__IN_ARENA) continue;
        own_array->array.host = own_array->offset < 0 ? NULL : c->arena + own_array->offset * even;
        if (mps__channel_is_scalar(own_array)) own_array->array.host = &own_array->scalar;
    }
    return MPS_OK;
}

/* Field of the solids' positions and areas; they have another array only in a step in which models
 * write them. */
static int32_t solid_field(int32_t channel)
{
    return channel == MPS__SOLID_PLACE ? MPS__FIELD_REF : MPS__FIELD_AREA;
}

mps__field *mps__channels_field(const mps__channels *c, mps__particles *s, int32_t k)
{
    if (k >= MPS__CHANNELS) return &s->field[k - MPS__CHANNELS];
    if (c->list[k].where != MPS__IN_FIELD || mps__channel_is_scalar(&c->list[k])) return NULL;
    if (k == MPS__SOLID_PLACE || k == MPS__SOLID_AREA)
        return c->list[k].array.host ? NULL : &s->field[solid_field(k)];
    mps__field *f = &s->field[c->list[k].field];
    return strcmp(f->name, c->list[k].spec.name) == 0
               ? f
               : mps__particles_field(s, c->list[k].spec.name);
}

void mps__channels_find_fields(mps__channels *c, mps__particles *s)
{
    for (int32_t k = 0; k < c->count; k++) {
        const mps__field *f = mps__channels_field(c, s, k);
        if (f) c->list[k].field = (int32_t)(f - s->field);
    }
}

mps__array *mps__channels_of(mps__channels *c, mps__particles *s, int32_t k)
{
    if (k < 0 || (k < MPS__CHANNELS && mps__channel_is_scalar(&c->list[k]))) return NULL;
    mps__field *f = mps__channels_field(c, s, k);
    return f ? mps__field_array(f) : &c->list[k].array;
}

size_t mps__channels_bytes(const mps__channels *c, const mps__particles *s, int32_t k)
{
    if (k < MPS__CHANNELS) return mps__channel_element(&c->list[k]);
    return mps__field_element(&s->field[k - MPS__CHANNELS]);
}

void *mps__channels_array(const mps__channels *c, mps__particles *s, int32_t k)
{
    if (k < 0) return NULL;
    const mps__field *f = mps__channels_field(c, s, k);
    return f ? *f->data : c->list[k].array.host;
}
