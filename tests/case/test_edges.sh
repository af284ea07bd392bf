#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Edges of tanks in 3-D, in summary.json: those of prisms and files, lines on cylinders and balls,
# none of boxes.
# usage: test_edges.sh PROGRAM
export LC_ALL=C # awk, printf and sort take numbers with a point
program=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failed=0
fail() {
    echo "FAILED: $*"
    failed=1
}
# name, number of edges, their length together [m], tank
edges() {
    printf 'mps: 1\ndim: 3\ndp: 0.2 m\ntank: %s\nfill: [{water: {depth: 50 %%}}]\nrun: {until: 0.001 s, threads: 1}\noutput: {frames: 1}\n' "$4" > "$1.yaml"
    "$program" run "$1.yaml" -q -o "$1" > log 2>&1 || fail "$1: $(cat log)"
    awk -v count="$2" -v length_all="$3" '/^  "edges"/ { inside = 1; next } /^  \]/ { inside = 0 }
        inside { gsub(/[][,]/, " "); n++; s += sqrt(($4 - $1) ^ 2 + ($5 - $2) ^ 2 + ($6 - $3) ^ 2) }
        END { if (n + 0 != count || (s - length_all) ^ 2 > (0.005 * length_all + 1e-5) ^ 2) { print n + 0, s + 0; exit 1 } }' \
        "$1/summary.json" > counted || fail "$1: edges and length $(cat counted), not $2, $3"
    grep -q '"edges": \[' "$1/report.html" || fail "$1: no edges in the page"
    [ -s "$1/picture_end.png" ] || fail "$1: no picture"
}
edges box 0 0 '{size: 2 1.2 1 m}'
# eight corners: two ends of 2 x 0.4 sqrt(2) + 2 x 0.2 sqrt(2) + 1.2 + 1.6 + 2 x 0.6, eight lines of
# 1 m
edges prism 24 19.394 '{size: 2 1.2 1 m, chamfer: {bottom: 0.2 0.2 m, top: 0.4 0.4 m}}'
edges across 24 19.394 '{size: 1 1.2 2 m, chamfer: {bottom: 0.2 0.2 m, top: 0.4 0.4 m, across: z}}'
# a corner of 11 degrees at (1, 1.1) is no edge across
edges roof 14 16.020 '{polygon: [0 0 m, 2 0 m, 2 1 m, 1 1.1 m, 0 1 m], width: 1 m}'
# two circles of 48 lines each, four lines along
edges tube 100 20.566 '{cylinder: {radius: 1 m, length: 2 m, axis: z}}'
# with heads like half of a ball: two great circles more
edges heads 196 33.13 '{cylinder: {radius: 1 m, length: 2 m, heads: 1 m, axis: x}}'
edges ball 144 18.850 '{sphere: {radius: 1 m}}'
{
    echo solid cube
    for face in "0 0 0 0 1 0 1 1 0" "0 0 0 1 1 0 1 0 0" "0 0 1 1 0 1 1 1 1" "0 0 1 1 1 1 0 1 1" "0 0 0 1 0 0 1 0 1" "0 0 0 1 0 1 0 0 1" \
        "0 1 0 0 1 1 1 1 1" "0 1 0 1 1 1 1 1 0" "0 0 0 0 0 1 0 1 1" "0 0 0 0 1 1 0 1 0" "1 0 0 1 1 0 1 1 1" "1 0 0 1 1 1 1 0 1"; do
        echo "facet normal 0 0 0 outer loop"
        echo "$face" | xargs -n 3 echo vertex
        echo "endloop endfacet"
    done
    echo endsolid
} > cube.stl
edges file 12 12 '{stl: cube.stl, unit: m, shift: 0 0 5 m}'
[ $failed -eq 0 ] && echo "edges are those of the tanks"
exit $failed
