// The frames of a report, drawn when their fold is opened first. Behind the # of its address may stand wishes.

document.getElementById("held").addEventListener("toggle", () => {
  const wish = new URLSearchParams(location.hash.slice(1));
  const numbers = (name) => (wish.has(name) ? wish.get(name).split(",").map(Number) : null);
  const viewer = new Viewer({ field: wish.get("field"), view: wish.get("view"), cut: numbers("cut"), hover: numbers("hover") }, () => {});
  const frames = [...document.querySelectorAll("script.held-frame")].map((page, k) => {
    const next = page.nextElementSibling;
    const bodies = next && next.classList.contains("held-bodies") ? async () => next.textContent : null;
    return { name: `held ${k}`, key: `held ${k}`, label: page.dataset.label, load: async () => page.textContent, bodies };
  });
  viewer.take(frames, []);
}, { once: true });
if (new URLSearchParams(location.hash.slice(1)).has("look")) document.getElementById("held").open = true;
