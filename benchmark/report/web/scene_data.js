// SPDX-License-Identifier: MIT
// The points of a page, as benchmark/report/pack.cpp wrote them.

const element = (id) => document.getElementById(id);
const grouped = (number) => number.toLocaleString('en');
/** A new element with attributes, and text or children. */
function make(tag, attributes, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

const rgbOf = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
/** A colour of page.css, which depends on the scheme: "--kind-1". */
const colourOf = (name) => rgbOf(getComputedStyle(document.documentElement).getPropertyValue(name).trim());
/** How a point looks, as four bytes: its colour, and 0 hidden, 1 usual, 2 emphasised or 3 marked. */
const painted = ([r, g, b], look) => (r | g << 8 | b << 16 | look << 24) >>> 0;
/** 256 colours between two. */
const shades = (low, high) => Array.from({length: 256}, (_, i) => low.map((value, axis) => value + (high[axis] - value) * i / 255));
/** Of kept points, from low to high. */
const keptShades = () => shades(colourOf('--kept-low'), colourOf('--kept-high'));

/** The bytes that `text` holds from `start` to `end`, as `printable` of benchmark/report/pack.cpp wrote them. */
function bytesOfText(text, start, end) {
  const bytes = new Uint8Array((((end - start) >> 1) * 13 + ((end - start) & 1) * 6) >> 3);
  const digit = (i) => { const code = text.charCodeAt(i); return code === 33 ? 25 : code - 35; };
  let bits = 0, count = 0, at = 0;
  for (let i = start; i < end; i += 2) {
    const isPair = i + 1 < end;
    bits |= (isPair ? digit(i) + 91 * digit(i + 1) : digit(i)) << count;
    for (count += isPair ? 13 : 6; count >= 8; count -= 8, bits >>= 8) bytes[at++] = bits & 255;
  }
  return bytes;
}

/** The stream in the script element `id`, which is unpacked while it is read. */
function unpacked(id) {
  const text = element(id).textContent, slice = 1 << 16;  // A slice ends with a whole byte.
  let at = 0;
  return new ReadableStream({pull(control) {
    const end = Math.min(text.length, at + slice);
    control.enqueue(bytesOfText(text, at, end));
    if ((at = end) === text.length) control.close();
  }}).pipeThrough(new DecompressionStream('deflate'));
}

/** Bytes of the stream in the script element `id`. */
const bytesOf = async (id) => new Uint8Array(await new Response(unpacked(id)).arrayBuffer());

/** Lets the browser draw and react, if it could not for 15 ms. */
let rested = 0;
async function rest() {
  if (performance.now() - rested < 15) return;
  await new Promise((resolve) => setTimeout(resolve));
  rested = performance.now();
}

/** Undoes `append_differences` into every fourth place of `values`, from `start` on. */
function addDifferences(bytes, offset, count, values, start) {
  let value = 0;
  for (let i = 0; i < count; ++i) {
    const folded = bytes[offset + i] | bytes[offset + count + i] << 8;
    value = (value + (folded & 1 ? -((folded + 1) >> 1) : folded >> 1)) & 0xffff;
    values[start + 4 * i] = value;
  }
}

/** A sequence's points: `places` holds x, y, z and the scan of each, `labels` an index each. */
class SceneData {
  constructor(head) {
    this.head = head;
    this.count = head.points;
    /** Metres of a unit of x, y and z. */
    this.step = head.voxel / head.steps_per_voxel * 2 ** head.shift;
  }

  /** Unpacks the points chunk by chunk. @param onChunk is called after each chunk */
  async load(onChunk) {
    if (this.isLoaded) return;
    Object.assign(this, {places: new Uint16Array(4 * this.count), labels: new Uint8Array(this.count), chunks: [], loaded: 0});
    const reader = unpacked(this.head.stream).getReader(), piece = new Uint8Array(9 * this.head.chunk);
    let filled = 0;
    for (let next = await reader.read(); !next.done; next = await reader.read()) {
      for (let used = 0; used < next.value.length;) {
        const size = 9 * Math.min(this.head.chunk, this.count - this.loaded), part = next.value.subarray(used, used + size - filled);
        piece.set(part, filled);
        used += part.length;
        filled += part.length;
        if (filled < size) continue;
        this.addChunk(piece, size / 9);
        onChunk?.(this.chunks[this.chunks.length - 1]);
        filled = 0;
        await rest();
      }
    }
    const [low, high] = this.quantiles(2, [0.01, 0.99]);
    Object.assign(this, {low, high: Math.max(low + 1, high), isLoaded: true});
  }

  /** A chunk is a range of points, with the corners of their box in metres. */
  addChunk(bytes, count) {
    const {places, step, loaded: start} = this, low = [Infinity, Infinity, Infinity], high = [0, 0, 0];
    for (let axis = 0; axis < 4; ++axis) addDifferences(bytes, 2 * axis * count, count, places, 4 * start + axis);
    this.labels.set(bytes.subarray(8 * count, 9 * count), start);
    for (let i = start; i < start + count; ++i) {
      for (let axis = 0; axis < 3; ++axis) {
        const value = places[4 * i + axis];
        if (value < low[axis]) low[axis] = value;
        if (value > high[axis]) high[axis] = value;
      }
    }
    this.chunks.push({start, count, box: [low.map((value) => value * step), high.map((value) => (value + 1) * step)]});
    this.loaded += count;
  }

  /** A byte for each point. */
  bytes(number) {
    return bytesOf(`${this.head.stream}-${number}`);
  }

  /** Units along an axis below which a share of the points are. */
  quantiles(axis, shares) {
    const bins = new Uint32Array(65536);
    for (let i = 0; i < this.count; ++i) ++bins[this.places[4 * i + axis]];
    return shares.map((share) => {
      let sum = 0, place = 0;
      while (place < 65535 && sum + bins[place] <= share * this.count) sum += bins[place++];
      return place;
    });
  }

  /** Height of point i, from 0 (low) to 255. */
  height(i) {
    return Math.round(255 * Math.min(1, Math.max(0, (this.places[4 * i + 2] - this.low) / (this.high - this.low))));
  }

  /** Corners of the map in metres, without the outermost points at each side. */
  box(share = 0.01) {
    const ends = [0, 1, 2].map((axis) => this.quantiles(axis, [share, 1 - share]));
    return [ends.map(([low]) => low * this.step), ends.map(([, high]) => (high + 1) * this.step)];
  }

  /** Corners of a box around the path of the sensor. */
  pathBox() {
    const sides = [0, 1, 2].map((axis) => this.head.trajectory.filter((_, i) => i % 3 === axis));
    return [sides.map((side) => side.reduce((a, b) => Math.min(a, b)) - 15), sides.map((side) => side.reduce((a, b) => Math.max(a, b)) + 15)];
  }

  /** The squares of `size` metres that hold most of the points that `wanted` accepts: corners and count. */
  squares(wanted, size, most) {
    const units = size / this.step, squares = new Map();
    for (let i = 0; i < this.count; ++i) {
      if (!wanted(i)) continue;
      const [x, y] = [0, 1].map((axis) => Math.floor(this.places[4 * i + axis] / units)), key = x * 65536 + y;
      const square = squares.get(key) ?? squares.set(key, {count: 0, sum: 0, x: x * size, y: y * size}).get(key);
      ++square.count;
      square.sum += this.places[4 * i + 2] * this.step;
    }
    return [...squares.values()].sort((a, b) => b.count - a.count).slice(0, most).map(({count, sum, x, y}) => (
      {count, box: [[x, y, sum / count - 2], [x + size, y + size, sum / count + 2]]}));
  }

  /** Of point i, in metres from the scene's origin. */
  position(i) {
    return [0, 1, 2].map((axis) => (this.places[4 * i + axis] + 0.5) * this.step);
  }

  /** World position of point i. */
  world(i) {
    const {origin, turn, voxel} = this.head;
    const at = this.position(i).map((value, axis) => value + origin[axis] * voxel);
    if (!turn) return at;
    return [0, 1, 2].map((row) => turn[3 * row] * at[0] + turn[3 * row + 1] * at[1] + turn[3 * row + 2] * at[2]);
  }

  /** The cell of point i, of which `edge` steps are an edge, in the frame that is turned so that up is z. */
  cell(i, edge) {
    const {origin, steps_per_voxel: per, shift} = this.head;
    return origin.map((start, axis) => Math.floor((start * per + this.places[4 * i + axis] * 2 ** shift) / edge));
  }

  /** Voxel of point i on the world's lattice; null where positions are too coarse to tell. */
  voxel(i) {
    const {steps_per_voxel: per, shift, turn, voxel} = this.head;
    if (2 ** shift > per) return null;
    return turn ? this.world(i).map((value) => Math.floor(value / voxel)) : this.cell(i, per);
  }

  sensor(scan) {
    return this.head.trajectory.slice(3 * scan, 3 * scan + 3);
  }
}
