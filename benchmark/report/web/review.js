// SPDX-License-Identifier: MIT
// The review of a cleaned map: removed points as objects, which a reader keeps or removes.

const LEGEND = [['kept', '--kept-high'], ['removed', '--kind-2'], ['kept by hand', '--kind-1'], ['removed by hand', '--kind-3']];  // Of page.css.
const SMALLEST = 8;  // Shown points of an object; smaller ones are one object, "scattered points".

/** Number of the connected group of each removed point: neighbours in space within a scan, and in the scans after it. */
function groupsOf(data, isRemoved) {
  const edge = Math.ceil(Math.max(0.5, 1.5 * data.head.error_cell) / data.step), {places, count} = data;
  const across = Math.ceil(65536 / edge) + 2, nodes = new Map(), keys = [], of = new Int32Array(count).fill(-1);
  let high = 3;
  for (let i = 0; i < count; ++i) high = Math.max(high, Math.floor(places[4 * i + 2] / edge) + 3);
  const key = (scan, x, y, z) => ((scan * across + x) * across + y) * high + z;
  for (let i = 0; i < count; ++i) {
    if (!isRemoved[i]) continue;
    const [x, y, z] = [0, 1, 2].map((axis) => Math.floor(places[4 * i + axis] / edge) + 1), at = key(places[4 * i + 3], x, y, z);
    let node = nodes.get(at);
    if (node === undefined) {
      nodes.set(at, node = keys.length);
      keys.push(at);
    }
    of[i] = node;
  }
  const parent = Int32Array.from(keys, (_, node) => node);
  const root = (node) => {
    while (parent[node] !== node) node = parent[node] = parent[parent[node]];
    return node;
  };
  // In the same and in the next scan all 26 neighbours, in two more scans the same place.
  const steps = [2, 3].map((scans) => key(scans, 0, 0, 0));
  for (const scan of [0, 1]) {
    for (const x of [-1, 0, 1]) for (const y of [-1, 0, 1]) for (const z of [-1, 0, 1]) {
      const step = key(scan, x, y, z);
      if (step > 0) steps.push(step);
    }
  }
  keys.forEach((at, node) => {
    for (const step of steps) {
      const other = nodes.get(at + step);
      if (other !== undefined) parent[Math.max(root(node), root(other))] = Math.min(root(node), root(other));
    }
  });
  return of.map((node) => node < 0 ? -1 : root(node));
}

/** The removed points as objects with number, points, size, scans and confidence. */
function objectsOf(data, isRemoved, confidence) {
  const groups = groupsOf(data, isRemoved), members = new Map();
  groups.forEach((group, i) => {
    if (group >= 0) (members.get(group) ?? members.set(group, []).get(group)).push(i);
  });
  const sorted = [...members.values()].sort((a, b) => data.places[4 * a[0] + 3] - data.places[4 * b[0] + 3] || a[0] - b[0]);
  const large = sorted.filter((points) => points.length >= SMALLEST);
  const small = sorted.filter((points) => points.length < SMALLEST).flat();
  const objects = large.map((points, i) => describe(data, points, confidence, i + 1, false));
  if (small.length > 0) objects.push(describe(data, small, confidence, objects.length + 1, true));
  return objects;
}

function describe(data, points, confidence, number, isScattered) {
  const boxes = new Map();  // Corners in each scan.
  let sum = 0;
  for (const i of points) {
    const scan = data.places[4 * i + 3], at = [0, 1, 2].map((axis) => data.places[4 * i + axis]);
    const [low, high] = boxes.get(scan) ?? boxes.set(scan, [[...at], [...at]]).get(scan);
    at.forEach((value, axis) => {
      low[axis] = Math.min(low[axis], value);
      high[axis] = Math.max(high[axis], value);
    });
    sum += confidence[i];
  }
  const sizes = [0, 1, 2].map((axis) => data.step * Math.max(...[...boxes.values()].map(([low, high]) => high[axis] - low[axis])));
  const scans = [...boxes.keys()].sort((a, b) => a - b), mean = sum / points.length / 250;
  return {number, points, isScattered, sizes, scans, confidence: mean, state: ''};
}

function setCurrent(item, is) {
  if (is) item.setAttribute('aria-current', 'true');
  else item.removeAttribute('aria-current');
}

class Review {
  constructor(content) {
    this.data = new SceneData(content.scenes[0]);
    this.hasConfidence = this.data.head.confidences.length > 0;
    this.stage = new Stage(element('canvas'));
    this.bar = new ScanBar(this.stage);
    this.history = [];
    this.selected = {points: [], object: null};
    this.visible = [true, true];
    this.preview = null;
    element('caution-field').hidden = !this.hasConfidence;
    this.setUpLegend();
    this.setUpActions();
    this.setUpDrags();
    document.addEventListener('raymoval-theme', () => this.paint());
    addEventListener('beforeunload', (event) => { if (this.isUnsaved) event.preventDefault(); });
  }

  async load() {
    const {data, stage} = this;
    await stage.unpack(data, 2.2);
    const [removed, confidence] = [await data.bytes(0), await data.bytes(1)];
    Object.assign(this, {base: removed, now: removed.slice(), confidence, marked: new Uint8Array(data.count)});
    this.objects = objectsOf(data, removed, confidence);
    this.objectOf = new Int32Array(data.count).fill(-1);
    this.objects.forEach(({points}, place) => points.forEach((i) => { this.objectOf[i] = place; }));
    this.bar.open(data.head);
    this.list();
    this.paint();
    this.lookAtAll();
    const size = (cell) => `one in each cell of ${Number(cell.toFixed(3))} m`;
    element('view-thinning').textContent = `${grouped(data.count)} of ${grouped(data.head.points_in_range)} points are shown. Removed ` +
        `points: ${size(data.head.error_cell)} and scan; each stands for all removed points there. Kept points: ` +
        `${size(data.head.other_cell)}; each stands for the kept points of all scans there, also where an edit removes it.`;
    element('view-status').textContent = '';
    this.tell('');
  }

  setUpLegend() {
    element('kinds').append(...LEGEND.map(([name, colour], kind) => {
      const swatch = make('span', {class: 'swatch', style: `--swatch:var(${colour})`});
      if (kind > 1) return make('label', {}, swatch, name);
      const box = make('input', {type: 'checkbox', id: `kind-${kind}`, checked: ''});
      box.addEventListener('change', () => {
        this.visible[kind] = box.checked;
        this.paint();
      });
      return make('label', {}, box, swatch, name);
    }));
  }

  setUpActions() {
    const actions = {keep: () => this.decide(0), remove: () => this.decide(1), undo: () => this.undo(), export: () => this.save(),
                     whole: () => this.lookAtAll(), above: () => this.stage.lookAt(this.data.box(), this.stage.azimuth, 1.57),
                     'caution-end': () => this.setCaution(null)};
    for (const [id, action] of Object.entries(actions)) element(id).addEventListener('click', action);
    element('order').addEventListener('change', () => this.list());
    element('caution').addEventListener('input', () => this.setCaution(Number(element('caution').value)));
    const keys = {k: actions.keep, r: actions.remove, Delete: actions.remove, u: actions.undo, n: () => this.next(),
                  Escape: () => { this.setPen(this.pen && {...this.pen, corners: []}); this.select([], null); }, Home: actions.whole};
    for (const mode of ['turn', 'box', 'lasso']) {
      keys[mode[0]] = () => { this.setDrag(mode); this.stage.canvas.focus(); };
    }
    document.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey || event.target.matches('input[type=range], select')) return;
      const action = keys[event.key] ?? keys[event.key.toLowerCase()];
      if (!action) return;
      event.preventDefault();
      action();
    });
  }

  setUpDrags() {
    let path = [];
    this.stage.onDrag = (phase, {offsetX, offsetY}) => {
      if (phase === 'start') path = [];
      this.setPen(null);
      if (this.drag === 'turn') return false;
      path.push([offsetX, offsetY]);
      const [x, y] = path[0];
      this.outline(phase === 'end' ? [] : path);
      if (phase !== 'end') return true;
      if (Math.max(...path.map(([a, b]) => Math.hypot(a - x, b - y))) < 4) this.choose(x, y);
      else this.selectWithin(this.corners(path));
      return true;
    };
    this.stage.onClick = (x, y) => this.choose(x, y);
    this.stage.onKey = (event) => this.onPenKey(event);
    document.querySelectorAll('input[name=drag]').forEach((choice) => choice.addEventListener('change', () => this.setDrag(choice.value)));
  }

  /** What a drag does: "turn", "box" or "lasso". */
  get drag() {
    return document.querySelector('input[name=drag]:checked').value;
  }

  setDrag(mode) {
    document.querySelector(`input[name=drag][value=${mode}]`).checked = true;
    this.setPen(mode === 'turn' ? null : {x: this.stage.width / 2, y: this.stage.height / 2, corners: []});
  }

  /** Corners of the lasso or box that follows a path. */
  corners(path) {
    if (this.drag === 'lasso') return path;
    const [[x, y], [right, down]] = [path[0], path[path.length - 1]];
    return [[x, y], [right, y], [right, down], [x, down]];
  }

  outline(path) {
    element('outline').setAttribute('points', path.length > 0 ? this.corners(path).join(' ') : '');
  }

  /** Shows the cross with which the keyboard draws, and the corners that are set; null: none. */
  setPen(pen) {
    if (pen === null && !this.pen) return;
    this.pen = pen;
    element('cross').setAttribute('visibility', pen ? 'visible' : 'hidden');
    this.outline(pen && pen.corners.length > 0 ? [...pen.corners, [pen.x, pen.y]] : []);
    if (!pen) return;
    element('cross').setAttribute('transform', `translate(${pen.x} ${pen.y})`);
    const share = (value, whole) => Math.round(100 * value / whole);
    this.tell(`Cross ${share(pen.x, this.stage.width)} % from the left, ${share(pen.y, this.stage.height)} % from the top, ` +
        `${pen.corners.length} corners set. Arrows move it, Space sets a corner, Enter selects.`);
  }

  /** Box and lasso by keyboard. @return whether the key was for them */
  onPenKey(event) {
    const {pen, stage: {width, height}} = this, step = event.shiftKey ? 40 : 8;
    const ways = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step]}, way = ways[event.key];
    if (!pen) return false;
    const within = (value, most) => Math.min(most - 1, Math.max(0, value));
    if (way) this.setPen({...pen, x: within(pen.x + way[0], width), y: within(pen.y + way[1], height)});
    else if (event.key === ' ') this.setPen({...pen, corners: [...pen.corners, [pen.x, pen.y]]});
    else if (event.key === 'Enter') this.finishPen();
    else return false;
    return true;
  }

  finishPen() {
    const {x, y, corners} = this.pen;
    this.setPen({x, y, corners: []});
    if (corners.length > 0) this.selectWithin(this.corners([...corners, [x, y]]));
    else this.choose(x, y);
  }

  /** Selects the object of the point under a place, or the cell of a kept point. */
  choose(x, y) {
    const i = this.stage.pick(x, y), object = i < 0 ? null : this.objects[this.objectOf[i]] ?? null;
    if (object) this.select(object.points, object);
    else this.select(i < 0 ? [] : [i], null);
  }

  /** Selects the shown points within an outline on the canvas. */
  selectWithin(outline) {
    const {width, height} = this.stage, mask = new OffscreenCanvas(width, height).getContext('2d');
    mask.beginPath();
    outline.forEach(([x, y]) => mask.lineTo(x, y));
    mask.fill();
    const {data: inside} = mask.getImageData(0, 0, width, height), points = [];
    const narrows = element('within').checked && this.selected.points.length > 0;
    this.stage.eachSeen(0, (i, x, y) => {
      if (inside[4 * (Math.floor(y) * width + Math.floor(x)) + 3] > 127 && (!narrows || this.marked[i])) points.push(i);
    });
    this.select(points, null);
  }

  select(points, object) {
    this.selected = {points, object};
    this.marked.fill(0);
    points.forEach((i) => { this.marked[i] = 1; });
    const removed = points.reduce((sum, i) => sum + this.now[i], 0);
    this.tell(points.length === 0 ? '' : `${object ? this.title(object) : 'Selection'}: ${grouped(removed)} removed and ` +
        `${grouped(points.length - removed)} kept points shown`);
    for (const item of element('objects').children) {
      setCurrent(item, Number(item.dataset.number) === object?.number);
    }
    this.paint();
  }

  /** Kept points of a cell that are shown apart, by their confidence, have one fate. */
  withTwins(points) {
    const edge = this.data.head.other_cell / this.data.head.voxel * this.data.head.steps_per_voxel;
    const key = (i) => this.data.cell(i, Math.round(edge)).join();
    const cells = new Set(points.filter((i) => !this.base[i]).map(key));
    if (cells.size === 0) return points;
    const all = new Set(points);
    for (let i = 0; i < this.data.count; ++i) if (!this.base[i] && !all.has(i) && cells.has(key(i))) all.add(i);
    return [...all];
  }

  decide(removed) {
    const {points, object} = this.selected;
    if (points.length === 0) return this.tell('Select an object or points first.');
    if (this.preview !== null) this.setCaution(null);
    const changed = this.withTwins(points).filter((i) => this.now[i] !== removed);
    changed.forEach((i) => { this.now[i] = removed; });
    this.history.push({changed, object, state: object?.state});
    this.isUnsaved = true;
    if (object) object.state = removed ? 'removed' : 'kept';
    this.list();
    if (object) this.next();
    else this.select([], null);
    this.tell(`${grouped(changed.length)} shown points ${removed ? 'removed' : 'kept'}.`);
  }

  undo() {
    const last = this.history.pop();
    if (!last) return;
    last.changed.forEach((i) => { this.now[i] ^= 1; });
    if (last.object) last.object.state = last.state;
    this.list();
    this.select(last.object ? last.object.points : last.changed, last.object);
  }

  /** Selects the first object in the list that has no decision, and looks at it. */
  next() {
    const object = this.ordered().find(({state}) => state === '');
    if (object) this.visit(object);
    else this.select([], null);
  }

  visit(object) {
    const at = object.points.map((i) => this.data.position(i)), sides = [0, 1, 2];
    const low = sides.map((axis) => at.reduce((least, place) => Math.min(least, place[axis]), Infinity) - 2);
    const high = sides.map((axis) => at.reduce((most, place) => Math.max(most, place[axis]), -Infinity) + 2);
    this.stage.lookAt([low, high]);
    this.select(object.points, object);
    element('objects').querySelector('[aria-current]')?.scrollIntoView({block: 'nearest'});
  }

  title(object) {
    return object.isScattered ? 'Scattered points' : `Object ${object.number}`;
  }

  ordered() {
    // The expected number of points that are wrongly removed.
    const size = ({points}) => points.length, doubt = (object) => size(object) * (1 - object.confidence);
    const by = {uncertain: (a, b) => doubt(b) - doubt(a),
                large: (a, b) => size(b) - size(a), number: (a, b) => a.number - b.number};
    const isDone = ({state}) => state !== '';
    return [...this.objects].sort((a, b) => isDone(a) - isDone(b) ||
        a.isScattered - b.isScattered || by[element('order').value](a, b) || a.number - b.number);
  }

  list() {
    element('objects').replaceChildren(...this.ordered().map((object) => {
      const {number, points, scans, sizes, confidence, state} = object, first = scans[0], last = scans[scans.length - 1];
      const size = `${sizes.map((length) => length.toFixed(1)).join(' × ')} m`;
      const facts = [`${grouped(points.length)} points`, ...(object.isScattered ? [] : [size]),
                     first === last ? `scan ${first}` : `scans ${first} to ${last}`,
                     ...(this.hasConfidence ? [`confidence ${confidence.toFixed(2)}`] : [])];
      const item = make('li', {'data-number': number, class: state},
          make('button', {type: 'button', class: 'object'}, make('strong', {}, this.title(object)),
               state ? ` ${state}` : '', make('small', {}, facts.join(', '))),
          make('button', {type: 'button', 'aria-label': `Keep ${this.title(object)}`}, 'Keep'),
          make('button', {type: 'button', 'aria-label': `Remove ${this.title(object)}`}, 'Remove'));
      setCurrent(item, object === this.selected.object);
      const [show, keep, remove] = item.children;
      show.addEventListener('click', () => this.visit(object));
      for (const [button, removed] of [[keep, 0], [remove, 1]]) {
        button.addEventListener('click', () => {
          this.select(object.points, object);
          this.decide(removed);
        });
      }
      return item;
    }));
    const open = this.objects.filter(({state}) => state === '').length;
    element('left').textContent = `${grouped(open)} of ${grouped(this.objects.length)} left to review`;
    element('undo').disabled = this.history.length === 0;
  }

  /** The number of steps of confidence from which a caution removes. Points with the lowest have no evidence. */
  threshold(caution) {
    return Math.max(Math.ceil(caution * 250 - 1e-9), this.data.head.confidences.findIndex((count) => count > 0) + 1);
  }

  /** Shows what a caution would remove; null: the map as it is. */
  setCaution(caution) {
    this.preview = caution;
    element('caution-end').hidden = caution === null;
    const {confidences, points_in_range: all} = this.data.head;
    element('caution-note').textContent = 'Move the slider to see what a threshold on the confidence would remove.';
    if (caution !== null) {
      const removed = confidences.slice(this.threshold(caution)).reduce((a, b) => a + b, 0);
      element('caution-note').textContent = `--caution ${caution.toFixed(2)} would remove ${grouped(removed)} points ` +
          `(${(100 * removed / all).toFixed(2)} %). For a map with it, clean again with this option.`;
    }
    this.paint();
  }

  paint() {
    if (!this.now) return;
    const {data, base, now, marked, visible, preview} = this, paint = new Uint32Array(data.count);
    const mark = painted(colourOf('--mark'), 3), kept = keptShades().map((colour) => painted(colour, 1));
    const colours = LEGEND.map(([, name]) => painted(colourOf(name), 2));
    const least = preview === null ? 0 : this.threshold(preview);
    for (let i = 0; i < data.count; ++i) {
      const removed = preview === null ? now[i] : this.confidence[i] >= least ? 1 : 0;
      if (!visible[removed] && !marked[i]) continue;
      const byHand = preview === null && base[i] !== removed;
      paint[i] = marked[i] ? mark : byHand ? colours[2 + removed] : removed ? colours[1] : kept[data.height(i)];
    }
    this.stage.setPaints([paint]);
  }

  tell(text) {
    element('selection').textContent = text;
  }

  lookAtAll() {
    this.stage.lookAt(this.data.box(), this.stage.azimuth || 2.2);
  }

  /** The method's answer with the corrections, for `raymoval clean --edits`. */
  async edits() {
    const {data, base, now} = this, keep = new Set(), remove = new Set();
    const edits = JSON.parse(new TextDecoder().decode(await bytesOf(`${data.head.stream}-review`)));
    for (let i = 0; i < data.count; ++i) {
      if (base[i] === now[i]) continue;
      if (base[i]) keep.add([data.places[4 * i + 3], ...data.cell(i, edits.removed_cell)].join());
      else remove.add(data.cell(i, edits.kept_cell).join());
    }
    const cells = (set) => [...set].map((cell) => cell.split(',').map(Number));
    return {...edits, keep: cells(keep), remove: cells(remove)};
  }

  async save() {
    const link = make('a', {download: 'edits.json', href: URL.createObjectURL(
        new Blob([JSON.stringify(await this.edits()), '\n'], {type: 'application/json'}))});
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    this.isUnsaved = false;
    this.tell('edits.json was exported.');
  }
}

startView(async () => {
  const review = window.raymovalReview = new Review(JSON.parse(element('scenes').textContent));
  await review.load();
  review.ready = true;
});
