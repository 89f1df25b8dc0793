#!/usr/bin/env bash
# ./test.sh [--nightly] [ctest options]: installs what is missing, builds, and runs every test but the nightly ones, or only
# those. Ends with ctest's own summary, and before it the tests that were skipped.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/cmake/steps.sh"

sections=(build test) filter=(--label-exclude '^nightly$') arguments=("$@")
if [ "${1:-}" = --nightly ]; then
  sections+=(nightly) filter=(--label-regex '^nightly$')
  shift
fi

data=${CANYON_TEST_DATA:-$root/../shared/data}
if [ -n "${CANYON_TEST_DATA:-}" ] && [ ! -d "$data" ]; then fail "CANYON_TEST_DATA: $data is no folder"; fi

mkdir -p "$root/build"
install_packages "${sections[@]}"
build_as_owner "$root/test.sh" "${arguments[@]}"
configure ON
build all

# Passes ctest's output on, but holds its closing lines back until the skipped tests have been counted.
summarize() {
  local line held=() skipped=()
  while IFS= read -r line; do
    if ((${#held[@]})) || [[ $line =~ ^[0-9]+%\ tests\ passed ]]; then
      held+=("$line")
      if [[ $line =~ ^[[:space:]]+[0-9]+\ -\ (.+)\ \(Skipped\) ]]; then skipped+=("${BASH_REMATCH[1]}"); fi
    else
      printf '%s\n' "$line"
    fi
  done
  if ((${#skipped[@]})); then
    local names
    names=$(printf ', %s' "${skipped[@]}")
    printf '%d test%s skipped: %s\n' "${#skipped[@]}" "$( ((${#skipped[@]} == 1)) || echo s)" "${names:2}"
  else
    printf '0 tests skipped\n'
  fi
  if ((${#held[@]})); then printf '%s\n' "${held[@]}"; fi
}

tests="$root/build/release"
status=0
ctest --test-dir "$tests" --output-on-failure --no-tests=error -j2 "${filter[@]}" "$@" | summarize || status=$?

# Where the recordings are, none of the tests that need them may be skipped.
if [ -d "$data" ] && grep -q 'real recordings not found' "$tests/Testing/Temporary/LastTest.log" 2>/dev/null; then
  fail "tests on real recordings were skipped although $data is there"
fi
exit "$status"
