// SPDX-License-Identifier: BSD-3-Clause
// Plots over time by uPlot: one a group of curves, one cursor for all, legends that are buttons.
import { unpackCurve, unpackTimes } from "./decode.js";

const prefixed = /^(Pa|N|J|W)(?=$|[ /])/;

// Factor and prefix that make a value of this size readable.
export function prefix(most, unit) {
    if (unit === "%") return [100, ""];
    if (!(most > 1e-6)) return [1, ""];
    if ((unit === "m" || unit === "s") && most < 0.0999) return [1e3, "m"];
    if (prefixed.test(unit)) {
        if (most < 0.0999) return [1e3, "m"];
        if (most >= 999.5e3) return [1e-6, "M"];
        if (most >= 999.5) return [1e-3, "k"];
    }
    return [1, ""];
}

// Three digits, as a person rounds.
export function rounded(v) {
    if (v === null || v === undefined || !Number.isFinite(v)) return "–";
    const most = Math.abs(v);
    if (most > 0 && (most < 1e-4 || most >= 1e7)) return v.toExponential(1);
    const text = Number(v.toPrecision(3)).toString().replace("-", "−");
    return most >= 9999.5 ? Number(v.toPrecision(3)).toLocaleString("en").replace("-", "−") : text;
}

export function quantity(v, unit) {
    if (v === null || v === undefined || !Number.isFinite(v)) return "–";
    const [factor, p] = prefix(Math.abs(v), unit);
    return unit ? `${rounded(v * factor)} ${p}${unit}` : rounded(v);
}

const tokens = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const dashes = [[], [8, 3], [2, 3]];

// The axis of a force, of its name: a weight of 10 MN would flatten 50 kN along another axis.
const component = (c) => /_([xyz])$/.exec(c.name)?.[1] ?? "";

// All columns of the page, in groups that become plots.
export async function readGroups(data) {
    const groups = new Map();
    for (const table of data.tables) {
        const t = await unpackTimes(table.t, table.points);
        for (const c of table.columns) {
            const about = (c.about || "").split(":")[0], by = c.plot ?? (["value", "wall_pressure"].includes(c.type) ? `${c.unit}|${about}` : c.type === "force" ? `${c.unit}|${component(c)}` : c.unit), key = `${c.place}|${by}`;
            if (!groups.has(key)) groups.set(key, {place: c.place, title: c.plot || about || c.label, titles: new Set(), unit: c.unit, t, table, series: [], plot: !!c.plot});
            const g = groups.get(key);
            g.titles.add(about || c.label);
            g.series.push({...c, values: await unpackCurve(c.data, table.points, c.lo, c.hi)});
        }
    }
    for (const g of groups.values()) {
        if (!g.plot && g.titles.size > 1) g.title = [...g.titles].join("; ");
        if (g.title.startsWith("Energy, change")) for (const s of g.series) if (s.name === "pe") s.values = s.values.map((v) => v === null ? null : v - s.values[0]);
        addReferences(g, data.references);
    }
    return [...groups.values()].sort((a, b) => a.place === "main" && b.place === "main" ? a.plot - b.plot : 0); // sensors before the motion
}

// Known points join the times of the plot: rows of the union, null where a curve has no value.
function addReferences(g, references) {
    const mine = references.filter((r) => r.column ? g.series.some((s) => s.name === r.column) : r.unit === g.unit && g.place === "main" && !g.plot);
    if (!mine.length) return;
    const points = mine.map((r) => new Map(r.points));
    const all = [...new Set([...g.t, ...points.flatMap((p) => [...p.keys()])])].sort((a, b) => a - b);
    const from = new Map(g.t.map((t, i) => [t, i]));
    for (const s of g.series) {
        const old = s.values;
        s.values = all.map((t) => from.has(t) ? old[from.get(t)] : undefined); // undefined: uPlot draws on; null: a gap
    }
    mine.forEach((r, k) => g.series.push({name: r.label, label: r.label, unit: g.unit, about: "", reference: true, line: r.line,
        values: all.map((t) => points[k].has(t) ? points[k].get(t) : undefined)}));
    g.t = all;
}

// ---- what a reader takes along ----

function save(name, blob) {
    const a = document.createElement("a");
    a.href = URL.createObjectURL(blob);
    a.download = name;
    a.click();
    setTimeout(() => URL.revokeObjectURL(a.href), 1000);
}

const fileName = (title, end) => `${title.replace(/[^A-Za-z0-9]+/g, "_").replace(/^_+|_+$/g, "").slice(0, 60) || "data"}.${end}`;

// A dash, or numbers with a sign and their unit: no formula.
const signed = /^[-+]([\d.,]+(e[-+]?\d+)?( [-+]?[\d.,]+(e[-+]?\d+)?)*( [A-Za-z][\w/ ]*)?)?$/;

// A field of CSV; one that a spreadsheet would take for a formula is a text.
export const field = (text) => {
    const own = /^[=+\-@\t]/.test(text) && !signed.test(text) ? `'${text}` : text;
    return /[",\n]/.test(own) ? `"${own.replaceAll('"', '""')}"` : own;
};
const csv = (rows) => new Blob([rows.map((row) => row.map((v) => field(String(v))).join(",")).join("\n") + "\n"], {type: "text/csv"});

function saveButtons(list) {
    const group = document.createElement("span");
    group.className = "save";
    for (const [text, about, act] of list) {
        const b = document.createElement("button");
        b.type = "button";
        b.textContent = text;
        b.title = `Save as ${text}: ${about}`;
        b.addEventListener("click", act);
        group.append(b);
    }
    return group;
}

// In SI, as in probes.csv; of a long run the points that the page has.
function saveCurves(g) {
    const rows = [["t[s]", ...g.series.map((s) => s.unit && s.unit !== "%" ? `${s.name}[${s.unit}]` : s.name)]];
    g.t.forEach((t, i) => rows.push([t, ...g.series.map((s) => s.values[i] ?? "nan")]));
    save(fileName(g.title, "csv"), csv(rows));
}

// The plot with its title above and its legend below.
function savePicture(chart) {
    const {g, plot, head} = chart, from = plot.ctx.canvas, scale = from.width / plot.width, line = 20 * scale, out = document.createElement("canvas"), c = out.getContext("2d");
    const shown = g.series.map((s, k) => [s, k]).filter(([, k]) => !chart.hidden.has(k));
    out.width = from.width;
    out.height = from.height + line * (shown.length + 2);
    c.fillStyle = tokens("--surface");
    c.fillRect(0, 0, out.width, out.height);
    c.drawImage(from, 0, 1.5 * line);
    c.font = `${14 * scale}px system-ui, sans-serif`;
    c.fillStyle = tokens("--ink");
    c.fillText(head, 8 * scale, line);
    shown.forEach(([s, k], i) => {
        const y = from.height + line * (i + 2.2);
        c.fillStyle = chart.colour(s, k);
        c.fillRect(8 * scale, y - 6 * scale, 20 * scale, 3 * scale);
        c.fillStyle = tokens("--ink");
        c.fillText(s.label, 36 * scale, y);
    });
    out.toBlob((blob) => save(fileName(g.title, "png"), blob));
}

// What a table is about: its label, the heading before it or the summary of its part of the page.
function tableName(table) {
    const box = table.closest(".scroll") ?? table, before = table.previousElementSibling;
    const head = before?.tagName === "H3" ? before : box.closest("details")?.querySelector("summary");
    return box.getAttribute("aria-label") ?? head?.textContent ?? "table";
}

// A button for each table of the page.
export function exportTables() {
    for (const table of document.querySelectorAll("table")) {
        const box = table.closest(".scroll") ?? table, name = tableName(table);
        const rows = () => [...table.rows].map((r) => [...r.cells].map((c) => c.textContent.replaceAll("\u2212", "-").trim()));
        const buttons = saveButtons([["CSV", name, () => save(fileName(name, "csv"), csv(rows()))]]);
        if (box === table) table.before(buttons);
        else box.prepend(buttons); // a region of its own, which may be a cell of a grid
    }
}

export class Charts {
    // onTime(t): a click in a plot
    constructor(groups, skip, onTime) {
        Object.assign(this, {groups, skip, onTime, charts: [], t: null, chosen: null, range: null});
        this.sync = uPlot.sync("time");
        this.build();
    }

    build() {
        for (const c of this.charts) c.plot.destroy();
        this.charts = [];
        for (const place of document.querySelectorAll(".charts")) {
            place.replaceChildren();
            for (const g of this.groups.filter((one) => one.place === place.dataset.place)) this.charts.push(this.makeChart(g, place));
        }
        if (this.t !== null) this.setTime(this.t);
        if (this.chosen) this.choose(this.chosen, false);
    }

    makeChart(g, place) {
        const box = document.createElement("figure"), head = document.createElement("figcaption"), panel = document.createElement("div"), legend = document.createElement("div");
        const real = g.series.filter((s) => !s.reference), start = this.skip;
        const known = real.flatMap((s) => s.values.filter((v, i) => v !== null && v !== undefined && g.t[i] >= start));
        const most = known.reduce((m, v) => Math.max(m, Math.abs(v)), 0), [factor, p] = prefix(most, g.unit);
        box.className = "chart";
        legend.className = "legend";
        legend.setAttribute("role", "group");
        legend.setAttribute("aria-label", `Curves of: ${g.title}`);
        head.textContent = g.unit ? `${g.title} [${p}${g.unit}]` : g.title;
        const impulse = real.reduce((m, s) => s.values.reduce((n, v, i) => g.t[i] < start && Math.abs(v) > n ? Math.abs(v) : n, m), 0);
        if (impulse > 1.5 * most && most > 0) {
            const note = document.createElement("span");
            note.className = "hint";
            note.textContent = ` Not in full: the impulse of the start, up to ${quantity(impulse, g.unit)}.`;
            head.append(note);
        }
        for (const s of g.place === "forces" ? real : []) this.tellMean(head, s, g, start);
        panel.setAttribute("role", "img");
        panel.setAttribute("aria-label", `${g.title}: ` + real.map((s) => {
            let high = -Infinity, at = 0;
            s.values.forEach((v, i) => { if (v > high && g.t[i] >= start) [high, at] = [v, g.t[i]]; });
            return Number.isFinite(high) ? `${s.label} at most ${quantity(high, g.unit)} at ${quantity(at, "s")}` : s.label;
        }).join("; "));
        box.append(head, panel, legend);
        place.append(box);
        head.append(saveButtons([["CSV", "table of the curves", () => saveCurves(g)], ["PNG", "picture of the plot", () => savePicture(chart)]]));
        const chart = {g, box, panel, legend, factor, p, most, hidden: new Set(), head: head.firstChild.textContent, colour: (s, k) => this.colour(g, s, k)};
        chart.plot = new uPlot(this.options(chart), [g.t, ...g.series.map((s) => s.values)], panel);
        chart.line = document.createElement("div");
        chart.line.className = "now";
        chart.plot.over.append(chart.line);
        this.placeTime(chart);
        chart.buttons = g.series.map((s, k) => this.legendButton(chart, s, k));
        new ResizeObserver(() => {
            const width = panel.clientWidth;
            if (width > 50 && Math.abs(width - chart.plot.width) > 1) chart.plot.setSize({width, height: chart.plot.height});
        }).observe(panel);
        return chart;
    }

    // The axis of a plot follows its curves and may be far from 0: then the caption has the mean.
    tellMean(head, s, g, start) {
        const known = s.values.filter((v, i) => v !== null && v !== undefined && g.t[i] >= start), n = known.length;
        const mean = known.reduce((m, v) => m + v / n, 0), reach = known.reduce((m, v) => Math.max(m, Math.abs(v - mean)), 0);
        if (!n || Math.abs(mean) < reach) return;
        const note = document.createElement("span");
        note.className = "hint mean";
        note.textContent = ` Mean of ${s.label}: ${quantity(mean, g.unit)}.`;
        head.append(note);
    }

    options(chart) {
        const {g, factor, panel} = chart, ink = tokens("--ink-2"), grid = tokens("--line"), axis = {stroke: ink, grid: {stroke: grid, width: 1}, ticks: {stroke: grid, width: 1}, font: "12px system-ui, sans-serif"};
        return {
            width: Math.max(200, panel.clientWidth), height: 204, legend: {show: false}, padding: [8, 12, 0, 0],
            cursor: {sync: {key: "time", setSeries: false}, drag: {x: true, y: false}, points: {size: 7}, bind: {dblclick: () => () => { this.setRange(null); return null; }}},
            scales: {x: {time: false}, y: {range: (u, lo, hi) => this.yRange(u, chart)}},
            series: [{}, ...g.series.map((s, k) => ({
                label: s.label, stroke: this.colour(g, s, k), width: 1.6, dash: dashes[Math.floor(k / 8) % 3], spanGaps: false,
                points: s.reference && !s.line ? {show: true, size: 8, width: 1.6, fill: tokens("--surface")} : {show: false},
                paths: s.reference && !s.line ? () => null : undefined,
            }))],
            axes: [{...axis, values: (u, at) => at.map((v) => rounded(v)), label: "t [s]", labelSize: 18, labelGap: 0, labelFont: axis.font, size: 28},
                {...axis, size: 58, values: (u, at) => at.map((v) => rounded(Number((v * factor).toPrecision(10))))}],
            hooks: {
                setScale: [() => this.placeTime(chart)],
                setSize: [() => this.placeTime(chart)],
                setCursor: [(u) => this.readOut(chart, u.cursor.idx)],
                setSelect: [(u) => {
                    if (u.select.width > 4) this.setRange([u.posToVal(u.select.left, "x"), u.posToVal(u.select.left + u.select.width, "x")]);
                    u.setSelect({left: 0, width: 0, top: 0, height: 0}, false);
                }],
                ready: [(u) => {
                    let from = null;
                    u.over.addEventListener("mousedown", (e) => { from = e.clientX; });
                    u.over.addEventListener("click", (e) => { if (from !== null && Math.abs(e.clientX - from) < 4) this.onTime(u.posToVal(e.offsetX, "x")); });
                }],
            },
        };
    }

    colour(g, s, k) {
        return s.reference ? tokens("--ink") : tokens(`--series-${k % 8}`);
    }

    // The whole run without the impulse of its first half per cent, and what is hidden left out.
    yRange(u, chart) {
        const {g} = chart, [from, to] = this.range ?? [g.t[0] + (this.range ? 0 : this.skip), g.t.at(-1)];
        let lo = Infinity, hi = -Infinity;
        g.series.forEach((s, k) => {
            if (u.series[k + 1] && !u.series[k + 1].show) return;
            for (let i = 0; i < g.t.length; i++) {
                const v = s.values[i];
                if (v === null || v === undefined || g.t[i] < from || g.t[i] > to) continue;
                if (v < lo) lo = v;
                if (v > hi) hi = v;
            }
        });
        if (!(hi >= lo)) return [0, 1];
        const margin = (hi - lo || Math.abs(hi) || 1) * 0.06;
        return [lo - (lo === 0 ? 0 : margin), hi + margin];
    }

    legendButton(chart, s, k) {
        const b = document.createElement("button"), swatch = document.createElement("i"), name = document.createElement("span"), value = document.createElement("output");
        b.type = "button";
        b.dataset.series = s.name;
        b.title = s.about || s.label;
        b.setAttribute("aria-pressed", "true");
        swatch.style.borderTopColor = this.colour(chart.g, s, k);
        if (s.reference && !s.line) swatch.className = "ring";
        else if (k >= 8) swatch.style.borderTopStyle = k >= 16 ? "dotted" : "dashed";
        name.textContent = s.label;
        value.setAttribute("aria-live", "off");
        b.append(swatch, name, value);
        b.addEventListener("click", () => {
            const show = chart.hidden.has(k);
            chart.hidden[show ? "delete" : "add"](k);
            b.setAttribute("aria-pressed", String(show));
            chart.plot.setSeries(k + 1, {show});
        });
        chart.legend.append(b);
        return b;
    }

    // Values below the cursor, or at the time of the film.
    readOut(chart, index) {
        const {g} = chart;
        if (index === null || index === undefined) index = this.t === null ? null : nearest(g.t, this.t);
        chart.buttons?.forEach((b, k) => {
            const v = index === null ? null : g.series[k].values[index];
            b.lastChild.textContent = v === null || v === undefined ? "" : rounded(Math.abs(v) < 5e-4 * chart.most ? 0 : v * chart.factor);
        });
    }

    // The line of the film's time.
    placeTime(chart) {
        const {plot, line} = chart;
        if (!plot || !line) return;
        const x = this.t === null ? -1 : plot.valToPos(this.t, "x"), width = plot.over.clientWidth;
        line.hidden = !(x >= 0 && x <= width);
        line.style.transform = `translateX(${x}px)`;
    }

    setTime(t) {
        this.t = t;
        for (const c of this.charts) {
            if (!c.box.offsetParent) continue; // in a closed part of the page
            this.placeTime(c);
            if (c.plot.cursor.idx === null || c.plot.cursor.idx === undefined) this.readOut(c, null);
        }
    }

    setRange(range) {
        this.range = range;
        for (const c of this.charts) c.plot.setScale("x", range ? {min: range[0], max: range[1]} : {min: c.g.t[0], max: c.g.t.at(-1)});
    }

    // Show one column before all others of its plot; null: all alike.
    choose(name, scroll = true) {
        this.chosen = name;
        for (const c of this.charts) {
            const k = c.g.series.findIndex((s) => s.name === name);
            c.g.series.forEach((s, i) => {
                const series = c.plot.series[i + 1];
                series.width = (k === i ? 2.8 : 1.6);
                series.alpha = k >= 0 && k !== i ? 0.25 : 1;
                c.buttons[i].classList.toggle("chosen", k === i);
            });
            if (k >= 0 && c.hidden.has(k)) c.buttons[k].click();
            c.plot.redraw();
            if (k >= 0 && scroll) {
                c.box.scrollIntoView({block: "nearest", behavior: "smooth"});
                c.buttons[k].focus({preventScroll: true});
            }
        }
    }
}

// Index of the time nearest to t in increasing times.
export function nearest(times, t) {
    let lo = 0, hi = times.length - 1;
    while (hi - lo > 1) {
        const middle = (lo + hi) >> 1;
        if (times[middle] <= t) lo = middle;
        else hi = middle;
    }
    return t - times[lo] <= times[hi] - t ? lo : hi;
}
