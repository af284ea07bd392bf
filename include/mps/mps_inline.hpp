/* SPDX-License-Identifier: BSD-3-Clause */
/** @file mps_inline.hpp  Bodies of mps.hpp, which includes it. */
#ifndef MPS_INLINE_HPP
#define MPS_INLINE_HPP

#include <limits>

namespace mps {

template <class T> lease<T>::lease(mps_sim *sim, const char *field) : sim_(nullptr)
{
    mps::check(sim, mps_lease_init(&lease_, sizeof lease_));
    mps::check(sim,
               mps_lease_begin(sim, field, std::is_const_v<T> ? MPS_READ : MPS_WRITE, &lease_));
    sim_ = sim;
    if (start()) return;
    end();
    throw error(MPS_E_ARG, std::string("field '") + field + "' has numbers of another type");
}

template <class T> void lease<T>::end()
{
    if (!sim_) return;
    mps::check(sim_, mps_lease_end(sim_, &lease_));
    sim_ = nullptr;
}

inline std::vector<double> probe::read() const
{
    const int32_t size = mps_probe_size(sim_, id_);
    std::vector<double> values(size > 0 ? static_cast<std::size_t>(size) : 1);
    check(sim_, mps_probe_read(sim_, id_, values.data()));
    return values;
}

inline probe_info probe::info() const
{
    probe_info info;
    check(sim_, mps_probe_info_get(sim_, id_, &info));
    return info;
}

inline std::pair<span<const double>, span<const double>> probe::series() const
{
    int64_t count = 0;
    const double *t = nullptr, *values = nullptr;
    check(sim_, mps_probe_series(sim_, id_, &count, &t, &values));
    const auto n = static_cast<std::size_t>(count);
    return {{t, n}, {values, n * static_cast<std::size_t>(mps_probe_size(sim_, id_))}};
}

inline void probe::remove() const
{
    check(sim_, mps_probe_remove(sim_, id_));
}

inline void frames::write()
{
    check(sim_, mps_frames_write(frames_.get()));
}

inline simulation::simulation(config c, const char *preset, logger log)
    : calls_(new callbacks{std::move(log), {}, {}, {}})
{
    char text[1024] = "";
    mps_sim *made = nullptr;
    c.error = text;
    c.error_size = sizeof text;
    if (calls_->log) {
        c.log_user = calls_.get();
        c.log = [](void *user, int level, const char *message) {
            auto *calls = static_cast<callbacks *>(user);
            guarded(
                calls, [&] { return calls->log(level, message), 0; }, 0);
        };
    }
    const mps_status status = mps_sim_create(&c, &made);
    if (status < 0) throw error(status, text);
    sim_.reset(made);
    if (preset) check(mps_preset_use(made, preset));
}

inline mps_status simulation::check(mps_status status) const
{
    if (calls_->failed) std::rethrow_exception(std::exchange(calls_->failed, nullptr));
    return mps::check(handle(), status);
}

inline int32_t simulation::dim() const
{
    int32_t dim = 0;
    check(mps_sim_shape(handle(), &dim, nullptr));
    return dim;
}

inline double simulation::dp() const
{
    double dp = 0;
    check(mps_sim_shape(handle(), nullptr, &dp));
    return dp;
}

inline double simulation::time() const
{
    double t = 0;
    check(mps_sim_time(handle(), &t, nullptr));
    return t;
}

inline int64_t simulation::steps() const
{
    int64_t steps = 0;
    check(mps_sim_time(handle(), nullptr, &steps));
    return steps;
}

inline double simulation::get(const char *slot, const char *key) const
{
    double value = 0;
    check(mps_model_get(handle(), slot, key, &value));
    return value;
}

inline void simulation::use(const mps_model_ops &ops)
{
    check(mps_model_register(handle(), &ops));
    use(ops.name);
}

inline std::array<double, 3> simulation::add(const mps_tank &t)
{
    std::array<double, 3> built{};
    check(mps_tank_add(handle(), &t, built.data()));
    return built;
}

inline std::array<double, 6> simulation::add(const std::string &path, const mps_stl &s)
{
    std::array<double, 6> built{};
    check(mps_stl_add(handle(), path.c_str(), &s, built.data()));
    return built;
}

template <class F> void simulation::add(solid s, F distance)
{
    struct data {
        callbacks *calls;
        F *distance;
    } user{calls_.get(), &distance};
    s.user = &user;
    s.distance = [](void *u, const double *x) -> double {
        auto *d = static_cast<data *>(u);
        return guarded(
            d->calls, [&] { return static_cast<double>((*d->distance)(x)); },
            std::numeric_limits<double>::quiet_NaN());
    };
    check(mps_solid_add(handle(), &s));
}

inline int64_t simulation::fill_box(const point &lo, const point &hi, int32_t index)
{
    int64_t added = 0;
    check(mps_fill_box_add(handle(), index, lo.data(), hi.data(), &added, nullptr));
    return added;
}

inline int64_t simulation::fill_level(const point &lo, const point &hi, int32_t index)
{
    int64_t added = 0;
    check(mps_fill_level_add(handle(), index, lo.data(), hi.data(), &added, nullptr));
    return added;
}

template <class F> int64_t simulation::fill(F inside, int32_t index)
{
    struct data {
        callbacks *calls;
        F *inside;
    } user{calls_.get(), &inside};
    int64_t added = 0;
    const int64_t first = newest();
    const mps_status status = mps_fill_add(
        handle(), index,
        [](void *u, const double *x) -> int {
            auto *d = static_cast<data *>(u);
            return guarded(
                d->calls, [&] { return static_cast<int>((*d->inside)(x) ? 1 : 0); }, 0);
        },
        &user, &added);
    if (calls_->failed && status >= 0) remove_since(first);
    check(status);
    return added;
}

inline int64_t simulation::newest() const
{
    int64_t last = -1;
    if (count() <= 0) return last;
    for (int64_t id : mps::lease<const int64_t>(handle(), "id").values())
        if (id > last) last = id;
    return last;
}

inline void simulation::remove_since(int64_t first)
{
    std::vector<int64_t> ids;
    for (int64_t id : mps::lease<const int64_t>(handle(), "id").values())
        if (id > first) ids.push_back(id);
    if (!ids.empty()) mps_particles_remove(handle(), static_cast<int64_t>(ids.size()), ids.data());
}

inline std::vector<int64_t> simulation::add(const mps_particle_block &block)
{
    std::vector<int64_t> ids(block.count > 0 ? static_cast<std::size_t>(block.count) : 0);
    check(mps_particles_add(handle(), &block, ids.data()));
    return ids;
}

inline void simulation::move(const std::vector<mps_harmonic> &harmonics)
{
    check(mps_motion_harmonics_set(handle(), static_cast<int32_t>(harmonics.size()),
                                   harmonics.data()));
}

inline void simulation::move(motion function)
{
    motion before = std::exchange(calls_->move, std::move(function));
    const mps_status status = mps_motion_callback_set(
        handle(),
        [](void *user, double t, mps_motion_state *state) -> int {
            auto *calls = static_cast<callbacks *>(user);
            return guarded(
                calls, [&] { return calls->move(t, *state), 0; }, 1);
        },
        calls_.get());
    if (status < 0) calls_->move = std::move(before);
    check(status);
}

inline motion_state simulation::pose() const
{
    motion_state state;
    check(mps_motion_state_get(handle(), &state));
    return state;
}

inline void simulation::carry(mps::body b, body_load load)
{
    body_load before = std::exchange(calls_->load, std::move(load));
    if (calls_->load) {
        b.user = calls_.get();
        b.load = [](void *user, double t, const mps_motion_state *state, double *out) -> int {
            auto *calls = static_cast<callbacks *>(user);
            return guarded(
                calls, [&] { return calls->load(t, *state, out), 0; }, 1);
        };
    }
    const mps_status status = mps_body_set(handle(), &b);
    if (status < 0) calls_->load = std::move(before);
    check(status);
}

inline mps::body_report simulation::body_report() const
{
    mps::body_report report;
    check(mps_body_get(handle(), &report));
    return report;
}

inline mps::probe simulation::add(const mps_probe &definition)
{
    int32_t id = -1;
    check(mps_probe_add(handle(), &definition, &id));
    return {handle(), id};
}

inline mps::energy simulation::energy() const
{
    mps::energy e;
    check(mps_energy_get(handle(), &e));
    return e;
}

inline mps::momentum simulation::momentum() const
{
    mps::momentum m;
    check(mps_momentum_get(handle(), &m));
    return m;
}

inline step_info simulation::step(double dt_max)
{
    step_info info;
    check(mps_step(handle(), dt_max, &info));
    return info;
}

template <class F> bool simulation::run(double t_end, F monitor)
{
    struct data {
        simulation *self;
        F *monitor;
    } user{this, &monitor};
    const mps_status status = mps_run(
        handle(), t_end,
        [](void *u, mps_sim *, const mps_step_info *info) -> int {
            auto *d = static_cast<data *>(u);
            return guarded(
                d->self->calls_.get(),
                [&] { return static_cast<int>((*d->monitor)(*d->self, *info) ? 0 : 1); }, 1);
        },
        &user);
    return check(status) != MPS_W_STOPPED;
}

inline mps::frames simulation::frames(const std::string &folder, const std::string &name,
                                      int32_t kinds)
{
    mps_frames *made = nullptr;
    check(mps_frames_open(handle(), folder.c_str(), name.c_str(), kinds, &made));
    return {handle(), made};
}

} // namespace mps

#endif
