#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Command line and outputs of the drivers: wrong values are refused by name, outputs are complete, exit codes are kept.
# usage: tests/cases/test_drivers.sh FOLDER_OF_DRIVERS
set -uo pipefail
drivers=$(realpath "${1:?usage: test_drivers.sh FOLDER_OF_DRIVERS}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
failures=0
fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

refused() { # text that must be in the message, driver, options...
    local text=$1 message code
    shift
    message=$("$drivers/$1" "${@:2}" 2>&1 >/dev/null)
    code=$?
    [ $code = 2 ] || fail "$*: exit $code instead of 2"
    grep -qF -- "$text" <<<"$message" || fail "$*: says '$message', not '$text'"
}

runs() { # exit code, driver, options...
    local wanted=$1 code
    shift
    "$drivers/$1" "${@:2}" --threads 1 >log 2>&1
    code=$?
    [ $code = "$wanted" ] || { fail "$*: exit $code instead of $wanted"; cat log; }
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
refused '--t-end 1e9: must be' standing_wave --t-end 1e9
refused '--threads 1.5: must be a whole number, 1 to 1024' standing_wave --threads 1.5
refused '--frames -1: must be' standing_wave --frames -1
refused '--dim 4: must be a whole number, 2 to 3' static_tank --dim 4
refused 'unknown option --dim' standing_wave --dim 3
refused 'unknown option --bogus' standing_wave --bogus
refused '--dp needs a value' standing_wave --dp
refused '--quiet takes no value' standing_wave --quiet=yes
refused 'there are imps, imps.paper' static_tank --model mmps
refused 'there are sundials.pcg' static_tank --solver magic
refused '--out /dev/null/x: Not a directory' static_tank --out /dev/null/x

"$drivers/static_tank" --help | grep -q -- '--probe-dt S' || fail "--help does not list --probe-dt"
"$drivers/static_tank" --version | grep -q 'libmps [0-9]' || fail "--version"

# a short run of each: header, number and spacing of rows, every key of the summary, frames
columns() { # driver, header wanted, options...
    runs 0 "$1" --dp 0.025 --t-end 0.02 --frames 2 --out "$1" --quiet "${@:3}"
    [ -s log ] && fail "$1 --quiet says: $(cat log)"
    has "$1" probes.csv steps.csv summary.json frames.pvd picture_1.png picture_end.png plot_energy.svg plot_dt.svg plot_ppe.svg report.html
    local header
    header=$(head -1 "$1/probes.csv")
    case $header in "$2"*) ;; *) fail "$1/probes.csv begins $header" ;; esac
    [ "$(wc -l <"$1/probes.csv")" = 22 ] || fail "$1/probes.csv has $(wc -l <"$1/probes.csv") lines instead of 22"
    awk -F, 'NR == 1 {n = NF} NF != n {exit 1} NR > 1 && ($1 - (NR - 2) * 1e-3) ^ 2 > 1e-24 {exit 1} /nan/ {exit 1}' "$1/probes.csv" ||
        fail "$1/probes.csv: rows are not complete or not every 1e-3 s"
    for key in case model dp n_fluid n_wall n_dummy steps t_end dt_mean wall_s cpu_s s_per_step ppe_solver ppe_iterations_mean ppe_s neighbour_s \
        operators_s peak_rss_bytes particles_lost volume_error max_speed status version threads; do
        grep -q "^  \"$key\": " "$1/summary.json" || fail "$1/summary.json has no $key"
    done
    grep -q '"status": "ok"' "$1/summary.json" || fail "$1: status is not ok"
    [ "$(find "$1/frames" -name '*.vtp' | wc -l)" -ge 3 ] || fail "$1: fewer than 3 frames"
}
columns sloshing_surge 't[s],P1[Pa],P2[Pa],P3[Pa],P4[Pa],P5[Pa],eta_left[m],eta_right[m],ke[J/m],x_tank[m],pe[J/m]'
columns static_tank 't[s],P1[Pa],P2[Pa],P3[Pa],eta_left[m],ke[J],x_tank[m]' --dim 3
columns standing_wave 't[s],eta_left[m],ke[J/m],x_tank[m]'
awk -F, 'NR == 2 && $2 > 0 {found = 1} END {exit !found}' static_tank/probes.csv || fail "static_tank/probes.csv has no pressure in the row of t = 0"

# a run without report and frames
runs 0 static_tank --dp 0.025 --t-end 0.005 --frames 0 --no-report --out bare
if [ -e bare/report.html ] || [ -e bare/frames.pvd ]; then fail "--no-report --frames 0 wrote them"; fi
has bare probes.csv summary.json

# the outputs of a run that breaks off are readable: steps far too long for a tank that starts with a jump
runs 3 sloshing_surge --dp 0.025 --dt 0.1 --t-end 5 --out diverged
grep -q 'at t = .*step' log || fail "a diverged run does not say when: $(cat log)"
has diverged probes.csv summary.json report.html
grep -q '"status": "MPS_E_' diverged/summary.json || fail "a diverged run's status: $(grep status diverged/summary.json)"

# Ctrl-C
"$drivers/static_tank" --dp 0.02 --t-end 1000 --out stopped --threads 1 >log 2>&1 &
pid=$!
sleep 2
kill -INT $pid
wait $pid
code=$?
[ $code = 130 ] || { fail "Ctrl-C: exit $code instead of 130"; cat log; }
has stopped probes.csv summary.json report.html
grep -q '"status": "MPS_W_STOPPED"' stopped/summary.json || fail "an interrupted run's status"

if [ $failures -gt 0 ]; then exit 1; fi
echo "drivers are in order"
