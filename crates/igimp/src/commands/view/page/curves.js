// Curves and histories at monitors, as small charts with a cursor at the frame.

// Rows of a table; texts in quotes may hold commas. A last line without end is still being written.
function table(text) {
  const rows = [];
  let row = [];
  let entry = "";
  let quoted = false;
  for (let k = 0; k < text.length; k += 1) {
    const letter = text[k];
    if (quoted) {
      if (letter !== '"') entry += letter;
      else if (text[k + 1] === '"') {
        entry += '"';
        k += 1;
      } else quoted = false;
    } else if (letter === '"') quoted = true;
    else if (letter === "," || letter === "\n") {
      row.push(entry.replace(/\r$/, ""));
      entry = "";
      if (letter === "\n") {
        rows.push(row);
        row = [];
      }
    } else entry += letter;
  }
  const [header = [], ...lines] = rows;
  return { header, rows: lines.map((line) => line.map(Number)) };
}

// A label without the marks of indices and powers.
function plain(text) {
  return text.replace(/[_^]\{([^}]*)\}/g, "$1").replaceAll("_", " ");
}

const SVG = "http://www.w3.org/2000/svg";

function drawn(parent, name, attributes, text) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
}

class Chart {
  constructor(parent, title, labels) {
    this.labels = labels.map(plain);
    this.card = document.createElement("article");
    this.card.append(document.createElement("h2"), document.createElementNS(SVG, "svg"), document.createElement("p"));
    [this.head, this.svg, this.foot] = this.card.children;
    this.head.textContent = title;
    parent.append(this.card);
  }

  // Points with the number of the line that they belong to.
  show(points) {
    this.points = points;
    const [width, height, left, right, top, bottom] = [330, 200, 52, 322, 8, 160];
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.setAttribute("role", "img");
    this.svg.setAttribute("aria-label", `${this.labels[1]} over ${this.labels[0]}`);
    this.svg.replaceChildren();
    const range = (axis) => {
      const own = points.map((point) => point[axis]).filter(Number.isFinite);
      return own.length > 0 ? widened(Math.min(...own), Math.max(...own)) : [0, 1];
    };
    drawn(this.svg, "text", { x: (left + right) / 2, y: height - 8, "text-anchor": "middle" }, this.labels[0]);
    drawn(this.svg, "rect", { class: "axis", x: left, y: top, width: right - left, height: bottom - top });
    if (points.length === 0) return;
    const [xs, ys] = [range(0), range(1)];
    this.x = (x) => left + ((right - left) * (x - xs[0])) / (xs[1] - xs[0]);
    this.y = (y) => bottom - ((bottom - top) * (y - ys[0])) / (ys[1] - ys[0]);
    const [xTicks, yTicks] = [ticksOf(...xs, 4), ticksOf(...ys, 4)];
    for (const x of xTicks) drawn(this.svg, "text", { x: this.x(x), y: bottom + 15, "text-anchor": "middle" }, tickText(x, xTicks));
    for (const y of yTicks) drawn(this.svg, "text", { x: left - 5, y: this.y(y) + 4, "text-anchor": "end" }, tickText(y, yTicks));
    for (const line of new Set(points.map((point) => point[2]))) {
      const own = points.filter((point) => point[2] === line && point.every(Number.isFinite));
      const places = own.map(([x, y]) => `${this.x(x).toFixed(2)},${this.y(y).toFixed(2)}`);
      drawn(this.svg, "polyline", { class: "curve", points: places.join(" ") });
    }
    this.cursor = drawn(this.svg, "g", { class: "cursor" });
    [this.top, this.bottom] = [top, bottom];
  }

  // Puts the cursor on a row, or takes it away.
  point(row) {
    if (this.points.length === 0) return;
    this.cursor.replaceChildren();
    const point = this.points[row];
    this.foot.textContent = point ? `${this.labels[1]}: ${short(point[1])} at ${short(point[0])}` : this.labels[1];
    this.card.dataset.row = point ? row : "";
    if (!point || !point.every(Number.isFinite)) return;
    const [x, y] = [this.x(point[0]), this.y(point[1])];
    drawn(this.cursor, "line", { x1: x, x2: x, y1: this.top, y2: this.bottom });
    drawn(this.cursor, "circle", { cx: x, cy: y, r: 3.5 });
  }
}
