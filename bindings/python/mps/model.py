# SPDX-License-Identifier: BSD-3-Clause
"""Models written in Python, for trying things: every verb costs a call of Python and arrays of numpy in each step. Write a
permanent model in C: docs/tutorials/your_own_model.md. Terms are those of mps/model.h.

    class Drag(mps.Model):
        name = "porous.drag"
        help = "drag of a porous block"
        settings = [mps.Setting("rate", "1/s", "of the velocity", 0.0, 0.0, 1e4)]

        @mps.verb(mps.MPS_FORCE, velocity=mps.MPS_USE_READ, acceleration=mps.MPS_USE_CHANGE)
        def push(self, s):
            s["acceleration"][s.fluid] -= s.setting["rate"] * s["velocity"][s.fluid]

    sim.use(Drag(), rate=3.0)
"""
from __future__ import annotations

import ctypes
from collections.abc import Callable
from ctypes import POINTER, byref, c_double, c_int32
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _numbers as N
from . import _structs as T
from . import errors
from ._library import c
from ._records import make, text

if TYPE_CHECKING:
    from .simulation import Simulation


@dataclass
class Setting:
    """A number that a user may set."""

    key: str
    unit: str
    help: str
    initial: float
    min: float
    max: float


@dataclass
class Channel:
    """An array that the model adds; components: 1..9, MPS_VECTOR, MPS_MATRIX. life:
    MPS_LIFE_STEP or MPS_LIFE_PARTICLE."""

    name: str
    unit: str
    help: str
    components: int = 1
    life: int = N.MPS_LIFE_STEP
    initial: float = 0.0


def verb(hook: int, *, after: str | None = None, before: str | None = None, **uses: int) -> Callable[[Any], Any]:
    """A method is called at a hook of the step. uses: channel=MPS_USE_..., available as
    s[channel]."""
    def mark(method: Any) -> Any:
        method.verb = (hook, after, before, uses)
        return method

    return mark


class Model:
    """Base of models in Python: name "slot.variant", help, settings, channels, methods with @verb."""

    name = ""
    help = ""
    settings: list[Setting] = []
    channels: list[Channel] = []


@dataclass
class Pairs:
    """All pairs of a stencil: particles i, neighbours j, r = x_j - x_i [pairs, dim], distances
    [m], weights W."""

    i: np.ndarray
    j: np.ndarray
    r: np.ndarray
    distance: np.ndarray
    w: np.ndarray

    def sum(self, values: np.ndarray, rows: int) -> np.ndarray:
        """Sum over the neighbours of each particle; values [pairs] or [pairs, numbers]."""
        flat = values.reshape(len(values), -1)
        out = np.stack([np.bincount(self.i, weights=flat[:, k], minlength=rows) for k in range(flat.shape[1])], axis=1)
        return out.reshape((rows,) + values.shape[1:])


def pairs_of(stencil: Any) -> Pairs:
    """The pairs of an mps_stencil."""
    n, dim = stencil.n, stencil.dim
    begin, end = np.ctypeslib.as_array(stencil.begin, (n,)), np.ctypeslib.as_array(stencil.end, (n,))
    counts = end - begin
    i = np.repeat(np.arange(n), counts)
    k = np.repeat(begin - np.concatenate(([0], np.cumsum(counts)[:-1])), counts) + np.arange(counts.sum())
    size = int(end.max(initial=0))
    j = np.ctypeslib.as_array(stencil.col, (max(size, 1),))[k].astype(np.int64)
    x = np.ctypeslib.as_array(stencil.x, (n, dim))
    r = x[j] - x[i]
    distance = np.sqrt((r * r).sum(axis=1))
    if stencil.kernel.id == N.MPS_KERNEL_IMPROVED:
        w = stencil.re / (0.85 * distance + 0.15 * stencil.re) - 1
    elif stencil.kernel.id == N.MPS_KERNEL_ORIGINAL:
        w = stencil.re / distance - 1
    else:
        w = np.array([stencil.kernel.fn(stencil.kernel.user, d, stencil.re) for d in distance])
    return Pairs(i, j, r, distance, w)


class Stage:
    """The state of a step in a verb. Arrays are copies in the present order of the particles,
    which may be kept after the verb; values written to channels with MPS_USE_WRITE or MPS_USE_CHANGE are passed
    to the library when the verb returns. A stage raises StateError after
    its verb.

    s["velocity"]     channel of the verb's uses, [n], [n, dim] or [n, dim^2]; all channels: `mps list models`
    s.setting["rate"] value of a setting
    s.x, s.kind, s.phase, s.fluid, s.id     positions [n, dim] m; FLUID, WALL or DUMMY; number of the phase; mask of fluid; id
    s.near, s.far     pairs within re_near and re_far; not in MPS_POPULATE, MPS_LIMIT and MPS_MOTION
    s.n, s.dim, s.dp, s.g      particles; 2 or 3; spacing [m]; gravity [dim] m/s2
    s.t, s.dt, s.step, s.hook  time at the beginning of the step [s], its length [s], its number from 1, MPS_POPULATE to MPS_SHIFT
    s.limit_step(dt)  in MPS_LIMIT: the longest step that is allowed"""

    def __init__(self, model: Model, stage: Any, uses: dict[str, int], shapes: dict[str, tuple[int, int]]) -> None:
        self._open, self._uses, self._shapes = stage, uses, shapes
        self._place = {name: k for k, name in enumerate(uses)}
        self._arrays: dict[str, np.ndarray] = {}
        self._views: dict[str, np.ndarray] = {}
        v = self._view
        self.dim, self.n, self.t, self.dt, self.dp, self.step, self.hook = v.dim, v.n, v.t, v.dt, v.dp, stage.step, stage.hook
        self.g = np.array(v.g)[: v.dim]
        self.setting = {s.key: v.setting[k] for k, s in enumerate(model.settings)}

    @property
    def _stage(self) -> Any:
        if self._open is None:
            raise errors.error(N.MPS_E_STATE, "a stage ends with its verb; keep its arrays instead")
        return self._open

    @property
    def _view(self) -> Any:
        return self._stage.view.contents

    def _end(self, done: bool) -> None:
        """End the stage; done: pass the written values to the library."""
        for name, view in self._views.items() if done else ():
            view[...] = self._arrays[name]
        self._open = None
        self._views = {}

    def __getitem__(self, channel: str) -> np.ndarray:
        """The values of a channel that the verb uses."""
        stage = self._stage
        if channel in self._arrays:
            return self._arrays[channel]
        if channel not in self._place:
            raise errors.error(N.MPS_E_NAME, f"the verb does not use '{channel}'; it uses {', '.join(self._place)}")
        components, kind = self._shapes[channel]
        numbers = {N.MPS_VECTOR: self.dim, N.MPS_MATRIX: self.dim**2, N.MPS_SCALAR: 1}.get(components, components)
        rows = 1 if components == N.MPS_SCALAR else self.n
        start = stage.data[self._place[channel]]
        if not start:
            raise errors.error(N.MPS_E_STATE, f"no active model has the channel '{channel}'")
        typed = ctypes.cast(start, POINTER(c_double if kind == N.MPS_TYPE_REAL else c_int32))
        view = np.ctypeslib.as_array(typed, (rows,) if numbers == 1 else (rows, numbers))
        array = self._arrays[channel] = view.copy()
        if self._uses[channel] & N.MPS_USE_WRITE:
            self._views[channel] = view
        else:
            array.flags.writeable = False
        return array

    def __setitem__(self, channel: str, values: Any) -> None:
        """Write a channel: s["acceleration"] += a."""
        array = self[channel]
        if values is not array:
            array[...] = values

    def _rows(self, start: Any, *numbers: int) -> np.ndarray:
        array = np.ctypeslib.as_array(start, (self.n, *numbers)).copy()
        array.flags.writeable = False
        return array

    @cached_property
    def x(self) -> np.ndarray:
        """[n, dim] positions at the beginning of the step, in the lab [m]."""
        return self._rows(self._view.x, self.dim)

    @cached_property
    def kind(self) -> np.ndarray:
        """[n] MPS_FLUID, MPS_WALL, MPS_DUMMY."""
        return self._rows(self._view.kind)

    @cached_property
    def phase(self) -> np.ndarray:
        """[n] number of the phase of fluid particles."""
        return self._rows(self._view.phase)

    @cached_property
    def id(self) -> np.ndarray:
        """[n] id, which stays with the particle."""
        return self._rows(self._view.id)

    @cached_property
    def fluid(self) -> np.ndarray:
        """[n] True for fluid."""
        return self.kind == N.MPS_FLUID

    @cached_property
    def near(self) -> Pairs:
        """Pairs within re_near."""
        return self._pairs(self._view.near)

    @cached_property
    def far(self) -> Pairs:
        """Pairs within re_far."""
        return self._pairs(self._view.far)

    def _pairs(self, stencil: Any) -> Pairs:
        if not stencil.begin or not stencil.x:
            raise errors.error(N.MPS_E_STATE, "there are no pairs in MPS_POPULATE, MPS_LIMIT and MPS_MOTION")
        return pairs_of(stencil)

    def limit_step(self, dt: float) -> None:
        """In MPS_LIMIT: the longest step allowed [s]."""
        stage = self._stage
        if stage.hook != N.MPS_LIMIT:
            raise errors.error(N.MPS_E_STATE, "limit_step() is for MPS_LIMIT")
        stage.dt_limit = min(stage.dt_limit, dt)


def _known_channels(handle: Any) -> dict[str, tuple[int, int]]:
    """Components and type of all channels."""
    info, found, index = make(T.mps_channel_info), {}, 0
    while c.mps_channel_info_get(handle, index, byref(info)) == 0:
        found[text(info.name)] = (info.components, info.type)
        index += 1
    return found


def _verbs(model: Model) -> list[tuple[Any, tuple[int, str | None, str | None, dict[str, int]]]]:
    """Methods with @verb, those of base classes too, in the order of their definition."""
    names = dict.fromkeys(name for kind in reversed(type(model).__mro__) for name in vars(kind))
    methods = [getattr(model, name) for name in names]
    return [(m, m.verb) for m in methods if callable(m) and hasattr(m, "verb")]


def _run(sim: Simulation, model: Model, method: Any, uses: dict[str, int]) -> Any:
    calls, handle = sim._calls, sim.handle  # not the simulation itself, which would then be freed by the collector alone

    def call(pointer: Any) -> int:
        shapes = calls.kept.setdefault("channels", {})
        if not set(uses) <= set(shapes):
            shapes.update(_known_channels(handle))
        stage = Stage(model, pointer.contents, uses, shapes)
        done = False
        try:
            method(stage)
            done = True
        except Exception as e:
            calls.failed = e
            c.mps_stage_fail(pointer, f"{type(e).__name__}: {e}".replace("%", "%%").encode())
        finally:
            stage._end(done)
        return 0 if done else 1

    return calls.guard(call, 1)


def _tables(sim: Simulation, model: Model) -> tuple[Any, list[Any]]:
    """The table of a model, and the objects it points to."""
    found = _verbs(model)
    kept: list[Any] = [model]
    verbs = (T.mps_verb * max(len(found), 1))()
    run_type = dict(T.mps_verb._fields_)["run"]
    for k, (method, (hook, after, before, uses)) in enumerate(found):
        list_ = (T.mps_use * max(len(uses), 1))(*[T.mps_use(name.encode(), access) for name, access in uses.items()])
        run = run_type(_run(sim, model, method, uses))
        verbs[k] = T.mps_verb(hook, len(uses), list_, after.encode() if after else None, before.encode() if before else None, run)
        kept += [list_, run]
    settings = (T.mps_setting * max(len(model.settings), 1))(
        *[T.mps_setting(s.key.encode(), s.unit.encode(), s.help.encode(), N.MPS_TYPE_REAL, s.initial, s.min, s.max) for s in model.settings])
    channels = (T.mps_channel * max(len(model.channels), 1))(
        *[T.mps_channel(h.name.encode(), h.unit.encode(), h.help.encode(), h.components, N.MPS_TYPE_REAL, h.life, h.initial)
          for h in model.channels])
    ops = T.mps_model_ops(struct_size=ctypes.sizeof(T.mps_model_ops), api=N.MPS_MODEL_API, name=model.name.encode(),
                          help=model.help.encode(), setting_count=len(model.settings), channel_count=len(model.channels),
                          verb_count=len(found), settings=settings, channels=channels, verbs=verbs)
    return ops, [*kept, ops, verbs, settings, channels]


def register(sim: Simulation, model: Model) -> str:
    """Register a model on a simulation, unless it is registered. Returns its name."""
    if not isinstance(model, Model):
        raise errors.error(N.MPS_E_ARG, f"a model is a name such as 'gas.pocket' or an object of a class of mps.Model, not {model!r}")
    key = f"model {model.name}"
    if key in sim._calls.kept and sim._calls.kept[key][0] is model:
        return model.name
    ops, kept = _tables(sim, model)
    sim.check(c.mps_model_register(sim.handle, byref(ops)))
    sim._calls.kept[key] = kept  # the library keeps pointers to them
    sim._calls.kept.pop("channels", None)
    return model.name
