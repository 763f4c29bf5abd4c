#!/usr/bin/env bash
# Explicit, midpoint and implicit coupling of damage on rigid disks under fretting at h, h/2, h/4
# and h/8: half a cycle, three seeds. Prints a line a run: coupling, step, seed, damage ratio,
# fracture energy (J/m), energy released by broken bonds over what their laws take, friction
# coefficient, steps that were not coupled, seconds of processor time; then the means over the
# seeds, with their standard errors.
# Usage: docs/coupling.sh [FOLDER], from the root of the repository, after `cargo build --release`;
# needs python3; half an hour on one core. SEEDS, STEPS, COUPLINGS and SETS (further `--set`s) may
# be given in the environment.
set -eu
out="${1:-results/coupling}"
program="${FRETWORK:-target/release/fretwork}"
mkdir -p "$out"

number() {
    python3 docs/summary_value.py "$@"
}

run() {
    local coupling="$1" step="$2" seed="$3"
    local name="$out/$coupling-$step-$seed" set=Explicit
    case "$coupling" in
    midpoint) set=Midpoint ;;
    implicit) set="Implicit(tolerance: 1e-3, max_iterations: 50)" ;;
    esac
    # shellcheck disable=SC2086
    "$program" run cases/wheel_rail_rigid.ron --out "$name" --set time.end=0.075 --set "seed=$seed" --set "time.step=$step" \
        --set "coupling=$set" --set output.frames=0 --set output.views=0 ${SETS:-} >"$name.log" 2>&1 || true
    local of="$name/summary.json"
    echo "$coupling $step $seed $(number "$of" damage_ratio) $(number "$of" energy fracture) $(number "$of" fracture released_over_declared)" \
        "$(number "$of" friction_coefficient) $(number "$of" solver uncoupled_steps) $(number "$of" cpu_seconds)"
}

for step in ${STEPS:-5e-5 2.5e-5 1.25e-5 6.25e-6}; do
    for seed in ${SEEDS:-7 8 9}; do
        for coupling in ${COUPLINGS:-explicit midpoint implicit}; do
            run "$coupling" "$step" "$seed"
        done
    done
done | tee "$out/runs.txt"

echo "means: coupling, step, damage ratio, fracture energy, released over declared, friction, each with its standard error; seconds"
awk '{
    key = $1 " " $2
    if (!(key in n)) order[++keys] = key
    n[key]++
    cost[key] += $9
    for (k = 4; k <= 7; k++) { sum[key, k] += $k; square[key, k] += $k * $k }
}
END {
    for (i = 1; i <= keys; i++) {
        key = order[i]
        line = key
        for (k = 4; k <= 7; k++) {
            mean = sum[key, k] / n[key]
            spread = square[key, k] / n[key] - mean * mean
            error = n[key] > 1 && spread > 0 ? sqrt(spread / (n[key] - 1)) : 0
            line = line sprintf("  %.4f +- %.4f", mean, error)
        }
        print line sprintf("  %.0f", cost[key] / n[key])
    }
}' "$out/runs.txt"
