#!/usr/bin/env bash
# check_format.sh [--fix]: every C++ file is formatted as .clang-format says, by clang-format 14; --fix makes it so.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

formatter=$(command -v clang-format-14 || command -v clang-format || true)
if [ -z "$formatter" ] || ! "$formatter" --version | grep -q 'version 14\.'; then
  echo "check_format: clang-format 14 is needed (package clang-format-14)" >&2
  exit 1
fi

folders=(core scene gnss inertial lidar fusion mission study report apps tests bench python viewer examples)
existing=()
for folder in "${folders[@]}"; do
  if [ -d "$folder" ]; then existing+=("$folder"); fi
done
sources() { find "${existing[@]}" \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z; }

if [ "${1:-}" = --fix ]; then
  sources | xargs -0 -r -n 40 -P 2 "$formatter" -i
  exit
fi
# shellcheck disable=SC2016 # expanded by the inner shell
wrong=$(sources | xargs -0 -r -n 20 -P 2 bash -c 'for f; do "$0" "$f" | cmp -s - "$f" || echo "$f: not formatted"; done' "$formatter")
if [ -n "$wrong" ]; then
  printf '%s\n' "$wrong" | sort
  echo "check_format: run cmake/check_format.sh --fix" >&2
  exit 1
fi
