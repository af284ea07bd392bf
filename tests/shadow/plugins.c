/* SPDX-License-Identifier: BSD-3-Clause */
#include "plugins.h"
#include <math.h>

/* ---- memory of a state: in the memory space of the equation ---- */

typedef struct arrays {
    mps_allocator host, from; /* `from`: of the block */
    double *block;
    int64_t numbers;
} arrays;

static void release(arrays *a)
{
    if (a->block) a->from.release(a->from.user, a->block);
    a->block = NULL;
    a->numbers = 0;
}

static double *reserve(arrays *a, const mps_ppe_problem *problem, int64_t numbers)
{
    const mps_allocator wanted = problem->device ? *problem->device : a->host;
    const int moved = wanted.alloc != a->from.alloc || wanted.user != a->from.user;
    if (a->block && !moved && numbers <= a->numbers) return a->block;
    release(a);
    a->from = wanted;
    a->block = wanted.alloc(wanted.user, (size_t)(numbers + 1) * sizeof *a->block);
    a->numbers = a->block ? numbers : 0;
    return a->block;
}

/* ---- a preconditioner ---- */

typedef struct neumann {
    arrays arrays;
    const mps_ppe_problem *problem;
} neumann;

static int neumann_create(const mps_allocator *allocator, void **self)
{
    neumann *s = allocator->alloc(allocator->user, sizeof *s);
    if (!s) return 1;
    *s = (neumann){.arrays = {.host = *allocator}};
    *self = s;
    return 0;
}

static void neumann_release_device(void *self)
{
    neumann *s = self;
    if (s->arrays.from.alloc != s->arrays.host.alloc) release(&s->arrays);
}

static void neumann_destroy(const mps_allocator *allocator, void *self)
{
    neumann *s = self;
    release(&s->arrays);
    allocator->release(allocator->user, s);
}

typedef struct matrix {
    const int64_t *row;
    const int32_t *col;
    const float *val;
    const double *diagonal, *inverse, *r;
    double *y, *z;
} matrix;

static matrix matrix_of(const mps_ppe_problem *a)
{
    return (matrix){.row = a->row, .col = a->col, .val = a->val, .diagonal = a->diagonal};
}

MPS_ROW void invert(const int dim, const mps_view *v, const matrix *f, int64_t i)
{
    const double d = f->diagonal[i];
    (void)dim, (void)v;
    f->y[i] = d > 0 ? 1 / d : 1;
}
MPS_ROWS(invert_rows, invert, matrix)

MPS_ROW void scale(const int dim, const mps_view *v, const matrix *f, int64_t i)
{
    (void)dim, (void)v;
    f->y[i] = f->inverse[i] * f->r[i];
}
MPS_ROWS(scale_rows, scale, matrix)

MPS_ROW void correct(const int dim, const mps_view *v, const matrix *f, int64_t i)
{
    double product = f->diagonal[i] * f->y[i];
    (void)dim, (void)v;
    for (int64_t k = f->row[i]; k < f->row[i + 1]; k++)
        product += (double)f->val[k] * f->y[f->col[k]];
    f->z[i] = f->inverse[i] * (2 * f->r[i] - product);
}
MPS_ROWS(correct_rows, correct, matrix)

static int neumann_setup(void *self, const mps_ppe_problem *problem)
{
    neumann *s = self;
    matrix f = matrix_of(problem);
    f.y = reserve(&s->arrays, problem, 2 * problem->n);
    if (!f.y) return MPS_PPE_NOMEM;
    s->problem = problem;
    mps_ppe_rows(problem, &invert_rows, &f);
    return MPS_PPE_CONVERGED;
}

static int neumann_apply(void *self, const double *r, double *z)
{
    const neumann *s = self;
    matrix f = matrix_of(s->problem);
    f.inverse = s->arrays.block;
    f.r = r;
    f.y = s->arrays.block + s->problem->n;
    f.z = z;
    mps_ppe_rows(s->problem, &scale_rows, &f);
    mps_ppe_rows(s->problem, &correct_rows, &f);
    return MPS_PPE_CONVERGED;
}

const mps_preconditioner_ops plugin_neumann = {.struct_size = sizeof plugin_neumann,
                                               .api = MPS_PPE_API,
                                               .name = "test.neumann",
                                               .symmetric = 1,
                                               .create = neumann_create,
                                               .setup = neumann_setup,
                                               .apply = neumann_apply,
                                               .destroy = neumann_destroy,
                                               .device = 1,
                                               .release_device = neumann_release_device,
                                               .fallback = "jacobi",
                                               .setup_async = 1};

/* ---- a solver ---- */

typedef struct cg {
    arrays arrays;
} cg;

typedef struct vectors {
    matrix a;
    const double *rhs;
    double *x, *r, *z, *p, *q;
    double alpha, beta;
} vectors;

static int cg_create(const mps_allocator *allocator, void **self)
{
    cg *s = allocator->alloc(allocator->user, sizeof *s);
    if (!s) return 1;
    *s = (cg){.arrays = {.host = *allocator}};
    *self = s;
    return 0;
}

static void cg_release_device(void *self)
{
    cg *s = self;
    if (s->arrays.from.alloc != s->arrays.host.alloc) release(&s->arrays);
}

static void cg_destroy(const mps_allocator *allocator, void *self)
{
    cg *s = self;
    release(&s->arrays);
    allocator->release(allocator->user, s);
}

MPS_ROW double product_of(const matrix *a, const double *x, int64_t i)
{
    double sum = a->diagonal[i] * x[i];
    for (int64_t k = a->row[i]; k < a->row[i + 1]; k++) sum += (double)a->val[k] * x[a->col[k]];
    return sum;
}

MPS_ROW void subtract(const int dim, const mps_view *v, const vectors *f, int64_t i)
{
    (void)dim, (void)v;
    f->r[i] = f->rhs[i] - product_of(&f->a, f->x, i);
}
MPS_ROWS(subtract_rows, subtract, vectors)

MPS_ROW void clear(const int dim, const mps_view *v, const vectors *f, int64_t i)
{
    (void)dim, (void)v;
    f->x[i] = 0;
}
MPS_ROWS(clear_rows, clear, vectors)

MPS_ROW void copy(const int dim, const mps_view *v, const vectors *f, int64_t i)
{
    (void)dim, (void)v;
    f->z[i] = f->r[i];
}
MPS_ROWS(copy_rows, copy, vectors)

MPS_ROW void direct(const int dim, const mps_view *v, const vectors *f, int64_t i)
{
    (void)dim, (void)v;
    f->p[i] = f->beta == 0 ? f->z[i] : f->z[i] + f->beta * f->p[i];
}
MPS_ROWS(direct_rows, direct, vectors)

MPS_ROW void multiply(const int dim, const mps_view *v, const vectors *f, int64_t i)
{
    (void)dim, (void)v;
    f->q[i] = product_of(&f->a, f->p, i);
}
MPS_ROWS(multiply_rows, multiply, vectors)

MPS_ROW void advance(const int dim, const mps_view *v, const vectors *f, int64_t i)
{
    (void)dim, (void)v;
    f->x[i] += f->alpha * f->p[i];
    f->r[i] -= f->alpha * f->q[i];
}
MPS_ROWS(advance_rows, advance, vectors)

/* r'r, r'z, p'q */
enum { RR, RZ, PQ, DOTS };

MPS_ROW void dot(const int dim, const mps_view *v, const vectors *f, int64_t i, double *sums)
{
    (void)dim, (void)v;
    sums[RR] += f->r[i] * f->r[i];
    sums[RZ] += f->r[i] * f->z[i];
    sums[PQ] += f->p[i] * f->q[i];
}
MPS_SUMS(dots, dot, vectors)

MPS_ROW void weigh(const int dim, const mps_view *v, const vectors *f, int64_t i, double *largest)
{
    (void)dim, (void)v;
    largest[0] = mps_larger(largest[0], fabs(f->rhs[i]));
}
MPS_SUMS(largest_rhs, weigh, vectors)

/* One iteration from the direction of the previous one. @return 0, or a reason of failure */
static int iterate(const mps_ppe_problem *problem, const mps_preconditioner_ops *pc, void *pc_self,
                   vectors *f, double *rz)
{
    double sums[DOTS];
    const int reason = pc ? pc->apply(pc_self, f->r, f->z) : 0;
    if (reason) return reason;
    if (!pc) mps_ppe_rows(problem, &copy_rows, f);
    if (mps_ppe_sum(problem, DOTS, &dots, f, sums)) return MPS_PPE_BREAKDOWN;
    if (!(sums[RZ] > 0)) return MPS_PPE_INDEFINITE;
    f->beta = *rz > 0 ? sums[RZ] / *rz : 0;
    *rz = sums[RZ];
    mps_ppe_rows(problem, &direct_rows, f);
    mps_ppe_rows(problem, &multiply_rows, f);
    if (mps_ppe_sum(problem, DOTS, &dots, f, sums)) return MPS_PPE_BREAKDOWN;
    if (!(sums[PQ] > 0)) return MPS_PPE_INDEFINITE;
    f->alpha = *rz / sums[PQ];
    mps_ppe_rows(problem, &advance_rows, f);
    return 0;
}

static int is_solved(const mps_ppe_problem *problem, const vectors *f, mps_ppe_result *result)
{
    mps_ppe_check(problem, f->x, f->z, result);
    return result->residual <= problem->tolerance &&
           (problem->divergence <= 0 || result->divergence <= problem->divergence);
}

static void cg_solve(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                     void *pc_self, double *p, mps_ppe_result *result)
{
    cg *s = self;
    double *block = reserve(&s->arrays, problem, 4 * problem->n), most = 0, rz = 0;
    result->reason = MPS_PPE_NOMEM;
    if (!block) return;
    vectors f = {.a = matrix_of(problem),
                 .rhs = problem->rhs,
                 .x = p,
                 .r = block,
                 .z = block + problem->n,
                 .p = block + 2 * problem->n,
                 .q = block + 3 * problem->n};
    mps_ppe_max(problem, 1, &largest_rhs, &f, &most);
    if (!(most > 0)) mps_ppe_rows(problem, &clear_rows, &f);
    result->reason = pc ? pc->setup(pc_self, problem) : MPS_PPE_CONVERGED;
    mps_ppe_rows(problem, &subtract_rows, &f);
    while (!result->reason && !is_solved(problem, &f, result)) {
        if (result->iterations++ == problem->max_iterations)
            result->reason = MPS_PPE_MAX_ITERATIONS;
        else
            result->reason = iterate(problem, pc, pc_self, &f, &rz);
    }
}

const mps_solver_ops plugin_cg = {.struct_size = sizeof plugin_cg,
                                  .api = MPS_PPE_API,
                                  .name = "test.cg",
                                  .preconditioner = "test.neumann",
                                  .symmetric = 1,
                                  .create = cg_create,
                                  .solve = cg_solve,
                                  .destroy = cg_destroy,
                                  .device = 1,
                                  .release_device = cg_release_device};

/* ---- a model with loops, sums, workspace, a channel and a state ---- */

enum { VELOCITY, ACCELERATION, PULLED, USES };
static const mps_use uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS},
                                   [ACCELERATION] = {"acceleration", MPS_USE_CHANGE},
                                   [PULLED] = {"drag_pulled", MPS_USE_CHANGE}};
static const mps_channel channels[] = {{.name = "drag_pulled",
                                        .unit = "m/s",
                                        .help = "Sum of the pulls",
                                        .components = 1,
                                        .type = MPS_TYPE_REAL,
                                        .life = MPS_LIFE_PARTICLE}};
static const mps_setting settings[] = {
    {"rate", "1/s", "Rate of the drag", MPS_TYPE_REAL, 2, 0, 100}};

typedef struct drag {
    const double *u;
    double *a, *pulled, *beside;
    double mean[3];
} drag;

MPS_ROW void add(const int dim, const mps_view *v, const drag *f, int64_t i, double *sums)
{
    if (!mps_is_fluid(v, i)) return;
    for (int d = 0; d < dim; d++) sums[d] += f->u[i * dim + d];
    sums[dim] += 1;
}
MPS_SUMS(add_rows, add, drag)

MPS_ROW void look(const int dim, const mps_view *v, const drag *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    double sum = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++)
        sum += f->u[(int64_t)mps_stencil_column(t, p) * dim] - f->u[i * dim];
    f->beside[i] = sum;
}
MPS_ROWS(look_rows, look, drag)

MPS_ROW void pull(const int dim, const mps_view *v, const drag *f, int64_t i)
{
    if (!mps_is_fluid(v, i)) return;
    for (int d = 0; d < dim; d++) {
        const double a = v->setting[0] * (f->mean[d] - f->u[i * dim + d] + 0.01 * f->beside[i]);
        f->a[i * dim + d] += a;
        f->pulled[i] += a * v->dt;
    }
}
MPS_ROWS(pull_rows, pull, drag)

static int pull_fluid(mps_stage *s)
{
    const int dim = s->view->dim;
    double sums[4] = {0}, *steps = mps_stage_state(s, 1);
    drag f = {.u = s->data[VELOCITY],
              .a = s->data[ACCELERATION],
              .pulled = s->data[PULLED],
              .beside = mps_stage_scratch(s, s->view->n)};
    if (!steps || !f.beside) return 1;
    *steps += 1;
    mps_stage_sum(s, dim + 1, &add_rows, &f, sums);
    for (int d = 0; d < dim && sums[dim] > 0; d++) f.mean[d] = sums[d] / sums[dim];
    mps_stage_rows(s, &look_rows, &f);
    mps_stage_rows(s, &pull_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_FORCE, .use_count = USES, .uses = uses, .run = pull_fluid, .device = 1}};

const mps_model_ops plugin_drag = {.struct_size = sizeof plugin_drag,
                                   .api = MPS_MODEL_API,
                                   .name = "drag.mean",
                                   .help = "Pulls fluid towards its mean velocity",
                                   .setting_count = 1,
                                   .channel_count = 1,
                                   .verb_count = 1,
                                   .settings = settings,
                                   .channels = channels,
                                   .verbs = verbs};

/* ---- a model that fails ---- */

static const mps_use mark_uses[] = {{"region", MPS_USE_CHANGE}};
static const mps_setting mark_settings[] = {
    {"bad", "-", "Whether a region is wrong", MPS_TYPE_FLAG, 0, 0, 1}};

typedef struct marking {
    int32_t *region;
} marking;

MPS_ROW void mark(const int dim, const mps_view *v, const marking *f, int64_t i)
{
    (void)dim;
    if (v->setting[0] > 0 && v->id[i] == 40) f->region[i] = 77;
}
MPS_ROWS(mark_rows, mark, marking)

static int mark_regions(mps_stage *s)
{
    mps_stage_rows(s, &mark_rows, &(marking){s->data[0]});
    return 0;
}

static const mps_verb mark_verbs[] = {{.hook = MPS_CLASSIFY,
                                       .use_count = 1,
                                       .uses = mark_uses,
                                       .after = "*",
                                       .run = mark_regions,
                                       .device = 1}};

const mps_model_ops plugin_mark = {.struct_size = sizeof plugin_mark,
                                   .api = MPS_MODEL_API,
                                   .name = "mark.region",
                                   .help = "A wrong region",
                                   .setting_count = 1,
                                   .verb_count = 1,
                                   .settings = mark_settings,
                                   .verbs = mark_verbs};
