# SPDX-License-Identifier: BSD-3-Clause
"""What rename.py renames: files, names that mean one thing everywhere, names of some files, edits of build files."""
from pathlib import Path

# Not read: frozen headers (made again by tests/abi/freeze), texts of others, these scripts.
LEFT_ALONE = ["tests/abi/frozen/v*", "src/post/page/vendor/*", "third_party/*", "scripts/rename/*", "scripts/words",
              "tests/fuzz/corpus/*", "tests/sundials7/include/*", "LICENSE", "*.svg.in"]

# ---- folders and files

FOLDERS = [("src/case/build/", "src/case/setup/")]
ENGINE = {"bodies.c": "", "bodies.h": "", "bodies_there.c": "bodies_device.c", "densities.c": "", "densities.h": "", "engine.c": "device_memory.c",
          "engine.h": "device_memory.h", "engine_fields.c": "device_memory_fields.c", "engine_twin.h": "mirror.h", "guard.c": "", "guard.h": "",
          "host.c": "runner.c", "host.h": "runner.h", "later.c": "deferred.c", "later.h": "deferred.h", "lives.c": "liveness.c",
          "model_state.c": "", "plan.c": "", "plan.h": "", "reaction.c": "", "reaction.h": "", "stage.c": ""}
READ = ["page_codec.c", "page_codec.h", "page_film.c", "page_film.h", "page_json.c", "page_json.h", "page_pack.c", "page_pose.c", "page_pose.h",
        "page_read.c", "page_read.h", "page_scale.c", "page_scale.h", "page_table.c", "page_text.c", "page_text.h", "page_vtp.c", "page_vtp.h",
        "tables.h"]
FILES = {f"src/core/models/{o}": f"src/core/engine/{n or o}" for o, n in ENGINE.items()} | {f"src/post/{f}": f"src/post/read/{f}" for f in READ} | {
    "src/core/base/forest.h": "src/core/base/union_find.h",
    "src/core/neighbours/neighbours_there.c": "src/core/neighbours/neighbours_device.c",
    "src/core/neighbours/screens.c": "src/core/neighbours/occluders.c",
    "src/core/neighbours/screens.h": "src/core/neighbours/occluders.h",
    "src/core/particles/ghosts_there.c": "src/core/particles/ghosts_device.c",
    "src/core/world/gather.c": "src/core/world/collect.c",
    "src/core/world/gather.h": "src/core/world/collect.h",
    "src/ppe/auxgrid_ranks_there.c": "src/ppe/auxgrid/auxgrid_ranks_device.c",
    "src/ppe/auxgrid_wires.c": "src/ppe/auxgrid/auxgrid_edges.c",
    "src/ppe/cg_room.h": "src/ppe/cg_workspace.h",
    "src/ppe/kernels.c": "src/ppe/rows.c",
    "src/ppe/kernels.h": "src/ppe/rows.h",
    "src/post/page_verdict.c": "src/post/page/page_summary.c",
    "tests/unit/test_search_there.c": "tests/unit/test_search_device.c",
}
# Files whose loops are kernels: the name of a kernel begins with that of its file.
MOVED_UNITS = list(FILES)


def moves(files: list[str]) -> list[tuple[str, str]]:
    out = []
    for f in files:
        name = f.rsplit("/", 1)[-1]
        new = FILES.get(f, f)
        if new == f:
            for old, folder in FOLDERS:
                if f.startswith(old):
                    new = folder + f[len(old):]
            if f.startswith("src/core/world/voids") and f.endswith(".c"):
                new = "src/core/voids/" + name
            if f.startswith("src/ppe/auxgrid") and f.count("/") == 2:
                new = "src/ppe/auxgrid/" + name
            if f.startswith("src/post/") and f.count("/") == 2:
                kind = "page" if name.startswith("page") else "picture" if name.startswith(("picture", "film")) else "stats"
                new = f"src/post/{kind}/{name}"
        if new != f:
            out.append((f, new))
    return out


ALL_C = ["*.c", "*.h"]
# (regex, replacement, files or None for all): paths and file names in texts.
PATHS = [
    (r"\bin place of\b", "instead of", None),
    (r"\bgoes on\b", "continues", ["*.md", "*.md.in", "*.sh", "*.py", "src/case/job/folder.c", "src/core/io/archive.c", "tests/conformance/model_kit.c",
                                   "tests/unit/test_checkpoint_refused.c"]),
    (r"\breactions\.there\b", "reactions.on_device", ["src/core/*"]),
    (r"\bsrc/case/build\b(?!_)", "src/case/setup", None),
    (r"\bcase/build(?=[\"';)\s])", "case/setup", ["CMakeLists.txt", "scripts/*", "src/case/CMakeLists.txt", "docs/*"]),
    (r"\bcore/models/stage\.c", "core/engine/stage.c", None),
    (r"\bcore/models/guard\.c", "core/engine/guard.c", None),
    (r"\bmodels/stage\.c", "engine/stage.c", ["scripts/layers"]),
    (r"\bsrc/post/(picture_\w+\.[ch]|picture\.c|film\w*\.[ch])", r"src/post/picture/\1", None),
    (r"\bsrc/post/((?:%s)\b)" % "|".join(f.replace(".", r"\.") for f in READ), r"src/post/read/\1", None),
    (r"\bsrc/post/(statistics\w*\.[ch]|harmonics\.c)", r"src/post/stats/\1", None),
    (r"\bsrc/post/(page_\w+\.[ch]|page\.c)", r"src/post/page/\1", None),
    (r"\bsrc/ppe/(auxgrid\w*\.[ch])", r"src/ppe/auxgrid/\1", None),
    (r"\bsrc/core/world/(voids\w*\.c)", r"src/core/voids/\1", None),
]
_INSIDE = ["src/*", "tests/unit/*", "tests/shadow/*", "tests/ranks/*", "tests/conformance/*", "tests/device/*", "docs/*", "scripts/*", "CMakeLists.txt",
           "CONTRIBUTING.md"]
for _old, _new in FILES.items():
    PATHS.append((r"\b" + _old.replace(".", r"\.") + r"(?!\w)", _new, None))
for _old, _new in sorted(FILES.items(), key=lambda f: -len(f[0])):
    _o, _n = Path(_old).name, Path(_new).name
    if _o != _n and not _o.startswith("kernels."):
        PATHS.append((r"(?<![\w.])" + _o.replace(".", r"\.") + r"(?!\w)", _n, _INSIDE))

# ---- names with one meaning

NAMES = {
    # public
    "mps_ppe_share": "mps_ppe_halo",
    "mps_stage_beside": "mps_stage_adjacent",
    "mps_particles_gather": "mps_particles_collect",
    "mps_particles_gather_end": "mps_particles_collect_end",
    "mps_job_ranks_leave": "mps_job_ranks_exit",
    "mps_job_say": "mps_job_print",
    "mps_job_say_fn": "mps_job_print_fn",
    "mps_flux_wall_share": "mps_flux_wall_fraction",
    # memory of a device
    "mps__twins": "mps__memory",
    "mps__twins_enter": "mps__memory_enter",
    "mps__twins_leave": "mps__memory_exit",
    "mps__twins_there": "mps__memory_on_device",
    "mps__twins_old": "mps__memory_stale",
    "mps__twins_go": "mps__memory_set_space",
    "mps__twins_seen": "mps__memory_read",
    "mps__twins_given": "mps__memory_write",
    "mps__twins_room": "mps__memory_workspace",
    "mps__twins_ready": "mps__memory_sync",
    "mps__twins_fields_ready": "mps__memory_sync_fields",
    "mps__twins_lists_ready": "mps__memory_sync_lists",
    "mps__twins_rows_ready": "mps__memory_sync_rows",
    "mps__twins_shared": "mps__memory_halo",
    "mps__twins_shared_field": "mps__memory_halo_field",
    "mps__twin": "mps__mirror",
    "mps__twin_give_back": "mps__mirror_release",
    "MPS__TWIN_FIELDS": "MPS__MIRROR_FIELDS",
    "MPS__PLACES": "MPS__SPACES",
    "mps__world_lists_twins": "mps__world_mirror_lists",
    "mps__shared": "mps__halo_array",
    "MPS_CORE_ENGINE_H": "MPS_CORE_DEVICE_MEMORY_H",
    "MPS_CORE_ENGINE_TWIN_H": "MPS_CORE_MIRROR_H",
    # devices
    "mps__device_room": "mps__device_alloc",
    "mps__device_give": "mps__device_free",
    "mps__device_leave": "mps__device_release",
    "mps__device_there": "mps__device_present",
    "mps__device_give_up": "mps__device_fail",
    "mps__device_outdate": "mps__device_invalidate",
    "mps__device_gather": "mps__device_reduce_async",
    "mps__values_gather": "mps__values_reduce_async",
    "mps__rows_gather": "mps__rows_multiply_async",
    "mps__vectors_gather_dot": "mps__vectors_dot_async",
    "MPSK__LEFT_OUT": "MPSK__CANCELLED",
    "MPSK__SKIPS": "MPSK__MASKED",
    "cuda_give": "cuda_free",
    "cuda_room": "cuda_block",
    "cuda_leave": "cuda_exit",
    "cuda_gather": "cuda_reduce_async",
    "opencl_room": "opencl_block",
    "OPENCL_ROOMS": "OPENCL_BLOCKS",
    "SHADOW_ROOMS": "SHADOW_BLOCKS",
    # base
    "mps__room": "mps__capacity_for",
    "mps__give": "mps__release",
    "mps__hypre_give": "mps__hypre_release",
    "mps__scan_room": "mps__scan_size",
    "mps__shared_number": "mps__atomic_number",
    "mps__forest_get": "mps__atomic_get",
    "mps__forest_put": "mps__atomic_put",
    "mps__forest_replace": "mps__atomic_replace",
    "mps__forest_root": "mps__union_find",
    "mps__forest_join": "mps__union_join",
    "MPS_CORE_FOREST_H": "MPS_CORE_UNION_FIND_H",
    "mps__ranks_tell": "mps__ranks_report",
    # what runs verbs, reductions that nothing waits for
    "mps__host": "mps__runner",
    "mps__host_take": "mps__runner_switch_to_host",
    "mps__host_come": "mps__runner_to_host",
    "mps__host_settle": "mps__runner_flush",
    "mps__host_settle_with": "mps__runner_flush_with",
    "mps__host_do_later": "mps__runner_defer",
    "mps__host_sum_later": "mps__runner_sum_deferred",
    "mps__host_max_later": "mps__runner_max_deferred",
    "mps__host_reactions_later": "mps__runner_reactions_deferred",
    "mps__host_tell_places": "mps__runner_log_spaces",
    "MPS_CORE_HOST_H": "MPS_CORE_RUNNER_H",
    "mps__later": "mps__deferred",
    "mps__laters": "mps__deferred_list",
    "mps__laters_sums": "mps__deferred_sums",
    "mps__laters_maxima": "mps__deferred_maxima",
    "MPS__LATERS": "MPS__DEFERRED",
    "MPS__LATER_VALUES": "MPS__DEFERRED_VALUES",
    "MPS_CORE_LATER_H": "MPS_CORE_DEFERRED_H",
    "mps__budget_later": "mps__budget_deferred",
    "mps__budget_flow_later": "mps__budget_flow_deferred",
    "mps__budget_push_later": "mps__budget_push_deferred",
    "mps__lives_make": "mps__liveness_make",
    # neighbours
    "mps__seer": "mps__near_plate",
    "MPS__SEER_SLOTS": "MPS__NEAR_PLATE_SLOTS",
    "MPS__SEER_LIST": "MPS__NEAR_PLATE_LIST",
    "MPS__RIM_ROWS": "MPS__BOUNDARY_ROWS",
    "MPS__SCREEN_LIST": "MPS__OCCLUDER_LIST",
    "MPS__SCREEN_BITS": "MPS__OCCLUDER_BITS",
    "MPS_CORE_SCREENS_H": "MPS_CORE_OCCLUDERS_H",
    # particles, ranks
    "mps__particles_gather": "mps__particles_permute_values",
    "mps__ghosts_share": "mps__ghosts_exchange",
    "mps__ghosts_share_at": "mps__ghosts_exchange_at",
    "mps__ghosts_share_indexed": "mps__ghosts_exchange_indexed",
    "mps__ghosts_there": "mps__ghosts_device",
    "mps__world_share_areas": "mps__world_exchange_areas",
    "mps__world_share_step": "mps__world_exchange_step",
    "mps__world_share_written": "mps__world_exchange_written",
    "mps__pass_share": "mps__pass_exchange",
    "mps__gather_all": "mps__collect_all",
    "mps__gather_solids": "mps__collect_solids",
    "mps__gather_end": "mps__collect_end",
    "MPS_CORE_GATHER_H": "MPS_CORE_COLLECT_H",
    "mps__job_gather": "mps__job_collect",
    "mps__job_gather_end": "mps__job_collect_end",
    # next step
    "mps__ahead": "mps__next_flags",
    "MPS__AHEADS": "MPS__NEXT_FLAGS",
    "MPS__AHEAD_OUTSIDE": "MPS__NEXT_OUTSIDE",
    "MPS__AHEAD_SPEED": "MPS__NEXT_SPEED",
    "MPS__AHEAD_SPILLED": "MPS__NEXT_SPILLED",
    "MPS__AHEAD_WAY": "MPS__NEXT_WAY",
    "mps__world_look_ahead": "mps__world_next_flags",
    # pressure
    "mps__ppe_come": "mps__ppe_to_host",
    "mps__ppe_go": "mps__ppe_to_device",
    "mps__solvers_there": "mps__solvers_on_device",
    "mps__world_there": "mps__world_on_device",
    "mps__bounds_pin_there": "mps__bounds_fix_device",
    "mps__bounds_free_there": "mps__bounds_restore_device",
    "mps__bounds_tell_there": "mps__bounds_conditions_device",
    "MPS__ROW_HELD": "MPS__ROW_ACTIVE",
    "mps__cg_room": "mps__cg_workspace",
    "MPS_PPE_CG_ROOM_H": "MPS_PPE_CG_WORKSPACE_H",
    # auxgrid
    "mps__grid_come": "mps__grid_to_host",
    "mps__grid_go": "mps__grid_to_device",
    "mps__grid_owners_go": "mps__grid_owners_to_device",
    "mps__grid_gather": "mps__grid_restrict_level",
    "mps__grid_wires": "mps__grid_edges",
    "mps__grid_there": "mps__grid_device_lists",
    "mps__grid_told": "mps__grid_reported",
    "mps__grid_plan_share": "mps__grid_plan_exchange",
    "mps__grid_ranks_share": "mps__grid_ranks_halo",
    "mps__grid_share_particles": "mps__grid_weights_particles",
    "mps__grid_share_cells": "mps__grid_weights_cells",
    "mps__grid_room": "mps__grid_buffer",
    "mps__grid_room_of": "mps__grid_buffer_of",
    "mps__grid_room_here": "mps__grid_buffer_host",
    "mps__grid_ranks_room": "mps__grid_ranks_buffer",
    "MPS__GRID_ROOMS": "MPS__GRID_BUFFERS",
    "MPS__GRID_DIVIDED_ROOMS": "MPS__GRID_DIVIDED_BUFFERS",
    "MPS__GRID_HERE": "MPS__GRID_HOST",
    "MPS__GRID_TURNS": "MPS__GRID_VISITS",
    "MPS__GRID_TURNS_THERE": "MPS__GRID_VISITS_DEVICE",
    # void spaces, walls, motion
    "mps__void_room": "mps__void_capacity",
    "mps__wall_turn": "mps__wall_correct",
    "MPS__WALL_TURNS": "MPS__WALL_ROUNDS",
    "mps__step_turn_areas": "mps__step_rotate_areas",
    "MPS__TURNED_AREAS": "MPS__ROTATED_AREAS",
    "mps__motion_turned": "mps__motion_rotated",
    # weights and fractions
    "mps__edge_share": "mps__edge_weight",
    "mps__gas_share": "mps__gas_fraction",
    "mps__plates_share": "mps__plates_fraction",
    "mps__lattice_plan_share": "mps__lattice_plan_fraction",
    "mps__random_share": "mps__random_fraction",
    # messages
    "mps__degree_here": "mps__degree_moves",
    "mps__wall_goes_on": "mps__wall_continues",
    "mps__case_go_on": "mps__case_continue",
    "mps__slots_tell": "mps__slots_log",
    "mps__job_tell": "mps__job_print",
    "mps__job_told": "mps__job_broadcast",
    "mps__case_say": "mps__case_log",
    "mps__case_say_at": "mps__case_log_at",
    "mps__case_say_key": "mps__case_log_key",
    "mps__sensor_say": "mps__sensor_log",
    "cli_say": "cli_print",
    "fmu_tell": "fmu_log",
    "fmu_say_fn": "fmu_log_fn",
    "kit_say": "kit_print",
    "mps__auxgrid_wires": "mps__auxgrid_edges",
    "GIVE_CONDITION": "SET_CONDITION",
    "GIVE_REGION": "SET_REGION",
    "GIVE_ROW": "SET_ROW",
    "GIVE_SLOPE": "SET_SLOPE",
    "GIVE_USES": "SET_USES",
    "GIVE_VALUE": "SET_VALUE",
    "driver_leave": "driver_exit",
    "mps__mpi_leave": "mps__mpi_finish",
    "mps__scene_room": "mps__scene_reserve",
    "mps__page_verdict": "mps__page_summary",
    # the build
    "MPS_ROOMS": "MPS_MODULES",
    "MPS_CASE_ROOMS": "MPS_CASE_MODULES",
}

# Families of names: whole names, the first that matches. Only for names that begin with mps.
PATTERNS = [
    (r"^mps__twins_(\w+)$", r"mps__memory_\1"),
    (r"^mps__twin_(\w+)$", r"mps__mirror_\1"),
    (r"^mps__host_(\w+)$", r"mps__runner_\1"),
    (r"^mps__screen(s?)$", r"mps__occluder\1"),
    (r"^mps__screen(s?)_(\w+)$", r"mps__occluder\1_\2"),
    (r"^mps__(ppe|solvers|pcg|jacobi|auxgrid|krylov|space|ghosts)_leave$", r"mps__\1_release_device"),
    (r"^(mps__\w+)_there$", r"\1_device"),
    (r"^MPS__GRID_(\w+)_THERE$", r"MPS__GRID_\1_DEVICE"),
]

# ---- names of some files: (files, {name: new}, [(regex of a whole name, new)])

_DEVICE_FILES = ("src/core/base/* src/core/particles/* src/core/neighbours/* src/core/engine/* src/core/pressure/* src/core/world/* "
                 "src/core/step/* src/core/voids/voids_liquid.c src/ppe/*")
LOCAL = [
    ("src/core/engine/device_memory* src/core/engine/mirror.h src/core/engine/runner.c src/core/engine/stage.c src/core/engine/reaction.c "
     "src/core/engine/bodies.c src/core/engine/guard.c", {"place": "space", "place_of": "space_of"}, []),
    ("src/core/engine/device_memory*", {"gone": "lost"}, []),
    ("src/core/world/lost.c", {"aheads": "flags", "raise_aheads": "raise_flags", "raise_ahead": "raise_flag", "take_ahead": "take_flags"}, []),
    ("src/core/step/budget.c", {"sum_later": "sum_deferred"}, []),
    ("src/core/*", {"rows_here": "rows_on_host", "not_here": "refuse_hook", "solve_here": "solve_on_host", "count_here": "count_on_rank",
                    "invert_here": "invert_on_host"}, []),
    ("src/core/pressure/ppe.c", {"tell_row": "write_row", "tell_rows": "write_rows"}, []),
    ("src/core/voids/voids_cells.c", {"is_there": "is_inside"}, []),
    ("src/core/measure/probe_face.c", {"looks_there": "looks_at"}, []),
    ("src/ppe/auxgrid/auxgrid_cycle.c", {"invert_here": "invert_on_host"}, []),
    ("plugins/hypre/pcg.c", {"dot_here": "dot_on_rank"}, []),
    ("src/case/job/*", {"steps_here": "steps_of_run"}, []),
    ("apps/mps/series.c", {"is_there": "exists"}, []),
    ("src/core/voids/voids_label.c src/geometry/shapes/contour.c src/geometry/shapes/mesh.c", {"rim": "border", "mark_rim": "mark_border"}, []),
    ("tests/unit/test_phase_collision.c", {"room": "box"}, []),
    ("tests/ranks/test_memory.c", {"room": "enough"}, []),
    ("tests/ranks/test_devices.c", {"room_for_a_part": "memory_for_a_part"}, []),
    ("tests/shadow/test_steps.c", {"without_room": "without_memory"}, []),
    ("tests/shadow/test_solver.c", {"wires": "edges", "wired": "edges_before"}, []),
    ("tests/device/test_rows.c", {"room": "alloc"}, []),
    ("examples/impact/toe.c", {"give_exact": "print_exact"}, []),
    ("apps/mps/fmu.c", {"say_nothing": "print_nothing"}, []),
    ("bindings/fmu/adapter.c", {"say_log": "log_text"}, []),
    ("tests/unit/test_solver_registry.c", {"told": "reported", "told_p": "reported_p"}, []),
    ("tests/*", {"told": "logged"}, []),
    # active set of least pressures
    ("src/core/pressure/bounds*",
     {"held": "active", "held_before": "active_before", "pin": "fix", "pin_rows": "fix_rows", "pin_row": "fix_row", "pinned": "fixed",
      "is_pinned": "is_fixed", "pinned_at": "fixed_at", "pinned_capacity": "fixed_capacity", "tell_pinned": "write_fixed",
      "tell_pinned_rows": "write_fixed_rows", "tell_row": "condition_row", "tell_rows": "condition_rows", "solve_held": "solve_active"}, []),
    ("src/core/particles/particles.* src/core/step/step_fluid.c src/core/step/step_pressure.c src/core/step/undo.c", {"held": "active"}, []),
    ("src/ppe/klu.c", {"pin": "datum", "pinned": "is_datum", "choose_pins": "choose_datums"}, []),
    # components of the equation
    ("src/core/pressure/levels.c",
     {"forest": "components", "forest_of": "components_of", "grow_forest": "find_components", "told": "datum_of", "level": "datum",
      "lacks_level": "lacks_datum", "tell_row": "send_row", "tell_rows": "send_rows", "hear_row": "receive_row", "hear_rows": "receive_rows"}, []),
    # buffers and capacities
    ("src/core/base/device.*", {"room": "block"}, []),
    ("src/core/base/scan.c", {"room": "size"}, []),
    ("tests/unit/test_loop.c", {"room": "whole"}, []),
    ("plugins/cuda/* tests/cuda/*", {"give": "memory_free"}, []),
    ("src/core/engine/device_memory* src/core/step/undo.c src/core/neighbours/neighbours.c src/core/voids/* src/core/world/voids.h "
     "apps/mps/info_stl.c apps/mps/stats.c include/mps/geometry.h src/geometry/tanks/api_solid.c src/geometry/shapes/mesh* plugins/mpi/* "
     "src/case/job/* src/case/text/store.c tests/unit/checkpoint_editor.h tests/fuzz/* tests/unit/test_checkpoint_refused.c tests/unit/test_pocket.c "
     "tests/unit/test_preset_values.c tests/unit/search_fixture.h", {"room": "capacity", "all_room": "all_capacity", "make_room": "reserve_more"}, []),
    ("src/core/engine/stage.c src/core/pressure/ppe.c src/core/pressure/solvers* src/core/particles/ghosts_device.c src/post/picture/picture_scene.c "
     "src/case/setup/reference.c src/post/read/page_film.* tests/unit/test_list.c tests/unit/test_structs.c", {"room": "buffer"}, []),
    ("src/core/neighbours/neighbours_rows.c src/ppe/cg* src/ppe/krylov.*", {"room": "workspace"}, []),
    ("src/core/io/archive.c src/case/text/out.c src/post/read/page_codec.c", {"room": "remaining", "bytes_room": "bytes_remaining"}, []),
    ("src/post/stats/statistics_write.c", {"room": "fits"}, []),
    ("src/post/picture/picture_draw.c", {"room": "extent"}, []),
    ("src/core/measure/probe_gauge.c src/geometry/shapes/sampling.c",
     {"room": "clearance", "gap_room": "gap_clearance", "layer_room": "layer_clearance", "wall_room": "wall_clearance"}, []),
    ("src/geometry/tanks/slots.c", {"has_room": "has_space"}, []),
    ("src/case/job/folder.c", {"folder_has_room": "folder_has_space"}, []),
    ("src/core/particles/particles.c", {"room_to_move": "reserve_move"}, []),
    ("src/post/stats/statistics_events.c", {"make_room": "reserve_more"}, []),
    ("src/post/read/page_film.c", {"frame_room": "reserve_frame"}, []),
    ("src/post/read/page_json.c", {"text_room": "reserve_text"}, []),
    ("src/ppe/auxgrid/*",
     {"room": "buffer", "share": "weight", "told": "reported", "turn": "visit", "turns": "visits", "shares": "weights", "set_shares": "set_weights",
      "share_cell": "weigh_cell", "share_cells": "weigh_cells", "share_particle": "weigh_particle", "share_particles": "weigh_particles",
      "share_rows": "exchange_rows", "gather_row": "restrict_row", "gather_rows": "restrict_rows", "gathering": "restriction",
      "gather_count": "collect_count", "wire": "edge", "wires": "edges", "add_wire": "add_edge", "add_short_wire": "add_short_edge",
      "wire_row": "edge_row", "wire_rows": "edge_rows", "wiring": "edge_list", "add_turn": "add_visit", "clear_turn": "clear_visit",
      "sum_turn": "sum_visit", "add_turns": "add_visits", "clear_turns": "clear_visits", "sum_turns": "sum_visits", "list_turns": "list_visits",
      "cells_here": "cells_on_rank"}, [(r"^(\w+)_room$", r"\1_buffer")]),
    ("plugins/cuda/* tests/cuda/* tests/device/opencl.* tests/shadow/* tests/ranks/test_devices.c",
     {"room": "block", "rooms": "blocks", "room_capacity": "block_capacity", "free_room": "free_block", "more_rooms": "grow_blocks",
      "room_of": "block_of", "ROOMS": "BLOCKS", "compare_rooms": "compare_blocks", "give": "release", "gives": "allocations",
      "outdated": "invalidated"}, []),
    ("bench/* tests/*", {"give": "release", "give_back": "release_all", "path_room": "path_capacity", "room_for": "allocate"}, [(r"^search_room(\w*)$", r"search_buffers\1")]),
    ("src/* tests/* apps/* plugins/* bindings/* examples/*", {}, [(r"^([A-Z_]+_)ROOM$", r"\1CAPACITY"), (r"^ROOM$", "CAPACITY")]),
    ("src/ppe/cg*", {"turn": "redirect", "turns": "redirections", "tell": "report", "tellings": "reports", "GOING": "RUNNING"}, []),
    ("src/phase/layer_history.c", {"give": "write", "give_rows": "write_rows"}, []),
    ("src/phase/gas_pocket.c", {}, [(r"^give_(\w+)$", r"set_\1")]),
    ("src/core/engine/bodies_device.c", {"give_row": "write_row", "give_rows": "write_rows", "number_here": "number_on_rank"}, []),
    ("plugins/mpi/cuts.c", {"give_place": "set_position"}, []),
    # permutations, collections
    ("src/core/particles/particles.c", {"GATHER": "PERMUTE"}, [(r"^gather_(\w+)$", r"permute_\1")]),
    ("src/core/*", {"gathered": "collected", "gathered_run": "collected_run", "gathering": "collecting", "gather_parts": "collect_parts",
                     "gather_blocks": "collect_blocks"}, []),
    ("src/phase/density_interface.c src/phase/dissipation_radial.c src/post/stats/harmonics.c", {"gather": "collect"}, []),
    ("apps/mps/gather.c", {"gathering": "collection"}, []),
    # passes and verbs
    ("src/core/*", {"leave_device": "exit_device"}, []),
    ("src/core/engine/* src/core/step/*", {"everywhere": "with_ghosts"}, []),
    ("src/core/engine/runner.* src/core/engine/stage.c", {"taken": "switched"}, []),
    # messages
    ("src/core/motion/motion.h src/core/api/api_motion.c src/core/step/limits.c src/core/engine/* src/core/step/step_pressure.c",
     {"told": "logged", "told_solution": "logged_solution", "tell_failure": "log_failure", "tell_apart": "log_apart"}, []),
    ("src/core/measure/probes.*", {"lag_told": "lag_logged"}, []),
    ("src/core/handle/sim.h src/geometry/tanks/slots.c", {"slots_told": "slots_logged"}, []),
    ("src/geometry/tanks/* src/core/api/api_particles.c", {}, [(r"^tell_(\w+)$", r"log_\1")]),
    ("src/core/api/api_list.c", {}, [(r"^tell_(\w+)$", r"fill_\1")]),
    ("src/core/step/step_fluid.c", {"tell_result": "check_result"}, []),
    ("src/core/pressure/solvers.c src/core/world/world_fields.c", {"tell": "report"}, []),
    ("apps/mps/info.c", {"tell": "describe", "tells": "describes"}, [(r"^tell_(\w+)$", r"describe_\1")]),
    ("apps/mps/jobs.c", {"told": "stop_sent"}, []),
    ("apps/* src/case/job/*", {"say_difference": "print_difference", "say_end": "print_end", "say_failure": "print_failure",
                               "say_run": "print_run", "say_varied": "print_varied", "plan_say_open": "plan_print_open"}, []),
    ("src/case/job/*", {"say": "print", "tells": "prints", "TELLS": "PRINTS", "tell": "describe", "heard": "received"}, []),
    ("include/mps/job.h bindings/fmu/* tests/case/* tests/post/* tests/fmu/* tests/faults/* tests/oom/* tests/mpi/* examples/driver/* apps/mps/*",
     {"say": "print", "say_user": "print_user"}, []),
    ("src/case/job/*", {"say_user": "print_user"}, []),
    ("examples/plugins/inflow/check.c", {"say": "report"}, []),
    ("src/case/setup/*", {"say": "message", "say_log": "add_log"}, []),
    ("src/core/engine/plan.c", {"said": "declared"}, []),
    ("plugins/mpi/*", {"tell": "notify", "telling": "notifying", "hear": "receive", "heard": "received", "settle": "agree", "settled": "agreed"}, []),
    ("src/core/* src/geometry/* tests/*",
     {"twins": "memory", "twin": "mirror", "twin_of": "mirror_of", "twin_of_array": "mirror_of_array", "open_twin": "open_mirror"}, []),
    (_DEVICE_FILES, {"there": "on_device", "room_there": "workspace_device", "find_there": "find_device", "counts_there": "counts_device",
                     "looks_there": "looks_there"}, [(r"^(\w+)_there$", r"\1_device"), (r"^(\w+)_there_(rows)$", r"\1_device_\2")]),
    ("tests/conformance/test_auxgrid.c", {"there": "on_device", "here": "on_host"}, []),
    ("tests/unit/search_fixture.h tests/shadow/solutions.h", {"there": "on_device"}, []),
    ("src/core/pressure/ppe_device.c src/core/engine/reaction.* src/ppe/auxgrid/auxgrid.c", {"here": "on_host", "reserve_here": "reserve_on_host"}, []),
    ("src/core/pressure/bounds.c src/ppe/kernels.*", {"here": "on_this_rank"}, []),
    ("src/core/engine/runner.c", {"old": "ghosts_stale"}, []),
    ("src/core/engine/*", {"old": "stale", "is_old": "is_stale", "outdate": "invalidate", "was_old": "was_stale", "is_old_memory": "is_stale_memory",
                           "laters": "deferred", "later": "deferred", "came": "copied", "lives": "ranges"}, []),
    ("src/core/particles/particles.* src/core/world/world_ranks.c tests/shadow/test_lazy.c tests/shadow/test_setters.c", {"old": "stale"}, []),
    ("src/core/* tests/*", {"ahead": "next_flags"}, []),
    ("src/core/* src/geometry/* tests/shadow/* tests/unit/*",
     {"screens": "occluders", "screen": "occluder", "seers": "near_plates", "seer": "near_plate", "seer_capacity": "near_plate_capacity",
      "make_screens": "make_occluders", "near_screen": "near_occluder", "set_screen": "set_occluder"}, []),
    ("src/core/neighbours/* src/core/world/* src/core/engine/* tests/unit/*",
     {"rim": "boundary", "rims": "boundaries", "rims_of": "boundaries_of"}, []),
]

# Two names of a file may become one there: (file, new name), or a name everywhere.
MERGED = {("src/core/base/device.c", "block"), ("src/core/base/device.h", "block"), ("src/core/neighbours/neighbours.c", "capacity"),
          ("src/core/particles/particles.h", "stale"), ("src/core/world/world_ranks.c", "stale"), ("tests/abi/test_layout.c", "release"),
          ("tests/mpi/test_failing.c", "release"), ("tests/mpi/test_hypre.c", "release"), ("tests/shadow/shadow.c", "release"),
          ("tests/shadow/shadow.c", "block"), ("tests/unit/test_model_tables.c", "release")}
MERGED_NAMES: set[str] = set()

# ---- edits of texts: (files, regex, replacement)

_OPS = r"\b(ops|bad)(->|\.)"
_OPS_FILES = "src/core/base/device.c tests/device/*.c tests/shadow/*.c tests/cuda/*.c"
_INIT_FILES = "plugins/cuda/cuda.c tests/device/opencl.c tests/shadow/shadow.c"
_LAUNCH_FILES = ("include/mps/device.h plugins/cuda/* src/core/base/device.* src/device/* tests/device/* tests/cuda/* src/core/engine/stage.c "
                 "src/ppe/cg*.[ch] tests/shadow/shadow.* tests/shadow/solutions.h")
_VERBS = {"room": "alloc", "give": "free", "rows": "launch", "values": "reduce", "gather": "reduce_async", "outdated": "invalidated"}
EARLY = []  # before the names of some files
EDITS = []  # after them
for _old, _new in _VERBS.items():
    EARLY += [
        (_OPS_FILES, _OPS + _old + r"\b(?!\.)", rf"\1\2{_new}"),
        (_INIT_FILES, rf"^(\s+)\.{_old} = ", rf"\1.{_new} = "),
        ("include/mps/device.h", rf"\(\*{_old}\)\(void \*self", rf"(*{_new})(void *self"),
        ("*", rf"\bmps_device_ops\.{_old}\b", f"mps_device_ops.{_new}"),
    ]
EARLY += [
    ("include/mps/ppe.h", r"\(\*share\)\(void \*host", "(*halo)(void *host"),
    ("include/mps/ppe.h", r"->ranks->share\(", "->ranks->halo("),
    ("src/core/pressure/ppe_ranks.c", r"\.share = share_columns", ".halo = exchange_columns"),
    ("src/core/pressure/ppe_ranks.c", r"\bshare_columns\b", "exchange_columns"),
    ("src/core/pressure/levels.c", r"\branks\.share\(", "ranks.halo("),
    ("src/ppe/* tests/* plugins/*", r"\btable\.share\(", "table.halo("),
    ("tests/ranks/test_auxgrid.c", r"\.share = share\b", ".halo = exchange_halo"),
    ("tests/ranks/test_auxgrid.c", r"\bint share\(", "int exchange_halo("),
    ("src/post/page/curves.js", r"const room = \(hi - lo", "const margin = (hi - lo"),
    ("src/post/page/curves.js", r"0 : room\), hi \+ room", "0 : margin), hi + margin"),
    (_INIT_FILES, r"\.alloc = room,", ".alloc = take_block,"),
    (_INIT_FILES, r"^static void \*room\(", "static void *take_block("),
]
EDITS += [
    ("src/core/api/api_ranks.c src/core/handle/sim.h tests/ranks/test_refusals.c include/mps/*.h",
     r"\b(not gathered|gathered already|are gathered|is gathered)\b", lambda m: m.group().replace("gathered", "collected")),
    # texts of messages, and the tests that look for them
    ("src/core/base/device.c", r"\boutdated\b", "invalidated"),
    ("src/core/base/device.c tests/ranks/test_devices.c", r"has no room\b", "has no memory"),
    ("tests/cuda/test_cuda.c", r"memory \? \"room\"", 'memory ? "no memory"'),
    ("src/core/pressure/solvers.c", r"no room for %s '%s': all %d places are taken", "cannot register %s '%s': all %d places are taken"),
    ("src/geometry/tanks/api_solid.c", r"\"room is %lld", '"capacity is %lld'),
    ("tests/unit/test_stl_edges.c", r"MPS_E_ARG, \"room\"", 'MPS_E_ARG, "capacity"'),
    ("src/case/job/folder.c", r"make room on it", "free space on it"),
    ("tests/device/opencl.c", r"\b(to|of) no room\"", r'\1 no block"'),
    ("tests/device/opencl.c", r"\"no room for", '"no memory for'),
    ("tests/shadow/test_solver.c", r"coarser grids %d, wires %d", "coarser grids %d, edges %d"),
    ("include/mps/geometry.h", r"@param room  ", "@param capacity"),
    ("include/mps/geometry.h", r"@param capacity +number of edges that `ends` has room for", "@param capacity  number of edges that fit in `ends`"),
    ("include/mps/geometry.h src/geometry/shapes/mesh.h", r"\[6\*room\]", "[6*capacity]"),
    ("include/mps/geometry.h", r"; NULL where (room|capacity) is 0$", ";\n *                 NULL where capacity is 0"),
    ("src/post/page/curves.js src/post/page/main.js", r"\broom\b(?!s)", "panel"),
    ("src/post/page/*.js tests/page/*", r"\brooms\b", "pockets"),
    ("src/post/page/view.js", r"\broom\b", "number"),
    ("src/post/stats/statistics_write.c", r"\ball_there\b", "all_given"),
    ("src/core/base/device.h", r"void \*block;$", "void *data;"),
    ("src/core/base/device.c", r"\bd->block\[k\]\.block\b", "d->block[k].data"),
    ("bindings/python/mps/case.py", r"\bconfig\.say\b", "config.print"),
    ("bindings/python/mps/_records.py", r"\"say\", \"say_user\"", '"print", "print_user"'),
    ("src/ppe/* tests/conformance/* tests/ranks/* bench/*", r"\bkernels\.(h|c)\b", r"rows.\1"),
    ("src/ppe/*", r"\bMPS_PPE_KERNELS_H\b", "MPS_PPE_ROWS_H"),
    ("scripts/device_rows", r"ROOT / \"src/device\", \*(rooms|modules)", 'ROOT / "src/device", ROOT / "src/ppe", *modules'),
    ("scripts/check", r"-Isrc/device \"\$\{modules", '-Isrc/device "${modules'),
    ("tests/sundials7/run", r"for source in src/ppe/\*\.c; do", "for source in src/ppe/*.c src/ppe/auxgrid/*.c; do"),
    ("tests/sundials7/run", r"-Iinclude -Isrc/core/base -f", "-Iinclude -Isrc/ppe -Isrc/core/base -f"),
    ("include/mps/device.h", r"void \(\*free\)\(void \*self, void \*room\)", "void (*free)(void *self, void *block)"),
    ("include/mps/device.h", r"Free memory of `room`", "Free memory of `alloc`"),
    (_LAUNCH_FILES, r"(?<![\w\"])unless(?=;|\b[,)\s]*[;,)=&])(?![ ]\w)", "cancel"),
    (_LAUNCH_FILES, r"(->|\.)unless\b", r"\1cancel"),
    (_LAUNCH_FILES, r"`unless`", "`cancel`"),
    (_LAUNCH_FILES, r"(->|\.)skip\b", r"\1mask"),
    (_LAUNCH_FILES, r"\*skip;", "*mask;"),
    ("*", r"\bmps_launch\.unless\b", "mps_launch.cancel"),
    ("*", r"\bmps_launch\.skip\b", "mps_launch.mask"),
    ("src/core/* tests/*", r"\b(memory|t)(\.|->)place == MPS__ON", r"\1\2space == MPS__ON"),
    ("src/core/step/step_books.c", r"\bt->place\b", "t->space"),
    ("src/core/* tests/*", r"\bmemory\.gone\b", "memory.lost"),
    # the struct that runs verbs, as a member of the world
    ("src/core/* src/geometry/* tests/*", r"\b(w|world)(->|\.)host\b", r"\1\2runner"),
    ("src/core/*", r"\bmps__runner host;", "mps__runner runner;"),
    # the build
    ("CMakeLists.txt", r"\bcore_rooms\b", "core_modules"),
    ("CMakeLists.txt src/case/CMakeLists.txt", r"\badd_(case_)?room\b", r"add_\1module"),
    ("CMakeLists.txt src/case/CMakeLists.txt", r"foreach\(room\b", "foreach(module"),
    ("CMakeLists.txt src/case/CMakeLists.txt", r"\$\{room\}", "${module}"),
    ("CMakeLists.txt", r"core/models core/pressure core/world core/step\n", "core/models core/engine core/pressure\n    core/world core/voids core/step"),
    ("CMakeLists.txt", r"core/step\s+core/measure", "core/step core/measure"),
    ("CMakeLists.txt", r"^add_module\(mps_ppe src/ppe src/core/base\)(.*)$",
     r"add_module(mps_ppe src/ppe src/ppe/auxgrid src/core/base)\1\n"
     "add_module(mps_auxgrid src/ppe/auxgrid src/ppe src/core/base)"),
    ("src/case/CMakeLists.txt", r"set\(rooms case/", "set(modules case/"),
    ("src/case/CMakeLists.txt", r"\$\{rooms\}", "${modules}"),
    ("src/case/CMakeLists.txt", r"if\(room MATCHES \"job\|build\"\)", 'if(module MATCHES "job|setup")'),
    ("src/case/CMakeLists.txt", r"^add_case_module\(mps_post \$\{post\} \$\{text\}\)$",
     "set(post_modules \"\")\n"
     "foreach(module read stats picture page)\n"
     "  list(APPEND post_modules ${post}/${module})\n"
     "  add_case_module(mps_post_${module} ${post}/${module} ${post_modules} ${text})\n"
     "endforeach()"),
    ("src/case/CMakeLists.txt", r"target_sources\(mps_post PRIVATE", "target_sources(mps_post_page PRIVATE"),
    ("src/case/CMakeLists.txt", r"list\(APPEND below \$\{post\}\)", "list(APPEND below ${post_modules})"),
    ("src/case/CMakeLists.txt", r"\$\{MPS_CASE_MODULES\} \$\{post\} \$\{text\}", "${MPS_CASE_MODULES} ${post_modules} ${text}"),
    ("CMakeLists.txt src/case/CMakeLists.txt", r"# A room is an object", "# A module is an object"),
    ("CMakeLists.txt src/case/CMakeLists.txt", r"\bthose of the rooms before it\b", "those of the modules before it"),
    ("src/case/CMakeLists.txt", r"^# Rooms, each sees its own headers and those of the modules before it; src/post sees its own alone\.$",
     "# Modules, each sees its own headers and those of the modules before it; those of src/post see no others."),
    ("tests/CMakeLists.txt", r"libmps_case: its rooms are", "libmps_case: its modules are"),
    ("tests/cases/test_folder.sh", r"make room on it", "free space on it"),
    # layers
    ("scripts/layers", r"\bROOMS\b", "MODULES"),
    ("scripts/layers", r"\bCASE_ROOMS\b", "CASE_MODULES"),
    ("scripts/layers", r"\b(case_)?room\(", r"\1module("),
    ("scripts/layers", r"\bcase_room\b", "case_module"),
    ("scripts/layers", r"which is no room; rooms are", "which is no module; modules are"),
    ("scripts/layers", r"which is in no room", "which is in no module"),
    ("scripts/layers", r"its room;? rooms have an order", "its module; modules have an order"),
    ("scripts/layers", r"the folder of its room\b", "the folder of its module"),
    ("scripts/layers", r"^# Rooms from the ground up: a file includes its own room and those below\. Each room of", "# Modules from the ground up: a file includes its own module and those below. Each module of"),
    ("scripts/layers", r"^# Rooms of libmps_case, likewise; src/post sees public headers, its own files and those of src/text, and only job and build see it\.$",
     "# Modules of libmps_case, in the same order; only src/case/job and src/case/setup see those of src/post."),
    ("scripts/layers", r"the room of each file name", "the module of each file name"),
    ("scripts/layers", r"\"core/models\", \"core/pressure\",\n\s+\"core/world\", \"core/step\"",
     '"core/models", "core/engine",\n         "core/pressure", "core/world", "core/voids", "core/step"'),
    ("scripts/layers", r"\[\"text\", \"post\", \"case/text\"", '["text", "post/read", "post/stats", "post/picture", "post/page", "case/text"'),
    ("scripts/layers", r"SEE_POST = \{\"post\", ", 'SEE_POST = {'),
    ("scripts/layers", r"return parts\[0\] if parts\[0\] in \(\"post\", \"text\"\) else", 'return parts[0] if parts[0] == "text" else'),
    ("scripts/layers", r"\(other == \"post\" and own not in SEE_POST\)", '(other.startswith("post/") and not own.startswith("post/") and own not in SEE_POST)'),
    ("scripts/layers", r"particles/ghosts_there\.c", "particles/ghosts_device.c"),
    ("scripts/layers", r"\"src/post/\*\.\[ch\]\"", '"src/post/*/*.[ch]"'),
    ("scripts/layers", r"\"src/ppe/\*\.\[ch\]\"\)", '"src/ppe/*.[ch]", "src/ppe/*/*.[ch]")'),
    ("scripts/layers", r"\"src/ppe/\*\", \"plugins", '"src/ppe/*.*", "src/ppe/*/*.*", "plugins'),
    ("scripts/layers", r"path\.parent\.name != \"ppe\"", '"ppe" not in path.parts'),
    ("scripts/analyse", r"\"src\", \"src/post\", \"src/text\"", '"src", "src/text"'),
    ("scripts/device_rows scripts/check", r"\brooms\b", "modules"),
    ("scripts/check", r"^    local modules$", "    local modules"),
    ("scripts/device_rows tests/device/test_rows.c", r"\btransfer__(clear|sum|add)_turns\b", r"transfer__\1_visits"),
]
EDITS += [
    ("docs/architecture.md", r"^\| `src/core/models` \|.*\|.*`plan\.c`.*\|$",
     "| `src/core/engine` | what runs a step: plan, liveness, memory of the device, loops | `runner.c`, `plan.c`, `device_memory.c`, `stage.c` |\n"
     "| `src/core/models` | registry of models, channels, presets | `models.c`, `channels.c`, `presets.c` |"),
    ("docs/architecture.md", r"^(\| `src/core/world` \|.*), `voids_\*\.c` \|$",
     r"| `src/core/voids` | void spaces of the tank | `voids.c`, `voids_*.c` |\n\1 |"),
    ("docs/architecture.md", r"^\| `src/post` \| in `libmps_case`: statistics, pages, pictures, from the folder of a run \|",
     "| `src/post` | in `libmps_case`, from the folder of a run: `read`, `stats`, `picture`, `page` |"),
]

# What must be in a file afterwards: (file, text).
REQUIRED = [
    ("CMakeLists.txt", "core/models core/engine"), ("CMakeLists.txt", "core/voids"), ("CMakeLists.txt", "add_module(mps_auxgrid"),
    ("src/case/CMakeLists.txt", "mps_post_${module}"), ("src/case/CMakeLists.txt", 'MATCHES "job|setup"'),
    ("src/case/CMakeLists.txt", "target_sources(mps_post_page"), ("scripts/layers", '"core/engine"'), ("scripts/layers", '"post/read"'),
    ("scripts/layers", "engine/stage.c"), ("scripts/layers", "particles/ghosts_device.c"), ("scripts/device_rows", '"src/ppe", *modules'),
    ("tests/sundials7/run", "src/ppe/auxgrid/*.c"), ("include/mps/device.h", "(*alloc)(void *self"), ("include/mps/device.h", "*cancel;"),
    ("include/mps/device.h", "*mask;"), ("include/mps/ppe.h", "(*halo)(void *host"), ("plugins/cuda/cuda.c", ".launch = "),
    ("tests/shadow/shadow.c", ".reduce_async = "), ("scripts/coverage", "src/core/engine/guard.c"),
]

# Sentences that had a private word in a comment: (old, new), in every file that has them.
TEXTS = [
    ("in room that keeps malloc's alignment", "in bytes that keep malloc's alignment"),
    ("(`outdated` of the table", "(`invalidated` of the table"),
    ("/** C, likewise, by rates [N s/m, N s, N m s]. */", "/** C, in the same order, by rates [N s/m, N s, N m s]. */"),
    ("/** What a case amounts to: particles,", "/** What a case is made of: particles,"),
    ("along the face. The moment likewise, about the place", "along the face. The moment is about the place"),
    ("/** The same of numbers; it waits for ever. */", "/** Largest of each number over all ranks; it waits for ever. */"),
    (" *  @param greatest  likewise */", " *  @param greatest  NULL, or [MPS_PHASES] out: the greatest of each phase [kg/m3] */"),
    (" *  room for n + ghosts values. */", " *  n + ghosts elements. */"),
    ("that is not free of the null space: likewise, with", "that is not free of the null space: the same, with"),
    ("/** [from_count] likewise */", "/** [from_count] their numbers, ascending, never the own one */"),
    (" *  @param in  likewise, from route->from */", " *  @param in  out: elements from route->from[0], then from from[1], ... */"),
    ("/** Pairs within re_far, likewise. Row i", "/** Pairs within re_far. Row i"),
    ("/** Likewise, with the first downcrossing of s P after t_P [s]. */",
     "/** (t_e - t_P)/(1 - s), t_e the first downcrossing of s P after t_P [s]. NAN: not in the\n     *  record. */"),
    ("/** Likewise for the generalised Pareto distribution. The search", "/** Fit the generalised Pareto distribution. The search"),
    ("Vectors in structs always have room for three; in 2-D", "Vectors in structs always have three elements; in 2-D"),
    ("# the same of the panel: peaks, impulse; empty without one", "# peaks and impulse of the panel; empty without one"),
    ("with some room, and must go on doing so", "with some margin, and must continue to do so"),
    ("/* without room for a text there is the status alone */", "/* without memory for a text there is the status alone */"),
    ("/* The same of the particles, as what they lack", "/* That sum over the particles, as what they lack"),
    ("/* The same of linear theory, with a damping", "/* The response of linear theory, with a damping"),
    ("/* The room that holds these bytes. */", "/* The block that holds these bytes. */"),
    ("/* later there is room */", "/* later there is memory */"),
    ("some are made to get room, others", "some are made to allocate, others"),
    ('"more kernels than the test has room for"', '"more kernels than the table of the test has entries"'),
    ("/* bytes that they have room for */", "/* their capacity in bytes */"),
    ("/* A config with room for a text, and", "/* A config with a buffer for a text, and"),
    ("/* Texts that leave no room for a film,", "/* Texts that leave no space for a film,"),
    ("/* pieces of room that rank 0 has */", "/* blocks that rank 0 may allocate */"),
    ("/* Rank 0 runs out of room at one place", "/* Rank 0 runs out of memory at one place"),
    ("behind no room or behind one. */", "behind no block or behind one. */"),
    ("/* The room of an address, -1:", "/* The block of an address, -1:"),
    ("Only the functions of the device open its rooms.", "Only the functions of the device open its blocks."),
    ("they stay open. Rooms lie one behind", "they stay open. Blocks are one behind"),
    ("/* room is refused, */", "/* memory is refused, */"),
    ("/* memory of all rooms; NULL: there are none */", "/* memory of all blocks; NULL: there are none */"),
    ("are found by the host, which has room for them. */", "are found by the host, which has memory for them. */"),
    ("/* A step for which the device has no room fails and changes nothing; the next has room. */",
     "/* A step for which the device has no memory fails and changes nothing; the next has memory. */"),
    ("were built and stand still; the fluid likewise. */", "were built and stand still, and so does the fluid. */"),
    ("the room behind them, and no number more, is written. */", "the elements behind them, and no number more, are written. */"),
    ("more pairs than there was room for, or fewer. */", "more pairs than the capacity, or fewer. */"),
    ("/* Without room for another stack loops", "/* Without memory for another stack loops"),
    ("/* The same of a first velocity 1, and", "/* That of a first velocity 1, and"),
    ("/* The same of u = exp(i w t)", "/* That of u = exp(i w t)"),
    ("there is no room to look for a slope", "there is no space to look for a slope"),
    ("does not have room for in the stack: the loops tell, and fill nothing. */",
     "cannot hold on the stack: the loops report it, and fill nothing. */"),
    ("as much as there is room for. */", "as much as fits. */"),
    ("/* A verb that asks for more than there is room for fails,", "/* A verb that requests more than there is memory for fails,"),
    ("it goes on growing. */", "it keeps growing. */"),
    (" * goes on doing so. */", " * continues to do so. */"),
    ("A run that still goes on has no summary", "A run in progress has no summary"),
    ("and those of a run that still goes on. */", "and those of a run in progress. */"),
]
PATHS.append((r"\bgoes on\b", "continues", ["tests/*", "include/mps/job.h"]))
