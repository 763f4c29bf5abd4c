// Scales of colours: from pale to dark for sizes, with a middle for values of both signs; bonds.
{
  const SIZES = [[242, 240, 232], [254, 204, 110], [240, 104, 44], [168, 24, 76], [66, 14, 84]];
  const SIGNS = [[33, 80, 160], [120, 170, 220], [240, 238, 232], [236, 140, 100], [160, 20, 40]];
  const mix = (table, t) => {
    const place = Math.max(0, Math.min(1, t)) * (table.length - 1);
    const k = Math.min(Math.floor(place), table.length - 2);
    return [0, 1, 2].map((c) => table[k][c] + (place - k) * (table[k + 1][c] - table[k][c]));
  };

  [FW.SIZES, FW.mix] = [SIZES, mix];

  FW.colours = {
    none: [150, 152, 156],
    grain: [222, 222, 218],
    first: [140, 148, 158],
    line: [120, 122, 126],
    edge: [96, 98, 102],
    broken: [20, 90, 230],
    chain: [40, 44, 52],
    bond: (damage) => mix([[150, 0, 12], [255, 112, 20]], damage),
  };

  // Whole numbers of few values are shown as they are.
  FW.range = (field, whole) => {
    const [low, high] = whole ? field.all : field.most;
    if (low < 0 && high > 0) { const top = Math.max(-low, high); return { low: -top, high: top, table: SIGNS }; }
    if (low === high) return { low: field.all[0], high: field.all[1], table: SIZES };
    return { low: low > 0 && low < 0.5 * high ? 0 : low, high, table: SIZES };
  };

  FW.colourOf = (range, value) => {
    if (!Number.isFinite(value)) return FW.colours.none;
    const { low, high, table } = range;
    return mix(table, high > low ? (value - low) / (high - low) : 0.5);
  };

  FW.gradient = (table) => `linear-gradient(to right, ${table.map((c) => `rgb(${c.join(",")})`).join(", ")})`;
}
