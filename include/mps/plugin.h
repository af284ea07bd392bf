/* SPDX-License-Identifier: BSD-3-Clause */
/** @file plugin.h  Plug-ins: shared libraries with models, pressure solvers, preconditioners, loads
 *  of a rigid body and motions of the tank. A case file names them:
 *
 *    plugins: [libscreen.so]
 *    use: [screen.porous]
 *    settings: {screen.darcy: 2 1/s}
 *
 *  A plug-in exports one function, mps_plugin(). It is compiled with this header and linked with
 *  libmps, which the program has already loaded:
 *
 *    cc -shared -fPIC -O2 screen.c -o libscreen.so $(pkg-config --cflags --libs mps)
 *
 *  @code{.c}
 *    #include <mps/plugin.h>
 *
 *    mps_status mps_plugin(mps_registry *r)
 *    {
 *        const mps_status status = mps_plugin_begin(r, "screen", "1.0");
 *        return status < 0 ? status : r->model(r->host, &screen_porous);
 *    }
 *  @endcode
 *
 *  The functions at the end of this header load plug-ins. They are in libmps_case, which is linked
 *  together with libmps; a plug-in does not call them. A plug-in runs with all rights of the
 *  program: load only files that you trust. */
#ifndef MPS_PLUGIN_H
#define MPS_PLUGIN_H

#include <mps/body.h>
#include <mps/model.h>
#include <mps/ppe.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_registry.api and mps_drive_ops.api. Tables of models and of
 *  solvers have their own versions, MPS_MODEL_API and MPS_PPE_API. */
#define MPS_PLUGIN_API 1u

/** Excitation of the tank: a load on the rigid body that carries it, `body: {load: {plugin:
 *  NAME}}`, or its motion, `motion: {plugin: NAME}`. Exactly one of `load` and `motion` is set.
 *  Both must be functions of their arguments only: steps may be repeated, runs continue from
 *  checkpoints, and each rank calls them. */
typedef struct mps_drive_ops {
    /** sizeof(mps_drive_ops) */
    uint32_t struct_size;
    /** MPS_PLUGIN_API */
    uint32_t api;
    /** 1..31 lower-case letters, digits and '_', a letter first; not the slot of a model. */
    const char *name;
    /** Description, one line. */
    const char *help;
    /** Entries of settings, 0..16. */
    int32_t setting_count;
    /** Kept 0. */
    int32_t reserved;
    /** Numbers that a user may set: `settings: {NAME.key: value}`. */
    const mps_setting *settings;
    /** Load on the body, as mps_body_load_fn. @param setting  values of the settings in their order
     *  @param load  out, 0 on entry @return 0; non-zero: the step fails with MPS_E_PLUGIN */
    int (*load)(void *user, const double *setting, double t, const mps_motion_state *state,
                double load[6]);
    /** Motion of the tank, as mps_motion_fn. @param state  out, 0 on entry: value, rate and
     *  acceleration of each degree of freedom
     *  @return 0; non-zero: the step fails with MPS_E_PLUGIN */
    int (*motion)(void *user, const double *setting, double t, mps_motion_state *state);
    /** NULL, or the shortest period of the load or motion [s]; <= 0: not periodic. A period is
     *  resolved by at least 20 time steps. */
    double (*period)(const double *setting);
    /** First argument of `load` and `motion`. */
    void *user;
} mps_drive_ops;

/** Argument of mps_plugin(): functions that register tables, and entries that mps_plugin_begin()
 *  sets. Tables and their texts must be valid as long as the plug-in is loaded. */
typedef struct mps_registry {
    /** sizeof(mps_registry) of the calling library. */
    uint32_t struct_size;
    /** MPS_PLUGIN_API of the calling library. */
    uint32_t api;
    /** First argument of the functions. */
    void *host;
    /** Register a model. @return as mps_model_register() */
    mps_status (*model)(void *host, const mps_model_ops *ops);
    /** Register a pressure solver. @return as mps_solver_register() */
    mps_status (*solver)(void *host, const mps_solver_ops *ops);
    /** Register a preconditioner. @return as mps_preconditioner_register() */
    mps_status (*preconditioner)(void *host, const mps_preconditioner_ops *ops);
    /** Register a load or a motion. @return MPS_E_ARG (which entry), MPS_E_NAME (a name in use) */
    mps_status (*drive)(void *host, const mps_drive_ops *ops);
    /** Out: MPS_PLUGIN_API of the plug-in. */
    uint32_t plugin_api;
    /** Kept 0. */
    int32_t reserved;
    /** Out: name of the plug-in, 1..47 characters, for report.html and messages. */
    const char *name;
    /** Out: its version, 1..47 characters, e.g. "1.2". */
    const char *version;
} mps_registry;

/** Visibility of mps_plugin(), also if a plug-in is compiled with -fvisibility=hidden. */
#if defined(__GNUC__)
#define MPS_PLUGIN_EXPORT __attribute__((visibility("default")))
#else
#define MPS_PLUGIN_EXPORT
#endif

/** The function that a plug-in exports. It is called once for each simulation, possibly from
 *  several threads concurrently, and registers the same tables each time.
 *  @return MPS_OK, or the status of the call that failed; the library has its text */
MPS_PLUGIN_EXPORT mps_status mps_plugin(mps_registry *r);

/** First call in mps_plugin(): set name and version of the plug-in, and check that the library has
 *  the interface with which it was compiled. @return MPS_E_VERSION: another interface */
static inline mps_status mps_plugin_begin(mps_registry *r, const char *name, const char *version)
{
    r->plugin_api = MPS_PLUGIN_API;
    if (r->api != MPS_PLUGIN_API || r->struct_size < sizeof *r) return MPS_E_VERSION;
    r->name = name;
    r->version = version;
    return MPS_OK;
}

/* ---- for programs that load plug-ins: libmps_case ------------------------------------------- */

/** A loaded plug-in. */
typedef struct mps_plugin_file mps_plugin_file;

/** Kinds of registered items. */
enum {
    /** A model. */
    MPS_PLUGIN_MODEL = 0,
    /** A pressure solver. */
    MPS_PLUGIN_SOLVER = 1,
    /** A preconditioner. */
    MPS_PLUGIN_PRECONDITIONER = 2,
    /** A load on a rigid body. */
    MPS_PLUGIN_LOAD = 3,
    /** A motion of the tank. */
    MPS_PLUGIN_MOTION = 4
};

/** Properties of a plug-in. Its texts are owned by the plug-in. */
typedef struct mps_plugin_info {
    /** Set by mps_plugin_info_init(). */
    uint32_t struct_size;
    /** Number of registered items. */
    int32_t items;
    /** Absolute path of its file. */
    const char *path;
    /** SHA-256 of its file: 64 hexadecimal digits. */
    const char *sha256;
    /** Name set by mps_plugin_begin(). */
    const char *name;
    /** Version set by mps_plugin_begin(). */
    const char *version;
} mps_plugin_info;

/** An item that a plug-in registers. */
typedef struct mps_plugin_item {
    /** Set by mps_plugin_item_init(). */
    uint32_t struct_size;
    /** MPS_PLUGIN_... */
    int32_t kind;
    /** Its name, e.g. "screen.porous". */
    const char *name;
    /** One line, or "". */
    const char *help;
    /** Table of a load or motion; else NULL. */
    const mps_drive_ops *drive;
} mps_plugin_item;

/** Load a plug-in and determine its items. This runs its code, including its constructors.
 *  @param path   of the file; a name without '/' is not searched in library folders
 *  @param out    out: the plug-in; close it with mps_plugin_close(). NULL on failure
 *  @param error  [size] NULL with size 0, or out: reason of a failure, one line
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | path or out is NULL |
 *  | MPS_E_IO | the file cannot be read, is no shared library of this machine, or a dependency is
 *  missing |
 *  | MPS_E_VERSION | another version of this interface, or another copy of libmps |
 *  | MPS_E_PLUGIN | no mps_plugin(), or this function failed |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_plugin_open(const char *path, mps_plugin_file **out, char *error,
                                   size_t size);

/** Unload a plug-in, after all simulations that use it are destroyed. NULL is allowed. */
MPS_API void mps_plugin_close(mps_plugin_file *plugin);

/** Register all models, solvers and preconditioners of a plug-in on a simulation. Destroy the
 *  simulation before you close the plug-in. Loads and motions are not registered, see
 *  mps_plugin_item_get(). Checkpoints then contain the SHA-256 of the plug-in: one that was written
 *  with another file is refused.
 *  @param error  as in mps_plugin_open()
 *  @return MPS_E_ARG: plugin or sim is NULL; else the error of the failed call */
MPS_API mps_status mps_plugin_register(const mps_plugin_file *plugin, mps_sim *sim, char *error,
                                       size_t size);

/** Set struct_size and zero. @param size  sizeof(mps_plugin_info) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_plugin_info_init(mps_plugin_info *info, size_t size);

/** Properties of a plug-in. @param info  initialised by mps_plugin_info_init(); out
 *  @return MPS_E_ARG: an argument */
MPS_API mps_status mps_plugin_info_get(const mps_plugin_file *plugin, mps_plugin_info *info);

/** Set struct_size and zero. @param size  sizeof(mps_plugin_item) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_plugin_item_init(mps_plugin_item *item, size_t size);

/** Item of a plug-in. @param index  from 0
 *  @param item  initialised by mps_plugin_item_init(); out
 *  @return MPS_E_ARG: no such item; invalid `item` */
MPS_API mps_status mps_plugin_item_get(const mps_plugin_file *plugin, int32_t index,
                                       mps_plugin_item *item);

MPS_END_DECLS

#endif
