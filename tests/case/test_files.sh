#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Case files that no driver in C repeats: columns of probes.csv, particles, outputs, first values against exact ones, and variants by --set.
# usage: test_files.sh PROGRAM CASES
program=$1 cases=$2 examples=$(realpath "$(dirname "$0")/../../examples")
. "$(dirname "$0")/program_kit.sh"
shopt -s nullglob

runs() { # folder, case, values..
    local folder=$1 case=$2 value set=()
    shift 2
    for value in "$@"; do set+=(--set "$value"); done
    expect 0 "" "$program" run "$case" -o "$folder" -j 1 -q --set "run.until=20 ms" --set output.frames=0 --set "output.page=0 MB" "${set[@]}"
}

tested=
file() { # case, dp, fluid particles, header wanted, values..
    local name=$1 header key column
    tested+=" $name"
    runs "$name" "$cases/$name.yaml" "dp=$2" output.frames=2 "output.page=12 MB" "${@:5}"
    [ -s log ] && fail "$name -q says: $(cat log)"
    [ -s "$name/probes.csv" ] || return
    for key in probes.csv momentum.csv steps.csv summary.json frames.pvd picture_1.png picture_end.png report.html; do
        [ -s "$name/$key" ] || fail "$name/$key is missing or empty"
    done
    header=$(head -1 "$name/probes.csv")
    case $header in "$4"*) ;; *) fail "$name/probes.csv begins $header" ;; esac
    [ "$(wc -l < "$name/probes.csv")" = 22 ] || fail "$name/probes.csv has $(wc -l < "$name/probes.csv") lines, not 22"
    awk -F, 'NR == 1 {n = NF} NF != n {exit 1} NR > 1 && ($1 - (NR - 2) * 1e-3) ^ 2 > 1e-24 {exit 1} /nan/ {exit 1}' "$name/probes.csv" ||
        fail "$name/probes.csv: rows are not complete or not every 1e-3 s"
    for key in case model dp n_fluid n_wall n_dummy steps t_end volume_error max_speed status version threads; do
        grep -q "^  \"$key\": " "$name/summary.json" || fail "$name/summary.json has no $key"
    done
    grep -q '"status": "ok"' "$name/summary.json" || fail "$name: status is not ok"
    grep -q "\"n_fluid\": $3," "$name/summary.json" || fail "$name has $(grep n_fluid "$name/summary.json"), not $3"
    for column in $(tr , '\n' <<< "$header" | sed 's/\[.*//' | grep -vx t); do
        grep -q "{\"name\": \"$column\", .*\"about\": \"..*\"}" "$name/summary.json" || fail "$name/summary.json says nothing about $column"
    done
}
value_is() { # folder, column, row (1: t = 0), value, tolerance
    local column
    column=$(head -1 "$1/probes.csv" | tr , '\n' | grep -n "^$2\(\[\|\$\)" | cut -d: -f1)
    awk -F, -v c="$column" -v row="$3" -v v="$4" -v e="$5" 'NR == row + 1 {exit !(($c - v) ^ 2 <= e * e)}' "$1/probes.csv" ||
        fail "$1: $2 in row $3 is $(sed -n "$(($3 + 1))p" "$1/probes.csv" | cut -d, -f"$column"), not $4 +- $5"
}
other() { # folder, folder: not the same run
    cmp -s "$1/probes.csv" "$2/probes.csv" && fail "$1 is the same as $2"
}

file sloshing_roll "31 mm" 82 't[s],roll[deg],P_left[Pa],P_right[Pa],eta_left[m],eta_quarter[m],eta_right[m],angle[deg],ke[J/m],x_tank[m]'
file standing_wave "25 mm" 780 't[s],eta_left[m],x_centre[m],ke[J/m],x_tank[m]'
file rising_bubble "50 mm" 741 't[s],yc[m],v[m/s],circularity,ke[J/m],x_tank[m],pe[J/m]'
file rising_bubble_2 "50 mm" 741 't[s],yc[m],v[m/s],circularity,ke[J/m],x_tank[m],pe[J/m]'
file droplet "1 mm" 361 't[s],dp[Pa],rx[m],ke[J/m],x_tank[m],pe[J/m]'
file droplet_oscillation "1 mm" 361 't[s],dp[Pa],rx[m],ke[J/m],x_tank[m],pe[J/m]'
file air_cushion "20 mm" 931 't[s],x_slug[m],ke[J/m],x_tank[m],pe[J/m]'
file cylinder_tank "50 mm" 524 't[s],surge[m],P_bottom[Pa],eta_middle[m],eta_left[m],F_x[N],F_y[N],ke[J],x_tank[m]'
for case in "$cases"/*.yaml; do # what a body moves is for case/anti_roll
    name=$(basename "$case" .yaml)
    [ -e "$examples/$name.c" ] || grep -q '^body:' "$case" || [[ " $tested " == *" $name "* ]] || fail "$name has no driver and is not tested"
done

value_is rising_bubble yc 1 0.5 0.02
value_is rising_bubble circularity 1 1 0.03
value_is droplet rx 1 0.005 2e-4
value_is sloshing_roll angle 1 0 0
value_is air_cushion x_slug 1 0 0
value_is standing_wave eta_left 1 0.02 2e-3
value_is cylinder_tank surge 21 0.00191706 1e-7 # 0.02 sin(4.8 0.02)
awk -F, 'NR == 1 {for (i = 1; i <= NF; i++) if ($i ~ /^P_bottom/) c = i} END {exit !(($c / (1000 * 9.81 * 0.25) - 1) ^ 2 < 0.04)}' cylinder_tank/probes.csv ||
    fail "cylinder_tank: P_bottom is not rho g 0.25 m: $(tail -1 cylinder_tank/probes.csv)"
# potential flow of the second mode has pi/4 R^4 (0.05 w)^2 (rho_i + rho_o), w^2 = 6 sigma/((rho_i + rho_o) R^3)
value_is droplet_oscillation ke 1 "$(awk 'BEGIN {print atan2(1, 1) * 0.005 * 0.05 ^ 2 * 6 * 0.0727}')" 4e-7 # of the circle; at this dp the lattice has 7 % more
value_is droplet ke 1 0 0
other rising_bubble_2 rising_bubble
grep -q '"label": "sigma/R"' droplet/report.html || fail "droplet/report.html has no sigma/R"

runs free "$cases/droplet_oscillation.yaml" "dp=1 mm" "run.until=2 ms" "settings.tension.sigma=0 N/m"
value_is free ke 1 0 0
runs water "$cases/sloshing_roll.yaml" "dp=31 mm" "fluids.oil={density: 998 kg/m3, viscosity: 0.894 mPa s}"
other water sloshing_roll
runs jump "$cases/sloshing_roll.yaml" "dp=31 mm" "motion.roll={amplitude: 2 deg, period: 0.85 T1}"
value_is jump angle 21 0.154081 1e-6 # 2 sin(2 pi 0.02/1.62953)
runs roll_3d "$cases/sloshing_roll.yaml" "dp=15.5 mm" dim=3 "run.until=5 ms"
grep -q '"dim": 3,' roll_3d/summary.json || fail "sloshing_roll in 3-D has $(grep '"dim"' roll_3d/summary.json)"
runs drop_paper "$cases/droplet.yaml" "dp=1 mm" "run.until=2 ms" model=mmps.paper # without gravity nothing is uppermost
# a model for one liquid, for comparison: with what two cannot do without
runs drop_one "$cases/droplet.yaml" "dp=1 mm" "run.until=2 ms" model=imps "use=tension.csf" "settings.tension.sigma=0.01 N/m"
runs cushion_one "$cases/air_cushion.yaml" "dp=20 mm" model=imps use=gas.compressible "settings={gas.sound: 340 m/s}"
expect 2 "to compare both, add" "$program" run "$cases/droplet.yaml" -o refused --set model=imps --set use=gradient.conservative

# a tank from a file: a box of 600 x 400 x 300 mm, two triangles a face
awk 'BEGIN {
    split("0 0 0 600 0 0 600 400 0 0 400 0 0 0 300 600 0 300 600 400 300 0 400 300", c)
    split("1432 5678 1265 3487 2376 1584", face)
    print "solid box"
    for (f = 1; f <= 6; f++)
        for (h = 0; h < 2; h++) {
            print "facet normal 0 0 0\nouter loop"
            for (k = 1; k <= 3; k++) {
                v = substr(face[f], k == 1 ? 1 : k + h, 1)
                print "vertex", c[3 * v - 2], c[3 * v - 1], c[3 * v]
            }
            print "endloop\nendfacet"
        }
    print "endsolid box"
}' >box.stl
box="{stl: box.stl, unit: mm}" sensors="{P: {wall: 300 0 150 mm}}"
runs box "$cases/cylinder_tank.yaml" "dp=50 mm" "tank=$box" "sensors=$sensors"
grep -q '"n_fluid": 220,' box/summary.json || fail "the box from a file has $(grep n_fluid box/summary.json), not 220 = 11 x 4 x 5"
head -8 box.stl > torn.stl
expect 2 "torn.stl" "$program" run "$cases/cylinder_tank.yaml" -o torn --set "tank=${box/box.stl/torn.stl}" --set "sensors=$sensors"

[ $failed -eq 0 ] && echo "$(wc -w <<< "$tested") case files without a driver are in order"
exit $failed
