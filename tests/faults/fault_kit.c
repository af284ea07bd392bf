/* SPDX-License-Identifier: BSD-3-Clause */
#include "fault_kit.h"
#include "build.h"
#include "run.h"
#include "view.h"
#include <cairo.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <mps/mps.h>
#include <spawn.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include <zlib.h>

enum { PLACES = 4000 };

static struct {
    const void *caller;
    int32_t visits;
} seen[PLACES];
static int32_t places, chosen, wanted;
static bool armed;
static char failed[80];
extern char __executable_start; /* made by the linker */

int32_t fault_places(void)
{
    return places;
}

int32_t fault_visits(int32_t place)
{
    return place < places ? seen[place].visits : 0;
}

void fault_forget(void)
{
    places = 0;
}

void fault_arm(int32_t place, int32_t visit)
{
    for (int32_t k = 0; k < places; k++) seen[k].visits = 0;
    chosen = place;
    wanted = visit;
    failed[0] = '\0';
    armed = true;
}

const char *fault_disarm(void)
{
    armed = false;
    return failed[0] ? failed : NULL;
}

static bool fails(const char *name, const void *caller)
{
    int32_t k = 0;
    if (!armed) return false;
    while (k < places && seen[k].caller != caller) k++;
    if (k == PLACES) abort();
    if (k == places) seen[places++].caller = caller;
    if (++seen[k].visits != wanted || k != chosen) return false;
    snprintf(failed, sizeof failed, "%s at +0x%llx", name,
             (unsigned long long)((const char *)caller - &__executable_start));
    return true;
}

/* `after`: action instead of a failing call. */
#define FAULT_AFTER(type, name, parameters, arguments, number, result, after)           \
    type __real_##name parameters;                                                      \
    type __wrap_##name parameters;                                                      \
    type __wrap_##name parameters                                                       \
    {                                                                                   \
        if (!fails(#name, __builtin_return_address(0))) return __real_##name arguments; \
        after;                                                                          \
        errno = number;                                                                 \
        return result;                                                                  \
    }
#define FAULT(type, name, parameters, arguments, number, result) \
    FAULT_AFTER(type, name, parameters, arguments, number, result, (void)0)

/* ---- the system ---- */

FAULT(void *, malloc, (size_t size), (size), ENOMEM, NULL)
FAULT(void *, calloc, (size_t count, size_t size), (count, size), ENOMEM, NULL)
FAULT(void *, realloc, (void *block, size_t size), (block, size), ENOMEM, NULL)
FAULT(FILE *, fopen, (const char *path, const char *mode), (path, mode), EMFILE, NULL)
FAULT(FILE *, tmpfile, (void), (), EMFILE, NULL)
FAULT(FILE *, open_memstream, (char **text, size_t *size), (text, size), ENOMEM, NULL)
FAULT_AFTER(int, fclose, (FILE * file), (file), ENOSPC, EOF, __real_fclose(file))
FAULT(int, fflush, (FILE * file), (file), ENOSPC, EOF)
FAULT(int, ferror, (FILE * file), (file), EIO, 1)
FAULT(int, fseek, (FILE * file, long at, int from), (file, at, from), EIO, -1)
FAULT(long, ftell, (FILE * file), (file), EIO, -1)
FAULT(size_t, fread, (void *to, size_t size, size_t count, FILE *file), (to, size, count, file),
      EIO, 0)
/* ferror() is set afterwards: a file opened for reading cannot be written. */
FAULT_AFTER(char *, fgets, (char *line, int size, FILE *file), (line, size, file), EIO, NULL,
            fputc(0, file))
FAULT(int, ftruncate, (int file, off_t size), (file, size), EIO, -1)
FAULT(ssize_t, write, (int file, const void *from, size_t size), (file, from, size), ENOSPC, -1)
FAULT(int, fstat, (int file, struct stat *about), (file, about), EIO, -1)
FAULT(int, mkdir, (const char *path, mode_t mode), (path, mode), EROFS, -1)
FAULT(int, rename, (const char *from, const char *to), (from, to), EACCES, -1)
FAULT(DIR *, opendir, (const char *path), (path), EMFILE, NULL)
FAULT(char *, getcwd, (char *path, size_t size), (path, size), ENOENT, NULL)
FAULT(char *, strdup, (const char *text), (text), ENOMEM, NULL)
FAULT(char *, strndup, (const char *text, size_t size), (text, size), ENOMEM, NULL)
FAULT(int, uname, (struct utsname * host), (host), EIO, -1)
FAULT(struct tm *, gmtime_r, (const time_t *t, struct tm *out), (t, out), EOVERFLOW, NULL)
FAULT(ssize_t, read, (int file, void *to, size_t size), (file, to, size), EIO, -1)

/* ---- other programs and libraries ---- */

FAULT(int, socketpair, (int domain, int type, int protocol, int *both),
      (domain, type, protocol, both), EMFILE, -1)
FAULT(int, posix_spawn_file_actions_init, (posix_spawn_file_actions_t * actions), (actions), ENOMEM,
      ENOMEM)
FAULT(int, posix_spawn_file_actions_adddup2,
      (posix_spawn_file_actions_t * actions, int from, int to), (actions, from, to), ENOMEM, ENOMEM)
FAULT(int, posix_spawn_file_actions_addopen,
      (posix_spawn_file_actions_t * actions, int file, const char *path, int flags, mode_t mode),
      (actions, file, path, flags, mode), ENOMEM, ENOMEM)
FAULT(int, posix_spawnp,
      (pid_t * child, const char *path, const posix_spawn_file_actions_t *actions,
       const posix_spawnattr_t *attributes, char *const *argv, char *const *environment),
      (child, path, actions, attributes, argv, environment), EAGAIN, EAGAIN)
FAULT(ssize_t, send, (int file, const void *from, size_t size, int flags),
      (file, from, size, flags), EPIPE, -1)
FAULT_AFTER(pid_t, waitpid, (pid_t child, int *ended, int options), (child, ended, options), ECHILD,
            -1, __real_waitpid(child, ended, options))
FAULT(int, deflateInit_, (z_streamp stream, int level, const char *version, int size),
      (stream, level, version, size), ENOMEM, Z_MEM_ERROR)
FAULT(cairo_surface_t *, cairo_image_surface_create, (cairo_format_t format, int width, int height),
      (format, width, height), ENOMEM,
      __real_cairo_image_surface_create(CAIRO_FORMAT_INVALID, width, height))

cairo_status_t __real_cairo_surface_write_to_png_stream(cairo_surface_t *surface,
                                                        cairo_write_func_t put, void *file);
cairo_status_t __wrap_cairo_surface_write_to_png_stream(cairo_surface_t *surface,
                                                        cairo_write_func_t put, void *file);
/* Only the uppermost rows: compressing complete pictures takes two thirds of the time of these
 * tests, which do not read them. */
cairo_status_t __wrap_cairo_surface_write_to_png_stream(cairo_surface_t *surface,
                                                        cairo_write_func_t put, void *file)
{
    enum { ROWS = 16 };
    if (fails("cairo_surface_write_to_png_stream", __builtin_return_address(0)))
        return CAIRO_STATUS_NO_MEMORY;
    const int height = cairo_image_surface_get_height(surface);
    cairo_surface_t *top = cairo_image_surface_create_for_data(
        cairo_image_surface_get_data(surface), cairo_image_surface_get_format(surface),
        cairo_image_surface_get_width(surface), height < ROWS ? height : ROWS,
        cairo_image_surface_get_stride(surface));
    const cairo_status_t status = __real_cairo_surface_write_to_png_stream(top, put, file);
    cairo_surface_destroy(top);
    return status;
}

int __real_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...)
{
    va_list list;
    if (fails("open", __builtin_return_address(0))) {
        errno = EACCES;
        return -1;
    }
    va_start(list, flags);
    const mode_t mode = flags & O_CREAT ? va_arg(list, mode_t) : 0;
    va_end(list);
    return __real_open(path, flags, mode);
}

/* Without waiting for the disk: a run of these tests is not needed after a crash of the machine. */
int __wrap_fsync(int file);
int __wrap_fsync(int file)
{
    (void)file;
    if (!fails("fsync", __builtin_return_address(0))) return 0;
    errno = EIO;
    return -1;
}

/* ---- libmps_case ---- Memory of a case is allocated in blocks, so that malloc() is called at few
 * of the places that use it. */

FAULT_AFTER(void *, mps__case_take, (mps_case * c, size_t size), (c, size), ENOMEM, NULL,
            c->no_memory = true)
FAULT_AFTER(char *, mps__case_copy, (mps_case * c, const char *text, size_t length),
            (c, text, length), ENOMEM, NULL, c->no_memory = true)
FAULT_AFTER(tree_node *, mps__tree_new, (mps_case * c, tree_kind kind, mps__place at),
            (c, kind, at), ENOMEM, NULL, c->no_memory = true)
FAULT_AFTER(void *, mps__build_alloc, (build * b, size_t size), (b, size), ENOMEM, NULL,
            (b->c->no_memory = true, b->status = MPS_E_NOMEM))
FAULT(char *, mps__job_copy, (const char *text), (text), ENOMEM, NULL)
FAULT(void *, mps__grown, (void *array, int64_t count, size_t size), (array, count, size), ENOMEM,
      NULL)
FAULT_AFTER(bool, mps__view_open, (mps_sim * sim, view *v), (sim, v), ENOMEM, false,
            *v = (view){.x.struct_size = 0})

char *__wrap_mps__case_print(mps_case *c, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
char *__wrap_mps__case_print(mps_case *c, const char *format, ...)
{
    va_list list;
    char text[4000];
    if (fails("mps__case_print", __builtin_return_address(0))) {
        c->no_memory = true;
        return NULL;
    }
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    return __real_mps__case_copy(c, text, strlen(text));
}

/* ---- libmps ---- */

#define LIBRARY(name, parameters, arguments, status) \
    FAULT(mps_status, name, parameters, arguments, EIO, status)

LIBRARY(mps_lease_begin, (mps_sim * sim, const char *field, int32_t mode, mps_lease *lease),
        (sim, field, mode, lease), MPS_E_NOMEM)
LIBRARY(mps_motion_state_get, (const mps_sim *sim, mps_motion_state *state), (sim, state),
        MPS_E_STATE)
LIBRARY(mps_motion_to_lab, (const mps_sim *sim, const double *tank, double *lab, double *velocity),
        (sim, tank, lab, velocity), MPS_E_STATE)
LIBRARY(mps_energy_get, (mps_sim * sim, mps_energy *energy), (sim, energy), MPS_E_NOMEM)
LIBRARY(mps_momentum_get, (mps_sim * sim, mps_momentum *momentum), (sim, momentum), MPS_E_NOMEM)
LIBRARY(mps_frames_open,
        (mps_sim * sim, const char *path, const char *name, int32_t kinds, mps_frames **frames),
        (sim, path, name, kinds, frames), MPS_E_IO)
LIBRARY(mps_frames_write, (mps_frames * frames), (frames), MPS_E_IO)
LIBRARY(mps_checkpoint_read, (mps_sim * sim, const char *path), (sim, path), MPS_E_NOMEM)
LIBRARY(mps_checkpoint_write, (mps_sim * sim, const char *path), (sim, path), MPS_E_IO)
LIBRARY(mps_probe_read, (mps_sim * sim, int32_t id, double *values), (sim, id, values), MPS_E_NOMEM)
LIBRARY(mps_probe_add, (mps_sim * sim, const mps_probe *probe, int32_t *id), (sim, probe, id),
        MPS_E_NOMEM)
LIBRARY(mps_phase_get, (const mps_sim *sim, int32_t index, mps_phase *phase), (sim, index, phase),
        MPS_E_ARG)
LIBRARY(mps_phase_set, (mps_sim * sim, int32_t index, const mps_phase *phase), (sim, index, phase),
        MPS_E_NOMEM)
LIBRARY(mps_lattice_get, (const mps_sim *sim, double *lo, double *h), (sim, lo, h), MPS_E_STATE)
LIBRARY(mps_particles_add, (mps_sim * sim, const mps_particle_block *block, int64_t *ids),
        (sim, block, ids), MPS_E_NOMEM)
LIBRARY(mps_tension_set, (mps_sim * sim, int32_t a, int32_t b, double sigma), (sim, a, b, sigma),
        MPS_E_NOMEM)
LIBRARY(mps_tension_get, (const mps_sim *sim, int32_t a, int32_t b, double *sigma),
        (sim, a, b, sigma), MPS_E_STATE)
LIBRARY(mps_model_set, (mps_sim * sim, const char *slot, const char *key, double value),
        (sim, slot, key, value), MPS_E_NOMEM)
LIBRARY(mps_model_get, (const mps_sim *sim, const char *slot, const char *key, double *value),
        (sim, slot, key, value), MPS_E_NOMEM)
LIBRARY(mps_model_remove, (mps_sim * sim, const char *slot), (sim, slot), MPS_E_NOMEM)
LIBRARY(mps_preset_use, (mps_sim * sim, const char *name), (sim, name), MPS_E_NOMEM)
LIBRARY(mps_solver_use, (mps_sim * sim, const char *solver, const char *preconditioner),
        (sim, solver, preconditioner), MPS_E_NOMEM)
LIBRARY(mps_solver_limits_set, (mps_sim * sim, const mps_solver_limits *limits), (sim, limits),
        MPS_E_NOMEM)
LIBRARY(mps_tank_add, (mps_sim * sim, const mps_tank *tank, double *built), (sim, tank, built),
        MPS_E_NOMEM)
LIBRARY(mps_stl_add, (mps_sim * sim, const char *path, const mps_stl *stl, double *built),
        (sim, path, stl, built), MPS_E_NOMEM)
LIBRARY(mps_solid_add, (mps_sim * sim, const mps_solid *solid), (sim, solid), MPS_E_NOMEM)
LIBRARY(mps_plate_add,
        (mps_sim * sim, const char *name, const double *corner, const double *edge,
         const double *edge2),
        (sim, name, corner, edge, edge2), MPS_E_NOMEM)
LIBRARY(mps_fill_add,
        (mps_sim * sim, int32_t phase, mps_inside_fn inside, void *user, int64_t *added),
        (sim, phase, inside, user, added), MPS_E_NOMEM)
LIBRARY(mps_fill_box_add,
        (mps_sim * sim, int32_t phase, const double *lo, const double *hi, int64_t *added,
         double *built),
        (sim, phase, lo, hi, added, built), MPS_E_NOMEM)
LIBRARY(mps_fill_level_add,
        (mps_sim * sim, int32_t phase, const double *lo, const double *hi, int64_t *added,
         double *built),
        (sim, phase, lo, hi, added, built), MPS_E_NOMEM)
LIBRARY(mps_motion_table_set,
        (mps_sim * sim, int64_t rows, const double *t, int32_t dofs, const int32_t *dof,
         const double *values),
        (sim, rows, t, dofs, dof, values), MPS_E_NOMEM)
LIBRARY(mps_motion_centre_set, (mps_sim * sim, const double *centre, int32_t start),
        (sim, centre, start), MPS_E_NOMEM)
LIBRARY(mps_motion_callback_set, (mps_sim * sim, mps_motion_fn fn, void *user), (sim, fn, user),
        MPS_E_NOMEM)
LIBRARY(mps_time_control_set, (mps_sim * sim, const mps_time_control *control), (sim, control),
        MPS_E_NOMEM)
LIBRARY(mps_ship_load_from_lab,
        (const mps_ship *ship, const mps_motion_state *tank, int32_t axes, const double *at,
         const double *lab, double *load),
        (ship, tank, axes, at, lab, load), MPS_E_STATE)
LIBRARY(mps_sim_create, (const mps_config *config, mps_sim **sim), (config, sim), MPS_E_NOMEM)
LIBRARY(mps_pass_info_get, (mps_sim * sim, int32_t index, mps_pass_info *info), (sim, index, info),
        MPS_E_ARG)
LIBRARY(mps_run, (mps_sim * sim, double t_end, mps_monitor_fn monitor, void *user),
        (sim, t_end, monitor, user), MPS_E_NOMEM)
