#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Each case gives the same bytes of probes.csv, frames and checkpoint on the host and on a GPU, and
# a checkpoint of one is resumed on the other. The GPU is the stand-in for the driver, which runs
# the kernels by OpenCL. 77: no OpenCL. Cases run alternately with the first or the second half on
# the GPU; named cases run both. MPIRUN in the environment: two ranks with a GPU each also have the
# bytes of a single process.
# usage: test_cases.sh PROGRAM CASES FOLDER_OF_STANDIN FOLDER_OF_PLUGIN KERNELS [NAME ..]
program=$1 cases=$2 standin=$3 plugin=$4 kernels=$5
shift 5
table=$(realpath "$(dirname "$0")/../case/short_runs") starter=$(realpath "$(dirname "$0")/../mpi/run")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export LC_ALL=C
failed=0 runs=0 turn=0 continued=0 both=$#

fail() {
    echo "FAILED: $*: $(tail -3 log)"
    failed=1
}
gpu() { LD_LIBRARY_PATH=$standin:$plugin STANDIN_KERNELS=$kernels "$program" "$@" --device cuda; }
host() { "$program" "$@"; }

# Half of a run on the host, the other half on the GPU.
halves() { # where, where, folder, case, time, options..
    local first=$1 second=$2 folder=$3 case=$4 t=$5
    shift 5
    $first run "$case" -o "$folder" -j 1 -q --set "run.until=$(awk "BEGIN {print $t / 2}") s" --set "run.checkpoint=1000 s" --set output.frames=2 \
        --set "output.page=0 MB" "$@" > log 2>&1 || { fail "$case: first half: $first"; return 1; }
    $second resume "$folder" -j 1 -q --set "run.until=$t s" > log 2>&1 || { fail "$case: second half: $second"; return 1; }
}
tested() { # name, case, time, options..
    local name=$1 file folder
    shift
    halves host host "$name.host" "$@" || return
    # a run of a few steps, all of them fitted to its end, has no checkpoint: the second half begins
    # anew
    local files=(probes.csv momentum.csv frames)
    if [ -s "$name.host/checkpoint.mps" ]; then
        files+=(checkpoint.mps)
        continued=$((continued + 1))
    fi
    [ "$(wc -l < "$name.host/probes.csv")" -ge 3 ] || fail "$name: $(wc -l < "$name.host/probes.csv") rows"
    local folders=("$name.gpu_host" "$name.host_gpu")
    [ "$both" -gt 0 ] || folders=("${folders[turn++ % 2]}")
    for folder in "${folders[@]}"; do
        case $folder in *gpu_host) halves gpu host "$folder" "$@" ;; *) halves host gpu "$folder" "$@" ;; esac || continue
        for file in "${files[@]}"; do
            diff -rq "$name.host/$file" "$folder/$file" > log 2>&1 || fail "$name"
        done
        runs=$((runs + 1))
    done
    rm -rf "$name".*
}

printf 'mps: 1\ndp: 50 mm\ntank: {size: 0.5 0.3 m}\nfill: [{water: {depth: 0.1 m}}]\nrun: {until: 0.01 s}\noutput: {frames: 0, page: 0 MB}\n' > still.yaml
gpu run still.yaml -o still -q > log 2>&1 || { grep -q "driver of NVIDIA does not start" log && { cat log; exit 77; }; fail "a run on the stand-in"; exit 1; }
grep -q '"device": "cuda"' still/summary.json || fail "the summary does not tell the device"

while read -r name t; do
    [ $# -gt 0 ] && [[ " $* " != *" $name "* ]] && continue
    tested "$name" "$cases/$name.yaml" "$t"
done < "$table"
[ $# -gt 0 ] || tested dam_break_3d "$cases/dam_break.yaml" 0.1 --set dim=3 --set "dp=50 mm"
ranks() {
    local options=(-j 1 -q --set "run.until=0.3 s" --set "run.checkpoint=0.1 s" --set output.frames=2 --set "output.page=0 MB") case=$cases/sloshing_surge.yaml file
    host run "$case" -o alone "${options[@]}" > log 2>&1 || fail "a run alone"
    LD_LIBRARY_PATH=$standin:$plugin STANDIN_KERNELS=$kernels "$starter" "$MPIRUN" 2 "$program" run "$case" -o many "${options[@]}" --mpi --device cuda > log 2>&1
    case $? in 0) ;; 77) return ;; *) fail "two ranks" ;; esac
    grep -q '"device": "cuda"' many/summary.json || fail "two ranks: the summary does not tell the device"
    for file in probes.csv momentum.csv checkpoint.mps frames; do
        diff -rq "alone/$file" "many/$file" > log 2>&1 || fail "two ranks"
    done
    runs=$((runs + 1))
    # a rank without a driver ends all
    printf '#!/bin/sh\n[ "${OMPI_COMM_WORLD_RANK:-$PMI_RANK}" = 0 ] || unset LD_LIBRARY_PATH\nexec "$@"\n' > some && chmod +x some
    LD_LIBRARY_PATH=$standin:$plugin STANDIN_KERNELS=$kernels timeout 120 "$starter" "$MPIRUN" 2 ./some "$program" run "$case" -o none "${options[@]}" --mpi --device cuda > log 2>&1
    [ $? -eq 2 ] && grep -q "no driver of NVIDIA is installed" log || fail "a rank without a driver"
}
[ -z "${MPIRUN:-}" ] || [ $# -gt 0 ] || ranks
[ $# -gt 0 ] || [ $continued -ge 12 ] || fail "only $continued cases went on from a checkpoint"
[ $failed -eq 0 ] && echo "$runs runs, one half on the host, one on the GPU, or on two ranks: the same bytes"
exit $failed
