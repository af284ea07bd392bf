#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# A driver in C and its case file give the same bytes of probes.csv and of frames: the language can say all that a driver does.
# usage: test_same_bytes.sh DRIVERS PROGRAM CASES [NAME ..]
drivers=$1 program=$2 cases=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

# name, time simulated [s]: some tens of steps
times="air_cushion 0.004
cylinder_tank 0.05
dam_break 0.06
droplet 0.002
impact 0.08
rayleigh_taylor 0.05
rising_bubble 0.02
sloshing_baffle_2d 0.06
sloshing_baffle_3d 0.06
sloshing_breaking 0.06
sloshing_high_fill 0.06
sloshing_low_fill 0.04
sloshing_roll 0.08
sloshing_surge 0.05
standing_wave 0.05
static_tank 0.05
static_two_fluid 0.02"

# a driver has no body that the library moves: these cases have `body`
count=$(grep -L "^body:" "$cases"/*.yaml | wc -l)
if [ "$count" -ne "$(wc -l <<< "$times")" ]; then
    echo "FAILED: $count case files, $(wc -l <<< "$times") drivers"
    exit 1
fi

while read -r name t; do
    [ $# -gt 0 ] && [[ " $* " != *" $name "* ]] && continue
    a=$work/$name.c b=$work/$name.yaml
    "$drivers/$name" --t-end "$t" --out "$a" --frames 2 --quiet --no-report --threads 1 > "$work/log" 2>&1 || {
        echo "FAILED: $name: the driver"; cat "$work/log"; failed=1; continue; }
    "$program" run "$cases/$name.yaml" --set "run.until=$t s" --set output.frames=2 --set "output.page=0 MB" -j 1 -o "$b" --quiet \
        > "$work/log" 2>&1 || { echo "FAILED: $name: the case"; cat "$work/log"; failed=1; continue; }
    rows=$(wc -l < "$a/probes.csv")
    [ "$rows" -ge 3 ] || { echo "FAILED: $name: $rows rows"; failed=1; }
    for file in probes.csv frames/frames_000000.vtp frames/frames_000001.vtp frames/frames_000002.vtp; do
        [ -e "$a/$file" ] || { echo "FAILED: $name: no $file"; failed=1; continue; }
        cmp "$a/$file" "$b/$file" || failed=1
    done
done <<< "$times"
[ $failed -eq 0 ] && echo "17 drivers and case files: the same bytes"
exit $failed
