/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of FMI 3.0 that importers require and a tank does not support: other types of values,
 * events, clocks, other kinds of simulation. They refuse, unless a call names no variable. */
#include <mps/export.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { OK = 0, REFUSED = 3 };

#define VALUES(NAME, TYPE)                                                                 \
    MPS_API int fmi3Get##NAME(void *, const uint32_t *, size_t, TYPE *, size_t);           \
    MPS_API int fmi3Set##NAME(void *, const uint32_t *, size_t, const TYPE *, size_t);     \
    int fmi3Get##NAME(void *c, const uint32_t *reference, size_t count, TYPE *value,       \
                      size_t values)                                                       \
    {                                                                                      \
        (void)c, (void)reference, (void)value, (void)values;                               \
        return count ? REFUSED : OK;                                                       \
    }                                                                                      \
    int fmi3Set##NAME(void *c, const uint32_t *reference, size_t count, const TYPE *value, \
                      size_t values)                                                       \
    {                                                                                      \
        (void)c, (void)reference, (void)value, (void)values;                               \
        return count ? REFUSED : OK;                                                       \
    }
VALUES(Float32, float)
VALUES(Int8, int8_t)
VALUES(UInt8, uint8_t)
VALUES(Int16, int16_t)
VALUES(UInt16, uint16_t)
VALUES(Int32, int32_t)
VALUES(UInt32, uint32_t)
VALUES(Int64, int64_t)
VALUES(UInt64, uint64_t)
VALUES(Boolean, bool)
VALUES(String, const char *)

/* A call that always refuses; its further arguments are ignored. */
#define REFUSE(NAME, ...)          \
    MPS_API int NAME(__VA_ARGS__); \
    int NAME(__VA_ARGS__)
#define BODY(...)       \
    {                   \
        __VA_ARGS__;    \
        return REFUSED; \
    }
typedef const uint32_t *refs;
REFUSE(fmi3GetBinary, void *c, refs r, size_t n, size_t *sizes, const uint8_t **v, size_t m)
{
    (void)c, (void)r, (void)sizes, (void)v, (void)m;
    return n ? REFUSED : OK;
}
REFUSE(fmi3SetBinary, void *c, refs r, size_t n, const size_t *sizes, const uint8_t *const *v,
       size_t m)
{
    (void)c, (void)r, (void)sizes, (void)v, (void)m;
    return n ? REFUSED : OK;
}
REFUSE(fmi3GetClock, void *c, refs r, size_t n, bool *v)
{
    (void)c, (void)r, (void)v;
    return n ? REFUSED : OK;
}
REFUSE(fmi3SetClock, void *c, refs r, size_t n, const bool *v)
{
    (void)c, (void)r, (void)v;
    return n ? REFUSED : OK;
}
REFUSE(fmi3GetNumberOfVariableDependencies, void *c, uint32_t r, size_t *n)
BODY((void)c, (void)r, (void)n)
REFUSE(fmi3GetVariableDependencies, void *c, uint32_t r, size_t *at, uint32_t *other,
       size_t *other_at, int *kind, size_t n)
BODY((void)c, (void)r, (void)at, (void)other, (void)other_at, (void)kind, (void)n)
REFUSE(fmi3GetAdjointDerivative, void *c, refs u, size_t nu, refs k, size_t nk, const double *seed,
       size_t ns, double *out, size_t no)
BODY((void)c, (void)u, (void)nu, (void)k, (void)nk, (void)seed, (void)ns, (void)out, (void)no)
REFUSE(fmi3EnterConfigurationMode, void *c)
BODY((void)c)
REFUSE(fmi3ExitConfigurationMode, void *c)
BODY((void)c)
REFUSE(fmi3EnterEventMode, void *c)
BODY((void)c)
REFUSE(fmi3EvaluateDiscreteStates, void *c)
BODY((void)c)
REFUSE(fmi3UpdateDiscreteStates, void *c, bool *more, bool *end, bool *nominals, bool *values,
       bool *defined, double *next)
BODY((void)c, (void)more, (void)end, (void)nominals, (void)values, (void)defined, (void)next)
REFUSE(fmi3GetOutputDerivatives, void *c, refs r, size_t n, const int32_t *order, double *v,
       size_t m)
BODY((void)c, (void)r, (void)n, (void)order, (void)v, (void)m)
REFUSE(fmi3GetIntervalDecimal, void *c, refs r, size_t n, double *interval, int *qualifier)
BODY((void)c, (void)r, (void)n, (void)interval, (void)qualifier)
REFUSE(fmi3GetIntervalFraction, void *c, refs r, size_t n, uint64_t *counter, uint64_t *resolution,
       int *qualifier)
BODY((void)c, (void)r, (void)n, (void)counter, (void)resolution, (void)qualifier)
REFUSE(fmi3GetShiftDecimal, void *c, refs r, size_t n, double *shift)
BODY((void)c, (void)r, (void)n, (void)shift)
REFUSE(fmi3GetShiftFraction, void *c, refs r, size_t n, uint64_t *counter, uint64_t *resolution)
BODY((void)c, (void)r, (void)n, (void)counter, (void)resolution)
REFUSE(fmi3SetIntervalDecimal, void *c, refs r, size_t n, const double *interval)
BODY((void)c, (void)r, (void)n, (void)interval)
REFUSE(fmi3SetIntervalFraction, void *c, refs r, size_t n, const uint64_t *counter,
       const uint64_t *resolution)
BODY((void)c, (void)r, (void)n, (void)counter, (void)resolution)
REFUSE(fmi3SetShiftDecimal, void *c, refs r, size_t n, const double *shift)
BODY((void)c, (void)r, (void)n, (void)shift)
REFUSE(fmi3SetShiftFraction, void *c, refs r, size_t n, const uint64_t *counter,
       const uint64_t *resolution)
BODY((void)c, (void)r, (void)n, (void)counter, (void)resolution)
