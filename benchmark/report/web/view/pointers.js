// SPDX-License-Identifier: MIT
// Mouse, pen and fingers on the canvas. OrbitControls of three.js would do most of it, but Debian's
// version does not zoom towards the pointer and shows a focus ring at each click.

/** A step of the wheel in pixels, by its deltaMode: pixels, lines, pages. */
const WHEEL_UNITS = [1, 16, 100];

/** A drag turns; with the right button, Shift or two fingers it moves; the wheel, the middle button
    and two fingers zoom. */
export function listenToPointers(stage) {
  const {canvas} = stage;
  const pressed = new Map();  // The last event of each pointer that is down.
  const zoom = (factor, {offsetX, offsetY}) => stage.zoom(factor, stage.locate(offsetX, offsetY));

  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pressed.set(event.pointerId, event);
  });
  for (const end of ['pointerup', 'pointercancel']) {
    canvas.addEventListener(end, (event) => pressed.delete(event.pointerId));
  }
  canvas.addEventListener('pointermove', (event) => {
    const before = pressed.get(event.pointerId);
    if (!before) return;
    pressed.set(event.pointerId, event);
    const right = event.clientX - before.clientX, down = event.clientY - before.clientY;
    const other = [...pressed.values()].find(({pointerId}) => pointerId !== event.pointerId);
    if (other) {
      const apart = ({clientX, clientY}) =>
          Math.max(1, Math.hypot(clientX - other.clientX, clientY - other.clientY));
      stage.pan(right / 2, down / 2);
      zoom(apart(before) / apart(event), {offsetX: (event.offsetX + other.offsetX) / 2,
                                          offsetY: (event.offsetY + other.offsetY) / 2});
    } else if (event.buttons & 4) {
      zoom(0.95 ** (-down / 100), event);
    } else if (event.buttons & 2 || event.shiftKey || event.ctrlKey || event.metaKey) {
      stage.pan(right, down);
    } else {
      const pixel = 2 * Math.PI / stage.height;
      stage.turn(-right * pixel, down * pixel);
    }
  });
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    // Browsers report a pinch on a touchpad as small steps of the wheel with Ctrl.
    const pixels = event.deltaY * WHEEL_UNITS[event.deltaMode] * (event.ctrlKey ? 10 : 1);
    zoom(0.95 ** (-pixels / 100), event);
  }, {passive: false});
}
