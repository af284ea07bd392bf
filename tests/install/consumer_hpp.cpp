// SPDX-License-Identifier: BSD-3-Clause
// mps.hpp in a program of a user: values, exceptions, callbacks that throw, lifetimes of objects.
#include <mps/mps.hpp>
#include <mps/mps.hpp>

#include <cmath>
#include <cstdio>

static int failures;
#define CHECK(what) \
    ((what) ? (void)0 : (std::printf("%d: %s\n", __LINE__, #what), (void)failures++))

template <class E, class F> static bool throws(F f, const char *part = "")
{
    try {
        f();
    } catch (const E &e) {
        return std::string(e.what()).find(part) != std::string::npos;
    }
    return false;
}

static mps::simulation still()
{
    mps::config config;
    config.dp = 0.05;
    mps::simulation sim(config);
    mps::tank tank;
    tank.size[0] = 1.0;
    tank.size[1] = 0.6;
    CHECK(std::fabs(sim.add(tank)[0] - 1.0) < 1e-12);
    CHECK(sim.fill_level({0, 0}, {1.0, 0.3}) == sim.count(MPS_FLUID));
    return sim;
}

static void values()
{
    mps::simulation sim = still();
    mps::probe_definition p;
    p.at[1] = 0.1;
    p.average = 0;
    p.rate = 200;
    const mps::probe wall = sim.add(p);
    CHECK(sim.run(0.2));
    CHECK(std::fabs(sim.time() - 0.2) < 1e-12 && sim.dim() == 2 && sim.steps() > 0);
    CHECK(std::fabs(wall.read().at(0) / 1962 - 1) < 0.02);
    CHECK(wall.series().first.size() == 41 && wall.series().second.size() == 41);
    CHECK(std::string(wall.info().part) == "tank.x0");
    CHECK(std::fabs(sim.energy().mass_filled / 300 - 1) < 0.03 &&
          std::fabs(sim.momentum().total[1]) < 1);
    wall.remove();
    CHECK(throws<mps::error>([&] { wall.read(); }));
    mps::phase oil;
    oil.density = 900;
    sim.set(1, oil);
    sim.set("collision", "distance", sim.get("collision", "distance"));
    sim.solver("sundials.bicgstab", "jacobi");
    CHECK(sim.step(1.0).ppe_iterations > 0);
}

static void arrays()
{
    mps::simulation sim = still();
    {
        auto u = sim.lease<double>("velocity");
        CHECK(u.stride() == 2 && u.size() == static_cast<std::size_t>(sim.count()));
        CHECK(throws<mps::error>([&] { sim.step(1.0); }));
        for (double &v : u.values()) v = 0.5;
        auto moved = std::move(u);
        moved.end();
    }
    CHECK(sim.lease<const double>("velocity")[0][1] == 0.5);
    {
        auto u = sim.lease<double>("velocity");
        u[0][0] = NAN;
        CHECK(throws<mps::error>([&] { u.end(); }, "finite"));
        u[0][0] = 0;
        u.end();
    }
    CHECK(throws<mps::error>([&] { sim.lease<const int32_t>("position"); }, "another type"));
    CHECK(throws<mps::error>([&] { sim.lease<const double>("colour"); }, "colour"));
    mps::particle_block block;
    const double x[] = {0.3, 0.5, 0.4, 0.5};
    block.count = 2;
    block.position = x;
    const int64_t n = sim.count();
    const std::vector<int64_t> ids = sim.add(block);
    CHECK(ids.size() == 2 && sim.count() == n + 2);
    sim.remove(ids);
    CHECK(sim.count() == n);
}

static void callbacks()
{
    mps::simulation sim = still();
    CHECK(!sim.run(1.0, [](mps::simulation &s, const mps_step_info &) { return s.steps() >= 3; }));
    CHECK(sim.steps() == 3);
    CHECK(throws<std::runtime_error>(
        [&] {
            sim.run(1.0, [](mps::simulation &, const mps_step_info &) -> bool {
                throw std::runtime_error("mine");
            });
        },
        "mine"));
    CHECK(sim.steps() == 4);
    double calls = 0;
    sim.move([&calls](double t, mps_motion_state &s) {
        if (t > 0.3) throw std::out_of_range("too late");
        calls++;
        s.value[MPS_MOVE_X] = 0.01 * t * t, s.rate[MPS_MOVE_X] = 0.02 * t,
        s.accel[MPS_MOVE_X] = 0.02;
    });
    mps::simulation moved = std::move(sim); // callbacks go along
    CHECK(throws<std::out_of_range>([&] { moved.run(0.5); }, "too late"));
    CHECK(calls > 1 && moved.time() > 0.05 && moved.time() <= 0.3);
    CHECK(moved.pose().value[MPS_MOVE_X] > 0);
    const int64_t n = moved.count();
    mps::simulation other = still();
    CHECK(throws<std::domain_error>(
        [&] {
            other.fill([](const double *x) -> bool {
                return x[1] > 0.5 ? throw std::domain_error("no") : true;
            });
        },
        "no"));
    CHECK(other.count() == n);
    mps::solid ball;
    ball.name = "ball";
    for (int d = 0; d < 2; d++) ball.lo[d] = 0.2, ball.hi[d] = 0.8;
    mps::config config;
    config.dp = 0.05;
    std::string said;
    mps::simulation solid(config, nullptr, [&said](int, const std::string &text) { said += text; });
    mps::tank tank;
    tank.size[0] = tank.size[1] = 1.02;
    solid.add(tank);
    CHECK(said.find("dp") != std::string::npos);
    solid.add(ball, [](const double *x) { return std::hypot(x[0] - 0.5, x[1] - 0.5) - 0.2; });
    CHECK(throws<std::domain_error>(
        [&] { solid.add(ball, [](const double *) -> double { throw std::domain_error("no"); }); }));
    CHECK(solid.fill([](const double *x) { return x[1] < 0.2; }) > 0);
}

// A rigid body of 100 kg/m under a force of 100 N/m along x: less than 1 m/s2, because of the added
// mass.
static void bodies()
{
    mps::simulation sim = still();
    mps::body box;
    box.free = MPS_BODY_FREE(MPS_MOVE_X);
    box.mass = 100;
    sim.carry(box, [](double, const mps_motion_state &, double *load) { load[0] = 100; });
    CHECK(sim.run(0.02));
    const mps::body_report r = sim.body_report();
    CHECK(r.acceleration[0] > 0.2 && r.acceleration[0] < 0.9 && r.external[0] == 100);
    CHECK(std::fabs(100 * r.acceleration[0] - 100 - r.liquid[0]) < 1e-6);
    mps::simulation moved = std::move(sim); // callbacks go along
    moved.carry(box, [](double, const mps_motion_state &, double *) {
        throw std::out_of_range("no more");
    });
    CHECK(throws<std::out_of_range>([&] { moved.step(1.0); }, "no more"));
    box.mass = -1;
    CHECK(throws<mps::error>([&] { moved.carry(box); }, "mass"));
}

// Objects after their simulation was destroyed, assigned or moved, within each kind of callback and
// after calls.
static void lifetimes()
{
    mps::simulation *owned = new mps::simulation(still());
    mps::probe_definition p;
    p.at[1] = 0.1;
    const mps::probe wall = owned->add(p);
    mps::frames frames = owned->frames(".", "lifetimes", 0);
    auto velocity = owned->lease<const double>("velocity");
    delete owned; // children keep it
    CHECK(velocity.size() > 0 && velocity[0][0] == 0);
    velocity.end();
    CHECK(velocity.size() == 0 && velocity.values().empty());
    CHECK(wall.read().size() == 1);
    frames.write();

    // the object of the run is assigned in its monitor: the run stops, and the old simulation is
    // destroyed
    owned = new mps::simulation(still());
    CHECK(!owned->run(1.0, [&](mps::simulation &, const mps_step_info &) { delete owned; }));
    mps::simulation sim = still();
    CHECK(!sim.run(1.0, [&](mps::simulation &, const mps_step_info &) { sim = still(); }));
    CHECK(sim.steps() == 0 && sim.run(0.01));
    mps::simulation elsewhere = still();
    CHECK(sim.run(0.02, [&](mps::simulation &s, const mps_step_info &) {
        if (&s == &sim) elsewhere = std::move(sim);
    }));
    CHECK(std::fabs(elsewhere.time() - 0.02) < 1e-12);

    // moved from: each call fails with an error
    CHECK(!sim.handle());
    CHECK(throws<mps::error>([&] { sim.step(1.0); }, "empty"));
    CHECK(throws<mps::error>([&] { sim.run(1.0); }, "empty"));
    CHECK(throws<mps::error>([&] { sim.count(); }, "empty"));
    CHECK(throws<mps::error>([&] { sim.time(); }, "empty"));
    CHECK(throws<mps::error>([&] { sim.lease<const double>("velocity"); }, "empty"));
    CHECK(throws<mps::error>([&] { sim.frames(".", "x"); }, "empty"));
    CHECK(throws<mps::error>([&] { sim.add(p); }, "empty"));
    CHECK(throws<mps::error>([&] { sim.move(mps::simulation::motion()); }, "empty"));
    CHECK(throws<mps::error>([&] { sim.carry(mps::body()); }, "empty"));
    CHECK(throws<mps::error>([&] { sim.fill([](const double *) { return true; }); }, "empty"));
    CHECK(throws<mps::error>([&] { sim.fill_box({0, 0}, {1, 1}); }, "empty"));
    CHECK(throws<mps::error>([&] { sim.check(mps_threads_set(sim.handle(), 2)); }, "empty"));
    sim = still();
    CHECK(sim.steps() == 0);

    // in a motion, a load of a body, a fill, a solid, a log
    sim.move([&](double t, mps_motion_state &) {
        if (t > 0.01) sim = still();
    });
    CHECK(!sim.run(1.0) && sim.steps() == 0 && sim.run(0.01));
    mps::body box;
    box.free = MPS_BODY_FREE(MPS_MOVE_X);
    box.mass = 100;
    sim = still();
    sim.carry(box, [&](double, const mps_motion_state &, double *) { sim = still(); });
    sim.step(1.0);
    CHECK(sim.steps() == 0);
    mps::simulation filled = still();
    CHECK(throws<mps::error>([&] {
        filled.fill([&](const double *) {
            filled = still();
            return false;
        });
    }));
    mps::config config;
    config.dp = 0.05;
    mps::simulation logged(config, nullptr, [&](int, const std::string &) { logged = still(); });
    mps::tank tank;
    tank.size[0] = tank.size[1] = 1.02;
    logged.add(tank);
    CHECK(logged.count(MPS_FLUID) > 0);
    mps::solid ball;
    ball.name = "ball";
    for (int d = 0; d < 2; d++) ball.lo[d] = 0.2, ball.hi[d] = 0.8;
    mps::simulation solid(config);
    solid.add(ball, [&](const double *x) {
        solid = mps::simulation(config);
        return std::hypot(x[0] - 0.5, x[1] - 0.5) - 0.2;
    });
    CHECK(solid.count() == 0);
    mps::simulation refused = still();
    CHECK(throws<mps::error>(
        [&] {
            refused.move([&](double, mps_motion_state &) {
                refused.move([](double, mps_motion_state &) {});
            });
        },
        "motion"));
    refused.step(1.0);
}

int main()
{
    mps::config bad;
    bad.dp = -1;
    CHECK(throws<mps::error>([&] { mps::simulation sim(bad); }, "dp"));
    CHECK(throws<mps::error>([] { still().use("gas.poket"); }, "gas.pocket"));
    CHECK(throws<mps::error>([] { still().step(-1); }, "dt_max"));
    values();
    arrays();
    callbacks();
    bodies();
    lifetimes();
    return failures ? 1 : 0;
}
