# SPDX-License-Identifier: BSD-3-Clause
# Sourced by tests of drivers on ranks, whose arguments are the folder of the drivers and mpirun.
# 77: MPI cannot start ranks.
here=$(realpath "$(dirname "$0")")
mpirun=${2:?usage: $0 FOLDER_OF_DRIVERS MPIRUN}
. "$here/../cases/drivers.sh"
export ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0 # of MPI
"$here/run" "$mpirun" 3 true || exit 77
export MPI_STARTS=1

ranks() { # exit code, ranks, driver, options...
    local wanted=$1 code
    "$here/run" "$mpirun" "$2" "$drivers/$3" --mpi "${@:4}" </dev/null >log 2>&1
    code=$?
    [ $code = "$wanted" ] || { fail "$2 ranks, ${*:3}: exit $code instead of $wanted"; cat log; }
}

# All files except the report and the summary, which contain times, and the state of ParaView, which
# contains its folder; of the summary all lines without times and the command line.
same() { # folder, other folder
    local file
    diff -rq -x report.html -x summary.json -x paraview.py "$1" "$2" || fail "$2 is not the same as $1"
    for file in "$1" "$2"; do grep -vE '"(.*_s|s_per_step|peak_rss_bytes|ranks|threads|command|date)":' "$file/summary.json" >"$file.summary"; done
    cmp "$1.summary" "$2.summary" || fail "$2/summary.json is not that of $1"
}
