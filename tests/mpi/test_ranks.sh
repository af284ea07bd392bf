#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Each driver in 2-D and 3-D writes the same bytes on several ranks as on one: all columns, frames,
# pictures and checkpoints. 77: MPI cannot start ranks. Cases run on 2, 3, 4, 5 ranks in turn; with
# "all" each case runs on all of these.
# usage: tests/mpi/test_ranks.sh FOLDER_OF_DRIVERS MPIRUN [all]
export LC_ALL=C # awk, printf and sort take numbers with a point
set -uo pipefail
. "$(dirname "$0")/ranks.sh"

tested= turn=0
while read -r name options; do
    read -ra options <<<"$options"
    tested+=" ${options[0]}"
    options+=(--frames 1 --no-report)
    runs 0 "${options[@]}" --out "$name.1"
    counts=$((2 + turn++ % 4))
    [ "${3:-}" != all ] || counts="2 3 4 5"
    for n in $counts; do
        ranks 0 $n "${options[@]}" --out "$name.$n"
        same "$name.1" "$name.$n"
        grep -q "\"ranks\": $n" "$name.$n/summary.json" || fail "$name.$n/summary.json does not tell its ranks"
    done
done <<'CASES'
dam dam_break --solver sundials.pcg/jacobi --dp 0.02 --t-end 0.1 --checkpoint 0.05
dam_3d dam_break --dim 3 --dp 0.05 --t-end 0.2
surge sloshing_surge --dp 0.03 --t-end 0.1
high_fill sloshing_high_fill --dp 0.03 --t-end 0.1
high_fill_air sloshing_high_fill --model mmps --dp 0.05 --t-end 0.02
low_fill sloshing_low_fill --dp 0.015 --t-end 0.05
breaking_air sloshing_breaking --model mmps --dp 0.03 --t-end 0.03 --checkpoint 0.03
breaking_3d sloshing_breaking --dim 3 --dp 0.03 --width 0.12 --t-end 0.02
baffle_2d sloshing_baffle_2d --dp 0.02 --t-end 0.05
baffle_3d sloshing_baffle_3d --dp 0.025 --t-end 0.02
static static_tank --dp 0.03 --t-end 0.1
static_3d static_tank --dim 3 --dp 0.05 --t-end 0.05
two_fluid static_two_fluid --dp 0.05 --t-end 0.05
taylor rayleigh_taylor --dp 0.05 --t-end 0.05
flat impact --case flat --dp 0.05 --probe-dt 1e-3
flat_3d impact --case flat --dim 3 --dp 0.1 --t-end 0.06 --cfl 0.1 --probe-dt 1e-3
film impact --case film --dp 0.05 --checkpoint 1
film_3d impact --case film --dim 3 --dp 0.1 --t-end 0.06 --cfl 0.1 --probe-dt 1e-3
wedge impact --case wedge --dp 0.05
jet impact --case jet --dp 0.1 --t-end 0.5
column impact --case column --dp 0.05 --t-end 0.1
column_3d impact --case column --dim 3 --dp 0.1 --t-end 0.1
floor impact --case floor --dp 0.05 --t-end 0.1
floor_3d impact --case floor --dim 3 --dp 0.1 --t-end 0.1
box impact --case box --dp 0.04 --t-end 0.05
box_3d impact --case box --dim 3 --dp 0.064 --t-end 0.02
CASES
for source in "$here"/../../examples/*.c; do
    [[ " $tested " == *" $(basename "$source" .c) "* ]] || fail "$(basename "$source" .c) is not tested on ranks"
done
[ $failures = 0 ]
