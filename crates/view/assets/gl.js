// WebGL2: balls as quads (disks in the plane, ray-cast spheres in space), triangles, and lines with
// a width.
{
  const BALL_V = `#version 300 es
layout(location=0) in vec2 corner; layout(location=1) in vec3 at; layout(location=2) in float radius; layout(location=3) in vec4 colour;
uniform mat4 V, P; uniform vec3 shift; uniform float size; out vec2 u; out vec3 eye; out float r; out vec4 tint;
void main() { vec4 x = V * vec4(at + shift, 1.0); r = radius * size; u = corner; eye = x.xyz; tint = colour; gl_Position = P * (x + vec4(corner * r, 0.0, 0.0)); }`;
  const BALL_F = `#version 300 es
precision highp float; in vec2 u; in vec3 eye; in float r; in vec4 tint; uniform mat4 P; uniform bool flatly; out vec4 o;
void main() { float s = dot(u, u); if (s > 1.0) discard;
  if (flatly) { float w = fwidth(sqrt(s)); float rim = smoothstep(1.0 - max(0.07, 1.5 * w), 1.0 - 0.5 * w, sqrt(s)); o = vec4(mix(tint.rgb, tint.rgb * 0.5, rim), 1.0); gl_FragDepth = gl_FragCoord.z; return; }
  vec3 n = vec3(u, sqrt(1.0 - s)); vec4 p = P * vec4(eye + n * r, 1.0); gl_FragDepth = 0.5 * p.z / p.w + 0.5;
  float light = 0.38 + 0.62 * max(dot(n, normalize(vec3(0.35, 0.55, 0.75))), 0.0); o = vec4(tint.rgb * light, 1.0); }`;
  const TRI_V = `#version 300 es
layout(location=0) in vec3 at; layout(location=1) in vec4 colour; uniform mat4 V, P; uniform vec3 shift; out vec3 eye; out vec4 tint;
void main() { vec4 x = V * vec4(at + shift, 1.0); eye = x.xyz; tint = colour; gl_Position = P * x; }`;
  const TRI_F = `#version 300 es
precision highp float; in vec3 eye; in vec4 tint; uniform bool flatly; out vec4 o;
void main() { if (flatly) { o = tint; return; } vec3 n = normalize(cross(dFdx(eye), dFdy(eye)));
  float light = 0.42 + 0.58 * abs(dot(n, normalize(vec3(0.35, 0.55, 0.75)))); o = vec4(tint.rgb * light, tint.a); }`;
  const LINE_V = `#version 300 es
layout(location=0) in vec2 corner; layout(location=1) in vec3 a; layout(location=2) in vec3 b; layout(location=3) in float width; layout(location=4) in vec4 colour;
uniform mat4 V, P; uniform vec3 shift; uniform vec2 view; uniform float unit, least, lift; out vec4 tint;
void main() { vec4 p = P * V * vec4(a + shift, 1.0), q = P * V * vec4(b + shift, 1.0); vec4 x = corner.x < 0.0 ? p : q;
  vec2 way = (q.xy / q.w - p.xy / p.w) * view; vec2 n = length(way) > 1e-6 ? normalize(vec2(-way.y, way.x)) : vec2(0.0, 1.0);
  float half_px = max(width * unit / x.w, least); x.xy += n * corner.y * half_px / view * 2.0 * x.w; x.z -= lift * x.w; gl_Position = x; tint = colour; }`;
  const LINE_F = `#version 300 es
precision highp float; in vec4 tint; out vec4 o; void main() { o = tint; }`;

  const program = (gl, vertex, fragment) => {
    const p = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader) || "shader");
      gl.attachShader(p, shader);
    }
    gl.linkProgram(p);
    if (!gl.getProgramParameter(p, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(p) || "program");
    const at = {};
    return { use: () => gl.useProgram(p), at: (name) => (at[name] ??= gl.getUniformLocation(p, name)) };
  };

  // Attributes of each kind of layer: name, numbers, whether bytes.
  const KINDS = {
    balls: { attributes: [["at", 3], ["radius", 1], ["colour", 4, true]], instanced: true },
    tris: { attributes: [["at", 3], ["colour", 4, true]], instanced: false },
    lines: { attributes: [["a", 3], ["b", 3], ["width", 1], ["colour", 4, true]], instanced: true },
  };

  FW.Gl = class {
    constructor(canvas) {
      const gl = canvas.getContext("webgl2", { alpha: false, antialias: true, preserveDrawingBuffer: true });
      if (!gl) throw new Error("it has no WebGL2");
      this.gl = gl;
      this.programs = { balls: program(gl, BALL_V, BALL_F), tris: program(gl, TRI_V, TRI_F), lines: program(gl, LINE_V, LINE_F) };
      this.quad = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, this.quad);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), gl.STATIC_DRAW);
      this.layers = [];
    }

    // Replaces all layers: {kind, at, colour, ...} with typed arrays.
    set(layers) {
      const { gl } = this;
      for (const { vao, buffers } of this.layers) { gl.deleteVertexArray(vao); buffers.forEach((b) => gl.deleteBuffer(b)); }
      this.layers = layers.filter((l) => l.colour.length).map((layer) => {
        const { attributes, instanced } = KINDS[layer.kind];
        const vao = gl.createVertexArray(), buffers = [];
        gl.bindVertexArray(vao);
        if (instanced) {
          gl.bindBuffer(gl.ARRAY_BUFFER, this.quad);
          gl.enableVertexAttribArray(0);
          gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
        }
        attributes.forEach(([name, width, bytes], k) => {
          const place = instanced ? k + 1 : k, buffer = gl.createBuffer();
          gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
          gl.bufferData(gl.ARRAY_BUFFER, layer[name], gl.STATIC_DRAW);
          gl.enableVertexAttribArray(place);
          gl.vertexAttribPointer(place, width, bytes ? gl.UNSIGNED_BYTE : gl.FLOAT, bytes === true, 0, 0);
          if (instanced) gl.vertexAttribDivisor(place, 1);
          buffers.push(buffer);
        });
        return { ...layer, vao, buffers, count: layer.colour.length / 4 };
      });
      gl.bindVertexArray(null);
    }

    draw({ V, P, unit, flat, shifts, clip, paper, ballSize }) {
      const { gl } = this;
      const [w, h] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
      gl.viewport(0, 0, w, h);
      gl.disable(gl.SCISSOR_TEST);
      gl.clearColor(...paper, 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      if (clip) { gl.enable(gl.SCISSOR_TEST); gl.scissor(...clip); }
      for (const layer of this.layers) {
        const p = this.programs[layer.kind];
        p.use();
        gl.bindVertexArray(layer.vao);
        const through = layer.clear === true;
        flat ? gl.disable(gl.DEPTH_TEST) : gl.enable(gl.DEPTH_TEST);
        gl.depthMask(!through);
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
        gl.uniformMatrix4fv(p.at("V"), false, V);
        gl.uniformMatrix4fv(p.at("P"), false, P);
        gl.uniform1i(p.at("flatly"), flat || layer.flat === true);
        if (layer.kind === "balls") gl.uniform1f(p.at("size"), ballSize);
        if (layer.kind === "lines") {
          gl.uniform2f(p.at("view"), w, h);
          gl.uniform1f(p.at("unit"), unit);
          gl.uniform1f(p.at("least"), (layer.least || 0.5) * devicePixelRatio);
          gl.uniform1f(p.at("lift"), flat ? 0 : layer.lift || 0);
        }
        for (const shift of layer.fixed ? [[0, 0, 0]] : shifts) {
          gl.uniform3f(p.at("shift"), ...shift);
          if (KINDS[layer.kind].instanced) gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, layer.count);
          else gl.drawArrays(gl.TRIANGLES, 0, layer.count);
        }
      }
      gl.depthMask(true);
      gl.disable(gl.SCISSOR_TEST);
    }
  };
}
