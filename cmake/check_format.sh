#!/usr/bin/env bash
# check_format.sh [--fix]: every C++ file is formatted as .clang-format says, by clang-format 14; --fix makes it so.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

formatter=$(command -v clang-format-14 || command -v clang-format || true)
if [ -z "$formatter" ] || ! "$formatter" --version | grep -q 'version 14\.'; then
  echo "check_format: clang-format 14 is needed (package clang-format-14)" >&2
  exit 1
fi
mode=(--dry-run --Werror)
if [ "${1:-}" = --fix ]; then mode=(-i); fi

folders=(core scene gnss inertial lidar fusion mission study report apps tests bench python viewer examples)
existing=()
for folder in "${folders[@]}"; do
  if [ -d "$folder" ]; then existing+=("$folder"); fi
done
find "${existing[@]}" \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z | xargs -0 -r -n 40 -P 2 "$formatter" "${mode[@]}" || {
  echo "check_format: run cmake/check_format.sh --fix" >&2
  exit 1
}
