// SPDX-License-Identifier: BSD-3-Clause
// A page in a browser: every control works, the canvas is the picture drawn by C, axe reports no
// errors.
// usage: node test.mjs FOLDER CHROMIUM
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";

const [,, folder, executablePath] = process.argv, axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"] });
let done = 0;

async function open(name, options = {}) {
    const page = await browser.newPage({ viewport: { width: 1440, height: 1000 }, colorScheme: "light", bypassCSP: true, ...options });
    page.problems = [];
    page.on("console", (m) => { if (["error", "warning"].includes(m.type()) && !/GPU stall|GL Driver/.test(m.text())) page.problems.push(m.text()); });
    page.on("pageerror", (e) => page.problems.push(e.stack));
    page.on("request", (r) => { if (!/^(file|data|blob):/.test(r.url())) page.problems.push(`asks for ${r.url()}`); });
    await page.addInitScript(() => { // what is written on canvases, in their pixels
        const own = CanvasRenderingContext2D.prototype.fillText;
        window.written = [];
        CanvasRenderingContext2D.prototype.fillText = function (said, x, y, ...more) {
            const at = this.getTransform().transformPoint({ x, y });
            window.written.push({ canvas: this.canvas, said, x: at.x, y: at.y });
            return own.call(this, said, x, y, ...more);
        };
    });
    await page.goto(`file://${folder}/${name}/report.html`);
    await page.waitForFunction(() => {
        const { film, curves } = document.documentElement.dataset;
        return curves === "all" && (film === "all" || !document.getElementById("film-data"));
    }, null, { timeout: 60000 });
    return page;
}

async function test(name, page, act) {
    await act(page);
    assert.deepEqual(page.problems, [], name);
    console.log(`ok ${++done} ${name}`);
}

const text = (page, selector) => page.locator(selector).innerText();
const frame = (page) => page.locator("#time").inputValue().then(Number);
const setFrame = (page, k) => page.locator("#time").evaluate((e, v) => { e.value = v; e.dispatchEvent(new Event("input")); }, k);
// Pixels of the canvas as it is now, three bytes each, from the top.
const pixels = async (page) => {
    const {width, height, text: packed} = await page.evaluate(() => {
        const c = document.getElementById("canvas"), copy = document.createElement("canvas"), pen = copy.getContext("2d");
        [copy.width, copy.height] = [c.width, c.height];
        pen.drawImage(c, 0, 0);
        const {data} = pen.getImageData(0, 0, c.width, c.height), parts = [];
        for (let i = 0; i < data.length; i += 32768) parts.push(String.fromCharCode(...data.subarray(i, i + 32768)));
        return { width: c.width, height: c.height, text: btoa(parts.join("")) };
    });
    return { width, height, data: Buffer.from(packed, "base64").filter((v, i) => i % 4 < 3) };
};
const differ = (a, b) => a.data.length !== b.data.length || a.data.some((v, i) => Math.abs(v - b.data[i]) > 2);

const flat = await open("flat");

await test("sensors are marked at once", flat, async (p) => {
    await p.waitForFunction(() => document.documentElement.dataset.curves === "all");
    await p.waitForFunction(() => document.querySelectorAll("#marks .probe").length === 1, null, { timeout: 3000 });
});

await test("the canvas is the picture that C draws of the frame", flat, async (p) => {
    await p.evaluate(() => { document.getElementById("screen").style.width = "720px"; });
    await p.waitForFunction(() => document.getElementById("canvas").width === 720);
    await setFrame(p, 4);
    // 720 of 2.3 m, 1.3 m
    assert.equal(await p.evaluate(() => document.getElementById("canvas").height), 407);
    const wanted = readFileSync(`${folder}/flat.rgb`), have = await pixels(p);
    let sum = 0, far = 0, inked = 0;
    for (let i = 0; i < wanted.length; i++) {
        const d = Math.abs(wanted[i] - have.data[i]);
        sum += d;
        far += d > 40;
        inked += wanted[i] < 250;
    }
    console.log(`   mean difference ${(sum / inked).toFixed(2)} of 255 on what is drawn, ${(100 * far / inked).toFixed(2)} % above 40`);
    assert.ok(inked > 0.1 * wanted.length, "the picture is blank");
    assert.ok(sum / inked < 3 && far / inked < 0.02, "differs by more than antialiasing");
    await p.reload();
    await p.waitForFunction(() => document.documentElement.dataset.film === "all" && document.documentElement.dataset.curves === "all");
});

await test("play, pause, steps, slider", flat, async (p) => {
    await p.selectOption("#pace", { index: 0 });
    const paces = await p.locator("#pace option").count();
    await p.selectOption("#pace", { index: paces - 1 });
    await p.click("#play");
    assert.equal(await text(p, "#play"), "Pause");
    await p.waitForFunction(() => Number(document.getElementById("time").value) > 2);
    await p.click("#play");
    assert.equal(await text(p, "#play"), "Play");
    const k = await frame(p);
    await p.click("#on");
    assert.equal(await frame(p), k + 1);
    await p.click("#back");
    assert.equal(await frame(p), k);
    await setFrame(p, 11);
    assert.match(await text(p, "#now"), /^11(\.0+)? s$/);
    assert.equal(await p.locator("#time").getAttribute("aria-valuetext"), "11 s");
    await setFrame(p, 29);
    await p.click("#play"); // from the end it begins again
    await p.waitForFunction(() => Number(document.getElementById("time").value) < 29);
    await p.waitForFunction(() => document.getElementById("play").textContent === "Play", null, { timeout: 20000 });
    assert.equal(await frame(p), 29);
});

await test("keys", flat, async (p) => {
    await setFrame(p, 5);
    await p.locator("#canvas").focus();
    await p.keyboard.press(".");
    assert.equal(await frame(p), 6);
    await p.keyboard.press(",");
    assert.equal(await frame(p), 5);
    const before = await pixels(p);
    for (const key of ["+", "ArrowLeft", "ArrowUp"]) {
        const last = await pixels(p);
        await p.keyboard.press(key);
        assert.ok(differ(last, await pixels(p)), key);
    }
    await p.keyboard.press("0");
    assert.ok(!differ(before, await pixels(p)), "0 shows all");
    await p.keyboard.press(" ");
    assert.equal(await text(p, "#play"), "Pause");
    await p.keyboard.press(" ");
    assert.equal(await text(p, "#play"), "Play");
});

await test("colour, view, walls, zoom", flat, async (p) => {
    await setFrame(p, 8);
    const first = await pixels(p);
    for (const mode of ["speed", "phase", "pressure"]) {
        const last = await pixels(p);
        await p.selectOption("#colour", mode);
        assert.ok(differ(last, await pixels(p)), mode);
        assert.match(await text(p, "#scale"), mode === "phase" ? /phase 0/ : new RegExp(`^${mode}.* \\[`));
    }
    assert.ok(!differ(first, await pixels(p)));
    await p.selectOption("#colour", "phase");
    const phases = await pixels(p);
    await p.selectOption("#colour", "pocket");
    assert.ok(differ(phases, await pixels(p)), "pockets");
    assert.deepEqual(await p.locator("#scale .chip").allInnerTexts(), ["beside no pocket", "pocket 1, 5", "pocket 2, 6", "pocket 3", "pocket 4"]);
    await setFrame(p, 0); // which has none
    const none = await pixels(p);
    await p.selectOption("#colour", "phase");
    assert.ok(!differ(none, await pixels(p)), "no pocket, no colour");
    await p.selectOption("#colour", "pressure");
    await setFrame(p, 8);
    assert.ok(!differ(first, await pixels(p)));
    await p.selectOption("#seen", "lab");
    assert.ok(differ(first, await pixels(p)), "seen from the lab");
    await p.selectOption("#seen", "tank");
    assert.ok(!differ(first, await pixels(p)));
    await p.uncheck("#walls-on");
    assert.ok(differ(first, await pixels(p)), "walls");
    await p.check("#walls-on");
    await p.click("#closer");
    const close = await pixels(p);
    assert.ok(differ(first, close), "zoom in");
    await p.click("#farther");
    await p.click("#farther");
    assert.ok(differ(first, await pixels(p)), "zoom out");
    await p.click("#whole");
    assert.ok(!differ(first, await pixels(p)), "all");
    assert.equal(await p.locator("#marks .probe").count(), 1);
    await p.uncheck("#marks-on");
    assert.equal(await p.locator("#marks .probe").count(), 0);
    await p.check("#marks-on");
    const box = await p.locator("#canvas").boundingBox();
    await p.mouse.move(box.x + 200, box.y + 200);
    await p.mouse.down();
    await p.mouse.move(box.x + 260, box.y + 220, { steps: 4 });
    await p.mouse.up();
    assert.ok(differ(first, await pixels(p)), "drag");
    await p.click("#whole");
});

await test("a particle is picked where it is, with its id and values", flat, async (p) => {
    const k = 7, i = 123, t = k / 29, box = await p.locator("#canvas").boundingBox();
    await setFrame(p, k);
    await p.uncheck("#marks-on");
    const phase = 0.37 * i, X = [1 + 0.9 * Math.sin(phase + 0.5 * t), 0.3 + 0.25 * Math.cos(1.7 * phase + 2 * t)];
    const scale = Math.min(box.width / 2.3, box.height / 1.3);
    await p.mouse.click(box.x + box.width / 2 + scale * (X[0] - 1), box.y + box.height / 2 - scale * (X[1] - 0.5));
    const said = await text(p, "#picked"), pressure = 1000 * (1 + Math.sin(0.1 * i + 0.3 * k));
    assert.match(said, new RegExp(`^Particle ${3 * (400 - i)}:`));
    const [, value, prefix] = said.match(/pressure ([\d.]+) (k?)Pa/);
    assert.ok(Math.abs(Number(value) * (prefix ? 1000 : 1) - pressure) < 10, said);
    assert.match(said, /speed( in the lab)? 0\.23[01]? m\/s|speed( in the lab)? 0\.22[89] m\/s/);
    assert.equal(await p.locator("#marks .ring").count(), 1);
    await p.keyboard.press("Escape");
    assert.equal(await p.locator("#picked").textContent(), "");
    await p.check("#marks-on");
});

await test("the pocket beside a particle is said", flat, async (p) => {
    const k = 7, i = 125, t = k / 29, box = await p.locator("#canvas").boundingBox();
    await setFrame(p, k);
    await p.uncheck("#marks-on");
    const phase = 0.37 * i, X = [1 + 0.9 * Math.sin(phase + 0.5 * t), 0.3 + 0.25 * Math.cos(1.7 * phase + 2 * t)];
    const scale = Math.min(box.width / 2.3, box.height / 1.3);
    await p.mouse.click(box.x + box.width / 2 + scale * (X[0] - 1), box.y + box.height / 2 - scale * (X[1] - 0.5));
    assert.match(await text(p, "#picked"), new RegExp(`^Particle ${3 * (400 - i)}:.*, beside pocket ${(3 * i + k) % 7},`));
    await p.keyboard.press("Escape");
    await p.check("#marks-on");
});

await test("curves: click sets the time, drag zooms, the button shows all, legends hide", flat, async (p) => {
    const over = p.locator(".charts[data-place=main] .u-over").first(), box = await over.boundingBox();
    await p.mouse.click(box.x + box.width / 2, box.y + 60);
    const k = await frame(p);
    assert.ok(Math.abs(k - 7.5) <= 1, `frame ${k}`); // 15 s of rows, a frame each second
    const labels = () => p.locator(".charts[data-place=main] .chart").first().locator("canvas").evaluate((c) => c.toDataURL());
    const before = await labels();
    await p.mouse.move(box.x + 60, box.y + 60);
    await p.mouse.down();
    await p.mouse.move(box.x + 160, box.y + 60, { steps: 5 });
    await p.mouse.up();
    await p.waitForTimeout(100);
    const zoomed = await labels();
    assert.notEqual(zoomed, before);
    await p.click("#all-time");
    await p.waitForTimeout(100);
    assert.equal(await labels(), before);
    const legend = p.locator(".legend button").first();
    await legend.click();
    assert.equal(await legend.getAttribute("aria-pressed"), "false");
    await p.waitForTimeout(100);
    assert.notEqual(await labels(), before);
    await legend.click();
    await p.waitForTimeout(100);
    assert.equal(await labels(), before);
    const now = await p.locator(".chart .now").first().evaluate((e) => e.getBoundingClientRect().x);
    await setFrame(p, 12);
    assert.ok(await p.locator(".chart .now").first().evaluate((e) => e.getBoundingClientRect().x) > now + 20);
    await p.mouse.move(box.x + 100, box.y + 50);
    assert.notEqual(await text(p, ".legend button output >> nth=0"), "");
    assert.match(await p.locator(".legend").nth(1).innerText(), /measured/);
});

await test("a sensor of the sketch shows its curve, an impact sets the time", flat, async (p) => {
    await p.locator(".sensor[data-column=P1]").focus();
    await p.keyboard.press("Enter");
    assert.equal(await p.locator(".legend button.chosen").getAttribute("data-series"), "P1");
    assert.equal(await p.locator(".sensor.chosen").count(), 1);
    assert.equal(await p.locator("#marks .probe.chosen").count(), 1);
    await p.keyboard.press("Escape");
    assert.equal(await p.locator(".sensor.chosen").count(), 0);
    const moment = p.locator("button.moment").first(), t = Number(await moment.getAttribute("data-time"));
    await moment.click();
    assert.ok(Math.abs(await frame(p) - t) <= 0.51);
    const details = p.locator("details", { hasText: "How it was computed" });
    await details.locator("summary").click();
    assert.ok(await details.locator("canvas").first().evaluate((c) => c.width) > 300);
});

await test("dark and light, the case inside", flat, async (p) => {
    const light = await pixels(p);
    await p.click("#theme");
    assert.equal(await p.evaluate(() => document.documentElement.dataset.theme), "dark");
    assert.ok(differ(light, await pixels(p)));
    assert.equal(await p.locator("#theme").textContent(), "Light"); // what it changes to
    await p.click("#theme");
    assert.ok(!differ(light, await pixels(p)));
    const own = await p.locator("#case").evaluate((e) => e.textContent.replaceAll("<\\", "<"));
    assert.equal(own, readFileSync(`${folder}/flat/case.yaml`, "utf8"));
});

const deep = await open("deep");

await test("3-D: turns by pointer and keys, picks", deep, async (p) => {
    const first = await pixels(p), box = await p.locator("#canvas").boundingBox();
    assert.ok(new Set(first.data).size > 50, "blank");
    await p.mouse.move(box.x + 300, box.y + 150);
    await p.mouse.down();
    await p.mouse.move(box.x + 360, box.y + 170, { steps: 4 });
    await p.mouse.up();
    const turned = await pixels(p);
    assert.ok(differ(first, turned));
    await p.locator("#canvas").focus();
    await p.keyboard.press("ArrowRight");
    assert.ok(differ(turned, await pixels(p)));
    await p.keyboard.press("0");
    assert.ok(!differ(first, await pixels(p)));
    assert.equal(await p.locator("#frame-choice").isVisible(), false);
    assert.equal(await p.locator("#colour option").count(), 3); // its frames have no pockets
});

// Pixels that walls cover, and those of them that they hide.
async function covered(name) {
    const p = await open(name), full = await pixels(p);
    await p.uncheck("#walls-on");
    const bare = await pixels(p), out = { seen: 0, hidden: 0 };
    for (let i = 0; i < bare.data.length; i += 3) {
        const far = Math.max(...[0, 1, 2].map((c) => Math.abs(full.data[i + c] - bare.data[i + c])));
        out.seen += far > 8;
        out.hidden += full.data[i] < 160 && far > 8 && Math.abs(full.data[i] - full.data[i + 1]) < 12 && Math.abs(full.data[i] - full.data[i + 2]) < 20;
    }
    assert.deepEqual(p.problems, []);
    return out;
}

await test("3-D: a chamfer lets the liquid be seen, a plate in the tank hides it", deep, async () => {
    const chamfer = await covered("chamfer"), plate = await covered("plate");
    console.log(`# pixels of walls: ${JSON.stringify({ chamfer, plate })}`);
    assert.ok(plate.hidden > 1000, "the plate is not solid");
    assert.ok(chamfer.seen > 50, "the walls of the tank are not shown");
    assert.ok(chamfer.hidden < 0.1 * plate.hidden, "the chamfer hides the liquid");
});

await test("forces: a plot for each axis, the mean of what stays away from 0", await open("chamfer"), async (p) => {
    const heads = await p.locator('.charts[data-place="forces"] figcaption').allInnerTexts();
    assert.equal(heads.length, 2);
    assert.ok(!/Mean/.test(heads[0]), heads[0]);
    assert.match(heads[1], /Mean of F_y: −9 kN/);
});

// ---- axes, names, what a reader saves ----

const openDetails = (p) => p.evaluate(() => {
    for (const d of document.querySelectorAll("details")) d.open = true;
});
const linesOf = (text) => text.toString().trim().split("\n");
const read = (path) => linesOf(readFileSync(`${folder}/${path}`, "utf8")).map((l) => l.split(","));

// What a button saves: name and bytes.
async function saved(p, button) {
    const [file] = await Promise.all([p.waitForEvent("download"), button.click()]);
    return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
}

// Cells of CSV, with quoted ones.
const cells = (line) => [...line.matchAll(/("(?:[^"]|"")*"|[^,]*)(?:,|$)/g)].slice(0, -1)
    .map(([, c]) => c[0] === '"' ? c.slice(1, -1).replaceAll('""', '"') : c);

await test("each plot: t [s] below it, ticks of its unit beside it", flat, async (p) => {
    await openDetails(p);
    await p.evaluate(() => { window.written = []; });
    await p.click("#theme"); // draws all plots again
    await p.click("#theme");
    await p.waitForFunction(() => [...document.querySelectorAll(".chart canvas")].every((c) => {
        const last = window.written.findLast((w) => w.canvas === c && w.said === "t [s]");
        return last && last.x < c.width; // drawn, with its last width
    }), null, { timeout: 10000 }).catch(() => {});
    const plots = await p.evaluate(() => [...document.querySelectorAll(".chart")].map((chart) => {
        const canvas = chart.querySelector("canvas"), scale = canvas.width / canvas.clientWidth;
        const c = canvas.getBoundingClientRect();
        const o = chart.querySelector(".u-over").getBoundingClientRect();
        const over = { left: o.left - c.left, right: o.right - c.left, bottom: o.bottom - c.top };
        const texts = window.written.filter((w) => w.canvas === canvas)
            .map((w) => ({ said: w.said, x: w.x / scale, y: w.y / scale }));
        const head = chart.querySelector("figcaption").firstChild.textContent;
        return { head, tall: c.height, over, texts };
    }));
    assert.equal(plots.length, 7);
    const most = { Pa: 24e3, m: 0.1, N: 40, J: 2, "%": 0.15, s: null };
    for (const { head, tall, over, texts } of plots) {
        const match = /\[(k|m(?!\])|M)?(Pa|N|J|m|s|%)\]$/.exec(head);
        assert.ok(match, head);
        const [, prefix, unit] = match;
        const below = texts.filter((w) => w.y > over.bottom);
        const number = (w) => Number(w.said.replace("−", "-"));
        const name = below.findLast((w) => w.said === "t [s]");
        assert.ok(name && name.x > over.left && name.x < over.right && name.y <= tall,
            `${head}: no t [s]: ${JSON.stringify({ over, tall, texts })}`);
        const times = below.filter((w) => w.said !== "t [s]").map(number);
        assert.ok(times.length >= 3 && times.every(Number.isFinite), `${head}: ${times}`);
        const values = texts.filter((w) => w.x < over.left && w.y <= over.bottom).map(number);
        assert.ok(values.length >= 2 && values.every(Number.isFinite), `${head}: ${values}`);
        if (most[unit] === null) continue;
        const top = Math.max(...values.map(Math.abs)) * ({ k: 1e3, m: 1e-3 }[prefix] ?? 1);
        assert.ok(top > 0.5 * most[unit] && top < 1.2 * most[unit], `${head}: ticks up to ${top}`);
    }
});

// A column of the page and the table from which it comes.
function sameColumn(head, rows, k, tables, seen) {
    const table = tables.find((t) => t[0].includes(head)), from = table?.[0].indexOf(head);
    assert.ok(table, `${head} is in no table`);
    const time = (text) => Number(text).toFixed(9); // a page keeps first and last of equal steps
    const known = table.slice(1).map((r) => [time(r[0]), Number(r[from])]), values = new Map(known);
    const finite = known.map(([, v]) => v).filter(Number.isFinite);
    const first = head === "pe[J]" ? finite[0] : 0; // energy: change since the start
    const quantum = (Math.max(...finite) - Math.min(...finite)) / 65534;
    let found = 0;
    for (const row of rows) {
        const v = values.get(time(row[0])), have = Number(row[k]);
        found += v !== undefined;
        const text = `${head}, t = ${row[0]}: ${row[k]}, ${v}`;
        if (v === undefined || Number.isNaN(v)) assert.equal(row[k], "nan", text);
        else assert.ok(Math.abs(have - (v - first)) <= 1.01 * quantum + 1e-8, text);
    }
    assert.equal(found, known.length, `${head}: rows`);
    seen.push(head);
}

await test("CSV of a plot: the numbers of the tables and the known points", flat, async (p) => {
    const tables = ["probes", "steps"].map((name) => read(`flat/${name}.csv`)), seen = [];
    const charts = p.locator(".chart");
    for (let i = 0; i < await charts.count(); i++) {
        const button = charts.nth(i).locator(".save button", { hasText: /^CSV$/ });
        assert.equal(await button.count(), 1);
        const { name, bytes } = await saved(p, button), [head, ...rows] = linesOf(bytes).map(cells);
        assert.match(name, /^[A-Za-z0-9_]+\.csv$/);
        assert.equal(head[0], "t[s]");
        assert.ok(rows.every((r) => r.length === head.length));
        assert.ok(rows.every((r, k) => k === 0 || Number(r[0]) > Number(rows[k - 1][0])));
        head.slice(1).forEach((h, k) => {
            if (h !== "measured[m]") return sameColumn(h, rows, k + 1, tables, seen);
            const known = rows.filter((r) => r[k + 1] !== "nan");
            const points = known.map((r) => [Number(r[0]), Number(r[k + 1])]);
            assert.deepEqual(points, [[0.5, 0.02], [1.005, -0.03]]);
            seen.push(h);
        });
    }
    const wanted = [...tables.flatMap((t) => t[0].slice(1)), "measured[m]"];
    assert.deepEqual(seen.sort(), wanted.sort());
});

// Of a picture, beside its plot: its size; values of its middle that differ from the plot; pixels
// with ink in plot and title; colours of the legend that are missing below the plot.
const comparePicture = (p, chart, bytes) => chart.evaluate(async (box, packed) => {
    const raw = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
    const plot = box.querySelector("canvas"), line = 20 * plot.width / plot.clientWidth;
    const image = await createImageBitmap(new Blob([raw], { type: "image/png" }));
    const canvas = (width, height, act) => {
        const c = document.createElement("canvas");
        const pen = c.getContext("2d", { willReadFrequently: true });
        [c.width, c.height] = [width, height];
        act(pen);
        return (x, y, w, h) => pen.getImageData(x, y, w, h).data;
    };
    const surface = getComputedStyle(document.documentElement).getPropertyValue("--surface").trim();
    const have = canvas(image.width, image.height, (pen) => pen.drawImage(image, 0, 0));
    const own = canvas(plot.width, plot.height, (pen) => {
        pen.fillStyle = surface;
        pen.fillRect(0, 0, plot.width, plot.height);
        pen.drawImage(plot, 0, 0);
    })(0, 0, plot.width, plot.height);
    const middle = have(0, 1.5 * line, plot.width, plot.height), below = 1.5 * line + plot.height;
    const ink = (data) => data.filter((v, i) => i % 4 === 0 && Math.abs(v - data[0]) > 60).length;
    const foot = have(0, below, image.width, image.height - below), colours = new Set();
    for (let i = 0; i < foot.length; i += 4) colours.add(`rgb(${foot.slice(i, i + 3).join(", ")})`);
    const swatches = [...box.querySelectorAll(".legend button[aria-pressed=true] i")]
        .map((s) => getComputedStyle(s).borderTopColor);
    return { width: image.width, wide: plot.width, lines: (image.height - plot.height) / line,
        far: middle.filter((v, i) => Math.abs(v - own[i]) > 1).length, inkOfPlot: ink(own),
        title: ink(have(0, 0, image.width, line * 1.2)),
        missing: swatches.filter((s) => !colours.has(s)) };
}, bytes.toString("base64"));

await test("PNG of a plot: the plot, its title, the legend of what is shown", flat, async (p) => {
    const charts = p.locator(".chart"), hide = charts.nth(1).locator(".legend button").first();
    await hide.click();
    for (let i = 0; i < await charts.count(); i++) {
        const chart = charts.nth(i), button = chart.locator(".save button", { hasText: /^PNG$/ });
        assert.equal(await button.count(), 1);
        const { name, bytes } = await saved(p, button);
        const shown = await chart.locator(".legend button[aria-pressed=true]").count();
        assert.match(name, /^[A-Za-z0-9_]+\.png$/);
        const d = await comparePicture(p, chart, bytes);
        const have = [d.width, Math.round(d.lines), d.far, d.missing];
        assert.deepEqual(have, [d.wide, shown + 2, 0, []], name);
        assert.ok(d.inkOfPlot > 200 && d.title > 100, `${name}: ${JSON.stringify(d)}`);
    }
    await hide.click();
});

await test("CSV of each table: its cells", flat, async (p) => {
    const tables = p.locator("table"), count = await tables.count();
    const buttons = await p.locator(".save button[title^='Save as CSV']").count();
    const plain = (row) => row.map((c) => c.replaceAll("−", "-").trim());
    assert.ok(count >= 6, `${count} tables`);
    assert.equal(buttons, count + await p.locator(".chart").count());
    const names = new Set();
    for (let i = 0; i < count; i++) {
        const table = tables.nth(i), button = await table.evaluateHandle((e) => {
            const box = e.closest(".scroll");
            return (box ? box.firstElementChild : e.previousElementSibling).querySelector("button");
        });
        const { name, bytes } = await saved(p, button);
        const texts = (e) => [...e.rows].map((r) => [...r.cells].map((c) => c.textContent));
        const wanted = await table.evaluate(texts);
        assert.deepEqual(linesOf(bytes).map(cells), wanted.map(plain), name);
        assert.match(name, /^[A-Za-z0-9_]+\.csv$/);
        assert.ok(name !== "table.csv" && !names.has(name), `two tables with the name ${name}`);
        names.add(name);
    }
});

await test("the film names its sensors where they are", flat, async (p) => {
    await p.click("#whole");
    const name = p.locator("#marks text.name"), box = await p.locator("#canvas").boundingBox();
    assert.deepEqual(await name.allTextContents(), ["P1"]);
    const scale = Math.min(box.width / 2.3, box.height / 1.3);
    const x = box.width / 2 + scale, y = box.height / 2 + 0.4 * scale;
    const mark = p.locator("#marks .probe"), at = (e, k) => e.getAttribute(k).then(Number);
    assert.ok(Math.hypot(await at(mark, "cx") - x, await at(mark, "cy") - y) < 2);
    const b = await name.boundingBox();
    assert.ok(b.x >= box.x && b.x + b.width <= box.x + box.width, "the name is cut off");
    assert.ok(Math.abs(b.y + b.height / 2 - box.y - y) < 8, "the name is beside the mark");
    await name.click();
    assert.match(await name.getAttribute("class"), /chosen/);
    await p.keyboard.press("Escape");
    await p.uncheck("#marks-on");
    assert.equal(await name.count(), 0);
    await p.check("#marks-on");
});

// Arrows of the axes and of the bow, in pixels: [from, along].
const arrows = (p) => p.evaluate(() => {
    const lines = [...document.querySelectorAll("#marks line.axis")];
    return Object.fromEntries(lines.map((l) => {
        const [x1, y1, x2, y2] = ["x1", "y1", "x2", "y2"].map((k) => Number(l.getAttribute(k)));
        return [l.nextElementSibling.textContent, [[x1, y1], [x2 - x1, y2 - y1]]];
    }));
});
const angle = (a, b) => {
    const cosine = (a[0] * b[0] + a[1] * b[1]) / Math.hypot(...a) / Math.hypot(...b);
    return Math.acos(cosine) * 180 / Math.PI;
};

// Axes of 0.32 m at the lower corner of the tank of 2 x 1 x 0.5 m; where the bow is, in these axes.
async function bowAt(p, along, place) {
    const a = await arrows(p), [o] = a.x, { width } = await p.locator("#screen").boundingBox();
    assert.deepEqual(Object.keys(a), ["x", "y", "z", "bow"]);
    for (const k of [0, 1]) assert.ok(a.y[0][k] === o[k] && a.z[0][k] === o[k]);
    assert.ok(a.x[1][0] > 20 && a.z[1][1] > 5 && angle(a.y[1], [0, -1]) < 10, JSON.stringify(a));
    const from = [0, 1].map((k) => o[k] +
        (a.x[1][k] * place[0] + a.y[1][k] * place[1] + a.z[1][k] * place[2]) / 0.32);
    const off = Math.hypot(from[0] - a.bow[0][0], from[1] - a.bow[0][1]);
    assert.ok(off < 0.1 * width, `the bow is not at ${from}: ${a.bow[0]}`);
    const axis = a[along.at(-1)][1].map((v) => along[0] === "-" ? -v : v);
    // lines along z, which leave the eye, differ most
    const turned = angle(a.bow[1], axis);
    assert.ok(turned < 60, `the bow is ${turned} degrees off ${along}`);
}

await test("3-D: axes and bow, along x and across", deep, async (p) => {
    await p.click("#whole");
    await bowAt(p, "x", [2, 1, 0.25]);
    const before = await arrows(p);
    await p.locator("#canvas").focus();
    for (let k = 0; k < 5; k++) await p.keyboard.press("ArrowLeft");
    assert.ok(angle(before.x[1], (await arrows(p)).x[1]) > 10, "axes turn with the view");
    await p.keyboard.press("0");
    const aft = await open("aft");
    await bowAt(aft, "-z", [1, 1, 0]);
    assert.deepEqual(aft.problems, []);
    const plain = await open("plate"); // no ship
    await plain.uncheck("#marks-on");
    assert.deepEqual(Object.keys(await arrows(plain)), ["x", "y", "z"]);
    assert.deepEqual(await p.locator("#marks text.name").allTextContents(), ["P1"]);
});

await test("the button of the theme follows the machine, also without a film", flat, async () => {
    for (const name of ["flat", "bare"]) {
        const p = await open(name, { colorScheme: "dark" });
        const say = () => p.locator("#theme").textContent();
        const ground = () => p.evaluate(() => getComputedStyle(document.body).backgroundColor);
        const lightness = async () => Number((await ground()).match(/\d+/)[0]); // of grey, of 255
        const look = async (word, dark) => {
            const says = (w) => document.getElementById("theme").textContent === w;
            await p.waitForFunction(says, word, { timeout: 5000 }).catch(() => {});
            assert.equal(await say(), word, name);
            assert.ok(dark === await lightness() < 100, `${name}: ${word}, ${await ground()}`);
        };
        await look("Light", true);
        await p.emulateMedia({ colorScheme: "light" });
        await look("Dark", false);
        await p.click("#theme");
        await look("Light", true);
        await p.emulateMedia({ colorScheme: "dark" });
        await look("Light", true);
        await p.click("#theme");
        await look("Dark", false);
        assert.deepEqual(p.problems, []);
        await p.close();
    }
});

async function accessible(name, page) {
    await test(`axe: ${name}`, page, async (p) => {
        await p.evaluate(() => { for (const d of document.querySelectorAll("details")) d.open = true; });
        await p.evaluate(axe);
        const found = await p.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
        assert.deepEqual(found.violations.map((v) => `${v.id}: ${v.nodes.map((n) => `${n.html.slice(0, 120)} ${n.failureSummary}`).join(" | ")}`), []);
    });
}
await accessible("light", flat);
await accessible("dark", await open("flat", { colorScheme: "dark" }));
const phone = await open("deep", { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });
await test("phone: nothing is wider than the screen", phone, async (p) => {
    assert.ok(await p.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    assert.ok((await pixels(p)).width >= 600);
});
await accessible("phone", phone);
await browser.close();
console.log(`${done} tests passed`);
