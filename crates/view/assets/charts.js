// Charts: uPlot with the colours of the page, axes with units, zoom that charts share, and keys.
{
  const dark = matchMedia("(prefers-color-scheme: dark)");
  let printing = false;
  const groups = new Map();
  const redraws = new Set();
  let sharing = false;

  FW.isDark = () => dark.matches && !printing;
  const ink = () => (FW.isDark() ? ["#c3c8d0", "#2c3038"] : ["#444a54", "#e6e8ec"]);
  const css = (rgb) => `rgb(${rgb.map(Math.round).join(",")})`;
  const EMPTY = [231, 232, 235];
  const colour = (series, k, gradient, count) => {
    // What is dark on paper is made lighter on a dark page.
    const shown = (rgb) => css(FW.isDark() ? rgb.map((c) => c + 0.45 * (255 - c)) : rgb);
    if (series.colour) return shown(series.colour);
    const { light, dark, order } = FW.data.palette;
    if (gradient) return shown(FW.mix(order, k / Math.max(1, count - 1)));
    return css((FW.isDark() ? dark : light)[(series.place ?? k) % light.length]);
  };

  // Ticks of a logarithmic axis: whole multiples of powers of ten, with labels at the powers, and
  // over few of them at 2 and 5 times these.
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

  const axis = ({ label, log, whole }, scale, side) => {
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

  const others = (chart) => [...(groups.get(chart.group) || [])].filter((other) => other !== chart);
  const share = (chart) => {
    if (sharing || !groups.get(chart.group)?.has(chart)) return;
    sharing = true;
    const { min, max } = chart.scales.x;
    others(chart).forEach((other) => other.setScale("x", { min, max }));
    sharing = false;
  };
  // All of each chart, also of those that share its zoom.
  const whole = (chart) => {
    sharing = true;
    [chart, ...others(chart)].forEach((c) => c.setData(c.data));
    sharing = false;
  };

  const clipped = (u, draw) => {
    const { ctx, bbox } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    draw(ctx, (x) => u.valToPos(x, "x", true), (y, scale = "y") => u.valToPos(y, scale, true));
    ctx.restore();
  };

  // Lines through points in any order, bars of intervals, markers.
  const path = (u, s) => {
    const [xs, ys] = u.data[s];
    const { line, dashed, markers, low, high, factor, scale, stroke } = u.series[s].style;
    clipped(u, (ctx, across, up) => {
      const px = devicePixelRatio, y = (v) => up(v, scale);
      ctx.strokeStyle = ctx.fillStyle = stroke();
      ctx.lineWidth = 1.6 * px;
      ctx.lineJoin = "round";
      if (line !== false) {
        ctx.beginPath();
        let pen = false;
        for (let k = 0; k < xs.length; k++) {
          if (xs[k] === null || ys[k] === null) { pen = false; continue; }
          pen ? ctx.lineTo(across(xs[k]), y(ys[k])) : ctx.moveTo(across(xs[k]), y(ys[k]));
          pen = true;
        }
        ctx.setLineDash(dashed ? [7 * px, 5 * px] : []);
        ctx.stroke();
        ctx.setLineDash([]);
      }
      const end = (values, k) => (values && Number.isFinite(values[k]) ? y(values[k] * factor) : null);
      for (let k = 0; k < xs.length; k++) {
        if (xs[k] === null || ys[k] === null) continue;
        const x = across(xs[k]), [a, b] = [end(low, k), end(high, k)], w = 3 * px;
        if (a !== null && b !== null) {
          ctx.beginPath();
          [[x - w, a, x + w, a], [x, a, x, b], [x - w, b, x + w, b]].forEach(([p, q, r, t]) => { ctx.moveTo(p, q); ctx.lineTo(r, t); });
          ctx.stroke();
        }
        if (markers) {
          ctx.beginPath();
          ctx.arc(x, y(ys[k]), 3.2 * px, 0, 2 * Math.PI);
          ctx.fill();
        }
      }
    });
    return null;
  };

  // Coloured cells, and arrows over them.
  const cells = (field, spec) => (u) => clipped(u, (ctx, across, up) => {
    const [fx, fy] = [spec.x.factor, spec.y.factor];
    const range = field.scale && { low: 0, high: field.scale.range[1], table: FW.SIZES };
    for (let k = 0; k + 1 < field.starts.length; k++) {
      ctx.beginPath();
      for (let p = field.starts[k]; p < field.starts[k + 1]; p++) ctx.lineTo(across(field.x[p] * fx), up(field.y[p] * fy));
      ctx.closePath();
      ctx.fillStyle = ctx.strokeStyle = css(!field.scale ? field.classes[field.values[k]][1] : Number.isFinite(field.values[k]) ? FW.colourOf(range, field.values[k]) : EMPTY);
      ctx.fill();
      ctx.stroke();
    }
    const far = [], long = 0.07 * u.bbox.width;
    ctx.lineWidth = 1.2 * devicePixelRatio;
    ctx.strokeStyle = "#000";
    for (const [[x, y], [dx, dy]] of field.arrows) {
      const at = [across(x * fx), up(y * fy)];
      if (far.some(([a, b]) => Math.hypot(a - at[0], b - at[1]) < 0.5 * long)) continue;
      far.push(at);
      const by = [dx * long, -dy * long], tip = [at[0] + by[0] / 2, at[1] + by[1] / 2];
      const wing = (s) => [tip[0] - 0.3 * by[0] + s * 0.15 * by[1], tip[1] - 0.3 * by[1] - s * 0.15 * by[0]];
      ctx.beginPath();
      ctx.moveTo(at[0] - by[0] / 2, at[1] - by[1] / 2);
      [tip, wing(1)].forEach((p) => ctx.lineTo(...p));
      ctx.moveTo(...tip);
      ctx.lineTo(...wing(-1));
      ctx.stroke();
    }
  });
  const keyOf = (field) => {
    const parts = field.scale ? [FW.ramp(field.scale.name, { low: 0, high: field.scale.range[1], table: FW.SIZES }, field.scale.unit, "")] : field.classes.map(([name, rgb]) => FW.key(rgb, name));
    return FW.element("div", { class: "legend" }, ...parts, ...(field.arrows.length ? [`arrows: ${field.arrow_label}`] : []));
  };

  // The point under the cursor: the nearest along the axis where points follow it, else the nearest
  // of all, if it is near.
  const nearest = (u, s) => {
    const { left, top } = u.cursor;
    if (left < 0 || !u.series[s].show) return null;
    const [xs, ys] = u.data[s], rises = u.series[s].style.rises;
    let best = null, least = rises ? Infinity : 40 * 40;
    for (let k = 0; k < xs.length; k++) {
      if (xs[k] === null || ys[k] === null) continue;
      const dx = u.valToPos(xs[k], "x") - left, dy = rises ? 0 : u.valToPos(ys[k], u.series[s].style.scale) - top;
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
    else if (event.key === "Escape" || event.key === "0") whole(chart);
    else return;
    event.preventDefault();
  };

  // Range of a scale: the one in the data of the page. Where series are hidden, or an axis was
  // chosen in the browser, it is computed by the rules of `Axis::range` of the library.
  const ranged = ({ log, range, fixed, factor }, ends) => (u, min, max) => {
    if (range && (fixed || u.series.every((s) => !s || s.show !== false))) return range.map((v) => v * factor);
    const all = ends.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [min ?? Infinity, max ?? -Infinity]);
    const known = all[0] <= all[1] && (!log || all[0] > 0) ? all : log ? [0.1, 10] : [0, 1];
    const [a, b] = log ? known.map(Math.log10) : known;
    const varies = b - a > 1e-9 * Math.max(Math.abs(a), Math.abs(b));
    const pad = varies ? 0.04 * (b - a) : log || a === 0 ? 1 : 0.1 * Math.abs(a);
    return [a - pad, b + pad].map((v) => (log ? 10 ** v : v));
  };

  // spec: {title, x, y, y2: axes as {name, unit, label, factor, log, whole, range, fixed}, series:
  // [{label, x, y, low, high, second, line, dashed, markers, colour, place}], gradient, field,
  // link: name of the charts that share their zoom}, with numbers in the units of the axes
  FW.chart = (host, spec) => {
    const plot = FW.element("div", { class: "plot", tabindex: 0, role: "img" });
    host.append(plot);
    const axes = { y: spec.y, ...(spec.y2 ? { y2: spec.y2 } : {}) };
    const times = (values, { factor, log }) => Array.from(values, (v) => (Number.isFinite(v) && (!log || v > 0) ? v * factor : null));
    const of = (s) => (s.second ? "y2" : "y");
    const points = spec.series.map((s) => [times(s.x, spec.x), times(s.y, axes[of(s)])]);
    if (spec.field) points.push([spec.x, spec.y].map(({ range, factor }) => range.map((v) => v * factor)));
    const ends = (scale) => spec.series.filter((s) => of(s) === scale).flatMap((s) => [...(s.low || []), ...(s.high || [])]).filter(Number.isFinite).map((v) => v * axes[scale].factor);
    const distr = ({ log }) => (log ? { distr: 3 } : {});
    const named = spec.series.some((s) => s.label) && spec.series.length <= 14;
    let chart = null;
    const join = (u) => {
      u.group = spec.link;
      if (!groups.has(u.group)) groups.set(u.group, new Set());
      groups.get(u.group).add(u);
    };
    const leave = () => { if (chart) { groups.get(chart.group)?.delete(chart); chart.destroy(); } };
    const build = () => {
      leave();
      const width = Math.max(260, host.clientWidth);
      const across = spec.field ? (spec.y.range[1] - spec.y.range[0]) / (spec.x.range[1] - spec.x.range[0]) : 0.55;
      const series = spec.series.map((s, k) => {
        const stroke = () => colour(s, k, spec.gradient, spec.series.length);
        const rises = points[k][0].every((x, i, all) => i === 0 || x >= all[i - 1]);
        return {
          label: s.label || spec.y.name, stroke, facets: [{ scale: "x", auto: true }, { scale: of(s), auto: true }], paths: path,
          style: { ...s, stroke, rises, scale: of(s), factor: axes[of(s)].factor },
          value: (u, _, i, p) => (p === null || p === undefined ? "–" : `${FW.number(u.data[i][1][p])}${rises && k ? "" : ` at ${FW.number(u.data[i][0][p])}`}`),
        };
      });
      if (spec.field) series.push({ show: true, facets: [{ scale: "x", auto: true }, { scale: "y", auto: true }], paths: () => null, style: {} });
      const scales = Object.entries(axes).map(([scale, a]) => [scale, { ...distr(a), range: ranged(a, ends(scale)) }]);
      chart = new uPlot({
        width, height: Math.round(spec.field ? across * (width - 62) + 58 : Math.min(340, Math.max(230, across * width))), mode: 2,
        scales: { x: { time: false, ...distr(spec.x), range: ranged(spec.x, []) }, ...Object.fromEntries(scales) },
        axes: [axis(spec.x, "x", 2), axis(spec.y, "y", 3), ...(spec.y2 ? [axis(spec.y2, "y2", 1)] : [])],
        series: [null, ...series],
        cursor: { drag: { x: true, y: true, uni: 20 }, sync: { key: spec.link }, dataIdx: nearest, points: { size: 0 }, bind: { dblclick: (u) => () => whole(u) } },
        legend: { show: named || (spec.series.length === 1 && !spec.field), live: true },
        hooks: { ready: [join], setScale: [(u, key) => { if (key === "x") share(u); }], drawAxes: spec.field ? [cells(spec.field, spec)] : [] },
      }, [null, ...points], plot);
      const says = spec.series.map((s, k) => {
        const finite = points[k][1].filter((v) => v !== null);
        if (!finite.length) return `${s.label}: no values`;
        const [low, high] = [Math.min, Math.max].map((f) => finite.reduce((a, b) => f(a, b)));
        return `${s.label || spec.y.name} from ${FW.number(low)} to ${FW.number(high)}, at the end ${FW.number(finite[finite.length - 1])}`;
      });
      plot.setAttribute("aria-label", `${spec.title}, ${spec.y.label} over ${spec.x.label}: ${says.join("; ")}`);
    };
    build();
    if (spec.field) host.append(keyOf(spec.field));
    plot.addEventListener("keydown", (event) => keys(chart, event));
    let wide = host.clientWidth;
    new ResizeObserver(() => {
      if (!printing && Math.abs(host.clientWidth - wide) > 2) { wide = host.clientWidth; build(); }
    }).observe(host);
    redraws.add(build);
    return { remove: () => { redraws.delete(build); leave(); plot.remove(); } };
  };

  const again = () => redraws.forEach((build) => build());
  dark.addEventListener("change", () => { again(); FW.redraw?.(); });
  const print = (on) => { if (printing !== on) { printing = on; if (dark.matches) { again(); } FW.still?.(); } };
  addEventListener("beforeprint", () => print(true));
  addEventListener("afterprint", () => print(false));
  matchMedia("print").addEventListener("change", (event) => print(event.matches));
}
