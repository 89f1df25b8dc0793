#!/usr/bin/env bash
# ./run.sh [verb and options]: installs what is missing, builds, and runs canyon; without a verb `canyon compare`, which
# drives the built-in mission low against high and says where the report is. Safe to repeat: a second call starts at once.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/cmake/steps.sh"

mkdir -p "$root/build"
install_packages build
build_as_owner "$root/run.sh" "$@"
configure OFF
build canyon

case ${1:-} in
  -h | --help | --version) ;;
  '' | -*) set -- compare "$@" ;;
esac
exec "$root/build/release/bin/canyon" "$@"
