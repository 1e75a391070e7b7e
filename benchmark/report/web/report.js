// SPDX-License-Identifier: MIT
// The 3-D view of a report: what each method removed and kept, rightly or wrongly.

const KEPT_STATIC = 0, FALSE_POSITIVE = 1, TRUE_POSITIVE = 2, FALSE_NEGATIVE = 3, NOT_EVALUATED = 4;
const KIND_NAMES = ['static, kept', 'static, lost', 'moving, removed', 'moving, kept', 'not evaluated'];
/** Of page.css. In shades of grey they differ, too. */
const KIND_COLOURS = ['--kept-high', '--kind-1', '--kind-2', '--kind-3', '--kind-4'];
const KIND_WORDS = ['kept, rightly (static)', 'removed, wrongly (static)', 'removed, rightly (moving)',
                    'kept, wrongly (moving)', null];

// SemanticKITTI's own colours of its labels would be lost on people who do not tell red from green:
// these are the palette of Okabe and Ito and shades of it, a family of labels each.
const OKABE_ITO = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#f0e442', '#8c8c8c'];
const LABELS = {0: '#8c8c8c', 1: '#8c8c8c', 9: '#8c8c8c', 251: '#d55e00', 10: '#56b4e9', 11: '#e69f00', 13: '#3d86b0',
                15: '#b87f00', 16: '#3d86b0', 18: '#2f6f96', 20: '#7cc4ec', 30: '#cc79a7', 31: '#b35f8d', 32: '#9c4c79',
                40: '#6f6f78', 44: '#85858f', 48: '#a3a3ad', 49: '#77777f', 60: '#bdbdc6', 50: '#c9a66b', 51: '#a8854d',
                52: '#8f7242', 70: '#009e73', 71: '#6d5b2e', 72: '#66b89f', 80: '#f0e442', 81: '#f0e442', 99: '#9a9a9a',
                252: '#d55e00', 253: '#e8743b', 254: '#ff3f6e', 255: '#ff8a3d', 256: '#c24a00', 257: '#c24a00',
                258: '#a33e00', 259: '#f2a07b'};
const labelColour = (id, index) => LABELS[id] ?? OKABE_ITO[index % 8];
/** Of the reason with code `code`, of which the first is the usual one; -1: none was given. */
const reasonColour = (code) => code < 0 ? '#5f6368' : code === 0 ? '#a8a8a8' : OKABE_ITO[[5, 4, 0, 1, 2, 3, 6][(code - 1) % 7]];
/** Low to high: cividis, which the colour-blind see as others do. */
const HEIGHTS = ['#00224e', '#123570', '#3b496c', '#575d6d', '#707173', '#8a8678', '#a59c74', '#c3b369', '#e1cc55', '#fee838'];

/** Kind and reason of each point for cell number `number` of a scene. */
async function readCell(data, number) {
  const bytes = await data.bytes(number), kinds = new Uint8Array(data.count);
  const classes = data.head.labels.map((label) => label.kind);  // LabelClass: static, moving, ignored.
  for (let i = 0; i < data.count; ++i) {
    const removed = bytes[i] & 1, kind = classes[data.labels[i]];
    kinds[i] = kind === 2 ? NOT_EVALUATED : kind === 1 ? (removed ? TRUE_POSITIVE : FALSE_NEGATIVE)
        : removed ? FALSE_POSITIVE : KEPT_STATIC;
  }
  return {number, head: data.head.cells[number], bytes, kinds};
}

class ReportView {
  constructor(content) {
    this.scenes = content.scenes.map((head) => new SceneData(head));
    this.visible = [true, true, true, true, false];
    this.cells = [];
    this.stage = new Stage(element('canvas'));
    this.bar = new ScanBar(this.stage);
    const choose = (id, names) => element(id).replaceChildren(...names.map(([value, name]) => make('option', {value}, name)));
    this.choose = choose;
    choose('sequence', this.scenes.map((scene, i) => [i, scene.head.sequence]));
    element('sequence-label').hidden = this.scenes.length < 2;
    element('sequence').addEventListener('change', () => this.open());
    for (const id of ['left', 'right']) element(id).addEventListener('change', () => this.openCells().then(() => this.showWorst()));
    element('colour').addEventListener('change', () => this.paint());
    element('path').addEventListener('change', () => this.set({path: element('path').checked}));
    element('size').addEventListener('input', () => this.set({size: Number(element('size').value)}));
    element('close').addEventListener('click', () => this.lookClose());
    element('whole').addEventListener('click', () => this.lookAtAll());
    element('above').addEventListener('click', () => this.stage.lookAt(this.data.box(), this.stage.azimuth, 1.57));
    element('full').addEventListener('click', () => {
      if (document.fullscreenElement) document.exitFullscreen();
      else element('viewer').requestFullscreen();
    });
    this.makeKinds();
    this.stage.onClick = (x, y) => this.tell(this.stage.pick(x, y));
    this.stage.canvas.addEventListener('keydown', ({key}) => {
      if (key === 'Home') this.lookAtAll();
      else if (key === 'Escape') this.tell(-1);
      else if ('1234'.includes(key)) element(`kind-${key - 1}`).click();
    });
    document.addEventListener('raymoval-theme', () => this.paint());
  }

  get data() {
    return this.scenes[Number(element('sequence').value)];
  }

  set(values) {
    Object.assign(this.stage, values);
    this.stage.request();
  }

  makeKinds() {
    element('kinds').append(...KIND_NAMES.map((name, kind) => {
      const box = make('input', {type: 'checkbox', id: `kind-${kind}`});
      box.checked = this.visible[kind];
      box.addEventListener('change', () => {
        this.visible[kind] = box.checked;
        this.paint();
      });
      return make('label', {for: `kind-${kind}`}, box, make('span', {class: 'swatch', style: `--swatch:var(${KIND_COLOURS[kind]})`}),
                  name, make('span', {class: 'count', id: `count-${kind}`}));
    }));
  }

  async open() {
    const {data} = this, {head} = data;
    await this.stage.unpack(data, this.sideways());
    if (data !== this.data) return;
    const names = head.cells.map((cell, i) => [i, cell.name]);
    this.choose('left', names);
    element('left').value = Math.max(0, head.cells.findIndex((cell) => !cell.control));
    this.choose('right', [['', 'nothing'], ...names]);
    await this.openCells();
    this.bar.open(head);
    this.tell(-1);
    this.tellThinning();
    this.lookClose();
    this.showWorst();
  }

  async openCells() {
    const {data} = this, cells = [];
    for (const id of ['left', 'right']) {
      if (element(id).value !== '') cells.push(await readCell(data, Number(element(id).value)));
    }
    if (data !== this.data) return;  // Another sequence was chosen meanwhile.
    this.cells = cells;
    element('viewer').classList.toggle('split', cells.length === 2);
    element('left-name').textContent = cells[0].head.name;
    element('right-name').textContent = cells[1]?.head.name ?? '';
    for (let kind = 0; kind < 5; ++kind) {
      const all = cells.map(({head: {counts}}) => kind < 4 ? counts[kind]
          : data.head.points_in_range - counts.reduce((a, b) => a + b));
      element(`count-${kind}`).textContent = all.map(grouped).join('\n');
      if (kind === 4) element('kind-4').parentElement.hidden = all[0] === 0;
    }
    this.paint();
    element('view-status').textContent = '';
    if (this.chosen >= 0) this.tell(this.chosen);
  }

  /** Gives each point its colour. */
  paint() {
    if (this.cells.length === 0) return;
    const {data, visible} = this, by = element('colour').value;
    const looks = [1, 2, 2, 2, 1], words = (colours, kind) => Uint32Array.from(colours, (colour) => painted(colour, looks[kind]));
    const heights = shades([0, 0, 0], [9, 0, 0]).map(([place]) => {
      const low = Math.min(8, Math.floor(place)), [a, b] = [low, low + 1].map((i) => rgbOf(HEIGHTS[i]));
      return a.map((value, axis) => value + (b[axis] - value) * (place - low));
    });
    const labels = data.head.labels.map((label, i) => rgbOf(labelColour(label.id, i)));
    const reasons = Array.from({length: 129}, (_, i) => rgbOf(reasonColour(i - 1)));
    const tables = looks.map((_, kind) => words(by === 'verdict' ? (kind === KEPT_STATIC ? keptShades() : Array(256).fill(colourOf(KIND_COLOURS[kind])))
        : by === 'height' ? heights : by === 'label' ? labels : reasons, kind));
    this.stage.setPaints(this.cells.map(({bytes, kinds}) => {
      const paint = new Uint32Array(data.count), isByHeight = by === 'verdict' || by === 'height';
      for (let i = 0; i < data.count; ++i) {
        if (visible[kinds[i]]) paint[i] = tables[kinds[i]][isByHeight ? data.height(i) : by === 'label' ? data.labels[i] : bytes[i] >> 1];
      }
      return paint;
    }));
    this.tellColours(by);
  }

  /** What the colours mean, unless they are those of the kinds. */
  tellColours(by) {
    const place = element('colours'), {head} = this.data;
    place.replaceChildren();
    const list = (entries) => place.append(make('ul', {class: 'legend'}, ...entries.map(
        ([colour, name]) => make('li', {}, make('span', {class: 'swatch', style: `--swatch:${colour}`}), name))));
    if (by === 'label') list(head.labels.map((label, i) => [labelColour(label.id, i), `${label.name} (${label.id})`]));
    if (by === 'height') {
      const style = `background:linear-gradient(to right, ${HEIGHTS.join(',')})`;
      place.append(make('div', {class: 'height-scale', style}), 'low to high');
    }
    if (by !== 'reason') return;
    for (const {head: {name, reasons}} of this.cells) {
      if (this.cells.length > 1) place.append(make('strong', {}, name));
      if (reasons.length > 0) list(reasons.map((text, code) => [reasonColour(code), text]));
      else place.append(make('p', {class: 'note'}, `${name} gives no reasons.`));
    }
  }

  /** The square with most removed points, else the whole map. */
  lookClose() {
    const {kinds} = this.cells[0];
    const [square] = this.data.squares((i) => kinds[i] === TRUE_POSITIVE || kinds[i] === FALSE_POSITIVE, 30, 1);
    if (square) this.stage.lookAt(square.box, this.sideways());
    else this.lookAtAll();
  }

  /** The places where the first method errs most, as pictures that open in the view. */
  showWorst() {
    const {stage, cells: [{kinds, head: {name}}]} = this, {target, azimuth, polar, range, paints} = stage;
    const squares = this.data.squares((i) => kinds[i] === FALSE_POSITIVE || kinds[i] === FALSE_NEGATIVE, 20, 10);
    stage.setPaints(paints.slice(0, 1));
    const pictures = squares.map(({box}) => {
      const small = make('canvas', {width: 180, height: 110, 'aria-hidden': 'true'}), {canvas} = stage;
      stage.lookAt(box, this.sideways());
      stage.range *= 0.7;
      stage.render();
      const high = Math.min(canvas.height, canvas.width * 110 / 180), wide = high * 180 / 110;
      small.getContext('2d').drawImage(canvas, (canvas.width - wide) / 2, (canvas.height - high) / 2, wide, high, 0, 0, 180, 110);
      return small;
    });
    Object.assign(stage, {target, azimuth, polar, range});
    stage.setPaints(paints);
    element('worst-title').textContent = `Where ${name} errs most`;
    element('worst-title').hidden = squares.length === 0;
    element('worst').replaceChildren(...squares.map(({box, count}, i) => {
      const button = make('button', {type: 'button'}, pictures[i], `${i + 1}: ${grouped(count)} shown errors`);
      button.addEventListener('click', () => {
        stage.lookAt(box, this.sideways());
        element('viewer').scrollIntoView({block: 'nearest'});
      });
      return make('li', {}, button);
    }));
  }

  lookAtAll() {
    this.stage.lookAt(this.data.box(), this.sideways());
  }

  sideways() {
    const first = this.data.sensor(0), last = this.data.sensor(this.data.head.scans.length - 1);
    return Math.atan2(last[1] - first[1], last[0] - first[0]) + 2.2;
  }

  /** Shows what is known of point i; -1: of none. */
  tell(i) {
    this.chosen = i;
    this.set({chosen: i < 0 ? null : this.data.position(i)});
    if (i < 0) return element('point').replaceChildren();
    const {data, data: {head}} = this, scan = data.places[4 * i + 3], label = head.labels[data.labels[i]], voxel = data.voxel(i);
    const range = Math.hypot(...data.position(i).map((value, axis) => value - data.sensor(scan)[axis]));
    const entries = [['scan', `${scan} (${head.scans[scan]})`], ['range', `${range.toFixed(1)} m`],
                     ['label', label ? `${label.name} (${label.id})` : 'unknown'],
                     ['position', `${data.world(i).map((value) => value.toFixed(2)).join(', ')} m`],
                     [`voxel of ${head.voxel} m`, voxel ? voxel.join(', ') : 'unknown'],
                     ...this.cells.map(({head: {name, reasons}, bytes, kinds}) => {
                       const verdict = KIND_WORDS[kinds[i]] ?? (bytes[i] & 1 ? 'removed' : 'kept') + ', not evaluated';
                       return [name, `${verdict}: ${bytes[i] >> 1 ? reasons[(bytes[i] >> 1) - 1] : 'the method gives no reason'}`];
                     })];
    element('point').replaceChildren(make('dl', {}, ...entries.flatMap(
        ([name, value]) => [make('dt', {}, name), make('dd', {}, value)])));
  }

  tellThinning() {
    const {head} = this.data, size = (cell) => `one in each cell of ${Number(cell.toFixed(3))} m`;
    element('view-thinning').textContent =
        `${grouped(head.points)} of ${grouped(head.points_in_range)} points within range are shown. Wrongly judged points ` +
        `(controls aside): ${head.error_cell > 0 ? size(head.error_cell) : 'all of them'}. Others: ${size(head.other_cell)}, ` +
        'moving ones in each scan anew; static ones stand for the first scan that saw their cell. The numbers beside the ' +
        'kinds are of all points.';
  }
}

startView(async () => {
  const view = window.raymovalView = new ReportView(JSON.parse(element('scenes').textContent));
  await view.open();
  view.ready = true;
});
