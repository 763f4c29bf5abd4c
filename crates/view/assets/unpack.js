// Packed arrays: base64 of gzip of the length of the heads, the heads as JSON, and the numbers.
const FW = { data: JSON.parse(document.getElementById("data").textContent) };
{
  const SIZE = { u8: 1, u16: 2, u32: 4, f32: 4, f64: 8 };

  class Arrays {
    constructor(buffer, under) {
      const length = new DataView(buffer).getUint32(0, true);
      const heads = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
      this.start = 4 + length;
      this.buffer = buffer;
      this.heads = new Map(heads.map((head) => [head.name, head]));
      this.read = new Map();
      this.under = under;
    }

    // The array of a name, as numbers; that of the arrays under these where it is not here.
    get(name) {
      const head = this.heads.get(name);
      if (!head) return this.under ? this.under.get(name) : undefined;
      if (!this.read.has(name)) this.read.set(name, this.numbers(head));
      return this.read.get(name);
    }

    numbers({ kind, count, at, low, high }) {
      const from = this.start + at;
      const bytes = this.buffer.slice(from, from + SIZE[kind] * count);
      if (kind === "f64") return new Float64Array(bytes);
      if (kind === "f32") return new Float32Array(bytes);
      if (kind === "u32") return new Uint32Array(bytes);
      const codes = new Uint8Array(bytes);
      const out = new Float64Array(count);
      const most = kind === "u8" ? 255 : 65535;
      for (let k = 0; k < count; k++) {
        const code = kind === "u8" ? codes[k] : codes[k] + 256 * codes[count + k];
        out[k] = code === most ? NaN : low + ((high - low) * code) / (most - 1);
      }
      return out;
    }
  }

  FW.unpack = async (id, under) => {
    const text = document.getElementById(id).textContent;
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Arrays(await new Response(stream).arrayBuffer(), under);
  };

  FW.element = (tag, attributes = {}, ...children) => {
    const node = document.createElement(tag);
    for (const [key, value] of Object.entries(attributes)) {
      if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
      else if (value !== null && value !== undefined && value !== false) node.setAttribute(key, value === true ? "" : value);
    }
    node.append(...children);
    return node;
  };
}
