// From the arrays of a state to layers: grains, contacts, first bodies, meshes.
{
  const paint = (count, of) => {
    const out = new Uint8Array(4 * count);
    for (let k = 0; k < count; k++) { const [r, g, b, a = 255] = of(k); out.set([r, g, b, a], 4 * k); }
    return out;
  };

  // Collects triangles or lines of which the number is not known before.
  class Collected {
    constructor() { this.at = []; this.colour = []; }
    triangle(p, q, r, c) { this.at.push(...p, ...q, ...r); for (let k = 0; k < 3; k++) this.colour.push(c[0], c[1], c[2], c[3] ?? 255); }
    layer(more) { return { kind: "tris", at: new Float32Array(this.at), colour: new Uint8Array(this.colour), ...more }; }
  }
  class Lines {
    constructor() { this.a = []; this.b = []; this.width = []; this.colour = []; }
    add(p, q, w, c) { this.a.push(...p); this.b.push(...q); this.width.push(w); this.colour.push(c[0], c[1], c[2], c[3] ?? 255); }
    layer(more) { return { kind: "lines", a: new Float32Array(this.a), b: new Float32Array(this.b), width: new Float32Array(this.width), colour: new Uint8Array(this.colour), ...more }; }
  }

  // The rotation of a grain as a function of a place about its centre.
  const turner = (arrays, flat) => {
    const turns = [0, 1, 2, 3].map((k) => arrays.get(`grain.turn${k}`));
    if (!turns[0]) return () => (x, y, z) => [x, y, z];
    if (flat) return (k) => { const [s, c] = [Math.sin(turns[0][k]), Math.cos(turns[0][k])]; return (x, y) => [c * x - s * y, s * x + c * y, 0]; };
    return (k) => {
      const [w, i, j, l] = turns.map((t) => t[k]);
      const n = Math.hypot(w, i, j, l) || 1, [a, b, c, d] = [w / n, i / n, j / n, l / n];
      return (x, y, z) => [
        (1 - 2 * (c * c + d * d)) * x + 2 * (b * c - a * d) * y + 2 * (b * d + a * c) * z,
        2 * (b * c + a * d) * x + (1 - 2 * (b * b + d * d)) * y + 2 * (c * d - a * b) * z,
        2 * (b * d - a * c) * x + 2 * (c * d + a * b) * y + (1 - 2 * (b * b + c * c)) * z];
    };
  };

  const grains = (scene, arrays, look) => {
    if (look.grains === "hidden") return [];
    const size = look.grains === "small" ? 0.4 : 1;
    const places = scene.places(arrays, "grain"), shape = arrays.get("grain.shape") || [];
    const radius = arrays.get("grain:radius"), first = arrays.get("grain:first_body") || [];
    const field = look.grainField, values = field ? scene.values(arrays, "grain", field) : null;
    const range = field ? look.grainRange : null;
    const tint = (k) => (first[k] === 1 ? FW.colours.first : values ? FW.colourOf(range, values[k]) : FW.colours.grain);
    const balls = [], pieces = [];
    for (let k = 0; k < shape.length; k++) {
      if (first[k] === 1 && !look.bodies) continue;
      (shape[k] === 0 ? balls : shape[k] > 1 ? pieces : []).push(k);
    }
    const layers = [];
    const at = new Float32Array(3 * balls.length), r = new Float32Array(balls.length);
    balls.forEach((k, i) => { at.set(places.subarray(3 * k, 3 * k + 3), 3 * i); r[i] = radius[k] / scene.size; });
    layers.push({ kind: "balls", at, radius: r, colour: paint(balls.length, (i) => tint(balls[i])) });
    if (pieces.length) {
      const start = arrays.get("outline.start"), outline = scene.ways(arrays, "outline"), turn = turner(arrays, scene.flat);
      const solid = new Collected(), edges = new Lines(), edge = FW.colours.edge;
      for (const k of pieces) {
        const [from, to] = [start[shape[k] - 2], start[shape[k] - 1]], rotate = turn(k), c = tint(k);
        const corners = [];
        for (let p = from; p < to; p++) {
          const [x, y, z] = rotate(size * outline[3 * p], size * outline[3 * p + 1], size * outline[3 * p + 2]);
          corners.push([x + places[3 * k], y + places[3 * k + 1], (z || 0) + places[3 * k + 2]]);
        }
        if (scene.flat) {
          for (let i = 2; i < corners.length; i++) solid.triangle(corners[0], corners[i - 1], corners[i], c);
          corners.forEach((p, i) => edges.add(p, corners[(i + 1) % corners.length], 0, edge));
        } else for (let i = 0; i + 2 < corners.length; i += 3) solid.triangle(corners[i], corners[i + 1], corners[i + 2], c);
      }
      layers.push(solid.layer());
      if (scene.flat) layers.push(edges.layer({ least: 0.4 }));
    }
    return layers;
  };

  const contacts = (scene, arrays, look) => {
    const a = scene.places(arrays, "contact.a"), b = scene.places(arrays, "contact.b");
    if (look.contacts === "none" || !a.length) return [];
    const count = a.length / 3, state = arrays.get("contact:state") || [], damage = arrays.get("contact:damage") || [];
    const force = arrays.get("contact:force_normal") || [], field = look.contactField;
    const values = field ? arrays.get(`contact:${field.name}`) : null;
    const thick = look.width / scene.size;
    const drawn = [], weight = (k) => Math.min(1.3, Math.sqrt(Math.abs(force[k] || 0) / (look.force || 1)));
    for (let k = 0; k < count; k++) {
      const bonded = state[k] === 1 || state[k] === 2;
      if (bonded && look.contacts === "bonds") drawn.push(k);
      else if (force[k] !== 0 && (look.contacts === "bonds" || look.contacts === "chains")) drawn.push(k);
      else if (values) drawn.push(k);
    }
    // What is above lies last: thin ones first, bonds over contacts.
    const rank = (k) => (look.contacts === "bonds" ? state[k] * 4 : 0) + weight(k);
    const order = drawn.map((k) => [rank(k), k]).sort((x, y) => x[0] - y[0]).map((x) => x[1]);
    const tint = (k) => {
      if (values) return FW.colourOf(look.contactRange, values[k]);
      if (look.contacts === "chains") return FW.colours.chain;
      if (state[k] === 1) return FW.colours.bond(damage[k] || 0);
      return state[k] === 2 ? FW.colours.broken : FW.colours.line;
    };
    const line = { kind: "lines", a: new Float32Array(3 * order.length), b: new Float32Array(3 * order.length), width: new Float32Array(order.length), colour: paint(order.length, (i) => tint(order[i])), least: 0.55, lift: 0.0004 };
    order.forEach((k, i) => {
      line.a.set(a.subarray(3 * k, 3 * k + 3), 3 * i);
      line.b.set(b.subarray(3 * k, 3 * k + 3), 3 * i);
      line.width[i] = look.chains ? thick * weight(k) : 0.25 * thick;
    });
    return [line];
  };

  const bodies = (scene, arrays, look) => {
    if (!look.bodies) return [];
    const start = arrays.get("body.start") || [], places = scene.places(arrays, "body"), side = arrays.get("body.side") || [];
    const shifts = scene.ways(arrays, "body.shift");
    const solid = new Collected(), edges = new Lines(), fill = FW.colours.first, edge = [70, 76, 84];
    for (let c = 0; c + 1 < start.length; c++) {
      const points = [];
      for (let p = start[c]; p < start[c + 1]; p++) points.push([0, 1, 2].map((a) => places[3 * p + a] + shifts[3 * c + a]));
      if (points.length < 2) continue;
      if (!scene.flat) {
        for (let i = 2; i < points.length; i++) solid.triangle(points[0], points[i - 1], points[i], [...fill, 90]);
        if (start.length < 4000) points.forEach((p, i) => edges.add(p, points[(i + 1) % points.length], 0, [...edge, 110]));
        continue;
      }
      for (let i = 1; i < points.length; i++) edges.add(points[i - 1], points[i], 0, edge);
      if (side[c] === 1) { for (let i = 2; i + 1 < points.length; i++) solid.triangle(points[0], points[i - 1], points[i], fill); continue; }
      // The solid is on the right of the outline: down to a straight line of an open one, along
      // each normal of a closed one.
      const depth = scene.depth / scene.size;
      const normal = (p, q) => { const [dx, dy] = [q[0] - p[0], q[1] - p[1]], n = Math.hypot(dx, dy) || 1; return [(depth * dy) / n, (-depth * dx) / n, 0]; };
      const whole = normal(points[0], points[points.length - 1]);
      const along = (p) => (p[0] * whole[0] + p[1] * whole[1]) / depth;
      const bottom = points.reduce((most, p) => Math.max(most, along(p)), -Infinity) + depth;
      const under = (p) => { const way = (bottom - along(p)) / depth; return [p[0] + way * whole[0], p[1] + way * whole[1], p[2]]; };
      for (let i = 1; i < points.length; i++) {
        const n = normal(points[i - 1], points[i]);
        const [p, q] = [points[i - 1], points[i]], [r, s] = [p, q].map((x) => (side[c] === 2 ? [x[0] + n[0], x[1] + n[1], x[2]] : under(x)));
        solid.triangle(p, q, s, fill);
        solid.triangle(p, s, r, fill);
      }
    }
    return [solid.layer(scene.flat ? {} : { clear: true }), edges.layer({ least: 0.7, clear: !scene.flat })];
  };

  const meshes = (scene, arrays, look) => scene.head.meshes.flatMap((mesh, m) => {
    const name = `mesh${m}`, at = scene.places(arrays, name), way = scene.ways(arrays, `${name}.move`), element = arrays.get(`${name}.element`) || [];
    if (!look.meshes) return [];
    for (let k = 0; k < way.length; k++) at[k] += look.stretch * way[k];
    const field = mesh.fields.find((f) => f.name === look.meshField), values = field ? arrays.get(`${name}:${field.name}`) : null;
    const n = mesh.corners, range = field ? FW.range(field) : null;
    const tint = (corner) => (values ? FW.colourOf(range, values[field.cells ? Math.floor(corner / n) : element[corner]]) : FW.colours.first);
    const point = (corner) => at.subarray(3 * element[corner], 3 * element[corner] + 3);
    if (n === 2) {
      const lines = new Lines();
      for (let k = 0; k < element.length; k += 2) lines.add(point(k), point(k + 1), 0, tint(k));
      return [lines.layer({ least: 2.2 })];
    }
    const places = new Float32Array(3 * element.length);
    for (let k = 0; k < element.length; k++) places.set(point(k), 3 * k);
    const out = [{ kind: "tris", at: places, colour: paint(element.length, tint), surface: true }];
    if (look.edges) {
      const lines = new Lines();
      for (let k = 0; k < element.length; k += 3) for (const [p, q] of [[0, 1], [1, 2], [2, 0]]) if (element[k + p] < element[k + q]) lines.add(point(k + p), point(k + q), 0, [60, 62, 66, 90]);
      out.push(lines.layer({ least: 0.25, lift: 0.0002 }));
    }
    return out;
  });

  FW.layers = (scene, arrays, look) => {
    const [g, c, b, m] = [grains, contacts, bodies, meshes].map((part) => part(scene, arrays, look));
    return scene.flat ? [...b, ...m, ...g, ...c] : [...m, ...g, ...c, ...b];
  };
}
