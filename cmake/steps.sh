# shellcheck shell=bash disable=SC2154 # root is set by the script that sources this
# Steps that run.sh, test.sh and .ci/run share; sourced by them, with $root the repository's top directory.
# Everything said goes to stderr, so that `./run.sh compare --json` leaves nothing but the JSON on stdout.

say() { printf -- '-- %s\n' "$*" >&2; }

# fail MESSAGE [LOG]: what the log says is wrong, else its end; the message; exit status 1.
fail() {
  local log=${2:-}
  if [ -f "$log" ]; then
    { grep -E '^FAILED:|(^|[ :])(fatal )?[eE]rror[ :]|undefined reference' "$log" | cut -c -300 | awk '!seen[$0]++' | head -n 20; } >&2 || true
    printf -- '---- the end of %s ----\n' "$log" >&2
    tail -n 15 "$log" | cut -c -300 >&2
  fi
  printf 'error: %s\n' "$1" >&2
  exit 1
}

# show_progress WHAT LOG: appends its input (of apt-get or ninja) to LOG and tells how far it is: on a terminal one line that
# is drawn over and over, otherwise one line per quarter.
show_progress() {
  local what=$1 log=$2 line done=0 total=0 percent shown=0
  while IFS= read -r line; do
    printf '%s\n' "$line" >>"$log"
    if [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]]; then
      done=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]}
    elif [[ $line =~ ([0-9]+)\ newly\ installed ]]; then
      total=$((3 * BASH_REMATCH[1])) # each package is fetched, unpacked and set up
    elif [[ $line =~ ^(Get:|Unpacking|Setting\ up) ]]; then
      done=$((done + 1))
    else
      continue
    fi
    ((done > 0 && total > 0)) || continue
    percent=$((100 * done / total))
    ((percent <= 100)) || percent=100
    if [ -t 2 ]; then
      printf '\r-- %s: %d %%  ' "$what" "$percent" >&2
      shown=1
    elif ((percent / 25 > shown)); then
      shown=$((percent / 25))
      say "$what: $percent %"
    fi
  done
  if [ -t 2 ] && ((shown)); then printf '\n' >&2; fi
}

# packages SECTION...: the names that cmake/debian-packages.txt lists in these sections.
packages() {
  local section='' line
  while IFS= read -r line; do
    line=${line%%#*}
    line=${line//[[:space:]]/}
    if [[ $line == \[*\] ]]; then
      section=${line:1:-1}
    elif [[ -n $line && " $* " == *" $section "* ]]; then
      printf '%s\n' "$line"
    fi
  done <"$root/cmake/debian-packages.txt"
}

# install_packages SECTION...: installs what is missing; does nothing, at once, when nothing is.
install_packages() {
  local wanted missing=() name as_root=() log="$root/build/packages.log" started=$SECONDS
  mapfile -t wanted < <(packages "$@")
  if ! command -v dpkg-query >/dev/null; then
    say "this is not Debian; the libraries needed are those of cmake/debian-packages.txt: ${wanted[*]}"
    return
  fi
  local present
  present=" $(dpkg-query -W -f '${db:Status-Abbrev}${Package}\n' "${wanted[@]}" 2>/dev/null | sed -n 's/^ii *//p' | tr '\n' ' ' || true)"
  for name in "${wanted[@]}"; do
    [[ $present == *" $name "* ]] || missing+=("$name")
  done
  ((${#missing[@]})) || return 0

  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null ||
      fail "packages are missing; as root: apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  say "installing ${#missing[@]} system packages and what they need (a few minutes): ${missing[*]}"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 apt-get -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0)
  local install=("${apt[@]}" install -y --no-install-recommends "${missing[@]}")
  : >"$log"
  if ! "${install[@]}" 2>&1 </dev/null | show_progress "packages" "$log"; then
    # A fresh system has no package index yet, an old one a stale one; an interrupted installation is finished first.
    say "updating the package index and trying again"
    "${as_root[@]}" dpkg --configure -a >>"$log" 2>&1 || true
    "${apt[@]}" update >>"$log" 2>&1 || true
    "${install[@]}" 2>&1 </dev/null | show_progress "packages" "$log" || fail "the packages could not be installed" "$log"
  fi
  say "packages installed in $((SECONDS - started)) s"
}

# When the whole script was started with sudo in a user's own checkout, the build is the user's, not root's.
build_as_owner() {
  if [ "$(id -u)" = 0 ] && [ "${SUDO_UID:-0}" != 0 ] && [ "$(stat -c %u "$root")" = "$SUDO_UID" ]; then
    chown -R "$SUDO_UID:${SUDO_GID:-$SUDO_UID}" "$root/build"
    exec runuser -u "$SUDO_USER" -- env HOME="$(getent passwd "$SUDO_USER" | cut -d: -f6)" "$@"
  fi
}

# As many compilers as there are processors, but no more than memory allows: the largest joined files take 2.4 GB.
parallelism() {
  local processors fit
  processors=$(nproc)
  fit=$(awk '/MemAvailable/ { print int($2 / 2500000) }' /proc/meminfo 2>/dev/null || true)
  if [ -n "$fit" ] && ((fit < processors)); then processors=$fit; fi
  ((processors > 0)) && echo "$processors" || echo 1
}

# configure ON|OFF [PRESET [CMake options]]: prepares build/PRESET (release), with or without the tests. A tree that is already
# prepared, and has the tests if they are asked for, is left as it is; ninja itself configures again when a CMake file changes.
configure() {
  local tests=$1 preset=${2:-release}
  local folder="$root/build/$preset"
  if [ -f "$folder/build.ninja" ]; then
    [ "$tests" = OFF ] && return
    grep -q '^CANYON_TESTS:BOOL=ON$' "$folder/CMakeCache.txt" && return
  fi
  mkdir -p "$folder"
  say "configuring build/$preset"
  (cd "$root" && cmake --preset "$preset" -DCANYON_TESTS="$tests" "${@:3}") >"$folder/configure.log" 2>&1 ||
    fail "the build could not be configured" "$folder/configure.log"
}

# build TARGET[,TARGET...] [PRESET]: says nothing when there is nothing to do.
build() {
  local preset=${2:-release} started=$SECONDS targets what=building
  local log="$root/build/$preset/build.log"
  IFS=, read -ra targets <<<"$1"
  [ "$preset" = release ] || what="building $preset"
  : >"$log"
  cmake --build "$root/build/$preset" --target "${targets[@]}" -- -j"$(parallelism)" 2>&1 | show_progress "$what" "$log" ||
    fail "the build failed" "$log"
  if ! grep -q 'no work to do' "$log"; then say "built in $((SECONDS - started)) s"; fi
}

# test_preset PRESET [ctest options]: the tests of that build, but the nightly ones.
test_preset() {
  ctest --test-dir "$root/build/$1" --output-on-failure --no-tests=error -j2 --label-exclude '^nightly$' "${@:2}" ||
    fail "tests of build/$1 failed"
}

# clang with the address and undefined-behaviour sanitizers, and its warnings, which are errors: core, which every reader of
# files stands on, and its tests. With `all`, everything, and every test but the nightly ones; damaged files of all formats, whose
# verbs need the whole program, among them.
run_sanitized() {
  local started=$SECONDS
  configure ON asan
  if [ "${1:-}" = all ]; then
    build all asan
    test_preset asan
  else
    build canyon_core_tests asan
    test_preset asan --label-regex '^core$'
  fi
  say "sanitized tests passed after $((SECONDS - started)) s"
}

# Everything built with clang as it is for use, and tested.
run_clang() {
  local started=$SECONDS
  configure ON clang
  build all clang
  test_preset clang
  say "clang's tests passed after $((SECONDS - started)) s"
}

# count_skipped: passes ctest's output on, but holds its closing lines back until the skipped tests have been counted and named.
count_skipped() {
  local line held=() skipped=()
  while IFS= read -r line; do
    if ((${#held[@]})) || [[ $line =~ ^[0-9]+%\ tests\ passed ]]; then
      held+=("$line")
      if [[ $line =~ ^[[:space:]]+[0-9]+\ -\ (.+)\ \(Skipped\) ]]; then skipped+=("${BASH_REMATCH[1]}"); fi
    else
      printf '%s\n' "$line"
    fi
  done
  case ${#skipped[@]} in
    0) printf '0 tests skipped\n' ;;
    1) printf '1 test skipped: %s\n' "${skipped[0]}" ;;
    *) printf '%d tests skipped: %s\n' "${#skipped[@]}" "$(printf '%s, ' "${skipped[@]}" | sed 's/, $//')" ;;
  esac
  if ((${#held[@]})); then printf '%s\n' "${held[@]}"; fi
}
