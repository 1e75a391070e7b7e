// SPDX-License-Identifier: MIT
// The points of a page, as benchmark/report/pack.cpp wrote them.

const element = (id) => document.getElementById(id);
const grouped = (number) => number.toLocaleString('en');
const isDark = () => {
  const set = document.documentElement.dataset.theme;
  return set ? set === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
};

/** A new element with attributes, and text or children. */
function make(tag, attributes, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

/** 256 colours between two. */
const shades = (low, high) => Array.from({length: 256}, (_, i) => low.map((value, axis) => value + (high[axis] - value) * i / 255));
/** Of kept points, from low to high. */
const keptShades = () => shades(...(isDark() ? ['#4c4f54', '#c4c7cc'] : ['#c3c6ca', '#6a6d72']).map(rgbOf));
const rgbOf = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

/** Bytes of the stream in the script element `id`. */
async function bytesOf(id) {
  const text = atob(element(id).textContent);
  const packed = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
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

  async load() {
    if (this.places) return;
    const bytes = await bytesOf(this.head.stream);
    const places = new Uint16Array(4 * this.count);
    for (let axis = 0; axis < 4; ++axis) addDifferences(bytes, 2 * axis * this.count, this.count, places, axis);
    this.labels = bytes.subarray(8 * this.count, 9 * this.count);
    this.places = places;
    const [low, high] = this.quantiles(2, [0.01, 0.99]);
    this.low = low;
    this.high = Math.max(low + 1, high);
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
