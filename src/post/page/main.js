// SPDX-License-Identifier: BSD-3-Clause
// Puts the page together: film, curves, sketch, one time for all.
import { Frames, fromBase64, inflate } from "./decode.js";
import { Charts, exportTables, nearest, prefix, quantity, readGroups, rounded } from "./curves.js";
import { View, kinds, pockets } from "./view.js";

const byId = (id) => document.getElementById(id), json = (id) => JSON.parse(byId(id)?.textContent ?? "null");
const state = {charts: null, view: null, frame: 0, playing: false, picked: -1, data: json("film-data"), pace: 1};

// ---- dark and light ----

function isDark() {
    const own = document.documentElement.dataset.theme;
    return own ? own === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

function applyTheme() {
    byId("theme").textContent = isDark() ? "Light" : "Dark"; // what it changes to
    const hex = getComputedStyle(document.documentElement).getPropertyValue("--stage").trim();
    if (state.view) {
        state.view.background = [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255);
        state.view.draw();
    }
    state.charts?.build();
}

byId("theme").addEventListener("click", () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    applyTheme();
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", applyTheme);
applyTheme(); // the page may have no film

// ---- time ----

function setFrame(frame, fromCurves = false) {
    const {data, view} = state;
    if (!view) return;
    state.frame = Math.max(0, Math.min(frame, view.frames.ready - 1));
    view.show(state.frame);
    const t = data.t[state.frame], slider = byId("time");
    slider.value = state.frame;
    slider.setAttribute("aria-valuetext", quantity(t, "s"));
    byId("now").textContent = `${t.toFixed(timePlaces)} s`;
    if (!fromCurves) state.charts?.setTime(t);
}

function setTime(t) {
    if (state.view) setFrame(nearest(state.data.t, t), true);
    state.charts.setTime(t);
}

function setPlaying(on) {
    state.playing = on && !!state.view;
    byId("play").textContent = state.playing ? "Pause" : "Play";
    if (!state.playing) return;
    const {t} = state.data;
    if (state.frame === t.length - 1) setFrame(0);
    let from = t[state.frame], begun = null;
    const step = (now) => {
        if (!state.playing) return;
        begun ??= now;
        const time = from + (now - begun) / 1000 * state.pace;
        let k = state.frame;
        while (k + 1 < state.view.frames.ready && t[k + 1] <= time) k++;
        if (k !== state.frame) setFrame(k);
        if (k === t.length - 1) setPlaying(false);
        else if (k === state.view.frames.ready - 1) [from, begun] = [t[k], now]; // wait for the next block
        requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
}

// ---- the film ----

const timePlaces = state.data ? Math.max(0, Math.min(5, Math.ceil(-Math.log10((state.data.t.at(-1) || 1) / state.data.t.length)))) : 2;

function fillPaces() {
    const select = byId("pace"), all = state.data.t.at(-1) - state.data.t[0] || 1;
    const paces = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100].filter((p) => all / p > 1.5 && all / p < 300);
    const usual = paces.reduce((best, p) => Math.abs(Math.log(all / p / 9)) < Math.abs(Math.log(all / best / 9)) ? p : best, paces[0] ?? 1);
    for (const p of paces.length ? paces : [1]) {
        const name = p === 1 ? "real time" : p < 1 ? `1/${Math.round(1 / p)} of real time` : `${p} x real time`;
        select.add(new Option(name, p, p === usual, p === usual));
    }
    state.pace = Number(select.value);
    select.addEventListener("change", () => {
        const playing = state.playing;
        state.pace = Number(select.value);
        setPlaying(false);
        setPlaying(playing);
    });
}

// Of a tank that moves the speed has a frame.
const speedIn = () => state.data.speed_in ? ` in ${state.data.speed_in}` : "";

function drawScale() {
    const {data, view} = state, mode = byId("colour").value, panel = byId("scale"), maps = mode === "speed" ? 1 : Math.min(3, data.phases);
    const css = (c) => `rgb(${c.map((v) => Math.round(255 * v)).join(" ")})`;
    panel.replaceChildren();
    if (mode === "phase") {
        for (let k = 0; k < data.phases; k++) {
            const chip = document.createElement("span"), name = state.phases?.[k]?.name;
            chip.className = "chip";
            chip.style.setProperty("--chip", css(kinds[Math.min(k, 3)]));
            chip.textContent = name ?? (k === 0 ? "liquid (phase 0)" : `phase ${k}`);
            panel.append(chip);
        }
        return;
    }
    if (mode === "pocket") {
        for (let c = 0; c < Math.min(5, data.pockets + 1); c++) { // colours in turn, by number
            const chip = document.createElement("span"), numbers = [];
            for (let n = c; c > 0 && n <= data.pockets && numbers.length < 3; n += 4) numbers.push(n);
            chip.className = "chip";
            chip.style.setProperty("--chip", css(c ? pockets[c - 1] : kinds[0]));
            chip.textContent = c ? `pocket ${numbers.join(", ")}${data.pockets >= c + 12 ? " .." : ""}` : "beside no pocket";
            panel.append(chip);
        }
        view.canvas.setAttribute("aria-label", `Film of ${data.count} particles, coloured by the pocket of gas beside them`);
        return;
    }
    const s = data[mode], unit = mode === "speed" ? "m/s" : "Pa", label = document.createElement("b"), bars = document.createElement("div");
    const [factor, p] = prefix(Math.max(Math.abs(s.lo), s.hi), unit);
    label.textContent = `${mode}${mode === "speed" ? speedIn() : ""} [${p}${unit}]`;
    bars.className = "bars";
    for (let m = 0; m < maps; m++) {
        const bar = document.createElement("i");
        bar.style.background = `linear-gradient(90deg, ${data.maps[m].map(css).join(",")})`;
        bars.append(bar);
    }
    const ticks = document.createElement("div");
    ticks.className = "ticks";
    for (let k = 0; k <= 4; k++) {
        const tick = document.createElement("span");
        tick.textContent = (k === 4 && s.most > s.hi * 1.001 ? "≥ " : "") + rounded((s.lo + (s.hi - s.lo) * k / 4) * factor);
        ticks.append(tick);
    }
    bars.append(ticks);
    panel.append(label, bars);
    view.canvas.setAttribute("aria-label", `Film of ${data.count} particles, coloured by ${mode}`);
}

// A value from its byte, as page_scale.c packs it.
function decodeValue(code, s) {
    const share = (code - 224) / 31;
    return code <= 224 ? s.lo + (s.hi - s.lo) * (code - 1) / 223 : s.hi + (s.most - s.hi) * share * share;
}

// An element of SVG. Texts are set as texts, never as markup.
function element(name, attributes, text = "") {
    const e = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
    e.textContent = text;
    return e;
}

// Axes of the tank at its lower corner and the bow, in 3-D: a view alone does not show which side is which.
function axisMarks(at) {
    const {lo, hi} = state.view.box, out = [], size = 0.16 * Math.max(...lo.map((v, d) => hi[d] - v));
    const arrow = (from, way, length, text, kind) => {
        const a = at(from), b = at(from.map((v, d) => v + length * way[d]));
        if (!a || !b) return;
        out.push(element("line", {class: `axis ${kind}`, x1: a[0], y1: a[1], x2: b[0], y2: b[1]}));
        const far = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
        out.push(element("text", {class: `axis ${kind}`, x: b[0] + 10 * (b[0] - a[0]) / far, y: b[1] + 10 * (b[1] - a[1]) / far + 4}, text));
    };
    ["x", "y", "z"].forEach((text, k) => arrow(lo, [0, 1, 2].map((d) => Number(d === k)), size, text, "own"));
    if (state.data.bow) {
        const middle = lo.map((v, d) => (v + hi[d]) / 2 + state.data.bow[d] * (hi[d] - v) / 2);
        middle[1] = hi[1];
        arrow(middle, state.data.bow, size, "bow", "bow");
    }
    return out;
}

// Mark and name of a sensor.
function sensorMarks(c, p) {
    const chosen = state.charts?.chosen === c.name ? " chosen" : "", left = p[0] > byId("screen").clientWidth - 60;
    return [element("circle", {class: `probe${chosen}`, "data-column": c.name, cx: p[0], cy: p[1], r: 5}),
        element("text", {class: `name${chosen}`, "data-column": c.name, x: p[0] + (left ? -9 : 9), y: p[1] + 4, "text-anchor": left ? "end" : "start"}, c.name)];
}

// Ring about the particle that is followed, and marks of the sensors.
function drawMarks() {
    const {view, data} = state, svg = byId("marks"), scale = devicePixelRatio || 1, out = [];
    const at = (X) => { const p = view.project(X); return p ? [p[0] / scale, p[1] / scale] : null; };
    if (data.dim === 3) out.push(...axisMarks(at));
    if (byId("marks-on").checked) {
        for (const c of state.sensors) {
            const p = at([c.at[0], c.at[1], data.dim === 3 ? c.at[2] : 0]);
            if (p) out.push(...sensorMarks(c, p));
        }
    }
    if (state.picked >= 0) {
        const X = view.place(state.picked), p = view.present(state.picked) ? at(X) : null, {value, values} = view.frames, k = view.frame * values * data.count + state.picked;
        if (p) out.push(element("circle", {class: "ring", cx: p[0], cy: p[1], r: 9}));
        const beside = values > 2 && value[k + 2 * data.count] > 0 ? `, beside pocket ${value[k + 2 * data.count]}` : "";
        const name = state.phase[state.picked] === 255 ? "Part of a body" : `Particle ${state.ids[state.picked]}`;
        const less = value[k] === 1 ? " or less" : ""; // suction in liquid or gas is below the scale
        byId("picked").textContent = p ? `${name}: speed${speedIn()} ${quantity(decodeValue(value[k + data.count], data.speed), "m/s")}, pressure ${quantity(decodeValue(value[k], data.pressure), "Pa")}${less}${beside}, at (${X.slice(0, data.dim).map(rounded).join(", ")}) m in the tank. Escape ends this.` : `${name} is not in this frame.`;
    } else byId("picked").textContent = "";
    svg.setAttribute("viewBox", `0 0 ${view.canvas.width / scale} ${view.canvas.height / scale}`); // on paper it has another size
    svg.replaceChildren(...out);
}

function fitCanvas() {
    const {view} = state, screen = byId("screen"), [w, h] = view.shape(), width = screen.clientWidth;
    if (width === 0) return; // not laid out
    const height = Math.round(Math.max(160, Math.min(width * h / w, innerHeight * 0.68))), scale = devicePixelRatio || 1;
    if (screen.style.height !== `${height}px`) screen.style.height = `${height}px`;
    const size = [Math.round(width * scale), Math.round(height * scale)];
    if (view.canvas.width !== size[0] || view.canvas.height !== size[1]) [view.canvas.width, view.canvas.height] = size;
    view.draw();
}

function bindPointer() {
    const {view} = state, {canvas} = view, pointers = new Map();
    let moved = 0, apart = 0;
    const scale = () => canvas.width / canvas.clientWidth;
    canvas.addEventListener("pointerdown", (e) => {
        pointers.set(e.pointerId, [e.offsetX, e.offsetY]);
        canvas.setPointerCapture(e.pointerId);
        moved = 0;
    });
    canvas.addEventListener("pointermove", (e) => {
        const last = pointers.get(e.pointerId);
        if (!last) return;
        const dx = e.offsetX - last[0], dy = e.offsetY - last[1];
        pointers.set(e.pointerId, [e.offsetX, e.offsetY]);
        moved += Math.abs(dx) + Math.abs(dy);
        if (pointers.size === 2) { // two fingers
            const [a, b] = [...pointers.values()], now = Math.hypot(a[0] - b[0], a[1] - b[1]);
            if (apart) view.zoomBy(now / apart, (a[0] + b[0]) / 2 * scale(), (a[1] + b[1]) / 2 * scale());
            apart = now;
        } else if (moved > 4) view.drag(dx * scale(), dy * scale(), e.shiftKey);
    });
    const end = (e) => {
        if (pointers.delete(e.pointerId) && moved <= 4 && e.type === "pointerup") {
            state.picked = view.pick(e.offsetX * scale(), e.offsetY * scale());
            drawMarks();
        }
        apart = 0;
    };
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    canvas.addEventListener("wheel", (e) => {
        if (!e.ctrlKey && !e.metaKey) return;
        e.preventDefault();
        view.zoomBy(Math.exp(-e.deltaY / 300), e.offsetX * scale(), e.offsetY * scale());
    }, {passive: false});
}

function reset() {
    state.view.whole();
    state.view.draw();
}

function bindKeys() {
    const {view} = state, turns = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
    const keys = {" ": () => setPlaying(!state.playing), ",": () => setFrame(state.frame - 1), ".": () => setFrame(state.frame + 1), "+": () => view.zoomBy(1.3), "=": () => view.zoomBy(1.3),
        "-": () => view.zoomBy(1 / 1.3), 0: reset, Escape: () => { state.picked = -1; choose(null); drawMarks(); }};
    document.addEventListener("keydown", (e) => {
        const target = e.target, typing = ["SELECT", "TEXTAREA"].includes(target.tagName) || (target.tagName === "INPUT" && target.type !== "range");
        if (e.ctrlKey || e.metaKey || e.altKey || typing) return;
        if (e.key === " " && (["BUTTON", "SUMMARY", "A"].includes(target.tagName) || target.getAttribute("role") === "button")) return;
        if (target === view.canvas && turns[e.key]) view.drag(turns[e.key][0] * 30, turns[e.key][1] * 30, e.shiftKey);
        else if (keys[e.key]) keys[e.key]();
        else return;
        e.preventDefault();
    });
}

function bindControls() {
    const {view} = state, on = (id, type, act) => byId(id).addEventListener(type, act);
    on("play", "click", () => setPlaying(!state.playing));
    on("back", "click", () => { setPlaying(false); setFrame(state.frame - 1); });
    on("on", "click", () => { setPlaying(false); setFrame(state.frame + 1); });
    on("time", "input", (e) => { setPlaying(false); setFrame(Number(e.target.value)); });
    on("colour", "change", (e) => {
        view.mode = ["pressure", "speed", "phase", "pocket"].indexOf(e.target.value);
        drawScale();
        view.draw();
    });
    on("seen", "change", (e) => { view.seen = e.target.value; reset(); });
    on("walls-on", "change", (e) => { view.showWalls = e.target.checked; view.draw(); });
    on("marks-on", "change", drawMarks);
    on("closer", "click", () => view.zoomBy(1.3));
    on("farther", "click", () => view.zoomBy(1 / 1.3));
    on("whole", "click", reset);
    on("marks", "click", (e) => { if (e.target.dataset.column) choose(e.target.dataset.column); });
}

// The frames of one element.
async function unpack(element, frames) {
    frames.add(await inflate(fromBase64(element.textContent)));
    element.textContent = "";
}

async function openFilm() {
    const {data} = state, walls = json("walls"), wallFrames = new Frames(walls.count, data.dim, walls.bits, 1), frames = new Frames(data.count, data.dim, data.bits, data.frames, data.pockets > 0 ? 3 : 2);
    const blocks = [...document.querySelectorAll(".film-block")], raw = await inflate(fromBase64(document.querySelector(".film-ids").textContent));
    state.ids = new Uint32Array(new Uint8Array(raw.subarray(0, 4 * data.count)).buffer);
    state.phase = raw.subarray(4 * data.count);
    await unpack(document.querySelector(".film-walls"), wallFrames);
    await unpack(blocks.shift(), frames);
    const lo = [...data.lo], hi = [...data.hi];
    for (let d = 0; d < data.dim; d++) { // the tank, or what moves where that is larger
        let least = Infinity, most = -Infinity;
        for (let i = 0; i < walls.count; i++) {
            const v = walls.lo[d] + walls.quantum * wallFrames.place[d * walls.count + i];
            least = Math.min(least, v);
            most = Math.max(most, v);
        }
        if (most > least) [lo[d], hi[d]] = [least, most];
    }
    try {
        state.view = new View(byId("canvas"), data, walls, frames, wallFrames, state.phase, {lo, hi});
    } catch (error) {
        byId("waiting").textContent = `There is no film: ${error.message}`;
        return;
    }
    if (!data.poses.length) byId("frame-choice").hidden = true;
    byId("time").max = data.frames - 1;
    state.view.after = drawMarks;
    if (data.pockets > 0) byId("colour").add(new Option("pocket of gas", "pocket"));
    fillPaces();
    bindPointer();
    bindKeys();
    bindControls();
    drawScale();
    setFrame(0);
    applyTheme();
    new ResizeObserver(fitCanvas).observe(byId("screen"));
    fitCanvas();
    byId("waiting").remove();
    document.documentElement.dataset.film = "first";
    for (const block of blocks) await unpack(block, frames);
    document.documentElement.dataset.film = "all";
}

// ---- curves ----

function choose(name) {
    state.charts?.choose(name);
    for (const g of document.querySelectorAll(".sensor")) g.classList.toggle("chosen", g.dataset.column === name);
    if (state.view) drawMarks();
}

function bindSketch() {
    for (const g of document.querySelectorAll(".sensor")) {
        const act = () => choose(g.dataset.column);
        g.addEventListener("click", act);
        g.addEventListener("keydown", (e) => {
            if (e.key !== "Enter" && e.key !== " ") return;
            e.preventDefault();
            act();
        });
    }
}

async function openCurves() {
    const data = json("curve-data"), groups = await readGroups(data);
    state.sensors = data.tables.flatMap((t) => t.columns).filter((c) => c.at && !["gauge", "force", "moment"].includes(c.type)); // as pictures have them
    state.charts = new Charts(groups, data.skip, setTime);
    byId("all-time").addEventListener("click", () => state.charts.setRange(null));
    for (const d of document.querySelectorAll("details")) d.addEventListener("toggle", () => state.charts.setTime(state.charts.t));
    for (const b of document.querySelectorAll(".moment")) b.addEventListener("click", () => setTime(Number(b.dataset.time)));
    bindSketch();
    exportTables();
    document.documentElement.dataset.curves = "all";
}

state.sensors = [];
const film = state.data ? openFilm() : Promise.resolve();
await openCurves();
if (state.view) {
    state.charts.setTime(state.data.t[state.frame]);
    drawMarks(); // the film was drawn before the sensors were known
}
await film;
