// The last frame of a report, drawn when its fold is opened first.

document.getElementById("last-frame").addEventListener("toggle", () => {
  const page = document.getElementById("last-frame-data");
  const bodies = document.getElementById("last-frame-bodies");
  const viewer = new Viewer({}, () => {});
  viewer.take([{ name: "last", key: "last", label: page.dataset.label, load: async () => page.textContent, bodies: bodies && (async () => bodies.textContent) }], []);
}, { once: true });
