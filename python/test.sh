#!/usr/bin/env bash
# Builds the wheel as `pip install .` does, installs it with its test extras into a clean virtual
# environment, and tests it there: tests, examples in docstrings, and types. Words after it are for
# pytest: python/test.sh -k results
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python="${PYTHON:-python3}"

if ! "$python" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 10))' 2>/dev/null; then
    echo "test.sh needs Python 3.10 or later with venv; name another one by PYTHON=..." >&2
    exit 1
fi

work=$(mktemp -d "${TMPDIR:-/tmp}/fretwork-python.XXXXXX")
trap 'rm -rf "$work"' EXIT
# What the workspace has built is not built again.
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$here/../target}"
export CARGO_BUILD_JOBS="${CARGO_BUILD_JOBS:-2}"
# The program, if it is built: a test compares what both write.
program="$CARGO_TARGET_DIR/release/fretwork"
if [ -z "${FRETWORK_PROGRAM:-}" ] && [ -x "$program" ]; then
    export FRETWORK_PROGRAM="$program"
fi

echo "==> pip wheel"
"$python" -m venv "$work/venv"
pip="$work/venv/bin/python -m pip --disable-pip-version-check --quiet"
$pip wheel --no-deps --wheel-dir "$work/wheels" "$here"
wheel=$(echo "$work"/wheels/pyfretwork-*.whl)
echo "$(basename "$wheel"), $(du -h "$wheel" | cut -f1)"

echo "==> pip install $(basename "$wheel")[test]"
$pip install "$wheel[test]"

# Not in the folder of the sources: the package that is tested is the installed one.
cd "$work"
ln -s "$here/../cases" "$here/../materials" "$here/../patches" .
package=$("$work/venv/bin/python" -c 'import fretwork, pathlib; print(pathlib.Path(fretwork.__file__).parent)')
case "$package" in
    "$work"/*) ;;
    *) echo "test.sh: the package is imported from $package" >&2; exit 1 ;;
esac
echo "==> examples in docstrings"
"$work/venv/bin/python" -m pytest -q -p no:cacheprovider --doctest-modules "$package"
echo "==> mypy"
"$work/venv/bin/python" -m mypy --config-file "$here/pyproject.toml" --cache-dir "$work/mypy" -p fretwork
"$work/venv/bin/python" -m mypy --config-file "$here/pyproject.toml" --cache-dir "$work/mypy" "$here/tests/typed.py"
# The stub says what the compiled part has.
"$work/venv/bin/python" -m mypy.stubtest --mypy-config-file "$here/pyproject.toml" fretwork._fretwork
echo "==> tests"
"$work/venv/bin/python" -m pytest -q -p no:cacheprovider --rootdir "$here" -c "$here/pyproject.toml" "$here/tests" "$@"
