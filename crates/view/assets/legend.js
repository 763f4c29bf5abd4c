// Legends of the colours that are shown.
{
  const { element } = FW;
  const ramp = (title, range, unit, doc) => {
    const bar = element("div", { class: "ramp", "aria-hidden": "true" });
    bar.style.background = FW.gradient(range.table);
    const most = Math.max(Math.abs(range.low), Math.abs(range.high)), s = FW.scaled(most, unit);
    const ticks = [0, 0.5, 1].map((t) => element("span", {}, FW.number((range.low + t * (range.high - range.low)) * s.factor, 3)));
    return element("div", { class: "scale", title: doc }, element("div", {}, title + (s.unit ? ` (${s.unit})` : "")), bar, element("div", { class: "ticks" }, ...ticks));
  };
  const key = (colour, text) => {
    const mark = element("i");
    mark.style.background = `rgb(${colour.join(",")})`;
    return element("span", { class: "key" }, mark, text);
  };

  [FW.ramp, FW.key] = [ramp, key];

  FW.legend = (host, scene, look) => {
    host.replaceChildren();
    if (look.grainField && look.grains !== "hidden") host.append(ramp(`grains: ${look.grainField.name}`, look.grainRange, look.grainField.unit, look.grainField.doc));
    if (look.meshes) {
      scene.head.meshes.forEach((mesh) => {
        const field = mesh.fields.find((f) => f.name === look.meshField);
        if (field) host.append(ramp(`${mesh.name}: ${field.name}`, FW.range(field), field.unit, field.doc));
      });
    }
    if (look.contacts === "bonds") {
      const c = FW.colours;
      host.append(ramp("intact bonds: damage", { low: 0, high: 1, table: [c.bond(0), c.bond(0.5), c.bond(1)] }, "", "damage D of intact bonds"));
      host.append(element("div", {}, key(c.broken, "broken bond"), key(c.line, "contact"), look.chains ? "width: by normal force" : ""));
    } else if (look.contacts === "chains") host.append(element("div", {}, key(FW.colours.chain, "contact"), look.chains ? "width: by normal force" : ""));
    else if (look.contactField) host.append(ramp(`contacts: ${look.contactField.name}`, look.contactRange, look.contactField.unit, look.contactField.doc));
    host.hidden = !host.childNodes.length;
  };
}
