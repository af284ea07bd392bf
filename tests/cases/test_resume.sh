#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checkpoints of the drivers: an interrupted or killed run that is resumed gives the same bytes as
# an uninterrupted one.
# usage: tests/cases/test_resume.sh FOLDER_OF_DRIVERS
export LC_ALL=C # awk, printf and sort take numbers with a point
set -uo pipefail
. "$(dirname "$0")/drivers.sh"

# A refusal touches none of the outputs.
refused() { # text that must be in the message, folder, driver, options...
    local text=$1 folder=$2 file
    shift 2
    rm -rf before && cp -r "$folder" before
    runs 2 "$@" --resume --out "$folder"
    grep -qF -- "$text" log || fail "$*: says '$(cat log)', not '$text'"
    diff -rq before "$folder" || fail "$*: is refused and changes $folder"
}

# Send a signal to a run as soon as it has written a checkpoint.
stopped() { # signal, exit code, folder, driver, options...
    local signal=$1 wanted=$2 folder=$3
    shift 3
    starts log "$@" --out "$folder"
    wait_for test -e "$folder/checkpoint.mps"
    kill -"$signal" $pid
    ends "$wanted" "$* and $signal" log
}

same() { # folder, folder
    local file
    for file in probes.csv momentum.csv steps.csv; do cmp "$1/$file" "$2/$file" || fail "$2/$file is not that of $1"; done
    [ ! -e "$1/trace.csv" ] || cmp "$1/trace.csv" "$2/trace.csv" || fail "$2/trace.csv is not that of $1"
    for file in "$1"/picture_*.png; do cmp "$file" "$2/${file#*/}" || fail "$2/${file#*/} is not that of $1"; done
    [ ! -e "$1/peaks.pvd" ] || { cmp "$1/peaks.pvd" "$2/peaks.pvd" && diff -rq "$1/peaks" "$2/peaks"; } || fail "$2 has other frames about peaks than $1"
}

# All frames of the series exist and no others, at increasing times.
series() { # folder
    sed -n 's/.*timestep="\([^"]*\)".*/\1/p' "$1/frames.pvd" | awk 'NR > 1 && $1 <= last {exit 1} {last = $1}' || fail "$1/frames.pvd: times do not increase"
    sed -n 's/.*file="\([^"]*\)".*/\1/p' "$1/frames.pvd" | diff - <(cd "$1" && find frames -name '*.vtp' | sort) || fail "$1/frames.pvd does not name its files"
}

# Ctrl-C, and SIGKILL a while after a checkpoint. Where the machine is quick these runs get farther:
# the end is chosen behind both. Frames are at the same times with either end, the first picture is
# before the checkpoint, the second one after it.
goes_on() { # name, interval of checkpoints, of frames, driver, options...
    local name=$1 interval=$2 frames=$3 end first second
    shift 3
    first=$(awk "BEGIN {print $interval / 2}")
    local endless=(--t-end "$(awk "BEGIN {print 50000 * $frames}")" --frames 50000 --checkpoint "$interval" --pictures "$first")
    stopped INT 130 "$name.int" "$@" "${endless[@]}"
    grep -q -- '--resume with the same options continues' log || fail "$*: Ctrl-C does not say how to go on: $(cat log)"
    stopped KILL 137 "$name.kill" "$@" "${endless[@]}"
    end=$(later "$(awk "BEGIN {print 4 * $frames}")" "$name.int" "$name.kill")
    second=$(awk "BEGIN {print $end - 2 * $frames}")
    set -- "$@" --t-end "$end" --frames "$(awk "BEGIN {printf \"%.0f\", $end / $frames}")" --pictures "$first,$second"
    runs 0 "$@" --out "$name"
    [ -s "$name/picture_2.png" ] || fail "$name: no second picture"
    runs 0 "$@" --out "$name.int" --resume
    same "$name" "$name.int"
    series "$name.int"
    printf '1,2' >>"$name.kill/probes.csv" # a row of which only half came to the disk
    tail -n 2 "$name/steps.csv" >>"$name.kill/steps.csv"
    cat "$name/probes.csv" >>"$name.kill/probes.csv" # more than the rest of the run will write
    runs 0 "$@" --out "$name.kill" --resume --checkpoint "$interval"
    same "$name" "$name.kill"
    series "$name.kill"
    diff -rq "$name/frames" "$name.kill/frames" || fail "$name.kill has other frames than $name"
    cmp "$name/frames.pvd" "$name.kill/frames.pvd" || fail "$name.kill/frames.pvd is not that of $name"
}
goes_on surge 0.2 0.05 sloshing_surge --dp 0.025
goes_on air 0.02 0.005 sloshing_high_fill --model mmps --dp 0.05 --sensor-average 0.005
goes_on impact 0.02 0.002 impact --case flat --dp 0.02 --cfl 0.1
goes_on solid 0.04 0.006 sloshing_baffle_3d --dp 0.025

# an end, and a later end
tank=(static_tank --dp 0.04 --probe-dt 0.002)
runs 0 "${tank[@]}" --t-end 0.2 --frames 2 --pictures 0.01 --out longer
refused 'later than --t-end, 0.04 s' longer "${tank[@]}" --t-end 0.04
refused 'probes.csv: has rows at other times; their rate must be what it was' longer static_tank --dp 0.04 --probe-dt 0.001 --t-end 0.4
refused 'dp 0.04' longer static_tank --dp 0.05 --probe-dt 0.002 --t-end 0.4
refused 'distance 0.5' longer "${tank[@]}" --t-end 0.4 --set collision.distance=0.5
refused 'must be set up by the same calls' longer sloshing_surge --dp 0.04 --probe-dt 0.002 --t-end 0.4
runs 0 "${tank[@]}" --t-end 0.4 --frames 4 --pictures 0.01 --resume --out longer
runs 0 "${tank[@]}" --t-end 0.4 --frames 4 --pictures 0.01 --out at_once
same at_once longer
diff -r at_once/frames longer/frames || fail "an extended run has other frames"
grep -q '"t_resumed": 0.1' longer/summary.json || fail "an extended run's summary: $(grep t_resumed longer/summary.json)"
grep -q "\"steps\": $(($(wc -l <longer/steps.csv) - 1))," longer/summary.json || fail "an extended run's steps: $(grep steps longer/summary.json)"
series longer
runs 0 "${tank[@]}" --t-end 0.4 --frames 4 --pictures 0.01 --resume --out longer # only the last steps are left to do
grep -q "the run in 'longer' reached its end; its last steps from" log || fail "a run that is done does not say so: $(cat log)"
same at_once longer

# runs that cannot be resumed
rm -rf old && cp -r surge old && rm old/checkpoint.mps
refused 'reached its end, t = ' old sloshing_surge --dp 0.025 --t-end 0.1
grep -q 'has no checkpoint; give a later --t-end' log || fail "a finished run without checkpoint: $(cat log)"
mkdir empty
refused "there is no run in 'empty'" empty sloshing_surge --dp 0.025 --t-end 1
damage() { # text that must be in the message, shell command that damages the copy
    rm -rf damaged && cp -r longer damaged
    (cd damaged && eval "$2") || fail "cannot damage: $2"
    refused "$1" damaged "${tank[@]}" --t-end 0.5
    grep -q 'start anew with --overwrite, or in another folder' log || fail "$2: does not say what to do: $(cat log)"
}
size=$(stat -c %s longer/checkpoint.mps)
for at in 0 3 $((size / 4)) $((size / 2)) $((size - 1)); do
    damage 'checkpoint.mps"' "printf '\\x5a' | dd of=checkpoint.mps bs=1 seek=$at conv=notrunc status=none"
    damage 'checkpoint.mps"' "truncate -s $at checkpoint.mps"
done
damage 'probes.csv: has not the columns of this run' "sed -i '1s/P1/P7/' probes.csv"
damage 'momentum.csv: ends before the checkpoint' "sed -i '60,\$d' momentum.csv"
damage 'steps.csv has not the steps of the checkpoint' "sed -i '30,\$d' steps.csv"
damage 'steps.csv has not the steps of the checkpoint' "sed -i '5d' steps.csv"
damage 'probes.csv: ends before the checkpoint' "sed -i '5s/,/;/' probes.csv"
damage 'steps.csv: No such file' 'rm steps.csv'
rm -rf damaged && cp -r longer damaged && echo more >>damaged/frames.pvd
runs 1 "${tank[@]}" --t-end 0.5 --resume --out damaged
grep -q 'frames.pvd' log || fail "a series that is not ours: $(cat log)"

# a restarted run removes the checkpoint of the older one
runs 0 "${tank[@]}" --t-end 0.01 --frames 0 --out longer --overwrite
[ ! -e longer/checkpoint.mps ] || fail "a checkpoint stays behind"

# without --checkpoint there is one at SIGTERM
starts log static_tank --dp 0.04 --t-end $never --frames 0 --out term
wait_for more_lines term/probes.csv 1
kill -TERM $pid
ends 130 SIGTERM log
[ -s term/checkpoint.mps ] || fail "SIGTERM leaves no checkpoint"

if [ $failures -gt 0 ]; then exit 1; fi
echo "runs go on as if they had not stopped"
