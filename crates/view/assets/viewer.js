// The viewer: a state of the scene, how it looks, and the camera.
{
  const { element } = FW;

  class Viewer {
    constructor(scene, host) {
      this.scene = scene;
      this.canvas = element("canvas", { tabindex: 0, role: "img" });
      this.still = element("img", { class: "still", alt: "The scene in its last state" });
      this.readout = element("div", { class: "readout", "aria-live": "polite" });
      this.rule = element("div", { class: "scale-bar", "aria-hidden": "true" });
      this.gl = new FW.Gl(this.canvas);
      this.camera = new FW.Camera(scene.head.dimension, scene.extent);
      this.speed = 1;
      this.now = -1;
      this.look = this.start();
      this.parts = FW.controls(this);
      this.key = element("div", { class: "legend", role: "group", "aria-label": "Legend" });
      const stage = element("div", { class: "stage" }, this.canvas, this.readout, this.rule);
      host.append(stage, this.still, this.parts.bar, this.parts.shown, this.key, this.parts.help);
      FW.moves(this, this.canvas, this.parts.shown);
      // A long layer needs less height than a heap.
      const shape = () => {
        if (!scene.flat) return;
        const wanted = 1.15 * stage.clientWidth * (scene.extent[1] / scene.extent[0]);
        this.canvas.style.height = `${Math.round(Math.max(200, Math.min(wanted, 0.66 * innerHeight, 620)))}px`;
      };
      shape();
      new ResizeObserver(() => { shape(); this.draw(); }).observe(stage);
      this.canvas.addEventListener("webglcontextlost", (e) => e.preventDefault());
      this.canvas.addEventListener("webglcontextrestored", () => { this.gl = new FW.Gl(this.canvas); this.build(); });
    }

    // What a scene looks like before anybody chooses.
    start() {
      const { head, flat } = this.scene;
      const find = (list, ...names) => names.map((n) => list.find((f) => f.name === n && f.all[0] !== f.all[1])).find(Boolean);
      const state = head.contacts.fields.find((f) => f.name === "state"), force = head.contacts.fields.find((f) => f.name === "force_normal");
      this.bonded = Boolean(state && state.all[1] > 0);
      const fields = head.meshes.flatMap((m) => m.fields);
      const field = this.bonded ? undefined : find(head.grains.fields, "speed");
      const radius = this.scene.base.get("grain:radius") || [];
      const mean = radius.length ? radius.reduce((a, b) => a + b, 0) / radius.length : this.scene.size / 40;
      return {
        grains: !flat && this.bonded ? "small" : "solid", grainField: field, grainRange: field && FW.range(field),
        contacts: this.bonded ? "bonds" : flat ? "chains" : "none", chains: true, contactField: undefined,
        force: force ? Math.max(Math.abs(force.most[0]), Math.abs(force.most[1])) : 1, width: 0.26 * mean,
        bodies: true, meshes: true, meshField: (find(fields, "von_mises", "pressure") || fields.find((f) => f.all[0] !== f.all[1]))?.name || "", stretch: 1, edges: false,
      };
    }

    set(change) { Object.assign(this.look, change); this.build(); }
    grainField(name) {
      const field = this.scene.head.grains.fields.find((f) => f.name === name);
      this.set({ grainField: field, grainRange: field && FW.range(field) });
    }
    contacts(value) {
      const field = value.startsWith(":") ? this.scene.head.contacts.fields.find((f) => f.name === value.slice(1)) : undefined;
      this.set({ contacts: value, contactField: field, contactRange: field && FW.range(field, field.unit === "" && field.all[1] <= 8) });
    }
    reset() { this.camera.reset(); this.draw(); }

    async show(k, byHand) {
      if (byHand) this.stop();
      const { scene, parts } = this;
      const now = Math.max(0, Math.min(scene.count - 1, k));
      const arrays = await scene.frame(now);
      this.now = now;
      this.arrays = arrays;
      parts.scrub.value = now;
      const text = `t = ${FW.quantity(scene.head.times[now], "s")}, state ${now + 1} of ${scene.count}`;
      parts.time.textContent = text;
      parts.scrub.setAttribute("aria-valuetext", text);
      this.canvas.setAttribute("aria-label", `The scene at ${text}: ${(arrays.get("grain.shape") || []).length} grains, ${(arrays.get("contact.a.x") || []).length} contacts`);
      this.build();
    }

    build() {
      if (!this.arrays) return;
      this.gl.set(FW.layers(this.scene, this.arrays, this.look));
      FW.legend(this.key, this.scene, this.look);
      this.draw();
    }

    draw() {
      const { canvas, camera, scene } = this;
      const [w, h] = [canvas.clientWidth, canvas.clientHeight];
      if (!w || !h || !this.arrays) return;
      const [pw, ph] = [Math.round(w * devicePixelRatio), Math.round(h * devicePixelRatio)];
      if (canvas.width !== pw || canvas.height !== ph) { canvas.width = pw; canvas.height = ph; }
      const view = camera.matrices(pw, ph);
      const length = scene.flat && scene.head.period[0];
      const shifts = length ? [-1, 0, 1].map((k) => [(k * length) / scene.size, 0, 0]) : [[0, 0, 0]];
      this.gl.draw({ ...view, flat: scene.flat, shifts, clip: length ? this.clip(pw, ph) : null, paper: FW.isDark() ? [0.106, 0.118, 0.137] : [1, 1, 1], ballSize: this.look.grains === "small" ? 0.4 : 1 });
      this.ruler(w, h);
    }

    // The part of the canvas of the periodic cell.
    clip(w, h) {
      const project = this.camera.projector(w, h), { scene } = this;
      const x = (at) => project((at - scene.centre[0]) / scene.size, 0, 0)[0];
      const [a, b] = [Math.max(0, Math.floor(x(0))), Math.min(w, Math.ceil(x(scene.head.period[0])))];
      return [a, 0, Math.max(0, b - a), h];
    }

    // A bar of a round length.
    ruler(w, h) {
      const { half } = this.camera.matrices(w, h);
      const metres = (2 * half * this.scene.size) / h;
      const aim = 110 * metres, power = 10 ** Math.floor(Math.log10(aim));
      const round = [5, 2, 1].find((k) => k * power <= aim) * power;
      const bar = element("span");
      bar.style.width = `${round / metres}px`;
      this.rule.replaceChildren(FW.quantity(round, "m", 2), bar);
      this.rule.hidden = !this.scene.flat;
    }

    hover(at) {
      if (!at || !this.arrays) { this.readout.textContent = ""; return; }
      const k = FW.pick(this.scene, this.arrays, this.camera, this.look, ...at, this.canvas.clientWidth, this.canvas.clientHeight);
      this.readout.textContent = k === null ? "" : FW.describe(this.scene, this.arrays, this.look, k);
    }

    stop() {
      this.playing = false;
      this.parts.play.textContent = "Play";
    }

    play() {
      if (this.playing) { this.stop(); return; }
      if (this.scene.count < 2) return;
      this.playing = true;
      this.parts.play.textContent = "Pause";
      let at = this.now >= this.scene.count - 1 ? -1 : this.now, due = 0;
      const tick = async (clock) => {
        if (!this.playing) return;
        if (clock >= due) {
          due = clock + 160 / this.speed;
          at += 1;
          if (at >= this.scene.count) { this.stop(); return; }
          await this.show(at);
        }
        requestAnimationFrame(tick);
      };
      requestAnimationFrame(tick);
    }

    // The picture that is printed in place of the viewer.
    picture() {
      this.draw();
      this.still.src = this.canvas.toDataURL("image/png");
    }
  }

  FW.viewer = async () => {
    const scene = new FW.Scene(FW.data.scene);
    await scene.open();
    const viewer = new Viewer(scene, document.getElementById("viewer"));
    await viewer.show(scene.count - 1);
    // Where pictures are drawn by the processor, reading one back takes long: after everything
    // else.
    const idle = window.requestIdleCallback || ((call) => setTimeout(call, 500));
    idle(() => { if (viewer.now === scene.count - 1) viewer.picture(); });
    FW.redraw = () => viewer.draw();
    FW.still = () => { if (!viewer.playing) viewer.picture(); };
    FW.shown = viewer;
  };
}
