#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs that are stopped by a signal: a checkpoint, rows that are complete up to it and go on without gap or double; progress in a batch log.
# usage: tests/cases/test_interrupt.sh FOLDER_OF_DRIVERS
set -uo pipefail
. "$(dirname "$0")/drivers.sh"
surge=(sloshing_surge --dp 0.025 --t-end 1.5 --frames 0 --no-report --probe-dt 0.001)

begin() { # folder, driver, options...: starts it; $pid
    "$drivers/$2" "${@:3}" --out "$1" --threads 1 >"$1.log" 2>&1 &
    pid=$!
}

has_rows() { # folder: waits until some are on the disk
    local tries=0
    until [ -s "$1/probes.csv" ] || [ $((tries += 1)) -gt 3000 ] || ! kill -0 "$pid" 2>/dev/null; do sleep 0.01; done
}

ends() { # exit code, what, folder
    wait "$pid" 2>/dev/null
    local code=$?
    [ $code = "$1" ] || { fail "$2: exit $code instead of $1"; cat "$3.log"; }
}

# A row at every 0.001 s from 0 up to the time of the last step, which is that of the checkpoint, and no other.
complete() { # folder
    awk -F, -v last="$(tail -1 "$1/steps.csv" | cut -d, -f1)" 'NR == 1 {next}
        ($1 - (NR - 2) * 1e-3) ^ 2 > 1e-24 {print "row", NR, "is at", $1; exit 1}
        END {if (NR - 2 != int(last / 1e-3 + 1e-6)) {print NR - 1, "rows until", last; exit 1}}' "$1/probes.csv" ||
        fail "$1/probes.csv is not complete"
}

begin batch static_tank --dp 0.02 --t-end 1000 --frames 0 --no-report # for what comes last
batch=$pid
begin silent static_tank --dp 0.02 --t-end 1000 --frames 0 --no-report --quiet
silent=$pid
begun=$SECONDS

runs 0 "${surge[@]}" --out whole
for signal in INT TERM HUP; do
    begin $signal "${surge[@]}"
    has_rows $signal
    kill -$signal $pid
    [ $signal != HUP ] || { sleep 0.02; kill -HUP $pid 2>/dev/null; } # terminals say it more than once
    ends 130 SIG$signal $signal
    [ -s $signal/checkpoint.mps ] || fail "SIG$signal leaves no checkpoint"
    [ ! -e $signal/run.lock ] || fail "SIG$signal leaves the folder locked"
    [ -s $signal/summary.json ] || fail "SIG$signal leaves no summary"
    complete $signal
    runs 0 "${surge[@]}" --out $signal --resume
    for file in probes.csv momentum.csv steps.csv; do cmp whole/$file $signal/$file || fail "SIG$signal, --resume: other $file"; done
done

# nohup: the signal is ignored
trap '' HUP
begin nohup sloshing_surge --dp 0.025 --t-end 0.3 --frames 0 --no-report
trap - HUP
has_rows nohup
kill -HUP $pid 2>/dev/null
ends 0 "SIGHUP under nohup" nohup

# no process reads what it says
"$drivers/static_tank" --dp 0.04 --t-end 1000 --frames 0 --out pipe --threads 1 2> >(exec true) &
pid=$!
has_rows pipe
kill -TERM $pid
touch pipe.log
ends 130 "SIGTERM with a closed pipe" pipe

# a line every 10 s
sleep $((begun + 13 - SECONDS > 0 ? begun + 13 - SECONDS : 0))
for pid in $batch $silent; do kill -TERM $pid; done
pid=$batch
ends 130 "the batch run" batch
pid=$silent
ends 130 "the silent run" silent
number='[0-9.e+-]+'
grep -E "^t=$number step=[0-9]+ dt=$number wall=$number eta=$number\$" batch.log | sed 's/.*wall=\([0-9.]*\).*/\1/' |
    awk '{if ($1 - last < 9.9) exit 1; last = $1} END {exit !(last >= 9.9)}' || fail "not a line of progress every 10 s: $(cat batch.log)"
grep -q 'eta=' silent.log && fail "--quiet shows progress"
complete batch

if [ $failures -gt 0 ]; then exit 1; fi
echo "runs that are stopped can go on"
