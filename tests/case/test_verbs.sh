#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Errors of the program mps: options in all forms, files that cannot be written, files of other
# types, out of memory, ranks.
# usage: test_verbs.sh PROGRAM FAKE_RANKS [FAIL_MALLOC]    without FAIL_MALLOC the tests of memory
# are skipped
program=$1 ranks=$2 memory=$3
. "$(dirname "$0")/program_kit.sh"
says() { grep -qE -- "$1" log || fail "no '$1' in: $(head -8 log)"; }
silent() { [ -s log ] && fail "$1 says $(head -3 log)"; }

cat > small.yaml << END
mps: 1
dp: 50 mm
tank: {size: 1 0.5 m}
fill: [{water: {depth: 0.2 m}}]
motion: {surge: {amplitude: 5 mm, period: 1 s}}
sensors: {P: {wall: 0 0.1 m}, eta: {gauge: 0.3 m}}
run: {until: 0.02 s}
output: {frames: 0, page: 0 MB}
END
printf 't[s],eta[m]\n0,1\n1,2\n2,1\n' > level.csv

# ---- options in all forms
expect 0 "usage: mps run" "$program" run -h
expect 0 "usage: mps VERB" "$program" help
expect 0 "dp 0.1 m," "$program" check small.yaml --set=dp='100 mm'
expect 0 "dp 0.1 m," "$program" check small.yaml -sdp='100 mm' --out=drawing.svg
[ -s drawing.svg ] || fail "--out=drawing.svg"
expect 2 "takes no value" "$program" run small.yaml --quiet=yes
expect 2 "needs a value" "$program" run small.yaml --out ''
expect 2 "unknown option" "$program" run small.yaml --seta x
expect 2 "unknown option" "$program" run small.yaml -z
expect 2 "cannot be read" "$program" check -
for count in 0 3x 5000 -1; do expect 2 "must be a whole number, 1 to 1024" "$program" run small.yaml -j $count; done
many=()
for ((k = 0; k < 65; k++)); do many+=(--set dp=50\ mm); done
expect 2 "is one --set too many" "$program" run small.yaml "${many[@]}"
expect 2 "is one argument too many" "$program" stats $(seq 65)
expect 0 "" "$program" run small.yaml -j1 -q -o "it's a place"
silent "a quiet run"
grep -q "\"command\": \".* run small.yaml -j1 -q -o .*it's a place" "it's a place/summary.json" || fail "the command of a run: $(grep command "it's a place/summary.json")"
expect 0 "" "$program" check small.yaml "${many[@]:0:100}" -q
silent "a quiet check"
[ -s small.svg ] || fail "no small.svg"
cp small.yaml .hidden
cp small.yaml plain
mkdir a.b
cp small.yaml a.b/plain
expect 0 " .hidden.svg" "$program" check .hidden
expect 0 " plain.svg" "$program" check a.b/plain

if cd /proc 2>/dev/null; then # a folder that takes no files
    "$program" check "$work/small.yaml" > "$work/told" 2> "$work/log" || fail "check in /proc: exit $?"
    grep -q "^level" "$work/told" || fail "check in /proc has no text"
    grep -q "there is no drawing, --out" "$work/log" || fail "check in /proc: $(cat "$work/log")"
    cd "$work" || exit 1
fi

# ---- lists
expect 0 "mps list keys [NAME]" "$program" list
expect 2 "is no list" "$program" list nothing
expect 2 "no key and no text of one has 'tanx'" "$program" list keys tanx
expect 0 "body.gravity" "$program" list keys buoyancy # a word of a text
"$program" list keys mps > log
[ "$(wc -l < log)" -ge 1 ] || fail "list keys mps"
# a text that cannot be written is a failure of each verb, an unrequested drawing is not
for verb in schema "list keys" "list units" "check small.yaml" "info small.yaml" --version --help "run --help"; do
    # shellcheck disable=SC2086
    "$program" $verb > /dev/full 2> log
    [ $? -eq 1 ] || fail "$verb to a full device: exit code"
    says "mps ${verb%% *}: cannot write to stdout: No space left"
done
# a reader that closes the pipe has what it wants
"$program" list keys 2> log | true
[ "${PIPESTATUS[0]}" -eq 0 ] || fail "a closed pipe: exit code"
silent "a closed pipe"

# ---- closed streams are no outputs
"$program" list cases <&- > log || fail "list without stdin"
says "^tank "
expect 2 "is no list" sh -c '"$0" list nothing <&- >&-' "$program"
sh -c '"$0" run "$1" -o closed <&- >&- 2>&-' "$program" small.yaml || fail "a run without streams: exit $?"
[ "$(head -1 closed/probes.csv | cut -c1-5)" = "t[s]," ] || fail "probes.csv of a run without streams: $(head -1 closed/probes.csv)"

# ---- files that cannot be written
expect 1 "nowhere/x.svg: No such file" "$program" check small.yaml -o nowhere/x.svg
expect 1 "/dev/full: No space left" "$program" check small.yaml -o /dev/full
expect 1 "nowhere/x.yaml: No such file" "$program" init tank -o nowhere/x.yaml
expect 1 "/dev/full: No space left" "$program" init tank -o /dev/full --overwrite
expect 0 "mine.yaml" "$program" init tank -o mine.yaml
expect 0 "voyage.csv" "$program" init voyage.csv
expect 2 "is there already" "$program" init voyage.csv
grep -q "^mps: 1" mine.yaml || fail "init -o"
expect 0 "" "$program" run small.yaml -q -o done
printf 't,eta\n0,1\n0.01,2\n0.02,3\n' > bare.csv # without units: compared as they are
expect 0 "  eta " "$program" compare done bare.csv
expect 2 "is more than the tank is high" "$program" run small.yaml -o none --set "fill.water.depth=90 m"
[ -e none ] && fail "a refused run made a folder"
expect 2 "outside the solids" "$program" run small.yaml -o none --set "sensors.P.wall=5 5 m" # refused later
[ -e none ] && fail "a refused run left a folder"
mkdir mine
expect 2 "outside the solids" "$program" run small.yaml -o mine --set "sensors.P.wall=5 5 m"
[ -d mine ] || fail "a refused run removed a folder that it did not make"
echo mine > mine.json
ln -s ../mine.json done/statistics.json # replaced, not written through; an empty folder too
mkdir done/statistics.csv
expect 0 "done/statistics.csv" "$program" stats done
[ "$(cat mine.json)" = mine ] && [ ! -h done/statistics.json ] && [ -s done/statistics.json ] || fail "statistics.json behind a link: $(cat mine.json)"
[ -f done/statistics.csv ] && [ -s done/statistics.csv ] || fail "no statistics.csv instead of a folder"
# files that may have no bytes: a full disk; log is such a file too, a pipe is none
# shellcheck disable=SC2016
expect 1 "cannot write 'statistics.json' in 'done': File too large" bash -c 'set -o pipefail; { trap "" XFSZ; ulimit -f 0; "$@" 2>&1; } | cat' full "$program" stats done
rm done/statistics.json done/statistics.csv
mkdir -p done/statistics.csv/mine
expect 1 "cannot write 'statistics.csv' in 'done': File exists" "$program" stats done
[ -s done/statistics.json ] || fail "no statistics.json"
rm -r done/statistics.csv

# ---- particles that the domain cuts: counted at the start, and as lost
expect 0 "" "$program" run small.yaml -q -o cut --set "domain=[0 0 m, 0.25 1 m]"
all=$(sed -n 's/.*"n_fluid": \([0-9]*\).*/\1/p' done/summary.json) lost=$(sed -n 's/.*"particles_lost": \([0-9]*\).*/\1/p' cut/summary.json)
[ "$(sed -n 's/.*"n_fluid": \([0-9]*\).*/\1/p' cut/summary.json)" = "$all" ] || fail "n_fluid of a cut tank: $(grep n_fluid cut/summary.json), $all"
[ "$((lost * 4))" -gt "$all" ] && [ "$lost" -lt "$all" ] || fail "particles_lost of a cut tank: $lost of $all"

# ---- a name of a file that is not UTF-8: the summary and the page are
cp small.yaml $'name\377.yaml'
expect 0 "" "$program" run $'name\377.yaml' -q -o named --set "output.page=1 MB"
for file in summary.json report.html; do iconv -f UTF-8 -t UTF-8 "named/$file" > /dev/null || fail "$file of a file whose name is not UTF-8"; done
grep -q '"case": "name' named/summary.json || fail "case of a file whose name is not UTF-8: $(grep '"case"' named/summary.json)"

# ---- a folder of several runs takes no other one
mkdir -p several/001 && cp small.yaml several/001/case.yaml
expect 2 "there are the runs of a sweep, repetition or convergence" "$program" run small.yaml -q -o several --overwrite
[ "$(ls several)" = 001 ] || fail "run in a folder of several runs: $(ls several)"

# ---- tables of other programs have units in round brackets
printf 'Time (s);P (kPa);eta (cm)\n0;1;1\n0.01;1;1\n0.02;1;1\n' > round.csv
expect 0 "" "$program" compare done round.csv
says "^  P +[0-9.]+ kPa +[0-9.e-]+ kPa +1 kPa "
says "^  eta +[0-9.]+ cm +[0-9.e-]+ cm +1 cm "

# ---- columns of a motion: others that the file has by their names are not dropped silently
printf 't[s],SURGE[m],Heave[m],PHI[deg],wind[m/s]\n0,0,0,0,0\n1,.01,0,1,0\n2,0,0,0,0\n' > ship.csv
expect 0 "motion.columns: names some degrees, so these columns are not used: SURGE, Heave; add them" "$program" check small.yaml --set "motion={file: ship.csv, columns: {roll: PHI}}"
expect 0 "" "$program" check small.yaml --set "motion={file: ship.csv, columns: {roll: PHI, surge: SURGE, heave: Heave}}"
grep -q "are not used" log && fail "motion.columns: all are used: $(grep "not used" log)"

# ---- a fit that cannot be extrapolated says so: 39 peaks below 10 kPa, one of 12 kPa
mkdir peaks
awk 'BEGIN {srand(1); print "t[s],P[Pa]"; for (i = 0; i < 100; i++) printf "%.2f,0\n", i / 100
    for (e = 0; e < 40; e++) {h = e == 20 ? 12000 : 10000 - 50 * (e * 17 % 40)
        for (k = 0; k < 100; k++) {p = k < 10 ? h * (1 - (k - 5) ^ 2 / 25) : 0; printf "%.2f,%.2f\n", 1 + e + k / 100, p}}}' > peaks/probes.csv
expect 0 "by moments: do not extrapolate; less than the highest peak of the record: of no use" "$program" stats peaks
says "^    Weibull +[0-9.]+ kPa, band [0-9.]+ kPa to [0-9.]+ kPa; less than the highest"

# ---- files of any size end, and take no memory of their size
cp -r done vast
truncate -s 1T vast/summary.json vast/probes.csv
expect 2 "mps collect: vast: none of 1 runs is done" timeout 60 "$program" collect vast
expect 2 ": a line of more than 16777216 bytes" timeout 60 "$program" info vast/probes.csv
([ "$slow" = 1 ] || ulimit -v 4000000; timeout 60 "$program" resume vast -q --set run.until="0.03 s" > log 2>&1)
[ $? -le 2 ] || fail "resume with rows of any size: $(tail -2 log)"
rm -r vast

# ---- check: what it refuses
expect 2 "no.yaml" "$program" check no.yaml
expect 2 "fill.water.depth: 90 m is more than the tank is high" "$program" check small.yaml --set "fill.water.depth=90 m"
expect 2 "motion.columns is needed" "$program" check small.yaml --set "motion={file: level.csv}"

# ---- stats: folders of other kinds
mkdir dry flat poor
cp level.csv dry/probes.csv
expect 2 "has no column of a pressure" "$program" stats dry
printf 't[s],P[Pa],Q[Pa],R[m]\n0,0,0,1\n1,0,0,nan\n2,5,0,1\n3,0,0,1\n' > flat/probes.csv
printf '{"t_end": 3, "inputs": [{"key": "impacts.threshold", "value": "1 Pa"}, {"key": "impacts.sensors", "value": "P"}, {"key": "impacts.window", "value": "0.1 s"}]}\n' > flat/summary.json
expect 0 "P: 1 event," "$program" stats flat
grep -q "^Q" log && fail "stats: impacts.sensors of the case is not used"
says "^sensors: P$"
expect 0 "Q: 0 events" "$program" stats flat Q P
says "no distribution is fitted: that needs 30 events$"
printf 't[s],P[Pa]\n0,5\n1,7\n2,5\n3,6\n' > poor/probes.csv # the liquid at rest presses with more than the threshold
cp flat/summary.json poor/
expect 0 "P: 0 events" "$program" stats poor
says "above 1 Pa, .*; 1 left out at the ends$"
says "the pressure is above that where the record begins or ends: a larger impacts.threshold may find peaks$"
cp flat/probes.csv poor/
printf '{"t_end": 3, "inputs": [{"key": "impacts.share", "value": "2"}]}\n' > poor/summary.json
expect 2 "poor: 'share' is 2" "$program" stats poor
printf 'no json' > poor/summary.json
expect 2 "poor/summary.json" "$program" stats poor
# limit of a long name: the folder exists, but names of its outputs are too long
long=done
while [ ${#long} -lt 4088 ]; do long=$long/./././.; done
expect 1 "': File name too long" "$program" stats "$long"
says "^mps stats: cannot write 'statistics.json' in "
# events that begin at once have no rise
awk 'BEGIN { print "t[s],P[Pa]"; for (i = 0; i <= 4000; i++) { t = i / 100; d = t - int(t); printf "%.2f,%.9g\n", t, (t > 0.5 && d < 0.05 ? 1000 + 100 * int(t) : 0) } }' > poor/probes.csv
printf '{"t_end": 40, "inputs": [{"key": "impacts.threshold", "value": "1 Pa"}, {"key": "impacts.window", "value": "0.1 s"}, {"key": "impacts.resamples", "value": "0"}, {"key": "impacts.exposure", "value": "60 s"}]}\n' > poor/summary.json
expect 0 "Weibull" "$program" stats poor
grep -q ", band \|extrapolated" log && fail "stats: a band without resamples, or a short exposure: $(cat log)"

# ---- compare
expect 2 "no column can be compared" "$program" compare dry done/../flat
printf 't[s],eta[m]\n5,1\n6,2\n' > late.csv
expect 2 "late.csv and dry: no column can be compared" "$program" compare dry dry late.csv
says "^  eta +.*no common time"
printf 't[s],eta\n0,1\n1,2\n2,2\n' > bare.csv
expect 0 "" "$program" compare dry dry bare.csv
[ "$(grep -cE "^  eta +[0-9.]+ mm? .* 2 m +2 m +1 s +1 s +" log)" -eq 3 ] || fail "compare without a unit: $(cat log)"
mkdir empty
printf 't[s],eta[m]\n' > empty/probes.csv
expect 2 "no column can be compared" "$program" compare empty dry

# ---- info: kinds of files
printf 'solid a\n facet normal 0 0 1\n' > ascii.stl
expect 0 "ASCII STL" "$program" info ascii.stl
{ head -c 80 /dev/zero; printf '\001\000\000\000'; head -c 50 /dev/zero; } > binary.stl
expect 0 "binary STL, 1 triangles" "$program" info binary.stl
{ head -c 80 /dev/zero; printf '\002\000\000\000'; head -c 50 /dev/zero; } > broken.stl
expect 2 "is no file of mps" "$program" info broken.stl
printf 'solid words, no surface' > words
expect 2 "is no file of mps" "$program" info words
printf 'a\001,b\n1,2\n' > control
expect 2 "is no file of mps" "$program" info control
printf 'a,b\r\n1,2\n' > windows.csv
expect 0 "1 rows, first column 1 .. 1" "$program" info windows.csv
for separator in '\t' ';' , ' '; do # as motion tables
    printf "time$separator\"roll, of it [deg]\"$separator\"P [Pa]\"\n0${separator}1${separator}2\n.5${separator}2${separator}3\n" > other.txt
    expect 0 "2 rows, first column 0 .. 0.5" "$program" info other.txt
    for line in time 'roll, of it \[deg\]' 'P \[Pa\]'; do says "^  $line$"; done
done
printf 'run,P[Pa]\n001,2\nA a,3\n' > names.csv
expect 0 "2 rows" "$program" info names.csv
says "^  P \[Pa\]$"
printf 'run of P\nno table at\n' > three.txt
expect 2 "is no file of mps" "$program" info three.txt
printf '# of mine\nmps: 1\n' > comment.yaml
expect 0 "case; 'mps check'" "$program" info comment.yaml
printf 'mps: 1\ntitle: A tank\ndp: 1 m\n' > titled.yaml
expect 0 "case: A tank;" "$program" info titled.yaml
printf '<!doctype html>\n<html lang="en">' > page.html
expect 0 "page, 32 bytes" "$program" info page.html
printf '<VTKFile type="Other"><Piece NumberOfPoints="7"><DataArray type="a"/><DataArray Name="pressure"/>' > frame.vtp
expect 0 "7 particles" "$program" info frame.vtp
says "^  pressure$"
printf '<VTKFile type="Collection">' > frames.pvd
expect 0 "series of frames" "$program" info frames.pvd
printf '<VTKFile type="Other">' > other.vtk
expect 2 "is no file of mps" "$program" info other.vtk
mkfifo pipe
piped() { # wanted text, command ..: a pipe without a writer is refused, nothing waits for one
    expect 2 "$1" timeout 20 "$program" "${@:2}"
    says "$fifo"
}
fifo="it is a pipe \(FIFO\), no regular file"
piped "pipe: " info pipe
piped "pipe: " check pipe
printf 'base: pipe\n' > on_pipe.yaml
piped "$work/pipe' cannot be read: " check on_pipe.yaml
piped "pipe: " check small.yaml --set "motion={file: pipe}"
piped "/pipe: " run small.yaml -q -o none --set "reference={eta: {file: pipe}}"
piped "pipe" check small.yaml --plugin ./pipe
piped "\"$work/pipe\": " check small.yaml --set "dim=3" --set "tank={stl: pipe, unit: m}" --set "sensors={}"
piped "pipe: " compare dry dry pipe
piped "pipe: " stats pipe
cp -r done piped # a folder of a run, with a pipe instead of one of its files
for row in "case.yaml resume" "checkpoint.mps resume" "probes.csv stats" "probes.csv report" "summary.json report"; do
    read -r file verb <<< "$row"
    mv piped/$file kept.file 2> /dev/null
    mkfifo piped/$file
    piped "$file" "$verb" piped
    rm piped/$file
    mv kept.file piped/$file 2> /dev/null
done
expect 2 "" timeout 20 "$program" info /dev/null
says "it is a device, no regular file"
mkdir -p taken/report.html
expect 2 "without outputs of a run" "$program" info taken
# checkpoints: a head of 16 bytes, parts of a title of 40, bytes, number
expect 0 "" "$program" run small.yaml --set "run.until=0.4 s" -q -o kept # the last 20 steps leave none
expect 0 "checkpoint of a run" "$program" info kept/checkpoint.mps
grep -q "cut short" log && fail "info: a whole checkpoint is cut short"
head -c -20 kept/checkpoint.mps > cut.mps
expect 0 "it is cut short, or damaged" "$program" info cut.mps
{ head -c 16 kept/checkpoint.mps; printf 'x%.0s' {1..40}; printf '\377\377\377\377\0\0\0\0\1\0\0\0\0\0\0\0'; } > huge.mps
expect 0 "checkpoint of a run, 72 bytes" "$program" info huge.mps
[ "$(wc -l < log)" -eq 2 ] || fail "info: a part with too large elements: $(cat log)"

# ---- info: contents; proposals for a mistyped verb
stl() { # facets as lines of nine numbers: an ASCII STL file
    echo "solid s"
    while read -r ax ay az bx by bz cx cy cz; do
        printf 'facet normal 0 0 0\nouter loop\nvertex %s %s %s\nvertex %s %s %s\nvertex %s %s %s\nendloop\nendfacet\n' "$ax" "$ay" "$az" "$bx" "$by" "$bz" "$cx" "$cy" "$cz"
    done
    echo "endsolid s"
}
# a tetrahedron at (1, 2, 3) with edges of 2, 3 and 4 along the axes
tetrahedron="1 2 3 1 5 3 3 2 3
1 2 3 3 2 3 1 2 7
1 2 3 1 2 7 1 5 3
3 2 3 1 5 3 1 2 7"
stl <<< "$tetrahedron" > solid.stl
expect 0 "ASCII STL, 4 triangles" "$program" info solid.stl
for line in "x 1 .. 3, size 2" "y 2 .. 5, size 3" "z 3 .. 7, size 4"; do says "^  $line$"; done
says "^  in the unit of the file$"
says "^  closed: each edge belongs to two triangles; volume 4$"
awk '{ print $1, $2, $3, $7, $8, $9, $4, $5, $6 }' <<< "$tetrahedron" | stl > inward.stl
expect 0 "closed: each edge belongs to two triangles; volume 4, normals point inwards" "$program" info inward.stl
head -3 <<< "$tetrahedron" | stl > open.stl
expect 0 "open: 3 edges do not belong to two triangles" "$program" info open.stl
grep -q "closed\|volume" log && fail "info: an open surface is closed: $(cat log)"
expect 0 "folder of a run of small" "$program" info done
says "^  done, to t = 0.02 s, [0-9]+ steps; 'mps resume done --set run.until=..' extends it$"
says "^  probes.csv +table of the sensors"
says "^  summary.json +summary of the run$"
grep -q "checkpoint\|film\|report" log && fail "info: outputs that are not there: $(cat log)"
expect 0 "  checkpoint.mps   checkpoint; 'mps resume' continues from it" "$program" info kept
t=$(tail -21 kept/steps.csv | head -1 | cut -d, -f1) # 20 steps are fitted to the end
expect 0 "checkpoint of a run at t = $(printf %.9g "$t") s, after $(($(wc -l < kept/steps.csv) - 21)) steps, $(wc -c < kept/checkpoint.mps) bytes; 'mps resume' continues from its folder" "$program" info kept/checkpoint.mps
says "^  state.t +1 numbers of 8 bytes$"
for pair in runn:run resum:resume chekc:check statistics: xyzzy:; do
    expect 2 "mps: '${pair%:*}' is no verb" "$program" "${pair%:*}"
    if [ "${pair#*:}" ]; then says "; the nearest is '${pair#*:}'$"; else grep -q "nearest" log && fail "a proposal for ${pair%:*}: $(cat log)"; fi
done

# ---- series: existing results, tables that cannot be written
"$program" run small.yaml --set "run.until=100000 s" -o stopped > log 2>&1 &
pid=$!
for ((k = 0; k < 600; k++)); do
    [ "$(wc -l 2> /dev/null < stopped/probes.csv)" -gt 20 ] 2> /dev/null && break
    sleep 0.05
done
expect 2 "" "$program" run small.yaml -o stopped --overwrite -q
says "another run|stopped"
kill -INT $pid
wait $pid
[ $? -eq 130 ] || fail "interrupted"
cat > sweep.yaml << END
base: small.yaml
sweep: {title: ['a, b', 'say "c"', plain]}
END
expect 0 "" "$program" sweep sweep.yaml -o swept -q -j 1
grep -q '^001,"a, b",0,' swept/sweep.csv && grep -q '^002,"say ""c""",0,' swept/sweep.csv && grep -q '^003,plain,0,' swept/sweep.csv ||
    fail "quotes of sweep.csv: $(cat swept/sweep.csv)"
head -1 swept/sweep.csv | grep -q '^run,title,exit,surge.max\[m\],P.max\[Pa\],eta.max\[m\],' || fail "a sweep without collect: $(head -1 swept/sweep.csv)"
# the names of all columns are known before a run: no sensor may have them
for name in $(head -1 swept/001/probes.csv | tr , '\n' | sed 's/\[.*//' | grep -vE '^(P|eta|F|F_.*)$'); do
    expect 2 "sensors.$name: probes.csv has a column '$name'" "$program" check small.yaml --set "sensors.$name={gauge: 1 dp}"
done
expect 2 "collect: no sensor is 'Q'; there are P" "$program" check sweep.yaml --set 'collect=[P.max, Q.max]'
expect 0 "mps sweep: table of the runs: swept/sweep.csv" "$program" sweep sweep.yaml -o swept
# unreadable constants of a run are reported
sed -i '1s/{/{ broken/' swept/003/summary.json
expect 0 "swept/003/summary.json" "$program" sweep sweep.yaml -o swept -q
sed -i '1s/{ broken/{/' swept/003/summary.json
# another number of threads is no other case; a missing table is a failure of its run only
rm swept/002/probes.csv
expect 0 "swept/003: is done already" "$program" sweep sweep.yaml -o swept
says "002.probes.csv"
grep -q '^002,"say ""c""",0,nan,nan,' swept/sweep.csv || fail "a run without its table: $(cat swept/sweep.csv)"
rm swept/001/summary.json
expect 0 "" "$program" sweep sweep.yaml -o swept -q
grep -q '"status": "ok"' swept/001/summary.json || fail "a run that was killed is not made again"
rm swept/001/case.yaml
mkdir swept/001/case.yaml
expect 2 "run of another case" "$program" sweep sweep.yaml -o swept -q
rm -r swept/001
rm swept/sweep.csv
echo mine > mine.csv
ln -s ../mine.csv swept/sweep.csv # replaced, not written through
expect 0 "" "$program" sweep sweep.yaml -o swept -q
[ "$(cat mine.csv)" = mine ] && [ ! -h swept/sweep.csv ] || fail "sweep.csv behind a link: $(cat mine.csv)"
rm swept/sweep.csv
mkdir swept/sweep.csv
expect 1 "sweep.csv: Is a directory" "$program" sweep sweep.yaml -o swept -q
expect 2 "no.yaml" "$program" sweep no.yaml
expect 0 "order" "$program" converge small.yaml -o finer -q --set "dp=25 mm"
cp finer/001/probes.csv kept.csv
head -1 kept.csv | grep -q '^t\[s\],surge\[m\],P\[Pa\],' || fail "P is not the second column: $(head -1 kept.csv)"
sed -i 's/^\([0-9][^,]*,[^,]*\),[^,]*,/\1,nan,/' finer/001/probes.csv # a column without values has no row
expect 0 "mps converge: finer/converge.csv" "$program" converge small.yaml -o finer --set "dp=25 mm"
says "finer/003: is done already"
grep -q '^P ' log && fail "a row of nothing: $(cat log)"
grep -q '^P,' finer/converge.csv && fail "a row of nothing: $(cat finer/converge.csv)"
grep -q '^eta,m,' finer/converge.csv || fail "converge.csv: $(cat finer/converge.csv)"
mv kept.csv finer/001/probes.csv
rm finer/converge.csv
mkdir finer/converge.csv
expect 1 "finer/converge.csv: Is a directory" "$program" converge small.yaml -o finer -q --set "dp=25 mm"
rmdir finer/converge.csv
sed -i '/^  "dp": /d' finer/002/summary.json
expect 1 "are not three spacings from coarse to fine" "$program" converge small.yaml -o finer -q --set "dp=25 mm"
sed -i 's/"status": "ok"/"status": "failed"/' finer/001/summary.json
rm finer/002/probes.csv
expect 0 "002/probes.csv" "$program" converge small.yaml -o finer -q --set "dp=25 mm"
grep -q order log && fail "converge of two runs has an order"
expect 2 "at most 64 values of --set and paths" "$program" sweep sweep.yaml "${many[@]:0:128}" -o none
for entry in max .max P.most; do expect 2 "must be a sensor and one of these statistics" "$program" sweep sweep.yaml --set "collect=[$entry]" -o none; done
[ -e none ] && fail "a refused sweep made a folder"
entries=$(printf 'P.max, %.0s' {1..300})
expect 2 "" "$program" sweep sweep.yaml --set "collect=[${entries%, }]" -o none
says "is one too many of|texts"
expect 0 "" "$program" sweep sweep.yaml --set "collect=[P.mean, P.min, P.max, eta.last]" -o means -q
awk -F, 'NR > 1 { s += $3; n++; if (n == 1 || $3 < least) least = $3; if (n == 1 || $3 > most) most = $3; last = $4 }
    END { printf "%.6g %.6g %.6g %.6g\n", s / n, least, most, last }' means/003/probes.csv > wanted
awk -F, '$2 == "plain" { printf "%.6g %.6g %.6g %.6g\n", $4, $5, $6, $7 }' means/sweep.csv | cmp - wanted || fail "mean, min, max, last: $(cat wanted means/sweep.csv)"
expect 2 "mps repeat: -n must be 2 to" "$program" repeat small.yaml -n 101
expect 2 "" "$program" repeat no.yaml -n 2 -o none
name=$(printf 'long/%.0s' {1..250})
expect 2 "the name is too long" "$program" repeat small.yaml -n 2 -o "$name"
sed 's/^dp: .*/dp: [50 mm]/' small.yaml > list.yaml
expect 2 "dp must be one number and a unit" "$program" repeat list.yaml -n 2 -o none
expect 0 "" "$program" repeat small.yaml -n 2 -o pair -q --set "tank={polygon: [0 0 m, 1 0 m, 1 0.5 m, 0 0.5 m]}"
grep -q "^P,Pa,2," pair/repeat.csv || fail "repeat.csv: $(cat pair/repeat.csv)"
rm pair/repeat.csv
ln -s /dev/full pair/repeat.csv
expect 1 "repeat.csv: No space left" "$program" repeat small.yaml -n 2 -o pair -q --set "tank={polygon: [0 0 m, 1 0 m, 1 0.5 m, 0 0.5 m]}"
rm pair/repeat.csv
mkdir pair/repeat.csv
sed -i 's/^title: .*//; s/5 mm/6 mm/' pair/001/case.yaml
expect 2 "repeat.csv: Is a directory" "$program" repeat small.yaml -n 2 -o pair -q --set "tank={polygon: [0 0 m, 1 0 m, 1 0.5 m, 0 0.5 m]}"
says "pair/001: there is a run of another case"
rmdir pair/repeat.csv
box=(--set "tank={polygon: [0 0 m, 1 0 m, 1 0.5 m, 0 0.5 m]}")
expect 2 "mps repeat: pair/repeat.csv" "$program" repeat small.yaml -n 2 -o pair "${box[@]}"
says "^varied: .* in all runs, whose cells fill the tank$|^varied: .*\(1 different in 1 runs\)$"
grep -q '^dp,m,,,,,,,,nan,0\.[0-9]*$' pair/repeat.csv && grep -q '^run.step_factor,,,,,,,,,nan,1.005$' pair/repeat.csv && grep -q '^P,Pa,1,.*,nan,[-0-9.e]*$' pair/repeat.csv ||
    fail "a run of two: $(cat pair/repeat.csv)"
# a column without values has no row
sed -i 's/^\([0-9][^,]*,[^,]*\),[^,]*,/\1,nan,/' pair/002/probes.csv
head -1 pair/002/probes.csv | grep -q '^t\[s\],surge\[m\],P\[Pa\],' || fail "P is not the second column: $(head -1 pair/002/probes.csv)"
expect 2 "eta " "$program" repeat small.yaml -n 2 -o pair -q "${box[@]}"
grep -q '^P ' log && fail "a row of nothing: $(cat log)"
grep -q '^P,' pair/repeat.csv && fail "a row of nothing: $(cat pair/repeat.csv)"
grep -q '^eta,m,1,' pair/repeat.csv || fail "repeat.csv: $(cat pair/repeat.csv)"
"$program" repeat small.yaml -n 2 --set "run.until=100000 s" -o ended > log 2>&1 & # interrupted: no other run, no table
pid=$!
for ((k = 0; k < 600; k++)); do
    [ "$(wc -l 2> /dev/null < ended/001/probes.csv)" -gt 20 ] 2> /dev/null && break
    sleep 0.05
done
kill -INT $pid
wait $pid
[ $? -eq 130 ] || fail "repeat interrupted: $(tail -3 log)"
[ -e ended/002 ] && fail "an interrupted series went on"
[ -e ended/repeat.csv ] && fail "a table of an interrupted run"

# ---- ranks: of one process that plays one of two
mkdir bin
cp "$program" bin/mps
expect 2 "it is built where there are MPI and Zoltan" bin/mps run small.yaml --mpi -o none
cp "$ranks" bin/mps_drivers_mpi.so
on() { # rank and what the other does, wanted exit code, text, arguments ..
    local with=$1 code=$2 text=$3
    shift 3
    expect "$code" "$text" env TEST_RANKS="$with" bin/mps "$@" --mpi
}
on "0 1 -1 1" 0 "messages end" run small.yaml -q -o ranks
cmp ranks/probes.csv done/probes.csv || fail "a run on one rank has other bytes"
on "0 x" 2 "is of another version" run small.yaml -o none
on "0 2 -1 1" 0 "usage: mps run" run --help
on "1 2 0 1" 0 "" run --help
grep -q usage log && fail "a second rank shows help"
# the lowest rank that fails shows its message
on "0 2 2 1" 2 "unknown option" run small.yaml --sett
on "1 2 2 1" 2 "messages end" run small.yaml --sett
grep -q "unknown option" log && fail "both ranks show a message"
on "1 2 -1 1" 2 "unknown option" run small.yaml --sett
on "0 2 3 1" 3 "messages end" run small.yaml
# a run that is refused after all have read the case
on "0 2 -1 1" 2 "earlier run" run small.yaml -o done
says "rank 0 leaves with 2"
says "messages end"
on "0 2 -1 0" 1 "all ranks end with 1" run small.yaml -o done
says "earlier run"
on "0 1 -1 1" 0 "" resume kept --set "run.until=0.42 s" -q
# processes that mpirun starts without --mpi
expect 2 "mpirun started 3 processes" env OMPI_COMM_WORLD_SIZE=3 OMPI_COMM_WORLD_RANK=0 "$program" run small.yaml -o none
expect 2 "" env PMI_SIZE=2 PMI_RANK=1 "$program" run small.yaml -o none
silent "the second of several processes"
expect 0 "" env PMI_SIZE=1 "$program" run small.yaml -o single -q
[ -e none ] && fail "a refused run made a folder"

# ---- coefficients: folders that are not what the runs left, lists, units
sed 's/^dp: .*/dp: 80 mm/; s/^motion: .*/motion: {centre: 0.5 0 m, surge: {amplitude: 9 mm, period: 1 T1}}/; /^sensors/d' small.yaml > forced.yaml
series=(coefficients forced.yaml --degrees "surge roll" --period "1.6 T1" --periods 4 -o coefficients -q)
expect 0 "" "$program" "${series[@]}"
expect 2 "more than 200 frequencies" "$program" "${series[@]}" --period "1.1 to 2 step 0.001 T1"
cp -r coefficients kept_coefficients
head -1 kept_coefficients/001/trace.csv > coefficients/001/trace.csv
expect 1 "coefficients/001: trace.csv has no steps" "$program" "${series[@]}"
sed '1s/liquid_a_surge/other/' kept_coefficients/001/trace.csv > coefficients/001/trace.csv
expect 1 "coefficients/001: no harmonic of the motion can be fitted" "$program" "${series[@]}"
rm -r coefficients/003 coefficients/tilt_roll.csv
mkdir coefficients/tilt_roll.csv
expect 2 "coefficients/tilt_roll.csv: Is a directory" "$program" "${series[@]}"
rm -r coefficients
# one folder of a complete series is damaged: the tables are complete except for it
spoiled() { # wanted exit code, wanted text, file, program of sed
    rm -rf coefficients
    cp -r kept_coefficients coefficients
    sed -i "$4" "coefficients/$3"
    expect "$1" "$2" "$program" "${series[@]}"
}
column() { head -1 coefficients/coefficients.csv | tr , '\n' | grep -c "^$1"; }
spoiled 1 "coefficients/001: trace.csv has no steps" 001/trace.csv '1s/,dt/,other/'
spoiled 1 "coefficients/001: no harmonic of the motion can be fitted" 001/trace.csv '5,$d' # shorter than what is measured
spoiled 1 "coefficients/001: no harmonic of the motion can be fitted" 001/trace.csv '3,$s/^\([^,]*\),[^,]*/\1,0/' # steps without a duration
spoiled 1 "coefficients/001: no harmonic of the motion can be fitted" 001/summary.json '/"motion omega"/d'
spoiled 1 "summary.json" 001/summary.json '1s/{/{ broken/'
says "^mps coefficients: coefficients/001: "
[ "$(column 'A_surge_surge\[')" -eq 1 ] && grep -q ',nan,nan,nan,nan,nan,0,' coefficients/coefficients.csv || fail "coefficients of one motion of two: $(cat coefficients/coefficients.csv)"
spoiled 0 "" 001/trace.csv '1s/walls_surge/other/'
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^A_surge_surge_walls/) j = i; next } { exit !($j == "nan") }' coefficients/coefficients.csv ||
    fail "A by walls that are not there: $(cat coefficients/coefficients.csv)"
spoiled 1 "coefficients/003: trace.csv has no steps" 003/trace.csv '2,$d'
spoiled 2 "coefficients/003 failed, exit code 2" 003/case.yaml 's/^dp: .*/dp: 81 mm/'
says "coefficients/003: there is a run of another case"
rm -r coefficients
mv kept_coefficients coefficients
for file in csv dat; do
    mv coefficients/coefficients.$file kept.$file
    mkdir coefficients/coefficients.$file
    expect 1 "coefficients.$file: Is a directory" "$program" "${series[@]}"
    rmdir coefficients/coefficients.$file
    ln -s /dev/full coefficients/coefficients.$file
    expect 1 "coefficients.$file: No space left" "$program" "${series[@]}"
    rm coefficients/coefficients.$file
    mv kept.$file coefficients/coefficients.$file
done
# refused before a run is created
expect 2 "use 'mps sweep'" "$program" coefficients forced.yaml --set "sweep={motion.surge.period: 1 2 T1}" -o none
expect 2 "no.yaml" "$program" coefficients no.yaml -o none
expect 2 "--set: there are too many" "$program" coefficients forced.yaml "${many[@]:0:120}" -o none
expect 2 "mps coefficients: --out: is too long" "$program" coefficients forced.yaml -o "$name"
expect 2 "forced.yaml: centre, axes, forward and order are too long" "$program" coefficients forced.yaml --set "motion.centre=0.5$(printf ' %.0s' {1..1100})0 m" -o none
refused_size() { # degrees, amplitude, degree that is named, what is allowed
    expect 2 "mps coefficients: --amplitude: $3: '$2': it must be $4, and not 0, e.g. " "$program" coefficients forced.yaml --degrees "$1" --amplitude "$2" --period "1.6 T1" -o none
    [ "$(wc -l < log)" -eq 1 ] || fail "an amplitude that is refused: $(cat log)"
}
refused_size "surge roll" "2 mm" roll "an angle"
refused_size "roll surge" "2 mm" roll "an angle"
refused_size "heave pitch" "1 dp" pitch "an angle" # 'pitch' is checked although the tank is 2-D
refused_size "surge roll" "0 deg" surge "a length or an angle"
refused_size "surge" "2 s" surge "a length or an angle"
refused_size "surge" "2" surge "a length or an angle"
refused_size "roll" "little" roll "an angle"
refused_size "roll" "nan deg" roll "an angle"
refused_size "roll" "1 deg, phase: 3 deg" roll "an angle"
[ -e none ] && fail "a refused series made a folder"
# motions and ramps of series that the folder is not of
of_another() { # text, arguments of coefficients
    local text=$1
    shift
    expect 2 "$text" "$program" coefficients forced.yaml -o coefficients "$@"
    says "coefficients/001: there is a run of another case"
    says "coefficients/001 failed, exit code 2"
    [ "$(grep -c 'load .* by' log)" -eq 0 ] || fail "a table without a run: $(cat log)"
}
of_another "run 1 of 1: motion={centre: 0.5 0 m, surge: {slope: 0.25 deg, period: 1.6 T1, ramp: 4}}" --period "1.6 T1"
of_another "surge: {slope: 0.25 deg, period: 1 T1, ramp: 12}}" --period "1 T1"
of_another "surge: {slope: 0.25 deg, period: 0.5 s, ramp: 6}}" --period "0.5 s"
of_another "heave: {slope: 0.01 rad, omega: 9 rad/s, ramp: 1}}" --degrees heave --omega "9 rad/s" --amplitude "0.01 rad" --periods 1
# in 3-D, with axes of its own; a tilt takes the longest period where no T1 is known
expect 0 "" "$program" coefficients forced.yaml --degrees roll --omega "20 rad/s" --periods 1 -o solid -q --set dim=3 --set "tank={size: 0.3 0.3 0.3 m}" --set "gravity=0 m/s2" \
    --set "motion={centre: 0.15 0 0.15 m, axes: 'x forward, y port, z up', surge: {amplitude: 1 mm, period: 1 s}}" --set "dp=100 mm"
head -1 solid/coefficients.csv | grep -qF ',A_roll_roll[kg m2],' || fail "units in 3-D: $(cat solid/coefficients.csv)"
grep -q '^  until: 0.942477796 s' solid/001/case.yaml || fail "three periods at 20 rad/s: $(grep until solid/001/case.yaml)"
grep -q '^  until: 5.02654825 s' solid/002/case.yaml && grep -q '^  axes: "x forward, y port, z up"' solid/002/case.yaml || fail "a tilt in 3-D: $(cat solid/002/case.yaml)"
# interrupted: no other run, no tables
"$program" coefficients forced.yaml --degrees "surge roll" --period "2000 T1" --periods 2 -o halted > log 2>&1 &
pid=$!
for ((k = 0; k < 600; k++)); do
    [ -e halted/001/trace.csv ] && break
    sleep 0.05
done
sleep 0.5
kill -INT $pid
wait $pid
[ $? -eq 130 ] || fail "coefficients interrupted: $(tail -3 log)"
says "^mps coefficients: halted/001 was interrupted, exit code 130$"
[ -e halted/002 ] && fail "an interrupted series went on"
[ -e halted/coefficients.csv ] && fail "a table of an interrupted run"
expect 0 "" "$program" coefficients forced.yaml --degrees sway --omega "200 deg/s" --amplitude "9 mm" --periods 3 -o by_omega
grep -q "averages over" log && fail "a load by the pressures of walls warns as if it were an impact: $(cat log)"
grep -q "t = .* s, .* steps in" log || fail "no messages of the run: $(cat log)"
grep -q '^3\.4906' by_omega/coefficients.csv || fail "200 deg/s: $(cat by_omega/coefficients.csv)"

# ---- memory that runs out: at each allocation of a short command, at some of a long one. No crash;
# a failure has a message, and what is done is right
starve() { # step, command ..
    local step=$1 k=1 code calls
    shift
    COUNT_CALLS=calls LD_PRELOAD=$memory "$program" "$@" > whole 2> /dev/null || fail "$*: exit $? with memory"
    calls=$(cat calls)
    while [ "$k" -le "$calls" ]; do
        FAIL_AT=$k LD_PRELOAD=$memory "$program" "$@" > log 2> errors
        code=$?
        case $code in
        0) sed '/^cost /d' log | cmp -s - <(sed '/^cost /d' whole) || fail "$*, allocation $k: exit 0 with another output" ;;
        1 | 2) [ -s errors ] || fail "$*, allocation $k: exit $code without a message" ;;
        *) fail "$*, allocation $k of $calls: exit $code: $(tail -2 errors)" ;;
        esac
        k=$((k + step))
    done
    [ "$calls" -ge 1 ] || fail "$*: no allocation"
}
if [ -n "$memory" ]; then
    expect 0 "" "$program" sweep sweep.yaml -o whole_sweep -q
    starve 1 stats flat
    starve 1 stats flat P --set "impacts.threshold=2 Pa"
    starve 1 compare dry dry dry/probes.csv
    starve 3 report done --set "impacts.threshold=2 Pa"
    starve 1 schema
    starve 1 list solvers
    starve 7 check small.yaml -o small.svg
    starve 97 run small.yaml -o starved --overwrite
    starve 29 sweep sweep.yaml -o whole_sweep -q
    # a folder with short tables of steps: to read those of `series` took three times as long, by
    # the same allocations
    series=(coefficients forced.yaml --degrees "surge roll" --period "1 T1" --periods 1 --set "run.dt=20 ms" -o short -q)
    expect 0 "" "$program" "${series[@]}"
    starve 3 "${series[@]}"
fi

[ $failed -eq 0 ] && echo "mps says what is in its way"
exit $failed
