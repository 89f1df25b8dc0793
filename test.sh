#!/usr/bin/env bash
# ./test.sh [--nightly] [ctest options]: installs what is missing, builds, and runs every test but the nightly ones, or only
# those. Ends with ctest's own summary, and before it the tests that were skipped.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/cmake/steps.sh"

sections=(build test) filter=(--label-exclude '^nightly$' --timeout 900)  # s; one that hangs must not take the others' time
arguments=("$@")
if [ "${1:-}" = --nightly ]; then
  sections+=(nightly) filter=(--label-regex '^nightly$' --timeout 14400)
  shift
fi

data=${CANYON_TEST_DATA:-$root/../shared/data}
if [ -n "${CANYON_TEST_DATA:-}" ] && [ ! -d "$data" ]; then fail "CANYON_TEST_DATA: $data is no folder"; fi

mkdir -p "$root/build"
install_packages "${sections[@]}"
build_as_owner "$root/test.sh" "${arguments[@]}"
configure ON
build all

tests="$root/build/release"
status=0
ctest --test-dir "$tests" --output-on-failure --no-tests=error -j2 "${filter[@]}" "$@" | count_skipped || status=$?

# Where the recordings are, none of the tests that need them may be skipped.
if [ -d "$data" ] && grep -q 'real recordings not found' "$tests/Testing/Temporary/LastTest.log" 2>/dev/null; then
  fail "tests on real recordings were skipped although $data is there"
fi
exit "$status"
