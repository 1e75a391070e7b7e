// SPDX-License-Identifier: MIT
// Colours of labels, reasons and heights.

// SemanticKITTI's own colours of its labels would be lost on people who do not tell red from green:
// these are the palette of Okabe and Ito and shades of it, a family of labels each.
const OKABE_ITO = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#f0e442', '#8c8c8c'];
const KNOWN = new Map(Object.entries({
  0: '#8c8c8c', 1: '#8c8c8c', 9: '#8c8c8c', 251: '#d55e00',
  10: '#56b4e9', 11: '#e69f00', 13: '#3d86b0', 15: '#b87f00', 16: '#3d86b0', 18: '#2f6f96', 20: '#7cc4ec',
  30: '#cc79a7', 31: '#b35f8d', 32: '#9c4c79',
  40: '#6f6f78', 44: '#85858f', 48: '#a3a3ad', 49: '#77777f', 60: '#bdbdc6',
  50: '#c9a66b', 51: '#a8854d', 52: '#8f7242',
  70: '#009e73', 71: '#6d5b2e', 72: '#66b89f', 80: '#f0e442', 81: '#f0e442', 99: '#9a9a9a',
  252: '#d55e00', 253: '#e8743b', 254: '#ff3f6e', 255: '#ff8a3d', 256: '#c24a00', 257: '#c24a00',
  258: '#a33e00', 259: '#f2a07b',
}));

export const labelColour = (id, index) => KNOWN.get(String(id)) ?? OKABE_ITO[index % 8];

/** Of the reason with code `code`, of which the first is the usual one; -1: none was given. */
export const reasonColour = (code) => code < 0 ? '#5f6368' : code === 0 ? '#a8a8a8'
    : OKABE_ITO[[5, 4, 0, 1, 2, 3, 6][(code - 1) % 7]];

/** Low to high: cividis, which the colour-blind see as others do. */
export const HEIGHTS = ['#00224e', '#123570', '#3b496c', '#575d6d', '#707173', '#8a8678', '#a59c74',
                        '#c3b369', '#e1cc55', '#fee838'];

export const rgbOf = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

/** Colour at `share` (0 to 1) of a list of colours. */
export function between(colours, share) {
  const at = share * (colours.length - 1), low = Math.min(Math.floor(at), colours.length - 2);
  const a = rgbOf(colours[low]), b = rgbOf(colours[low + 1]);
  return a.map((value, i) => Math.round(value + (b[i] - value) * (at - low)));
}
