// Colours of values and of things that are to be told apart (session/view/picture_png.cpp has the same).

const good = [[0, 140, 25, 38], [0.35, 230, 115, 64], [0.6, 250, 217, 140], [0.8, 168, 214, 219], [1, 84, 153, 199]];
const plain = [[0, 68, 40, 110], [0.25, 59, 82, 139], [0.5, 33, 145, 140], [0.75, 94, 201, 98], [1, 253, 231, 37]];
const row = [[133, 176, 212], [236, 165, 96], [148, 196, 133], [212, 128, 136], [176, 158, 207], [222, 205, 120], [119, 190, 190],
  [205, 150, 190], [170, 150, 125], [160, 168, 178]];

export const rowColour = (i) => row[((i % row.length) + row.length) % row.length];
export const css = ([r, g, b]) => `rgb(${r},${g},${b})`;

/** 256 colours from low to high. kind: 'good' (high is good), 'bad' (low is good), 'plain'. */
function table(kind) {
  const stops = kind === 'plain' ? plain : good, out = new Uint8Array(768);
  for (let i = 0; i < 256; ++i) {
    const t = kind === 'bad' ? 1 - i / 255 : i / 255;
    let k = 1;
    while (k + 1 < stops.length && stops[k][0] < t) ++k;
    const [a, b] = [stops[k - 1], stops[k]], w = (t - a[0]) / (b[0] - a[0]);
    for (let c = 0; c < 3; ++c) out[3 * i + c] = Math.round((1 - w) * a[c + 1] + w * b[c + 1]);
  }
  return out;
}
const tables = {};
export const scale = (kind) => (tables[kind] ??= table(kind));

export function scaleColour(kind, low, high, value) {
  const t = Math.max(0, Math.min(255, Math.round((255 * (value - low)) / (high - low || 1)))), colours = scale(kind);
  return Number.isNaN(value) ? [128, 128, 128] : [colours[3 * t], colours[3 * t + 1], colours[3 * t + 2]];
}

/** Ends of the scale: from 0 to the ideal for metrics that have one, else what there is. */
export function scaleRange(channel, values) {
  let low = Infinity, high = -Infinity;
  for (const v of values) {
    if (v < low) low = v;
    if (v > high) high = v;
  }
  if (!(low <= high)) return { low: 0, high: 1, least: 0, most: 1 };
  const least = low, most = high;
  if (channel.ideal !== undefined && channel.ideal !== null) {
    if (channel.small_is_better) low = channel.ideal;
    else { high = channel.ideal; low = Math.min(0, low); }
  }
  if (!(high > low)) high = low + Math.max(Math.abs(low) * 1e-6, 1e-12);
  return { low, high, least, most };
}
export const scaleKind = (channel) => (channel.small_is_better === undefined ? 'plain' : channel.small_is_better ? 'bad' : 'good');
