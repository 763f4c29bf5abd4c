#!/usr/bin/env bash
# Builds the documentation as a searchable book: target/book/index.html. Installs mdBook into
# target/tools the first time.
set -eu
cd "$(dirname "$0")/.."
mdbook=$(command -v mdbook || true)
if [ -z "$mdbook" ]; then
    mdbook=target/tools/bin/mdbook
    if [ ! -x "$mdbook" ]; then
        cargo install mdbook --version 0.5.4 --locked --root target/tools --no-default-features --features search
    fi
fi
book="$PWD/target/book"
rm -rf "$book"
"$mdbook" build docs --dest-dir "$book/docs"
# Pages link to files of the project, such as ../cases/silo.ron: they stand beside the pages.
for folder in cases examples fits patches studies tests/engines; do
    mkdir -p "$book/$folder"
    cp -r "$folder/." "$book/$folder"
done
# mdBook makes every link to a file .md one to .html, also to those that are not in the book.
find "$book" -path "$book/docs" -prune -o -name "*.md" -print | while read -r page; do
    {
        echo '<!doctype html><meta charset="utf-8"><pre style="white-space: pre-wrap">'
        sed 's/&/\&amp;/g; s/</\&lt;/g' "$page"
    } >"${page%.md}.html"
done
echo '<!doctype html><meta http-equiv="refresh" content="0; url=docs/index.html">' >"$book/index.html"
echo "open target/book/index.html"
