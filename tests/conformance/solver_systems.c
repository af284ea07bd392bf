/* SPDX-License-Identifier: BSD-3-Clause */
/* Test systems, the counting allocator and the threads of the solver kit. */
#include "solver_kit.h"
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* ---- memory ---- */

static void *count_alloc(void *user, size_t size)
{
    kit_memory *m = user;
    m->count++;
    if (m->fail_at && m->count >= m->fail_at) return NULL;
    unsigned char *block = malloc(size ? size : 1);
    if (!block) return NULL;
    memset(block, 0xff, size); /* doubles start as NaN: a read before a write shows */
    m->live++;
    return block;
}

static void count_release(void *user, void *block)
{
    kit_memory *m = user;
    m->live--;
    free(block);
}

void kit_memory_init(kit_memory *memory)
{
    *memory = (kit_memory){.allocator = {count_alloc, count_release, memory}};
}

/* ---- systems ---- */

/* Uniform in -1..1; the same everywhere. */
static double noise(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 4503599627370496.0 - 1;
}

void kit_system_free(kit_system *s)
{
    if (!s) return;
    free(s->row);
    free(s->col);
    free(s->component);
    free(s->val);
    free(s->diagonal);
    free(s->rhs);
    free(s->shift);
    free(s->weight);
    free(s->x);
    free(s->exact);
    free(s);
}

static kit_system *new_system(int dim, int64_t n, int64_t entries)
{
    kit_system *s = calloc(1, sizeof *s);
    if (!s) return NULL;
    s->row = calloc((size_t)n + 1, sizeof *s->row);
    s->col = calloc((size_t)entries, sizeof *s->col);
    s->component = calloc((size_t)n, sizeof *s->component);
    s->val = calloc((size_t)entries, sizeof *s->val);
    s->diagonal = calloc((size_t)n, sizeof *s->diagonal);
    s->rhs = calloc((size_t)n, sizeof *s->rhs);
    s->shift = calloc((size_t)n, sizeof *s->shift);
    s->weight = calloc((size_t)n, sizeof *s->weight);
    s->x = calloc((size_t)(n * dim), sizeof *s->x);
    s->exact = calloc((size_t)n, sizeof *s->exact);
    s->problem = (mps_ppe_problem){.struct_size = sizeof s->problem,
                                   .dim = dim,
                                   .n = n,
                                   .row = s->row,
                                   .col = s->col,
                                   .val = s->val,
                                   .diagonal = s->diagonal,
                                   .rhs = s->rhs,
                                   .shift = s->shift,
                                   .weight = s->weight,
                                   .x = s->x,
                                   .dp = 0.01,
                                   .tolerance = 1e-10,
                                   .max_iterations = 5000};
    if (s->row && s->col && s->component && s->val && s->diagonal && s->rhs && s->shift &&
        s->weight && s->x && s->exact)
        return s;
    kit_system_free(s);
    return NULL;
}

/* rhs = A exact */
static void set_rhs(kit_system *s)
{
    for (int64_t i = 0; i < s->problem.n; i++) {
        s->rhs[i] = s->diagonal[i] * s->exact[i];
        for (int64_t k = s->row[i]; k < s->row[i + 1]; k++)
            s->rhs[i] += (double)s->val[k] * s->exact[s->col[k]];
    }
}

kit_system *kit_dense_system(int n, const double *a, const double *exact)
{
    kit_system *s = new_system(2, n, (int64_t)n * n);
    if (!s) return NULL;
    int64_t at = 0;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            s->shift[i] += a[i * n + j];
            if (i == j) s->diagonal[i] = a[i * n + j];
            if (a[i * n + j] == 0 || i == j) continue;
            s->col[at] = j;
            s->val[at++] = (float)a[i * n + j];
        }
        s->row[i + 1] = at;
        s->exact[i] = exact[i];
        s->weight[i] = 1;
        s->x[2 * i] = i * s->problem.dp;
    }
    set_rhs(s);
    return s;
}

/* Index of a lattice site, or -1 outside the box. */
static int64_t site(const kit_lattice *o, int box, int i, int j, int k)
{
    if (i < 0 || j < 0 || k < 0 || i >= o->nx || j >= o->ny || k >= o->nz) return -1;
    return (((int64_t)box * o->nz + k) * o->ny + j) * o->nx + i;
}

static void place(const kit_lattice *o, kit_system *s)
{
    uint64_t state = 42;
    for (int64_t n = 0; n < s->problem.n; n++) {
        int64_t c[3] = {n % o->nx, n / o->nx % o->ny, n / ((int64_t)o->nx * o->ny) % o->nz};
        int64_t box = n / ((int64_t)o->nx * o->ny * o->nz);
        for (int d = 0; d < o->dim; d++)
            s->x[n * o->dim + d] = s->problem.dp * ((double)c[d] + 0.15 * noise(&state));
        s->x[n * o->dim] += (double)box * s->problem.dp * (o->nx + 10);
    }
}

static double density(const kit_lattice *o, int64_t n)
{
    int64_t height = o->dim == 2 ? n / o->nx % o->ny : n / ((int64_t)o->nx * o->ny) % o->nz;
    return 2 * height >= (o->dim == 2 ? o->ny : o->nz) ? 1000 / o->contrast : 1000;
}

/* k_ij of two particles: weight of the kernel over the mean density; 0 beyond the radius. */
static double coupling(const kit_lattice *o, const kit_system *s, int64_t a, int64_t b)
{
    double r2 = 0, re = o->re * s->problem.dp;
    for (int d = 0; d < o->dim; d++) {
        double e = s->x[a * o->dim + d] - s->x[b * o->dim + d];
        r2 += e * e;
    }
    double r = sqrt(r2);
    double w = r < re ? re / (0.85 * r + 0.15 * re) - 1 : 0;
    return w * 2 / (density(o, a) + density(o, b)) / (re * re);
}

/* Row of one particle; columns ascend since the lattice is walked in its order. */
static void fill_row(const kit_lattice *o, kit_system *s, int64_t n)
{
    int reach = (int)o->re + 1, reach_z = o->dim == 3 ? reach : 0;
    int i = (int)(n % o->nx), j = (int)(n / o->nx % o->ny),
        k = (int)(n / ((int64_t)o->nx * o->ny) % o->nz);
    int box = (int)(n / ((int64_t)o->nx * o->ny * o->nz));
    int64_t at = s->row[n];
    double sum = 0;
    for (int dk = -reach_z; dk <= reach_z; dk++)
        for (int dj = -reach; dj <= reach; dj++)
            for (int di = -reach; di <= reach; di++) {
                int64_t m = site(o, box, i + di, j + dj, k + dk);
                const float c = m < 0 || m == n ? 0 : (float)coupling(o, s, n, m);
                if (c == 0) continue;
                s->col[at] = (int32_t)m;
                s->val[at++] = -c;
                sum += (double)c;
            }
    int height = o->dim == 2 ? o->ny - 1 - j : o->nz - 1 - k;
    if (box < o->open && height == 0)
        s->shift[n] = 0.5 * sum; /* neighbours on the free surface, p = 0 there */
    s->shift[n] += o->compressible * sum;
    s->diagonal[n] = s->shift[n] + sum;
    s->row[n + 1] = at;
}

/* A smooth pressure with some noise, of mean zero over singular boxes. */
static void set_exact(const kit_lattice *o, kit_system *s)
{
    uint64_t state = 7;
    int64_t size = s->problem.n / o->boxes;
    for (int64_t n = 0; n < s->problem.n; n++) {
        const double *x = s->x + n * o->dim;
        s->exact[n] = 1000 * (cos(9 * x[0]) + sin(11 * x[1]) + (o->dim == 3 ? x[2] : 0) +
                              0.01 * noise(&state));
    }
    for (int box = o->compressible > 0 ? o->boxes : o->open; box < o->boxes; box++) {
        double mean = 0;
        for (int64_t n = 0; n < size; n++) mean += s->exact[box * size + n] / (double)size;
        for (int64_t n = 0; n < size; n++) s->exact[box * size + n] -= mean;
    }
}

kit_system *kit_lattice_system(const kit_lattice *o)
{
    int64_t size = (int64_t)o->nx * o->ny * o->nz, reach = 2 * ((int64_t)o->re + 1) + 1;
    kit_system *s = new_system(o->dim, size * o->boxes,
                               size * o->boxes * reach * reach * (o->dim == 3 ? reach : 1));
    if (!s) return NULL;
    place(o, s);
    for (int64_t n = 0; n < s->problem.n; n++) fill_row(o, s, n);
    set_exact(o, s);
    set_rhs(s);
    bool singular = o->compressible == 0 && o->open < o->boxes;
    for (int64_t n = 0; n < s->problem.n; n++) {
        int box = (int)(n / size);
        s->weight[n] = 1e-6; /* dt^2 */
        s->component[n] = box < o->open ? -1 : box - o->open;
    }
    s->problem.components = singular ? o->boxes - o->open : 0;
    s->problem.component = singular ? s->component : NULL;
    return s;
}

/* ---- threads ---- */

/* Persistent threads: a solution has thousands of loops, and starting a thread takes longer than
 * most of them. Loops of several callers are serialised: `caller` is locked during a loop, `lock`
 * during access to the other members. */
enum { MOST_THREADS = 64 };
typedef struct team_state {
    pthread_mutex_t caller, lock;
    pthread_cond_t begun, ended;
    mps_part_fn body;
    void *argument;
    int32_t threads, parts, next, ended_parts;
} team_state;

static team_state team = {.caller = PTHREAD_MUTEX_INITIALIZER,
                          .lock = PTHREAD_MUTEX_INITIALIZER,
                          .begun = PTHREAD_COND_INITIALIZER,
                          .ended = PTHREAD_COND_INITIALIZER};

/* Process the next part; the lock is held on entry and return. */
static void do_part(void)
{
    const int32_t part = team.next++;
    pthread_mutex_unlock(&team.lock);
    team.body(team.argument, part);
    pthread_mutex_lock(&team.lock);
    if (++team.ended_parts == team.parts) pthread_cond_signal(&team.ended);
}

static void *work(void *unused)
{
    (void)unused;
    pthread_mutex_lock(&team.lock);
    for (;;) {
        while (team.next >= team.parts) pthread_cond_wait(&team.begun, &team.lock);
        do_part();
    }
    return NULL;
}

static void run_parts(void *user, int32_t parts, mps_part_fn body, void *argument)
{
    pthread_t thread;
    (void)user;
    pthread_mutex_lock(&team.caller);
    pthread_mutex_lock(&team.lock);
    while (team.threads < parts - 1 && team.threads < MOST_THREADS &&
           pthread_create(&thread, NULL, work, NULL) == 0) {
        pthread_detach(thread);
        team.threads++;
    }
    team.body = body;
    team.argument = argument;
    team.parts = parts;
    team.next = team.ended_parts = 0;
    pthread_cond_broadcast(&team.begun);
    do_part(); /* the others are for the threads, so that they do run at once */
    while (team.threads < parts - 1 && team.next < team.parts) do_part();
    while (team.ended_parts < team.parts) pthread_cond_wait(&team.ended, &team.lock);
    pthread_mutex_unlock(&team.lock);
    pthread_mutex_unlock(&team.caller);
}

mps_parallel kit_parallel(int threads)
{
    return (mps_parallel){
        .struct_size = sizeof(mps_parallel), .threads = threads, .run = run_parts};
}
