"""Results of runs of docs/sensitivity.sh, and the table of their changes with a setting.

Usage: python3 docs/sensitivity.py row FOLDER OUTPUT...    a line of a run; its results are kept in FOLDER.tsv
       python3 docs/sensitivity.py table FOLDER            all such lines of a folder, as changes from `base`

An output is a path in summary.json (`scars.0.depth`), a column of statistics.csv (`statistics.wall_fx:max`, or `:last`, the last row), or a ratio of two.
"""

import csv
import json
import math
import pathlib
import sys


def value(folder, output):
    """One output of a run, nan where there is none."""
    if "/" in output:
        above, below = (value(folder, part) for part in output.split("/"))
        return above / below if below else math.nan
    try:
        if output.startswith("statistics."):
            column, how = output.removeprefix("statistics.").split(":")
            with open(folder / "statistics.csv") as file:
                rows = csv.reader(file)
                place = [name.split(" ")[0] for name in next(rows)].index(column)
                numbers = [float(row[place]) for row in rows if row]
            return max(numbers) if how == "max" else numbers[-1]
        with open(folder / "summary.json") as file:
            found = json.load(file)
        for key in output.split("."):
            found = found[int(key)] if isinstance(found, list) else found[key]
        return float(found)
    except (OSError, KeyError, IndexError, TypeError, ValueError):
        return math.nan


def row(folder, outputs):
    """Prints and keeps the outputs of a run."""
    case, setting, seed = folder.name.rsplit(".", 2)
    found = [value(folder, output) for output in outputs]
    cost = value(folder, "cpu_seconds")
    print(case, setting, seed, f"{cost:.1f}", *(f"{x:.4g}" for x in found), flush=True)
    with open(folder.with_name(folder.name + ".tsv"), "w") as file:
        file.write("\t".join([case, setting, seed, repr(cost)]) + "\n")
        for output, x in zip(outputs, found):
            file.write(f"{output}\t{x!r}\n")


def spread(numbers):
    """Mean and standard error."""
    n = len(numbers)
    mean = sum(numbers) / n
    if n < 2:
        return mean, math.nan
    return mean, math.sqrt(sum((x - mean) ** 2 for x in numbers) / (n * (n - 1)))


def change(base, other, is_share):
    """Mean change over the seeds in % (of a share of energy: in per cent of it) with its standard error."""
    pairs = [(base[seed], other[seed]) for seed in other if seed in base]
    pairs = [(a, b) for a, b in pairs if math.isfinite(a) and math.isfinite(b) and (is_share or a)]
    if not pairs:
        return "", ""
    differences = [100 * (b if is_share else (b - a) / abs(a)) for a, b in pairs]
    mean, error = spread(differences)
    sign = "" if is_share else "+"
    text = f"{mean:{sign}.2g}" if abs(mean) < 0.1 else f"{mean:{sign}.1f}"
    return text, "" if math.isnan(error) else f" ± {error:.1f}"


def table(folder):
    """Prints changes with each setting, one line for each output of each case."""
    results, costs, order = {}, {}, []
    for file in sorted(folder.glob("*.tsv"), key=lambda f: f.stat().st_mtime):
        lines = file.read_text().splitlines()
        case, setting, seed, cost = lines[0].split("\t")
        costs.setdefault((case, setting), []).append(float(cost))
        for line in lines[1:]:
            output, x = line.split("\t")
            key = (case, output)
            if key not in results:
                results[key] = {}
                order.append(key)
            results[key].setdefault(setting, {})[seed] = float(x)
    settings = ["fine", "inertia", "alert", "window", "soft", "explicit", "explicit-fine"]
    print("| case | output | seeds | base | scatter (%) | " + " | ".join(settings) + " | cpu (s) of base, " + ", ".join(settings) + " |")
    print("|---" * (len(settings) + 6) + "|")
    for key in order:
        case, output = key
        by = results[key]
        if "base" not in by:
            continue
        base = by["base"]
        numbers = [x for x in base.values() if math.isfinite(x)]
        if not numbers:
            continue
        share = "/energy." in output
        mean, error = spread(numbers)
        scatter = "" if math.isnan(error) or share or not mean else f"{100 * error * math.sqrt(len(numbers)) / abs(mean):.1f}"
        cells = ["".join(change(base, by[s], share)) if s in by else "" for s in settings]
        spent = [f"{spread(costs[case, s])[0]:.0f}" if (case, s) in costs else "-" for s in ["base", *settings]]
        shown = f"{100 * mean:.2g} %" if share else f"{mean:.4g}"
        print("|", " | ".join([case, output, str(len(numbers)), shown, scatter, *cells, ", ".join(spent)]), "|")


if __name__ == "__main__":
    what, at = sys.argv[1], pathlib.Path(sys.argv[2])
    if what == "row":
        row(at, sys.argv[3:])
    else:
        table(at)
