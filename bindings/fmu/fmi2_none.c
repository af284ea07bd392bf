/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of FMI 2.0 that importers require and a tank does not support: whole numbers, flags,
 * texts, derivatives of signals. They refuse, unless a call names no variable. */
#include <mps/export.h>
#include <stddef.h>

enum { OK = 0, DISCARD = 2, REFUSED = 3 };

#define VALUES(NAME, TYPE)                                                                 \
    MPS_API int fmi2Get##NAME(void *, const unsigned *, size_t, TYPE *);                   \
    MPS_API int fmi2Set##NAME(void *, const unsigned *, size_t, const TYPE *);             \
    int fmi2Get##NAME(void *c, const unsigned *reference, size_t count, TYPE *value)       \
    {                                                                                      \
        (void)c, (void)reference, (void)value;                                             \
        return count ? REFUSED : OK;                                                       \
    }                                                                                      \
    int fmi2Set##NAME(void *c, const unsigned *reference, size_t count, const TYPE *value) \
    {                                                                                      \
        (void)c, (void)reference, (void)value;                                             \
        return count ? REFUSED : OK;                                                       \
    }
VALUES(Integer, int)
VALUES(Boolean, int)
VALUES(String, const char *)

MPS_API int fmi2SetRealInputDerivatives(void *, const unsigned *, size_t, const int *,
                                        const double *);
MPS_API int fmi2GetRealOutputDerivatives(void *, const unsigned *, size_t, const int *, double *);
MPS_API int fmi2GetIntegerStatus(void *, int, int *);
MPS_API int fmi2GetStringStatus(void *, int, const char **);

int fmi2SetRealInputDerivatives(void *c, const unsigned *reference, size_t count, const int *order,
                                const double *value)
{
    (void)c, (void)reference, (void)order, (void)value;
    return count ? REFUSED : OK;
}

int fmi2GetRealOutputDerivatives(void *c, const unsigned *reference, size_t count, const int *order,
                                 double *value)
{
    (void)c, (void)reference, (void)order, (void)value;
    return count ? REFUSED : OK;
}

int fmi2GetIntegerStatus(void *c, int kind, int *value)
{
    (void)c, (void)kind, (void)value;
    return DISCARD;
}

int fmi2GetStringStatus(void *c, int kind, const char **value)
{
    (void)c, (void)kind, (void)value;
    return DISCARD;
}
