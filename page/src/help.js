// The table of keys.
const rows = [
  ['drag', 'turn'], ['Shift or right button and drag', 'move'], ['wheel', 'zoom to the mouse'],
  ['click', 'pick; with Ctrl or Shift one more'], ['Ctrl and drag, Alt and drag', 'box, lasso around hexes'],
  ['arrows, with Shift', 'turn, move'], ['+ -', 'zoom'], ['0 to 6', 'from a corner, +x, -x, +y, -y, +z, -z'],
  ['Enter, with Shift', 'pick what is in the middle, one more'], ['X or O, arrows, Enter', 'box or lasso; a box around the middle, its size, pick its hexes'], ['K', 'next kind to pick'], ['Esc', 'pick nothing'],
  ['F', 'show all, or what is picked'], ['I, H, A', 'only what is picked, hide it, all'], ['L', 'labels'], ['E, P, G', 'edges, parallel, mesh or CAD'],
  ['C, [ and ]', 'kind of cut, move it'], ['W', 'next of the worst ten'], ['B', 'before and after'],
  ['R', 'type a range: hex 3 5 to 9'], ['/', 'search'], [':', 'prompt'], ['T', 'light or dark'],
];

export function fillHelp(dialog) {
  const table = document.createElement('table');
  for (const [keys, what] of rows) {
    const row = table.insertRow();
    row.insertCell().append(Object.assign(document.createElement('kbd'), { textContent: keys }));
    row.insertCell().append(what);
  }
  const close = Object.assign(document.createElement('button'), { textContent: 'Close' });
  close.addEventListener('click', () => dialog.close());
  dialog.append(Object.assign(document.createElement('h2'), { textContent: 'Mouse and keys' }), table, close);
}
