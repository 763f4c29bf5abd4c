#!/bin/sh
# Compares the time of steps of this tree with that of another revision, by the bench `stages`.
#
#   benches/before_after.sh REV [PAIRS [ARGUMENTS OF THE BENCH]]
#   benches/before_after.sh main 7 fretting --threads 1 2
#
# Builds the bench of REV in a worktree (target/before_after/tree, kept for the next time; the first
# build takes minutes) and runs it and that of this tree in turn, PAIRS times (5), the order
# changing each time. Prints for each stage the ratio of times, this tree over REV: the median of
# the pairs, the least and the largest; "cpu" is processor time.
set -eu
cd "$(dirname "$0")/.."
[ $# -ge 1 ] || { sed -n '2,9s/^# \{0,1\}//p' "$0"; exit 2; }
rev=$(git rev-parse --verify "$1^{commit}")
pairs=${2:-5}
shift
[ $# -eq 0 ] || shift

out=$PWD/target/before_after
tree=$out/tree
mkdir -p "$out"
if [ -d "$tree" ]; then
    git -C "$tree" checkout --quiet --force --detach "$rev"
else
    git worktree add --quiet --detach "$tree" "$rev"
fi
# This bench times both, also a revision that did not have it.
cp -r benches/stages.rs benches/support "$tree/benches/"
grep -q 'name = "stages"' "$tree/Cargo.toml" ||
    printf '\n[[bench]]\nname = "stages"\nharness = false\n' >>"$tree/Cargo.toml"

build() { # folder -> path of its bench
    (cd "$1" && CARGO_TARGET_DIR="$1/target" cargo bench --bench stages --no-run 2>&1 | tee /dev/stderr) |
        sed -n 's|.*(\(.*/stages-[0-9a-f]*\))|\1|p' | sed "s|^target|$1/target|"
}
after=$(build "$PWD")
before=$(build "$tree")
[ -x "$after" ] && [ -x "$before" ] || { echo "a bench was not built" >&2; exit 1; }

: >"$out/before.txt"
: >"$out/after.txt"
i=0
while [ $i -lt "$pairs" ]; do
    if [ $((i % 2)) -eq 0 ]; then order="before after"; else order="after before"; fi
    for which in $order; do
        if [ "$which" = before ]; then bench=$before; else bench=$after; fi
        "$bench" "$@" | sed 1d >>"$out/$which.txt"
    done
    i=$((i + 1))
    echo "pair $i of $pairs" >&2
done

# Columns of the bench: stage threads steps contacts sweeps step cpu detect laws solve rest
awk -v pairs="$pairs" '
    function sorted(n,  i, j, t) {
        for (i = 2; i <= n; i++) for (j = i; j > 1 && r[j - 1] > r[j]; j--) { t = r[j]; r[j] = r[j - 1]; r[j - 1] = t }
    }
    function middle(n) { sorted(n); return n % 2 ? r[(n + 1) / 2] : (r[n / 2] + r[n / 2 + 1]) / 2 }
    function ratio(k, column,  i, n) {
        n = 0
        for (i = 1; i <= pairs; i++) if (old[k, i, column] > 0) r[++n] = new[k, i, column] / old[k, i, column]
        return n ? middle(n) : 0
    }
    function time(of, k, column,  i, n) {
        n = 0
        for (i = 1; i <= pairs; i++) r[++n] = of == "old" ? old[k, i, column] : new[k, i, column]
        return middle(n)
    }
    {
        k = $1 " " $2
        if (FNR == NR) { i = ++a[k]; if (i == 1) order[++keys] = k; for (c = 4; c <= NF; c++) old[k, i, c] = $c }
        else { i = ++b[k]; for (c = 4; c <= NF; c++) new[k, i, c] = $c }
    }
    END {
        printf "%-20s %7s %9s %9s %9s %9s  %-20s %-20s %6s %6s %6s %6s\n", "stage", "threads", "sweeps", "sweeps", "step-ms", "step-ms",
            "cpu (min, max)", "step (min, max)", "detect", "laws", "solve", "rest"
        for (n = 1; n <= keys; n++) {
            k = order[n]; split(k, part, " ")
            printf "%-20s %7s %9.1f %9.1f %9.3f %9.3f", part[1], part[2], old[k, 1, 5], new[k, 1, 5], time("old", k, 6), time("new", k, 6)
            for (c = 7; c >= 6; c--) { m = ratio(k, c); printf "  %.3f (%.3f, %.3f)", m, r[1], r[pairs] }
            for (c = 8; c <= 11; c++) printf " %6.2f", ratio(k, c)
            print ""
        }
    }' "$out/before.txt" "$out/after.txt"
