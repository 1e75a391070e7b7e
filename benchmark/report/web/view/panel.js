// SPDX-License-Identifier: MIT
// Parts of the page around the canvas.
import {HEIGHTS, labelColour, reasonColour} from './colours.js';

export const element = (id) => document.getElementById(id);

const grouped = (number) => number.toLocaleString('en');

/** A new element with text or children. */
function make(tag, attributes, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

export function fillSelect(select, names, chosen) {
  select.replaceChildren(...names.map(([value, name]) => {
    const option = make('option', {value}, name);
    option.selected = value === chosen;
    return option;
  }));
}

const swatch = (colour) => make('span', {class: 'swatch', style: `--swatch:${colour}`});

const KIND_NAMES = ['static, kept: right', 'static, removed: false positive',
                    'moving, removed: true positive', 'moving, kept: false negative',
                    'label not evaluated'];
/** Without labels nobody knows what is right. */
const UNLABELLED_NAMES = ['kept', null, 'removed', null, null];

/** A checkbox for each kind. @param visible what is shown at first @param changed called with kind and whether it is shown */
export function makeKinds(unlabelled, colours, visible, changed) {
  const field = element('kinds');
  field.append(...(unlabelled ? UNLABELLED_NAMES : KIND_NAMES).map((name, kind) => {
    const box = make('input', {type: 'checkbox', id: `kind-${kind}`});
    box.checked = visible[kind];
    box.addEventListener('change', () => changed(kind, box.checked));
    const count = make('span', {class: 'count', id: `count-${kind}`});
    const label = make('label', {for: `kind-${kind}`}, box, swatch(colours[kind]), name ?? '', count);
    if (name === null) label.style.display = 'none';
    return label;
  }));
}

/** Shows or hides the kind at place `number` (from 1) of those in the list. */
export function switchKind(number) {
  const boxes = [...element('kinds').querySelectorAll('input')]
      .filter((box) => box.parentElement.style.display !== 'none');
  boxes[number - 1]?.click();
}

/** Takes away what says nothing where there is one method and no label. */
export function hideComparison() {
  element('kind-keys').replaceChildren(make('kbd', {}, '1'), ' and ', make('kbd', {}, '2'));
  const help = element('view-help').firstChild;
  help.textContent = help.textContent.replace('its scan, label and voxel, and why it was removed or kept',
                                              'its scan and voxel, and whether it was removed');
  for (const id of ['left', 'right']) element(id).parentElement.style.display = 'none';
  for (const radio of document.querySelectorAll('input[name="colour"]')) {
    if (radio.value === 'label' || radio.value === 'reason') radio.parentElement.style.display = 'none';
  }
}

/** How many points of each kind there are in the data of each shown cell. */
export function tellKinds(head, cells) {
  for (let kind = 0; kind < 5; ++kind) {
    const all = cells.map(({head: {counts}}) => kind < 4 ? counts[kind]
        : head.points_in_range - counts[0] - counts[1] - counts[2] - counts[3]);
    element(`count-${kind}`).textContent = all.map(grouped).join('\n');
  }
  element('kind-4').parentElement.style.display = cells.every((cell) => cell.shown[4] === 0) ? 'none' : '';
}

/** What the colours mean, unless they are those of the kinds. */
export function tellColours(by, head, cells) {
  const place = element('colours');
  place.replaceChildren();
  const list = (entries) => place.append(make('ul', {class: 'legend'}, ...entries.map(
      ([colour, name]) => make('li', {}, swatch(colour), name))));
  if (by === 'label') {
    list(head.labels.map((label, i) => [labelColour(label.id, i), `${label.name} (${label.id})`]));
  } else if (by === 'height') {
    place.append(make('div', {class: 'height-scale', style:
        `background:linear-gradient(to right, ${HEIGHTS.join(',')})`}), 'low to high');
  } else if (by === 'reason') {
    for (const cell of cells) {
      if (cells.length > 1) place.append(make('strong', {}, cell.head.name));
      if (cell.head.reasons.length === 0) {
        place.append(make('p', {class: 'note'}, `${cell.head.name} does not say why.`));
      } else {
        list(cell.head.reasons.map((text, code) => [reasonColour(code), text]));
      }
    }
  }
}

const KIND_WORDS = ['kept, rightly (static)', 'removed, wrongly (static)', 'removed, rightly (moving)',
                    'kept, wrongly (moving)', null];

/** What is known of a point. */
export function tellPoint(data, cells, i) {
  const {head} = data;
  const scan = data.places[4 * i + 3];
  const label = head.labels[data.labels[i]];
  const voxel = data.voxel(i);
  const metres = (values) => values.map((value) => value.toFixed(2)).join(', ');
  const entries = [
    ['scan', `${scan} (${head.scans[scan]})`],
    ...(head.unlabelled ? [] : [['label', label ? `${label.name} (${label.id})` : 'unknown']]),
    ['position', `${metres(data.world(i))} m`],
    [`voxel of ${head.voxel} m`, voxel ? voxel.join(', ') : 'unknown'],
  ];
  for (const cell of cells) {
    const kind = cell.tags[4 * i + 2], reason = cell.tags[4 * i + 1];
    if (head.unlabelled) {
      entries.push([cell.head.name, cell.tags[4 * i + 3] ? 'removed' : 'kept']);
      continue;
    }
    const verdict = KIND_WORDS[kind] ?? (cell.tags[4 * i + 3] ? 'removed' : 'kept') + ', not evaluated';
    const why = reason > 0 ? cell.head.reasons[reason - 1] : 'the method does not say why';
    entries.push([cell.head.name, `${verdict}: ${why}`]);
  }
  element('point').replaceChildren(make('dl', {}, ...entries.flatMap(
      ([name, value]) => [make('dt', {}, name), make('dd', {}, value)])));
}

/** How much of the data is shown. */
export function tellThinning(head) {
  const size = (cell) => `one in each cell of ${Number(cell.toFixed(3))} m`;
  if (head.unlabelled) {
    element('view-thinning').textContent =
        `${grouped(head.points)} of ${grouped(head.points_in_range)} points are shown. Removed ones: ` +
        `${size(head.error_cell)}, in each scan anew. Kept ones: ${size(head.other_cell)}; they ` +
        'stand for the first scan that saw their cell. The numbers beside the kinds are of all points.';
    return;
  }
  const errors = head.error_cell > 0 ? size(head.error_cell) : 'all of them';
  element('view-thinning').textContent =
      `${grouped(head.points)} of ${grouped(head.points_in_range)} points within range are shown. ` +
      `Points that a method (controls aside) judged wrongly: ${errors}. Others: ` +
      `${size(head.other_cell)}, moving ones in each scan anew; static ones stand for the first ` +
      'scan that saw their cell. The numbers beside the kinds are of all points.';
}
