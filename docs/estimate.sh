#!/usr/bin/env bash
# Whether the error that runs estimate of themselves covers what finer settings really change: six
# cases, two seeds each, as they are, with a quarter of the step, and with a hundredth of the
# tolerance. Prints a line a case, setting and result: the change that the repeated steps show, the
# half-width that the run reports, the actual change (means over the seeds, %), and whether the
# half-width covers it; changes below 0.2 % count as covered.
# Usage: docs/estimate.sh [FOLDER], from the root of the repository, after `cargo build --release`;
# needs python3; twenty minutes on two cores, most of them for the tight tolerance of the first
# case. Runs that are in the folder already are not made again.
set -eu
out="${1:-results/estimate}"
program="${FRETWORK:-target/release/fretwork}"
seeds="${SEEDS:-7 8}"
mkdir -p "$out"

run() {
    local name="$out/$1" case="$2"
    shift 2
    [ -e "$name/summary.json" ] || "$program" run "cases/$case.ron" --out "$name" --set output.frames=0 --set output.views=0 \
        --set output.figures=false "$@" >"$name.log" 2>&1 || true
}

# A case: its name, its step, its tolerance, and what else is set.
study() {
    local case="$1" step="$2" tolerance="$3" seed
    shift 3
    for seed in $seeds; do
        run "$case-$seed-base" "$case" --set "seed=$seed" "$@"
        run "$case-$seed-step" "$case" --set "seed=$seed" --set uncertainty.repeats=0 --set "time.step=$step" "$@"
        run "$case-$seed-tolerance" "$case" --set "seed=$seed" --set uncertainty.repeats=0 --set "solver.tolerance=$tolerance" "$@"
    done
}

first() {
    study regime_map 2.5e-5 1e-5
    study shear_cell_3d 2.5e-5 1e-6 --set time.end=0.1
    study punch_scar 6.25e-6 1e-8
}
second() {
    study fretting_scar 2.5e-5 1e-10
    study plane_shear 5e-5 1e-5 --set time.end=0.6
    study wheel_rail_rigid 1.25e-5 1e-5 --set time.end=0.1
}
first &
second
wait

python3 - "$out" $seeds <<'PYTHON'
import json
import os
import sys

out, seeds = sys.argv[1], sys.argv[2:]
results = ["friction_coefficient", "friction_energy", "damage_ratio", "wear"]
effect = {"damage_ratio": "damage"}


def summary(case, seed, setting):
    path = f"{out}/{case}-{seed}-{setting}/summary.json"
    return json.load(open(path)) if os.path.exists(path) else None


def mean(values):
    return sum(values) / len(values)


held, all_of = 0, 0
for case in ["wheel_rail_rigid", "plane_shear", "shear_cell_3d", "regime_map", "fretting_scar", "punch_scar"]:
    for setting in ["step", "tolerance"]:
        for name in results:
            rows = []
            for seed in seeds:
                base, fine = summary(case, seed, "base"), summary(case, seed, setting)
                if not base or not fine:
                    continue
                known = base["uncertainty"]
                half, change = known[name][setting], known["repeats"][setting][effect.get(name, name)]
                value, finer = known[name]["value"], fine["uncertainty"][name]["value"]
                if half is None or finer is None:
                    continue
                rows.append((change["change"], half / abs(value), finer / value - 1, known["repeats"]["cost_share"]))
            if not rows:
                continue
            change, half, actual, cost = (100 * mean([r[k] for r in rows]) for k in range(4))
            holds = abs(actual) <= max(half, 0.2)
            held, all_of = held + holds, all_of + 1
            print(f"{case:20} {setting:9} {name:20} seeds {len(rows)} shown {change:+7.2f} reported +-{half:6.2f} "
                  f"actual {actual:+7.2f} cost {cost:.1f} {'holds' if holds else 'FAILS'}", flush=True)
print(f"holds in {held} of {all_of}")
PYTHON
