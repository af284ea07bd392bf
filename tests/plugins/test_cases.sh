#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Plug-ins of cases in the program mps: check, run, resume, sweep, pages, and each refusal of a
# plug-in.
# usage: test_cases.sh PROGRAM FOLDER_OF_PLUGINS [RANKS]     RANKS: a program that runs its
# arguments on two ranks
program=$1 modules=$2 mpirun=$3
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../case/program_kit.sh"
unset MPS_PLUGIN_PATH
says() { grep -qF -- "$1" log || fail "no '$1' in: $(head -8 log)"; }
same() { cmp -s "$1" "$2" || fail "$1 and $2 differ"; }

mkdir lib
cp "$modules"/plugin_*.so lib/
mv lib/plugin_screen.so lib/libscreen.so
cat > tank.yaml << END
mps: 1
dp: 50 mm
tank: {size: 1 0.5 m}
fill: [{water: {depth: 0.2 m}}]
motion: {surge: {amplitude: 5 mm, period: 1 s}}
sensors: {P: {wall: 0 0.1 m}}
run: {until: 0.05 s, threads: 1}
output: {frames: 0, page: 0 MB}
END
cat > case.yaml << END
base: tank.yaml
plugins: [lib/libscreen.so]
use: [screen.uniform]
settings: {screen.rate: 20 1/s}
END

# ---- a plug-in acts: with a rate of 0 the bytes are those of the tank without it, a rate changes
# them
expect 0 "" "$program" run tank.yaml -q -o plain
expect 0 "" "$program" run case.yaml -q -o drag
expect 0 "" "$program" run case.yaml -q -o zero --set "settings.screen.rate=0 1/s"
same plain/probes.csv zero/probes.csv
cmp -s plain/probes.csv drag/probes.csv && fail "the plug-in has no effect"
sum=$(sha256sum lib/libscreen.so | cut -d' ' -f1)
python3 - drag/summary.json "$sum" << 'END' || fail "plugins of summary.json"
import json, sys
p = json.load(open(sys.argv[1]))["plugins"][0]
assert p["name"] == "screen" and p["version"] == "1.0" and p["sha256"] == sys.argv[2] and p["file"].endswith("/lib/libscreen.so")
assert [(i["kind"], i["name"]) for i in p["items"]] == [
    ("model", "screen.uniform"), ("preconditioner", "plain"), ("load", "magnet"), ("motion", "carriage")]
END
grep -q "sha256: $sum" drag/case.yaml || fail "case.yaml of a run has no checksum"
expect 0 "screen 1.0: $work/lib/libscreen.so, SHA-256 ${sum:0:16}" "$program" check case.yaml
says "model screen.uniform: Uniform drag"
expect 0 "" "$program" run drag/case.yaml -q -o again
same drag/probes.csv again/probes.csv
expect 0 "" "$program" run case.yaml -q -o threads --set run.threads=2
same drag/probes.csv threads/probes.csv

# ---- search path of files; --plugin adds one, or replaces one of the same name
sed 's|lib/libscreen.so|libscreen.so|' case.yaml > name.yaml
expect 2 "MPS_PLUGIN_PATH names further folders" "$program" check name.yaml
expect 0 "" env MPS_PLUGIN_PATH=/nowhere:"$work/lib" "$program" check name.yaml
expect 2 ", nor in MPS_PLUGIN_PATH, '/nowhere'" env MPS_PLUGIN_PATH=/nowhere "$program" check name.yaml
grep -v plugins: case.yaml > none.yaml
expect 2 "no model 'screen.uniform'" "$program" check none.yaml
expect 0 "" "$program" run none.yaml -q -o option --plugin lib/libscreen.so
same drag/probes.csv option/probes.csv
sed 's|lib/|nowhere/|' case.yaml > moved.yaml
expect 2 "moved.yaml:2:11: error: plugins: there is no file 'nowhere/libscreen.so' in '$work/'" "$program" check moved.yaml
expect 0 "" "$program" check moved.yaml --plugin lib/libscreen.so
expect 0 "" "$program" check none.yaml --set "plugins=$work/lib/libscreen.so"
expect 0 "warning: plugins: nothing of this plug-in is used; e.g. 'use: [screen.uniform]'" "$program" check tank.yaml --plugin lib/libscreen.so

# ---- settings: unit, range, kind, name
for value in "30" "30 1/s" "30 1/s" "0.03e3 1/s"; do expect 0 "" "$program" check case.yaml --set "settings.screen.rate=$value"; done
expect 2 "settings.screen.rate: '101 1/s' is out of its range: 0 .. 100 1/s" "$program" check case.yaml --set "settings.screen.rate=101 1/s"
expect 2 "settings.screen.rate: '3 1/m': a number in '1/s' is wanted" "$program" check case.yaml --set "settings.screen.rate=3 1/m"
expect 2 "whole numbers, 1 .. 5" "$program" check case.yaml --set "settings.screen.layers=2.5"
expect 2 "has no unit" "$program" check case.yaml --set "settings.screen.reach=5"
expect 2 "0 .. 1e+06 mm" "$program" check case.yaml --set "settings.screen.reach=1001 m"
expect 2 "-90 .. 90 deg" "$program" check case.yaml --set "settings.screen.angle=2 rad"
expect 0 "" "$program" check case.yaml --set "settings.screen.angle=1.5 rad"
expect 2 "no setting 'screen.rat'; did you mean 'screen.rate'?" "$program" check case.yaml --set "settings.screen.rat=1"
expect 0 "" "$program" run case.yaml -q -o off --set "settings.screen.on=no"
same plain/probes.csv off/probes.csv
expect 0 "" "$program" run case.yaml -q -o all --set "settings.screen.reach=2 m" # mm of the plug-in
same drag/probes.csv all/probes.csv
expect 2 "use.1: no model 'screen.unifrom'; did you mean 'screen.uniform'?" "$program" check case.yaml --set "use=[screen.unifrom]"

# ---- preconditioner, load, motion
expect 0 "" "$program" run tank.yaml -q -o solver --plugin lib/libscreen.so --set run.preconditioner=plain
grep -q '"ppe_solver": ".*plain' solver/summary.json || fail "preconditioner: $(grep ppe_solver solver/summary.json)"
cat > driven.yaml << END
base: tank.yaml
plugins: lib/libscreen.so
motion: {plugin: carriage}
settings: {carriage.amplitude: 5 mm}
END
sed -i '/^base/d;/^motion: {plugin/d' driven.yaml
sed 's|^motion.*|motion: {plugin: carriage}|' tank.yaml >> driven.yaml
expect 0 "" "$program" run driven.yaml -q -o driven --set "run.dt=2.5 ms"
expect 0 "" "$program" run tank.yaml -q -o harmonics --set "run.dt=2.5 ms"
expect 0 ", 'carriage' of a plug-in" "$program" check driven.yaml
python3 - harmonics/probes.csv driven/probes.csv << 'END' || fail "a motion of a plug-in is not that of the case"
import csv, sys
a, b = ([list(map(float, r)) for r in list(csv.reader(open(p)))[1:]] for p in sys.argv[1:])
assert len(a) == len(b) > 40 and max(abs(x[1] - y[1]) for x, y in zip(a, b)) < 1e-6 * max(abs(x[1]) for x in a)
END
expect 2 "motion.plugin: no plug-in has a motion 'carrige'; did you mean 'carriage'?" "$program" check driven.yaml --set motion.plugin=carrige
expect 2 "no plug-in has a motion 'magnet'" "$program" check driven.yaml --set motion.plugin=magnet
expect 2 "motion: give a plug-in or degrees, not both" "$program" check driven.yaml --set "motion.surge={amplitude: 1 mm, period: 1 s}"
sed 's|^motion.*|body: {mass: 100 kg, surge: {stiffness: 4 kN/m}, load: {plugin: magnet}}|' tank.yaml > body.yaml
printf 'plugins: lib/libscreen.so\nsettings: {magnet.strength: 10 N, magnet.period: 2 s}\n' >> body.yaml
sed 's|^motion.*|body: {mass: 100 kg, surge: {stiffness: 4 kN/m, load: {amplitude: 10 N, period: 2 s}}}|' tank.yaml > harmonic.yaml
expect 0 "" "$program" run body.yaml -q -o body
expect 0 "" "$program" run harmonic.yaml -q -o harmonic
python3 - body/probes.csv harmonic/probes.csv << 'END' || fail "a load of a plug-in is not that of the case"
import csv, sys
a, b = (list(csv.DictReader(open(p))) for p in sys.argv[1:])
key = next(k for k in a[0] if k.startswith("body_external_surge"))
assert len(a) == len(b) and abs(float(a[-1][key]) - float(b[-1][key])) < 1e-9 * abs(float(b[-1][key])) != 0
END
expect 2 "body.load: give 'file', a table, or 'plugin'" "$program" check body.yaml --set "body.load={ramp: 1 s}"
expect 2 "has no effect here" "$program" check tank.yaml --plugin lib/libscreen.so --set "settings.magnet.strength=1 N" --set use=screen.uniform

# ---- a run is resumed with the same file only
expect 0 "" "$program" run case.yaml -q -o parts --set "run.checkpoint=0.05 s"
cp -r parts other
expect 0 "" "$program" resume parts -q --set "run.until=0.1 s"
expect 0 "" "$program" resume other -q --set "run.until=0.1 s" -j 2 --plugin lib/libscreen.so
same parts/probes.csv other/probes.csv
cp "$modules/plugin_screen2.so" lib/libscreen.so
expect 2 "is not the file that is wanted: its SHA-256 is" "$program" resume other -q --set "run.until=0.15 s"
expect 2 "plugins.1.sha256 is '" "$program" resume other -q --set "run.until=0.15 s" --set "plugins=$work/lib/libscreen.so"
rm lib/libscreen.so
expect 2 "plugins: there is no file '$work/lib/libscreen.so'" "$program" resume other -q --set "run.until=0.15 s"
sed -i '/^plugins:/,/sha256/d;/^use:/d;/^settings:/,/screen.rate/d' parts/case.yaml
expect 2 'the checkpoint has "plug-in screen 1.0' "$program" resume parts -q --set "run.until=0.15 s"
cp "$modules/plugin_screen.so" lib/libscreen.so

# ---- sweeps vary settings, not plug-ins
cat case.yaml - > sweep.yaml << END
sweep: {settings.screen.rate: [0 1/s, 20 1/s]}
END
expect 0 "" "$program" sweep sweep.yaml -q -o sweep
same plain/probes.csv sweep/001/probes.csv
same drag/probes.csv sweep/002/probes.csv
expect 0 "is done already" "$program" sweep sweep.yaml -o sweep
for path in plugins plugins.file plugins.1.file plugins.1; do
    expect 2 "plug-ins cannot be varied" "$program" sweep case.yaml -o sweep3 --set "sweep={$path: [$work/lib/libscreen.so]}"
done

# ---- a plug-in of a page or a text is not loaded: the constructor of this plug-in creates a file
cp "$modules/plugin_trap.so" lib/trap.so
export TRAP="$work/trapped"
trapped() { [ -e "$TRAP" ] && { fail "$1: the plug-in ran"; rm -f "$TRAP"; }; }
page() { # rest of the case
    printf '<!DOCTYPE html><html><script type="text/yaml" id="case">\n%s\n%s\n</script></html>\n' "$(cat tank.yaml)" "$1" > page.html
}
evil=$work/lib/trap.so
page "plugins: ['$evil']"
for verb in check run sweep repeat converge coefficients fmu; do
    expect 2 "is a program that would run with your rights" "$program" $verb page.html -q -o evil
    trapped "$verb of a page"
done
expect 2 "'$evil' is a program" "$program" check page.html --set "dp=40 mm"
page "set: {plugins: ['$evil']}"
expect 2 "is a program" "$program" check page.html
page "sweep: {plugins.file: ['$evil']}"
expect 2 "plug-ins cannot be varied" "$program" sweep page.html -o evil
page "set: {sweep: {plugins: ['$evil']}}"
expect 2 "" "$program" sweep page.html -o evil
printf "base: tank.yaml\nplugins: ['%s']\n" "$evil" > evil.yaml
printf '<html><script type="text/yaml" id="case">\nbase: evil.yaml\n</script></html>\n' > page.html
expect 2 "is a program" "$program" check page.html
printf 'base: page.html\n' > over.yaml # a case over a page
expect 2 "is a program" "$program" check over.yaml
page "plugins: [{file: '$evil', sha256: $(sha256sum "$evil" | cut -d' ' -f1)}]"
expect 2 "is a program" "$program" check page.html
for verb in info report stats; do
    "$program" $verb page.html > log 2>&1
    trapped "$verb of a page"
done
trapped "a page"
page "plugins: ['/elsewhere/libscreen.so']"
expect 0 "" "$program" check page.html --plugin lib/libscreen.so # the user's own copy
page "plugins: ['$evil']"
expect 0 "" "$program" check page.html --allow-plugins
[ -e "$TRAP" ] || fail "--allow-plugins loads nothing"
rm -f "$TRAP"
cp -r drag stored
sed -i "s|file: .*|file: $evil|;/sha256/d" stored/case.yaml
for verb in report stats "compare stored"; do
    # shellcheck disable=SC2086
    "$program" $verb stored > log 2>&1
    trapped "$verb of a folder"
done
expect 2 "an FMU has a libmps of its own" "$program" fmu case.yaml

# ---- plug-ins that are refused, at their line
refused() { # file, text
    printf 'base: tank.yaml\nplugins: [%s]\nuse: [screen.uniform]\n' "$1" > bad.yaml
    expect 2 "bad.yaml:2:11: error: plugins: " "$program" check bad.yaml
    says "$2"
    grep -q "no model" log && fail "$1: a model of a plug-in that is refused: $(cat log)"
}
refused lib/plugin_no_function.so "has no function mps_plugin(), which <mps/plugin.h> declares"
refused lib/plugin_api.so "it has version 7 of the interface <mps/plugin.h>, and this program version 1"
refused lib/plugin_model_api.so "model interface 8"
refused lib/plugin_taken.so "model name 'gas.pocket' is taken"
refused lib/plugin_name.so "must be 'slot.variant'"
refused lib/plugin_no_begin.so "mps_plugin() must call mps_plugin_begin()"
refused lib/plugin_nothing.so "mps_plugin() registers nothing"
refused lib/plugin_return.so "mps_plugin() returned -"
refused lib/plugin_ignores.so "'other.one' is taken"
refused lib/plugin_drive.so "setting 'a' of 'drive': the default 3 is not in its range, 0 .. 1"
refused lib/plugin_undefined.so "undefined symbol: nowhere_defined"
refused lib/plugin_link.so "link it with libmps: \$(pkg-config --libs mps)"
refused nowhere.so "there is no file 'nowhere.so' in '$work/'"
refused tank.yaml "it is no shared library"
refused lib "it is a folder, no regular file"
: > empty.so
refused empty.so "it is no shared library"
head -c 3000 lib/libscreen.so > cut.so
refused cut.so "it is cut short or damaged"
mkfifo pipe.so
refused pipe.so "it is a pipe (FIFO), no regular file"
# in an ELF header the machine is at byte 18, the class at byte 4, the type at byte 16
patched() { cp lib/libscreen.so "$1"; printf "$3" | dd of="$1" bs=1 seek="$2" conv=notrunc status=none; }
patched arm.so 18 '\363\000'
refused arm.so "it is built for RISC-V, 64 bits, and this program for"
patched small.so 4 '\001'
refused small.so "32 bits"
patched object.so 16 '\001'
refused object.so "it is an object file, no shared library"
printf 'base: tank.yaml\nplugins: [lib/libscreen.so, lib/plugin_same.so]\n' > bad.yaml
expect 2 "plugin_same.so': the name 'screen.uniform' is taken by '$work/lib/libscreen.so'" "$program" check bad.yaml
printf 'base: tank.yaml\nplugins: [lib/libscreen.so, {file: lib/libscreen.so}]\n' > bad.yaml
expect 2 "is taken by" "$program" check bad.yaml
for value in "[[a]]" "{fil: x}" "{file: [x]}" "[{sha256: x}]" "''" "3" "[{file: '', sha256: 3}]" "{file: x, sha256: {a: b}}"; do
    printf 'base: tank.yaml\nplugins: %s\n' "$value" > bad.yaml
    expect 2 "bad.yaml:2:" "$program" check bad.yaml
done
expect 0 "" "$program" check tank.yaml --set "plugins=[]" -q

# ---- lists
expect 0 "screen.uniform           Uniform drag" "$program" list models --plugin lib/libscreen.so
expect 0 "screen.rate: Drag of the fluid; 0 .. 100 1/s, default 0" "$program" list settings --plugin lib/libscreen.so
expect 0 "body.load.plugin: magnet" "$program" list plugins --plugin lib/libscreen.so
says "magnet.strength: Amplitude along x; 0 .. 1000 N, default 5"
expect 0 "plugin_no_function.so: it has no function" env MPS_PLUGIN_PATH="$work/lib" "$program" list plugins
expect 2 "there is" "$program" check case.yaml --plugin nowhere.so
expect 2 "--plugin nowhere.so: it cannot be read" "$program" list models --plugin nowhere.so

# ---- two ranks: each loads the plug-in
if [ -n "$mpirun" ]; then
    "$here/../mpi/run" "$mpirun" 2 "$program" run case.yaml --mpi -q -o ranks > log 2>&1
    code=$?
    if [ $code = 0 ]; then same drag/probes.csv ranks/probes.csv; elif [ $code != 77 ]; then fail "two ranks: exit $code: $(tail -3 log)"; fi
fi
[ $failed = 0 ] && echo "plug-ins of cases: all hold"
exit $failed
