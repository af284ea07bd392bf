// SPDX-License-Identifier: BSD-3-Clause
// A tank that rolls, from C++17: pressure at the wall, energies, a picture of the particles in
// ParaView.
//   c++ -std=c++17 tank.cpp $(pkg-config --cflags --libs mps) -o tank
#include <mps/mps.hpp>

#include <cmath>
#include <cstdio>

int main()
try {
    mps::config config;
    config.dp = 0.02;
    mps::simulation sim(config, "imps", [](int, const std::string &text) {
        std::printf("libmps: %s\n", text.c_str());
    });

    mps::tank tank;
    tank.size[0] = 1.0;
    tank.size[1] = 0.6;
    sim.add(tank);
    sim.fill_level({0, 0}, {1.0, 0.3});

    const double amplitude = 0.07, omega = 5.0;
    sim.centre({0.5, 0});
    sim.move([=](double t, mps_motion_state &state) { // smooth start, as x^3
        const double x = std::fmin(t / 2.0, 1.0), f = x * x * x * (10 + x * (6 * x - 15)),
                     df = x < 1 ? 15 * x * x * (1 - x) * (1 - x) : 0,
                     ddf = x < 1 ? 7.5 * 2 * x * (1 - x) * (1 - 2 * x) : 0, s = std::sin(omega * t),
                     c = std::cos(omega * t);
        state.value[MPS_ROTATE_Z] = amplitude * f * s;
        state.rate[MPS_ROTATE_Z] = amplitude * (df * s + f * omega * c);
        state.accel[MPS_ROTATE_Z] = amplitude *
                                    (ddf * s + 2 * df * omega * c - f * omega * omega * s);
    });
    mps::time_control control;
    control.dt_max = 2 * std::acos(-1.0) / omega / 20;
    sim.set(control);

    mps::probe_definition definition;
    definition.type = MPS_PROBE_WALL_PRESSURE;
    definition.at[1] = 0.1;
    definition.rate = 100;
    const mps::probe wall = sim.add(definition);

    double next = 0;
    sim.run(1.0, [&](mps::simulation &s, const mps_step_info &info) {
        if (info.t >= next) {
            std::printf("t = %.2f s, kinetic energy %.3f J/m, %d iterations\n", info.t,
                        s.energy().kinetic, info.ppe_iterations);
            next += 0.2;
        }
    });

    double largest = 0;
    for (double p : wall.series().second) largest = std::fmax(largest, p);
    double highest = 0;
    {
        const auto x = sim.lease<const double>("position");
        const auto kind = sim.lease<const int32_t>("kind");
        for (std::size_t i = 0; i < x.size(); i++)
            if (kind[i][0] == MPS_FLUID) highest = std::fmax(highest, x[i][1]);
    }
    std::printf("largest pressure %.0f Pa, highest particle %.3f m\n", largest, highest);
    sim.frames(".", "tank_frames").write();
    return 0;
} catch (const mps::error &e) {
    std::fprintf(stderr, "%s: %s\n", e.name(), e.what());
    return 1;
}
