/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of mps/probe.h. */
#include "sim.h"
#include "world_ranks.h"
#include <string.h>

static const mps_probe probe_defaults = {.direction = {0, 1, 0}, .average = MPS_AVERAGE_AUTO};
static const mps_probe_info info_default = {.struct_size = sizeof(mps_probe_info)};
static const mps_energy energy_defaults = {0};
static const mps_momentum momentum_defaults = {0};

static mps_status find_probe(const mps_sim *sim, int32_t id, mps__probe **probe)
{
    MPS__CHECK(mps__sim_context(sim), id >= 0 && id < sim->probes.count,
               "probe %d: there are %lld, counted from 0", (int)id, (long long)sim->probes.count);
    MPS__CHECK(mps__sim_context(sim), !sim->probes.list[id].removed, "probe %d was removed",
               (int)id);
    *probe = &sim->probes.list[id];
    return MPS_OK;
}

mps_status mps_probe_init(mps_probe *probe, size_t size)
{
    return mps__struct_init("mps_probe", probe, size, &probe_defaults, sizeof probe_defaults);
}

mps_status mps_probe_add(mps_sim *sim, const mps_probe *probe, int32_t *id)
{
    MPS__SETS(sim);
    mps_probe p = probe_defaults;
    MPS__CHECK(&sim->context, id, "id is NULL");
    MPS__TRY(mps__struct_in(&sim->context, "mps_probe", &p, sizeof p, probe));
    const mps_status status = mps__probes_add(&sim->world, &sim->probes, &p, id);
    /* broadcast out of memory only: other errors occur on all ranks and need not end the run */
    return status == MPS_E_NOMEM ? mps__ranks_report(&sim->world.ranks, status) : status;
}

mps_status mps_probe_remove(mps_sim *sim, int32_t id)
{
    MPS__SETS(sim);
    mps__probe *probe = NULL;
    MPS__TRY(find_probe(sim, id, &probe));
    mps__probe_remove(&sim->context, probe);
    return MPS_OK;
}

mps_status mps_probe_info_init(mps_probe_info *info, size_t size)
{
    return mps__struct_init("mps_probe_info", info, size, &info_default, sizeof info_default);
}

mps_status mps_probe_info_get(const mps_sim *sim, int32_t id, mps_probe_info *info)
{
    mps__probe *p = NULL;
    if (!sim) return MPS_E_ARG;
    MPS__TRY(find_probe(sim, id, &p));
    const mps__particles *s = &sim->world.particles;
    /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): find_probe() sets it or fails below 0 */
    const bool sensor = p->config.type == MPS_PROBE_WALL_PRESSURE;
    const int32_t part = sensor ? p->sensor.face.part : -1;
    mps_probe_info found = {.struct_size = sizeof found,
                            .type = p->config.type,
                            .name = p->name,
                            .part = part >= 0 ? s->part_name[part] : p->part_name,
                            .diameter = p->config.diameter,
                            .values = mps__probe_values(&sim->world, p)};
    memcpy(found.at, p->config.at, sizeof found.at);
    if (sensor) memcpy(found.normal, p->sensor.face.normal, sizeof found.normal);
    return mps__struct_out(mps__sim_context(sim), "mps_probe_info", info, &found, sizeof found);
}

int32_t mps_probe_size(const mps_sim *sim, int32_t id)
{
    mps__probe *probe = NULL;
    if (!sim || find_probe(sim, id, &probe) < 0) return -1;
    return mps__probe_values(&sim->world, probe);
}

mps_status mps_probe_read(mps_sim *sim, int32_t id, double *values)
{
    MPS__MEASURES(sim);
    mps__probe *probe = NULL;
    MPS__CHECK(&sim->context, values, "values is NULL");
    MPS__TRY(find_probe(sim, id, &probe));
    const mps__lock before = mps__lock_set(&sim->context, MPS__LOCKED, "a kernel");
    const mps_status status = mps__probe_read(&sim->world, probe, values);
    sim->context.lock = before;
    return mps__ranks_report(&sim->world.ranks, status);
}

/* A probe that records samples; NULL: none, with the reason in the status. */
static mps__probe *find_series(mps_sim *sim, int32_t id, mps_status *status)
{
    mps__probe *probe = NULL;
    *status = find_probe(sim, id, &probe);
    if (*status < 0 || !probe) return NULL;
    if (probe->config.rate > 0) return probe;
    *status = mps__fail(&sim->context, MPS_E_STATE, "probe %d keeps no samples: its rate is 0",
                        (int)id);
    return NULL;
}

mps_status mps_probe_series(mps_sim *sim, int32_t id, int64_t *count, const double **t,
                            const double **values)
{
    MPS__MEASURES(sim);
    mps_status status;
    mps__probe *probe = find_series(sim, id, &status);
    if (!probe) return status;
    const mps__lock before = mps__lock_set(&sim->context, MPS__LOCKED, "a kernel");
    status = mps__probe_take(&sim->world, probe);
    sim->context.lock = before;
    MPS__TRY(mps__ranks_report(&sim->world.ranks, status));
    if (count) *count = probe->series.count;
    if (t) *t = probe->series.t;
    if (values) *values = probe->series.value;
    return MPS_OK;
}

mps_status mps_probe_series_clear(mps_sim *sim, int32_t id)
{
    MPS__READS(sim);
    mps_status status;
    mps__probe *probe = find_series(sim, id, &status);
    if (!probe) return status;
    probe->series.count = 0;
    probe->series.cuts++;
    return MPS_OK;
}

mps_status mps_energy_init(mps_energy *energy, size_t size)
{
    return mps__struct_init("mps_energy", energy, size, &energy_defaults, sizeof energy_defaults);
}

mps_status mps_energy_get(mps_sim *sim, mps_energy *energy)
{
    MPS__MEASURES(sim);
    mps_energy now;
    MPS__TRY(mps__ranks_report(&sim->world.ranks, mps__energy_measure(&sim->world, &now)));
    return mps__struct_out(&sim->context, "mps_energy", energy, &now, sizeof now);
}

mps_status mps_momentum_init(mps_momentum *momentum, size_t size)
{
    return mps__struct_init("mps_momentum", momentum, size, &momentum_defaults,
                            sizeof momentum_defaults);
}

mps_status mps_momentum_get(mps_sim *sim, mps_momentum *momentum)
{
    MPS__MEASURES(sim);
    mps_momentum now;
    MPS__TRY(mps__world_adopt(&sim->world));
    MPS__TRY(mps__momentum_measure(&sim->world, &now));
    MPS__TRY(mps__ranks_status(&sim->world.ranks));
    return mps__struct_out(&sim->context, "mps_momentum", momentum, &now, sizeof now);
}
