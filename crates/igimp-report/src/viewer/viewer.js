// Frames with a slider: which is shown, by which field, in which colours, and the value under the pointer.

// Frames whose arrays are kept unpacked.
const KEPT = 8;
// Frames of more particles are not asked for but by the user.
const LARGE = 200000;
// Time that a frame stays where the case has no time [ms].
const STAY = 250;
// A motion is played so fast at first that it takes no less than this [s].
const SHORTEST = 4;
// A scale this wide has more ticks [CSS pixel].
const WIDE = 560;

class Viewer {
  // `wish` may name a frame (from 1), a field, a place to point at (in space a point of the canvas, as shares of
  // its sides), a view, a cut, the least value shown in hundredths of the scale, arrows, contours, the outlines and the ends of a section; `changed` hears of every frame shown.
  constructor(wish, changed) {
    this.part = Object.fromEntries(["soil", "field", "map", "state", "state-label", "space", "view", "cut", "cut-row", "cut-at", "cut-told", "cut-side", "slant-row", "slant-turn", "slant-dip", "slant-told", "canvas", "surface", "bar", "ticks", "bar-label", "play", "slider", "pace", "pace-label", "when", "found", "keys", "clamp", "fixed", "bands", "contours", "outlines", "arrows", "least", "least-row", "least-told", "picture", "film", "draw-section", "section", "section-curve", "section-told", "section-table", "section-end"].map((id) => [id, document.getElementById(id)]));
    const { part } = this;
    this.scene = new Scene(part.canvas, part.surface);
    this.wish = wish;
    this.changed = changed;
    this.frames = [];
    this.states = [];
    this.loaded = new Map();
    this.ranges = new Map();
    this.turn = 0;
    this.pointed = -1;
    this.longest = new Map();
    // The range of a run beside, and who hears of that of this one.
    this.joint = null;
    this.ranged = () => {};
    part.contours.value = wish.contours || "";
    part.outlines.checked = wish.outlines !== "0";
    this.listen();
    this.section = new SectionTool(this);
    this.cutting = new Cutting(this);
  }

  // Takes up frames: each with a key that names its content, a label and a way to load its text, that of its rigid bodies
  // where there are some, and its time in seconds where the soil moves in time. Who looks at the last frame goes on to look
  // at the last.
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
    this.setPace();
    const { state } = this.part;
    const chosen = state.value;
    state.replaceChildren(new Option("frame by frame", ""), ...states.map((own) => new Option(own.label, own.name)));
    state.value = states.some((own) => own.name === chosen) ? chosen : "";
    this.part["state-label"].hidden = states.length === 0;
    // A run that ends with a search opens on the way in which the body fails.
    const mechanism = states.find((own) => own.isMechanism);
    if (mechanism && !this.shown && !this.wish.framed) state.value = mechanism.name;
    this.show();
  }

  listen() {
    const { part, scene } = this;
    part.slider.addEventListener("input", () => {
      part.state.value = "";
      this.show();
    });
    for (const name of ["field", "state", "map", "clamp", "fixed", "bands", "contours", "arrows"]) part[name].addEventListener("change", () => this.show());
    part.outlines.addEventListener("change", () => scene.outline(part.outlines.checked));
    part.play.addEventListener("click", () => (this.playing ? this.stop() : this.play()));
    document.getElementById("in").addEventListener("click", () => scene.zoom(1.6));
    document.getElementById("out").addEventListener("click", () => scene.zoom(1 / 1.6));
    document.getElementById("whole").addEventListener("click", () => this.look("whole"));
    part.picture.addEventListener("click", () => savePicture(this));
    part.film.addEventListener("click", async () => {
      this.stop();
      part.film.disabled = true;
      await saveFilm(this);
      part.film.disabled = false;
    });
    part.view.addEventListener("change", () => this.look(part.view.value));
    part.least.addEventListener("input", () => this.from(Number(part.least.value)));
    new Pointing(scene, (x, y) => this.pointAt(scene.boxAt(x, y)), (view) => this.look(view));
    window.addEventListener("resize", () => scene.paint());
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => scene.paint());
  }

  // Takes up a view by its name; without one the body was turned by hand.
  look(name) {
    if (name === "whole") this.scene.whole();
    else if (name) this.scene.look(name);
    this.part.view.value = name === "whole" ? "isometric" : name;
  }

  // Lets the pace be chosen where frames have times; at first it is the fastest that is slow enough to be followed.
  setPace() {
    const { part } = this;
    const times = this.frames.map((entry) => entry.seconds).filter(Number.isFinite);
    const lasts = times.length > 1 ? Math.max(...times) - Math.min(...times) : 0;
    part["pace-label"].hidden = lasts === 0;
    if (lasts === 0 || part.pace.dataset.set) return;
    const paces = [...part.pace.options].map((option) => option.value).filter((value) => Number(value) <= 1);
    part.pace.value = paces.find((value) => lasts / Number(value) >= SHORTEST) || paces[paces.length - 1];
    part.pace.dataset.set = "by itself";
  }

  // How long a frame stays until the next one [ms].
  stay() {
    const { slider, pace } = this.part;
    const [own, next] = [0, -1].map((k) => this.frames[Number(slider.value) - 1 - k]);
    const lasts = own && next ? next.seconds - own.seconds : NaN;
    return lasts >= 0 ? (1000 * lasts) / Number(pace.value) : STAY;
  }

  // What depends on the first frame: its dimension and its size.
  furnish(dimension) {
    const { part, wish } = this;
    // A scale for all frames asks for all of them.
    if (this.shown.particles > LARGE) part.fixed.checked = false;
    part.space.hidden = dimension === 2;
    // Of a thinned body the page has no inside.
    part["least-row"].hidden = dimension === 2 || Boolean(this.shown.planes);
    // Of a thinned body only some planes have all that they cross.
    part.cut.querySelector("option[value='3']").disabled = Boolean(this.shown.planes) || !this.scene.surface;
    part.canvas.style.touchAction = dimension === 2 ? "pan-y" : "none";
    part.keys.textContent = dimension === 2
      ? "Buttons, or the wheel on the drawing once it was clicked (or with Ctrl), zoom; drag to move. Keys: arrows, + − 0."
      : "Drag to turn, with Shift or the right button to move; the wheel zooms once the drawing was clicked (or with Ctrl), two fingers do both. Keys: arrows turn, Shift and arrows move, + − 0, and 1 to 7 for the views.";
    if (dimension === 3 && wish.view) {
      this.look(wish.view);
      wish.view = "";
    }
    if (dimension === 3 && wish.least) {
      this.from(wish.least);
      wish.least = 0;
    }
    if (dimension === 3 && wish.cut) {
      this.cutting.wish(wish.cut);
      wish.cut = null;
    }
  }

  // Leaves out particles whose value is less than so many hundredths of the scale.
  from(hundredths) {
    this.part.least.value = hundredths;
    this.scene.from(hundredths / 100);
    this.paint();
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
    await Promise.all([this.show(), new Promise((done) => setTimeout(done, this.stay()))]);
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

  // A frame, with its rigid bodies and reinforcement where there are some.
  static async read(entry) {
    const [soil, bodies, members] = await Promise.all([entry.load(), entry.bodies ? entry.bodies() : null, entry.members ? entry.members() : null]);
    return Object.assign(new Frame(soil), { bodies: bodies && new Frame(bodies), members: members && new Frame(members) });
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
    const { part } = this;
    this.turn += 1;
    const turn = this.turn;
    const entry = this.entry();
    if (!entry) return;
    try {
      const frame = await this.frame(entry);
      const field = this.choose(frame.shown());
      const [shapes, values] = [await frame.shapes(), await frame.values(field)];
      const bodies = { lines: [], triangles: [], members: [], water: entry.water || [], slip: entry.slip, soil: null };
      const soil = frame.arrayOf("material");
      if (soil) bodies.soil = await frame.numbers(soil);
      if (frame.members && frame.members.count > 0) bodies.members = (await frame.members.shapes()).corners;
      const arrows = await this.arrowsOf(frame);
      if (frame.bodies && frame.bodies.count > 0) bodies[frame.bodies.kind] = (await frame.bodies.shapes()).corners;
      this.ranges.set(this.named(entry, field), frame.range(field));
      if (turn !== this.turn) return;
      const isOther = this.shown !== frame;
      Object.assign(this, { shown: frame, values, field, shownEntry: entry });
      if (isOther) {
        const isFirst = this.scene.dimension === 0;
        this.scene.show(frame.dimension, shapes, bodies);
        this.scene.outline(part.outlines.checked);
        if (isFirst) this.furnish(frame.dimension);
      }
      this.scene.overlay.arrows = arrows;
      this.paint();
      this.section.tell();
      await this.describe();
      this.changed(entry, field, Number(part.slider.value));
      if (part.fixed.checked) await this.gather(field, turn);
    } catch (error) {
      if (turn === this.turn) part.when.textContent = `${entry.label}: cannot be read (${error.message})`;
    }
  }

  // The arrows that are chosen; their list is filled once.
  async arrowsOf(frame) {
    const { part, wish } = this;
    const all = frame.vectors();
    if (part.arrows.options.length < 2) {
      part.arrows.append(...all.map((own) => new Option(own.title, own.name)));
      if (wish.arrows) part.arrows.value = wish.arrows;
      if (part.arrows.selectedIndex < 0) part.arrows.selectedIndex = 0;
    }
    const own = all.find((vector) => vector.name === part.arrows.value);
    if (!own) return null;
    const array = frame.arrayOf(own.name);
    const numbers = await frame.numbers(array);
    const { components } = array;
    let most = own.kind === "vector" ? array.range[3][1] : 0;
    for (let at = 0; own.kind === "stress" && at < numbers.length; at += components) {
      for (const { value } of principal(numbers[at], numbers[at + 1], numbers[at + 3])) if (Math.abs(value) > most) most = Math.abs(value);
    }
    // The same length means the same in all frames that were seen.
    const largest = Math.max(most, this.longest.get(own.name) || 0);
    this.longest.set(own.name, largest);
    return { numbers, components, largest, kind: own.kind };
  }

  // A picture of what is chosen, once it is drawn.
  settled() {
    this.scene.paint();
    return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(pictureOf(this)))));
  }

  named(entry, field) {
    return `${entry.key} ${field.key}`;
  }

  // Reads the range of every frame, for one scale over all of them.
  async gather(field, turn) {
    const missing = this.frames.filter((entry) => !this.ranges.has(this.named(entry, field)));
    for (const entry of missing) {
      const frame = await this.frame(entry);
      this.ranges.set(this.named(entry, field), frame.range(field));
      if (turn !== this.turn) return;
    }
    if (missing.length > 0) this.paint();
  }

  // Least and largest value of the scale, in SI units: with those of a run beside, where it shows the same field.
  range() {
    const { part, field, joint } = this;
    const own = this.ownRange();
    const isJoint = joint && joint.field === field.key && part.fixed.checked;
    const scale = isJoint ? [Math.min(own[0], joint.own[0]), Math.max(own[1], joint.own[1])] : own;
    this.ranged({ field: field.key, own, scale });
    return scale;
  }

  // Least and largest value of this run.
  ownRange() {
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
    this.unit = unitFor(field.unit, Math.max(Math.abs(low), Math.abs(high)));
    this.barTicks = this.ticksOfBar(low, high, part.bar.clientWidth > WIDE ? 10 : 7);
    let colours = mixed(MAPS[map]);
    if (part.bands.checked && !field.whole) colours = banded(colours, this.barTicks.map((tick) => tick.share));
    this.colours = colours;
    this.scene.colour(this.values, [low, high], colours);
    this.contour(low, high);
    const least = low + this.scene.least * (high - low);
    part["least-told"].textContent = this.scene.least > 0 ? `${short(field.whole ? least : least / this.unit[0])}${this.unit[1] ? ` ${this.unit[1]}` : ""} on` : "all";
    const every = part.bands.checked ? 1 : 8;
    const stops = colours.map((colour, k) => [colour, k]).filter(([, k]) => k % every === 0 || k === LEVELS - 1);
    part.bar.style.background = `linear-gradient(to right, ${stops.map(([colour, k]) => `rgb(${colour}) ${((100 * k) / (LEVELS - 1)).toFixed(2)}%`).join(", ")})`;
    part.ticks.replaceChildren(...this.barTicks.map(({ share, text }) => {
      const mark = Object.assign(document.createElement("span"), { textContent: text });
      mark.style.left = `${(100 * share).toFixed(3)}%`;
      return mark;
    }));
    part["bar-label"].textContent = `${field.title}${this.unit[1] ? ` [${this.unit[1]}]` : ""}${field.rest}`;
    part.when.textContent = `${this.shownEntry.label}${this.scene.bodies.slip ? "; red: where soil shears most as it fails" : ""}`;
    part.slider.setAttribute("aria-valuetext", this.shownEntry.label);
  }

  // Contours at the ticks of the scale, where they are wanted.
  contour(low, high) {
    const { part, scene, field, barTicks } = this;
    const isWanted = part.contours.value !== "" && !field.whole && high > low;
    const ticks = isWanted ? barTicks.filter(({ share }) => share > 0.001 && share < 0.999) : [];
    const levels = ticks.map(({ share }) => low + share * (high - low));
    const colours = ticks.map(({ share }) => this.colours[Math.round(share * (this.colours.length - 1))]);
    scene.contour(this.values, levels, colours, part.contours.value === "values" ? ticks.map(({ text }) => text) : null);
  }

  // Ticks of the colour bar at round values, about so many: their place on it, and their text.
  ticksOfBar(low, high, about) {
    const { field, unit } = this;
    if (!Number.isFinite(low)) return [{ share: 0.5, text: "–" }];
    if (!(high > low)) return [{ share: 0.5, text: short(field.whole ? Math.round(low) : low / unit[0]) }];
    const divide = field.whole ? 1 : unit[0];
    let values = ticksOf(low / divide, high / divide, about);
    if (field.whole) values = values.filter((value) => Number.isInteger(value));
    return values.map((value) => ({ share: (value * divide - low) / (high - low), text: field.whole ? String(value) : tickText(value, values) }));
  }

  pointAt(box) {
    if (!this.shown) return;
    this.pointed = box;
    this.describe();
  }

  // The box at the place that was wished for.
  wished([x, y]) {
    const { scene } = this;
    const place = scene.layout();
    return scene.dimension === 2 ? scene.holding([x, y]) : scene.boxAt(x * place.width, y * place.height);
  }

  // Tells of the particle that is pointed at; it stays the same from frame to frame.
  async describe() {
    const { found } = this.part;
    if (this.wish.hover && this.shown) {
      this.pointed = this.wished(this.wish.hover);
      this.wish.hover = null;
    }
    const cell = this.pointed;
    this.scene.marked = cell;
    this.scene.paint();
    if (cell < 0 || cell >= this.values.length) return;
    const number = await this.shown.particle(cell);
    if (cell !== this.pointed) return;
    const [x, y, z] = this.scene.centre(cell);
    const place = this.scene.dimension === 2 ? `(${short(x)}, ${short(y)})` : `(${short(x)}, ${short(y)}, ${short(z)})`;
    const value = this.values[cell];
    const unit = ["", "-"].includes(this.unit[1]) ? "" : ` ${this.unit[1]}`;
    const read = short(this.field.whole ? value : value / this.unit[0]);
    found.textContent = `Particle ${number} at ${place} m: ${this.field.title} ${read}${unit}`;
    Object.assign(found.dataset, { particle: number, x, y, value });
  }
}
