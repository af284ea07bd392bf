// SPDX-License-Identifier: BSD-3-Clause
// Scripts of a page without a browser: columns to plots, numbers to texts, and packed curves, which
// must be restored.
// usage: node scripts.mjs PAGE_FOLDER REPORT_HTML
import assert from "node:assert/strict";
import { readFileSync, writeFileSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const [,, source, report] = process.argv, own = mkdtempSync(join(tmpdir(), "mps_page_"));
for (const name of ["decode", "curves"]) writeFileSync(join(own, `${name}.mjs`), readFileSync(join(source, `${name}.js`), "utf8").replace("./decode.js", "./decode.mjs"));
const { nearest, prefix, quantity, readGroups, rounded, field } = await import(join(own, "curves.mjs"));

assert.equal(quantity(3590, "Pa"), "3.59 kPa");
assert.equal(quantity(-0.0123, "m"), "−12.3 mm");
assert.equal(rounded(12345), "12,300");
assert.equal(rounded(NaN), "–");
assert.deepEqual(prefix(2e6, "N"), [1e-6, "M"]);
assert.deepEqual([0, 1, 1.4, 1.6, 9].map((t) => nearest([0, 1, 2, 3], t)), [0, 1, 1, 2, 3]);
const fields = [["P1[Pa]"], ["a,b", '"a,b"'], ['"x"', '"""x"""'], ["-"], ["-3.5"], ["-3.5e-7"],
    ["-0.1 m"], ["-1.0e-5 m/s2"], ["-12,300 N m", '"-12,300 N m"'], ["-0.1, -2 m", '"-0.1, -2 m"'],
    ["=1+1", "'=1+1"], ["@x", "'@x"], ["+1+1", "'+1+1"], ["-1-A1", "'-1-A1"],
    ["-1 cmd|' /C x'!A0", "'-1 cmd|' /C x'!A0"], ["-sum(A1)", "'-sum(A1)"], ["-3 m=1", "'-3 m=1"]];
for (const [text, wanted] of fields) assert.equal(field(text), wanted ?? text);

// The data elements of a page that C has written.
const page = readFileSync(report, "utf8");
const data = JSON.parse(/<script type="application\/json" id="curve-data">(.*?)<\/script>/s.exec(page)[1]);
const groups = await readGroups(data);
const group = (name) => groups.filter((g) => g.series.some((s) => s.name === name));
for (const t of data.tables) for (const c of t.columns) assert.equal(group(c.name).length, 1, c.name); // each in one plot
assert.equal(group("P1")[0].unit, "Pa");
assert.deepEqual(group("eta")[0].series.map((s) => s.label), ["eta", "measured"]);
const eta = group("eta")[0], at = eta.t.indexOf(1.005);
assert.equal(eta.series[1].values[at], -0.03);
const k = eta.t.indexOf(eta.t.find((t) => t > 0.7 && t < 0.8));
assert.ok(Math.abs(eta.series[0].values[k] - 0.1 * Math.sin(6 * eta.t[k])) < 1e-5);

// Degrees of freedom of a ship give a plot of displacements and one of rotations, for any texts.
const own_columns = data.tables[0].columns.slice(0, 1).map((c) => c.data)[0];
const ship = {tables: [{...data.tables[0], columns: ["surge", "heave", "roll", "pitch"].map((name, i) => ({name, label: name, unit: i < 2 ? "m" : "deg", type: "value", about: `${name} of it`,
    place: "main", plot: i < 2 ? "Motion of the tank: shifts" : "Motion of the tank: turns", lo: 0, hi: 1, data: own_columns}))}], references: []};
assert.deepEqual((await readGroups(ship)).map((g) => [g.title, g.unit, g.series.length]), [["Motion of the tank: shifts", "m", 2], ["Motion of the tank: turns", "deg", 2]]);
console.log("scripts of the page: good");
