#!/bin/sh
# Accuracy against cost of shipped cases; the tables of frontiers.md. Takes an hour or more; with
# names of cases only these are run. Each study is stored in OUT (results/frontiers) and continues
# where it stopped.
# BUDGET: limit of the wall time of a study (60m).
# docs/dev/frontiers.sh [CASE...]
set -e
out=${OUT:-results/frontiers}
program=${FRETWORK:-cargo run --release --quiet --}
study() {
    name=$1
    shift
    if [ -n "$wanted" ] && ! echo " $wanted " | grep -q " $name "; then return; fi
    mkdir -p "$out"
    echo "== $name"
    $program trade "cases/$name.ron" --out "$out/$name" --budget "${BUDGET:-60m}" "$@" | tee "$out/$name.txt"
}
wanted="$*"
study collapse --seeds 10 --vary time.step=1.25e-4,2.5e-4,5e-4,1e-3 --vary solver.tolerance=5e-5,5e-4,5e-3 --output energy.friction=2%
study regime_map --seeds 10 --vary time.step=5e-5,1e-4,2e-4,4e-4 --vary solver.tolerance=1e-4,1e-3,1e-2 --output friction_coefficient=5%
study shear_cell_3d --seeds 10 --vary time.step=5e-5,1e-4,2e-4 --vary solver.tolerance=1e-5,1e-4,1e-3 --output friction_coefficient=5%
study plane_shear --seeds 10 --vary time.step=1e-4,2e-4,4e-4 --vary solver.tolerance=1e-4,1e-3,1e-2 \
    --output measures.bulk_mu=3% --output measures.bulk_phi=1%
study silo --seeds 10 --vary time.step=2.5e-4,5e-4,1e-3 --vary solver.tolerance=1e-4,1e-3,1e-2 --output measures.held_rate=5%
study wheel_rail_rolling --vary time.step=1e-5,2e-5,4e-5 --output friction_coefficient=5% --seeds 5
study voronoi_block --vary time.step=1e-6,2e-6,4e-6 --vary solver.tolerance=1e-5,1e-4,1e-3 --output statistics.wall_fx:max=2%
study cohesive_shear --vary time.step=1e-4,2e-4,4e-4 --vary solver.tolerance=1e-4,1e-3,1e-2 --output measures.bulk_mu=3%
study forced_fold --vary time.step=2.5e-4,5e-4,1e-3 --vary solver.tolerance=1e-4,1e-3,1e-2 --output damage_ratio=5%
study rotating_drum_2d --vary time.step=2.5e-4,5e-4,1e-3 --vary solver.tolerance=1e-4,1e-3,1e-2 --output measures.slope=3%
study wheel_rail_degradable --vary time.step=2.5e-5,5e-5,1e-4,2e-4 --vary solver.tolerance=1e-4,1e-3 \
    --output friction_coefficient=5% --output damage_ratio=5%
study silo_3d --vary time.step=5e-4,1e-3,2e-3 --vary solver.tolerance=1e-4,1e-3,1e-2 --output measures.held_rate=5%
study rotating_drum_3d --vary time.step=5e-4,1e-3,2e-3 --vary solver.tolerance=1e-4,1e-3,1e-2 --output measures.slope=3%
study fault_propagation --vary time.step=2.5e-4,5e-4,1e-3 --vary solver.tolerance=1e-4,1e-3,1e-2 --output damage_ratio=5%
study voronoi_block_3d --vary time.step=1e-6,2e-6,4e-6 --vary solver.tolerance=1e-5,1e-4,1e-3 --output statistics.left_fx:max=2%
study fretting_scar --vary time.step=5e-5,1e-4,2e-4 --vary solver.tolerance=1e-8,1e-6,1e-4 --output scars.0.depth=2%
study punch_scar --seeds 10 --vary time.step=1.25e-5,2.5e-5,5e-5,1e-4,2e-4 --vary solver.tolerance=1e-8,1e-6,1e-4 --output scars.0.middle=5%
study fretting_wear_jump --vary time.step=2.5e-4,5e-4,1e-3 --vary solver.tolerance=1e-6,1e-5,1e-4 --output scars.0.depth=4%
study biaxial --vary time.step=2e-4,4e-4,8e-4 --vary solver.tolerance=5e-5,5e-4,5e-3 --output biaxial.peak_ratio=5%
study third_body_steady --vary time.step=5e-6,1e-5,2e-5 --vary solver.tolerance=5e-3,5e-2,0.5 --output friction_coefficient=5%
