// What is under the pointer: the grain in front there.
{
  FW.pick = (scene, arrays, camera, look, x, y, width, height) => {
    if (look.grains === "hidden") return null;
    const project = camera.projector(width, height);
    const places = scene.places(arrays, "grain"), radius = arrays.get("grain:radius") || [], shape = arrays.get("grain.shape") || [];
    const size = look.grains === "small" ? 0.4 : 1;
    let best = null, near = Infinity;
    for (let k = 0; k < shape.length; k++) {
      if (shape[k] === 1) continue;
      const [px, py, depth, unit] = project(places[3 * k], places[3 * k + 1], places[3 * k + 2]);
      const distance = Math.hypot(px - x, py - y), reach = ((radius[k] * size) / scene.size) * unit * 1.05;
      const order = scene.flat ? distance : depth;
      if (distance <= reach && order < near) { near = order; best = k; }
    }
    return best;
  };

  FW.describe = (scene, arrays, look, k) => {
    const at = scene.axes.map((axis) => FW.quantity(arrays.get(`grain.${axis}`)[k], "m"));
    const id = arrays.get("grain:id");
    const parts = [`grain ${id ? id[k] : k} at ${at.join(", ")}`];
    const field = look.grainField;
    if (field) parts.push(`${field.name} ${FW.quantity(scene.values(arrays, "grain", field)[k], field.unit)}`);
    else { const r = arrays.get("grain:radius"); if (r) parts.push(`radius ${FW.quantity(r[k], "m")}`); }
    return parts.join("; ");
  };
}
