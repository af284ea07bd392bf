// SPDX-License-Identifier: BSD-3-Clause
// Particles drawn by WebGL 2: discs in 2-D, shaded balls in 3-D. Places are those of the frame of the tank.

const vertexText = `#version 300 es
precision highp float;
layout(location = 0) in float px;
layout(location = 1) in float py;
layout(location = 2) in float pz;
layout(location = 3) in float pressure;
layout(location = 4) in float speed;
layout(location = 5) in float phase;
layout(location = 6) in float pocket;
uniform vec3 lo, shift;
uniform float quantum, radius, pixels;
uniform mat3 turn;
uniform mat4 camera;
uniform int mode, walls;
uniform vec3 map[15];
uniform vec3 kinds[5];
uniform vec3 pockets[4];
uniform vec3 wallColour;
uniform float wallAlpha;
out vec4 colour;
out float size;
vec3 shade(int m, float share) {
    float f = 4.0 * clamp(share, 0.0, 1.0);
    int k = min(int(f), 3);
    return mix(map[5 * m + k], map[5 * m + k + 1], f - float(k));
}
void main() {
    vec3 x = turn * (lo + quantum * vec3(px, py, pz)) + shift;
    gl_Position = camera * vec4(x, 1.0);
    size = radius * pixels / gl_Position.w;
    gl_PointSize = 2.0 * size + 2.0;
    int kind = int(phase + 0.5);
    bool body = walls == 1 || kind == 255;
    if (walls == 0 && pressure < 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // not in this frame
    float code = mode == 1 ? speed : pressure;
    int number = int(pocket + 0.5);
    vec3 c = mode == 3 && number > 0 ? pockets[(number - 1) % 4] : mode >= 2 ? kinds[min(kind, 3)] : shade(mode == 1 ? 0 : kind % 3, (code - 1.0) / 223.0);
    colour = body ? vec4(wallColour, wallAlpha) : vec4(c, 1.0);
}`;
const fragmentText = `#version 300 es
precision highp float;
in vec4 colour;
in float size;
uniform int solid;
out vec4 result;
void main() {
    vec2 d = (gl_PointCoord - 0.5) * (2.0 * size + 2.0);
    float cover = clamp(size + 0.5 - length(d), 0.0, 1.0);
    if (cover <= 0.0 || (solid == 1 && cover < 0.5)) discard;
    vec3 c = colour.rgb;
    if (solid == 1) {
        vec3 n = vec3(d.x, -d.y, 0.0) / max(size, 1.0);
        n.z = sqrt(max(0.0, 1.0 - dot(n.xy, n.xy)));
        c *= 0.55 + 0.5 * max(0.0, dot(n, normalize(vec3(-0.4, 0.7, 0.8))));
        cover = 1.0;
    }
    float a = colour.a * cover;
    result = vec4(c * a, a);
}`;
const lineVertex = `#version 300 es
layout(location = 0) in vec3 x;
uniform mat4 camera;
uniform mat3 turn;
uniform vec3 shift;
void main() { gl_Position = camera * vec4(turn * x + shift, 1.0); }`;
const lineFragment = `#version 300 es
precision highp float;
uniform vec4 colour;
out vec4 result;
void main() { result = colour; }`;

function program(gl, vertex, fragment) {
    const p = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
        const s = gl.createShader(type);
        gl.shaderSource(s, text);
        gl.compileShader(s);
        if (!gl.getShaderParameter(s, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(s));
        gl.attachShader(p, s);
    }
    gl.linkProgram(p);
    if (!gl.getProgramParameter(p, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(p));
    const at = {};
    for (let i = 0; i < gl.getProgramParameter(p, gl.ACTIVE_UNIFORMS); i++) {
        const name = gl.getActiveUniform(p, i).name.replace("[0]", "");
        at[name] = gl.getUniformLocation(p, name);
    }
    return {p, at};
}

const subtract = (a, b) => a.map((v, i) => v - b[i]);
const dot = (a, b) => a.reduce((s, v, i) => s + v * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((v) => v / Math.hypot(...a));

export class View {
    // data: head of the film; walls: head of the walls; frames: Frames; wallFrames: Frames of one frame; phase: of each particle
    constructor(canvas, data, walls, frames, wallFrames, phase, box) {
        const gl = canvas.getContext("webgl2", {antialias: false, preserveDrawingBuffer: true, alpha: false});
        if (!gl) throw new Error("This browser has no WebGL 2.");
        Object.assign(this, {canvas, gl, data, walls, frames, wallFrames, box, frame: 0, mode: 0, seen: "tank", showWalls: true});
        this.points = program(gl, vertexText, fragmentText);
        this.lines = program(gl, lineVertex, lineFragment);
        this.dots = this.makeBuffers(frames.count, phase, frames.values);
        if (data.dim === 3) this.sortWalls();
        else {
            this.wallDots = this.makeBuffers(wallFrames.count, new Uint8Array(wallFrames.count));
            this.fill(this.wallDots, wallFrames, 0);
        }
        this.edges = this.makeEdges();
        this.background = [1, 1, 1];
        this.whole();
    }

    makeBuffers(count, phase, values = 2) {
        const {gl, data} = this, array = gl.createVertexArray(), place = gl.createBuffer(), value = gl.createBuffer(), kind = gl.createBuffer();
        gl.bindVertexArray(array);
        gl.bindBuffer(gl.ARRAY_BUFFER, place);
        gl.bufferData(gl.ARRAY_BUFFER, Math.max(1, count) * data.dim * 2, gl.DYNAMIC_DRAW);
        for (let d = 0; d < data.dim; d++) {
            gl.enableVertexAttribArray(d);
            gl.vertexAttribPointer(d, 1, gl.UNSIGNED_SHORT, false, 0, d * count * 2);
        }
        gl.bindBuffer(gl.ARRAY_BUFFER, value);
        gl.bufferData(gl.ARRAY_BUFFER, Math.max(1, count) * values, gl.DYNAMIC_DRAW);
        for (const [k, place] of [3, 4, 6].slice(0, values).entries()) { // without pockets the last is 0
            gl.enableVertexAttribArray(place);
            gl.vertexAttribPointer(place, 1, gl.UNSIGNED_BYTE, false, 0, k * count);
        }
        gl.bindBuffer(gl.ARRAY_BUFFER, kind);
        gl.bufferData(gl.ARRAY_BUFFER, phase, gl.STATIC_DRAW);
        gl.enableVertexAttribArray(5);
        gl.vertexAttribPointer(5, 1, gl.UNSIGNED_BYTE, false, 0, 0);
        return {array, place, value, count};
    }

    fill(buffers, frames, k) {
        const {gl} = this, n = frames.count, {dim, values} = frames;
        gl.bindBuffer(gl.ARRAY_BUFFER, buffers.place);
        gl.bufferSubData(gl.ARRAY_BUFFER, 0, frames.place.subarray(k * dim * n, (k + 1) * dim * n));
        gl.bindBuffer(gl.ARRAY_BUFFER, buffers.value);
        gl.bufferSubData(gl.ARRAY_BUFFER, 0, frames.value.subarray(k * values * n, (k + 1) * values * n));
    }

    // Walls of the tank apart from what stands in it, which alone may hide the liquid. A box shows its edges; the walls of other tanks are faint, with their sharp edges.
    sortWalls() {
        const {wallFrames, walls, box, data} = this, {count, place, value} = wallFrames, tank = [], inner = [];
        const on = (i) => [0, 1, 2].some((d) => {
            const v = walls.lo[d] + walls.quantum * place[d * count + i];
            return v < box.lo[d] + 0.6 * data.dp || v > box.hi[d] - 0.6 * data.dp;
        });
        const named = value.subarray(0, count).includes(1); // else: by where they are
        for (let i = 0; i < count; i++) (named ? value[i] === 1 : on(i)) ? tank.push(i) : inner.push(i);
        this.boxed = named ? tank.every(on) : inner.length < 0.4 * count;
        if (!named && !this.boxed) tank.push(...inner.splice(0));
        this.wallDots = this.makeDots(tank);
        this.innerDots = this.makeDots(inner);
    }

    // Buffers of some of the walls.
    makeDots(chosen) {
        const {wallFrames} = this, n = chosen.length, kept = {count: n, dim: 3, values: 2, place: new Uint16Array(3 * n), value: new Uint8Array(2 * n)};
        chosen.forEach((i, k) => { for (let d = 0; d < 3; d++) kept.place[d * n + k] = wallFrames.place[d * wallFrames.count + i]; });
        const dots = this.makeBuffers(n, new Uint8Array(Math.max(1, n)));
        this.fill(dots, kept, 0);
        return dots;
    }

    // Those of the tank, or of its box.
    makeEdges() {
        const {gl, box, data} = this, at = data.edges.slice();
        for (let i = 0; i < 8 && data.edges.length === 0; i++) {
            for (let d = 0; d < 3; d++) {
                if (i >> d & 1) continue;
                for (const corner of [i, i | 1 << d]) for (let e = 0; e < 3; e++) at.push(corner >> e & 1 ? box.hi[e] : box.lo[e]);
            }
        }
        const array = gl.createVertexArray(), buffer = gl.createBuffer();
        gl.bindVertexArray(array);
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(at), gl.STATIC_DRAW);
        gl.enableVertexAttribArray(0);
        gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
        return {array, count: at.length / 3};
    }

    // Bounds of what is shown: the tank with three spacings about it.
    bounds() {
        const margin = 3 * this.data.dp, box = this.seen === "lab" ? this.swept() : this.box;
        return {lo: box.lo.map((v) => v - margin), hi: box.hi.map((v) => v + margin)};
    }

    // Where the tank comes to, in the frame of the lab.
    swept() {
        if (this.sweptBox) return this.sweptBox;
        if (!this.data.poses.length) return this.box;
        const out = {lo: [Infinity, Infinity, Infinity], hi: [-Infinity, -Infinity, -Infinity]};
        for (const p of this.data.poses) {
            for (let i = 0; i < 8; i++) {
                const X = [0, 1, 2].map((d) => i >> d & 1 ? this.box.hi[d] : this.box.lo[d]);
                for (let d = 0; d < 3; d++) {
                    const v = dot(p.slice(3 * d, 3 * d + 3), X) + p[9 + d];
                    out.lo[d] = Math.min(out.lo[d], v);
                    out.hi[d] = Math.max(out.hi[d], v);
                }
            }
        }
        return this.sweptBox = out;
    }

    whole() {
        const {lo, hi} = this.bounds();
        this.centre = lo.map((v, d) => (v + hi[d]) / 2);
        this.zoom = 1;
        this.turnAbout = this.data.dim === 3 ? [-0.5, 0.35] : [0, 0];
    }

    // Width and height of the whole, for the shape of the canvas.
    shape() {
        const {lo, hi} = this.bounds();
        return this.data.dim === 3 ? [Math.hypot(hi[0] - lo[0], hi[2] - lo[2]), (hi[1] - lo[1]) * 1.1 + (hi[2] - lo[2]) * 0.35] : [hi[0] - lo[0], hi[1] - lo[1]];
    }

    pose() {
        const p = this.data.poses.length && this.seen === "lab" ? this.data.poses[this.frame] : [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0];
        return {turn: p.slice(0, 9), shift: p.slice(9)};
    }

    // Column-major matrix; `pixels` times a radius over w is the radius on the screen.
    camera() {
        const {width, height} = this.canvas, {lo, hi} = this.bounds(), c = this.centre;
        if (this.data.dim === 2) {
            const scale = this.zoom * Math.min(width / (hi[0] - lo[0]), height / (hi[1] - lo[1]));
            const sx = 2 * scale / width, sy = 2 * scale / height;
            return {m: [sx, 0, 0, 0, 0, sy, 0, 0, 0, 0, 0, 0, -sx * c[0], -sy * c[1], 0, 1], pixels: scale};
        }
        const [yaw, pitch] = this.turnAbout, reach = Math.hypot(...subtract(hi, lo)) / 2, focal = 2.4, aspect = width / height;
        const back = [Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)];
        const right = unit(cross([0, 1, 0], back)), up = cross(back, right);
        let fit = 0; // the distance from which all corners are seen
        for (let i = 0; i < 8; i++) {
            const X = [0, 1, 2].map((d) => (i >> d & 1 ? 1 : -1) * (hi[d] - lo[d]) / 2);
            fit = Math.max(fit, dot(X, back) + focal * Math.max(Math.abs(dot(X, right)) / aspect, Math.abs(dot(X, up))));
        }
        const far = fit / this.zoom, eye = c.map((v, d) => v + far * back[d]), near = Math.max(far - 2 * reach, far / 100), end = far + 2 * reach;
        const a = (end + near) / (near - end), b = 2 * end * near / (near - end);
        const row = (v, s) => [s * v[0], s * v[1], s * v[2], -s * dot(v, eye)];
        const x = row(right, focal / aspect), y = row(up, focal), z = row(back, 1);
        const clip = z.map((v, i) => a * v + (i === 3 ? b : 0)), w = z.map((v) => -v), m = [];
        for (let i = 0; i < 4; i++) m.push(x[i], y[i], clip[i], w[i]);
        return {m, pixels: focal * height / 2};
    }

    // A point of the frame of the tank, in pixels of the canvas; null: behind the eye.
    project(X) {
        const {turn, shift} = this.pose(), {m} = this.camera(), x = [0, 1, 2].map((i) => dot(turn.slice(3 * i, 3 * i + 3), X) + shift[i]);
        const p = [0, 1, 2, 3].map((i) => m[i] * x[0] + m[4 + i] * x[1] + m[8 + i] * x[2] + m[12 + i]);
        return p[3] > 0 && this.canvas.width && this.canvas.height ? [(p[0] / p[3] + 1) / 2 * this.canvas.width, (1 - p[1] / p[3]) / 2 * this.canvas.height, p[3]] : null;
    }

    place(i) {
        const {frames, data} = this, at = this.frame * frames.dim * frames.count + i;
        return [0, 1, 2].map((d) => d < frames.dim ? data.lo[d] + data.quantum * frames.place[at + d * frames.count] : 0);
    }

    present(i) {
        return this.frames.value[this.frame * this.frames.values * this.frames.count + i] > 0;
    }

    // The particle nearest to a pixel, in 3-D the foremost of those under it; -1: none.
    pick(x, y) {
        let best = -1, most = Infinity;
        const reach = this.camera().pixels * this.radius();
        for (let i = 0; i < this.frames.count; i++) {
            if (!this.present(i)) continue;
            const p = this.project(this.place(i));
            if (!p) continue;
            const d = Math.hypot(p[0] - x, p[1] - y), size = Math.max(8, 1.5 * reach / p[2]);
            const order = this.data.dim === 3 ? p[2] : d;
            if (d < size && order < most) [best, most] = [i, order];
        }
        return best;
    }

    radius() {
        return 0.5 * this.data.dp * Math.pow(this.data.every, 1 / this.data.dim);
    }

    show(frame) {
        this.frame = Math.max(0, Math.min(frame, this.frames.ready - 1));
        this.fill(this.dots, this.frames, this.frame);
        this.draw();
    }

    draw() {
        const {gl, data} = this, solid = data.dim === 3, {m, pixels} = this.camera(), {turn, shift} = this.pose();
        gl.viewport(0, 0, this.canvas.width, this.canvas.height);
        gl.clearColor(...this.background, 1);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        if (solid) gl.enable(gl.DEPTH_TEST);
        const turned = [0, 3, 6, 1, 4, 7, 2, 5, 8].map((k) => turn[k]);
        if (solid && this.showWalls && (this.boxed || data.edges.length > 0)) this.drawEdges(m, turned, shift);
        const {p, at} = this.points;
        gl.useProgram(p);
        gl.uniformMatrix4fv(at.camera, false, m);
        gl.uniformMatrix3fv(at.turn, false, turned);
        gl.uniform3fv(at.shift, shift);
        gl.uniform1f(at.pixels, pixels);
        gl.uniform1i(at.mode, this.mode);
        gl.uniform1i(at.solid, solid ? 1 : 0);
        gl.uniform3fv(at.map, data.maps.flat(2));
        gl.uniform3fv(at.kinds, kinds.flat());
        gl.uniform3fv(at.pockets, pockets.flat());
        gl.uniform3fv(at.wallColour, [0.55, 0.55, 0.58]);
        gl.uniform1f(at.wallAlpha, 1);
        this.drawDots(this.dots, data, 0, this.radius());
        if (this.showWalls && !solid) this.drawDots(this.wallDots, this.walls, 1, 0.5 * data.dp);
        if (this.showWalls && solid) this.drawDots(this.innerDots, this.walls, 1, 0.5 * data.dp);
        if (this.showWalls && solid && !this.boxed) { // faint, so that the liquid is seen through them
            gl.uniform1f(at.wallAlpha, 0.35);
            gl.depthMask(false);
            this.drawDots(this.wallDots, this.walls, 1, 0.12 * data.dp);
            gl.depthMask(true);
        }
        this.after?.();
    }

    drawDots(buffers, head, walls, radius) {
        const {gl} = this, {at} = this.points;
        gl.bindVertexArray(buffers.array);
        gl.uniform1i(at.walls, walls);
        gl.uniform3fv(at.lo, [head.lo[0], head.lo[1], this.data.dim === 3 ? head.lo[2] : 0]);
        gl.uniform1f(at.quantum, head.quantum);
        gl.uniform1f(at.radius, radius);
        gl.drawArrays(gl.POINTS, 0, buffers.count);
    }

    drawEdges(m, turned, shift) {
        const {gl} = this, {p, at} = this.lines;
        gl.useProgram(p);
        gl.uniformMatrix4fv(at.camera, false, m);
        gl.uniformMatrix3fv(at.turn, false, turned);
        gl.uniform3fv(at.shift, shift);
        gl.uniform4fv(at.colour, [0.5, 0.5, 0.54, 1]);
        gl.bindVertexArray(this.edges.array);
        gl.drawArrays(gl.LINES, 0, this.edges.count);
    }

    // Move by pixels: a 2-D picture is shifted, a 3-D one too where `slide`, else it turns.
    drag(dx, dy, slide) {
        const {pixels} = this.camera();
        if (this.data.dim === 2) {
            this.centre[0] -= dx / pixels;
            this.centre[1] += dy / pixels;
        } else if (slide) {
            const [yaw] = this.turnAbout, far = this.project(this.centre)?.[2] ?? 1;
            this.centre[0] -= dx * Math.cos(yaw) * far / pixels;
            this.centre[2] += dx * Math.sin(yaw) * far / pixels;
            this.centre[1] += dy * far / pixels;
        } else {
            this.turnAbout[0] -= dx * 0.006;
            this.turnAbout[1] = Math.max(-1.5, Math.min(1.5, this.turnAbout[1] + dy * 0.006));
        }
        this.draw();
    }

    // About a pixel of the canvas, which stays where it is in 2-D.
    zoomBy(factor, x = this.canvas.width / 2, y = this.canvas.height / 2) {
        const before = this.camera().pixels;
        this.zoom = Math.max(0.2, Math.min(60, this.zoom * factor));
        if (this.data.dim === 2) {
            const after = this.camera().pixels, share = 1 / before - 1 / after;
            this.centre[0] += (x - this.canvas.width / 2) * share;
            this.centre[1] -= (y - this.canvas.height / 2) * share;
        }
        this.draw();
    }
}

// Colours of phases: water, gas, two others.
export const kinds = [[0.13, 0.44, 0.71], [0.83, 0.77, 0.94], [0.86, 0.37, 0.09], [0.30, 0.60, 0.35], [0.55, 0.55, 0.58]];
// Colours of pockets of gas, in turn.
export const pockets = [[0.86, 0.37, 0.09], [0.93, 0.73, 0.13], [0.45, 0.18, 0.55], [0.20, 0.62, 0.42]];
