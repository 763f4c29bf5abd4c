// Controls of the viewer: what is shown, time, and the ways to move by pointer, touch and keys.
{
  const { element } = FW;
  const choose = (label, options, value, change) => {
    const node = element("select", { onchange: (e) => change(e.target.value) });
    options.forEach(([k, text, doc]) => node.append(element("option", { value: k, selected: k === value, title: doc }, text)));
    return element("label", {}, label, node);
  };
  const check = (label, value, change) => element("label", {}, element("input", { type: "checkbox", checked: value, onchange: (e) => change(e.target.checked) }), label);

  FW.controls = (viewer) => {
    const { scene, look } = viewer;
    const play = element("button", { type: "button", class: "play", onclick: () => viewer.play() }, "Play");
    const scrub = element("input", { type: "range", class: "scrub", min: 0, max: scene.count - 1, step: 1, "aria-label": "Time", oninput: (e) => viewer.show(Number(e.target.value), true) });
    const time = element("span", { class: "time", "aria-live": "off" });
    const step = (text, label, by) => element("button", { type: "button", "aria-label": label, title: label, onclick: () => viewer.show(viewer.now + by, true) }, text);
    const bar = element("div", { class: "bar" }, play, step("‹", "Previous state", -1), step("›", "Next state", 1), scrub, time,
      choose("speed", [["0.25", "¼×"], ["0.5", "½×"], ["1", "1×"], ["2", "2×"], ["4", "4×"]], "1", (v) => { viewer.speed = Number(v); }),
      element("button", { type: "button", onclick: () => viewer.reset() }, "Reset view"));
    const fields = (list) => list.filter((f) => f.all[0] !== f.all[1]).map((f) => [f.name, f.name.replaceAll("_", " ") + (f.unit ? ` (${f.unit})` : ""), f.doc]);
    const shown = element("div", { class: "bar" });
    if (scene.head.grains.fields.length) {
      shown.append(choose("colour grains by", [["", "nothing"], ...fields(scene.head.grains.fields)], look.grainField?.name || "", (v) => viewer.grainField(v)));
      shown.append(choose("grains", [["solid", "solid"], ["small", "small"], ["hidden", "hidden"]], look.grains, (v) => viewer.set({ grains: v })));
    }
    if (scene.head.contacts.fields.length) {
      const options = [["none", "none"], ...(viewer.bonded ? [["bonds", "bonds, intact and broken"]] : []), ["chains", "force chains"], ...fields(scene.head.contacts.fields).map(([k, ...rest]) => [`:${k}`, ...rest])];
      shown.append(choose("contacts", options, look.contacts, (v) => viewer.contacts(v)));
      shown.append(check("width by force", look.chains, (v) => viewer.set({ chains: v })));
    }
    if (scene.head.meshes.length) {
      const names = new Map(scene.head.meshes.flatMap((m) => m.fields).map((f) => [f.name, f]));
      shown.append(choose("colour meshes by", [["", "nothing"], ...fields([...names.values()])], look.meshField, (v) => viewer.set({ meshField: v })));
      shown.append(choose("displacement", [["0", "none"], ["1", "1×"], ["10", "10×"], ["100", "100×"], ["1000", "1000×"]], String(look.stretch), (v) => viewer.set({ stretch: Number(v) })));
      shown.append(check("elements", look.edges, (v) => viewer.set({ edges: v })));
    }
    shown.append(check("first bodies", look.bodies, (v) => viewer.set({ bodies: v })));
    const turn = scene.flat ? "" : " (shift moves)";
    const help = element("p", { class: "keys" }, "Keys, with the picture in focus: ",
      ...[["space", "play"], [", .", "step"], ["Home End", "first, last"], ["arrows", (scene.flat ? "move" : "turn") + turn], ["+ −", "zoom"], ["0", "reset"], ["g", "grains"], ["c", "contacts"], ["f", "colours"], ["b", "first bodies"]]
        .map(([k, text]) => element("span", {}, element("kbd", {}, k), ` ${text}`)),
      scene.flat ? "Drag to move, wheel or pinch to zoom." : "Drag to turn, shift-drag or two fingers to move, wheel or pinch to zoom.");
    return { bar, shown, help, play, scrub, time };
  };

  const cycle = (node) => {
    if (!node) return;
    node.selectedIndex = (node.selectedIndex + 1) % node.options.length;
    node.dispatchEvent(new Event("change"));
  };

  FW.moves = (viewer, canvas, shown) => {
    const { camera, scene } = viewer;
    const box = () => [canvas.clientWidth, canvas.clientHeight];
    const held = new Map();
    const select = (text) => [...shown.querySelectorAll("label")].find((l) => l.textContent.startsWith(text))?.querySelector("select,input");
    canvas.addEventListener("pointerdown", (e) => { canvas.setPointerCapture(e.pointerId); held.set(e.pointerId, [e.offsetX, e.offsetY]); canvas.focus({ preventScroll: true }); });
    const release = (e) => held.delete(e.pointerId);
    ["pointerup", "pointercancel", "pointerleave"].forEach((name) => canvas.addEventListener(name, release));
    canvas.addEventListener("pointerleave", () => viewer.hover(null));
    canvas.addEventListener("pointermove", (e) => {
      const last = held.get(e.pointerId), here = [e.offsetX, e.offsetY];
      if (!last) { viewer.hover(here); return; }
      const [dx, dy] = [here[0] - last[0], here[1] - last[1]];
      held.set(e.pointerId, here);
      if (held.size > 1) {
        const other = [...held].find(([id]) => id !== e.pointerId)[1];
        const apart = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
        const middle = [0.5 * (here[0] + other[0]), 0.5 * (here[1] + other[1])], [w, h] = box();
        camera.scale(apart(here) / apart(last), middle[0] - w / 2, middle[1] - h / 2, w, h);
        camera.pan(dx / 2, dy / 2, w, h);
      } else if (scene.flat || e.shiftKey || e.buttons & 6) camera.pan(dx, dy, ...box());
      else camera.turn(0.008 * dx, 0.008 * dy);
      viewer.draw();
    });
    canvas.addEventListener("wheel", (e) => {
      // A page is scrolled over the picture until the picture is used.
      if (document.activeElement !== canvas && !e.ctrlKey) return;
      e.preventDefault();
      const [w, h] = box();
      camera.scale(Math.exp(-0.0015 * e.deltaY), e.offsetX - w / 2, e.offsetY - h / 2, w, h);
      viewer.draw();
    }, { passive: false });
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    canvas.addEventListener("keydown", (e) => {
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      const way = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[e.key];
      if (way) scene.flat || e.shiftKey ? camera.pan(40 * way[0], 40 * way[1], ...box()) : camera.turn(-0.12 * way[0], -0.12 * way[1]);
      else if (e.key === "+" || e.key === "=") camera.scale(1.25);
      else if (e.key === "-") camera.scale(0.8);
      else if (e.key === "0" || e.key === "r") { viewer.reset(); }
      else if (e.key === " ") viewer.play();
      else if (e.key === ",") viewer.show(viewer.now - 1, true);
      else if (e.key === ".") viewer.show(viewer.now + 1, true);
      else if (e.key === "Home") viewer.show(0, true);
      else if (e.key === "End") viewer.show(scene.count - 1, true);
      else if (e.key === "g") cycle([...shown.querySelectorAll("label")].find((l) => l.firstChild.textContent === "grains")?.querySelector("select"));
      else if (e.key === "c") cycle(select("contacts"));
      else if (e.key === "f") cycle(select("colour grains") || select("colour meshes"));
      else if (e.key === "b") select("first bodies")?.click();
      else return;
      e.preventDefault();
      viewer.draw();
    });
  };
}
