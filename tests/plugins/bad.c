/* SPDX-License-Identifier: BSD-3-Clause */
/* Plug-ins that are refused, one for each BAD_...; the test expects the reason in the text. */
#include <mps/plugin.h>

int nowhere_defined(void);
int mps_nowhere_defined(void);

/* A model that is good but for its name. */
static int nothing(mps_stage *s)
{
    (void)s;
    return 0;
}
static const mps_verb verbs[] = {{.hook = MPS_FORCE, .run = nothing}};
static const mps_model_ops model = {.struct_size = sizeof(mps_model_ops),
#ifdef BAD_MODEL_API
                                    .api = MPS_MODEL_API + 7,
#else
                                    .api = MPS_MODEL_API,
#endif
#ifdef BAD_TAKEN
                                    .name = "gas.pocket",
#elif defined BAD_NAME
                                    .name = "screen",
#elif defined BAD_SAME
                                    .name = "screen.uniform",
#else
                                    .name = "other.one",
#endif
                                    .help = "A model",
                                    .verb_count = 1,
                                    .verbs = verbs};

#ifdef BAD_DRIVE
static int load(void *user, const double *setting, double t, const mps_motion_state *state,
                double force[6])
{
    (void)user, (void)setting, (void)t, (void)state, (void)force;
    return 0;
}
static const mps_setting settings[] = {{"a", "m", "help", MPS_TYPE_REAL, 3.0, 0.0, 1.0}};
static const mps_drive_ops drive = {.struct_size = sizeof(mps_drive_ops),
                                    .api = MPS_PLUGIN_API,
                                    .name = "drive",
                                    .help = "A load",
                                    .setting_count = 1,
                                    .settings = settings,
                                    .load = load};
#endif

#ifdef BAD_NO_FUNCTION
int other_function(void);
int other_function(void)
{
    return (int)sizeof model;
}
#else
mps_status mps_plugin(mps_registry *r)
{
    (void)model;
#ifndef BAD_NO_BEGIN
    const mps_status status = mps_plugin_begin(r, "bad", "1.0");
    if (status < 0) return status;
#endif
#ifdef BAD_API
    r->plugin_api = MPS_PLUGIN_API + 6;
    return MPS_E_VERSION;
#elif defined BAD_NOTHING
    return MPS_OK;
#elif defined BAD_RETURN
    return MPS_E_STATE;
#elif defined BAD_IGNORES
    r->model(r->host, &model);
    r->model(r->host, &model); /* the name is taken now */
    return MPS_OK;
#elif defined BAD_DRIVE
    return r->drive(r->host, &drive);
#elif defined BAD_UNDEFINED
    return nowhere_defined() ? MPS_OK : r->model(r->host, &model);
#elif defined BAD_LINK
    return mps_nowhere_defined() ? MPS_OK : r->model(r->host, &model);
#else
    return r->model(r->host, &model);
#endif
}
#endif
