// Saves the picture of the floor as PNG, and the paths on it as CSV.

const STYLES = ['fill', 'fill-opacity', 'stroke', 'stroke-width', 'stroke-dasharray', 'stroke-linecap', 'stroke-linejoin',
  'opacity', 'display', 'font-family', 'font-size', 'text-anchor'];
const PNG_SCALE = 2;

// A copy of the current picture, with the styles from the style sheet as attributes, and lines of text: [source, text].
function standalone(svg, lines) {
  const copy = svg.cloneNode(true), originals = svg.querySelectorAll('*');
  copy.querySelectorAll('*').forEach((each, index) => {
    const style = getComputedStyle(originals[index]);
    for (const name of STYLES) {
      each.setAttribute(name, style.getPropertyValue(name));
    }
    each.removeAttribute('style');
    each.removeAttribute('class');
  });
  const width = svg.clientWidth, height = svg.clientHeight;
  const background = document.createElementNS(svg.namespaceURI, 'rect');
  for (const [name, value] of Object.entries({width, height, fill: getComputedStyle(svg).backgroundColor})) {
    background.setAttribute(name, value);
  }
  copy.prepend(background);
  lines.forEach(([source, text], index) => {
    const line = document.createElementNS(svg.namespaceURI, 'text');
    const color = getComputedStyle(document.documentElement).getPropertyValue(`--${source || 'text'}`);
    for (const [name, value] of Object.entries({x: 10, y: 18 + 16 * index, fill: color, 'font-size': 12, 'font-family': 'sans-serif'})) {
      line.setAttribute(name, value);
    }
    line.textContent = text;
    copy.append(line);
  });
  for (const name of ['id', 'tabindex', 'role', 'aria-label']) {
    copy.removeAttribute(name);
  }
  copy.setAttribute('xmlns', svg.namespaceURI);
  copy.setAttribute('width', width);
  copy.setAttribute('height', height);
  copy.setAttribute('viewBox', `0 0 ${width} ${height}`);
  return {text: new XMLSerializer().serializeToString(copy), width, height};
}

function download(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// The paths of this run and of the earlier runs that are shown, one pose per line: m, and degrees.
function table({run, status: {surface, seed}, paths, earlier}) {
  const number = (earlier[earlier.length - 1]?.number || 0) + 1;
  const all = [...earlier.filter(({shown}) => shown), ...Object.entries(paths).map(
    ([source, points]) => ({number, name: run, surface, seed, source, points}))];
  return ['run,method,surface,seed,source,x,y,heading', ...all.flatMap(each => each.points.map(([x, y, yaw]) =>
    [each.number, each.name, each.surface, each.seed, each.source, x, y, (yaw * 180 / Math.PI).toFixed(2)].join()))].join('\n');
}

export async function save(svg, lines, model) {
  const name = `rbx1_nav-${new Date().toISOString().slice(0, 19).replace(/[:T]/g, '-')}`;
  download(new Blob([table(model), '\n'], {type: 'text/csv'}), `${name}.csv`);
  const {text, width, height} = standalone(svg, lines), image = new Image();
  image.src = URL.createObjectURL(new Blob([text], {type: 'image/svg+xml'}));
  await image.decode();
  const canvas = document.createElement('canvas');
  canvas.width = PNG_SCALE * width;
  canvas.height = PNG_SCALE * height;
  canvas.getContext('2d').drawImage(image, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(image.src);
  canvas.toBlob(blob => download(blob, `${name}.png`), 'image/png');
}
