/* SPDX-License-Identifier: BSD-3-Clause */
/* Structs of the public interface. */
#include "base.h"
#include <mps/device.h>
#include <mps/list.h>
#include <mps/model.h>
#include <mps/mps.h>
#include <mps/ppe.h>
#include <mps/voids.h>
#include <stddef.h>
#include <string.h>

enum { MPS__VERSIONS = 4 };

typedef struct known_struct {
    const char *type;
    /* ascending, of the versions that changed it; the last is the current one */
    size_t size[MPS__VERSIONS];
} known_struct;

/* 1.0.0 is the first version. A struct that grows gets a second size, e.g.
 *     {"mps_tank", {offsetof(mps_tank, first_new_member), sizeof(mps_tank)}}. */
/* clang-format off */
#define V1(type) {#type, {sizeof(type)}}
#define V2(type, second) {#type, {offsetof(type, second), sizeof(type)}}
/* clang-format on */
static const known_struct structs[] = {
    V1(mps_channel_info),
    V1(mps_config),
    V1(mps_device_info),
    V1(mps_device_ops),
    V1(mps_flux),
    V1(mps_grid),
    V1(mps_kernel),
    V1(mps_lease),
    V1(mps_load),
    V1(mps_model_info),
    V1(mps_model_ops),
    V1(mps_motion_pose),
    V1(mps_motion_state),
    V1(mps_name_info),
    V1(mps_parallel),
    V1(mps_particle_block),
    V1(mps_pass_info),
    V1(mps_phase),
    V1(mps_ppe_problem),
    V1(mps_ppe_result),
    V1(mps_preconditioner_ops),
    V1(mps_probe),
    V1(mps_probe_info),
    V1(mps_ranks_ops),
    V1(mps_setting_info),
    V1(mps_ship),
    V1(mps_ship_motion),
    V1(mps_solid),
    V1(mps_solver_limits),
    V1(mps_solver_ops),
    V1(mps_stage),
    V1(mps_stencil),
    V1(mps_stl),
    V1(mps_tank),
    V1(mps_time_control),
    V1(mps_verb_info),
    V1(mps_voids),
    V1(mps_voids_config),
    V2(mps_body, friction),
    V2(mps_body_report, friction),
    V2(mps_energy, friction),
    V2(mps_momentum, friction),
    V2(mps_step_info, pockets),
    V2(mps_view, fastest),
};
#undef V1
#undef V2

/* Sizes of a type, NULL if it is not in the table. */
static const size_t *sizes_of(const char *type)
{
    for (size_t k = 0; k < sizeof structs / sizeof structs[0]; k++)
        if (strcmp(structs[k].type, type) == 0) return structs[k].size;
    return NULL;
}

/* No version will have larger structs [bytes]. An uninitialised size is usually larger, and all
 * bytes up to a size are read. */
static const size_t LARGEST = 4096;

/* Whether this is the size of a version, or larger than the current one (a newer version). Other
 * sizes end before the first version's members, or cut one. */
static bool is_size(const size_t *size, size_t given)
{
    int last = 0;
    for (; last < MPS__VERSIONS && size[last]; last++)
        if (given == size[last]) return true;
    return given > size[last - 1] && given <= LARGEST;
}

mps_status mps__struct_check(mps__context *c, const char *type, const void *given)
{
    const size_t *size = sizes_of(type);
    uint32_t bytes;
    MPS__CHECK(c, given, "%s is NULL", type);
    memcpy(&bytes, given, sizeof bytes);
    if (size && is_size(size, bytes)) return MPS_OK;
    if (strstr(type, "_ops")) /* plug-in tables have no _init function */
        return mps__fail(c, MPS_E_ARG,
                         "%s.struct_size is %u: set it to sizeof(%s); version 1.0.0 has %zu", type,
                         bytes, type, size ? size[0] : 0);
    return mps__fail(c, MPS_E_ARG,
                     "%s.struct_size is %u: call %s_init() first; version 1.0.0 has %zu", type,
                     bytes, type, size ? size[0] : 0);
}

mps_status mps__struct_in(mps__context *c, const char *type, void *out, size_t size, const void *in)
{
    uint32_t given;
    MPS__TRY(mps__struct_check(c, type, in));
    memcpy(&given, in, sizeof given);
    const unsigned char *bytes = in;
    for (size_t k = size; k < given; k++)
        if (bytes[k])
            return mps__fail(c, MPS_E_VERSION,
                             "%s of %u bytes comes from a newer version and uses its entries; this "
                             "one knows %zu",
                             type, given, size);
    memcpy(out, in, given < size ? given : size);
    return MPS_OK;
}

mps_status mps__struct_out(mps__context *c, const char *type, void *out, const void *in,
                           size_t size)
{
    uint32_t given;
    MPS__TRY(mps__struct_check(c, type, out));
    memcpy(&given, out, sizeof given);
    memcpy(out, in, given < size ? given : size);
    memcpy(out, &given, sizeof given);
    return MPS_OK;
}

mps_status mps__struct_init(const char *type, void *out, size_t size, const void *defaults,
                            size_t full)
{
    const size_t *sizes = sizes_of(type);
    if (!out || !sizes || !is_size(sizes, size) || size > UINT32_MAX) return MPS_E_ARG;
    const uint32_t given = (uint32_t)size;
    memset(out, 0, size);
    memcpy(out, defaults, size < full ? size : full);
    memcpy(out, &given, sizeof given);
    return MPS_OK;
}
