#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Command line and outputs of the drivers: wrong values are refused by name, outputs are complete,
# exit codes are kept.
# usage: tests/cases/test_drivers.sh FOLDER_OF_DRIVERS
export LC_ALL=C # awk, printf and sort take numbers with a point
set -uo pipefail
sources=$(realpath "$(dirname "$0")/../..")
. "$(dirname "$0")/drivers.sh"

refused() { # text that must be in the message, driver, options...
    local text=$1 message code
    shift
    message=$("$drivers/$1" "${@:2}" 2>&1 >/dev/null)
    code=$?
    [ $code = 2 ] || fail "$*: exit $code instead of 2"
    grep -qF -- "$text" <<<"$message" || fail "$*: says '$message', not '$text'"
}

has() { # folder, files...
    local file
    for file in "${@:2}"; do [ -s "$1/$file" ] || fail "$1/$file is missing or empty"; done
}

refused '--dp 0: must be a number, 0.0005 to 0.05' static_tank --dp 0
refused '--dp 1: must be' static_tank --dp=1
refused '--dp nan: must be' static_tank --dp nan
refused '--dt 0: must be a number greater than 0, at most 0.1' sloshing_surge --dt 0
refused '--dt is longer than --t-end' sloshing_surge --dt 0.1 --t-end 0.05
refused '--cfl -1: must be' sloshing_surge --cfl -1
refused '--t-end 1e9: must be' static_tank --t-end 1e9
refused '--threads 1.5: must be a whole number, 1 to 1024' static_tank --threads 1.5
refused '--frames -1: must be' static_tank --frames -1
refused '--checkpoint 1e-300: must be a number, 1e-06 to' static_tank --checkpoint 1e-300
refused '--dim 4: must be a whole number, 2 to 3' static_tank --dim 4
refused 'unknown option --dim' sloshing_surge --dim 3
refused 'unknown option --bogus' static_tank --bogus
refused '--dp needs a value' static_tank --dp
refused '--quiet takes no value' static_tank --quiet=yes
refused 'unknown option --amplitude' static_tank --amplitude 0.1
refused '--amplitude 0: must be a number greater than 0' sloshing_high_fill --amplitude 0
refused '--layers -1: must be a whole number, 0 to 100' sloshing_baffle_2d --layers -1
refused 'unknown option --layers' dam_break --layers 1
refused '--pictures 1,0.5: must be increasing times' sloshing_breaking --pictures 1,0.5
refused '--pictures 1,: must be increasing times' sloshing_breaking --pictures 1,
refused '--pictures has times later than --t-end' sloshing_breaking --pictures 1,2 --t-end 1.5
refused 'did you mean "shift.tangential"' static_tank --use shift.tangentia
refused 'separatio' static_tank --remove separatio
refused '--set shift.bogus=1: model "shift.tangential" has no setting "bogus"' static_tank --set shift.bogus=1
refused 'no active model in slot "bogus"; the active slots are "surface", ' static_tank --set bogus.strain=1
refused 'no active model in slot "sorce"; did you mean "source"?' static_tank --set sorce.strain=1
refused 'no active model "source.mixed"; its slot has "source.volume"' static_tank --set source.mixed.strain=1
refused '--set collision.distance=-1: ' static_tank --set collision.distance=-1
refused '--set collision=1: must be slot.key=number' static_tank --set collision=1
refused '--set collision.distance: must be slot.key=number' static_tank --set collision.distance
refused '--set collision.distance=0.5x: must be slot.key=number' static_tank --set=collision.distance=0.5x
refused '--re-far 1.5: must be a number, 2.1 to 10' static_tank --re-far 1.5
refused '--model magic: no preset "magic"; there are "imps", "imps.paper", "mmps", "mmps.paper"' static_tank --model magic
refused '--model mmps: is for two phases, this case has one; there are imps, imps.paper' static_tank --model mmps
refused '--model mmps.paper: is for two phases' dam_break --model mmps.paper
refused '--sigma -1: must be a number not less than 0, at most 100' static_two_fluid --sigma -1
refused '--sigma with --model imps: has no surface tension' sloshing_high_fill --model imps --sigma 0.01
refused 'unknown option --sigma' rayleigh_taylor --sigma 0
refused '--case fla: must be one of flat|film|wedge|jet|column|floor|box|toe' impact --case fla
refused '--case dam: must be one of flat|film|wedge|jet|column|floor|box|toe' impact --case dam
refused '--rows 0: must be a whole number, 1 to 200' impact --case film --rows 0
refused '--dim 3: this case is for 2 dimensions' impact --case wedge --dim 3
refused '--tip thin: must be one of flat|wedge|round' impact --case toe --tip thin
refused '--shift 2: must be a number not less than 0, at most 1' impact --case toe --shift 2
refused '--width 0: must be a number, 0.01 to 2' sloshing_breaking --dim 3 --width 0
refused "there are 'sundials.pcg'" static_tank --solver magic
refused "'sundials.klu', 'sundials.kinsol'; a preconditioner stands behind a /" static_two_fluid --solver magic
for option in --model --solver; do # choices are listed once
    "$drivers/static_tank" $option magic >log 2>&1
    [ "$(grep -o 'there are' log | wc -l)" = 1 ] || fail "$option magic: $(cat log)"
done
refused "choose 'sundials.kinsol'" sloshing_high_fill --model mmps --dp 0.04 --use gas.isentropic --frames 0 --no-report --out nonlinear
refused 'phase 3 has no fluid particle: add the gas, or set gas.phase' sloshing_high_fill --model mmps --dp 0.04 --set gas.phase=3 --frames 0 --no-report --out no_gas
refused 'gas.phase is 1.5: must be a whole number' sloshing_high_fill --model mmps --dp 0.04 --set gas.phase=1.5 --frames 0 --no-report --out no_gas
refused '--out /dev/null/x: Not a directory' static_tank --out /dev/null/x

"$drivers/static_tank" --help | grep -q -- '--probe-dt S' || fail "--help does not list --probe-dt"
"$drivers/impact" --help | grep -q -- '--tip flat|wedge|round .* (flat)' || fail "--help does not list --tip with its default"
"$drivers/static_tank" --version | grep -q 'libmps [0-9]' || fail "--version"

# --list-models: all models of the library with their settings, and all else that has a name
"$drivers/static_tank" --list-models >list || fail "--list-models: exit $?"
models=$(sed -nE 's/^extern const mps_model_ops mps__([a-z]+)_([a-z_]+);$/\1.\2/p' "$sources/src/core/models/built_in.h")
[ "$(wc -w <<<"$models")" -ge 29 ] || fail "built_in.h has too few models: $models"
for name in $models; do
    grep -qx "### $name" list || fail "--list-models has no section $name"
done
for name in imps.paper mmps.paper sundials.kinsol auxgrid improved restitution acceleration interface_distance; do
    grep -qF "\`$name\`" list || fail "--list-models does not name $name"
done
"$drivers/rayleigh_taylor" --list-models | cmp -s - list || fail "--list-models of two drivers differ"

# --profile: a line for each pass on stdout, and their sum, which is the time of the steps
"$drivers/static_tank" --dp 0.05 --t-end 0.02 --frames 0 --no-report --quiet --profile --out profile --threads 1 >table 2>log || fail "--profile: exit $?: $(cat log)"
for name in search limits predict source.volume solve gradient.corrected move commit; do
    grep -q " $name " table || fail "--profile has no line of $name"
done
awk '$1 == "sum" {found = $2 > 0 && ($2 - $NF) ^ 2 <= (0.02 * $NF) ^ 2} END {exit !found}' table || fail "--profile: $(tail -1 table)"

# a short run of each: header, number and spacing of rows, every key of the summary, frames
columns() { # driver, dp, fluid particles, header wanted, options...
    runs 0 "$1" --dp "$2" --t-end 0.02 --frames 2 --out "$1" --quiet "${@:5}"
    [ -s log ] && fail "$1 --quiet says: $(cat log)"
    has "$1" probes.csv momentum.csv steps.csv summary.json frames.pvd picture_1.png picture_end.png report.html
    local header
    header=$(head -1 "$1/probes.csv")
    case $header in "$4"*) ;; *) fail "$1/probes.csv begins $header" ;; esac
    [ "$(wc -l <"$1/probes.csv")" = 22 ] || fail "$1/probes.csv has $(wc -l <"$1/probes.csv") lines instead of 22"
    awk -F, 'NR == 1 {n = NF} NF != n {exit 1} NR > 1 && ($1 - (NR - 2) * 1e-3) ^ 2 > 1e-24 {exit 1} /nan/ {exit 1}' "$1/probes.csv" ||
        fail "$1/probes.csv: rows are not complete or not every 1e-3 s"
    for key in case model dp n_fluid n_wall n_dummy steps t_end dt_mean wall_s cpu_s s_per_step ppe_solver ppe_iterations_mean ppe_s neighbour_s \
        operators_s peak_rss_bytes particles_lost volume_error max_speed status version threads; do
        grep -q "^  \"$key\": " "$1/summary.json" || fail "$1/summary.json has no $key"
    done
    grep -q '"status": "ok"' "$1/summary.json" || fail "$1: status is not ok"
    grep -q "\"n_fluid\": $3," "$1/summary.json" || fail "$1 has $(grep n_fluid "$1/summary.json") instead of $3"
    [ "$(find "$1/frames" -name '*.vtp' | wc -l)" -ge 3 ] || fail "$1: fewer than 3 frames"
}
columns sloshing_surge 0.025 310 't[s],surge[m],P1[Pa],P2[Pa],P3[Pa],P4[Pa],P5[Pa],eta_left[m],eta_right[m],ke[J/m],x_tank[m],pe[J/m]'
columns sloshing_high_fill 0.025 276 't[s],surge[m],P1[Pa],eta_right[m],ke[J/m],x_tank[m]'
columns sloshing_low_fill 0.015 78 't[s],surge[m],P1[Pa],eta_right[m],ke[J/m],x_tank[m]'
columns sloshing_breaking 0.025 367 't[s],surge[m],P1[Pa],P2[Pa],P3[Pa],eta_left[m],eta_right[m],air_volume[m2],ke[J/m],x_tank[m]'
columns sloshing_baffle_2d 0.01 978 't[s],surge[m],eta_a[m],eta_b[m],eta_c[m],ke[J/m],x_tank[m]'
columns sloshing_baffle_3d 0.025 1859 't[s],surge[m],eta_a[m],eta_b[m],eta_c[m],ke[J],x_tank[m]'
columns dam_break 0.025 286 't[s],P1[Pa],P2[Pa],P3[Pa],P4[Pa],front[m],ke[J/m],x_tank[m]'
columns static_tank 0.025 616 't[s],P1[Pa],P2[Pa],P3[Pa],eta_left[m],ke[J],x_tank[m]' --dim 3
columns impact 0.05 800 't[s],P_10[Pa],P_25[Pa],P_50[Pa],P_75[Pa],P_bottom[Pa],P_mean[Pa],F[N/m],ke[J/m],x_tank[m]' --probe-dt 1e-3
has impact trace.csv
columns static_two_fluid 0.05 570 't[s],P1[Pa],P2[Pa],P3[Pa],ke[J/m],x_tank[m],pe[J/m]'
columns rayleigh_taylor 0.05 760 't[s],ytop[m],ybot[m],ke[J/m],x_tank[m],pe[J/m]'
awk -F, 'NR == 2 && $2 > 0 {found = 1} END {exit !found}' static_tank/probes.csv || fail "static_tank/probes.csv has no pressure in the row of t = 0"

# what the drivers of two phases begin with and end with
value_is() { # folder, column, row (1: t = 0), value, tolerance
    local column
    column=$(head -1 "$1/probes.csv" | tr , '\n' | grep -n "^$2\(\[\|\$\)" | cut -d: -f1)
    awk -F, -v c="$column" -v row="$3" -v v="$4" -v e="$5" 'NR == row + 1 {exit !(($c - v) ^ 2 <= e * e)}' "$1/probes.csv" ||
        fail "$1: $2 in row $3 is not $4 +- $5"
}
value_is rayleigh_taylor ytop 1 1.15 0.026
value_is rayleigh_taylor ybot 1 0.85 0.026
awk -F, 'END {exit !(($2 - $4 - 4905) ^ 2 < 250 ^ 2)}' static_two_fluid/probes.csv || fail "static_two_fluid: P1 - P3 is not rho g 0.5 m"
grep -q '"trespass": -0.0' static_two_fluid/summary.json || fail "static_two_fluid has $(grep trespass static_two_fluid/summary.json)"
grep -q '"strays": 0,' rayleigh_taylor/summary.json || fail "rayleigh_taylor has $(grep strays rayleigh_taylor/summary.json)"
runs 0 sloshing_surge --ramp 1 --dp 0.05 --t-end 0.1 --frames 0 --out surge_ramp
value_is surge_ramp x_tank 101 1.12077e-4 1e-9 # 0.02 sin(6.469 t) x^3 (10 - 15 x + 6 x^2), x = 6.469 t/(2 pi)
runs 0 rayleigh_taylor --model mmps.paper --dp 0.05 --t-end 1 --frames 0 --out two_liquids # p = 0 atop the lower of two liquids breaks off at 0.83 s
# a model for one phase gets the model that a case of two phases needs: a pressure datum
runs 0 static_two_fluid --model imps --dp 0.05 --t-end 0.05 --frames 0 --out level
awk -F, 'END {exit !(($3 - 2460) ^ 2 < 250 ^ 2)}' level/probes.csv || fail "static_two_fluid --model imps: P2 is not rho g 0.25 m"

# air above the water, in 3-D too
runs 0 sloshing_high_fill --model mmps --dp 0.025 --t-end 0.02 --frames 0 --out air
grep -q '"n_fluid": 529,' air/summary.json || fail "the tank with air has $(grep n_fluid air/summary.json) instead of 529 = 23 x 23"
value_is air eta_right 1 0 2e-3
runs 0 sloshing_breaking --model mmps --dim 3 --width 0.15 --dp 0.03 --t-end 0.005 --frames 0 --out air3
grep -q '"n_fluid": 4872,' air3/summary.json || fail "the tank with air has $(grep n_fluid air3/summary.json) instead of 4872 = 42 x 29 x 4"
grep -q 'air_volume\[m3\]' air3/probes.csv || fail "no air_volume[m3] in 3-D"

# particle numbers: Z14's surge tank, the dam break in 3-D
counts() { # fluid, walls and dummies, driver, options...
    runs 0 "${@:3}" --t-end 1e-5 --frames 0 --no-report --quiet --out counts --overwrite
    local fluid wall dummy
    for key in fluid wall dummy; do declare $key="$(sed -n "s/.*\"n_$key\": \([0-9]*\),.*/\1/p" counts/summary.json)"; done
    [ "$fluid $((wall + dummy))" = "$1 $2" ] || fail "${*:3}: $fluid + $wall + $dummy particles instead of $1 + $2"
}
counts 12338 1974 sloshing_surge --whole-rows --dp 0.004
counts 12437 1974 sloshing_surge --dp 0.004 # 62.5 rows: 0.25 m
counts 1431 14766 dam_break --dim 3 --dp 0.025 # 23.85 x 12 rows
counts 4101 8676 sloshing_baffle_3d --paper-baffle --dp 0.02 # at the paper's dp 0.005: 274195 111360

# motions at t = 0.02: -a (1 - cos wt), also with an amplitude of one's own, and a sin wt
tank_is() { # folder, formula
    local column
    column=$(head -1 "$1/probes.csv" | tr , '\n' | grep -n x_tank | cut -d: -f1)
    awk -F, -v c="$column" 'END {x = '"$2"'; exit !(x != 0 && ($c / x - 1) ^ 2 < 1e-18)}' "$1/probes.csv" || fail "$1: the tank is not at $2"
}
tank_is sloshing_high_fill '-0.005 * (1 - cos(6.85 * 0.02))'
tank_is sloshing_low_fill '-0.01 * (1 - cos(2.825 * 0.02))'
tank_is sloshing_breaking '0.1 * sin(8 * atan2(1, 1) * 0.496 * 0.02)'
tank_is sloshing_baffle_2d '0.1 * sin(3.53 * 0.02)'
tank_is sloshing_baffle_3d '0.03 * sin(6.582 * 0.02)'
runs 0 sloshing_high_fill --dp 0.025 --t-end 0.02 --frames 0 --amplitude 5e-4 --out small
tank_is small '-5e-4 * (1 - cos(6.85 * 0.02))'

# models exchanged, numbers changed: the run is another one; pictures at times of one's own
runs 0 sloshing_high_fill --dp 0.025 --t-end 0.02 --frames 0 --use viscosity.laplacian --set collision.distance=0.7 --set collision.pair.distance=0.6 \
    --pictures 0.005,0.01 --out same
cmp -s same/probes.csv sloshing_high_fill/probes.csv || fail "settings equal to the preset's change the run"
has same picture_1.png picture_2.png picture_end.png
[ ! -e same/picture_3.png ] || fail "--pictures 0.005,0.01 makes three"
runs 0 sloshing_high_fill --dp 0.025 --t-end 0.02 --frames 0 --use gradient.conservative --set source.strain=0 --out other
if cmp -s other/probes.csv sloshing_high_fill/probes.csv; then fail "--use and --set change nothing"; fi
runs 0 sloshing_high_fill --dp 0.025 --t-end 0.02 --frames 0 --remove dissipation --out fewer
if cmp -s fewer/probes.csv sloshing_high_fill/probes.csv; then fail "--remove changes nothing"; fi

# a sensor's average is smoother than the signal
runs 0 sloshing_high_fill --dp 0.025 --t-end 0.02 --frames 0 --sensor-average 0.005 --out averaged
if cmp -s averaged/probes.csv sloshing_high_fill/probes.csv; then fail "--sensor-average changes nothing"; fi

# a driver does not warn of an average that it chose itself, and names the column of one that the
# user chose
runs 0 impact --case wedge --dp 0.02 --t-end 0.02 --frames 0 --out own_average
if grep -q 'warning' log; then fail "impact --case wedge warns of its own default: $(cat log)"; fi
runs 0 impact --case wedge --dp 0.02 --t-end 0.02 --frames 0 --sensor-average 0.001 --out short_average
grep -q 'warning: t = .*: F is a mean over 0.001 s;.*--sensor-average' log || fail "a short average: $(cat log)"

# what each column of probes.csv is, and where: in summary.json and in the report
grep -qF '{"name": "P1", "unit": "Pa", "type": "wall_pressure", "at": [0, 0.05, 0], "diameter": 0.025, "normal": [1, 0, 0], "part": "tank.x0", "about": "Wall pressure: sensor at (0, 0.05) m' sloshing_surge/summary.json ||
    fail "sloshing_surge/summary.json does not say where P1 is"
grep -qF '{"name": "still_level", "about": "y of the still level' sloshing_surge/summary.json || fail "sloshing_surge/summary.json does not say what still_level is"
grep -qF '{"name": "wetted_dp", "about": "wetted side' own_average/summary.json || fail "the summary of a wedge does not say what wetted_dp is"
grep -qF '"liquid_depth": 0.25,' sloshing_surge/summary.json || fail "sloshing_surge/summary.json has no depth"
for text in 'P1 \[Pa\]</th><td>Wall pressure: sensor at (0, 0.05) m' 'inner size of the tank</th><td>0.8 x 0.5 m' 'id="film-data"' '"label": "crests, FNPF"'; do
    grep -q "$text" sloshing_surge/report.html || fail "sloshing_surge/report.html has no $text"
done
for folder in sloshing_surge impact rayleigh_taylor dam_break; do # each column is in the list
    for name in $(head -1 $folder/probes.csv | tr , '\n' | sed 's/\[.*//' | grep -vx t); do
        grep -q "{\"name\": \"$name\", .*\"about\": \"..*\"}" $folder/summary.json || fail "$folder/summary.json says nothing about $name"
    done
done

# a run without report and frames
runs 0 static_tank --dp 0.025 --t-end 0.005 --frames 0 --no-report --out bare
if [ -e bare/report.html ] || [ -e bare/frames.pvd ]; then fail "--no-report --frames 0 wrote them"; fi
has bare probes.csv summary.json

# without standard streams messages land in no file
"$drivers/static_tank" --dp 0.025 --t-end 0.005 --frames 0 --no-report --threads 1 --out closed <&- >&- 2>&- || fail "closed streams: exit $?"
has closed probes.csv summary.json
head -1 closed/probes.csv | grep -q '^t\[' || fail "closed streams: probes.csv begins with $(head -1 closed/probes.csv)"
if grep -l 'static_tank:' closed/*.csv; then fail "closed streams: messages are in these files"; fi

# the outputs of a run that breaks off are readable: steps far too long for a tank that starts with
# a jump
runs 3 sloshing_surge --model imps.paper --dp 0.025 --dt 0.1 --t-end 5 --out diverged
grep -q 'at t = .*step' log || fail "a diverged run does not say when: $(cat log)"
has diverged probes.csv summary.json report.html
grep -q '"status": "MPS_E_' diverged/summary.json || fail "a diverged run's status: $(grep status diverged/summary.json)"

# a gas that would move at its speed of sound
runs 3 sloshing_high_fill --model mmps --dp 0.05 --set gas.sound=1 --amplitude 0.5 --out fast
grep -q 'phase 1 moves at .* m/s in the tank, and the speed of sound there is 1 m/s' log || fail "a gas that is too fast: $(cat log)"

# Ctrl-C
starts log static_tank --dp 0.02 --t-end $never --out stopped
wait_for more_lines stopped/probes.csv 1
kill -INT $pid
ends 130 Ctrl-C log
has stopped probes.csv summary.json report.html
grep -q '"status": "MPS_W_STOPPED"' stopped/summary.json || fail "an interrupted run's status"

if [ $failures -gt 0 ]; then exit 1; fi
echo "drivers are in order"
