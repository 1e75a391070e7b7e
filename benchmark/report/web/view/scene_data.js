// SPDX-License-Identifier: MIT
// Reads what benchmark/report/pack.cpp wrote.

/** Kinds of points, by number. */
export const KEPT_STATIC = 0, FALSE_POSITIVE = 1, TRUE_POSITIVE = 2, FALSE_NEGATIVE = 3,
             NOT_EVALUATED = 4;

const IGNORED = 2, MOVING = 1;  // LabelClass

/** Bytes of the stream in the script element `id`. */
async function bytesOf(id) {
  const text = atob(document.getElementById(id).textContent);
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
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
export class SceneData {
  constructor(head) {
    this.head = head;
    this.count = head.points;
    /** Metres of a step of x, y and z. */
    this.step = head.voxel / head.steps_per_voxel * 2 ** head.shift;
    this.cells = new Map();
  }

  async load() {
    if (this.places) return;
    const bytes = await bytesOf(this.head.stream);
    const places = new Uint16Array(4 * this.count);
    for (let axis = 0; axis < 4; ++axis) {
      addDifferences(bytes, 2 * axis * this.count, this.count, places, axis);
    }
    this.labels = bytes.subarray(8 * this.count, 9 * this.count);
    this.places = places;
    this.findHeights();
  }

  /** Kind and reason of each point for cell number `number`, and how many there are of each kind. */
  async cell(number) {
    const known = this.cells.get(number);
    if (known) return known;
    const bytes = await bytesOf(`${this.head.stream}-${number}`);
    const tags = new Uint8Array(4 * this.count);  // Label, reason, kind, nothing.
    const shown = [0, 0, 0, 0, 0];
    const classes = this.head.labels.map((label) => label.kind);
    for (let i = 0; i < this.count; ++i) {
      const label = this.labels[i];
      const removed = bytes[i] & 1;
      const kind = classes[label] === IGNORED ? NOT_EVALUATED
          : classes[label] === MOVING ? (removed ? TRUE_POSITIVE : FALSE_NEGATIVE)
          : removed ? FALSE_POSITIVE : KEPT_STATIC;
      tags[4 * i] = label;
      tags[4 * i + 1] = bytes[i] >> 1;
      tags[4 * i + 2] = kind;
      tags[4 * i + 3] = removed;
      ++shown[kind];
    }
    const cell = {number, head: this.head.cells[number], tags, shown};
    this.cells.set(number, cell);
    return cell;
  }

  /** Steps along an axis below which a share of the points are. */
  quantiles(axis, shares) {
    const bins = new Uint32Array(65536);
    for (let i = 0; i < this.count; ++i) ++bins[this.places[4 * i + axis]];
    return shares.map((share) => {
      let sum = 0, place = 0;
      while (place < 65535 && sum + bins[place] <= share * this.count) sum += bins[place++];
      return place;
    });
  }

  /** Heights in steps below which 1 % and 99 % of the points are. */
  findHeights() {
    const [low, high] = this.quantiles(2, [0.01, 0.99]);
    this.low = low;
    this.high = Math.max(low + 1, high);
  }

  /** Corners of the box that holds the map in metres, without the outermost thousandth of the points
      at each side, which single far returns are. */
  box() {
    const ends = [0, 1, 2].map((axis) => this.quantiles(axis, [0.001, 0.999]));
    return {low: ends.map(([low]) => low * this.step),
            high: ends.map(([, high]) => (high + 1) * this.step)};
  }

  /** Of point i, in metres from the scene's origin. */
  position(i) {
    return [0, 1, 2].map((axis) => (this.places[4 * i + axis] + 0.5) * this.step);
  }

  /** Voxel of point i on the world's lattice; null where positions are too coarse to tell. */
  voxel(i) {
    const {origin, steps_per_voxel: per, shift, turn, voxel} = this.head;
    if (2 ** shift > per) return null;
    if (turn) return this.world(i).map((value) => Math.floor(value / voxel));
    return origin.map((start, axis) =>
        start + Math.floor(this.places[4 * i + axis] * 2 ** shift / per));
  }

  /** World position of point i. */
  world(i) {
    const {origin, turn, voxel} = this.head;
    const at = this.position(i).map((value, axis) => value + origin[axis] * voxel);
    if (!turn) return at;
    return [0, 1, 2].map((row) =>
        turn[3 * row] * at[0] + turn[3 * row + 1] * at[1] + turn[3 * row + 2] * at[2]);
  }

  sensor(scan) {
    return this.head.trajectory.slice(3 * scan, 3 * scan + 3);
  }
}
