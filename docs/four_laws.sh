#!/bin/sh
# Four cohesive-damage pairs on the fretting case; prints the table of four_laws.md. Takes about
# five minutes on one core.
# docs/four_laws.sh [FOLDER]
set -e
out=${1:-results/four_laws}
run() {
    cargo run --release --quiet -- run cases/wheel_rail_fretting.ron --out "$out/$3" \
        --set interfaces.third_body.cohesion="$1" --set interfaces.third_body.damage="$2" --verbose > "$out.$3.txt"
}
mkdir -p "$out"
run mac mac mac
run elastic-bond mohr-coulomb-brittle brittle
run elastic-bond linear-softening linear
run elastic-bond exponential-softening exponential
# Bit-identical until the bonds form, at 0.024 s of the case.
for pair in mac brittle linear exponential; do
    awk -F, 'NR > 1 && $2 < 0.0239' "$out/$pair/statistics.csv" | cut -d, -f1-10 | cksum
done
for pair in mac brittle linear exponential; do
    echo "== $pair"
    grep -E "^  (cycle [123] |damage |dissipated)" "$out.$pair.txt"
done
