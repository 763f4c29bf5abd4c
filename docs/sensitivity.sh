#!/usr/bin/env bash
# How the results of the shipped cases depend on numerical settings: each case as it is, and with
# one setting changed at a time: a quarter of the step with a hundredth of the tolerance (fine), a
# tenth of the inertia where it is scaled (inertia), twice the alert distance (alert), twice the
# window where it is periodic (window), half of Young's moduli where contacts are springs (soft:
# physics). Cases with broken bonds also with damage coupled at the start of a step (explicit,
# explicit-fine). docs/accuracy.sh has wheel_rail_fretting and wheel_rail_rigid. Scars have no
# sample: their seed k lengthens the step by k times a relative 1e-10, and shows how far friction of
# single cycles amplifies rounding. Prints a line a run, case, setting, seed, seconds of processor
# time, results, and at the end the table of changes.
# Usage: docs/sensitivity.sh [FOLDER [CASE...]], from the root of the repository, after `cargo build
# --release`; needs python3; runs that are in FOLDER are not made again: take another FOLDER when a
# case has changed. SEEDS="3 4" takes other seeds than each case's own, SETTINGS="base fine" only
# these settings.
set -eu
out="${1:-results/sensitivity}"
shift || true
wanted="$*"
program="${FRETWORK:-target/release/fretwork}"
mkdir -p "$out"

# case_is NAME SEEDS OUTPUTS OPTIONS...: begins a case; outputs are those of `fretwork trade`, and
# ratios of two.
case_is() {
    case="$1" seeds="${SEEDS:-$2}" outputs="$3"
    shift 3
    common=("$@") nudged=no
    [ -z "$wanted" ] || [[ " $wanted " == *" $case "* ]]
}

# with SETTING OPTIONS...: runs the case for each of its seeds.
with() {
    local setting="$1" seed option options
    shift
    [ -z "${SETTINGS:-}" ] || [[ " $SETTINGS " == *" $setting "* ]] || return 0
    for seed in $seeds; do
        local name="$out/$case.$setting.$seed"
        options=()
        for option in "${common[@]}" "$@"; do
            [[ "$nudged $option" != "yes time.step="* ]] || option="time.step=$(python3 -c "print(${option#*=} * (1 + $seed * 1e-10))")"
            options+=("$option")
        done
        if [ ! -e "$name/finished" ]; then
            "$program" run "cases/$case.ron" --out "$name" --set "seed=$seed" --set uncertainty.repeats=0 --set output.frames=0 \
                --set output.views=0 --set output.figures=false "${options[@]}" >"$name.log" 2>&1 && touch "$name/finished"
            rm -f "$name"/*.h5 "$name"/*.vtkhdf
        fi
        if [ ! -e "$name/finished" ]; then
            echo "$case $setting $seed did not finish: $name.log" >&2
            continue
        fi
        # shellcheck disable=SC2086
        python3 docs/sensitivity.py row "$name" $outputs
    done
}

# settings STEP TOLERANCE ALERT: the settings that every case has.
settings() {
    local quarter hundredth twice
    quarter=$(python3 -c "print($1 / 4)")
    hundredth=$(python3 -c "print($2 / 100)")
    twice=$(python3 -c "print($3 * 2)")
    fine=(--set "time.step=$quarter" --set "solver.tolerance=$hundredth")
    with base --set "time.step=$1"
    with fine "${fine[@]}"
    with alert --set "time.step=$1" --set "detection.alert=$twice"
}

# explicit: damage coupled at the start of a step, and so with finer settings.
explicit() {
    with explicit --set coupling=Explicit
    with explicit-fine --set coupling=Explicit "${fine[@]}"
}

# wall COUNT: a row of COUNT disks of 8 mm.
wall() {
    python3 -c "print('[Balls([' + ', '.join(f'([{0.004 + 0.008 * k:.4f}, 0.0], 0.004)' for k in range($1)) + '])]')"
}

# window_of_disks COUNT LOW HIGH: twice the period of a layer of COUNT disks between walls of disks.
window_of_disks() {
    with window --set periodic.x=0.4 --set "grains.0.count=$1" --set "grains.0.low=[0.0, $2]" --set "grains.0.high=[0.4, $3]" \
        --set "bodies.bottom.shapes=$(wall 50)" --set "bodies.top.shapes=$(wall 50)"
}

# half_moduli NAME:MODULUS:MODULUS...: options for contacts with half of these Young's moduli, in
# Pa.
half_moduli() {
    local each name one other at=parameters.contact
    for each in "$@"; do
        IFS=: read -r name one other <<<"$each"
        echo "--set interfaces.$name.$at.young_1=$one --set interfaces.$name.$at.young_2=$other"
    done
}

correction=energy.correction/energy.external_work
released=fracture.released_over_declared

if case_is voronoi_block "3 4 5" "statistics.wall_fx:max energy.fracture broken $released"; then
    settings 2e-6 1e-3 1e-4
    explicit
fi
if case_is voronoi_block_3d "3 4 5" "statistics.left_fx:max energy.fracture broken $released"; then
    settings 2e-6 1e-3 1e-4
    explicit
fi
if case_is regime_map "19 20 21" "friction_coefficient broken $released $correction"; then
    settings 1e-4 1e-3 2e-4
    explicit
    window_of_disks 800 0.004 0.226
fi
if case_is fault_propagation "23 24" "broken measures.fault_angle measures.fault_width measures.sheared_grains $correction"; then
    settings 5e-4 1e-3 8e-5
    explicit
fi
if case_is forced_fold "29 30" "broken measures.left_angle measures.right_angle measures.sheared_grains $correction"; then
    settings 5e-4 1e-3 8e-5
    explicit
fi
if case_is wheel_rail_degradable "7 8" "energetic_coefficient friction_coefficient damage_ratio energy.friction $released" --set time.end=0.1; then
    settings 5e-5 0.5 2e-7
    with inertia --set inertia_scaling=5.8e7
    with window --set periodic.x=8e-4 --set grains.0.count=2400 --set "grains.0.high=[8e-4, 5.05e-5]" --set grains.1.count=1380 \
        --set "grains.1.high=[8e-4, 8e-5]" --set bodies.rail.shapes.0.points=1600 --set bodies.wheel.shapes.0.points=1600 \
        --set bodies.wheel.mass=22000.0 --set "bodies.wheel.dofs.y=Force(Table([(0.0, -8960.0), (0.03, -8960.0), (0.045, -8.96e5)]))"
    # shellcheck disable=SC2046
    with soft $(half_moduli rail_metal:1.05e11:1.05e11 rail_base:1.05e11:1.05e11 third_body:8.25e10:8.25e10 metal_oxide:1.05e11:8.25e10 \
        rail_oxide:1.05e11:8.25e10 wheel_oxide:1.05e11:8.25e10 wheel_metal:1.05e11:1.05e11)
fi
if case_is third_body_steady "5 6" "friction_coefficient broken energy.friction $released" --set time.end=0.11; then
    settings 1e-5 0.5 2e-7
    with inertia --set inertia_scaling=2e6
    # shellcheck disable=SC2046
    with soft $(half_moduli rail_metal:8.25e10:8.25e10 rail_base:1.05e11:8.25e10 face:1.05e11:8.25e10 press:1.05e11:8.25e10)
fi
if case_is wheel_rail_rolling "3 4" "friction_coefficient energy.friction $correction"; then
    settings 4e-5 5e-5 3.1e-4
    with inertia --set inertia_scaling=1e3
fi
if case_is fretting_scar "0 1 2" "uncertainty.friction_coefficient.value scars.0.depth wear.volume_first_bodies"; then
    nudged=yes
    settings 1e-4 1e-8 2e-4
fi
if case_is punch_scar "0 1 2" "uncertainty.friction_coefficient.value scars.0.depth scars.0.middle wear.volume_first_bodies"; then
    nudged=yes
    settings 2.5e-5 1e-6 2e-4
fi
if case_is fretting_wear_jump "0 1 2" "uncertainty.friction_coefficient.value scars.0.depth wear.volume_first_bodies"; then
    nudged=yes
    settings 5e-4 1e-5 2e-4
fi
if case_is plane_shear "19 20" "measures.bulk_mu measures.bulk_phi measures.bulk_I $correction"; then
    settings 2e-4 1e-3 8e-4
    window_of_disks 1000 0.005 0.265
fi
if case_is cohesive_shear "19 20" "measures.bulk_mu measures.bulk_phi measures.bulk_I $correction"; then
    settings 2e-4 1e-3 1.6e-4
    window_of_disks 1000 0.005 0.265
fi
if case_is shear_cell_3d "2 3 4" "friction_coefficient energy.friction wear.volume_first_bodies $correction"; then
    settings 1e-4 1e-4 5e-4
    with window --set periodic.x=0.16 --set "bodies.floor.shapes.0.points=(32, 16)" --set grains.0.count=960 \
        --set "grains.0.high=[0.16, 0.08, 0.0525]" --set bodies.lid.mass=1.0 --set "bodies.lid.dofs.z=Force(Constant(-12.8))"
fi
if case_is collapse "5 6 7" "statistics.beyond:last energy.friction energy.potential" \
    --set 'measures=[Mass(name: "beyond", axis: 0, above: 0.28)]'; then
    settings 2.5e-4 5e-4 1.5e-4
fi
if case_is biaxial "11 12" "biaxial.peak_ratio $correction" --set grains.0.count=500 --set "bodies.right.position=[0.26, 0]" \
    --set "bodies.top.position=[0, 0.265]" --set "grains.0.high=[0.26, 0.265]"; then
    settings 4e-4 5e-4 1e-3
fi
if case_is silo "3 4" "measures.held_rate"; then
    settings 5e-4 1e-3 1.75e-4
fi
if case_is silo_3d "5" "measures.held_rate" --set "phases.drain.until=After(0.6)"; then
    settings 1e-3 1e-3 2e-4
fi
if case_is rotating_drum_2d "7 8" "measures.slope"; then
    settings 5e-4 1e-3 7.5e-5
fi
if case_is rotating_drum_3d "31 32" "measures.slope"; then
    settings 1e-3 1e-3 1.6e-4
fi
if case_is newton_cradle "0" "energy.kinetic"; then
    settings 1e-4 1e-12 1e-3
fi
if case_is painleve_rod "0" "energy.kinetic energy.friction"; then
    settings 1e-4 1e-10 1e-3
fi
if case_is block_tower "0" "statistics.ground_fy:last"; then
    settings 1e-3 1e-10 1e-3
fi
if case_is block_wall "0" "statistics.table_fy:last"; then
    settings 1e-3 1e-6 1e-3
fi
if case_is masonry_arch "0" "statistics.ground_fy:last"; then
    settings 1e-3 1e-8 8e-3
fi

python3 docs/sensitivity.py table "$out"
