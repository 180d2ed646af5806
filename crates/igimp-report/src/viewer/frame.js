// Frames as the program packs them: JSON with numbers in base64, compressed by zlib; an array is unpacked
// when it is first asked for.

const READERS = {
  f32: (bytes) => new Float32Array(bytes.buffer),
  i32: (bytes) => new Int32Array(bytes.buffer),
  u16: (bytes) => new Uint16Array(bytes.buffer),
  u8: (bytes) => bytes,
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

// Numbers from their bytes: all first bytes, all second bytes, and so on.
async function unpacked(array) {
  const sorted = await inflated(fromBase64(array.data));
  const width = { f32: 4, i32: 4, u16: 2, u8: 1 }[array.kind];
  const count = sorted.length / width;
  const bytes = new Uint8Array(sorted.length);
  for (let k = 0; k < width; k += 1) {
    for (let at = 0; at < count; at += 1) bytes[at * width + k] = sorted[k * count + at];
  }
  const stored = READERS[array.kind](bytes);
  if (array.whole || array.kind === "u8") return stored;
  const { components, low, step, kind } = array;
  const numbers = new Float64Array(stored.length);
  for (let at = 0; at < stored.length; at += 1) {
    const component = at % components;
    // The last step of rounded numbers stands for what is none.
    numbers[at] = kind === "u16" && stored[at] === 65535 ? NaN : low[component] + step[component] * stored[at];
  }
  return numbers;
}

class Frame {
  constructor(text) {
    Object.assign(this, JSON.parse(text));
    this.known = new Map();
  }

  // The numbers of an array, as a promise.
  numbers(array) {
    if (!this.known.has(array)) this.known.set(array, unpacked(array));
    return this.known.get(array);
  }

  // What is shown of boxes and bodies, by name.
  async shapes() {
    const pairs = this.places.map(async (array) => [array.name, await this.numbers(array)]);
    return Object.fromEntries(await Promise.all(pairs));
  }

  // Every field that can be shown: arrays of one number, components, lengths of vectors.
  shown() {
    const fields = [];
    for (const array of this.fields) {
      const { components, whole } = array;
      const [, name, unit, rest] = /^(.*?)(?: \[(.*?)\](.*))?$/.exec(array.name);
      const add = (what, component) => fields.push({
        key: what ? `${array.name}, ${what}` : array.name, array: array.name, component, whole,
        unit: unit === undefined ? "" : unit, title: Frame.titled(name, what), rest: rest || "",
      });
      if (components === 1) {
        add("", 0);
        continue;
      }
      if (components === 3) add("length", 3);
      for (let k = 0; k < components; k += 1) {
        const called = array.component_names[k] || String(k);
        // In the plane nothing points out of it but stress and stretch.
        if (this.dimension === 3 || !called.includes("Z") || called === "ZZ") add(called.toLowerCase(), k);
      }
    }
    return fields;
  }

  // The length of a velocity has a name of its own.
  static titled(name, what) {
    if (name === "velocity" && what === "length") return "speed";
    return what ? `${name} ${what}` : name;
  }

  // What arrows can show: vectors, and the principal values of stress in the plane.
  vectors() {
    const called = (array) => array.name.replace(/ \[.*$/, "");
    const vectors = this.fields.filter((array) => array.components === 3).map((array) => ({ name: array.name, kind: "vector", title: called(array) }));
    const stresses = this.fields.filter((array) => array.components === 6 && this.dimension === 2);
    const named = stresses.map((array) => ({ name: array.name, kind: "stress", title: `principal stresses of ${called(array)}` }));
    return [...vectors, ...named];
  }

  arrayOf(name) {
    return this.fields.find((array) => array.name === name);
  }

  // A number for every box, in SI units.
  async values(field) {
    const array = this.arrayOf(field.array);
    const numbers = await this.numbers(array);
    const { components } = array;
    if (components === 1) return numbers;
    const values = new Float64Array(this.count);
    for (let box = 0; box < this.count; box += 1) {
      const at = box * components;
      values[box] = field.component === 3 && components === 3 ? Math.hypot(numbers[at], numbers[at + 1], numbers[at + 2]) : numbers[at + field.component];
    }
    return values;
  }

  // Least and largest over all particles, and the same without the outermost 1 % on either side.
  range(field) {
    const [least, most, low, high] = this.arrayOf(field.array).range[field.component];
    return { whole: [least, most], inner: [low, high] };
  }

  // The number of a box's particle.
  async particle(box) {
    const numbers = this.arrayOf("particle");
    return numbers ? (await this.numbers(numbers))[box] : box;
  }
}

// The unit in which a largest value reads well, as in the pictures of a report.
function unitFor(unit, largest) {
  if (unit === "Pa" && largest >= 2e6) return [1e6, "MPa"];
  if (unit === "Pa" && (largest >= 500 || largest === 0)) return [1e3, "kPa"];
  if (unit === "m" && largest > 0 && largest < 0.1) return [1e-3, "mm"];
  return [1, unit];
}

function short(value) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(3).replace("-", "−");
  return String(Number(value.toPrecision(4))).replace("-", "−");
}
