// A picture of what is seen, a film of it, and tables, to be kept.

function keep(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// The drawing with its colour bar and what is said of it, on a white ground.
function pictureOf(viewer) {
  const { scene, part, field } = viewer;
  const { canvas, below } = scene;
  const sharp = window.devicePixelRatio || 1;
  const foot = Math.round(74 * sharp);
  const sheet = document.createElement("canvas");
  [sheet.width, sheet.height] = [canvas.width, canvas.height + foot];
  const pen = sheet.getContext("2d");
  const ground = getComputedStyle(canvas.parentElement).backgroundColor;
  pen.fillStyle = ground && ground !== "rgba(0, 0, 0, 0)" ? ground : "#ffffff";
  pen.fillRect(0, 0, sheet.width, sheet.height);
  if (scene.surface) pen.drawImage(below, 0, 0);
  pen.drawImage(canvas, 0, 0);
  pen.scale(sharp, sharp);
  const [left, right, top] = [48, canvas.width / sharp - 24, canvas.height / sharp];
  const ramp = pen.createLinearGradient(left, 0, right, 0);
  viewer.colours.forEach((colour, k) => ramp.addColorStop(k / (viewer.colours.length - 1), `rgb(${colour})`));
  pen.fillStyle = ramp;
  pen.fillRect(left, top + 6, right - left, 12);
  pen.fillStyle = cssColour("--ink") || cssColour("--soft");
  pen.font = "12px system-ui, sans-serif";
  pen.textAlign = "center";
  for (const { share, text } of viewer.barTicks) {
    const x = left + share * (right - left);
    pen.fillRect(x, top + 18, 1, 4);
    pen.fillText(text, x, top + 34);
  }
  pen.fillText(part["bar-label"].textContent, (left + right) / 2, top + 50);
  pen.fillText(part.when.textContent, (left + right) / 2, top + 67);
  sheet.dataset.field = field.key;
  return sheet;
}

function nameOf(viewer, ending) {
  const plain = `${document.title} ${viewer.field.title}`.replace(/[^A-Za-z0-9]+/g, "-").replace(/^-|-$/g, "").toLowerCase();
  return `${plain || "picture"}.${ending}`;
}

function savePicture(viewer) {
  pictureOf(viewer).toBlob((blob) => keep(blob, nameOf(viewer, "png")));
}

// Whether the browser can make a film of a canvas.
function canFilm() {
  return typeof MediaRecorder !== "undefined" && Boolean(HTMLCanvasElement.prototype.captureStream);
}

// Plays all frames from the first one and keeps them as WebM.
async function saveFilm(viewer) {
  const { slider } = viewer.part;
  slider.value = 1;
  await viewer.show();
  const first = await viewer.settled();
  const screen = document.createElement("canvas");
  [screen.width, screen.height] = [first.width, first.height];
  const pen = screen.getContext("2d");
  const recorder = new MediaRecorder(screen.captureStream());
  const parts = [];
  recorder.ondataavailable = (event) => parts.push(event.data);
  const done = new Promise((ended) => {
    recorder.onstop = ended;
  });
  pen.drawImage(first, 0, 0);
  recorder.start();
  for (let k = 1; k <= viewer.frames.length; k += 1) {
    slider.value = k;
    await viewer.show();
    const sheet = await viewer.settled();
    pen.drawImage(sheet, 0, 0, screen.width, screen.height);
    await new Promise((next) => setTimeout(next, k === viewer.frames.length ? 1500 : Math.max(viewer.stay(), 34)));
  }
  recorder.stop();
  await done;
  keep(new Blob(parts, { type: recorder.mimeType }), nameOf(viewer, "webm"));
}
