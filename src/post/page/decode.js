// SPDX-License-Identifier: BSD-3-Clause
// Undoes page_codec.c: base64, deflate, bytes of one significance side by side, differences from a prediction.

export function fromBase64(text) {
    const raw = atob(text), bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
    return bytes;
}

export async function inflate(bytes) {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

// 16 bits a value, of the range from lo to hi; 65535 is null.
export async function unpackCurve(text, points, lo, hi) {
    const raw = await inflate(fromBase64(text)), out = new Array(points);
    let code = 0;
    for (let i = 0; i < points; i++) {
        code = (code + raw[i] + 256 * raw[points + i]) & 65535;
        out[i] = code === 65535 ? null : lo + (hi - lo) * code / 65534;
    }
    return out;
}

export async function unpackTimes(t, points) {
    if (t.data === undefined) {
        return Array.from({length: points}, (_, i) => points > 1 ? t.from + (t.to - t.from) * i / (points - 1) : t.from);
    }
    const raw = await inflate(fromBase64(t.data)), view = new DataView(raw.buffer);
    return Array.from({length: points}, (_, i) => view.getFloat64(8 * i, true));
}

// Particles of all frames so far. place: planes x, y (, z) of each frame; value: pressures (0: not there), speeds (, pockets) of each frame.
export class Frames {
    constructor(count, dim, bits, frames, values = 2) {
        Object.assign(this, {count, dim, bits, frames, values, ready: 0});
        this.place = new Uint16Array(frames * dim * count);
        this.value = new Uint8Array(frames * values * count);
    }

    // The frames of a block, unpacked.
    add(raw) {
        const {count, dim, values} = this, size = (2 * dim + values) * count;
        for (let at = 0; at + size <= raw.length && this.ready < this.frames; at += size) {
            for (let d = 0; d < dim; d++) this.addPlane(raw, at + d * count, at + (dim + d) * count, d);
            const now = this.ready * values * count, before = now - values * count, from = at + 2 * dim * count;
            for (let i = 0; i < values * count; i++) {
                this.value[now + i] = raw[from + i] + (this.ready ? this.value[before + i] : 0);
            }
            this.ready++;
        }
    }

    // Low and high bytes of one coordinate: 0, 1, 2, 3, 4 is 0, -1, 1, -2, 2 from 2 x - x before.
    addPlane(raw, low, high, d) {
        const {count, dim, place} = this, mask = (1 << this.bits) - 1, step = dim * count;
        const now = (this.ready * dim + d) * count, last = now - step, before = last - step;
        for (let i = 0; i < count; i++) {
            const u = raw[low + i] | raw[high + i] << 8, difference = u & 1 ? -((u + 1) >> 1) : u >> 1;
            const predicted = this.ready > 1 ? 2 * place[last + i] - place[before + i] : this.ready ? place[last + i] : 0;
            place[now + i] = predicted + difference & mask;
        }
    }
}
