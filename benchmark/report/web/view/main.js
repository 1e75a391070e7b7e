// SPDX-License-Identifier: MIT
// The 3-D view of a report.
import {Color} from 'three';

import {COLOUR_BY, Cloud, SceneBuffers, sharedUniforms} from './cloud.js';
import {rgbOf} from './colours.js';
import {element, fillSelect, hideComparison, makeKinds, switchKind, tellColours, tellKinds, tellPoint,
        tellThinning} from './panel.js';
import {pick} from './picking.js';
import {SceneData} from './scene_data.js';
import {Stage} from './stage.js';

const DARK = {ground: '#0e0f11', mark: '#f0e442', kept: ['#4c4f54', '#c4c7cc'], other: '#5f5570'};
const LIGHT = {ground: '#ffffff', mark: '#000000', kept: ['#c3c6ca', '#6a6d72'], other: '#b9a9cf'};

const isDark = () => {
  const set = document.documentElement.dataset.theme;
  return set ? set === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
};

class View {
  constructor(content) {
    this.scenes = content.scenes.map((head) => new SceneData(head));
    this.kindColours = content.colours;
    this.visible = [true, true, true, true, false];
    this.colourBy = 'verdict';
    this.clouds = [];
    this.uniforms = sharedUniforms();
    this.stage = new Stage(element('canvas'));
    this.setUpChoices();
    this.setUpScans();
    this.setUpCanvas();
    document.addEventListener('raymoval-theme', () => this.paint());
  }

  get data() {
    return this.scenes[Number(element('sequence').value)];
  }

  setUpChoices() {
    fillSelect(element('sequence'), this.scenes.map((scene, i) => [String(i), scene.head.sequence]), '0');
    element('sequence-label').style.display = this.scenes.length < 2 ? 'none' : '';
    element('sequence').addEventListener('change', () => this.openScene());
    for (const id of ['left', 'right']) element(id).addEventListener('change', () => this.openCells());
    const unlabelled = this.scenes.every((scene) => scene.head.unlabelled);
    if (unlabelled) hideComparison();
    makeKinds(unlabelled, [...this.kindColours, '#a596bd'], this.visible, (kind, shown) => this.showKind(kind, shown));
    for (const radio of document.querySelectorAll('input[name="colour"]')) {
      radio.addEventListener('change', () => this.setColourBy(radio.value));
    }
    element('path').addEventListener('change', () => {
      this.stage.path.visible = this.stage.sensor.visible = element('path').checked;
      this.stage.request();
    });
    element('size').addEventListener('input', () => {
      this.uniforms.pointSize.value = Number(element('size').value);
      this.stage.request();
    });
    element('whole').addEventListener('click', () => this.lookAtAll());
    element('above').addEventListener('click', () => this.lookAtAll(true));
    element('sensor').addEventListener('click', () => this.lookFromSensor());
    element('full').addEventListener('click', () => {
      if (document.fullscreenElement) document.exitFullscreen();
      else element('viewer').requestFullscreen();
    });
  }

  setUpScans() {
    element('scan').addEventListener('input', () => {
      if (element('mode').value === '0') element('mode').value = '2';
      this.tellScan();
    });
    element('mode').addEventListener('change', () => this.tellScan());
    element('play').addEventListener('click', () => this.play(this.timer === undefined));
  }

  play(on) {
    clearInterval(this.timer);
    this.timer = undefined;
    element('play').setAttribute('aria-pressed', String(on));
    element('play').textContent = on ? 'Pause' : 'Play';
    if (!on) return;
    if (element('mode').value === '0') element('mode').value = '2';
    this.timer = setInterval(() => this.stepScan(1, true), 120);
  }

  stepScan(by, around = false) {
    const slider = element('scan'), last = Number(slider.max);
    let next = Number(slider.value) + by;
    if (around && next > last) next = 0;
    slider.value = String(Math.min(last, Math.max(0, next)));
    if (element('mode').value === '0') element('mode').value = '2';
    this.tellScan();
  }

  tellScan() {
    const scan = Number(element('scan').value), {head} = this.data;
    this.uniforms.scan.value = scan;
    this.uniforms.mode.value = Number(element('mode').value);
    const name = `scan ${scan} of ${head.scans.length} (${head.scans[scan]})`;
    element('scan-name').textContent = name;
    element('scan').setAttribute('aria-valuetext', name);
    this.stage.sensor.position.set(...this.data.sensor(scan));
    this.stage.request();
  }

  setUpCanvas() {
    const canvas = element('canvas');
    let down = null;
    canvas.addEventListener('pointerdown', (event) => { down = [event.clientX, event.clientY]; });
    canvas.addEventListener('pointerup', (event) => {
      if (down === null || event.button !== 0) return;
      const moved = Math.hypot(event.clientX - down[0], event.clientY - down[1]);
      down = null;
      if (moved < 4) this.choose(event.offsetX, event.offsetY);
    });
    canvas.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey || !this.onKey(event)) return;
      event.preventDefault();
    });
  }

  onKey(event) {
    const turn = 0.08, shift = event.shiftKey;
    switch (event.key) {
      case 'ArrowLeft': shift ? this.stage.move(-0.08, 0) : this.stage.turn(-turn, 0); return true;
      case 'ArrowRight': shift ? this.stage.move(0.08, 0) : this.stage.turn(turn, 0); return true;
      case 'ArrowUp': shift ? this.stage.move(0, 0.08) : this.stage.turn(0, turn); return true;
      case 'ArrowDown': shift ? this.stage.move(0, -0.08) : this.stage.turn(0, -turn); return true;
      case '+': case '=': this.stage.zoom(0.88); return true;
      case '-': this.stage.zoom(1.14); return true;
      case ',': this.stepScan(-1); return true;
      case '.': this.stepScan(1); return true;
      case 'Home': this.lookAtAll(); return true;
      case 'Escape': this.forgetPoint(); return true;
      case '1': case '2': case '3': case '4': switchKind(event.key); return true;
    }
    return false;
  }

  async openScene() {
    this.play(false);
    const data = this.data;
    const names = data.head.cells.map((cell, i) => [String(i), cell.name]);
    const first = Math.max(0, data.head.cells.findIndex((cell) => !cell.control));
    fillSelect(element('left'), names, String(first));
    fillSelect(element('right'), [['', 'nothing'], ...names], '');
    this.tell('Unpacking points ...');
    await data.load();
    this.buffers?.dispose();
    this.buffers = new SceneBuffers(data);
    element('scan').max = String(data.head.scans.length - 1);
    element('scan').value = '0';
    element('mode').value = '0';
    this.stage.setTrajectory(data.head.trajectory);
    this.forgetPoint();
    await this.openCells();
    this.tellScan();
    tellThinning(data.head);
    this.lookAtAll();
  }

  async openCells() {
    const data = this.data;
    const chosen = [element('left').value, element('right').value].filter((value) => value !== '');
    const cells = [];
    for (const number of chosen) cells.push(await data.cell(Number(number)));
    if (data !== this.data) return;  // Another sequence was chosen meanwhile.
    this.clouds.forEach((cloud) => cloud.dispose());
    this.clouds = cells.map((cell) => new Cloud(this.buffers, cell, this.uniforms));
    this.clouds.forEach((cloud) => cloud.show(this.visible));
    element('viewer').classList.toggle('split', cells.length === 2);
    element('left-name').textContent = cells[0].head.name;
    element('right-name').textContent = cells.length === 2 ? cells[1].head.name : '';
    this.stage.setClouds(this.clouds);
    tellKinds(data.head, cells);
    this.paint();
    this.tell('');
    if (this.chosen !== undefined) this.tellChosen();
  }

  get cells() {
    return this.clouds.map((cloud) => cloud.cell);
  }

  showKind(kind, shown) {
    this.visible[kind] = shown;
    this.clouds.forEach((cloud) => cloud.show(this.visible));
    this.stage.request();
  }

  setColourBy(by) {
    this.colourBy = by;
    this.uniforms.colourBy.value = COLOUR_BY[by];
    tellColours(by, this.data.head, this.cells);
    this.stage.request();
  }

  paint() {
    const theme = isDark() ? DARK : LIGHT;
    const rgb = (hex) => rgbOf(hex).map((value) => value / 255);
    const colour = (hex, factor) => new Color(...rgb(hex).map((value) => value * factor));
    const kinds = this.kindColours.map((hex) => isDark() ? [colour(hex, 0.85), colour(hex, 1.15)]
                                                         : [colour(hex, 0.8), colour(hex, 1)]);
    kinds[0] = theme.kept.map((hex) => colour(hex, 1));
    kinds.push([colour(theme.other, 1), colour(theme.other, 1)]);
    this.clouds.forEach((cloud) => cloud.paint(kinds));
    this.uniforms.ground.value.setRGB(...rgb(theme.ground));
    this.uniforms.pixels.value = Math.min(window.devicePixelRatio || 1, 2);
    this.stage.setColours(rgb(theme.ground), rgb(theme.mark));
    tellColours(this.colourBy, this.data.head, this.cells);
    this.stage.request();
  }

  /** Shows the whole map, obliquely or from above. */
  lookAtAll(fromAbove = false) {
    const {low, high} = this.data.box();
    const first = this.data.sensor(0), last = this.data.sensor(this.data.head.scans.length - 1);
    const angle = Math.atan2(last[1] - first[1], last[0] - first[0]) + 2.2;
    this.stage.lookAtBox(low, high, fromAbove ? [0.001 * Math.cos(angle), 0.001 * Math.sin(angle), 1]
                                              : [Math.cos(angle), Math.sin(angle), 0.75]);
  }

  lookFromSensor() {
    const scan = Number(element('scan').value), here = this.data.sensor(scan);
    const count = this.data.head.scans.length;
    const a = this.data.sensor(Math.max(0, scan - 1)), b = this.data.sensor(Math.min(count - 1, scan + 1));
    const angle = Math.atan2(b[1] - a[1], b[0] - a[0]);
    this.stage.look([here[0] + 8 * Math.cos(angle), here[1] + 8 * Math.sin(angle), here[2] - 1],
                    [-16 * Math.cos(angle), -16 * Math.sin(angle), 6]);
  }

  /** Tells the point under a place of the canvas. @return its number, or -1 */
  choose(x, y) {
    if (this.clouds.length === 0) return -1;
    const at = this.stage.locate(x, y), {mode, scan} = this.uniforms;
    const upTo = mode.value === 1 ? scan.value : Infinity;
    const found = pick(this.stage, this.data, this.cells[at.side], at, this.visible,
                       (of) => of <= upTo);
    if (found >= 0) {
      this.chosen = found;
      this.stage.mark(this.data.position(found));
      this.tellChosen();
    }
    return found;
  }

  tellChosen() {
    tellPoint(this.data, this.cells, this.chosen);
  }

  forgetPoint() {
    this.chosen = undefined;
    this.stage.mark(null);
    element('point').replaceChildren();
  }

  tell(text) {
    element('view-status').textContent = text;
  }

  /** RGBA of the picture as it is drawn now, for tests. */
  pixels() {
    this.stage.render();
    const gl = this.stage.renderer.getContext();
    const {drawingBufferWidth: width, drawingBufferHeight: height} = gl;
    const data = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
    return {width, height, data};
  }
}

function start() {
  const source = element('scenes');
  if (!source || !element('viewer')) return;
  const open = async () => {
    try {
      const view = new View(JSON.parse(source.textContent));
      window.raymovalView = view;
      await view.openScene();
      view.ready = true;
    } catch (error) {
      element('view-status').textContent =
          `The 3-D view cannot be shown (${error.message}). It needs a browser with WebGL.`;
      window.raymovalViewError = error;
    }
  };
  const watcher = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    watcher.disconnect();
    open();
  }, {rootMargin: '600px'});
  watcher.observe(element('viewer'));
}

start();
