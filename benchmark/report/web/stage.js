// SPDX-License-Identifier: MIT
// The canvas of a page: points drawn with WebGL, or on a plain canvas where there is no WebGL.

// `paint` is a colour and how a point looks, see `painted`.
const VERTEX = `
precision highp float;
uniform mat4 matrix;
uniform float unit, size, pixels, scan, mode;
uniform vec3 ground;
attribute vec4 position, paint;
varying vec3 shade;
void main() {
  float look = floor(paint.a * 255.0 + 0.5);
  bool present = abs(position.w - scan) < 0.5;
  gl_Position = matrix * vec4((position.xyz + 0.5) * unit, 1.0);
  if (look < 0.5 || (mode == 1.0 && position.w > scan + 0.5)) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  float large = max(size, 12.0 * size / gl_Position.w) * (0.6 + 0.4 * look);
  shade = paint.rgb;
  if (mode == 2.0) {
    if (present) large = large * 1.6 + 1.0; else shade = mix(shade, ground, 0.78);
  }
  gl_Position.z -= 0.0003 * (look + (mode == 2.0 && present ? 2.0 : 0.0)) * gl_Position.w;
  gl_PointSize = min(large, 14.0) * pixels;
}`;

const FRAGMENT = `
precision highp float;
uniform bool round;
varying vec3 shade;
void main() {
  vec2 from = gl_PointCoord - 0.5;
  if (round && dot(from, from) > 0.25) discard;
  gl_FragColor = vec4(shade, 1.0);
}`;

const FIELD = Math.tan(25 * Math.PI / 180), NEAR = 0.3, FAR = 5000;
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** The canvas: one camera, one or two paints of the same points beside each other. */
class Stage {
  constructor(canvas) {
    Object.assign(this, {canvas, target: [0, 0, 0], azimuth: 0, polar: 0.7, range: 50, size: 2, scan: 0, mode: 0,
                         detail: 1, path: true, chosen: null, paints: [], buffers: []});
    this.gl = canvas.getContext('webgl', {antialias: false, powerPreference: 'high-performance'});
    if (this.gl) this.setUp(this.gl);
    else this.flat = canvas.getContext('2d');
    this.listen();
    new ResizeObserver(() => this.request()).observe(canvas.parentElement);
    canvas.addEventListener('webglcontextrestored', () => location.reload());
    addEventListener('beforeprint', () => this.render());
  }

  setUp(gl) {
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, 'position');
    gl.bindAttribLocation(program, 1, 'paint');
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.SCISSOR_TEST);
    gl.enableVertexAttribArray(0);
    this.at = (name) => gl.getUniformLocation(program, name);
    this.places = gl.createBuffer();
    this.lines = gl.createBuffer();
  }

  /** Shows points while they are unpacked, in one colour, along the path of the sensor. */
  async unpack(data, azimuth) {
    const {gl} = this;
    const loading = data.load(({start, count}) => {
      if (this.data !== data) return;  // Other points were chosen meanwhile.
      element('view-status').textContent = `Unpacking points: ${Math.floor(100 * data.loaded / data.count)} %`;
      if (gl) {
        gl.bindBuffer(gl.ARRAY_BUFFER, this.places);
        gl.bufferSubData(gl.ARRAY_BUFFER, 8 * start, data.places.subarray(4 * start, 4 * (start + count)));
      }
      this.request();
    });
    Object.assign(this, {data, chosen: null});
    if (gl) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.places);
      gl.bufferData(gl.ARRAY_BUFFER, data.places, gl.STATIC_DRAW);
    }
    this.setPaints([new Uint32Array(data.count).fill(painted([128, 128, 128], 1))]);
    this.lookAt(data.pathBox(), azimuth);
    await loading;
  }

  /** Ranges of points whose chunks may be in sight. Points are up to 14 pixels large. */
  rangesInSight() {
    const rows = this.rows(), ranges = [];
    for (const {start, count, box} of this.data.chunks) {
      const outside = [0, 0, 0, 0, 0];
      for (let corner = 0; corner < 8; ++corner) {
        const place = [0, 1, 2].map((axis) => box[corner >> axis & 1][axis]);
        const [x, y, , w] = rows.map((row) => dot(row, place) + row[3]), edge = 1.03 * w;
        [x > edge, x < -edge, y > edge, y < -edge, w < NEAR].forEach((is, side) => { outside[side] += is; });
      }
      if (outside.includes(8)) continue;
      const last = ranges[ranges.length - 1];
      if (last && last.start + last.count === start) last.count += count;
      else ranges.push({start, count});
    }
    return ranges;
  }

  /** @param paints one or two arrays of `painted` words, one for each point */
  setPaints(paints) {
    const {gl} = this;
    this.paints = paints;
    this.ground = colourOf('--view-ground');
    this.mark = colourOf('--mark');
    if (gl) {
      paints.forEach((paint, side) => {
        this.buffers[side] ??= gl.createBuffer();
        gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[side]);
        gl.bufferData(gl.ARRAY_BUFFER, paint, gl.DYNAMIC_DRAW);
      });
    }
    this.request();
  }

  /** Draws soon, once. Where frames come late, fewer points are drawn until the view is at rest. */
  request() {
    if (this.pending) return;
    this.pending = true;
    const asked = performance.now();
    requestAnimationFrame(() => {
      this.pending = false;
      // While the view is turned, the time since the last frame counts; otherwise it was a pause.
      const now = performance.now(), waited = now - (asked - this.drawn < 50 ? this.drawn : asked);
      this.drawn = now;
      const factor = waited > 50 ? Math.max(0.3, 40 / waited) : waited < 25 ? 1.1 : 1;
      this.detail = Math.min(1, Math.max(60000 / (1 + (this.data?.loaded ?? 0)), this.detail * factor));
      this.render(this.detail);
      clearTimeout(this.rest);
      if (this.detail < 1) this.rest = setTimeout(() => this.render(), 400);
    });
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    Object.assign(this, {width, height, ratio, each: width / Math.max(1, this.paints.length)});
    const pixels = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== pixels[0]) this.canvas.width = pixels[0];
    if (this.canvas.height !== pixels[1]) this.canvas.height = pixels[1];
    return width > 0 && height > 0;
  }

  /** Unit vectors: from the target to the eye, to the right, up. */
  axes() {
    const {azimuth: a, polar: p} = this, c = Math.cos(p), s = Math.sin(p);
    return [[Math.cos(a) * c, Math.sin(a) * c, s], [-Math.sin(a), Math.cos(a), 0],
            [-s * Math.cos(a), -s * Math.sin(a), c]];
  }

  eye() {
    const [back] = this.axes();
    return this.target.map((value, axis) => value + this.range * back[axis]);
  }

  /** Rows of the matrix from metres to x, y, z and w of the clip space. */
  rows() {
    const [back, right, up] = this.axes(), eye = this.eye();
    const row = (axis, factor, plus = 0) => [...axis.map((value) => value * factor), plus - factor * dot(axis, eye)];
    const depth = (FAR + NEAR) / (FAR - NEAR);
    return [row(right, this.height / (FIELD * this.each)), row(up, 1 / FIELD),
            row(back, -depth, -2 * FAR * NEAR / (FAR - NEAR)), row(back, -1)];
  }

  /** @param detail share of the points that is drawn */
  render(detail = 1) {
    if (!this.resize() || this.paints.length === 0) return;
    if (!this.gl) return this.renderFlat();
    const {gl, at, data, ratio} = this, rows = this.rows();
    // WebGL allows at most 255 bytes between points, of which each has eight.
    const each = Math.floor(this.canvas.width / this.paints.length), skip = Math.min(31, Math.max(1, Math.round(1 / detail)));
    const ranges = this.rangesInSight();
    const matrix = [0, 1, 2, 3].flatMap((column) => rows.map((row) => row[column]));
    gl.uniformMatrix4fv(at('matrix'), false, matrix);
    gl.uniform1f(at('pixels'), ratio);
    gl.uniform1f(at('scan'), this.scan);
    gl.uniform3f(at('ground'), ...this.ground.map((value) => value / 255));
    gl.clearColor(...this.ground.map((value) => value / 255), 1);
    this.paints.forEach((_, side) => {
      gl.viewport(side * each, 0, each, this.canvas.height);
      gl.scissor(side * each, 0, each, this.canvas.height);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.uniform1f(at('unit'), data.step);
      gl.uniform1f(at('size'), this.size);
      gl.uniform1f(at('mode'), this.mode);
      gl.uniform1i(at('round'), 1);
      gl.enableVertexAttribArray(1);
      for (const {start, count} of ranges) {
        gl.bindBuffer(gl.ARRAY_BUFFER, this.places);
        gl.vertexAttribPointer(0, 4, gl.UNSIGNED_SHORT, false, 8 * skip, 8 * start);
        gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[side]);
        gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, 4 * skip, 4 * start);
        gl.drawArrays(gl.POINTS, 0, Math.ceil(count / skip));
      }
      gl.disableVertexAttribArray(1);
      gl.uniform1f(at('mode'), 0);
      gl.uniform1f(at('unit'), 1);
      if (this.path) {
        this.line(data.head.trajectory, gl.LINE_STRIP, 1);
        this.line(data.sensor(this.scan), gl.POINTS, 8);
      }
      if (this.chosen) this.line(this.chosen, gl.POINTS, 11);
    });
  }

  /** Draws places in metres in the colour of marks. */
  line(places, kind, size) {
    const {gl} = this, count = places.length / 3;
    const values = new Float32Array(4 * count);
    for (let i = 0; i < count; ++i) values.set(places.slice(3 * i, 3 * i + 3).map((value) => value - 0.5), 4 * i);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.lines);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STREAM_DRAW);
    gl.vertexAttribPointer(0, 4, gl.FLOAT, false, 0, 0);
    gl.vertexAttrib4f(1, ...this.mark.map((value) => value / 255), 1 / 255);
    gl.uniform1f(this.at('size'), size);
    gl.uniform1i(this.at('round'), kind === gl.POINTS ? 1 : 0);
    gl.drawArrays(kind, 0, count);
  }

  /** Draws a pixel for each point, the marked ones last. */
  renderFlat() {
    const {width, height} = this.canvas, image = this.flat.createImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer);
    pixels.fill(painted(this.ground, 255));
    this.paints.forEach((paint, side) => {
      for (const look of [1, 2, 3]) {
        this.eachSeen(side, (i, x, y) => {
          if (paint[i] >>> 24 !== look) return;
          const column = Math.floor((x + side * this.each) * this.ratio), line = Math.floor(y * this.ratio);
          const at = line * width + column, colour = (paint[i] | 255 << 24) >>> 0;
          pixels[at] = colour;
          if (look > 1 && column + 1 < width) pixels[at + 1] = colour;
        });
      }
    });
    this.flat.putImageData(image, 0, 0);
  }

  /** Calls with number, place in pixels and depth of each point that is shown within a side. */
  eachSeen(side, visit) {
    const {places, step} = this.data, paint = this.paints[side], [a, b, , d] = this.rows();
    for (const {start, count} of this.rangesInSight()) for (let i = start; i < start + count; ++i) {
      if (paint[i] >>> 24 === 0 || (this.mode === 1 && places[4 * i + 3] > this.scan)) continue;
      const x = (places[4 * i] + 0.5) * step, y = (places[4 * i + 1] + 0.5) * step, z = (places[4 * i + 2] + 0.5) * step;
      const w = d[0] * x + d[1] * y + d[2] * z + d[3];
      if (w <= NEAR) continue;
      const right = ((a[0] * x + a[1] * y + a[2] * z + a[3]) / w + 1) / 2 * this.each;
      const down = (1 - (b[0] * x + b[1] * y + b[2] * z + b[3]) / w) / 2 * this.height;
      if (right >= 0 && right < this.each && down >= 0 && down < this.height) visit(i, right, down, w);
    }
  }

  /** Side, and place in it in pixels, of a place on the canvas. */
  locate(x, y) {
    const side = Math.max(0, Math.min(this.paints.length - 1, Math.floor(x / this.each)));
    return {side, x: x - side * this.each, y};
  }

  /**
   * The point under a place of the canvas, or -1: of those that cover it the one that is nearest to
   * the viewer, else one within 7 pixels, where each pixel off the place weighs much.
   */
  pick(x, y) {
    const at = this.locate(x, y);
    let best = -1, least = Infinity;
    this.eachSeen(at.side, (i, right, down, depth) => {
      const off = (right - at.x) ** 2 + (down - at.y) ** 2;
      const score = depth * (1 + Math.max(0, off - 2.25));
      if (off <= 49 && score < least) [best, least] = [i, score];
    });
    return best;
  }

  /** Looks at the box between two corners, from as near as shows all of it. */
  lookAt([low, high], azimuth = this.azimuth, polar = 0.65) {
    this.resize();
    Object.assign(this, {azimuth, polar, target: low.map((value, axis) => (value + high[axis]) / 2)});
    const [back, right, up] = this.axes();
    const tangents = [FIELD * this.each / Math.max(1, this.height), FIELD].map((value) => value / 1.04);
    this.range = 5;
    for (let corner = 0; corner < 8; ++corner) {
      const offset = this.target.map((value, axis) => (corner >> axis & 1 ? high : low)[axis] - value);
      [right, up].forEach((axis, i) => {
        this.range = Math.max(this.range, dot(offset, back) + Math.abs(dot(offset, axis)) / tangents[i]);
      });
    }
    this.request();
  }

  /** Turns by angles in radians about the target, never over the top. */
  turn(azimuth, polar) {
    this.azimuth += azimuth;
    this.polar = Math.min(Math.PI / 2 - 0.001, Math.max(-1.5, this.polar + polar));
    this.request();
  }

  /** Moves along the ground by shares of the distance to the target. */
  move(right, forward) {
    const c = Math.cos(this.azimuth) * this.range, s = Math.sin(this.azimuth) * this.range;
    this.shift([-s * right - c * forward, c * right - s * forward, 0]);
  }

  /** Moves the picture by pixels to the right and down, at the distance of the target. */
  pan(right, down) {
    const [, x, y] = this.axes(), pixel = 2 * this.range * FIELD / this.height;
    this.shift(x.map((value, axis) => pixel * (down * y[axis] - right * value)));
  }

  shift(step) {
    this.target = this.target.map((value, axis) => value + step[axis]);
    this.request();
  }

  /** The point at the distance of the target under a place of the canvas. */
  under(x, y) {
    const at = this.locate(x, y), [, right, up] = this.axes(), pixel = 2 * this.range * FIELD / this.height;
    return this.target.map((value, axis) =>
        value + pixel * ((at.x - this.each / 2) * right[axis] + (this.height / 2 - at.y) * up[axis]));
  }

  /** Scales the distance to the target; what is under the place stays there. */
  zoom(factor, x = this.each / 2, y = this.height / 2) {
    const fixed = this.under(x, y);
    this.target = this.target.map((value, axis) => fixed[axis] + factor * (value - fixed[axis]));
    this.range *= factor;
    this.request();
  }

  /** A drag turns; with the right button, Shift or two fingers it moves; the wheel, the middle button
      and two fingers zoom. `onDrag` and `onKey` may take drags and keys for themselves, and `onClick` gets a click's place. */
  listen() {
    const {canvas} = this, pressed = new Map();  // The last event of each pointer that is down.
    let start = null;
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      pressed.set(event.pointerId, event);
      start = pressed.size === 1 && event.button === 0 ? event : null;
      this.taken = start !== null && !event.shiftKey && (this.onDrag?.('start', event) ?? false);
    });
    for (const end of ['pointerup', 'pointercancel']) {
      canvas.addEventListener(end, (event) => {
        pressed.delete(event.pointerId);
        if (this.taken) this.onDrag('end', event);
        else if (start && end === 'pointerup' && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) < 4) {
          this.onClick?.(event.offsetX, event.offsetY, event);
        }
        this.taken = start = null;
      });
    }
    canvas.addEventListener('pointermove', (event) => {
      const before = pressed.get(event.pointerId);
      if (!before) return;
      pressed.set(event.pointerId, event);
      if (this.taken) return this.onDrag('move', event);
      const right = event.clientX - before.clientX, down = event.clientY - before.clientY;
      const other = [...pressed.values()].find(({pointerId}) => pointerId !== event.pointerId);
      if (other) {
        const apart = ({clientX, clientY}) => Math.max(1, Math.hypot(clientX - other.clientX, clientY - other.clientY));
        this.pan(right / 2, down / 2);
        this.zoom(apart(before) / apart(event), (event.offsetX + other.offsetX) / 2, (event.offsetY + other.offsetY) / 2);
      } else if (event.buttons & 4) {
        this.zoom(0.95 ** (-down / 100), event.offsetX, event.offsetY);
      } else if (event.buttons & 2 || event.shiftKey || event.ctrlKey || event.metaKey) {
        this.pan(right, down);
      } else {
        this.turn(-right * 2 * Math.PI / this.height, down * 2 * Math.PI / this.height);
      }
    });
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      // Browsers report a pinch on a touchpad as small steps of the wheel with Ctrl.
      const pixels = event.deltaY * [1, 16, 100][event.deltaMode] * (event.ctrlKey ? 10 : 1);
      this.zoom(0.95 ** (-pixels / 100), event.offsetX, event.offsetY);
    }, {passive: false});
    canvas.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey || !(this.onKey?.(event) || this.onArrow(event))) return;
      event.preventDefault();
    });
  }

  onArrow({key, shiftKey}) {
    const steps = {ArrowLeft: [-0.08, 0], ArrowRight: [0.08, 0], ArrowUp: [0, 0.08], ArrowDown: [0, -0.08]};
    if (steps[key]) shiftKey ? this.move(...steps[key]) : this.turn(...steps[key]);
    else if (key === '+' || key === '=') this.zoom(0.88);
    else if (key === '-') this.zoom(1.14);
    else return false;
    return true;
  }

  /** RGBA of the picture as it is drawn now, for tests. */
  pixels() {
    this.render();
    const {gl} = this, {width, height} = this.canvas, data = new Uint8Array(4 * width * height);
    if (gl) gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
    else data.set(this.flat.getImageData(0, 0, width, height).data);
    return {width, height, data};
  }
}

/** The bar below the canvas: all scans, those up to one, or one that is marked. */
class ScanBar {
  constructor(stage, changed) {
    Object.assign(this, {stage, changed});
    element('scan').addEventListener('input', () => this.step(0));
    element('mode').addEventListener('change', () => this.show());
    element('play').addEventListener('click', () => this.play(this.timer === undefined));
    for (const [key, by] of [[',', -1], ['.', 1]]) {
      stage.canvas.addEventListener('keydown', (event) => { if (event.key === key) this.step(by); });
    }
  }

  open(head) {
    this.play(false);
    this.head = head;
    Object.assign(element('scan'), {max: String(head.scans.length - 1), value: '0'});
    element('mode').value = '0';
    this.show();
  }

  play(on) {
    clearInterval(this.timer);
    this.timer = on ? setInterval(() => this.step(1, true), 120) : undefined;
    element('play').setAttribute('aria-pressed', String(on));
    element('play').textContent = on ? 'Pause' : 'Play';
  }

  step(by, around = false) {
    const slider = element('scan'), last = Number(slider.max), next = Number(slider.value) + by;
    slider.value = String(around && next > last ? 0 : Math.min(last, Math.max(0, next)));
    if (element('mode').value === '0') element('mode').value = '2';
    this.show();
  }

  show() {
    const scan = Number(element('scan').value), {scans} = this.head;
    Object.assign(this.stage, {scan, mode: Number(element('mode').value)});
    element('scan-name').textContent = `scan ${scan} of ${scans.length} (${scans[scan]})`;
    element('scan').setAttribute('aria-valuetext', element('scan-name').textContent);
    this.changed?.();
    this.stage.request();
  }
}

/** Calls `open` when the view comes into sight, and shows its error. */
function startView(open) {
  if (!element('viewer')) return;
  const watcher = new IntersectionObserver(async (entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    watcher.disconnect();
    try {
      await open();
    } catch (error) {
      element('view-status').textContent = `The view cannot be shown: ${error.message}`;
      window.raymovalViewError = error;
    }
  }, {rootMargin: '600px'});
  watcher.observe(element('viewer'));
}
