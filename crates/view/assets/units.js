// Numbers with units: a prefix that suits the largest of them.
{
  const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];
  const TAKES = /^(m|N|Pa|s|J|W|Hz|g)(?=$|[ /])/;

  // Factor from the SI unit, and the unit with its prefix.
  FW.scaled = (most, unit) => {
    const size = Math.abs(most);
    // Volumes have a unit in common, since cubes of prefixes are far apart.
    if (/^m\^?3(?=$|[ /])/.test(unit) && size < 1e-2) return { factor: 1e9, unit: unit.replace(/^m\^?3/, "mm³") };
    if (!TAKES.test(unit) || !(size > 0) || !Number.isFinite(size)) return { factor: 1, unit };
    const all = unit.startsWith("s") ? PREFIXES.slice(3) : PREFIXES;
    const [step, prefix] = all.find(([step]) => size >= step) || all[all.length - 1];
    return { factor: 1 / step, unit: prefix + unit };
  };

  FW.number = (value, digits = 4) => {
    if (value === null || value === undefined || Number.isNaN(value)) return "–";
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size >= 1e-3 && size < 1e6) return String(Number(value.toPrecision(digits)));
    return value.toExponential(digits - 2).replace(/\.?0+e/, "e").replace("e+", "e");
  };

  FW.quantity = (value, unit, digits = 4) => {
    const { factor, unit: shown } = FW.scaled(value, unit);
    return FW.number(value * factor, digits) + (shown ? " " + shown : "");
  };

  FW.most = (values) => {
    let most = 0;
    for (const v of values) if (Number.isFinite(v) && Math.abs(v) > most) most = Math.abs(v);
    return most;
  };
}
