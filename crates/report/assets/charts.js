// Charts: uPlot with the colours of the page, axes with units, zoom that is shared by charts over time, and keys.
{
  const LIGHT = ["#0072b2", "#c44e00", "#00805c", "#b0508a", "#9a6a00", "#4a4a4a", "#2aa0d8", "#7a4b2a"];
  const DARK = ["#5ab4f0", "#ff9d57", "#3fd0a0", "#e79bc8", "#f0c050", "#c8c8c8", "#8fd3f5", "#d0a080"];
  const dark = matchMedia("(prefers-color-scheme: dark)");
  let printing = false;
  const linked = new Set();
  const redraws = new Set();
  let sharing = false;

  FW.isDark = () => dark.matches && !printing;
  const colour = (k) => (FW.isDark() ? DARK : LIGHT)[k % LIGHT.length];
  const ink = () => (FW.isDark() ? ["#c3c8d0", "#2c3038"] : ["#444a54", "#e6e8ec"]);

  // Ticks of a logarithmic axis: whole multiples of powers of ten, with labels at the powers, and over few of them at 2 and 5 times these.
  const multiples = (min, max) => {
    const ticks = [];
    for (let k = Math.floor(Math.log10(min)); k <= Math.log10(max); k++) for (let m = 1; m < 10; m++) ticks.push([m, Number(`${m}e${k}`)]);
    return ticks.filter(([, t]) => t >= min && t <= max);
  };
  const logarithmic = (scale) => ({
    splits: (u, _, min, max) => multiples(min, max).map(([, t]) => t),
    filter: (u, ticks) => {
      const { min, max } = u.scales[scale];
      const labels = max / min > 200 ? [1] : [1, 2, 5];
      const shown = new Set(multiples(min, max).filter(([m]) => labels.includes(m)).map(([, t]) => t));
      return ticks.map((t) => (shown.has(t) ? t : null));
    },
  });

  const axis = (label, scale, side, whole, log) => {
    const [stroke, grid] = ink();
    const font = "12px system-ui, sans-serif";
    return {
      scale, side, label, stroke, font, labelFont: font, labelSize: 20, size: side === 2 ? 38 : 62, gap: 4,
      grid: { stroke: grid, width: 1, show: side !== 1 }, ticks: { stroke: grid, width: 1, size: 5 },
      ...(log ? logarithmic(scale) : {}),
      ...(whole ? { incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000] } : {}),
      values: (_, ticks) => ticks.map((t) => (t === null ? "" : FW.number(t, 6))),
    };
  };

  const share = (chart) => {
    if (sharing) return;
    sharing = true;
    const { min, max } = chart.scales.x;
    for (const other of linked) if (other !== chart) other.setScale("x", { min, max });
    sharing = false;
  };

  // Lines through points in any order: neither axis need increase.
  const path = (u, s) => {
    const [xs, ys] = u.data[s];
    const { ctx, bbox } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.beginPath();
    let pen = false;
    for (let k = 0; k < xs.length; k++) {
      if (xs[k] === null || ys[k] === null) { pen = false; continue; }
      const x = u.valToPos(xs[k], "x", true), y = u.valToPos(ys[k], "y", true);
      pen ? ctx.lineTo(x, y) : ctx.moveTo(x, y);
      pen = true;
    }
    ctx.strokeStyle = ctx.fillStyle = colour(s - 1);
    ctx.lineWidth = 1.6 * devicePixelRatio;
    ctx.lineJoin = "round";
    const { line, markers, low, high, factor } = u.series[s].style;
    if (line !== false) ctx.stroke();
    const end = (values, k) => (Number.isFinite(values[k]) ? u.valToPos(values[k] * factor, "y", true) : null);
    for (let k = 0; k < xs.length; k++) {
      if (xs[k] === null || ys[k] === null) continue;
      const x = u.valToPos(xs[k], "x", true);
      if (low?.length) {
        const [a, b] = [end(low, k), end(high, k)], w = 3 * devicePixelRatio;
        if (a !== null && b !== null) {
          ctx.beginPath();
          [[x - w, a, x + w, a], [x, a, x, b], [x - w, b, x + w, b]].forEach(([p, q, r, t]) => { ctx.moveTo(p, q); ctx.lineTo(r, t); });
          ctx.stroke();
        }
      }
      if (markers) {
        ctx.beginPath();
        ctx.arc(x, u.valToPos(ys[k], "y", true), 3.2 * devicePixelRatio, 0, 2 * Math.PI);
        ctx.fill();
      }
    }
    ctx.restore();
    return null;
  };

  const nearest = (u, s) => {
    const { left, top } = u.cursor;
    if (left < 0 || !u.series[s].show) return null;
    const [xs, ys] = u.data[s];
    let best = null, least = 40 * 40;
    for (let k = 0; k < xs.length; k++) {
      if (xs[k] === null || ys[k] === null) continue;
      const dx = u.valToPos(xs[k], "x") - left, dy = u.valToPos(ys[k], "y") - top;
      if (dx * dx + dy * dy < least) { least = dx * dx + dy * dy; best = k; }
    }
    return best;
  };

  const keys = (chart, event) => {
    const { min, max } = chart.scales.x;
    const width = max - min;
    // A logarithmic axis has no zero.
    const move = (a, b) => chart.setScale("x", { min: chart.scales.x.distr === 3 ? Math.max(a, 0.5 * min) : a, max: b });
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (step && event.shiftKey) move(min + 0.1 * step * width, max + 0.1 * step * width);
    else if (step) chart.setCursor({ left: Math.max(0, Math.min(chart.over.clientWidth, (chart.cursor.left < 0 ? chart.over.clientWidth / 2 : chart.cursor.left) + 8 * step)), top: chart.over.clientHeight / 2 });
    else if (event.key === "+" || event.key === "=") move(min + 0.15 * width, max - 0.15 * width);
    else if (event.key === "-") move(min - 0.2 * width, max + 0.2 * width);
    else if (event.key === "Escape" || event.key === "0") chart.setData(chart.data);
    else return;
    event.preventDefault();
  };

  // spec: {x: {label, unit, values}, ys: [{label, unit, values, x?}], loose: any order, log: axes with logarithmic scales, link: shared zoom, title}
  FW.chart = (host, spec) => {
    const plot = FW.element("div", { class: "plot", tabindex: 0, role: "img" });
    host.append(plot);
    let chart = null;
    const build = () => {
      if (chart) { linked.delete(chart); chart.destroy(); }
      const width = Math.max(260, host.clientWidth);
      const units = [...new Set(spec.ys.map((y) => y.unit))].slice(0, 2);
      const shown = units.map((unit) => FW.scaled(Math.max(...spec.ys.filter((y) => y.unit === unit).map((y) => FW.most(y.values))), unit));
      const across = FW.scaled(FW.most(spec.x.values), spec.x.unit);
      const times = (values, factor) => Array.from(values, (v) => (Number.isFinite(v) ? v * factor : null));
      const of = (y) => Math.max(0, units.indexOf(y.unit));
      const named = (label, unit) => (unit ? `${label} (${unit})` : label);
      const labels = shown.map((s, k) => {
        const own = spec.ys.filter((y) => of(y) === k);
        const names = spec.quantity || own.map((y) => y.label).join(", ");
        return named(own.length <= 3 || spec.quantity ? names : "", s.unit).trim();
      });
      const series = spec.ys.map((y, k) => ({
        label: y.label, stroke: () => colour(k), width: 1.6, scale: of(y) ? "y2" : "y", spanGaps: spec.gaps === true,
        points: { show: spec.points === true, size: 7, stroke: () => colour(k), fill: () => colour(k) },
        ...(spec.loose
          ? { style: { ...y, factor: shown[of(y)].factor }, facets: [{ scale: "x", auto: true }, { scale: "y", auto: true }], paths: path,
              value: (u, _, s, i) => (i === null || i === undefined ? "–" : `${FW.number(u.data[s][0][i])}, ${FW.number(u.data[s][1][i])}`) }
          : { value: (_, v) => FW.number(v) }),
      }));
      const pad = (u, min, max) => (min === null ? [0, 1] : min === max ? [min - (Math.abs(min) || 1) * 0.1, max + (Math.abs(max) || 1) * 0.1] : [min - 0.04 * (max - min), max + 0.04 * (max - min)]);
      // With intervals the axis holds their ends.
      const ends = (k) => spec.ys.filter((y) => of(y) === k).flatMap((y) => [...(y.low || []), ...(y.high || [])]).filter(Number.isFinite).map((v) => v * shown[k].factor);
      const around = (k) => { const e = ends(k); return (u, min, max) => pad(u, min === null ? null : Math.min(min, ...e), Math.max(max, ...e)); };
      const [xlog, ylog] = spec.log || [];
      const decades = (u, min, max) => (min > 0 ? [min / (max / min || 1) ** 0.04 / 1.1, max * (max / min || 1) ** 0.04 * 1.1] : [0.1, 1]);
      const plain = (u, min, max) => (min === null ? [0, 1] : min === max ? [min - 1, max + 1] : [min, max]);
      const options = {
        width, height: Math.round(Math.min(340, Math.max(230, 0.55 * width))), mode: spec.loose ? 2 : 1,
        scales: { x: { time: false, ...(xlog ? { distr: 3, range: decades } : { range: spec.loose ? pad : plain }) }, y: ylog ? { distr: 3, range: decades } : { range: around(0) }, ...(units.length > 1 ? { y2: { range: pad } } : {}) },
        axes: [axis(named(spec.x.label, across.unit), "x", 2, spec.x.label === "cycle", xlog), axis(labels[0], "y", 3, false, ylog), ...(units.length > 1 ? [axis(labels[1], "y2", 1)] : [])],
        series: [spec.loose ? null : { label: named(spec.x.label, across.unit), value: (_, v) => FW.number(v, 5) }, ...series],
        cursor: { drag: { x: true, y: spec.loose === true, uni: 20 }, ...(spec.link ? { sync: { key: "time" } } : {}),
          ...(spec.loose ? { dataIdx: nearest, points: { size: 0 } } : {}) },
        legend: { live: true },
        hooks: { setScale: [(u, key) => { if (spec.link && key === "x") share(u); }] },
      };
      const data = spec.loose
        ? [null, ...spec.ys.map((y) => [times(y.x || spec.x.values, across.factor), times(y.values, shown[of(y)].factor)])]
        : [times(spec.x.values, across.factor), ...spec.ys.map((y) => times(y.values, shown[of(y)].factor))];
      chart = new uPlot(options, data, plot);
      if (spec.link) linked.add(chart);
      const says = spec.ys.map((y, k) => {
        const values = data[k + 1] && spec.loose ? data[k + 1][1] : data[k + 1];
        const finite = values.filter((v) => v !== null);
        if (!finite.length) return `${y.label}: no values`;
        const low = finite.reduce((a, b) => Math.min(a, b)), high = finite.reduce((a, b) => Math.max(a, b));
        return `${y.label} from ${FW.number(low)} to ${FW.number(high)} ${shown[of(y)].unit}, at the end ${FW.number(finite[finite.length - 1])}`;
      });
      plot.setAttribute("aria-label", `${spec.title} over ${spec.x.label}: ${says.join("; ")}`);
    };
    build();
    plot.addEventListener("keydown", (event) => keys(chart, event));
    let wide = host.clientWidth;
    new ResizeObserver(() => {
      if (!printing && Math.abs(host.clientWidth - wide) > 2) { wide = host.clientWidth; build(); }
    }).observe(host);
    redraws.add(build);
    return { remove: () => { redraws.delete(build); linked.delete(chart); chart.destroy(); plot.remove(); } };
  };

  const again = () => redraws.forEach((build) => build());
  dark.addEventListener("change", () => { again(); FW.redraw?.(); });
  const print = (on) => { if (printing !== on) { printing = on; if (dark.matches) { again(); } FW.still?.(); } };
  addEventListener("beforeprint", () => print(true));
  addEventListener("afterprint", () => print(false));
  matchMedia("print").addEventListener("change", (event) => print(event.matches));
}
