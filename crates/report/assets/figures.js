// The figures of a page: what each kind draws, and its choosers.
{
  const { element } = FW;
  const heading = (host, title, note) => {
    host.append(element("figcaption", {}, element("h3", {}, title), element("p", {}, note)));
  };
  const column = (run, name) => run.columns.get(name);

  const select = (label, options, value, change) => {
    const node = element("select", { onchange: (event) => change(event.target.value) });
    options.forEach(([key, text]) => node.append(element("option", { value: key, selected: key === value }, text)));
    return element("label", {}, label + " ", node);
  };

  // The rows of each cycle; all in one without cycles.
  const cycles = (run, x, y) => {
    const number = column(run, "cycle");
    const groups = new Map();
    for (let k = 0; k < x.values.length; k++) {
      const cycle = number ? number.values[k] : 1;
      if (number && cycle < 1) continue;
      if (!groups.has(cycle)) groups.set(cycle, [[], []]);
      const [xs, ys] = groups.get(cycle);
      xs.push(x.values[k]);
      ys.push(y.values[k]);
    }
    return [...groups].filter(([, [xs]]) => xs.length > 2);
  };

  // At most six of the cycles, with the first and the last.
  const some = (list) => {
    if (list.length <= 6) return list;
    return [0, 1, 2, 3, 4, 5].map((k) => list[Math.round((k * (list.length - 1)) / 5)]);
  };

  const loops = (host, figure, runs) => {
    const [{ columns }] = runs.filter((run) => column(run, figure.x) && column(run, figure.y[0]));
    const x = columns.get(figure.x), y = columns.get(figure.y[0]);
    let ys;
    if (runs.length > 1) {
      ys = runs.flatMap((run) => {
        const [a, b] = [column(run, figure.x), column(run, figure.y[0])];
        const last = a && b ? cycles(run, a, b).pop() : null;
        return last ? [{ label: run.name, unit: b.unit, x: last[1][0], values: last[1][1] }] : [];
      });
    } else {
      ys = some(cycles(runs[0], x, y)).map(([cycle, [xs, values]]) => ({ label: `cycle ${cycle}`, unit: y.unit, x: xs, values }));
    }
    if (!ys.length) ys = [{ label: y.name, unit: y.unit, x: x.values, values: y.values }];
    FW.chart(host, { title: figure.title, loose: true, x: { label: x.name, unit: x.unit, values: x.values }, ys, quantity: y.name });
  };

  // Runs over one axis: their times are joined, with gaps where one has no row.
  const joined = (runs, xname, names) => {
    const own = runs.map((run) => ({ run, x: column(run, xname), ys: names.map((n) => column(run, n)).filter(Boolean) })).filter((o) => o.x && o.ys.length);
    if (!own.length) return null;
    const label = (run, y) => (runs.length > 1 ? (names.length > 1 ? `${run.name}: ${y.name}` : run.name) : y.name);
    const unit = own[0].x.unit;
    if (own.length === 1) {
      const [{ run, x, ys }] = own;
      return { x: { label: xname, unit, values: x.values }, ys: ys.map((y) => ({ label: label(run, y), unit: y.unit, values: y.values, doc: y.doc })) };
    }
    const tables = own.map(({ x, ys }) => [Array.from(x.values), ...ys.map((y) => Array.from(y.values))]);
    const [xs, ...rest] = uPlot.join(tables);
    const heads = own.flatMap(({ run, ys }) => ys.map((y) => ({ label: label(run, y), unit: y.unit, doc: y.doc })));
    return { gaps: true, x: { label: xname, unit, values: xs }, ys: heads.map((head, k) => ({ ...head, values: rest[k].map((v) => (v === null || v === undefined ? NaN : v)) })) };
  };

  const time = (host, figure, runs) => {
    const spec = joined(runs, figure.x, figure.y);
    if (spec) FW.chart(host, { title: figure.title, link: true, quantity: figure.y.length > 1 && runs.length === 1 ? "" : figure.y[0], ...spec });
  };

  const byCycle = (host, figure) => {
    const ys = figure.data.columns.filter((c) => c.values.some((v) => v !== null)).map((c) => ({ label: c.name, unit: "", values: c.values.map((v) => (v === null ? NaN : v)) }));
    FW.chart(host, { title: figure.title, points: true, x: { label: "cycle", unit: "", values: figure.data.x }, ys });
  };

  const table = (host, figure) => {
    const columns = figure.data.columns.map((c) => ({ ...c, values: c.values.map((v) => (v === null ? NaN : v)) }));
    const slices = columns.find((c) => c.name === "slice");
    const groups = new Map();
    columns[0].values.forEach((_, k) => {
      const key = slices ? slices.values[k] : 0;
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push(k);
    });
    const rows = [...groups.values()][0];
    const rises = (c) => rows.every((k, i) => i === 0 || c.values[k] > c.values[rows[i - 1]]);
    const axes = columns.filter((c) => c !== slices && rises(c));
    const others = columns.filter((c) => c !== slices && !["from", "to"].includes(c.name) && !rises(c));
    if (!axes.length || !others.length) { host.remove(); return; }
    let x = axes[0], y = others[0], chart = null;
    const name = figure.data.name.replaceAll("_", " ");
    heading(host, slices ? `Profiles across: ${name}` : `Table: ${name}`, `From ${figure.data.name}.csv${slices ? ", by slice of time" : ""}.`);
    const draw = () => {
      chart?.remove();
      const at = (slice) => { const c = (name) => columns.find((c) => c.name === name); const k = groups.get(slice)[0]; return c("from") && c("to") ? ` (${FW.quantity(c("from").values[k], "s", 3)} to ${FW.quantity(c("to").values[k], "s", 3)})` : ""; };
      const ys = [...groups].map(([slice, rows]) => ({ label: slices ? (slice === 0 ? "whole time" : `slice ${slice}${at(slice)}`) : y.name, unit: y.unit, x: rows.map((k) => x.values[k]), values: rows.map((k) => y.values[k]) }));
      chart = FW.chart(host, { title: figure.data.name, loose: true, x: { label: x.name, unit: x.unit, values: x.values }, ys, quantity: y.name });
    };
    const options = (list) => list.map((c) => [c.name, c.name]);
    host.append(element("div", { class: "tools" }, select("show", options(others), y.name, (name) => { y = others.find((c) => c.name === name); draw(); }),
      select("across", options(axes), x.name, (name) => { x = axes.find((c) => c.name === name); draw(); })));
    draw();
  };

  const any = (host, figure, runs) => {
    const names = [...new Set(runs.flatMap((run) => [...run.columns.keys()]))];
    const doc = element("p", { class: "meaning" });
    let x = figure.x, first = figure.y[0] || names[0], second = "", chart = null;
    const draw = () => {
      chart?.remove();
      const chosen = [first, second].filter(Boolean);
      const spec = joined(runs, x, chosen);
      const docs = chosen.map((n) => runs.map((run) => column(run, n)).find(Boolean)).filter(Boolean);
      doc.textContent = docs.map((c) => `${c.name}${c.unit ? ` [${c.unit}]` : ""}: ${c.doc}`).join(". ");
      if (!spec) return;
      const quantity = runs.length > 1 && chosen.length === 1 ? first : "";
      if (x === "time") { chart = FW.chart(host, { title: chosen.join(", "), link: true, quantity, ...spec }); return; }
      const ys = runs.flatMap((run) => chosen.map((n) => [run, column(run, x), column(run, n)])).filter(([, a, b]) => a && b)
        .map(([run, a, b]) => ({ label: runs.length > 1 ? `${run.name}: ${b.name}` : b.name, unit: b.unit, x: a.values, values: b.values }));
      chart = FW.chart(host, { title: chosen.join(", "), loose: true, x: spec.x, ys: ys.filter((y) => y.unit === ys[0].unit), quantity });
    };
    const options = names.map((n) => [n, n]);
    host.append(element("div", { class: "tools" },
      select("show", options, first, (n) => { first = n; draw(); }),
      select("and", [["", "nothing else"], ...options], "", (n) => { second = n; draw(); }),
      select("over", options, x, (n) => { x = n; draw(); })), doc);
    draw();
  };

  const finite = (values) => values.map((v) => (v === null ? NaN : v));
  const curves = (host, figure) => {
    const ys = figure.curves.map((c) => ({ label: c.label, unit: figure.y_unit, x: finite(c.x), values: finite(c.values), low: finite(c.low), high: finite(c.high), line: c.line, markers: c.markers }));
    const x = { label: figure.x, unit: figure.x_unit, values: ys.flatMap((y) => y.x) };
    FW.chart(host, { title: figure.title, loose: true, log: [figure.x_log, figure.y_log], x, ys, quantity: figure.y[0] });
  };

  const KINDS = { loops, time, cycles: byCycle, any, curves };

  FW.figures = async () => {
    const heads = FW.data.runs || [{ ...FW.data.series, name: "" }];
    const runs = await Promise.all(heads.map(async (head, k) => {
      const arrays = await FW.unpack(FW.data.runs ? `series-${k}` : "series");
      const columns = new Map(head.columns.map((c) => [c.name, { ...c, values: arrays.get(c.name) }]));
      return { name: head.name, columns };
    }));
    FW.data.figures.forEach((figure, k) => {
      const host = document.getElementById(`figure-${k}`);
      if (figure.kind === "table") return table(host, figure);
      heading(host, figure.title, figure.note);
      KINDS[figure.kind](host, figure, runs);
    });
  };
}
