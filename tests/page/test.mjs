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
    await page.goto(`file://${folder}/${name}/report.html`);
    await page.waitForFunction(() => document.documentElement.dataset.film === "all" && document.documentElement.dataset.curves === "all", null, { timeout: 60000 });
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
