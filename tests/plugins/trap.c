/* SPDX-License-Identifier: BSD-3-Clause */
/* A plug-in whose constructor creates a file, $TRAP: a program that does not request it must not
 * load it. */
#include <mps/plugin.h>
#include <stdio.h>
#include <stdlib.h>

__attribute__((constructor)) static void leave_file(void)
{
    const char *path = getenv("TRAP");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (file) fclose(file);
}

static int nothing(mps_stage *s)
{
    (void)s;
    return 0;
}
static const mps_verb verbs[] = {{.hook = MPS_FORCE, .run = nothing}};
static const mps_model_ops model = {.struct_size = sizeof(mps_model_ops),
                                    .api = MPS_MODEL_API,
                                    .name = "trap.model",
                                    .help = "A model",
                                    .verb_count = 1,
                                    .verbs = verbs};

mps_status mps_plugin(mps_registry *r)
{
    const mps_status status = mps_plugin_begin(r, "trap", "1.0");
    return status < 0 ? status : r->model(r->host, &model);
}
