// Helper functions for SVG elements and axis labels.

export function element(name, attributes = {}, parent = null) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) {
    made.setAttribute(key, value);
  }
  if (parent) {
    parent.append(made);
  }
  return made;
}

// A round step (1, 2 or 5 times a power of ten) that divides the range into at most `count` parts.
export function roundStep(range, count) {
  const rough = range / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * [1, 2, 5, 10].find(factor => factor * power >= rough * 0.999);
}

// A number without trailing zeros: 0.5, 1, -0.25.
export function short(value) {
  return String(Math.round(value * 1000) / 1000 + 0);
}
