// Scales of colours.

// Colours of a scale.
const LEVELS = 256;

function mixed(anchors) {
  return Array.from({ length: LEVELS }, (_, level) => {
    const place = (level / (LEVELS - 1)) * (anchors.length - 1);
    const k = Math.min(Math.floor(place), anchors.length - 2);
    const part = [0, 1, 2].map((c) => Math.round(anchors[k][c] + (place - k) * (anchors[k + 1][c] - anchors[k][c])));
    return part;
  });
}

// The same colours in steps between places on the scale, each in the colour of its middle.
function banded(colours, shares) {
  const edges = [0, ...shares.filter((share) => share > 0.001 && share < 0.999), 1];
  const last = colours.length - 1;
  return colours.map((_, level) => {
    const k = Math.min(edges.findLastIndex((edge) => edge <= level / last), edges.length - 2);
    return colours[Math.round(0.5 * (edges[k] + edges[k + 1]) * last)];
  });
}
