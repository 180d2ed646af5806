// What pointer, wheel and keys do to the scene.

// Degrees by CSS pixel of a drag, and by key.
const TURN = 0.4;
const STEP = 7.5;

class Pointing {
  // `pointed` hears where the pointer is, `turned` that the view is another one.
  constructor(scene, pointed, turned) {
    this.scene = scene;
    this.pointed = pointed;
    this.turned = turned;
    this.down = new Map();
    const { canvas } = scene;
    const on = (name, call, options) => canvas.addEventListener(name, call.bind(this), options);
    on("wheel", this.wheel, { passive: false });
    on("pointerdown", this.press);
    on("pointermove", this.move);
    on("pointerup", this.release);
    on("pointercancel", this.release);
    on("keydown", this.key);
    on("contextmenu", (event) => scene.dimension === 3 && event.preventDefault());
  }

  inside(event) {
    const box = this.scene.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  // As on maps: the wheel belongs to the page, unless the body was taken up or Ctrl is held.
  wheel(event) {
    const isOurs = event.ctrlKey || event.metaKey || document.activeElement === this.scene.canvas;
    if (!isOurs || event.deltaY === 0) return;
    event.preventDefault();
    this.scene.zoom(1.2 ** -Math.sign(event.deltaY), this.inside(event));
  }

  press(event) {
    this.down.set(event.pointerId, this.inside(event));
    this.pointed(...this.inside(event));
    try {
      this.scene.canvas.setPointerCapture(event.pointerId);
    } catch {
      // A pointer that is gone already.
    }
  }

  release(event) {
    this.down.delete(event.pointerId);
  }

  move(event) {
    const { scene, down } = this;
    const to = this.inside(event);
    const from = down.get(event.pointerId);
    if (!from) {
      this.pointed(...to);
      return;
    }
    down.set(event.pointerId, to);
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    if (down.size === 2) {
      const other = [...down].find(([id]) => id !== event.pointerId)[1];
      const apart = (point) => Math.hypot(point[0] - other[0], point[1] - other[1]) || 1;
      scene.zoom(apart(to) / apart(from), [0.5 * (to[0] + other[0]), 0.5 * (to[1] + other[1])]);
      scene.move(0.5 * dx, 0.5 * dy);
    } else if (scene.dimension === 2 || event.buttons !== 1 || event.shiftKey || event.ctrlKey) {
      scene.move(dx, dy);
    } else {
      scene.rotate(-TURN * dx, TURN * dy);
      this.turned("");
    }
  }

  key(event) {
    const { scene } = this;
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const arrow = arrows[event.key];
    const views = ["isometric", "front", "back", "left", "right", "top", "bottom"];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (arrow && (event.shiftKey || scene.dimension === 2)) scene.move(-30 * arrow[0], -30 * arrow[1]);
    else if (arrow) {
      scene.rotate(STEP * arrow[0], -STEP * arrow[1]);
      this.turned("");
    } else if (event.key === "+" || event.key === "=") scene.zoom(1.25);
    else if (event.key === "-") scene.zoom(0.8);
    else if (event.key === "0" || event.key === "Home") this.turned("whole");
    else if (scene.dimension === 3 && views[Number(event.key) - 1]) this.turned(views[Number(event.key) - 1]);
    else return;
    event.preventDefault();
  }
}
