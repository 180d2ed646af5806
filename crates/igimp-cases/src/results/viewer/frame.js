// Frames: VTK's XML format as igimp writes it. Arrays stand in the text in base64, compressed by zlib in
// blocks; an array is unpacked when it is first asked for.

// Whole numbers of eight bytes, as far as they are exact.
function ofEightBytes(bytes) {
  const halves = new Uint32Array(bytes.buffer);
  const numbers = new Float64Array(halves.length / 2);
  for (let k = 0; k < numbers.length; k += 1) numbers[k] = halves[2 * k] + 4294967296 * halves[2 * k + 1];
  return numbers;
}

// Numbers of the bytes of an array, little-endian as browsers are.
const READERS = {
  Float64: (bytes) => new Float64Array(bytes.buffer),
  Int64: ofEightBytes,
  UInt64: ofEightBytes,
  Int32: (bytes) => Float64Array.from(new Int32Array(bytes.buffer)),
  UInt8: (bytes) => Float64Array.from(bytes),
};

function fromBase64(text) {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let k = 0; k < letters.length; k += 1) bytes[k] = letters.charCodeAt(k);
  return bytes;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Number of blocks, their size, size of a smaller last one, compressed size of each; then the blocks.
async function unpacked(text) {
  const blocks = ofEightBytes(fromBase64(text.slice(0, 12)).slice(0, 8))[0];
  const length = 4 * Math.ceil((8 * (3 + blocks)) / 3);
  const sizes = ofEightBytes(fromBase64(text.slice(0, length))).subarray(3);
  const data = fromBase64(text.slice(length));
  let start = 0;
  const parts = await Promise.all([...sizes].map((size) => {
    start += size;
    return inflated(data.subarray(start - size, start));
  }));
  const whole = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}

class Frame {
  constructor(text) {
    const page = new DOMParser().parseFromString(text, "application/xml");
    this.cells = Number(page.querySelector("Piece").getAttribute("NumberOfCells"));
    const arrays = (selector) => new Map([...page.querySelectorAll(selector)].map((own) => [own.getAttribute("Name"), own]));
    this.places = arrays("Points > DataArray, Cells > DataArray");
    this.data = arrays("CellData > DataArray");
    this.known = new Map();
  }

  // The numbers of an array, as a promise.
  numbers(element) {
    if (!this.known.has(element)) this.known.set(element, Frame.unpack(element));
    return this.known.get(element);
  }

  static async unpack(element) {
    if (element.getAttribute("format") !== "binary") return new Float64Array(0);
    return READERS[element.getAttribute("type")](await unpacked(element.textContent.trim()));
  }

  // The four corners of each cell, x and y in turn: eight numbers a cell.
  async corners() {
    if (!this.corner) {
      const points = await this.numbers(this.places.get("Points"));
      const connectivity = await this.numbers(this.places.get("connectivity"));
      this.corner = new Float64Array(8 * this.cells);
      for (let k = 0; k < 4 * this.cells; k += 1) {
        this.corner[2 * k] = points[3 * connectivity[k]];
        this.corner[2 * k + 1] = points[3 * connectivity[k] + 1];
      }
    }
    return this.corner;
  }

  // The ends of each line of a frame of rigid bodies, x and y in turn: four numbers a line, around one body
  // after another.
  async lines() {
    const points = await this.numbers(this.places.get("Points"));
    const connectivity = await this.numbers(this.places.get("connectivity"));
    const ends = new Float64Array(4 * this.cells);
    for (let k = 0; k < 2 * this.cells; k += 1) {
      ends[2 * k] = points[3 * connectivity[k]];
      ends[2 * k + 1] = points[3 * connectivity[k] + 1];
    }
    return ends;
  }

  // Every field that can be shown: arrays of one number, components, lengths of vectors.
  fields() {
    const fields = [];
    for (const [array, element] of this.data) {
      const components = Number(element.getAttribute("NumberOfComponents") || 1);
      const whole = element.getAttribute("type") !== "Float64";
      const [, name, unit, rest] = /^(.*?)(?: \[(.*?)\](.*))?$/.exec(array);
      const add = (what, component) => fields.push({
        key: what ? `${array}, ${what}` : array, array, components, component, whole,
        unit: unit === undefined ? "" : unit, title: what ? `${name} ${what}` : name, rest: rest || "",
      });
      if (components === 1) {
        add("", 0);
        continue;
      }
      if (components === 3) add("length", -1);
      for (let k = 0; k < components; k += 1) {
        const called = element.getAttribute(`ComponentName${k}`) || String(k);
        // In the plane nothing points out of it but stress and stretch.
        if (!called.includes("Z") || called === "ZZ") add(called.toLowerCase(), k);
      }
    }
    return fields;
  }

  // A number for every cell, in SI units.
  async values(field) {
    const numbers = await this.numbers(this.data.get(field.array));
    const { components, component } = field;
    if (components === 1) return numbers;
    const values = new Float64Array(this.cells);
    for (let cell = 0; cell < this.cells; cell += 1) {
      const at = cell * components;
      values[cell] = component < 0 ? Math.hypot(numbers[at], numbers[at + 1], numbers[at + 2]) : numbers[at + component];
    }
    return values;
  }

  // The number of a cell's particle.
  async particle(cell) {
    const numbers = this.data.get("particle");
    return numbers ? (await this.numbers(numbers))[cell] : cell;
  }
}

// The unit in which a largest value reads well, as in the pictures of a report.
function unitFor(unit, largest) {
  if (unit === "Pa" && largest >= 2e6) return [1e6, "MPa"];
  if (unit === "Pa" && (largest >= 500 || largest === 0)) return [1e3, "kPa"];
  if (unit === "m" && largest > 0 && largest < 0.1) return [1e-3, "mm"];
  return [1, unit];
}

// Least and largest, and the same without the outermost 1 % on either side.
function rangeOf(values) {
  const sorted = values.filter(Number.isFinite).sort();
  if (sorted.length === 0) return { whole: [NaN, NaN], inner: [NaN, NaN] };
  const last = sorted.length - 1;
  const at = (share) => sorted[Math.round(share * last)];
  return { whole: [sorted[0], sorted[last]], inner: [at(0.01), at(0.99)] };
}

function short(value) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(3).replace("-", "−");
  return String(Number(value.toPrecision(4))).replace("-", "−");
}
