/* SPDX-License-Identifier: BSD-3-Clause */
/** @file mps.hpp  C++17 interface of libmps: RAII objects, exceptions with the text of the library,
 *  lambdas as callbacks, arrays as spans. All C functions can be used together with it: handle().
 *
 *      mps::config config;
 *      config.dp = 0.01;
 *      mps::simulation sim(config);
 *      mps::tank tank;
 *      tank.size[0] = 1.0, tank.size[1] = 0.6;
 *      sim.add(tank);
 *      sim.fill_level({0, 0}, {1.0, 0.3});
 *      sim.run(2.0, [](mps::simulation &s, const mps_step_info &info) { return info.t > 1.0; });
 *
 *  Objects of one simulation are used by one thread at a time. A probe, a lease, frames and each
 *  running call share the ownership of their simulation: it remains valid if its object is
 *  destroyed, moved or assigned, also by a callback. If its object is destroyed during a run, the
 *  run stops after the current step, and the simulation is destroyed when the call returns. A
 *  moved-from simulation is empty: its calls throw MPS_E_STATE. */
#ifndef MPS_HPP
#define MPS_HPP

#include <mps/model.h>
#include <mps/mps.h>

#include <array>
#include <cstddef>
#include <exception>
#include <functional>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace mps {

/** A call failed; the state is unchanged. what() is the text of the library. */
class error : public std::runtime_error {
  public:
    error(mps_status status, const std::string &text)
        : std::runtime_error(text.empty() ? mps_status_text(status) : text), status_(status)
    {
    }
    /** MPS_E_... */
    mps_status status() const noexcept { return status_; }
    /** "MPS_E_ARG", ... */
    const char *name() const noexcept { return mps_status_name(status_); }

  private:
    mps_status status_;
};

/** A C struct with its defaults. */
template <class T, mps_status (*init)(T *, std::size_t)> struct with_defaults : T {
    with_defaults() : T()
    {
        const mps_status status = init(this, sizeof(T));
        if (status < 0) throw error(status, "");
    }
};
using config = with_defaults<mps_config, mps_config_init>;
using phase = with_defaults<mps_phase, mps_phase_init>;
using solver_limits = with_defaults<mps_solver_limits, mps_solver_limits_init>;
using time_control = with_defaults<mps_time_control, mps_time_control_init>;
using step_info = with_defaults<mps_step_info, mps_step_info_init>;
using tank = with_defaults<mps_tank, mps_tank_init>;
using stl = with_defaults<mps_stl, mps_stl_init>;
using solid = with_defaults<mps_solid, mps_solid_init>;
using particle_block = with_defaults<mps_particle_block, mps_particle_block_init>;
using motion_state = with_defaults<mps_motion_state, mps_motion_state_init>;
using body = with_defaults<mps_body, mps_body_init>;
using body_report = with_defaults<mps_body_report, mps_body_report_init>;
using probe_definition = with_defaults<mps_probe, mps_probe_init>;
using probe_info = with_defaults<mps_probe_info, mps_probe_info_init>;
using energy = with_defaults<mps_energy, mps_energy_init>;
using momentum = with_defaults<mps_momentum, mps_momentum_init>;
using ship = with_defaults<mps_ship, mps_ship_init>;
using ship_motion = with_defaults<mps_ship_motion, mps_ship_motion_init>;

/** A non-owning span of numbers. */
template <class T> class span {
  public:
    span() = default;
    span(T *data, std::size_t size) : data_(data), size_(size) {}
    T *data() const noexcept { return data_; }
    std::size_t size() const noexcept { return size_; }
    bool empty() const noexcept { return size_ == 0; }
    T *begin() const noexcept { return data_; }
    T *end() const noexcept { return data_ + size_; }
    T &operator[](std::size_t k) const { return data_[k]; }

  private:
    T *data_ = nullptr;
    std::size_t size_ = 0;
};

/** A point or a vector: 2 or 3 numbers, padded with 0. */
struct point : std::array<double, 3> {
    point(std::initializer_list<double> values) : std::array<double, 3>{0, 0, 0}
    {
        if (values.size() > 3) throw error(MPS_E_ARG, "a point has at most 3 numbers");
        std::size_t k = 0;
        for (double v : values) (*this)[k++] = v;
    }
};

class simulation;

/** Shared ownership of a simulation by a probe, a lease or frames, so that it is destroyed after
 *  them. */
using keeper = std::shared_ptr<const void>;

/** An array of particles, without a copy. T: double (all fields of numbers), const int32_t ("kind",
 *  "phase", "part", "region", "plate"), const int64_t ("id"). Const T: for reading. Particles are
 *  not reordered until it is destroyed or end() is called; do not use the span after that. */
template <class T> class lease {
  public:
    using value = std::remove_const_t<T>;
    static_assert(std::is_same_v<value, double> || std::is_const_v<T>,
                  "fields of integers are for reading");

    /** @param keep  empty: the simulation must outlive the lease */
    lease(mps_sim *sim, const char *field, keeper keep = {});
    lease(const lease &) = delete;
    lease &operator=(const lease &) = delete;
    lease(lease &&other) noexcept
        : keep_(std::move(other.keep_)), sim_(std::exchange(other.sim_, nullptr)),
          lease_(std::exchange(other.lease_, mps_lease{}))
    {
    }
    lease &operator=(lease &&other) noexcept
    {
        keep_.swap(other.keep_);
        std::swap(sim_, other.sim_);
        std::swap(lease_, other.lease_);
        return *this;
    }
    /** Ends the lease; if end() would fail, the lease remains open without an exception. */
    ~lease()
    {
        if (sim_) mps_lease_end(sim_, &lease_);
    }
    /** End the lease; fails if a written value is not finite, and the lease remains open then. */
    void end();
    /** All numbers, particle by particle; empty after end(). */
    span<T> values() const
    {
        return {start(), static_cast<std::size_t>(lease_.count * lease_.stride)};
    }
    /** The numbers of particle i. */
    span<T> operator[](std::size_t i) const { return {start() + i * stride(), stride()}; }
    /** Number of particles. */
    std::size_t size() const noexcept { return static_cast<std::size_t>(lease_.count); }
    /** Numbers per particle. */
    std::size_t stride() const noexcept { return static_cast<std::size_t>(lease_.stride); }

  private:
    T *start() const noexcept
    {
        if constexpr (std::is_same_v<value, double>)
            return lease_.data;
        else if constexpr (std::is_same_v<value, int32_t>)
            return lease_.integers;
        else
            return lease_.ids;
    }
    keeper keep_;
    mps_sim *sim_;
    mps_lease lease_{};
};

/** A sensor of a simulation. */
class probe {
  public:
    /** @param keep  empty: the simulation must outlive the probe */
    probe(mps_sim *sim, int32_t id, keeper keep = {}) : keep_(std::move(keep)), sim_(sim), id_(id)
    {
    }
    int32_t id() const noexcept { return id_; }
    /** Current values. */
    std::vector<double> read() const;
    /** Properties of the probe. */
    probe_info info() const;
    /** Times and values [n * size] of its samples; valid until the next step. */
    std::pair<span<const double>, span<const double>> series() const;
    /** Remove it. */
    void remove() const;

  private:
    keeper keep_;
    mps_sim *sim_;
    int32_t id_;
};

/** A series of frames for ParaView. */
class frames {
  public:
    /** @param keep  empty: the simulation must outlive the frames */
    frames(mps_sim *sim, mps_frames *f, keeper keep = {})
        : keep_(std::move(keep)), sim_(sim), frames_(f)
    {
    }
    /** Write the current state. */
    void write();

  private:
    struct close {
        void operator()(mps_frames *f) const noexcept { mps_frames_close(f); }
    };
    keeper keep_;
    mps_sim *sim_;
    std::unique_ptr<mps_frames, close> frames_;
};

/** Throw the error of a failed call on a simulation. */
inline mps_status check(const mps_sim *sim, mps_status status)
{
    if (status < 0) throw error(status, sim ? mps_sim_error(sim) : "");
    return status;
}

/** A simulation. */
class simulation {
  public:
    /** Motion of the tank: sets value, rate, accel at a time. */
    using motion = std::function<void(double t, mps_motion_state &state)>;
    /** External load on a rigid body in addition to liquid, weight and springs: sets force and
     *  moment, 6 numbers, 0 on entry. */
    using body_load = std::function<void(double t, const mps_motion_state &state, double *load)>;
    /** Receives messages of the library. */
    using logger = std::function<void(int level, const std::string &text)>;

    /** @param preset  NULL: "imps" @param log  empty: none */
    explicit simulation(config c, const char *preset = nullptr, logger log = {});
    simulation(const simulation &) = delete;
    simulation &operator=(const simulation &) = delete;
    simulation(simulation &&other) noexcept : held_(std::move(other.held_)) { own(this); }
    simulation &operator=(simulation &&other) noexcept
    {
        if (this == &other) return *this;
        own(nullptr);
        held_ = std::move(other.held_);
        own(this);
        return *this;
    }
    ~simulation() { own(nullptr); }

    /** For C functions; NULL: moved-from. */
    mps_sim *handle() const noexcept { return held_ ? held_->sim : nullptr; }
    /** Throw the error of a C function, or the exception of a callback. */
    mps_status check(mps_status status) const { return in()(status); }

    int32_t dim() const;
    /** Spacing [m] */
    double dp() const;
    /** Time [s] */
    double time() const;
    int64_t steps() const;
    int64_t count(int32_t kind = -1) const { return mps_particles_count(in().kept->sim, kind); }

    void set(int32_t index, const mps_phase &p) { in()(mps_phase_set(handle(), index, &p)); }
    void set(const mps_time_control &c) { in()(mps_time_control_set(handle(), &c)); }
    void set(const mps_solver_limits &l) { in()(mps_solver_limits_set(handle(), &l)); }
    void set(const char *slot, const char *key, double value)
    {
        in()(mps_model_set(handle(), slot, key, value));
    }
    double get(const char *slot, const char *key) const;
    void use(const char *model) { in()(mps_model_use(handle(), model)); }
    /** Register a model of a plug-in and activate it.
     *  @param ops  its strings and tables must be valid as long as the simulation */
    void use(const mps_model_ops &ops);
    void remove(const char *slot) { in()(mps_model_remove(handle(), slot)); }
    void solver(const char *name, const char *preconditioner = nullptr)
    {
        in()(mps_solver_use(handle(), name, preconditioner));
    }

    /** @return size as built */
    std::array<double, 3> add(const mps_tank &t);
    void add(const mps_solid &s) { in()(mps_solid_add(handle(), &s)); }
    /** @return corners as built */
    std::array<double, 6> add(const std::string &path, const mps_stl &s);
    void baffle(const char *name, const point &lo, const point &hi)
    {
        in()(mps_baffle_add(handle(), name, lo.data(), hi.data(), nullptr));
    }
    /** A solid by its signed distance [m], double(const double *x), in the box of s.lo and s.hi. */
    template <class F> void add(solid s, F distance);
    /** @return particles added, as all fills */
    int64_t fill_box(const point &lo, const point &hi, int32_t index = 0);
    int64_t fill_level(const point &lo, const point &hi, int32_t index = 0);
    /** Fluid where bool(const double *x) is true. If it throws, no fluid is added. */
    template <class F> int64_t fill(F inside, int32_t index = 0);
    /** @return ids of the new particles */
    std::vector<int64_t> add(const mps_particle_block &block);
    void remove(const std::vector<int64_t> &ids)
    {
        in()(mps_particles_remove(handle(), static_cast<int64_t>(ids.size()), ids.data()));
    }

    void centre(const point &c, int32_t start = MPS_START_AT_REST)
    {
        in()(mps_motion_centre_set(handle(), c.data(), start));
    }
    void move(const std::vector<mps_harmonic> &harmonics);
    void move(motion function);
    motion_state pose() const;
    /** A rigid body carries the tank. @param load  empty: that of b */
    void carry(mps::body b, body_load load = {});
    /** The body in the last step. */
    mps::body_report body_report() const;

    mps::probe add(const mps_probe &definition);
    mps::energy energy() const;
    mps::momentum momentum() const;
    /** lease<const double>("position"), lease<double>("velocity") for writing */
    template <class T> mps::lease<T> lease(const char *field)
    {
        const call now = in();
        return mps::lease<T>(now.kept->sim, field, now.kept);
    }

    /** One step of at most dt_max [s]. */
    step_info step(double dt_max);
    /** Step until t_end.
     *  @param monitor  of (simulation &, const mps_step_info &), after each step. It returns a bool
     *                  or a number, where true stops the run, as in C; or void
     *  @return whether t_end was reached */
    template <class F> bool run(double t_end, F monitor);
    bool run(double t_end)
    {
        return run(t_end, [](simulation &, const mps_step_info &) {});
    }

    mps::frames frames(const std::string &folder, const std::string &name, int32_t kinds = 0);
    void checkpoint(const std::string &path) { in()(mps_checkpoint_write(handle(), path.c_str())); }
    void restore(const std::string &path) { in()(mps_checkpoint_read(handle(), path.c_str())); }

  private:
    /* A function of the user at a fixed address: the library has a pointer to it. */
    struct held;
    template <class F> struct bound {
        held *of;
        F function;
    };
    /* The C simulation and its callbacks. Shared by its object, its children and running calls. */
    struct held {
        explicit held(logger l) : log(std::move(l)) {}
        held(const held &) = delete;
        held &operator=(const held &) = delete;
        ~held() { mps_sim_destroy(sim); }
        mps_sim *sim = nullptr;
        simulation *owner = nullptr; /* NULL: destroyed or assigned */
        logger log;
        std::unique_ptr<bound<motion>> move;
        std::unique_ptr<bound<body_load>> load;
        std::exception_ptr failed;
    };
    /* A call, in()(mps_...(handle())): in() is evaluated first and shares the ownership. */
    struct call {
        std::shared_ptr<held> kept;
        mps_status operator()(mps_status status) const
        {
            if (kept->failed) std::rethrow_exception(std::exchange(kept->failed, nullptr));
            return mps::check(kept->sim, status);
        }
    };
    call in() const
    {
        if (!held_) throw error(MPS_E_STATE, "the simulation is empty: it was moved from");
        return {held_};
    }
    void own(simulation *owner) noexcept
    {
        if (held_) held_->owner = owner;
    }
    template <class F>
    static auto guarded(held *h, F call, decltype(call()) otherwise) -> decltype(call())
    {
        if (h->failed) return otherwise;
        try {
            return call();
        } catch (...) {
            h->failed = std::current_exception();
            return otherwise;
        }
    }
    template <class F> static bool stops(held *h, F &monitor, const mps_step_info &info);
    static int64_t newest(mps_sim *sim);
    static void remove_since(mps_sim *sim, int64_t first);
    std::shared_ptr<held> held_;
};

} // namespace mps

#include <mps/mps_inline.hpp>

#endif
