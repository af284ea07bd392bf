/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of a device, from the loops of the library. scripts/device_rows compiles each file with
 * loops for NVPTX or SPIR and includes this header first: the loop macros then define kernels for
 * 2-D and 3-D instead of the loop of the host; the script finds those that do not depend on the
 * dimension. The rest of the file is compiled and dropped. MPS_UNIT is the name of the file without
 * its suffix. */
#ifndef MPS_DEVICE_KERNELS_H
#define MPS_DEVICE_KERNELS_H

#include "launch.h"
#include "layout.h"
#include "loop.h"
#include "threads.h"

/* A kernel of arguments `given_`, a pointer to const. On NVPTX they are passed by value, in
 * parameter memory, unless they are too large. */
#ifdef __NVPTX__
#define MPSK__GLOBAL      const __attribute__((address_space(1)))
#define MPSK__LARGE(type) (sizeof(type) > MPS__LAUNCH_BY_VALUE)
#define MPSK__KERNEL(name, type) \
    void name(__typeof__(__builtin_choose_expr(MPSK__LARGE(type), (const type *)0, *(type *)0)) at_)
#define MPSK__GIVEN(type) \
    const type *const given_ = __builtin_choose_expr(MPSK__LARGE(type), at_, &at_);
#else
#define MPSK__GLOBAL             const
#define MPSK__KERNEL(name, type) void name(const __attribute__((address_space(1))) type *at_)
#define MPSK__GIVEN(type)        const type *const given_ = (const type *)(uintptr_t)at_;
#endif

#define MPSK__JOIN(unit, name) mpsk_##unit##__##name
#define MPSK__NAME(unit, name) MPSK__JOIN(unit, name)

_Static_assert(MPS__TOGETHER == MPS__LAUNCH_GROUP, "threads of a group");

/* Whether the results of a kernel are no longer needed. The address is compared as a number: for
 * pointers NVPTX would create an address of 0 first. */
#define MPSK__CANCELLED(given) \
    (mpsk__bits(&(given).cancel) != 0 && *(MPSK__GLOBAL int64_t *)mpsk__bits(&(given).cancel))
static inline __attribute__((always_inline)) int64_t mpsk__bits(const void *value)
{
    int64_t bits;
    __builtin_memcpy(&bits, value, sizeof bits);
    return bits;
}

/* Whether a loop of models skips a row: a particle of another rank. */
#define MPSK__MASKED(given, i) \
    (mpsk__bits(&(given).mask) != 0 && ((MPSK__GLOBAL uint8_t *)mpsk__bits(&(given).mask))[i])

/* Both dimensions; `work` is the code of a row, with dim_ and i_. */
#define MPSK__BOTH(name, work)                               \
    MPSK__ONE(MPSK__NAME(MPS_UNIT, name##_2), name, 2, work) \
    MPSK__ONE(MPSK__NAME(MPS_UNIT, name##_3), name, 3, work)
#define MPSK__ONE(kernel, name, dimension, work)     \
    MPSK__KERNEL(kernel, name##_given)               \
    {                                                \
        enum { dim_ = dimension };                   \
        const int64_t i_ = mps__thread_row();        \
        MPSK__GIVEN(name##_given)                    \
        if (i_ >= given_->launch.n) return;          \
        if (MPSK__CANCELLED(given_->launch)) return; \
        work                                         \
    }

/* Store the values of a row in the terms. The loop bound is constant, so that the values stay in
 * registers. */
#define MPSK__STORE(most)                                                                \
    _Pragma("unroll") for (int k_ = 0; k_ < (most); k_++) if (k_ < given_->launch.count) \
        given_->launch.terms[k_ * given_->launch.n + i_] = own_[k_];

#undef MPS_ROWS
#define MPS_ROWS(name, row, type)                                  \
    typedef struct name##_given {                                  \
        mps__launch launch;                                        \
        mps_view view;                                             \
        type fields;                                               \
    } name##_given;                                                \
    MPSK__BOTH(name, if (MPSK__MASKED(given_->launch, i_)) return; \
               row(dim_, &given_->view, &given_->fields, i_);)     \
    static const mps_rows name = {sizeof(mps_rows), sizeof(type), #name, NULL};

/* MPS_SUMS() does not state how many values a row has. A loop that is not unrolled stores those
 * that the compiler knows to be `first` still: unrolled stores of all MPS_PARALLEL_VALUES would be
 * most of a short kernel. */
#define MPSK__STORE_SOME                                                             \
    const double first_ = given_->launch.first;                                      \
    const int64_t count_ = given_->launch.count;                                     \
    double *to_ = given_->launch.terms + i_;                                         \
    int64_t set_ = 0;                                                                \
    _Pragma("unroll") for (int k_ = 0; k_ < MPS_PARALLEL_VALUES; k_++)               \
    {                                                                                \
        const int same_ = mpsk__bits(&own_[k_]) == mpsk__bits(&first_);              \
        if (!__builtin_constant_p(same_)) set_ = k_ + 1;                             \
    }                                                                                \
    _Pragma("unroll") for (int k_ = 0; k_ < MPS_PARALLEL_VALUES; k_++)               \
    {                                                                                \
        if (k_ >= set_) break;                                                       \
        if (k_ < count_) *to_ = own_[k_];                                            \
        to_ += given_->launch.n;                                                     \
    }                                                                                \
    _Pragma("clang loop unroll(disable)") for (int64_t k_ = set_; k_ < count_; k_++) \
    {                                                                                \
        *to_ = first_;                                                               \
        to_ += given_->launch.n;                                                     \
    }

#undef MPS_SUMS
#define MPS_SUMS(name, row, type)                                                                \
    typedef struct name##_given {                                                                \
        mps__launch launch;                                                                      \
        mps_view view;                                                                           \
        type fields;                                                                             \
    } name##_given;                                                                              \
    MPSK__BOTH(name, double own_[MPS_PARALLEL_VALUES];                                           \
               for (int k_ = 0; k_ < MPS_PARALLEL_VALUES; k_++) own_[k_] = given_->launch.first; \
               if (!MPSK__MASKED(given_->launch, i_))                                            \
                   row(dim_, &given_->view, &given_->fields, i_, own_);                          \
               MPSK__STORE_SOME)                                                                 \
    static const mps_sums name = {sizeof(mps_sums), sizeof(type), #name, NULL};

#undef MPS__LOOP_OF
#define MPS__LOOP_OF(name, work, type, host) \
    typedef struct name##_given {            \
        mps__launch launch;                  \
        type fields;                         \
    } name##_given;                          \
    MPSK__BOTH(name, work;)                  \
    static const mps__loop name = {#name, sizeof(type), NULL};

#undef MPS__VALUES_OF
#define MPS__VALUES_OF(name, work, type, sums, maxima, host)                                      \
    typedef struct name##_given {                                                                 \
        mps__launch launch;                                                                       \
        type fields;                                                                              \
    } name##_given;                                                                               \
    MPSK__BOTH(name, double own_[(sums) + (maxima)];                                              \
               for (int k_ = 0; k_ < (sums) + (maxima); k_++) own_[k_] = k_ < (sums) ? 0          \
                                                                                     : -INFINITY; \
               work; MPSK__STORE((sums) + (maxima)))                                              \
    static const mps__values name = {#name, sizeof(type), sums, maxima, NULL};

#undef MPS__GROUP
#define MPS__GROUP(name, whole, together, type)                                          \
    typedef struct name##_given {                                                        \
        mps__launch launch;                                                              \
        type fields;                                                                     \
    } name##_given;                                                                      \
    MPSK__KERNEL(MPSK__NAME(MPS_UNIT, name), name##_given)                               \
    {                                                                                    \
        MPSK__GIVEN(name##_given)                                                        \
        together(&given_->fields, mps__thread_lane(), !MPSK__CANCELLED(given_->launch)); \
    }                                                                                    \
    static const mps__loop name = {#name, sizeof(type), NULL};

#endif
