#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The folder of a run: an earlier run is not overwritten by accident, only one run writes at a time,
# a folder that cannot be written is refused.
# usage: tests/cases/test_folder.sh FOLDER_OF_DRIVERS
set -uo pipefail
. "$(dirname "$0")/drivers.sh"
tank=(static_tank --dp 0.04 --probe-dt 0.002 --t-end 0.3 --frames 2)

says() { # texts that must be in the log...
    local text
    for text in "$@"; do grep -qF -- "$text" log || fail "says '$(cat log)', not '$text'"; done
}

unchanged() { # text in the message, folder, options...
    local text=$1 folder=$2
    shift 2
    rm -rf before && cp -r "$folder" before
    runs 2 "${tank[@]}" --out "$folder" "$@"
    says "$text"
    diff -r before "$folder" || fail "$*: is refused and changes $folder"
}

# ---- an earlier run
runs 0 "${tank[@]}" --checkpoint 1 --out run
unchanged 'there is an earlier run (checkpoint.mps, probes.csv, steps.csv, frames.pvd, summary.json)' run
says '--resume continues from its checkpoint' '--overwrite removes it'
unchanged '--resume and --overwrite exclude each other' run --resume --overwrite
runs 0 "${tank[@]}" --out run --resume
for what in probes.csv steps.csv frames.pvd summary.json; do
    mkdir -p "some_$what" && cp "run/$what" "some_$what"
    unchanged "there is an earlier run ($what); --resume begins it again, since it has no checkpoint" "some_$what"
done
mkdir -p mine/frames && touch mine/notes.txt mine/picture_x.png mine/plot_mine.svg mine/frames/frames_1.vtp
runs 0 "${tank[@]}" --out mine # nothing of a run
runs 0 "${tank[@]}" --checkpoint 1 --pictures 0.01,0.02,0.03,0.04 --out mine --overwrite
cp mine/probes.csv whole.csv
runs 0 static_tank --dp 0.04 --probe-dt 0.002 --t-end 0.02 --frames 0 --pictures 0.01 --no-report --out mine --overwrite
for what in notes.txt picture_x.png plot_mine.svg frames/frames_1.vtp; do [ -e "mine/$what" ] || fail "--overwrite removes $what"; done
for what in frames.pvd frames/frames_000000.vtp picture_2.png report.html run.lock; do
    [ ! -e "mine/$what" ] || fail "--overwrite leaves $what"
done
runs 2 "${tank[@]}" --out mine --overwrite --use bogus.model # refused for another reason: nothing is removed
[ -e mine/probes.csv ] || fail "a wrong option removes an earlier run"

runs 2 "${tank[@]}" --out mine2 --use gas.compressible # refused when the first step begins: no run is there
[ ! -e mine2/probes.csv ] || fail "a run that is refused leaves files that the next one is refused for"

# ---- two runs at a time
starts busy.log static_tank --dp 0.04 --t-end $never --frames 0 --out busy
wait_for test -e busy/probes.csv
for option in --overwrite --resume; do
    runs 2 "${tank[@]}" --out busy $option
    says "another run is writing there, process $pid"
done
kill -KILL $pid
wait $pid 2>/dev/null
[ -e busy/run.lock ] || fail "this test expects the file of a killed run"
runs 0 "${tank[@]}" --out busy --overwrite
[ ! -e busy/run.lock ] || fail "the file of the lock stays"

# ---- folders that cannot be written
other=()
[ "$(id -u)" != 0 ] || other=(setpriv --reuid 65534 --regid 65534 --clear-groups)
mkdir closed && chmod 555 closed && chmod 755 .
if "${other[@]}" "$drivers/static_tank" --version >/dev/null 2>&1; then
    for folder in closed closed/below; do
        (exec "${other[@]}" "$drivers/static_tank" --out $folder) >log 2>&1
        [ $? = 2 ] || fail "a folder without permission: not exit 2"
        says "--out $folder: Permission denied; choose another folder with --out, or change the permissions"
    done
else
    echo "skipped: folders without permission (no other user can run $drivers/static_tank)"
fi

disk() { # options of mount, text, exit code, options of the driver...
    local options=$1 text=$2 wanted=$3
    shift 3
    mkdir -p disk
    unshare -m bash -c 'mount -t tmpfs -o "$1" none disk && shift && exec "$@"' - "$options" "$drivers/static_tank" --dp 0.04 --out disk/run --threads 1 "$@" >log 2>&1
    [ $? = "$wanted" ] || { fail "a disk of $options: not exit $wanted"; cat log; }
    says "$text"
}
if unshare -m mount -t tmpfs none /mnt 2>/dev/null; then
    disk size=32k 'No space left on device; the disk is full; free space on it' 2
    disk size=256k 'outputs cannot be written: No space left on device; the disk is full' 1 --t-end 1000 --probe-dt 1e-4 --frames 0 # in mid-run
    disk ro 'Read-only file system; the disk can only be read; choose a folder on another one' 2
else
    echo "skipped: full and read-only disks (mount is not allowed)"
fi

if [ $failures -gt 0 ]; then exit 1; fi
echo "folders of runs are in order"
