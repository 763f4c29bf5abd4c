#!/usr/bin/env bash
# What the friction of the fretting cases depends on: one cycle, several seeds, one setting at a
# time. Groups: rigid and compliant, disks with rigid and with compliant contacts
# (cases/wheel_rail_rigid.ron); angular, polygons with compliant contacts
# (cases/wheel_rail_fretting.ron). Prints a line a run: group, setting, seed, energetic coefficient,
# coefficient of sliding, damage ratio, position correction (J/m), external work (J/m), energy
# released by broken bonds over what their laws take, seconds of processor time.
# Usage: docs/accuracy.sh [FOLDER [GROUP...]], from the root of the repository, after `cargo build
# --release`; needs python3; disks take ten minutes on two cores, angular two and a half hours of
# one. SEEDS="7 8" takes other seeds than each group's own.
set -eu
out="${1:-results/accuracy}"
shift || true
groups=("${@:-rigid compliant angular}")
program="${FRETWORK:-target/release/fretwork}"
mkdir -p "$out"

within=()
springs=(--set solver.norm=Power --set solver.test_every=10)
for interface in third_body rail_oxide wheel_oxide; do
    within+=(--set "interfaces.$interface.bonds_within=2e-7")
    springs+=(--set "interfaces.$interface.contact=hertz-mindlin")
done

number() {
    python3 docs/summary_value.py "$@"
}

# run GROUP SETTING SEED CASE OPTIONS...
run() {
    local group="$1" setting="$2" seed="$3" case="$4"
    shift 4
    local name="$out/$group-$setting-$seed"
    "$program" run "cases/$case.ron" --out "$name" --set "seed=$seed" --set output.frames=0 --set output.views=0 "$@" \
        >"$name.log" 2>&1 || true
    local of="$name/summary.json"
    echo "$group $setting $seed $(number "$of" energetic_coefficient) $(number "$of" friction_coefficient) $(number "$of" damage_ratio)" \
        "$(number "$of" energy correction) $(number "$of" energy external_work) $(number "$of" fracture released_over_declared) $(number "$of" cpu_seconds)"
}

# moduli OXIDE STEEL: Young's moduli in Pa.
moduli() {
    local at=parameters.contact
    echo "--set interfaces.third_body.$at.young_1=$1 --set interfaces.third_body.$at.young_2=$1"
    for interface in rail_oxide wheel_oxide; do
        echo "--set interfaces.$interface.$at.young_1=$2 --set interfaces.$interface.$at.young_2=$1"
    done
}

# disks GROUP TOLERANCE TIGHT OPTIONS...
disks() {
    local group="$1" tolerance="$2" tight="$3" case=wheel_rail_rigid
    shift 3
    set -- --set time.end=0.1 "${within[@]}" "$@"
    for seed in ${SEEDS:-7 8 9 10 11 12 13}; do
        run "$group" base "$seed" $case --set "solver.tolerance=$tolerance" "$@"
        run "$group" inertia-tenth "$seed" $case --set "solver.tolerance=$tolerance" --set inertia_scaling=5.8e7 "$@"
    done
    for seed in ${SEEDS:-7 8 9}; do
        run "$group" tolerance "$seed" $case --set "solver.tolerance=$tight" "$@"
        run "$group" half-step "$seed" $case --set "solver.tolerance=$tolerance" --set time.step=2.5e-5 "$@"
        run "$group" alert-twice "$seed" $case --set "solver.tolerance=$tolerance" --set detection.alert=4e-7 "$@"
    done
}

angular() {
    local case=wheel_rail_fretting
    local wide=(--set periodic.x=8e-4 --set "grains.0.high=[8e-4, 4.32e-5]" --set bodies.rail.shapes.0.points=1600
        --set bodies.wheel.shapes.0.points=1600 --set bodies.wheel.mass=22000.0
        --set "bodies.wheel.dofs.y=Force(Table([(0.0, -4480.0), (0.005, -4480.0), (0.022, -8.96e5)]))")
    for seed in ${SEEDS:-7 8 9 10 11 12 13 14 15 16}; do
        run angular base "$seed" $case --set time.end=0.075
        run angular fine "$seed" $case --set time.end=0.075 --set time.step=6.25e-6 --set solver.tolerance=0.005
        run angular alert-twice "$seed" $case --set time.end=0.075 --set detection.alert=4e-7
        run angular inertia-tenth "$seed" $case --set time.end=0.075 --set inertia_scaling=5.8e7
        run angular window-twice "$seed" $case --set time.end=0.075 "${wide[@]}"
    done
    for seed in ${SEEDS:-7 8 9}; do
        run angular tolerance "$seed" $case --set time.end=0.075 --set solver.tolerance=0.005
        run angular half-step "$seed" $case --set time.end=0.075 --set time.step=1.25e-5
        # shellcheck disable=SC2046
        run angular soft "$seed" $case --set time.end=0.075 $(moduli 8.25e10 1.05e11)
        # shellcheck disable=SC2046
        run angular stiff "$seed" $case --set time.end=0.075 $(moduli 3.3e11 4.2e11)
    done
}

for group in ${groups[*]}; do
    case "$group" in
    rigid) disks rigid 1e-3 1e-4 & ;;
    compliant) disks compliant 0.5 0.005 "${springs[@]}" & ;;
    angular) angular & ;;
    *) echo "unknown group $group: rigid, compliant or angular" >&2 && exit 1 ;;
    esac
done
wait
