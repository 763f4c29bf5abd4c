// The figures of a page: the charts that were described, and one of any column of the statistics
// over any other.
{
  const { element } = FW;
  const heading = (host, title, note) => host.append(element("figcaption", {}, element("h3", {}, title), element("p", {}, note)));

  const select = (label, options, value, change) => {
    const node = element("select", { onchange: (event) => change(event.target.value) });
    options.forEach(([key, text]) => node.append(element("option", { value: key, selected: key === value }, text)));
    return element("label", {}, label + " ", node);
  };

  // A column of any run as an axis.
  const axisOf = (name, columns) => {
    const most = Math.max(...columns.map((c) => FW.most(c.values)));
    const { factor, unit } = FW.scaled(most, columns[0].unit);
    return { name, unit: columns[0].unit, label: unit ? `${name} (${unit})` : name, factor };
  };

  // Charts over time share their zoom, others with those over the same numbers.
  const link = (x, other) => (x.unit === "s" ? x.label : other);

  // `opens` has the names of the columns that are shown at first, the most wanted first: across,
  // upwards, and on the axis on the right.
  const any = (host, runs, opens) => {
    heading(host, "Any column of the statistics", "Choose what is drawn over what.");
    const names = [...new Set(runs.flatMap((run) => [...run.columns.keys()]))];
    const varies = (name) => runs.some((run) => run.columns.get(name)?.values.some((v, _, all) => v !== all[0] && Number.isFinite(v)));
    const unit = (name) => runs.map((run) => run.columns.get(name)).find(Boolean).unit;
    const doc = element("p", { class: "meaning" });
    const wanted = (list) => list.find((name) => names.includes(name) && varies(name));
    let x = wanted(opens.across) || names[0], chart = null;
    let first = wanted(opens.up) || names.find((n) => opens.units.includes(unit(n)) && varies(n)) || names.find((n) => unit(n) && unit(n) !== unit(x) && varies(n)) || x;
    let second = wanted(opens.right.filter((name) => name !== first)) || "";
    const draw = () => {
      chart?.remove();
      const chosen = [first, second].filter(Boolean);
      const own = (name) => runs.map((run) => run.columns.get(name)).filter(Boolean);
      doc.textContent = chosen.map((n) => own(n)[0]).map((c) => `${c.name}${c.unit ? ` [${c.unit}]` : ""}: ${c.doc}`).join(". ");
      if (!own(x).length) return;
      const series = chosen.flatMap((name, k) => runs.filter((run) => run.columns.has(name) && run.columns.has(x)).map((run) => ({
        label: [run.name, chosen.length > 1 || !run.name ? name : ""].filter(Boolean).join(": "), second: k === 1, x: run.columns.get(x).values, y: run.columns.get(name).values,
      })));
      const [y, y2] = chosen.map((name) => axisOf(name, own(name)));
      const across = axisOf(x, own(x));
      chart = FW.chart(host, { title: chosen.join(", "), x: across, y, y2, series, link: link(across, "any") });
    };
    const options = names.map((n) => [n, n]);
    host.append(element("div", { class: "tools" },
      select("show", options, first, (n) => { first = n; draw(); }),
      select("and", [["", "nothing else"], ...options], second, (n) => { second = n; draw(); }),
      select("over", options, x, (n) => { x = n; draw(); })), doc);
    draw();
  };

  FW.figures = async () => {
    const numbers = await FW.unpack("numbers");
    const get = (name) => (name === null ? null : numbers.get(name));
    const runs = FW.data.runs.map((run) => ({ ...run, columns: new Map(run.columns.map((c) => [c.name, { ...c, values: get(c.values) }])) }));
    FW.data.figures.forEach((figure, k) => {
      const host = document.getElementById(`figure-${k}`);
      if (figure.any) return any(host, runs, figure.any);
      heading(host, figure.title, figure.note);
      const field = figure.field && { ...figure.field, ...Object.fromEntries(["starts", "x", "y", "values"].map((key) => [key, get(figure.field[key])])) };
      const series = figure.series.map((s) => ({ ...s, x: get(s.x), y: get(s.y), low: get(s.low), high: get(s.high) }));
      FW.chart(host, { ...figure, field, series, link: link(figure.x, figure.series[0]?.x || figure.title) });
    });
  };
}
