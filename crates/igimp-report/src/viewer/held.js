// The frames of a report, drawn when their fold is opened first. Behind the # of its address may stand wishes.

document.getElementById("held").addEventListener("toggle", () => {
  const wish = new URLSearchParams(location.hash.slice(1));
  const numbers = (name) => (wish.has(name) ? wish.get(name).split(",").map(Number) : null);
  const viewer = new Viewer({ field: wish.get("field"), view: wish.get("view"), cut: numbers("cut"), hover: numbers("hover"), least: Number(wish.get("least")), arrows: wish.get("arrows"), section: numbers("section"), contours: wish.get("contours"), outlines: wish.get("outlines") }, () => {});
  const over = JSON.parse(document.getElementById("held-over").textContent);
  const frames = [...document.querySelectorAll("script.held-frame")].map((page, k) => {
    const beside = (name) => {
      for (let next = page.nextElementSibling; next && !next.classList.contains("held-frame"); next = next.nextElementSibling) {
        if (next.classList.contains(name)) return async () => next.textContent;
      }
      return null;
    };
    const [bodies, members] = ["held-bodies", "held-members"].map(beside);
    const seconds = page.dataset.seconds ? Number(page.dataset.seconds) : NaN;
    return { name: `held ${k}`, key: `held ${k}`, label: page.dataset.label, seconds, load: async () => page.textContent, bodies, members, ...over[page.dataset.stage] };
  });
  viewer.take(frames, []);
}, { once: true });
if (new URLSearchParams(location.hash.slice(1)).has("look")) document.getElementById("held").open = true;
