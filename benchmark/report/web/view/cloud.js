// SPDX-License-Identifier: MIT
// Points on the graphics card: a geometry per kind of point, all of one cell sharing their buffers.
import {BufferAttribute, BufferGeometry, Color, DataTexture, Group, NearestFilter, Points,
        RawShaderMaterial, Vector2} from 'three';

import {HEIGHTS, between, labelColour, reasonColour, rgbOf} from './colours.js';
import {FALSE_POSITIVE, KEPT_STATIC, NOT_EVALUATED} from './scene_data.js';

export const COLOUR_BY = {verdict: 0, label: 1, reason: 2, height: 3};

// In GLSL ES 1.00, which every version of three.js takes as it is.
const VERTEX = `
precision highp float;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform float stepSize, pointSize, pixels, scan, mode, colourBy;
uniform vec2 heights;
uniform vec3 low, high, ground;
uniform float grow;
uniform sampler2D colours;
attribute vec4 position;
attribute vec4 tag;
varying vec3 shade;
void main() {
  bool present = abs(position.w - scan) < 0.5;
  if (mode > 0.5 && mode < 1.5 && position.w > scan + 0.5) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = 1.0;
    return;
  }
  vec4 seen = modelViewMatrix * vec4((position.xyz + 0.5) * stepSize, 1.0);
  gl_Position = projectionMatrix * seen;
  float height = clamp((position.z - heights.x) / (heights.y - heights.x), 0.0, 1.0);
  float column = colourBy < 1.5 ? tag.x : colourBy < 2.5 ? tag.y : height * 255.0;
  shade = colourBy < 0.5 ? mix(low, high, height)
                         : texture2D(colours, vec2(column + 0.5, colourBy - 0.5) / vec2(256.0, 3.0)).rgb;
  if (colourBy > 0.5 && colourBy < 2.5) shade *= 0.68 + 0.32 * height;  // Shape shows.
  float size = max(pointSize * pixels, 0.03 * pointSize * projectionMatrix[1][1] * 400.0 * pixels / -seen.z);
  size = min(size * grow, 14.0 * pixels);
  if (mode > 1.5) {
    shade = present ? shade : mix(shade, ground, 0.78);
    size = present ? size * 1.6 + pixels : size;
    if (present) gl_Position.z -= 0.0005 * gl_Position.w;
  }
  gl_PointSize = size;
}`;

const FRAGMENT = `
precision highp float;
varying vec3 shade;
void main() {
  vec2 from = gl_PointCoord - 0.5;
  if (dot(from, from) > 0.25) discard;
  gl_FragColor = vec4(shade, 1.0);
}`;

/** Rows: colour of each label, of each reason, of each height. */
function colourTable(head) {
  const data = new Uint8Array(256 * 3 * 4).fill(255);
  const put = (row, column, rgb) => data.set(rgb, 4 * (256 * row + column));
  head.labels.slice(0, 256).forEach((label, i) => put(0, i, rgbOf(labelColour(label.id, i))));
  for (let i = 0; i < 128; ++i) put(1, i, rgbOf(reasonColour(i - 1)));
  for (let i = 0; i < 256; ++i) put(2, i, between(HEIGHTS, i / 255));
  const table = new DataTexture(data, 256, 3);
  table.minFilter = table.magFilter = NearestFilter;
  table.needsUpdate = true;
  return table;
}

/** Whether a share of the points of this kind may do while the view moves. */
const mayBeThinned = (kind) => kind === KEPT_STATIC || kind === NOT_EVALUATED;

/** What all materials of the view share. */
export function sharedUniforms() {
  return {pointSize: {value: 2}, pixels: {value: 1}, scan: {value: 0}, mode: {value: 0},
          colourBy: {value: 0}, ground: {value: new Color()}};
}

/** In an order of which every beginning is spread over the whole; the same each time. */
function shuffled(numbers) {
  let state = 1;
  for (let i = numbers.length - 1; i > 0; --i) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    const other = Math.floor(state / 4294967296 * (i + 1));
    const number = numbers[i];
    numbers[i] = numbers[other];
    numbers[other] = number;
  }
  return numbers;
}

/** Numbers of the points of each kind. */
function indicesByKind(cell, count) {
  const lists = cell.shown.map((size) => new Uint32Array(size));
  const filled = [0, 0, 0, 0, 0];
  for (let i = 0; i < count; ++i) {
    const kind = cell.tags[4 * i + 2];
    lists[kind][filled[kind]++] = i;
  }
  return lists;
}

/** The buffers of a sequence; they live as long as it is shown. */
export class SceneBuffers {
  constructor(data) {
    this.data = data;
    this.place = new BufferAttribute(data.places, 4);
    this.table = colourTable(data.head);
  }
  dispose() {
    this.table.dispose();
  }
}

/** A cell's points: a group with one child per kind. */
export class Cloud {
  constructor(buffers, cell, uniforms) {
    const {data} = buffers;
    this.cell = cell;
    this.group = new Group();
    const tag = new BufferAttribute(cell.tags, 4);
    this.kinds = indicesByKind(cell, data.count).map((numbers, kind) => {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', buffers.place);  // Without one of this name nothing is drawn.
      geometry.setAttribute('tag', tag);
      geometry.setIndex(new BufferAttribute(mayBeThinned(kind) ? shuffled(numbers) : numbers, 1));
      const material = new RawShaderMaterial({
        vertexShader: VERTEX, fragmentShader: FRAGMENT,
        uniforms: {...uniforms, stepSize: {value: data.step}, colours: {value: buffers.table},
                   heights: {value: new Vector2(data.low, data.high)},
                   grow: {value: kind === KEPT_STATIC ? 1 : kind === FALSE_POSITIVE ? 1.3 : 1.5},
                   low: {value: new Color()}, high: {value: new Color()}},
      });
      const points = new Points(geometry, material);
      points.frustumCulled = false;
      points.renderOrder = kind;
      this.group.add(points);
      return points;
    });
  }

  /** @param colours [low, high] of each kind, as three's colours */
  paint(colours) {
    this.kinds.forEach((points, kind) => {
      points.material.uniforms.low.value.copy(colours[kind][0]);
      points.material.uniforms.high.value.copy(colours[kind][1]);
    });
  }

  show(visible) {
    this.kinds.forEach((points, kind) => { points.visible = visible[kind]; });
  }

  /** Draws this share of the points that may be thinned. */
  setDetail(share) {
    this.kinds.forEach(({geometry}, kind) => {
      if (mayBeThinned(kind)) geometry.setDrawRange(0, Math.ceil(geometry.index.count * share));
    });
  }

  dispose() {
    this.kinds.forEach((points) => {
      points.geometry.dispose();
      points.material.dispose();
    });
  }
}
