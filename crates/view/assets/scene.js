// States of the scene: unpacked when they are first shown; the box of the first one gives the units
// of drawing.
{
  FW.Scene = class {
    constructor(head) {
      this.head = head;
      this.flat = head.dimension === 2;
      this.frames = new Map();
    }

    async open() {
      this.base = await FW.unpack("frame-0");
      this.frames.set(0, this.base);
      this.axes = this.flat ? ["x", "y"] : ["x", "y", "z"];
      const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
      const boxes = (arrays) => {
        const box = (name, radius, way) => {
          const columns = this.axes.map((axis) => arrays.get(`${name}.${axis}`) || []);
          const low = columns.map(() => Infinity), high = columns.map(() => -Infinity);
          columns.forEach((values, a) => {
            const moved = way && arrays.get(`${way}.${this.axes[a]}`);
            for (let k = 0; k < values.length; k++) {
              const x = values[k] + (moved ? moved[k] : 0), r = radius ? radius[k] : 0;
              low[a] = Math.min(low[a], x - r);
              high[a] = Math.max(high[a], x + r);
            }
          });
          return [low, high];
        };
        return { all: [box("grain", arrays.get("grain:radius")), ...this.head.meshes.map((_, k) => box(`mesh${k}`, null, `mesh${k}.move`))], body: box("body") };
      };
      const join = ([l, h]) => this.axes.forEach((_, a) => { low[a] = Math.min(low[a], l[a]); high[a] = Math.max(high[a], h[a]); });
      const [start, end] = [boxes(this.base), boxes(await this.frame(this.count - 1))];
      [...start.all, ...end.all].forEach(join);
      // First bodies are seen whole where they are not much larger than what is between them.
      const wide = ([l, h]) => Math.hypot(...this.axes.map((_, a) => Math.max(0, h[a] - l[a])));
      if (!(low[0] <= high[0]) || (!this.flat && wide(end.body) < 4 * wide([low, high]))) [start.body, end.body].forEach(join);
      for (let a = 0; a < 3; a++) if (!(low[a] <= high[a])) { low[a] = 0; high[a] = 0; }
      this.head.period.forEach((length, a) => {
        if (length && this.flat && a === 0) { low[0] = 0; high[0] = length; }
      });
      this.centre = low.map((l, a) => 0.5 * (l + high[a]));
      const half = low.map((l, a) => 0.5 * (high[a] - l));
      this.size = (this.flat ? Math.max(...half) : Math.hypot(...half)) || 1;
      const grow = (x) => Math.max(x / this.size, 0.08);
      this.extent = [grow(half[0]), grow(half[1]) * (this.flat ? 1.12 : 1), grow(half[2])];
      // First bodies around a layer are seen to some depth.
      this.depth = 0.16 * Math.min(half[0] || half[1], half[1] || half[0]) + 0.02 * this.size;
      if (this.flat) this.extent[1] += this.depth / this.size;
      this.box = [low, high];
    }

    get count() { return this.head.times.length; }

    async frame(k) {
      if (!this.frames.has(k)) {
        // A few states are kept, so that playing on does not fill the memory.
        if (this.frames.size > 60) for (const old of [...this.frames.keys()].slice(1, 30)) this.frames.delete(old);
        this.frames.set(k, await FW.unpack(`frame-${k}`, this.base));
      }
      return this.frames.get(k);
    }

    // Coordinates of an array in units of drawing, three a point.
    places(arrays, name) {
      const columns = this.axes.map((axis) => arrays.get(`${name}.${axis}`) || []);
      const count = columns[0].length, out = new Float32Array(3 * count);
      columns.forEach((values, a) => { for (let k = 0; k < count; k++) out[3 * k + a] = (values[k] - this.centre[a]) / this.size; });
      return out;
    }

    // Differences likewise.
    ways(arrays, name) {
      const columns = this.axes.map((axis) => arrays.get(`${name}.${axis}`) || []);
      const count = columns[0].length, out = new Float32Array(3 * count);
      columns.forEach((values, a) => { for (let k = 0; k < count; k++) out[3 * k + a] = values[k] / this.size; });
      return out;
    }

    // Values of a field; of one that is derived, the size of its components.
    values(arrays, group, field) {
      if (!field.of) return arrays.get(`${group}:${field.name}`);
      const parts = field.of.map((name) => arrays.get(`${group}:${name}`)).filter(Boolean);
      return Float64Array.from(parts[0] || [], (_, k) => Math.hypot(...parts.map((p) => p[k])));
    }
  };
}
