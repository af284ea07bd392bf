/* SPDX-License-Identifier: BSD-3-Clause */
/* FMI 2.0, co-simulation: maps names and types of the standard to the adapter. Names of functions
 * are those of the standard. */
#include "fmi2.h"
#include "adapter.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CO_SIMULATION = 1, STEP_STATUS = 0, LAST_TIME = 2, TERMINATED = 3 };

typedef struct instance {
    fmu *tank;
    char *name;
    fmi2_callbacks callbacks;
    double start;     /* of fmi2SetupExperiment() */
    fmi2_status last; /* of the last step */
} instance;

MPS_API fmi2_version fmi2GetTypesPlatform, fmi2GetVersion;
MPS_API fmi2_debug fmi2SetDebugLogging;
MPS_API fmi2_instantiate fmi2Instantiate;
MPS_API fmi2_free_instance fmi2FreeInstance;
MPS_API fmi2_setup fmi2SetupExperiment;
MPS_API fmi2_call fmi2EnterInitializationMode, fmi2ExitInitializationMode, fmi2Terminate, fmi2Reset,
    fmi2CancelStep;
MPS_API fmi2_get fmi2GetReal;
MPS_API fmi2_set fmi2SetReal;
MPS_API fmi2_state_get fmi2GetFMUstate, fmi2FreeFMUstate;
MPS_API fmi2_state_set fmi2SetFMUstate;
MPS_API fmi2_state_size fmi2SerializedFMUstateSize;
MPS_API fmi2_state_write fmi2SerializeFMUstate;
MPS_API fmi2_state_read fmi2DeSerializeFMUstate;
MPS_API fmi2_derivative fmi2GetDirectionalDerivative;
MPS_API fmi2_step fmi2DoStep;
MPS_API fmi2_status_get fmi2GetStatus;
MPS_API fmi2_real_status_get fmi2GetRealStatus;
MPS_API fmi2_flag_status_get fmi2GetBooleanStatus;

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
    if (i->callbacks.log)
        i->callbacks.log(i->callbacks.environment, i->name, (fmi2_status)status, category[status],
                         "%s", text);
}

const char *fmi2GetTypesPlatform(void)
{
    return "default";
}

const char *fmi2GetVersion(void)
{
    return "2.0";
}

fmi2_status fmi2SetDebugLogging(void *c, int on, size_t count, const char *const *categories)
{
    NEEDS(c);
    (void)count;
    (void)categories;
    ((instance *)c)->tank->chatty = on != 0;
    return FMU_OK;
}

static int digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* The path of a "file:///.." URI; other texts are paths. */
static void path_of(const char *uri, char *path, size_t size)
{
    size_t used = 0;
    const char *at = uri;
    const bool is_uri = strncmp(uri, "file:", 5) == 0;
    if (is_uri) at += 5;
    if (is_uri && strncmp(at, "//", 2) == 0) { /* after the host name of the URI */
        const char *slash = strchr(at + 2, '/');
        at = slash ? slash : at + 2;
    }
    for (; *at && used + 1 < size; at++) {
        const bool coded = is_uri && *at == '%' && digit(at[1]) >= 0 && digit(at[2]) >= 0;
        path[used++] = coded ? (char)(16 * digit(at[1]) + digit(at[2])) : *at;
        if (coded) at += 2;
    }
    path[used] = '\0';
}

static void free_all(instance *i)
{
    free(i->name);
    free(i);
}

void *fmi2Instantiate(const char *name, int kind, const char *token, const char *resources,
                      const fmi2_callbacks *callbacks, int visible, int logging)
{
    char path[2000] = "";
    const size_t length = name ? strlen(name) + 1 : 1;
    instance *i = callbacks ? calloc(1, sizeof *i) : NULL;
    (void)visible;
    if (!i) return NULL;
    i->callbacks = *callbacks;
    i->name = calloc(length, 1);
    if (!i->name) {
        free_all(i);
        return NULL;
    }
    if (name) memcpy(i->name, name, length);
    if (resources) path_of(resources, path, sizeof path);
    if (kind != CO_SIMULATION)
        print(i, FMU_ERROR, "instantiate: this is an FMU for co-simulation");
    else
        i->tank = fmu_create(path, token, logging != 0, print, i);
    if (i->tank) return i;
    free_all(i);
    return NULL;
}

void fmi2FreeInstance(void *c)
{
    instance *i = c;
    if (!i) return;
    fmu_destroy(i->tank);
    free_all(i);
}

fmi2_status fmi2SetupExperiment(void *c, int tolerance_defined, double tolerance, double start,
                                int stop_defined, double stop)
{
    NEEDS(c);
    instance *i = c;
    (void)tolerance_defined; /* set by the case */
    (void)tolerance;
    (void)stop_defined; /* a tank has no end */
    (void)stop;
    if (i->tank->v.mode != FMU_INSTANTIATED)
        return fmu_log(i->tank, FMU_ERROR, "setup: is not allowed after initialisation");
    i->start = start;
    return FMU_OK;
}

fmi2_status fmi2EnterInitializationMode(void *c)
{
    NEEDS(c);
    return fmu_initialise(((instance *)c)->tank, ((instance *)c)->start);
}

fmi2_status fmi2ExitInitializationMode(void *c)
{
    NEEDS(c);
    return fmu_begin(((instance *)c)->tank);
}

fmi2_status fmi2Terminate(void *c)
{
    NEEDS(c);
    return fmu_terminate(((instance *)c)->tank);
}

fmi2_status fmi2Reset(void *c)
{
    NEEDS(c);
    ((instance *)c)->start = 0;
    return fmu_reset(((instance *)c)->tank);
}

fmi2_status fmi2GetReal(void *c, const fmi2_reference *reference, size_t count, double *value)
{
    NEEDS(c && (count == 0 || (reference && value)));
    return fmu_get(((instance *)c)->tank, reference, count, value);
}

fmi2_status fmi2SetReal(void *c, const fmi2_reference *reference, size_t count, const double *value)
{
    NEEDS(c && (count == 0 || (reference && value)));
    return fmu_set(((instance *)c)->tank, reference, count, value);
}

fmi2_status fmi2DoStep(void *c, double time, double length, int no_rollback)
{
    NEEDS(c);
    instance *i = c;
    (void)no_rollback;
    i->last = fmu_step(i->tank, time, length);
    return i->last;
}

fmi2_status fmi2CancelStep(void *c)
{
    NEEDS(c);
    return fmu_log(((instance *)c)->tank, FMU_ERROR, "cancel: no step is under way");
}

fmi2_status fmi2GetStatus(void *c, int kind, fmi2_status *value)
{
    NEEDS(c && value);
    const instance *i = c;
    if (kind != STEP_STATUS) return FMU_DISCARD;
    *value = i->last;
    return FMU_OK;
}

fmi2_status fmi2GetRealStatus(void *c, int kind, double *value)
{
    NEEDS(c && value);
    if (kind != LAST_TIME) return FMU_DISCARD;
    *value = ((instance *)c)->tank->v.time;
    return FMU_OK;
}

fmi2_status fmi2GetBooleanStatus(void *c, int kind, int *value)
{
    NEEDS(c && value);
    (void)c;
    if (kind != TERMINATED) return FMU_DISCARD;
    *value = 0; /* a tank does not end by itself */
    return FMU_OK;
}

fmi2_status fmi2GetFMUstate(void *c, void **state)
{
    NEEDS(c && state);
    fmu_state *s = *state;
    const fmu_status status = fmu_state_take(((instance *)c)->tank, &s);
    *state = s;
    return status;
}

fmi2_status fmi2SetFMUstate(void *c, void *state)
{
    NEEDS(c);
    return fmu_state_restore(((instance *)c)->tank, state);
}

fmi2_status fmi2FreeFMUstate(void *c, void **state)
{
    NEEDS(c);
    if (!state) return FMU_OK;
    fmu_state_free(((instance *)c)->tank, *state);
    *state = NULL;
    return FMU_OK;
}

fmi2_status fmi2SerializedFMUstateSize(void *c, void *state, size_t *size)
{
    NEEDS(c && size);
    const unsigned char *bytes;
    return fmu_state_bytes(((instance *)c)->tank, state, &bytes, size);
}

fmi2_status fmi2SerializeFMUstate(void *c, void *state, char *out, size_t size)
{
    NEEDS(c && out);
    return fmu_state_write(((instance *)c)->tank, state, out, size);
}

fmi2_status fmi2DeSerializeFMUstate(void *c, const char *bytes, size_t size, void **state)
{
    NEEDS(c && bytes && state);
    fmu_state *s = NULL;
    const fmu_status status = fmu_state_read(((instance *)c)->tank, (const unsigned char *)bytes,
                                             size, &s);
    if (status == FMU_OK) *state = s;
    return status;
}

fmi2_status fmi2GetDirectionalDerivative(void *c, const fmi2_reference *unknown, size_t unknowns,
                                         const fmi2_reference *known, size_t knowns,
                                         const double *seed, double *out)
{
    NEEDS(c && (unknowns == 0 || (unknown && out)) && (knowns == 0 || (known && seed)));
    return fmu_derivative(((instance *)c)->tank,
                          &(fmu_direction){unknown, known, unknowns, knowns, seed, out});
}
