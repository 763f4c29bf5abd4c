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
"$mdbook" build docs --dest-dir "$PWD/target/book"
# Pages link to cases as ../cases: they are next to the book.
mkdir -p target/cases
cp -r cases/. target/cases
echo "open target/book/index.html"
