# SPDX-License-Identifier: BSD-3-Clause
"""A simulation: set up, step, read."""
from __future__ import annotations

import ctypes
import warnings
from collections.abc import Callable, Iterator
from ctypes import POINTER, byref, c_double, c_int32, c_int64
from pathlib import Path
from typing import Any

import numpy as np

from . import _numbers as N
from . import errors
from . import _structs as T
from ._couple import Coupling
from ._geometry import Geometry
from ._held import Held, Owner
from ._library import c
from ._motion import Motion
from ._records import Calls, Record, coded, copied, make, pointer, real, record, text, whole
from .lease import Lease
from .model import Model, register
from .probe import Probe

_PROBES = {"wall_pressure": N.MPS_PROBE_WALL_PRESSURE, "fluid_pressure": N.MPS_PROBE_FLUID_PRESSURE, "gauge": N.MPS_PROBE_GAUGE,
           "force": N.MPS_PROBE_FORCE}


def _message(log: Callable[[int, str], None] | None) -> Callable[[Any, int, bytes], None]:
    """Receives log messages of the library. It does not refer to the simulation, which only the
    garbage collector would then free."""
    def call(_user: Any, level: int, what: bytes) -> None:
        if log is not None:
            log(level, text(what))
        elif level >= N.MPS_LOG_WARNING:
            warnings.warn(errors.in_python(text(what)), stacklevel=4)

    return call


class Simulation(Geometry, Motion, Coupling, Owner):
    """An MPS simulation. Keywords are the members of mps_config, with its defaults: Simulation(dp=0.01, dim=2, threads=2).

    preset: "imps" (one liquid with a free surface), "mmps" (liquid and gas), "imps.paper", "mmps.paper".
    log: a function of (level, text), or None for no log; warnings of the library become warnings of Python.

    Arrays are [particles] or [particles, numbers], in SI units. One thread at a time may use a simulation.

    `with mps.Simulation(dp=0.01) as sim:` closes it at the end, with its frames, snapshots and leases; else Python does so when nothing
    refers to it any more. A closed simulation raises StateError. close() within a call of the library raises BusyError. It cannot be copied
    or pickled: snapshot() keeps a state in memory, checkpoint() in a file."""

    _instead = "; snapshot() keeps a state in memory, checkpoint() in a file; in each process of multiprocessing build a simulation"

    def __init__(self, dp: float | None = None, *, preset: str = "imps", log: Callable[[int, str], None] | None = None, **config: Any) -> None:
        if dp is None:
            raise errors.error(N.MPS_E_ARG, "Simulation: dp, the spacing of the particles [m], is missing: Simulation(dp=0.01)")
        config["dp"] = dp
        self._calls = Calls()
        error = ctypes.create_string_buffer(1024)
        one = make(T.mps_config, config, "Simulation")
        self._calls.kept["log"] = one.log = T.mps_log_fn(self._calls.guard(_message(log), None))
        one.error, one.error_size = ctypes.cast(error, POINTER(ctypes.c_char)), len(error)
        handle = POINTER(T.mps_sim)()
        status = c.mps_sim_create(byref(one), byref(handle))
        if status < 0:
            raise errors.error(status, text(error.value))
        self._held = Held("simulation", handle, c.mps_sim_destroy, calls=self._calls)
        self.preset(preset)

    @classmethod
    def adopt(cls, handle: Any, owner: Owner | None = None) -> Simulation:
        """A simulation that another object, `owner`, creates and destroys; it is closed before
        its owner."""
        sim = cls.__new__(cls)
        sim._calls, sim._owner = Calls(), owner
        sim._held = Held("simulation", handle, lambda _: None, owner._held if owner is not None else None, sim._calls)
        return sim

    @property
    def handle(self) -> Any:
        """The simulation, for functions of C: mps.c.mps_step(sim.handle, ...)."""
        return self._held.pointer

    def __repr__(self) -> str:
        if self.closed:
            return "<mps.Simulation, closed>"
        return f"<mps.Simulation, {self.dim}-D, dp {self.dp:g} m, {self.count()} particles, t = {self.t:g} s, {self.steps} steps>"

    # ---- errors

    def failure(self, status: int) -> errors.Error:
        """The exception of a status of this simulation."""
        return errors.error(status, text(c.mps_sim_error(self.handle)))

    def check(self, status: int) -> int:
        """Raise the failure of a call of the library, or the exception of one of your functions."""
        if status == 0 and self._calls.failed is None:
            return 0
        failed = self._calls.taken()
        if failed is not None and not isinstance(failed, Exception):
            raise failed  # KeyboardInterrupt
        if status < 0:
            raise self.failure(status) from failed
        if failed is not None:
            raise failed
        if status == N.MPS_W_NOT_CONVERGED:
            warnings.warn(text(c.mps_status_text(status)), errors.NotConverged, stacklevel=3)
        return status

    # ---- what it is

    @property
    def dim(self) -> int:
        """2 or 3."""
        dim = c_int32()
        self.check(c.mps_sim_shape(self.handle, byref(dim), None))
        return dim.value

    @property
    def dp(self) -> float:
        """Spacing of the particles [m]; the first tank changes it."""
        dp = c_double()
        self.check(c.mps_sim_shape(self.handle, None, byref(dp)))
        return dp.value

    @property
    def t(self) -> float:
        """Time [s]."""
        t = c_double()
        self.check(c.mps_sim_time(self.handle, byref(t), None))
        return t.value

    @property
    def steps(self) -> int:
        """Steps done."""
        steps = c_int64()
        self.check(c.mps_sim_time(self.handle, None, byref(steps)))
        return steps.value

    def threads(self, number: int) -> None:
        """Number of threads. Results do not depend on it."""
        self.check(c.mps_threads_set(self.handle, whole("threads", number)))

    # ---- phases, models, solver

    def phase(self, index: int = 0, **entries: float) -> None:
        """Properties of a phase: density [kg/m3], viscosity [Pa s]."""
        self.check(c.mps_phase_set(self.handle, whole("phase", index), byref(make(T.mps_phase, entries, "phase"))))

    def tension(self, a: int, b: int, sigma: float) -> None:
        """Surface tension between two phases [N/m]."""
        self.check(c.mps_tension_set(self.handle, whole("a", a), whole("b", b), real("sigma", sigma)))

    def preset(self, name: str) -> None:
        """Replace all models by those of a preset."""
        self.check(c.mps_preset_use(self.handle, coded(name)))

    def use(self, model: str | Model, **settings: float) -> None:
        """Activate a model by its name "slot.variant", or one of yours; with settings."""
        name = model if isinstance(model, str) else register(self, model)
        self.check(c.mps_model_use(self.handle, coded(name)))
        for key, value in settings.items():
            self.set(name.split(".")[0], key, value)

    def remove(self, slot: str) -> None:
        """Deactivate the model of a slot."""
        self.check(c.mps_model_remove(self.handle, coded(slot)))

    def set(self, slot: str, key: str, value: float) -> None:
        """Change a setting of the model of a slot."""
        self.check(c.mps_model_set(self.handle, coded(slot), coded(key), real(key, value)))

    def get(self, slot: str, key: str) -> float:
        """A setting of the model of a slot."""
        value = c_double()
        self.check(c.mps_model_get(self.handle, coded(slot), coded(key), byref(value)))
        return value.value

    @property
    def models(self) -> list[str]:
        """Active models, in the order of calling."""
        found: list[str] = []
        while (name := c.mps_model_name(self.handle, len(found))) is not None:
            found.append(text(name))
        return found

    def solver(self, name: str, preconditioner: str | None = None, **limits: float) -> None:
        """Pressure solver, with members of mps_solver_limits."""
        self.check(c.mps_solver_use(self.handle, coded(name), coded(preconditioner)))
        if limits:
            self.check(c.mps_solver_limits_set(self.handle, byref(make(T.mps_solver_limits, limits, "solver"))))

    def time_control(self, **entries: float) -> None:
        """Length of the steps: members of mps_time_control, e.g. cfl, dt, dt_max."""
        self.check(c.mps_time_control_set(self.handle, byref(make(T.mps_time_control, entries, "time_control"))))

    # ---- particles

    def read(self, field: str) -> Lease:
        """Lease a field for reading: `with sim.read("position") as x`."""
        return Lease(self, field, False)

    def write(self, field: str) -> Lease:
        """Lease a field for writing."""
        return Lease(self, field, True)

    def __getitem__(self, field: str) -> np.ndarray:
        """A copy of a field."""
        with self.read(field) as values:
            return values.copy()

    def __setitem__(self, field: str, values: Any) -> None:
        """Write a field; a single number applies to all particles."""
        with self.write(field) as array:
            array[...] = values

    @property
    def fluid(self) -> np.ndarray:
        """[particles] True for fluid."""
        with self.read("kind") as kind:
            return kind == N.MPS_FLUID

    def count(self, kind: int = -1) -> int:
        """Number of particles: of FLUID, WALL, DUMMY, or of all."""
        return c.mps_particles_count(self.handle, whole("kind", kind))

    def add_field(self, name: str, components: int = 1) -> None:
        """Add a field of your own, which moves with the particles."""
        self.check(c.mps_field_add(self.handle, coded(name), whole("components", components)))

    def add_particles(self, position: Any, velocity: Any = None, area: Any = None, **entries: Any) -> np.ndarray:
        """Add particles at [n, dim], with members kind, phase, part of mps_particle_block.
        Returns their ids."""
        dim = self.dim
        arrays = {"position": position, "velocity": velocity, "area": area}
        given = {k: np.ascontiguousarray(v, dtype=float).reshape(-1, dim) for k, v in arrays.items() if v is not None}
        n = len(given["position"])
        for name, array in given.items():
            if len(array) != n:
                raise errors.ArgumentError(f"{name}: {len(array)} rows, but {n} positions")
        block = make(T.mps_particle_block, {**entries, **{k: pointer(v) for k, v in given.items()}, "count": n}, "add_particles")
        ids = np.empty(n, dtype=np.int64)
        self.check(c.mps_particles_add(self.handle, byref(block), pointer(ids, c_int64)))
        return ids

    def remove_particles(self, ids: Any) -> None:
        """Remove particles by id, all or none."""
        ids = np.ascontiguousarray(ids, dtype=np.int64).reshape(-1)
        self.check(c.mps_particles_remove(self.handle, len(ids), pointer(ids, c_int64)))

    # ---- steps

    def step(self, dt_max: float = 1e30) -> Record:
        """One step of at most dt_max [s]; returns mps_step_info."""
        info = make(T.mps_step_info)
        with self._held as handle:
            self.check(c.mps_step(handle, real("dt_max", dt_max), byref(info)))
        return record(info)

    def run(self, t_end: float, monitor: Callable[[Simulation, Record], object] | None = None) -> bool:
        """Step until t_end [s]. monitor(sim, info) is called after each step: True stops the run, False and None continue it, as in C
        and C++. Returns whether t_end was reached."""
        def call(_user: Any, _sim: Any, info: Any) -> int:
            return 1 if monitor is not None and monitor(self, record(copied(info.contents))) else 0

        # a callback without a monitor too: it lets Python see Ctrl-C
        function = T.mps_monitor_fn(self._calls.guard(call, 1))
        with self._held as handle:
            return self.check(c.mps_run(handle, real("t_end", t_end), function, None)) != N.MPS_W_STOPPED

    # ---- measures

    def probe(self, kind: str, at: Any = (), **entries: Any) -> Probe:
        """Add a sensor: "wall_pressure", "fluid_pressure", "gauge", "force"; members of
        mps_probe, e.g. average, rate, diameter."""
        if kind not in _PROBES:
            raise errors.UnknownName(f"no sensor '{kind}'; there are {', '.join(_PROBES)}")
        number = c_int32()
        one = make(T.mps_probe, {"at": at, **entries, "type": _PROBES[kind]}, "probe")
        self.check(c.mps_probe_add(self.handle, byref(one), byref(number)))
        return Probe(self, number.value)

    @property
    def energy(self) -> Record:
        """Energies, volume, mass, and the energy budget: mps_energy."""
        energy = make(T.mps_energy)
        self.check(c.mps_energy_get(self.handle, byref(energy)))
        return record(energy)

    @property
    def momentum(self) -> Record:
        """Momentum and its sources: mps_momentum."""
        momentum = make(T.mps_momentum)
        self.check(c.mps_momentum_get(self.handle, byref(momentum)))
        return record(momentum)

    # ---- files

    def frames(self, folder: str | Path, name: str = "frames", kinds: int = 0) -> Frames:
        """A series of frames for ParaView: `with sim.frames("out") as f: f.write()`. The folder is made. kinds: sum of MPS_FRAMES_...; 0: fluid
        and walls. mps.Frame reads them."""
        return Frames(self, folder, name, kinds)

    def checkpoint(self, path: str) -> None:
        """Write the complete state for the next steps."""
        self.check(c.mps_checkpoint_write(self.handle, coded(path)))

    def restore(self, path: str) -> None:
        """Continue from a checkpoint, in a simulation that was set up by the same calls."""
        self.check(c.mps_checkpoint_read(self.handle, coded(path)))


class Frames(Owner):
    """A series of frames for ParaView; the simulation owns it."""

    def __init__(self, sim: Simulation, folder: str | Path, name: str, kinds: int) -> None:
        self._sim, frames = sim, POINTER(T.mps_frames)()
        try:
            Path(folder).mkdir(parents=True, exist_ok=True)
        except (OSError, ValueError) as e:
            raise errors.error(N.MPS_E_IO, f"the folder {str(folder)!r} cannot be made: {e}") from None
        sim.check(c.mps_frames_open(sim.handle, coded(str(folder)), coded(name), whole("kinds", kinds), byref(frames)))
        self._held = Held("series of frames", frames, c.mps_frames_close, sim._held)

    def write(self) -> None:
        """Write the present state."""
        with self._held as frames:
            self._sim.check(c.mps_frames_write(frames))


def catalogue(sim: Simulation) -> Iterator[tuple[str, str]]:
    """Names and help of all models, built-in and registered."""
    index = 0
    info = make(T.mps_model_info)
    while c.mps_model_info_get(sim.handle, index, byref(info)) == 0:
        yield text(info.name), text(info.help)
        index += 1
