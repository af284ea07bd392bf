/* SPDX-License-Identifier: BSD-3-Clause */
/* FMI 3.0, co-simulation: maps names and types of the standard to the adapter. Names of functions
 * are those of the standard. */
#include "fmi3.h"
#include "adapter.h"
#include <stdlib.h>

#define EXPORT MPS_API

typedef struct instance {
    fmu *tank;
    void *environment;
    fmi3_log *log;
} instance;

EXPORT fmi3_version fmi3GetVersion;
EXPORT fmi3_debug fmi3SetDebugLogging;
EXPORT fmi3_instantiate fmi3InstantiateCoSimulation;
EXPORT fmi3_free_instance fmi3FreeInstance;
EXPORT fmi3_enter fmi3EnterInitializationMode;
EXPORT fmi3_call fmi3ExitInitializationMode, fmi3EnterStepMode, fmi3Terminate, fmi3Reset;
EXPORT fmi3_get fmi3GetFloat64;
EXPORT fmi3_set fmi3SetFloat64;
EXPORT fmi3_state_get fmi3GetFMUState, fmi3FreeFMUState;
EXPORT fmi3_state_set fmi3SetFMUState;
EXPORT fmi3_state_size fmi3SerializedFMUStateSize;
EXPORT fmi3_state_write fmi3SerializeFMUState;
EXPORT fmi3_state_read fmi3DeserializeFMUState;
EXPORT fmi3_derivative fmi3GetDirectionalDerivative;
EXPORT fmi3_step fmi3DoStep;

/* Required arguments: an importer that passes NULL gets an error. */
#define NEEDS(what)                    \
    do {                               \
        if (!(what)) return FMU_ERROR; \
    } while (0)

static void print(void *user, fmu_status status, const char *text)
{
    static const char *const category[] = {"logAll", "logStatusWarning", "logStatusDiscard",
                                           "logStatusError"};
    const instance *i = user;
    if (i->log) i->log(i->environment, (fmi3_status)status, category[status], text);
}

const char *fmi3GetVersion(void)
{
    return "3.0";
}

fmi3_status fmi3SetDebugLogging(void *c, bool on, size_t count, const char *const *categories)
{
    NEEDS(c);
    instance *i = c;
    (void)count;
    (void)categories;
    i->tank->chatty = on;
    return FMU_OK;
}

void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources,
                                  bool visible, bool logging, bool event_mode, bool early_return,
                                  const fmi3_reference *intermediate, size_t intermediate_count,
                                  void *environment, fmi3_log *log, fmi3_intermediate *update)
{
    instance *i = calloc(1, sizeof *i);
    (void)name;
    (void)visible;
    (void)early_return; /* steps are never interrupted */
    (void)intermediate;
    (void)update;
    if (!i) return NULL;
    *i = (instance){.environment = environment, .log = log};
    if (event_mode || intermediate_count > 0)
        print(i, FMU_ERROR, "instantiate: there is no event mode and no intermediate variable");
    else if (!resources)
        print(i, FMU_ERROR, "instantiate: the path of the resources is missing");
    else
        i->tank = fmu_create(resources, token, logging, print, i);
    if (i->tank) return i;
    free(i);
    return NULL;
}

void fmi3FreeInstance(void *c)
{
    instance *i = c;
    if (!i) return;
    fmu_destroy(i->tank);
    free(i);
}

fmi3_status fmi3EnterInitializationMode(void *c, bool tolerance_defined, double tolerance,
                                        double start, bool stop_defined, double stop)
{
    NEEDS(c);
    (void)tolerance_defined; /* set by the case */
    (void)tolerance;
    (void)stop_defined; /* a tank has no end */
    (void)stop;
    return fmu_initialise(((instance *)c)->tank, start);
}

fmi3_status fmi3ExitInitializationMode(void *c)
{
    NEEDS(c);
    return fmu_begin(((instance *)c)->tank);
}

fmi3_status fmi3EnterStepMode(void *c)
{
    NEEDS(c);
    return fmu_log(((instance *)c)->tank, FMU_ERROR, "there is no event mode to leave");
}

fmi3_status fmi3Terminate(void *c)
{
    NEEDS(c);
    return fmu_terminate(((instance *)c)->tank);
}

fmi3_status fmi3Reset(void *c)
{
    NEEDS(c);
    return fmu_reset(((instance *)c)->tank);
}

static fmi3_status count_wrong(fmu *f, const char *call)
{
    return fmu_log(f, FMU_ERROR, "%s: the numbers of variables and values differ", call);
}

fmi3_status fmi3GetFloat64(void *c, const fmi3_reference *reference, size_t references,
                           double *value, size_t values)
{
    NEEDS(c && (references == 0 || (reference && value)));
    fmu *f = ((instance *)c)->tank;
    return references == values ? (int)fmu_get(f, reference, references, value)
                                : count_wrong(f, "get");
}

fmi3_status fmi3SetFloat64(void *c, const fmi3_reference *reference, size_t references,
                           const double *value, size_t values)
{
    NEEDS(c && (references == 0 || (reference && value)));
    fmu *f = ((instance *)c)->tank;
    return references == values ? (int)fmu_set(f, reference, references, value)
                                : count_wrong(f, "set");
}

fmi3_status fmi3DoStep(void *c, double time, double length, bool no_rollback, bool *event,
                       bool *terminate, bool *early, double *last_time)
{
    NEEDS(c && event && terminate && early && last_time);
    fmu *f = ((instance *)c)->tank;
    (void)no_rollback;
    const fmu_status status = fmu_step(f, time, length);
    *event = *terminate = *early = false;
    *last_time = f->v.time;
    return status;
}

fmi3_status fmi3GetFMUState(void *c, void **state)
{
    NEEDS(c && state);
    fmu_state *s = *state;
    const fmu_status status = fmu_state_take(((instance *)c)->tank, &s);
    *state = s;
    return status;
}

fmi3_status fmi3SetFMUState(void *c, void *state)
{
    NEEDS(c);
    return fmu_state_restore(((instance *)c)->tank, state);
}

fmi3_status fmi3FreeFMUState(void *c, void **state)
{
    NEEDS(c);
    if (!state) return FMU_OK;
    fmu_state_free(((instance *)c)->tank, *state);
    *state = NULL;
    return FMU_OK;
}

fmi3_status fmi3SerializedFMUStateSize(void *c, void *state, size_t *size)
{
    NEEDS(c && size);
    const unsigned char *bytes;
    return fmu_state_bytes(((instance *)c)->tank, state, &bytes, size);
}

fmi3_status fmi3SerializeFMUState(void *c, void *state, uint8_t *out, size_t size)
{
    NEEDS(c && out);
    return fmu_state_write(((instance *)c)->tank, state, out, size);
}

fmi3_status fmi3DeserializeFMUState(void *c, const uint8_t *bytes, size_t size, void **state)
{
    NEEDS(c && bytes && state);
    fmu_state *s = NULL;
    const fmu_status status = fmu_state_read(((instance *)c)->tank, bytes, size, &s);
    if (status == FMU_OK) *state = s;
    return status;
}

fmi3_status fmi3GetDirectionalDerivative(void *c, const fmi3_reference *unknown, size_t unknowns,
                                         const fmi3_reference *known, size_t knowns,
                                         const double *seed, size_t seeds, double *out, size_t outs)
{
    NEEDS(c && (unknowns == 0 || (unknown && out)) && (knowns == 0 || (known && seed)));
    fmu *f = ((instance *)c)->tank;
    if (seeds != knowns || outs != unknowns) return count_wrong(f, "derivative");
    return fmu_derivative(f, &(fmu_direction){unknown, known, unknowns, knowns, seed, out});
}
