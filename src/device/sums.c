/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels that reduce the terms of rows. Exact sums do not depend on the grouping of terms, so that
 * their bytes are those of the host. Group g of a launch works on value g / parts, as one of
 * `parts` groups; all groups have MPS__LAUNCH_GROUP threads. */
#include "kernels.h"
#include <math.h>

typedef struct place {
    /* the thread's first term; stride; index of the thread in its group */
    int64_t begin, step, lane;
} place;

static inline __attribute__((always_inline)) place place_of(const mps__launch_join *g)
{
    const int64_t group = mps__thread_group(), lane = mps__thread_lane();
    return (place){.begin = group % g->parts * MPS__LAUNCH_GROUP + lane,
                   .step = g->parts * MPS__LAUNCH_GROUP,
                   .lane = lane};
}

/* Terms to reduce; none if the results are not needed. No thread returns early: OpenCL compilers do
 * not accept barriers under a condition. */
static inline __attribute__((always_inline)) int64_t count_of(const mps__launch_join *g)
{
    return MPSK__CANCELLED(*g) ? 0 : g->n;
}

static inline int64_t value_of(const mps__launch_join *g)
{
    return mps__thread_group() / g->parts;
}

/* Strides of a tree reduction; all threads wait between the rounds. */
#define HALVES MPS__ROLLED for (int64_t half = MPS__LAUNCH_GROUP / 2; half > 0; half /= 2)

/* Reduces the sums of the threads of a group to one; the first thread stores it. */
#define JOIN_GROUP(shared, own, out)                        \
    shared[at.lane] = own;                                  \
    HALVES                                                  \
    {                                                       \
        mps__thread_wait();                                 \
        if (at.lane < half) {                               \
            const mps_exact other = shared[at.lane + half]; \
            mps_exact_join(&own, &other);                   \
            shared[at.lane] = own;                          \
        }                                                   \
    }                                                       \
    if (at.lane == 0) ((mps_exact *)(out))[mps__thread_group()] = own;

MPS__SHARED(mps_exact, added, MPS__LAUNCH_GROUP, mpsk_sums__add);
MPSK__KERNEL(mpsk_sums__add, mps__launch_join)
{
    MPSK__GIVEN(mps__launch_join)
    const place at = place_of(given_);
    const int64_t n = count_of(given_);
    const double *terms = given_->terms + value_of(given_) * given_->n;
    mps_exact own = {{0}, 0, 0};
    for (int64_t i = at.begin; i < n; i += at.step) mps_exact_add(&own, 1, &terms[i]);
    JOIN_GROUP(added, own, given_->out)
}

MPS__SHARED(mps_exact, joined, MPS__LAUNCH_GROUP, mpsk_sums__join);
MPSK__KERNEL(mpsk_sums__join, mps__launch_join)
{
    MPSK__GIVEN(mps__launch_join)
    const place at = place_of(given_);
    const int64_t n = count_of(given_);
    const mps_exact *sums = given_->sums + value_of(given_) * given_->n;
    mps_exact own = {{0}, 0, 0};
    for (int64_t i = at.begin; i < n; i += at.step) mps_exact_join(&own, &sums[i]);
    JOIN_GROUP(joined, own, given_->out)
}

/* Maxima of terms; the same kernel reduces the results of groups. A NaN does not count. */
MPS__SHARED(double, raised, MPS__LAUNCH_GROUP, mpsk_sums__raise);
MPSK__KERNEL(mpsk_sums__raise, mps__launch_join)
{
    MPSK__GIVEN(mps__launch_join)
    const place at = place_of(given_);
    const int64_t n = count_of(given_);
    const double *terms = given_->terms + value_of(given_) * given_->n;
    double own = -INFINITY;
    for (int64_t i = at.begin; i < n; i += at.step)
        if (terms[i] > own) own = terms[i];
    raised[at.lane] = own;
    HALVES
    {
        mps__thread_wait();
        if (at.lane < half && raised[at.lane + half] > raised[at.lane])
            raised[at.lane] = raised[at.lane + half];
    }
    if (at.lane == 0) ((double *)given_->out)[mps__thread_group()] = raised[0];
}
