// The cut in space: where its sliders put it, and which side it takes away.

class Cutting {
  constructor(viewer) {
    this.viewer = viewer;
    this.side = 1;
    const { part } = viewer;
    part.cut.addEventListener("change", () => this.lay());
    part["cut-at"].addEventListener("input", () => this.there());
    for (const name of ["slant-turn", "slant-dip"]) part[name].addEventListener("input", () => this.lay(this.share()));
    part["cut-side"].addEventListener("click", () => {
      this.side = -this.side;
      this.there();
    });
  }

  // Takes up a cut that was wished for: axis, share of the way, side, and the direction and dip of a slanted one.
  wish([axis, share, side, turn, dip]) {
    const { part } = this.viewer;
    if (turn !== undefined) [part["slant-turn"].value, part["slant-dip"].value] = [turn, dip];
    part.cut.value = String(axis);
    this.side = side || 1;
    this.lay(share);
  }

  // Lets the slider of the cut run over the body: anywhere, or from one place to the next where the page has
  // the particles of some planes alone.
  lay(share = 0.5) {
    const { part, scene, shown } = this.viewer;
    const axis = part.cut.value === "" ? -1 : Number(part.cut.value);
    part["cut-row"].hidden = axis < 0;
    part["slant-row"].hidden = axis !== 3;
    if (axis === 3) {
      const [low, high] = offsetsOf(this.slant(), scene.extent);
      const slider = Object.assign(part["cut-at"], { min: low, max: high, step: (high - low) / 500 || 1 });
      slider.value = low + share * (high - low);
    } else if (axis >= 0) {
      const { planes } = shown;
      const slider = part["cut-at"];
      const { low, high } = scene.extent;
      const places = planes ? planes[axis] : null;
      Object.assign(slider, places ? { min: 0, max: places.length - 1, step: 1 } : { min: low[axis], max: high[axis], step: (high[axis] - low[axis]) / 500 || 1 });
      slider.value = Number(slider.min) + share * (slider.max - slider.min);
    }
    this.there();
  }

  // The normal of a slanted cut.
  slant() {
    const { part } = this.viewer;
    return slantOf(Number(part["slant-turn"].value), Number(part["slant-dip"].value));
  }

  // Where the slider of the cut stands, as a share of its way.
  share() {
    const { min, max, value } = this.viewer.part["cut-at"];
    return max > min ? (value - min) / (max - min) : 0.5;
  }

  there() {
    const { part, scene, shown } = this.viewer;
    if (part.cut.value === "") scene.cut = null;
    else if (part.cut.value === "3") {
      const [normal, at] = [this.slant(), Number(part["cut-at"].value)];
      const { side } = this;
      scene.cut = { axis: -1, own: this.side, normal: normal.map((x) => side * x), offset: side * at };
      part["slant-told"].textContent = `${part["slant-turn"].value}° from x, ${part["slant-dip"].value}°`;
      part["cut-told"].textContent = "";
    } else {
      const axis = Number(part.cut.value);
      const { planes } = shown;
      const at = planes ? planes[axis][Math.min(Number(part["cut-at"].value), planes[axis].length - 1)] : Number(part["cut-at"].value);
      // What is taken away is the side of the eye, unless the other one is asked for.
      const side = this.side * (scene.layout().eye[axis] < 0 ? -1 : 1);
      if (!scene.cut || scene.cut.axis !== axis || scene.cut.own !== this.side) this.facing = side;
      const normal = [0, 0, 0];
      normal[axis] = this.facing;
      scene.cut = { axis, own: this.side, normal, offset: at * this.facing };
      part["cut-told"].textContent = `${"xyz"[axis]} = ${short(at)} m`;
    }
    scene.slice();
    this.viewer.section.tell();
    scene.paint();
  }
}
