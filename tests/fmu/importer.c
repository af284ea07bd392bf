/* SPDX-License-Identifier: BSD-3-Clause */
/* Both interfaces, by the module that the FMU has. */
#include "importer.h"
#include "fmi2.h"
#include "fmi3.h"
#include <dirent.h>
#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const uint32_t pose_refs[INPUTS] = {16, 17, 21, 32, 33, 37, 48, 49, 53};
const uint32_t load_refs[OUTPUTS] = {64, 65, 69, 80, 81, 85};

struct module {
    int version;
    char folder[1024], token[64], resources[1100];
    void *library;
    struct {
        fmi2_instantiate *instantiate;
        fmi2_free_instance *release;
        fmi2_setup *setup;
        fmi2_call *enter, *leave, *reset, *terminate;
        fmi2_get *get;
        fmi2_set *set;
        fmi2_step *step;
        fmi2_state_get *state_get, *state_free;
        fmi2_state_set *state_set;
        fmi2_state_size *state_size;
        fmi2_state_write *state_write;
        fmi2_state_read *state_read;
        fmi2_derivative *derivative;
    } two;
    struct {
        fmi3_instantiate *instantiate;
        fmi3_free_instance *release;
        fmi3_enter *enter;
        fmi3_call *leave, *reset, *terminate;
        fmi3_get *get;
        fmi3_set *set;
        fmi3_step *step;
        fmi3_state_get *state_get, *state_free;
        fmi3_state_set *state_set;
        fmi3_state_size *state_size;
        fmi3_state_write *state_write;
        fmi3_state_read *state_read;
        fmi3_derivative *derivative;
    } three;
};

static void end(const char *what, const char *why)
{
    fprintf(stderr, "importer: %s: %s\n", what, why ? why : "missing");
    exit(1);
}

/* ISO C has no cast from void * to a function. */
static void find(const module *m, const char *name, void *function)
{
    void *symbol = dlsym(m->library, name);
    if (!symbol) end(name, dlerror());
    memcpy(function, &symbol, sizeof symbol);
}

static void find_two(module *m)
{
    find(m, "fmi2Instantiate", &m->two.instantiate);
    find(m, "fmi2FreeInstance", &m->two.release);
    find(m, "fmi2SetupExperiment", &m->two.setup);
    find(m, "fmi2EnterInitializationMode", &m->two.enter);
    find(m, "fmi2ExitInitializationMode", &m->two.leave);
    find(m, "fmi2Reset", &m->two.reset);
    find(m, "fmi2Terminate", &m->two.terminate);
    find(m, "fmi2GetReal", &m->two.get);
    find(m, "fmi2SetReal", &m->two.set);
    find(m, "fmi2DoStep", &m->two.step);
    find(m, "fmi2GetFMUstate", &m->two.state_get);
    find(m, "fmi2FreeFMUstate", &m->two.state_free);
    find(m, "fmi2SetFMUstate", &m->two.state_set);
    find(m, "fmi2SerializedFMUstateSize", &m->two.state_size);
    find(m, "fmi2SerializeFMUstate", &m->two.state_write);
    find(m, "fmi2DeSerializeFMUstate", &m->two.state_read);
    find(m, "fmi2GetDirectionalDerivative", &m->two.derivative);
}

static void find_three(module *m)
{
    find(m, "fmi3InstantiateCoSimulation", &m->three.instantiate);
    find(m, "fmi3FreeInstance", &m->three.release);
    find(m, "fmi3EnterInitializationMode", &m->three.enter);
    find(m, "fmi3ExitInitializationMode", &m->three.leave);
    find(m, "fmi3Reset", &m->three.reset);
    find(m, "fmi3Terminate", &m->three.terminate);
    find(m, "fmi3GetFloat64", &m->three.get);
    find(m, "fmi3SetFloat64", &m->three.set);
    find(m, "fmi3DoStep", &m->three.step);
    find(m, "fmi3GetFMUState", &m->three.state_get);
    find(m, "fmi3FreeFMUState", &m->three.state_free);
    find(m, "fmi3SetFMUState", &m->three.state_set);
    find(m, "fmi3SerializedFMUStateSize", &m->three.state_size);
    find(m, "fmi3SerializeFMUState", &m->three.state_write);
    find(m, "fmi3DeserializeFMUState", &m->three.state_read);
    find(m, "fmi3GetDirectionalDerivative", &m->three.derivative);
}

/* binaries/PLATFORM/NAME.so: one platform and one module. */
static void find_file(char *path, size_t size)
{
    for (int level = 0; level < 2; level++) {
        DIR *folder = opendir(path);
        struct dirent *e;
        while (folder && (e = readdir(folder)) != NULL && e->d_name[0] == '.') continue;
        if (!folder || !e) end(path, NULL);
        const size_t used = strlen(path);
        snprintf(path + used, size - used, "/%s", e->d_name);
        closedir(folder);
    }
}

static void read_token(module *m)
{
    char path[1100], text[8192];
    const char *name = m->version == 2 ? "guid=\"" : "instantiationToken=\"";
    snprintf(path, sizeof path, "%s/modelDescription.xml", m->folder);
    FILE *file = fopen(path, "r");
    const size_t length = file ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file) fclose(file);
    text[length] = '\0';
    const char *at = strstr(text, name);
    if (!at || sscanf(at + strlen(name), "%63[^\"]", m->token) != 1) end(path, "no token");
}

const module *module_load(const char *folder, int version)
{
    char path[2048];
    module *m = calloc(1, sizeof *m);
    if (!m) end("module", "no memory");
    m->version = version;
    snprintf(m->folder, sizeof m->folder, "%s/%d", folder, version);
    snprintf(m->resources, sizeof m->resources, "%s%s/resources%s", version == 2 ? "file://" : "",
             m->folder, version == 3 ? "/" : "");
    read_token(m);
    snprintf(path, sizeof path, "%s/binaries", m->folder);
    find_file(path, sizeof path);
    m->library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!m->library) end(path, dlerror());
    if (version == 2)
        find_two(m);
    else
        find_three(m);
    return m;
}

/* Functions with an instance argument. Pointers, counts and flags are all 0; numbers are
 * arbitrary. */
static const char *const names_two[] = {"fmi2SetDebugLogging",
                                        "fmi2FreeInstance",
                                        "fmi2SetupExperiment",
                                        "fmi2EnterInitializationMode",
                                        "fmi2ExitInitializationMode",
                                        "fmi2Terminate",
                                        "fmi2Reset",
                                        "fmi2GetReal",
                                        "fmi2SetReal",
                                        "fmi2DoStep",
                                        "fmi2CancelStep",
                                        "fmi2GetStatus",
                                        "fmi2GetRealStatus",
                                        "fmi2GetBooleanStatus",
                                        "fmi2GetIntegerStatus",
                                        "fmi2GetStringStatus",
                                        "fmi2GetFMUstate",
                                        "fmi2SetFMUstate",
                                        "fmi2FreeFMUstate",
                                        "fmi2SerializedFMUstateSize",
                                        "fmi2SerializeFMUstate",
                                        "fmi2DeSerializeFMUstate",
                                        "fmi2GetDirectionalDerivative",
                                        "fmi2GetInteger",
                                        "fmi2SetInteger",
                                        "fmi2GetBoolean",
                                        "fmi2SetBoolean",
                                        "fmi2GetString",
                                        "fmi2SetString",
                                        "fmi2SetRealInputDerivatives",
                                        "fmi2GetRealOutputDerivatives",
                                        NULL};
static const char *const names_three[] = {"fmi3SetDebugLogging",
                                          "fmi3FreeInstance",
                                          "fmi3EnterInitializationMode",
                                          "fmi3ExitInitializationMode",
                                          "fmi3EnterStepMode",
                                          "fmi3Terminate",
                                          "fmi3Reset",
                                          "fmi3GetFloat64",
                                          "fmi3SetFloat64",
                                          "fmi3DoStep",
                                          "fmi3GetFMUState",
                                          "fmi3SetFMUState",
                                          "fmi3FreeFMUState",
                                          "fmi3SerializedFMUStateSize",
                                          "fmi3SerializeFMUState",
                                          "fmi3DeserializeFMUState",
                                          "fmi3GetDirectionalDerivative",
                                          "fmi3GetAdjointDerivative",
                                          "fmi3EnterConfigurationMode",
                                          "fmi3ExitConfigurationMode",
                                          "fmi3EnterEventMode",
                                          "fmi3EvaluateDiscreteStates",
                                          "fmi3UpdateDiscreteStates",
                                          "fmi3GetOutputDerivatives",
                                          NULL};

void module_null(const module *m)
{
    const char *const *names = m->version == 2 ? names_two : names_three;
    for (int k = 0; names[k]; k++) {
        int (*call)(void *, size_t, size_t, size_t, size_t, size_t, size_t, size_t, size_t);
        find(m, names[k], &call);
        const int status = call(NULL, 0, 0, 0, 0, 0, 0, 0, 0);
        const bool may_succeed = strstr(names[k], "FreeInstance") || /* returns nothing */
                                 strstr(names[k], "DirectionalDerivative") == names[k] ||
                                 strstr(names[k], "RealInputDer") || strstr(names[k], "OutputDer");
        const bool values = strncmp(names[k] + 4, "Get", 3) == 0 ||
                            strncmp(names[k] + 4, "Set", 3) == 0;
        if (!may_succeed && !values && status == 0) end(names[k], "succeeds without an instance");
    }
}

int module_version(const module *m)
{
    return m->version;
}

const char *module_token(const module *m)
{
    return m->token;
}

static void log_two(void *environment, const char *name, fmi2_status status, const char *category,
                    const char *message, ...)
{
    tank *t = environment;
    va_list values;
    (void)name, (void)status, (void)category;
    va_start(values, message);
    vsnprintf(t->text, sizeof t->text, message, values);
    va_end(values);
    t->messages++;
}

static void log_three(void *environment, fmi3_status status, const char *category,
                      const char *message)
{
    tank *t = environment;
    (void)status, (void)category;
    snprintf(t->text, sizeof t->text, "%s", message);
    t->messages++;
}

bool tank_open(tank *t, const module *m, const char *token)
{
    const fmi2_callbacks callbacks = {log_two, calloc, free, NULL, t};
    *t = (tank){.of = m, .logging = false};
    if (!token) token = m->token;
    t->instance = m->version == 2
                      ? m->two.instantiate("tank", 1, token, m->resources, &callbacks, 0,
                                           t->logging)
                      : m->three.instantiate("tank", token, m->resources, false, t->logging, false,
                                             false, NULL, 0, t, log_three, NULL);
    return t->instance != NULL;
}

/* A call of either version. */
#define CALL(NAME, TWO, THREE) (t->of->version == 2 ? t->of->two.NAME TWO : t->of->three.NAME THREE)

void tank_close(tank *t)
{
    CALL(release, (t->instance), (t->instance));
}

int tank_start(tank *t, double time)
{
    const module *m = t->of;
    int status;
    if (m->version == 2) {
        status = m->two.setup(t->instance, 0, 0, time, 0, 0);
        if (status == 0) status = m->two.enter(t->instance);
    } else {
        status = m->three.enter(t->instance, false, 0, time, false, 0);
    }
    return status ? status : CALL(leave, (t->instance), (t->instance));
}

int tank_set(tank *t, const uint32_t *r, size_t count, const double *value)
{
    return CALL(set, (t->instance, r, count, value), (t->instance, r, count, value, count));
}

int tank_get(tank *t, const uint32_t *r, size_t count, double *value)
{
    return CALL(get, (t->instance, r, count, value), (t->instance, r, count, value, count));
}

int tank_step(tank *t, double time, double length)
{
    bool event, last, early;
    double reached;
    return CALL(step, (t->instance, time, length, 0),
                (t->instance, time, length, false, &event, &last, &early, &reached));
}

int tank_reset(tank *t)
{
    return CALL(reset, (t->instance), (t->instance));
}

int tank_terminate(tank *t)
{
    return CALL(terminate, (t->instance), (t->instance));
}

int tank_state_take(tank *t, void **state)
{
    return CALL(state_get, (t->instance, state), (t->instance, state));
}

int tank_state_put(tank *t, void *state)
{
    return CALL(state_set, (t->instance, state), (t->instance, state));
}

int tank_state_free(tank *t, void **state)
{
    return CALL(state_free, (t->instance, state), (t->instance, state));
}

int tank_state_size(tank *t, void *state, size_t *size)
{
    return CALL(state_size, (t->instance, state, size), (t->instance, state, size));
}

int tank_state_write(tank *t, void *state, void *bytes, size_t size)
{
    return CALL(state_write, (t->instance, state, bytes, size), (t->instance, state, bytes, size));
}

int tank_state_read(tank *t, const void *bytes, size_t size, void **state)
{
    return CALL(state_read, (t->instance, bytes, size, state), (t->instance, bytes, size, state));
}

int tank_derivative(tank *t, const uint32_t *unknown, size_t unknowns, const uint32_t *known,
                    size_t count, const double *seed, double *out)
{
    return CALL(derivative, (t->instance, unknown, unknowns, known, count, seed, out),
                (t->instance, unknown, unknowns, known, count, seed, count, out, unknowns));
}
