/* SPDX-License-Identifier: BSD-3-Clause */
/** @file mps_inline.hpp  Definitions of the functions of mps.hpp, which includes it. */
#ifndef MPS_INLINE_HPP
#define MPS_INLINE_HPP

#include <limits>

namespace mps {

template <class T>
lease<T>::lease(mps_sim *sim, const char *field, keeper keep)
    : keep_(std::move(keep)), sim_(nullptr)
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
    lease_ = mps_lease{};
    keep_.reset();
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
    : held_(std::make_shared<held>(std::move(log)))
{
    char text[1024] = "";
    c.error = text;
    c.error_size = sizeof text;
    if (held_->log) {
        c.log_user = held_.get();
        c.log = [](void *user, int level, const char *message) {
            auto *h = static_cast<held *>(user);
            guarded(
                h, [&] { return h->log(level, message), 0; }, 0);
        };
    }
    const mps_status status = mps_sim_create(&c, &held_->sim);
    if (status < 0) throw error(status, text);
    own(this);
    if (preset) in()(mps_preset_use(handle(), preset));
}

inline int32_t simulation::dim() const
{
    int32_t dim = 0;
    in()(mps_sim_shape(handle(), &dim, nullptr));
    return dim;
}

inline double simulation::dp() const
{
    double dp = 0;
    in()(mps_sim_shape(handle(), nullptr, &dp));
    return dp;
}

inline double simulation::time() const
{
    double t = 0;
    in()(mps_sim_time(handle(), &t, nullptr));
    return t;
}

inline int64_t simulation::steps() const
{
    int64_t steps = 0;
    in()(mps_sim_time(handle(), nullptr, &steps));
    return steps;
}

inline double simulation::get(const char *slot, const char *key) const
{
    double value = 0;
    in()(mps_model_get(handle(), slot, key, &value));
    return value;
}

inline void simulation::use(const mps_model_ops &ops)
{
    in()(mps_model_register(handle(), &ops));
    use(ops.name);
}

inline std::array<double, 3> simulation::add(const mps_tank &t)
{
    std::array<double, 3> built{};
    in()(mps_tank_add(handle(), &t, built.data()));
    return built;
}

inline std::array<double, 6> simulation::add(const std::string &path, const mps_stl &s)
{
    std::array<double, 6> built{};
    in()(mps_stl_add(handle(), path.c_str(), &s, built.data()));
    return built;
}

template <class F> void simulation::add(solid s, F distance)
{
    const call now = in();
    bound<F &> user{now.kept.get(), distance};
    s.user = &user;
    s.distance = [](void *u, const double *x) -> double {
        auto *d = static_cast<bound<F &> *>(u);
        return guarded(
            d->of, [&] { return static_cast<double>(d->function(x)); },
            std::numeric_limits<double>::quiet_NaN());
    };
    now(mps_solid_add(now.kept->sim, &s));
}

inline int64_t simulation::fill_box(const point &lo, const point &hi, int32_t index)
{
    int64_t added = 0;
    in()(mps_fill_box_add(handle(), index, lo.data(), hi.data(), &added, nullptr));
    return added;
}

inline int64_t simulation::fill_level(const point &lo, const point &hi, int32_t index)
{
    int64_t added = 0;
    in()(mps_fill_level_add(handle(), index, lo.data(), hi.data(), &added, nullptr));
    return added;
}

template <class F> int64_t simulation::fill(F inside, int32_t index)
{
    const call now = in();
    bound<F &> user{now.kept.get(), inside};
    int64_t added = 0;
    const int64_t first = newest(now.kept->sim);
    const mps_status status = mps_fill_add(
        now.kept->sim, index,
        [](void *u, const double *x) -> int {
            auto *d = static_cast<bound<F &> *>(u);
            return guarded(
                d->of, [&] { return static_cast<int>(d->function(x) ? 1 : 0); }, 0);
        },
        &user, &added);
    if (now.kept->failed && status >= 0) remove_since(now.kept->sim, first);
    now(status);
    return added;
}

inline int64_t simulation::newest(mps_sim *sim)
{
    int64_t last = -1;
    if (mps_particles_count(sim, -1) <= 0) return last;
    for (int64_t id : mps::lease<const int64_t>(sim, "id").values())
        if (id > last) last = id;
    return last;
}

inline void simulation::remove_since(mps_sim *sim, int64_t first)
{
    std::vector<int64_t> ids;
    for (int64_t id : mps::lease<const int64_t>(sim, "id").values())
        if (id > first) ids.push_back(id);
    if (!ids.empty()) mps_particles_remove(sim, static_cast<int64_t>(ids.size()), ids.data());
}

inline std::vector<int64_t> simulation::add(const mps_particle_block &block)
{
    std::vector<int64_t> ids(block.count > 0 ? static_cast<std::size_t>(block.count) : 0);
    in()(mps_particles_add(handle(), &block, ids.data()));
    return ids;
}

inline void simulation::move(const std::vector<mps_harmonic> &harmonics)
{
    in()(mps_motion_harmonics_set(handle(), static_cast<int32_t>(harmonics.size()),
                                  harmonics.data()));
}

inline void simulation::move(motion function)
{
    const call now = in();
    auto fresh = std::make_unique<bound<motion>>(
        bound<motion>{now.kept.get(), std::move(function)});
    now(mps_motion_callback_set(
        now.kept->sim,
        [](void *user, double t, mps_motion_state *state) -> int {
            auto *b = static_cast<bound<motion> *>(user);
            return guarded(
                b->of, [&] { return b->function(t, *state), 0; }, 1);
        },
        fresh.get()));
    now.kept->move = std::move(fresh);
}

inline motion_state simulation::pose() const
{
    motion_state state;
    in()(mps_motion_state_get(handle(), &state));
    return state;
}

inline void simulation::carry(mps::body b, body_load load)
{
    const call now = in();
    std::unique_ptr<bound<body_load>> fresh;
    if (load) {
        fresh = std::make_unique<bound<body_load>>(
            bound<body_load>{now.kept.get(), std::move(load)});
        b.user = fresh.get();
        b.load = [](void *user, double t, const mps_motion_state *state, double *out) -> int {
            auto *of = static_cast<bound<body_load> *>(user);
            return guarded(
                of->of, [&] { return of->function(t, *state, out), 0; }, 1);
        };
    }
    now(mps_body_set(now.kept->sim, &b));
    now.kept->load = std::move(fresh);
}

inline mps::body_report simulation::body_report() const
{
    mps::body_report report;
    in()(mps_body_get(handle(), &report));
    return report;
}

inline mps::probe simulation::add(const mps_probe &definition)
{
    const call now = in();
    int32_t id = -1;
    now(mps_probe_add(now.kept->sim, &definition, &id));
    return {now.kept->sim, id, now.kept};
}

inline mps::energy simulation::energy() const
{
    mps::energy e;
    in()(mps_energy_get(handle(), &e));
    return e;
}

inline mps::momentum simulation::momentum() const
{
    mps::momentum m;
    in()(mps_momentum_get(handle(), &m));
    return m;
}

inline step_info simulation::step(double dt_max)
{
    step_info info;
    in()(mps_step(handle(), dt_max, &info));
    return info;
}

template <class F> bool simulation::stops(held *h, F &monitor, const mps_step_info &info)
{
    using result = decltype(monitor(*h->owner, info));
    bool stop = false;
    if (!h->owner) return true;
    if constexpr (std::is_void_v<result>)
        monitor(*h->owner, info);
    else
        stop = static_cast<bool>(monitor(*h->owner, info));
    return stop || !h->owner;
}

template <class F> bool simulation::run(double t_end, F monitor)
{
    const call now = in();
    bound<F &> user{now.kept.get(), monitor};
    return now(mps_run(
               now.kept->sim, t_end,
               [](void *u, mps_sim *, const mps_step_info *info) -> int {
                   auto *d = static_cast<bound<F &> *>(u);
                   return guarded(
                       d->of, [&] { return stops(d->of, d->function, *info) ? 1 : 0; }, 1);
               },
               &user)) != MPS_W_STOPPED;
}

inline mps::frames simulation::frames(const std::string &folder, const std::string &name,
                                      int32_t kinds)
{
    const call now = in();
    mps_frames *made = nullptr;
    now(mps_frames_open(now.kept->sim, folder.c_str(), name.c_str(), kinds, &made));
    return {now.kept->sim, made, now.kept};
}

} // namespace mps

#endif
