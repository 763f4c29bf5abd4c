#!/usr/bin/env bash
# What the friction of the fretting case depends on, with rigid and with compliant contacts: one cycle, three to seven seeds, one setting
# at a time. Prints a line a run: contacts, setting, seed, friction coefficient, damage ratio, position correction (J/m), external work (J/m),
# seconds of processor time.
# Usage: docs/accuracy.sh [FOLDER], from the root of the repository, after `cargo build --release`; ten minutes on two cores.
set -eu
out="${1:-results/accuracy}"
program="${FRETWORK:-target/release/fretwork}"
mkdir -p "$out"

within=()
springs=(--set solver.norm=Power --set solver.test_every=10)
for interface in third_body rail_oxide wheel_oxide; do
    within+=(--set "interfaces.$interface.bonds_within=2e-7")
    springs+=(--set "interfaces.$interface.contact=hertz-mindlin")
done

number() {
    sed -n "s/^ *\"$2\": \([-+.0-9e]*\),*\$/\1/p" "$1" | head -1
}

run() {
    local contacts="$1" setting="$2" seed="$3"
    shift 3
    local name="$out/$contacts-$setting-$seed"
    "$program" run cases/wheel_rail_fretting.ron --out "$name" --set time.end=0.1 --set "seed=$seed" --set output.frames=0 \
        --set output.views=0 "${within[@]}" "$@" >"$name.log" 2>&1 || true
    local of="$name/summary.json"
    echo "$contacts $setting $seed $(number "$of" friction_coefficient) $(number "$of" damage_ratio) $(number "$of" correction)" \
        "$(number "$of" external_work) $(number "$of" cpu_seconds)"
}

all() {
    local contacts="$1" tolerance="$2" tight="$3"
    shift 3
    for seed in 7 8 9 10 11 12 13; do
        run "$contacts" base "$seed" --set "solver.tolerance=$tolerance" "$@"
        run "$contacts" inertia-tenth "$seed" --set "solver.tolerance=$tolerance" --set inertia_scaling=5.8e7 "$@"
    done
    for seed in 7 8 9; do
        run "$contacts" tolerance "$seed" --set "solver.tolerance=$tight" "$@"
        run "$contacts" half-step "$seed" --set "solver.tolerance=$tolerance" --set time.step=2.5e-5 "$@"
        run "$contacts" alert-twice "$seed" --set "solver.tolerance=$tolerance" --set detection.alert=4e-7 "$@"
    done
}
all rigid 1e-3 1e-4 &
all compliant 0.5 0.005 "${springs[@]}"
wait
