/* SPDX-License-Identifier: BSD-3-Clause */
/* The particle store: a table of arrays that grow, permute and shrink together. */
#include "particles.h"
#include "loop.h"
#include <mps/particles.h>
#include <string.h>

/* A field marked `trails` stays behind a new one. */
static void keep_last(mps__particles *s)
{
    if (s->fields < 2) return;
    mps__field *a = &s->field[s->fields - 2], *b = a + 1;
    if (!a->trails) return;
    const mps__field last = *a;
    *a = *b;
    *b = last;
    if (a->data == &b->own) a->data = &a->own;
    if (b->data == &a->own) b->data = &b->own;
}

mps_status mps__particles_field_add(mps__particles *s, const char *name, int32_t components,
                                    size_t size, bool is_public, void **data)
{
    MPS__CHECK(s->context, s->fields < MPS__FIELDS_MAX, "field \"%s\" is one too many: at most %d",
               name, MPS__FIELDS_MAX);
    mps__field *f = &s->field[s->fields];
    memset(f, 0, sizeof *f);
    MPS__CHECK(s->context, mps__name_copy(f->name, 32, name),
               "a field needs a name of 1..31 characters");
    f->components = components;
    f->size = size;
    f->is_public = is_public;
    f->data = data ? data : &f->own;
    *f->data = mps__alloc(s->context, s->capacity * components, size);
    if (!*f->data) return MPS_E_NOMEM;
    mps__array_written(mps__field_array(f), MPS__ON_HOST);
    s->fields++;
    keep_last(s);
    return MPS_OK;
}

mps_status mps__particles_init(mps__particles *s, mps__context *context, int32_t dim)
{
    *s = (mps__particles){.context = context, .dim = dim, .scratch = &s->own};
    const struct {
        const char *name;
        int32_t components;
        size_t size;
        bool is_public;
        void **data;
    } built_in[] = {
        {"position", dim, sizeof(double), true, (void **)&s->x},
        {"velocity", dim, sizeof(double), true, (void **)&s->u},
        {"pressure", 1, sizeof(double), true, (void **)&s->p},
        {"number_density", 1, sizeof(double), true, (void **)&s->nd},
        {"density", 1, sizeof(double), true, (void **)&s->rho},
        {"ref", dim, sizeof(double), false, (void **)&s->ref},
        {"area", dim, sizeof(double), false, (void **)&s->area},
        {"id", 1, sizeof(int64_t), false, (void **)&s->id},
        {"kind", 1, sizeof(int32_t), false, (void **)&s->kind},
        {"phase", 1, sizeof(int32_t), false, (void **)&s->phase},
        {"part", 1, sizeof(int32_t), false, (void **)&s->part},
        {"region", 1, sizeof(int32_t), false, (void **)&s->region},
        {"wall_of", 1, sizeof(int32_t), false, (void **)&s->wall_of},
        {"plate", 1, sizeof(int32_t), false, (void **)&s->plate},
        {"wall_pressure", 1, sizeof(double), true, (void **)&s->load},
        {"held", 1, sizeof(uint8_t), false, (void **)&s->active},
    };
    for (size_t k = 0; k < sizeof built_in / sizeof built_in[0]; k++)
        MPS__TRY(mps__particles_field_add(s, built_in[k].name, built_in[k].components,
                                          built_in[k].size, built_in[k].is_public,
                                          built_in[k].data));
    static const char *const tags[] = {"id", "kind", "phase", "part", "region", "plate"};
    for (size_t k = 0; k < sizeof tags / sizeof tags[0]; k++) {
        mps__field *f = mps__particles_field(s, tags[k]);
        if (f) f->is_tag = true;
    }
    return MPS_OK;
}

void mps__particles_free(mps__particles *s)
{
    for (int32_t k = 0; k < s->fields; k++) {
        mps__free(s->context, *s->field[k].data);
        mps__free(s->context, s->field[k].array.kept);
        *s->field[k].data = NULL;
    }
    mps__scratch_free(s->context, &s->own);
    s->fields = 0;
    s->n = s->capacity = 0;
}

void mps__particles_written(mps__particles *s)
{
    for (int32_t k = 0; k < s->fields; k++)
        mps__array_written(mps__field_array(&s->field[k]), MPS__ON_HOST);
}

/* Allocate new arrays for all fields, or none: the caller swaps them in. */
static mps_status new_arrays(mps__particles *s, int64_t capacity, void *array[MPS__FIELDS_MAX])
{
    for (int32_t k = 0; k < s->fields; k++) {
        array[k] = mps__alloc(s->context, capacity, mps__field_element(&s->field[k]));
        if (!array[k]) {
            while (k-- > 0) mps__free(s->context, array[k]);
            return MPS_E_NOMEM;
        }
    }
    return MPS_OK;
}

static void swap_arrays(mps__particles *s, int64_t capacity, void *array[MPS__FIELDS_MAX])
{
    for (int32_t k = 0; k < s->fields; k++) {
        mps__free(s->context, *s->field[k].data);
        *s->field[k].data = array[k];
    }
    s->capacity = capacity;
}

mps_status mps__particles_reserve(mps__particles *s, int64_t extra)
{
    int64_t wanted = s->n + extra;
    MPS__CHECK(s->context, wanted <= INT32_MAX, "%lld particles: at most %d", (long long)wanted,
               INT32_MAX);
    if (wanted <= s->capacity) return MPS_OK;
    const int64_t least = s->n + s->n / 4, capacity = wanted > least ? wanted : least;
    void *array[MPS__FIELDS_MAX];
    MPS__TRY(new_arrays(s, capacity, array));
    for (int32_t k = 0; k < s->fields; k++)
        if (s->n > 0)
            memcpy(array[k], *s->field[k].data, (size_t)s->n * mps__field_element(&s->field[k]));
    swap_arrays(s, capacity, array);
    return MPS_OK;
}

mps_status mps__particles_replace(mps__particles *s, int64_t n, const void *const from[])
{
    const int64_t capacity = n > 0 ? n : 1;
    void *array[MPS__FIELDS_MAX];
    MPS__TRY(new_arrays(s, capacity, array));
    for (int32_t k = 0; k < s->fields; k++)
        if (from[k]) memcpy(array[k], from[k], (size_t)n * mps__field_element(&s->field[k]));
    swap_arrays(s, capacity, array);
    s->n = n;
    s->generation++;
    mps__particles_written(s);
    s->solids++;
    return MPS_OK;
}

static void begin_field(const mps__field *f, int64_t first, int64_t count)
{
    double *values = *f->data;
    memset((char *)*f->data + (size_t)first * mps__field_element(f), 0,
           (size_t)count * mps__field_element(f));
    for (int64_t k = first * f->components; f->begin != 0 && k < (first + count) * f->components;
         k++)
        values[k] = f->begin;
}

void mps__particles_field_begin(mps__particles *s, const char *name, double value)
{
    mps__field *f = mps__particles_field(s, name);
    if (!f) return;
    f->begin = value;
    begin_field(f, 0, s->n);
}

void mps__particles_field_drop(mps__particles *s)
{
    mps__field *f = &s->field[--s->fields];
    mps__free(s->context, *f->data);
    mps__free(s->context, f->array.kept);
    mps__array_release(&f->array);
    *f->data = NULL;
}

int64_t mps__particles_append(mps__particles *s, int64_t count, int32_t kind)
{
    int64_t first = s->n;
    for (int32_t k = 0; k < s->fields; k++) begin_field(&s->field[k], first, count);
    for (int64_t i = first; i < first + count; i++) {
        s->id[i] = s->next_id++;
        s->kind[i] = kind;
        s->wall_of[i] = -1;
        if (s->wall_id) s->wall_id[i] = -1;
    }
    s->n += count;
    s->generation++;
    mps__particles_written(s);
    s->solids += kind != MPS_FLUID;
    return first;
}

/* Whether the order is the identity. */
static bool in_order(const mps__particles *s, int64_t count, const int32_t *order)
{
    if (count != s->n) return false;
    for (int64_t i = 0; i < count; i++)
        if (order[i] != i) return false;
    return true;
}

typedef struct permute_fields {
    char *to;
    const char *from;
    const int32_t *order;
    size_t bytes; /* of an element */
} permute_fields;

MPS_ROW void permute_row(const permute_fields *f, int64_t i, size_t bytes)
{
    memcpy(f->to + (size_t)i * bytes, f->from + (size_t)f->order[i] * bytes, bytes);
}

/* Permute elements. A copy of a constant size is inlined, of any other a call. */
#define PERMUTE(name, size)                                                    \
    MPS_ROW void name##_row(const int dim, const permute_fields *f, int64_t i) \
    {                                                                          \
        (void)dim;                                                             \
        permute_row(f, i, size);                                               \
    }                                                                          \
    MPS__LOOP(name, name##_row, permute_fields)
PERMUTE(permute_1, 1)
PERMUTE(permute_4, 4)
PERMUTE(permute_8, 8)
PERMUTE(permute_16, 16)
PERMUTE(permute_24, 24)
PERMUTE(permute_any, f->bytes)
#undef PERMUTE

static const mps__loop *permute_of(size_t bytes)
{
    return bytes == 1    ? &permute_1
           : bytes == 4  ? &permute_4
           : bytes == 8  ? &permute_8
           : bytes == 16 ? &permute_16
           : bytes == 24 ? &permute_24
                         : &permute_any;
}

void mps__particles_permute_values(const mps_parallel *p, void *to, const void *from, int64_t count,
                                   const int32_t *order, size_t bytes)
{
    mps__loop_run_cheap(p, permute_of(bytes), MPS__ANY_DIM, count,
                        &(permute_fields){to, from, order, bytes});
}

/* Permute one array by way of `scratch`, which is as large as the array. */
static void permute_field(mps__particles *s, const mps__field *f, int64_t count,
                          const int32_t *order, char *scratch)
{
    const size_t bytes = mps__field_element(f);
    mps__particles_permute_values(s->parallel, scratch, *f->data, count, order, bytes);
    mps__parallel_copy(s->parallel, *f->data, scratch, (size_t)count * bytes);
}

static int64_t count_solids(const mps__particles *s)
{
    int64_t count = 0;
    for (int64_t i = 0; i < s->n; i++) count += s->kind[i] != MPS_FLUID;
    return count;
}

/* Workspace for one array of n particles. */
static char *reserve_move(mps__particles *s, int64_t n)
{
    size_t largest = sizeof(int32_t);
    for (int32_t k = 0; k < s->fields; k++)
        if (mps__field_element(&s->field[k]) > largest) largest = mps__field_element(&s->field[k]);
    /* blocks 0 and 1 may contain the order */
    return mps__scratch_take(s->context, s->scratch, 2, n, largest);
}

mps_status mps__particles_permute_reserve(mps__particles *s, int64_t n)
{
    return reserve_move(s, n) ? MPS_OK : MPS_E_NOMEM;
}

mps_status mps__particles_permute(mps__particles *s, int64_t count, const int32_t *order)
{
    static const bool stale[MPS__FIELDS_MAX] = {false};
    return mps__particles_reorder(s, count, order, stale);
}

mps_status mps__particles_reorder(mps__particles *s, int64_t count, const int32_t *order,
                                  const bool *stale)
{
    if (in_order(s, count, order)) return MPS_OK;
    const int64_t solids = count != s->n ? count_solids(s) : 0;
    char *scratch = reserve_move(s, s->n);
    if (!scratch) return MPS_E_NOMEM;
    for (int32_t k = 0; k < s->fields; k++) {
        if (stale[k]) continue;
        permute_field(s, &s->field[k], count, order, scratch);
        mps__array_invalidate(mps__field_array(&s->field[k]), MPS__ON_DEVICE);
    }
    int32_t *place = (int32_t *)(void *)scratch; /* new index by old index */
    for (int64_t i = 0; i < s->n; i++) place[i] = -1;
    for (int64_t i = 0; i < count; i++) place[order[i]] = (int32_t)i;
    for (int64_t i = 0; i < count; i++)
        if (s->wall_of[i] >= 0) s->wall_of[i] = place[s->wall_of[i]];
    mps__array_written(mps__field_array(&s->field[MPS__FIELD_WALL_OF]), MPS__ON_HOST);
    const bool fewer = count != s->n;
    s->n = count;
    if (fewer) s->generation++;
    if (fewer) mps__particles_written(s);
    if (fewer && count_solids(s) != solids) s->solids++;
    return MPS_OK;
}

mps__field *mps__particles_field(mps__particles *s, const char *name)
{
    for (int32_t k = 0; name && k < s->fields; k++)
        if (strcmp(s->field[k].name, name) == 0) return &s->field[k];
    return NULL;
}

int32_t mps__part_number(mps__particles *s, const char *name, bool add)
{
    for (int32_t k = 0; name && k < s->parts; k++)
        if (strcmp(s->part_name[k], name) == 0) return k;
    if (!add || s->parts == MPS__PARTS_MAX ||
        !mps__name_copy(s->part_name[s->parts], MPS__PART_NAME, name))
        return -1;
    return s->parts++;
}

int32_t mps__particles_leases(const mps__particles *s)
{
    int32_t open = 0;
    for (int32_t k = 0; k < s->fields; k++) open += s->field[k].readers + s->field[k].writer;
    return open;
}
