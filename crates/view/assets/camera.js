// What the viewer looks at: a window in the plane, or an orbit in space. Lengths are in the units
// of the scene's box.
{
  const multiply = (a, b) => {
    const out = new Float32Array(16);
    for (let c = 0; c < 4; c++) for (let r = 0; r < 4; r++) for (let k = 0; k < 4; k++) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
    return out;
  };

  FW.Camera = class {
    constructor(dimension, extent) {
      this.flat = dimension === 2;
      this.extent = extent;
      this.reset();
    }

    reset() {
      Object.assign(this, { target: [0, 0, 0], zoom: 1, azimuth: 0.6, elevation: 0.35 });
    }

    // Half of the height that is seen, at the target.
    half(width, height) {
      const [ex, ey] = this.flat ? this.extent : [1, 1];
      return (1.06 * Math.max(ey, (ex * height) / width)) / this.zoom;
    }

    matrices(width, height) {
      const half = this.half(width, height), ratio = width / height;
      const [x, y, z] = this.target;
      const identity = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
      if (this.flat) {
        const V = identity.slice();
        V[12] = -x; V[13] = -y;
        const P = new Float32Array([1 / (half * ratio), 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, -0.1, 0, 0, 0, 0, 1]);
        return { V, P, unit: height / (2 * half), half };
      }
      const focal = 1 / Math.tan(0.3), distance = half * focal;
      const [sa, ca, se, ce] = [Math.sin(this.azimuth), Math.cos(this.azimuth), Math.sin(this.elevation), Math.cos(this.elevation)];
      // Rows: right, up, backwards; z is up in the scene.
      const right = [ca, sa, 0], up = [sa * se, -ca * se, ce], back = [sa * ce, -ca * ce, se];
      const dot = (r) => r[0] * x + r[1] * y + r[2] * z;
      const V = new Float32Array([right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
        -dot(right), -dot(up), -dot(back) - distance, 1]);
      const near = Math.max(0.02 * distance, distance - 4), far = distance + 6;
      const P = new Float32Array([focal / ratio, 0, 0, 0, 0, focal, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0]);
      return { V, P, unit: (0.5 * height * focal), half, right, up, distance, focal };
    }

    // Moves what is seen by pixels.
    pan(dx, dy, width, height) {
      const { half, right, up } = this.matrices(width, height);
      const step = (2 * half) / height;
      if (this.flat) { this.target[0] -= dx * step; this.target[1] += dy * step; return; }
      for (let k = 0; k < 3; k++) this.target[k] += step * (-dx * right[k] + dy * up[k]);
    }

    turn(dx, dy) {
      this.azimuth -= dx;
      this.elevation = Math.max(-1.55, Math.min(1.55, this.elevation + dy));
    }

    // Zooms about a place on the canvas, in pixels from its middle.
    scale(factor, px = 0, py = 0, width = 1, height = 1) {
      const before = (2 * this.half(width, height)) / height;
      this.zoom = Math.max(0.2, Math.min(2000, this.zoom * factor));
      const after = (2 * this.half(width, height)) / height;
      if (this.flat) { this.target[0] += px * (before - after); this.target[1] -= py * (before - after); }
    }

    // Where points are on the canvas, in pixels: a function of a place.
    projector(width, height) {
      const { V, P, unit } = this.matrices(width, height);
      const M = multiply(P, V);
      return (x, y, z) => {
        const w = M[3] * x + M[7] * y + M[11] * z + M[15];
        const cx = M[0] * x + M[4] * y + M[8] * z + M[12], cy = M[1] * x + M[5] * y + M[9] * z + M[13];
        return [(0.5 + (0.5 * cx) / w) * width, (0.5 - (0.5 * cy) / w) * height, w, unit / w];
      };
    }
  };
}
