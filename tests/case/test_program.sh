#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# The program mps: each verb, exit codes, an interrupted run.
# usage: test_program.sh PROGRAM CASES
program=$1 cases=$2 script=$(realpath "$0")
. "$(dirname "$0")/program_kit.sh"

expect 2 "usage: mps VERB" "$program"
expect 0 "usage: mps VERB" "$program" --help
expect 0 "libmps" "$program" --version
expect 2 "is no verb" "$program" rum x
expect 0 "--set" "$program" run --help
expect 2 "unknown option" "$program" run --sett x.yaml
expect 2 "is missing" "$program" run
expect 2 "one argument too many" "$program" run a b
expect 2 "needs a value" "$program" run x.yaml --set
expect 2 "1 to 1024" "$program" run x.yaml -j many
expect 2 "no.yaml" "$program" run no.yaml

# a device is refused by name, or with the missing part
printf 'mps: 1\ndp: 50 mm\ntank: {size: 1 0.6 m}\nfill: [{water: {depth: 0.2 m}}]\nrun: {until: 10 ms}\n' > small.yaml
expect 2 "must be cuda, or cuda:N" "$program" run small.yaml --device gpu
expect 2 "must be cuda, or cuda:N" "$program" run small.yaml --device cuda:x
if ! ldconfig -p | grep -qF libcuda.so.1; then
    expect 2 "" "$program" run small.yaml --device cuda
    grep -qE "no driver of NVIDIA|needs libmps-cuda1" log || fail "no reason: $(head -5 log)"
    [ ! -e small/probes.csv ] || fail "outputs of a run that did not begin"
fi
rm -rf small

# init writes cases that check accepts; it replaces nothing
for name in $("$program" list cases | cut -d' ' -f1); do
    expect 0 "$name" "$program" init "$name"
done
[ -e voyage.csv ] || fail "no voyage.csv"
expect 2 "is there already" "$program" init tank
expect 0 "tank.yaml" "$program" init tank --overwrite
expect 2 "no case with the name" "$program" init tnk
# without a name: all names, as 'list cases' has them
expect 2 "mps init: NAME is missing; cases to start from:" "$program" init
"$program" list cases > names
tail -n +2 log | cmp -s - names || fail "init without NAME: $(head -3 log)"
mkdir taken
echo mine > taken/voyage.csv
(cd taken && "$program" init ship > /dev/null 2>&1) && fail "init ship beside another voyage.csv"
[ -e taken/ship.yaml ] && fail "ship.yaml with the voyage.csv of another"
[ "$(cat taken/voyage.csv)" = mine ] || fail "voyage.csv was replaced"
for name in tank lng roll ship; do
    expect 0 "periods" "$program" check $name.yaml
    grep -q "particles .* of fluid" log || fail "$name: no particles"
    grep -q "<svg" $name.svg || fail "$name: no drawing"
done
"$program" check tank.yaml | grep -q "T1 1.41[78] s" || fail "T1 of 1 m, 0.24 m"
"$program" check tank.yaml --set fill.water.depth=50% | grep -q "T1 1.319 s" || fail "T1 of 1 m, 0.3 m"
# T1 ignores solids: those that cross the surface are named, with the period of 0.6 m; those below
# it are not
expect 0 "without the solids" "$program" check tank.yaml --set "dp=20 mm" --set "solids={high: {plate: [0.4 0 m, 0.4 0.4 m]}, low: {plate: [0.7 0 m, 0.7 0.1 m]}}"
grep -q "^surface *solid 'high' stands in it, x = 0.4 m$" log || fail "surface: $(cat log)"
grep -q "the longest open stretch, 0.6 m, is 0.9508 s" log || fail "open stretch: $(cat log)"
grep -q "solid 'low'" log && fail "a solid below the surface stands in it"
expect 0 "T1 1.418 s" "$program" check tank.yaml --set "dp=20 mm" --set "solids={low: {plate: [0.7 0 m, 0.7 0.1 m]}}"
grep -q "^surface" log && fail "a solid below the surface: $(cat log)"
expect 0 "x = 0.4 .. 0.5 m, not from side to side" "$program" check tank.yaml --set "dim=3" --set "dp=50 mm" --set "tank.size=1 0.6 0.5 m" \
    --set "solids={post: {box: [0.4 0 0.2 m, 0.5 0.4 0.3 m]}}"
grep -q "open stretch" log && fail "a post closes no surface"
expect 0 "without the fluid above" "$program" check tank.yaml --set "dp=50 mm" --set "fill=[{water: {depth: 40 %}}, {air: rest}]" --set "model=mmps"
# requested dp, built dp, and cells
expect 0 "dp 20 mm requested, 19.9 mm built in cells of 19.8 mm x 20 mm," "$program" check tank.yaml --set "dp=20 mm" --set "tank.size=1.01 0.6 m"
expect 0 "2-D, dp 20 mm, gravity" "$program" check tank.yaml --set "dp=20 mm"
expect 0 "dp 0.0199017 m (0.02 m requested, cells 0.0198039 x 0.02 m)," "$program" run tank.yaml --set "dp=20 mm" --set "tank.size=1.01 0.6 m" \
    --set "run.until=0.01 s" --set "output.frames=0" -o cells
grep -q '"dp": 0.01990171[0-9]*,' cells/summary.json && grep -q '"dp_requested": 0.02,' cells/summary.json &&
    grep -q '"lattice": \[0.0198039[0-9]*, 0.02[0-9]*\]' cells/summary.json || fail "spacings of summary.json: $(grep -A3 '"dp"' cells/summary.json)"
grep -q "19.8 mm x 20 mm" cells/report.html || fail "spacings on the page"

# a tank of a file with two ribs: ribs thinner than the spacing are not resolved, and the check
# compares the count of wall particles with the surface
ribs() { # thickness in m; surfaces of the cells of a grid
    awk -v t="$1" 'function corner(a, s, u, v,   k, p) {
        k[a] = c[a] + s; k[(a + 1) % 3] = c[(a + 1) % 3] + u; k[(a + 2) % 3] = c[(a + 2) % 3] + v
        for (p = 0; p < 3; p++) printf "%s%.9g", p ? " " : "vertex ", g[p, k[p]]
        print "" }
    function triangle(a, s, u1, v1, u2, v2) {
        print "facet normal 0 0 0\nouter loop"; corner(a, s, 0, 0); corner(a, s, u1, v1); corner(a, s, u2, v2); print "endloop\nendfacet" }
    function liquid(i, j, k) { return i >= 0 && i < 5 && j >= 0 && j < 2 && k == 0 && !(i % 2 && j == 0) }
    BEGIN { split("0 0.3 r 0.7 s 1", x); x[3] = 0.3 + t; x[5] = 0.7 + t
        for (i = 0; i < 6; i++) g[0, i] = x[i + 1]
        g[1, 0] = 0; g[1, 1] = 0.4; g[1, 2] = 0.8; g[2, 0] = 0; g[2, 1] = 0.6
        print "solid ribs"
        for (c[0] = 0; c[0] < 5; c[0]++) for (c[1] = 0; c[1] < 2; c[1]++) { c[2] = 0
            for (a = 0; a < 3 && liquid(c[0], c[1], 0); a++) for (s = 0; s < 2; s++) {
                n[0] = c[0]; n[1] = c[1]; n[2] = 0; n[a] += 2 * s - 1
                if (liquid(n[0], n[1], n[2])) continue
                if (s) { triangle(a, s, 1, 0, 1, 1); triangle(a, s, 1, 1, 0, 1) }
                else { triangle(a, s, 1, 1, 1, 0); triangle(a, s, 0, 1, 1, 1) } } }
        print "endsolid ribs" }' > ribs.stl
}
printf 'mps: 1\ndim: 3\ndp: 50 mm\ntank: {stl: ribs.stl, unit: m}\nfill: [{water: {depth: 30 %%}}]\nrun: {until: 1 s}\n' > ribs.yaml
ribs 0.2
expect 0 "68 triangles" "$program" check ribs.yaml
! grep -q "wall particles where" log || fail "ribs of four spacings: $(grep where log)"
ribs 0.005
expect 0 'warning: solid "tank" has ' "$program" check ribs.yaml
read -r count wanted < <(sed -n 's/.* has \([0-9]*\) wall particles where its surface has \([0-9]*\) dp2: its parts.*/\1 \2/p' log)
# four sides of the ribs, 0.4 x 0.6 m, are missing
awk -v n="$count" -v w="$wanted" 'BEGIN {exit !(w > 1840 && w < 1912 && n < 0.9 * w && n > 0.7 * w)}' || fail "$count wall particles of $wanted"

for list in cases keys models settings solvers units measures; do
    [ "$("$program" list $list | wc -l)" -gt 3 ] || fail "list $list"
done
expect 2 "is no list" "$program" list model
expect 0 "solids.*.holes.pitch" "$program" list keys holes
[ "$(grep -c '^[a-z]' log)" -eq 3 ] || fail "list keys holes: $(cat log)"
expect 0 "motion.roll|pitch|yaw.jonswap" "$program" list keys roll
grep -q "^sensors" log && fail "list keys roll: sensors"
expect 2 "xyzzy" "$program" list keys xyzzy
expect 2 "one argument too many" "$program" list cases tank
"$program" schema > schema.json || fail "schema"
grep -q "2020-12" schema.json || fail "schema.json"

# a run, refused, replaced, from its own case
expect 0 "" "$program" run tank.yaml --set "run.until=0.05 s" --set output.frames=2 -o run -q
[ -e run/report.html ] || fail "no report.html"
expect 2 "earlier run" "$program" run tank.yaml --set "run.until=0.05 s" -o run -q
expect 0 "" "$program" run tank.yaml --set "run.until=0.05 s" --set output.frames=2 -o run -q --overwrite -j 1
expect 0 "" "$program" run run/case.yaml -o again -q
cmp run/probes.csv again/probes.csv || fail "case.yaml gives other bytes"
expect 0 "" "$program" run run/report.html -o once_more -q
cmp run/probes.csv once_more/probes.csv || fail "the case of report.html gives other bytes"
cmp run/frames/frames_000002.vtp once_more/frames/frames_000002.vtp || fail "the case of report.html gives another frame"
# the volume of a liquid of very few particles
cat > ball.yaml << 'EOF'
mps: 1
dim: 3
dp: 50 mm
tank: {sphere: {radius: 0.18 m}}
solids: {block: {box: [-0.06 0 -0.06 m, 0.06 0.1 0.06 m]}}
fill: [{water: {depth: 45 %}}]
motion: {surge: {amplitude: 20 mm, period: 0.7 s}}
output: {frames: 0}
run: {until: 0.08 s}
EOF
expect 0 "warning: the liquid's volume changed by up to " "$program" run ball.yaml -o ball
expect 0 "" "$program" run tank.yaml --set "run.until=0.05 s" --set output.frames=0 -o calm
! grep -q "volume changed" log || fail "a calm tank has a warning of its volume"
rm run/report.html
expect 0 "run/report.html: " "$program" report run
[ -s run/report.html ] || fail "no report.html by 'mps report'"
expect 2 "needs the folder of a run" "$program" report nowhere
for verb in "run -o none" check; do # in the words of a case, also before a run
    # shellcheck disable=SC2086
    expect 2 "output.page: 100 kB is too small, must be 500 kB or more" "$program" $verb tank.yaml --set "output.page=100 kB" -q
done
expect 2 "until" "$program" run tank.yaml --set run.until=5 -o none -q
[ -e none ] && fail "a wrong case made a folder"
expect 3 "" "$program" run tank.yaml --set "run.dt=20 ms" --set "motion.surge.amplitude=5 m" -o wild -q
[ -s wild/probes.csv ] || fail "a run that diverged has no rows"

# stats: 40 pulses, a triangle each of 0.2 s and 1000 Pa, 1025 Pa, .. at 1 s, 2 s, ..
mkdir -p pulses shifted bare
awk 'BEGIN { print "t[s],P1[Pa],P2[Pa],eta[m]"
    for (i = 0; i <= 4100; i++) {
        t = i / 100; n = int(t + 0.5); d = t - n; if (d < 0) d = -d
        p = n >= 1 && n <= 40 && d < 0.1 ? (1000 + 25 * (n - 1)) * (1 - d / 0.1) : 0
        printf "%.2f,%.9g,%.9g,%.9g\n", t, p, 0, sin(6.283185307179586 * t) } }' > pulses/probes.csv
awk 'BEGIN { print "t[s],eta[m],P1[kPa]"
    for (i = 0; i <= 4100; i++) printf "%.2f,%.9g,0\n", i / 100, sin(6.283185307179586 * (i / 100 - 0.1)) }' > shifted/probes.csv
cp pulses/probes.csv bare/
printf '{\n  "t_end": 41,\n  "inputs": [\n    {"key": "T1", "value": "1 s"},\n    {"key": "impacts.threshold", "value": "100 Pa"},\n    {"key": "impacts.sensors", "value": "P1; P2"}\n  ]\n}\n' > pulses/summary.json
expect 0 "P1: 40 events" "$program" stats pulses
for text in "highest 1.98 kPa at 40 s" "above 100 Pa, until 0.2 s below it" "P2: 0 events" \
    "exceeded once in 3 h" "for screening" "Weibull " "generalised Pareto " \
    "constants of the run in pulses: impacts.from 0.205 s, impacts.threshold 100 Pa, T1 1 s" "sensors: P1; P2" "an edit of case.yaml does not"; do
    grep -qF "$text" log || fail "stats: no '$text'"
done
grep -qE "^ +1 +1.98 kPa +40 s +0.1 s +0.1 s " log || fail "stats: rise and decay of the highest: $(grep -E '^ +1 ' log)"
[ "$(wc -l < pulses/statistics.csv)" -eq 41 ] || fail "statistics.csv has no 40 events"
grep -q '"weibull"' pulses/statistics.json || fail "statistics.json has no fits"
expect 0 "P1: 39 events" "$program" stats bare P1 # without constants the window is 0.82 s; the record begins 0.78 s before the first
grep -q "1 left out at the ends" log || fail "stats: the first pulse is not told as cut"
grep -q "P2" log && fail "stats of one column has another"
grep -q "(by deviations: set impacts.threshold)" log || fail "stats: not told that the threshold is a guess"
expect 0 "P2: no pressure from 0.21 s to 41 s: no liquid came here" "$program" stats bare P2
# another threshold without another run: half of the pulses are above 1475 Pa; the page uses it too,
# and states this
expect 0 "constants by --set: impacts.threshold 1.48 kPa, impacts.window 0.1 s" "$program" stats pulses P1 --set "impacts.threshold=1.48 kPa" -s "impacts.window=0.1 T1"
grep -q "P1: 20 events" log && grep -q "^constants of the run in pulses: .*impacts.threshold 100 Pa" log && ! grep -q "edit of case" log || fail "stats --set: $(head -5 log)"
[ "$(wc -l < pulses/statistics.csv)" -eq 21 ] || fail "statistics.csv with another threshold"
expect 0 "sensors: P2" "$program" stats pulses --set "impacts.sensors=P2"
grep -q "^P1" log && fail "stats of P2 has P1"
expect 2 "did you mean 'threshold'?" "$program" stats pulses --set "impacts.treshold=6 kPa"
expect 2 "a pressure is wanted" "$program" stats pulses --set "impacts.threshold=6 s"
expect 2 "is no constant of the statistics" "$program" stats pulses --set "run.until=6 s"
expect 0 "constants by --set: impacts.threshold 50 Pa" "$program" report run --set "impacts.threshold=50 Pa"
expect 2 "mps report: --set" "$program" report run --set "impacts.threshold=50"
grep -q "has no unit" log || fail "report --set: $(cat log)"
expect 0 "run/report.html: " "$program" report run
mkdir few
cp pulses/probes.csv few/
printf '{\n  "t_end": 41,\n  "sensor_average_most": 0.15,\n  "inputs": [\n{"key": "T1", "value": "1 s"},\n{"key": "impacts.threshold", "value": "100 Pa"},\n{"key": "impacts.least_events", "value": "100"}\n]}\n' > few/summary.json
expect 0 "that needs 100 events, at this rate a record of about 102 s" "$program" stats few P1
grep -q "40 of 40 rise or decay faster" log || fail "stats: unresolved events are not counted"
grep -q "by deviations" log && fail "stats: a threshold that is given is called a guess"
expect 0 "P_right: " "$program" stats run
expect 2 "the nearest is 'P_left'" "$program" stats run P_lift
expect 2 "is no pressure" "$program" stats run eta_left
expect 2 "no such folder" "$program" stats nowhere
expect 2 "is no folder" "$program" stats pulses/probes.csv

# compare: a sine of 1 s that is 0.1 s later differs by -2 sin(0.1 pi) cos(2 pi (t - 0.05)): rms
# from 0.205 to 41 s, of straight lines
expect 0 "shifted against pulses" "$program" compare pulses shifted pulses/probes.csv
awk '/^  eta/ { n++; ok += $3 == "m" && $15 == "s" && $18 == "deg" && (n == 2 ? $2 == 0 && $14 == 0 : $2 == 0.436 && $14 == 0.1 && $17 == 36) }
    END { exit !(n == 3 && ok == 3) }' log || fail "compare: $(grep eta log)"
grep -q "^  P1 .* Pa " log || fail "compare: units: $(grep P1 log)"
grep -q "pulses against pulses/probes.csv" log || fail "compare: no reference"
# a table of others: another name, another unit, times in ms; a part of the time
awk -F, 'NR == 1 { print "t[ms],pressure[kPa]"; next } $1 < 20 { printf "%.15g,%.15g\n", 1000 * $1, $2 / 1000 }' pulses/probes.csv > other.csv
expect 2 "no column can be compared" "$program" compare pulses other.csv
grep -q -- "--map COLUMN=NAME says" log && grep -q "other.csv has pressure\[kPa\]" log || fail "compare: no help: $(cat log)"
expect 0 "pulses against other.csv" "$program" compare pulses other.csv --map P1=pressure
awk '/^  P1/ { exit !($2 < 1e-12 && $3 == "kPa") }' log || fail "compare --map: $(grep P1 log)"
expect 2 "has no column 'P7'" "$program" compare pulses other.csv --map P7=pressure
expect 2 "COLUMN=NAME is wanted" "$program" compare pulses other.csv --map pressure
# known values of the case are the default
expect 2 "has no 'reference'" "$program" compare pulses
mkdir known
cp pulses/probes.csv known/
printf '{\n  "t_end": 41,\n  "references": [{"label": "measured", "unit": "m", "column": "eta", "line": false, "points": [[1.1, 0], [2.35, 1], [3.6, 0], [99, 3]]}]}\n' > known/summary.json
expect 0 "known against measured" "$program" compare known
grep -q "at 3 of 4 points" log || fail "compare: points: $(cat log)"
expect 0 "P_left" "$program" compare run again
awk '/^  P_left/ { exit !($2 == 0 && $3 == "Pa" && $5 ~ /^k?Pa$/) }' log || fail "the same run differs"
expect 2 "is missing" "$program" compare
expect 2 "no such folder" "$program" compare run nowhere
expect 2 "the last argument" "$program" compare run/probes.csv run
expect 2 "no column can be compared" "$program" compare run shifted

# slots of a baffle on the page
expect 0 "" "$program" run lng.yaml --set "run.until=5 ms" --set output.frames=0 -o slots -q
for piece in "0], [0.48, 0.04]" "0.09], [0.48, 0.16]" "0.21], [0.48, 0.25]"; do
    grep -qF "[[0.48, $piece]" slots/summary.json || fail "no part of the baffle: $piece"
done

# info
for what in "case:tank.yaml" "table:run/probes.csv" "frame of particles:run/frames/frames_000001.vtp" \
    "series of frames:run/frames.pvd" "page:run/report.html" "summary:run/summary.json"; do
    expect 0 "${what%%:*}" "$program" info "${what#*:}"
done
head -c 3000 /dev/urandom > noise
expect 2 "is no file of mps" "$program" info noise
printf '{' | cat - noise > brace # binary that begins as JSON, and text that is none
expect 2 "is no file of mps" "$program" info brace
printf '{ not json\n' > brace
expect 2 "is no file of mps" "$program" info brace
expect 2 "No such file" "$program" info nothing
expect 0 "report.html" "$program" info run
expect 2 "without outputs of a run" "$program" info taken

# interrupted, and continued: the same bytes as the whole run
never=1000
"$program" run tank.yaml --set "run.until=$never s" --set output.frames=0 -o cut > log 2>&1 &
pid=$!
for i in $(seq 600); do
    [ "$(wc -l 2> /dev/null < cut/probes.csv)" -gt 60 ] 2> /dev/null && break
    sleep 0.1
done
kill -INT $pid
wait $pid
got=$?
[ $got -eq 130 ] || fail "interrupted: exit $got"
expect 0 "checkpoint of a run" "$program" info cut/checkpoint.mps
last=$(tail -1 cut/probes.csv | cut -d, -f1)
end=$(awk -v t="$last" 'BEGIN { printf "%.3f", t + 0.2 }') # the last steps before the end are shorter
expect 0 "" "$program" resume cut --set "run.until=$end s" -q
expect 0 "" "$program" run tank.yaml --set "run.until=$end s" --set output.frames=0 -o whole -q
cmp cut/probes.csv whole/probes.csv || fail "a continued run has other bytes"

# paraview.py asks ParaView for the arrays of the frames, their times, spheres of dp and the scale
# of the pictures; the camera shows the tank
if command -v python3 > /dev/null; then
    here=$(dirname "$script")
    expect 0 "" python3 "$here/check_paraview.py" run
    expect 0 "" "$program" run tank.yaml --set "dp=40 mm" --set "run.until=0.1 s" --set "output.frames=2" -o away -q \
        --set "motion={surge: {amplitude: 0.3 m, period: 10000 s, phase: 90 deg}}"
    expect 0 "" python3 "$here/check_paraview.py" away 0.3 0
fi

# several runs of one case: a table, skipped when done, refused where it cannot be
cat > sweep.yaml << END
base: tank.yaml
set: {dp: 20 mm, run.until: 0.05 s, output.frames: 0, output.page: 0 MB}
sweep: {motion.surge.period: 0.9 1 T1, motion.surge.amplitude: 10 20 mm}
collect: [P_left.max, F.last]
END
sed '/^sweep\|^collect/d' sweep.yaml > single.yaml
expect 2 "use 'mps sweep'" "$program" run sweep.yaml -o none -q
expect 2 "use 'mps sweep'" "$program" repeat sweep.yaml -o none -q
expect 2 "use 'mps run'" "$program" sweep single.yaml -o none -q
expect 2 "max, min, mean, last" "$program" sweep sweep.yaml --set "collect=[P_left.most]" -o none -q
expect 2 "must be 2 to" "$program" repeat single.yaml -n 1 -o none -q
[ -e none ] && fail "a refused series made a folder"
expect 2 "collect: no sensor is 'P_no'; there are P_left" "$program" sweep sweep.yaml --set "collect=[P_no.max]" -o no_column -q
expect 2 "no column of probes.csv is 'heave'" "$program" sweep sweep.yaml --set "collect=[heave.max]" -o no_heave -q
[ -e no_column ] || [ -e no_heave/002 ] && fail "an unknown column did not end the sweep"
expect 0 "run 4 of 4: motion.surge.period=1 T1 motion.surge.amplitude=20 mm" "$program" sweep sweep.yaml -o swept
[ "$(wc -l < swept/sweep.csv)" -eq 5 ] || fail "sweep.csv: $(cat swept/sweep.csv)"
head -1 swept/sweep.csv | grep -q '^run,motion.surge.period,motion.surge.amplitude,motion.surge.period.si\[s\],motion.surge.amplitude.si\[m\],exit,P_left.max\[Pa\],F_x.last\[N/m\],' ||
    fail "names of sweep.csv: $(head -1 swept/sweep.csv)"
most=$(awk -F, 'NR > 1 && (NR == 2 || $3 > m) { m = $3 } END { printf "%.9g", m }' swept/003/probes.csv)
last=$(awk -F, 'END { printf "%.9g", $6 }' swept/003/probes.csv)
T1=$(sed -n 's/.*"T1", "value": "\([.0-9]*\) s.*/\1/p' swept/003/summary.json)
grep -q "^003,1 T1,10 mm,$T1,0.01,0,$most,$last," swept/sweep.csv || fail "not $most, $last: $(grep ^003 swept/sweep.csv)"
expect 0 "" "$program" run single.yaml --set "motion.surge.period=1 T1" -o alone -q
cmp alone/probes.csv swept/003/probes.csv || fail "a run of a sweep has other bytes than a run alone"
# p3h and harmonic: those of 'mps stats', and of a fit of mean + a sin + b cos of its own
sed '/^collect\|^sweep/d' sweep.yaml > fitted.yaml
cat >> fitted.yaml << END
sweep: {motion.surge.amplitude: 10 20 mm}
impacts: {deviations: 0.5, window: 0.05 T1, least_events: 3, scale: 40, from: 1 s, until: 6 s}
collect: [P_left.p3h, P_left.harmonic, F.harmonic, eta_left.harmonic, P_left.p3h_pareto]
END
runs="001 002"
if [ "$slow" = 1 ]; then
    runs= # all that follows reads numbers of many steps
else
    expect 0 "" "$program" sweep fitted.yaml --set "dp=40 mm" --set "run.until=6.5 s" -o fitted -q
    head -1 fitted/sweep.csv | grep -qF 'exit,P_left.p3h[Pa],P_left.harmonic[Pa],F_x.harmonic[N/m],F_y.harmonic[N/m],F_m.harmonic[N m/m],eta_left' ||
        fail "names of sweep.csv: $(head -1 fitted/sweep.csv)"
fi
for run in $runs; do
    expect 0 "" "$program" stats fitted/$run P_left
    wanted=$(sed -n 's/.*"weibull".*"full_scale": \([-+.0-9e]*\),.*/\1/p' fitted/$run/statistics.json)
    [ -n "$wanted" ] && [ "$(awk -F, -v run=$run '$1 == run { print $5 }' fitted/sweep.csv)" = "$wanted" ] ||
        fail "p3h of run $run: not '$wanted': $(grep ^$run fitted/sweep.csv)"
    pareto=$(sed -n 's/.*"pareto".*"full_scale": \([-+.0-9e]*\),.*/\1/p' fitted/$run/statistics.json)
    [ -n "$pareto" ] && [ "$pareto" != "$wanted" ] && [ "$(awk -F, -v run=$run '$1 == run { print $NF }' fitted/sweep.csv)" = "$pareto" ] ||
        fail "p3h_pareto of run $run: not '$pareto': $(grep ^$run fitted/sweep.csv)"
    omega=$(sed -n 's/.*"motion omega", "value": "\([.0-9]*\) rad.*/\1/p' fitted/$run/summary.json)
    for column in P_left:6 F_x:7; do
        awk -F, -v w="$omega" -v name="${column%%:*}" -v got="$(awk -F, -v run=$run -v k="${column#*:}" '$1 == run { print $k }' fitted/sweep.csv)" '
            NR == 1 { for (k = 1; k <= NF; k++) if (index($k, name "[") == 1) at = k; next }
            $1 >= 1 && $1 <= 6 && $at != "nan" {
                f[0] = 1; f[1] = sin(w * $1); f[2] = cos(w * $1); f[3] = $at
                for (i = 0; i < 3; i++) for (j = 0; j < 4; j++) m[i, j] += f[i] * f[j] }
            END {
                for (i = 0; i < 3; i++) for (r = 0; r < 3; r++) if (r != i) {
                    q = m[r, i] / m[i, i]
                    for (j = 0; j < 4; j++) m[r, j] -= q * m[i, j] }
                a = m[1, 3] / m[1, 1]; b = m[2, 3] / m[2, 2]; e = sqrt(a * a + b * b)
                exit !(e > 0 && (got / e - 1) ^ 2 < 1e-12) }' fitted/$run/probes.csv ||
            fail "harmonic of ${column%%:*}, run $run: $(grep ^$run fitted/sweep.csv)"
    done
done
expect 2 "is no pressure" "$program" sweep fitted.yaml --set "collect=[eta_left.p3h]" --set "run.until=0.05 s" -o no_pressure -q
expect 2 "'eta_left.p3h_pareto': column 'eta_left' is no pressure" "$program" sweep fitted.yaml --set "collect=[eta_left.p3h_pareto]" --set "run.until=0.05 s" -o no_pressure --overwrite -q
expect 0 "P_left.p3h: 2 of 2 values are nan: too few impacts" "$program" sweep fitted.yaml --set "collect=[P_left.p3h, F.harmonic]" --set "run.until=0.05 s" --set "impacts.from=0 s" -o short
grep -q "^001,10 mm,0.01,0,nan,nan,nan,nan$" short/sweep.csv || fail "sweep.csv of short runs: $(cat short/sweep.csv)"
cp swept/sweep.csv before.csv
rm -r swept/002
expect 0 "swept/001: is done already" "$program" sweep sweep.yaml -o swept -j 1
cmp before.csv swept/sweep.csv || fail "a sweep made whole again has another table"
expect 2 "run of another case" "$program" sweep sweep.yaml --set "run.until=0.06 s" -o swept -q
sed 's/^sweep.*/sweep: {motion.surge.amplitude: 1e-6 5 m}/' sweep.yaml > bad.yaml
expect 3 "bad/002 failed, exit code 3" "$program" sweep bad.yaml --set "run.dt=20 ms" --set "run.until=0.6 s" -o bad -q
grep -q "^002,5 m,5,3,nan,nan" bad/sweep.csv || fail "sweep.csv of a failed run: $(cat bad/sweep.csv)"
# the last 20 steps divide the rest of a run; earlier steps have the factor. If whole cells give one
# dp, the runs differ in their steps: each motion, fixed steps and none
repeated() {
    expect 0 "" "$program" repeat $1.yaml --set "run.until=0.2 s" -n 3 -o $1 -q
    grep -q "^varied: time steps by +-0.5 %, dp as built [0-9.]* mm in all runs, whose cells fill the tank$" log || fail "repeat: $(cat log)"
    grep -q "^run.step_factor,,,,,,,,,0.995,1,1.005$" $1/repeat.csv || fail "factors of $1/repeat.csv: $(cat $1/repeat.csv)"
    for k in 001 003; do
        cmp -s $1/$k/probes.csv $1/002/probes.csv && fail "$1: runs $k and 002 are the same"
    done
    "$program" run $1.yaml --set "run.until=0.2 s" -o $1/plain -q || fail "a plain run of $1"
    cmp $1/plain/probes.csv $1/002/probes.csv || fail "$1: the middle run is not that of the case"
}
cp single.yaml same.yaml
printf 'base: single.yaml\nset: {run.dt: 1 ms}\n' > fixed.yaml
awk '/^[a-z]/ { skip = /^motion/ } !skip' tank.yaml > still_tank.yaml
sed 's/tank.yaml/still_tank.yaml/' single.yaml > still.yaml
repeated same
[ "$slow" = 1 ] || repeated fixed
[ "$slow" = 1 ] || repeated still
for k in 1 2 3; do # the first step, of a length that is chosen
    awk -F, -v f="$(sed -n 's/.*step_factor,*\(.*\)/\1/p' same/repeat.csv | cut -d, -f$k)" 'NR == FNR { if (FNR == 2) base = $2; next }
        FNR == 2 { exit !(f > 0.99 && ($2 / base / f - 1) ^ 2 < 1e-18) }' same/002/steps.csv same/00$k/steps.csv || fail "steps of run $k"
done
expect 0 "largest value of" "$program" repeat single.yaml --set "dp=5 mm" --set "run.until=0.01 s" -n 3 -o repeated -q
grep -qE "^P_left  *3( +[-0-9.]+ (k|m|)Pa){5}$" log || fail "repeat: $(cat log)"
grep -q "^varied: time steps by +-0.5 %, dp as built 4.9[0-9]* mm to 5.0[0-9]* mm (3 different in 3 runs)$" log || fail "repeat: $(cat log)"
# repeat.csv: the values of the runs, their mean, least and largest
[ "$(head -1 repeated/repeat.csv)" = "largest value of,unit,runs,mean,least,most,deviation,mean_band,next_band,001,002,003" ] ||
    fail "repeat.csv: $(cat repeated/repeat.csv)"
awk -F, '/^dp,m,,,,,,,/ { ok += $10 < $11 && $11 < $12 && $10 > 0.0049 && $12 < 0.0051 }
    /^run.step_factor,,,,,,,,/ { ok += $10 == 0.995 && $11 == 1 && $12 == 1.005 }
    /^P_left,Pa,3,/ { m = ($10 + $11 + $12) / 3; d = sqrt((($10 - m) ^ 2 + ($11 - m) ^ 2 + ($12 - m) ^ 2) / 2)
        least = most = $10; for (k = 11; k <= 12; k++) { if ($k < least) least = $k; if ($k > most) most = $k }
        ok += ($4 / m - 1) ^ 2 < 1e-14 && $5 == least && $6 == most && ($7 - d) ^ 2 <= (1e-5 * d) ^ 2 && $8 > 0 && $9 > $8 }
    END { exit !(ok == 3) }' repeated/repeat.csv || fail "repeat.csv: $(cat repeated/repeat.csv)"
grep -q "^dp: 4.975 mm" repeated/001/case.yaml && grep -q "^dp: 5.025 mm" repeated/003/case.yaml || fail "dp of repeat"
expect 0 "order" "$program" converge single.yaml -o converged -q
grep -q "^ke " log || fail "converge: $(cat log)"
# converge.csv: the largest values of the three runs, order and band as printed
[ "$(head -1 converged/converge.csv)" = "largest value of,unit,coarse,middle,fine,change,order,limit,band,kind" ] ||
    fail "converge.csv: $(cat converged/converge.csv)"
most() { awk -F, -v name="$2" 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == name) at = k; next } !n++ || $at > m { m = $at } END { printf "%.9g", m }' "$1"; }
three=$(most converged/001/probes.csv 'P_left[Pa]'),$(most converged/002/probes.csv 'P_left[Pa]'),$(most converged/003/probes.csv 'P_left[Pa]')
grep -q "^P_left,Pa,$three," converged/converge.csv || fail "converge.csv has not $three: $(grep ^P_left converged/converge.csv)"
grep -qE "^dp,m,0[.0-9]*,0[.0-9]*,0[.0-9]*,,,,,$" converged/converge.csv || fail "dp of converge.csv"
# "12.3 kPa", three digits, with the minus of a text
sed -n 's/\xe2\x88\x92/-/g; s/,//g; /^P_left/p' log > printed
awk -F, 'function rounded(v, unit) { return sprintf("%.3g", unit == "kPa" ? v / 1000 : unit == "mPa" ? v * 1000 : v) }
    function same(v, number, unit) { return rounded(v, unit) + 0 == number + 0 && unit ~ /^[km]?Pa$/ }
    NR == FNR { n = split($0, p, " "); next }
    /^P_left/ { order = p[n - 3] == "-" ? $7 == "nan" || $7 == "-nan" : sprintf("%.3g", $7) + 0 == p[n - 3] + 0
        exit !(same($3, p[2], p[3]) && same($5, p[6], p[7]) && same($6, p[8], p[9]) && order && same($9, p[n - 2], p[n - 1])) }' \
    printed converged/converge.csv || fail "converge.csv is not as printed: $(cat printed) $(grep ^P_left converged/converge.csv)"
grep -q "^dp: 40 mm" converged/001/case.yaml && grep -q "^dp: 20 mm" converged/003/case.yaml || fail "dp of converge"

# an interrupted sweep stops, and can be resumed
until=3
[ "$slow" = 1 ] && until=0.5
long=(--set "run.until=$until s" --set "motion.surge.amplitude=10 mm")
"$program" sweep sweep.yaml "${long[@]}" -o half > log 2>&1 &
pid=$!
for i in $(seq 3000); do # often: the run is over in a second
    [ "$(wc -l 2> /dev/null < half/001/probes.csv)" -gt 60 ] 2> /dev/null && break
    sleep 0.02
done
kill -INT $pid
wait $pid
got=$?
[ $got -eq 130 ] || fail "sweep interrupted: exit $got: $(tail -3 log)"
[ -e half/001/checkpoint.mps ] || fail "no checkpoint of an interrupted sweep"
[ -e half/002 ] && fail "an interrupted sweep went on"
expect 0 "" "$program" sweep sweep.yaml "${long[@]}" -o half -q
expect 0 "" "$program" run single.yaml "${long[@]}" --set "motion.surge.period=0.9 T1" -o unbroken -q
cmp half/001/probes.csv unbroken/probes.csv || fail "a run of a continued sweep has other bytes"
[ "$(wc -l < half/sweep.csv)" -eq 3 ] || fail "sweep.csv of a continued sweep: $(cat half/sweep.csv)"

[ $failed -eq 0 ] && echo "mps does what it says"
exit $failed
