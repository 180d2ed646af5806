// Frames with a slider: which is shown, by which field, in which colours, and the value under the pointer.

// Frames whose arrays are kept unpacked.
const KEPT = 8;
// Colours of a scale.
const LEVELS = 128;

function mixed(anchors) {
  return Array.from({ length: LEVELS }, (_, level) => {
    const place = (level / (LEVELS - 1)) * (anchors.length - 1);
    const k = Math.min(Math.floor(place), anchors.length - 2);
    const part = [0, 1, 2].map((c) => Math.round(anchors[k][c] + (place - k) * (anchors[k + 1][c] - anchors[k][c])));
    return `rgb(${part.join(",")})`;
  });
}

class Viewer {
  // `wish` may name a frame (from 1), a field and a place to point at; `changed` hears of every frame shown.
  constructor(wish, changed) {
    this.part = Object.fromEntries(["soil", "field", "map", "state", "state-label", "canvas", "bar", "ticks", "bar-label", "play", "slider", "when", "found", "clamp", "fixed"].map((id) => [id, document.getElementById(id)]));
    this.soil = new Soil(this.part.canvas);
    this.wish = wish;
    this.changed = changed;
    this.frames = [];
    this.states = [];
    this.loaded = new Map();
    this.ranges = new Map();
    this.turn = 0;
    this.pointed = -1;
    this.listen();
  }

  // Takes up frames: each with a key that names its content, a label and a way to load its text, and that of
  // its rigid bodies where there are some. Who
  // looks at the last frame goes on to look at the last.
  take(frames, states) {
    const { slider } = this.part;
    const wasLast = this.frames.length === 0 || Number(slider.value) === this.frames.length;
    this.frames = frames;
    this.states = states;
    this.part.soil.hidden = frames.length === 0;
    if (frames.length === 0) return;
    slider.max = frames.length;
    if (wasLast && !this.playing) slider.value = frames.length;
    if (this.wish.frame) {
      slider.value = this.wish.frame;
      this.wish.frame = 0;
    }
    slider.disabled = frames.length < 2;
    this.part.play.disabled = frames.length < 2;
    const { state } = this.part;
    const chosen = state.value;
    state.replaceChildren(new Option("frame by frame", ""), ...states.map((own) => new Option(own.label, own.name)));
    state.value = states.some((own) => own.name === chosen) ? chosen : "";
    this.part["state-label"].hidden = states.length === 0;
    this.show();
  }

  listen() {
    const { part, soil } = this;
    part.slider.addEventListener("input", () => {
      part.state.value = "";
      this.show();
    });
    for (const name of ["field", "state", "map", "clamp", "fixed"]) part[name].addEventListener("change", () => this.show());
    part.play.addEventListener("click", () => (this.playing ? this.stop() : this.play()));
    document.getElementById("in").addEventListener("click", () => soil.zoom(1.6));
    document.getElementById("out").addEventListener("click", () => soil.zoom(1 / 1.6));
    document.getElementById("whole").addEventListener("click", () => soil.whole());
    const inside = (event) => {
      const box = part.canvas.getBoundingClientRect();
      return soil.placeAt(event.clientX - box.left, event.clientY - box.top);
    };
    part.canvas.addEventListener("wheel", (event) => {
      // As on maps: the wheel alone belongs to the page.
      if (!event.ctrlKey && !event.metaKey) return;
      event.preventDefault();
      soil.zoom(1.2 ** -Math.sign(event.deltaY), inside(event));
    }, { passive: false });
    part.canvas.addEventListener("pointermove", (event) => {
      if (event.buttons === 1) soil.move(event.movementX, event.movementY);
      else this.pointAt(...inside(event));
    });
    part.canvas.addEventListener("pointerdown", (event) => this.pointAt(...inside(event)));
    window.addEventListener("resize", () => soil.paint());
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => soil.paint());
  }

  play() {
    const { slider } = this.part;
    if (Number(slider.value) === this.frames.length) slider.value = 1;
    else slider.stepUp();
    this.playing = true;
    this.step();
  }

  // Shows the frame of the slider, and moves on when it is there.
  async step() {
    const { part } = this;
    part.state.value = "";
    part.play.textContent = "❚❚";
    part.play.setAttribute("aria-label", "Pause");
    await Promise.all([this.show(), new Promise((done) => setTimeout(done, 250))]);
    if (!this.playing) return;
    if (Number(part.slider.value) === this.frames.length) {
      this.stop();
      return;
    }
    part.slider.stepUp();
    this.step();
  }

  stop() {
    this.playing = false;
    this.part.play.textContent = "▶";
    this.part.play.setAttribute("aria-label", "Play");
  }

  // The frame, or state of a search, that is chosen.
  entry() {
    const state = this.states.find((own) => own.name === this.part.state.value);
    return state || this.frames[Number(this.part.slider.value) - 1];
  }

  // A frame, with its rigid bodies where there are some.
  static async read(entry) {
    const [soil, bodies] = await Promise.all([entry.load(), entry.bodies ? entry.bodies() : null]);
    return Object.assign(new Frame(soil), { bodies: bodies && new Frame(bodies) });
  }

  // A frame as a promise; those looked at last are kept.
  frame(entry) {
    const found = this.loaded.get(entry.key) || Viewer.read(entry);
    this.loaded.delete(entry.key);
    this.loaded.set(entry.key, found);
    found.catch(() => this.loaded.delete(entry.key));
    if (this.loaded.size > KEPT) this.loaded.delete(this.loaded.keys().next().value);
    return found;
  }

  // Fills the list of fields once, with the displacement chosen where there is no wish.
  choose(fields) {
    const { field } = this.part;
    if (field.options.length === 0) {
      field.replaceChildren(...fields.map((own) => new Option(`${own.title}${own.unit ? ` [${own.unit}]` : ""}${own.rest}`, own.key)));
      field.value = this.wish.field || "";
      if (field.selectedIndex < 0) field.selectedIndex = 0;
    }
    return fields.find((own) => own.key === field.value) || fields[0];
  }

  async show() {
    this.turn += 1;
    const turn = this.turn;
    const entry = this.entry();
    if (!entry) return;
    try {
      const frame = await this.frame(entry);
      const field = this.choose(frame.fields());
      const [corner, values] = [await frame.corners(), await frame.values(field)];
      const lines = frame.bodies ? await frame.bodies.lines() : [];
      this.ranges.set(this.named(entry, field), rangeOf(values));
      if (turn !== this.turn) return;
      Object.assign(this, { shown: frame, values, field, shownEntry: entry });
      Object.assign(this.soil, { corner, lines });
      this.paint();
      await this.describe();
      this.changed(entry, field, Number(this.part.slider.value));
      if (this.part.fixed.checked) await this.gather(field, turn);
    } catch (error) {
      if (turn === this.turn) this.part.when.textContent = `${entry.label}: cannot be read (${error.message})`;
    }
  }

  named(entry, field) {
    return `${entry.key} ${field.key}`;
  }

  // Reads the range of every frame, for one scale over all of them.
  async gather(field, turn) {
    const missing = this.frames.filter((entry) => !this.ranges.has(this.named(entry, field)));
    for (const entry of missing) {
      const frame = await this.frame(entry);
      this.ranges.set(this.named(entry, field), rangeOf(await frame.values(field)));
      if (turn !== this.turn) return;
    }
    if (missing.length > 0) this.paint();
  }

  // Least and largest value of the scale, in SI units.
  range() {
    const { part, field } = this;
    const entries = part.fixed.checked && this.frames.includes(this.shownEntry) ? this.frames : [this.shownEntry];
    const kind = part.clamp.checked && !field.whole ? "inner" : "whole";
    const known = entries.map((entry) => this.ranges.get(this.named(entry, field))).filter(Boolean);
    const ends = known.map((range) => range[kind]).filter((range) => range.every(Number.isFinite));
    return [Math.min(...ends.map((end) => end[0])), Math.max(...ends.map((end) => end[1]))];
  }

  paint() {
    const { part, field } = this;
    let [low, high] = this.range();
    const [below, above] = [Math.max(-low, 0), Math.max(high, 0)];
    const isOfBothSigns = !field.whole && Math.min(below, above) > 0.15 * Math.max(below, above);
    const map = part.map.value === "auto" ? (isOfBothSigns ? "diverging" : "viridis") : part.map.value;
    if (map === "diverging") [low, high] = [-Math.max(Math.abs(low), Math.abs(high)), Math.max(Math.abs(low), Math.abs(high))];
    const colours = mixed(MAPS[map]);
    this.unit = unitFor(field.unit, Math.max(Math.abs(low), Math.abs(high)));
    this.soil.show(this.soil.corner, this.values, [low, high], colours);
    part.bar.style.background = `linear-gradient(to right, ${colours.filter((_, k) => k % 8 === 0 || k === LEVELS - 1).join(", ")})`;
    const count = field.whole ? Math.min(high - low, 8) : 4;
    const shares = high > low ? Array.from({ length: count + 1 }, (_, k) => k / count) : [0.5];
    const tick = (share) => {
      const value = low + share * (high - low);
      if (field.whole) return Math.round(value);
      return Math.abs(value) < 1e-4 * Math.max(-low, high) ? 0 : value / this.unit[0];
    };
    part.ticks.replaceChildren(...shares.map((share) => Object.assign(document.createElement("span"), { textContent: Number.isFinite(low) ? short(tick(share)) : "–" })));
    part["bar-label"].textContent = `${field.title}${this.unit[1] ? ` [${this.unit[1]}]` : ""}${field.rest}`;
    part.when.textContent = this.shownEntry.label;
    part.slider.setAttribute("aria-valuetext", this.shownEntry.label);
  }

  pointAt(x, y) {
    this.pointed = this.soil.cellAt(x, y);
    this.describe();
  }

  // Tells of the particle that is pointed at; it stays the same from frame to frame.
  async describe() {
    const { found } = this.part;
    if (this.wish.hover && this.shown) {
      this.pointed = this.soil.cellAt(...this.wish.hover);
      this.wish.hover = null;
    }
    const cell = this.pointed;
    this.soil.marked = cell;
    this.soil.paint();
    if (cell < 0 || cell >= this.values.length) return;
    const number = await this.shown.particle(cell);
    if (cell !== this.pointed) return;
    const [x, y] = this.soil.centre(cell);
    const value = this.values[cell];
    const unit = ["", "-"].includes(this.unit[1]) ? "" : ` ${this.unit[1]}`;
    const read = short(this.field.whole ? value : value / this.unit[0]);
    found.textContent = `Particle ${number} at (${short(x)}, ${short(y)}) m: ${this.field.title} ${read}${unit}`;
    Object.assign(found.dataset, { particle: number, x, y, value });
  }
}
