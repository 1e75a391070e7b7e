// SPDX-License-Identifier: MIT
import {Matrix4} from 'three';

const REACH = 7, COVERED = 1.5;  // Pixels; about what a point that is drawn covers around itself.

/**
 * The point under a place of the canvas, or -1: of those that cover it the one that is nearest to
 * the viewer, else one within reach, where each pixel off the place weighs much.
 * @param at what Stage.locate gave
 * @param visible whether each kind is shown
 * @param filter whether a scan's points are shown
 */
export function pick(stage, data, cell, at, visible, filter) {
  stage.camera.updateMatrixWorld();
  const m = new Matrix4().multiplyMatrices(stage.camera.projectionMatrix,
                                           stage.camera.matrixWorldInverse).elements;
  const {places, count, step} = data;
  const {tags} = cell;
  const wide = at.each / 2, high = stage.height / 2;
  let best = -1, bestScore = Infinity;
  for (let i = 0; i < count; ++i) {
    if (!visible[tags[4 * i + 2]] || !filter(places[4 * i + 3])) continue;
    const x = (places[4 * i] + 0.5) * step, y = (places[4 * i + 1] + 0.5) * step,
          z = (places[4 * i + 2] + 0.5) * step;
    const w = m[3] * x + m[7] * y + m[11] * z + m[15];
    if (w <= 0.3) continue;
    const dx = ((m[0] * x + m[4] * y + m[8] * z + m[12]) / w - at.x) * wide;
    const dy = ((m[1] * x + m[5] * y + m[9] * z + m[13]) / w - at.y) * high;
    const off = dx * dx + dy * dy;
    if (off > REACH * REACH) continue;
    const score = w * (1 + Math.max(0, off - COVERED * COVERED));
    if (score < bestScore) {
      best = i;
      bestScore = score;
    }
  }
  return best;
}
