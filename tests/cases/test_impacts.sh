#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Impacts: what walls report is what the fluid receives, impulses and forces are the exact ones, whatever the length of the step.
# usage: tests/cases/test_impacts.sh FOLDER_OF_DRIVERS
set -uo pipefail
. "$(dirname "$0")/drivers.sh"

impact() { # folder, options of the driver...
    runs 0 impact --quiet --no-report --frames 0 --out "$1" --case "${@:2}"
}

value() { # folder, figure
    sed -n "s/^  \"$2\": \([-+.e0-9]*\),\{0,1\}$/\1/p" "$1/summary.json"
}

# A figure, or a number, lies between two factors of another one.
between() { # folder, figure, least factor, largest factor, figure or number
    local is against=$5
    is=$(value "$1" "$2")
    [[ $against =~ ^[-+.0-9] ]] || against=$(value "$1" "$5")
    awk -v is="$is" -v lo="$3" -v hi="$4" -v ref="$against" 'BEGIN {exit !(is != "" && is >= lo * ref && is <= hi * ref)}' ||
        fail "$1: $2 is ${is:-missing}, not $3 to $4 times $5 ($against)"
}

# exact impulses at the bottom, on the whole wall and of the fluid, independent of the step
for cfl in 0.1 0.3; do
    impact "flat_$cfl" flat --dp 0.025 --cfl $cfl
    between "flat_$cfl" impulse_bottom 0.95 1.05 exact_bottom
    between "flat_$cfl" impulse_mean 0.95 1.05 exact_mean
    between "flat_$cfl" impulse_fluid 0.95 1.05 exact_mean
    between "flat_$cfl" impulse_force_late 0.95 1.05 impulse_fluid_late
    between "flat_$cfl" force_before -1e-9 1e-9 1
done
impact slice flat --dim 3 --dp 0.05
between slice impulse_fluid 0.92 1.08 exact_mean
between slice impulse_force_late 0.9 1.1 impulse_fluid_late

# a film of two rows: the wall has what the fluid lost and what the half cells of the floor carry
for cfl in 0.05 0.1 0.2 0.4; do
    impact "film_$cfl" film --rows 2 --cfl $cfl
    between "film_$cfl" impulse_walls 1.06 1.44 impulse_fluid
done

impact jet jet --dp 0.05
between jet stagnation 0.95 1.05 1
between jet force_fluid 0.95 1.05 1
between jet force_walls 0.95 1.05 1

# 20 dp wetted and a small block: no exact force, but walls and fluid agree
impact wedge wedge --deadrise 30 --dp 0.01 --block 1
between wedge force_mean 0.95 1.05 force_fluid
between wedge cp_2dp 0.85 1.1 6.93

impact column column --dp 0.025
between column before -0.01 0.01 1
between column impulse_fluid 0.95 1.05 1
between column impulse_walls 0.95 1.05 1
between column rebound -1 0.02 1
between column still 0.98 1.02 1
between column least -0.1 2 1

# nothing holds the liquid back where the void reaches
impact floor floor --dp 0.025
between floor middle_least_mean -0.1 2 1
between floor rim_least_mean -0.1 2 1
between floor gap 0.9 1.1 1

[ $failures = 0 ] || { echo "$failures failures"; exit 1; }
