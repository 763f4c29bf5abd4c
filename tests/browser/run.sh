#!/usr/bin/env bash
# Opens reports in a headless Chromium and uses them: tests/browser/check.mjs; the extension of an
# editor: tests/browser/vscode.mjs. Needs chromium, node
# and the npm package playwright-core; installs what is missing where it may (root and apt-get),
# else says that it is skipped. Screenshots are left in target/browser.
set -eu
cd "$(dirname "$0")/../.."
place=target/browser
mkdir -p "$place"

may=no
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then may=yes; fi
find_chromium() { command -v chromium || command -v chromium-browser || command -v google-chrome || true; }
if [ "$may" = yes ]; then
    if [ -z "$(find_chromium)" ]; then
        { apt-get update -qq && apt-get install -y -qq --no-install-recommends chromium fonts-dejavu-core; } >"$place/apt.log" 2>&1 || true
    fi
    if ! command -v npm >/dev/null; then
        { apt-get update -qq && apt-get install -y -qq --no-install-recommends nodejs npm; } >>"$place/apt.log" 2>&1 || true
    fi
fi
chromium=$(find_chromium)
if [ -z "$chromium" ] || ! command -v node >/dev/null; then
    echo "tests/browser: skipped, there is no chromium or no node (Debian: apt-get install chromium nodejs npm)"
    exit 0
fi
if [ ! -d "$place/node_modules/playwright-core" ]; then
    if ! npm install --prefix "$place" --no-audit --no-fund --silent playwright-core@1.65.1 >"$place/npm.log" 2>&1; then
        echo "tests/browser: skipped, npm cannot install playwright-core (see $place/npm.log)"
        exit 0
    fi
fi

fretwork=${FRETWORK:-target/release/fretwork}
[ -x "$fretwork" ] || cargo build --release --quiet
node tests/browser/vscode.mjs "$fretwork"

runs="$place/runs"
rm -rf "$runs"
mkdir -p "$runs"
run() {
    local name=$1 case=$2
    shift 2
    "$fretwork" run "$case" --out "$runs/$name" "$@" >"$runs/$name.log" 2>&1 || { cat "$runs/$name.log"; exit 1; }
}
# Grains with bonds in the plane; grains in space, balls and polyhedra; a body that deforms; a run
# that was killed.
run bonded tests/program/report/bonded.ron
run again tests/program/report/bonded.ron --set interfaces.layer.parameters.contact.mu=0.2
run solid cases/verification/voronoi_plate_3d.ron
run balls cases/verification/shear_3d.ron
run rubber cases/verification/rubber_block.ron
# Killed once it has recorded states.
"$fretwork" run tests/program/report/bonded.ron --out "$runs/killed" --set time.end=600 --set output.views=60000 --no-report >"$runs/killed.log" 2>&1 &
process=$!
waited=0
until [ "$(stat -c %s "$runs/killed/results.h5" 2>/dev/null || echo 0)" -gt 300000 ] || [ $waited -gt 120 ]; do
    sleep 1
    waited=$((waited + 1))
done
sleep 3
kill -9 $process
wait $process 2>/dev/null || true
"$fretwork" report "$runs/killed" >>"$runs/killed.log"
"$fretwork" compare "$runs/bonded" "$runs/again" "$runs/killed" --out "$runs/compare.html" >/dev/null

CHROMIUM="$chromium" node tests/browser/check.mjs "$place" "$@"
