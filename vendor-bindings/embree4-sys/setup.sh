#!/usr/bin/env bash
# Makes a build possible: a C++ compiler, and Embree 4.3 or later from the system or, where there is
# none, from the redistributable that PyPI carries, unpacked into .embree/ of the repository.
# Quick and without effect when everything is there. --redistributable fetches that, whatever the system has.
set -euo pipefail

# Built for glibc >= 2.27. The wheel's Python modules are not used, only its two shared libraries.
readonly WHEEL=embreex-4.4.0.post1-cp311-cp311-manylinux_2_27_x86_64.manylinux_2_28_x86_64.whl
readonly REQUIREMENT=embreex==4.4.0.post1
readonly SHA256=2cd0f7d5c6342e6247e31f700761689cae7829454d8c6de0c41e62124a023e1f

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
readonly root

# shellcheck source=../fetch.sh
source "$root/vendor-bindings/fetch.sh"

# The build script is the one judge of where Embree is. True if it finds one.
embree_is_found() {
  local output
  output=$(cd "$root" && cargo build --quiet --locked -p embree4-sys 2>&1) && return 0
  [[ $output == *"no Embree 4 found"* ]] || die "$output"
  return 1
}

# Debian 13, Ubuntu 24.04 and later.
install_system_embree() {
  command -v apt-cache >/dev/null || return 1
  local candidate
  candidate=$(apt-cache policy libembree-dev 2>/dev/null | awk '$1 == "Candidate:" { print $2 }')
  [[ -n $candidate && $candidate != "(none)" ]] || return 1
  dpkg --compare-versions "$candidate" ge 4.3 && dpkg --compare-versions "$candidate" lt 5 || return 1
  apt_install libembree-dev
}

fetch_redistributable() {
  # Beside its destination, so that the last step is one rename.
  work=$(mktemp -d "$root/.embree.XXXXXX.tmp")
  trap 'rm -rf "$work"' EXIT
  fetch_wheel "Embree 4.3 or later" "$REQUIREMENT" "$WHEEL" "$SHA256" "$work" \
    --platform manylinux_2_28_x86_64 --implementation cp --python-version 3.11 --abi cp311
  cp "$work"/wheel/embreex-*.dist-info/licenses/* "$work/wheel/embreex.libs/"
  chmod 755 "$work/wheel/embreex.libs"
  rm -rf "$root/.embree"
  mv "$work/wheel/embreex.libs" "$root/.embree"
}

command -v cargo >/dev/null || die "cargo is missing: install Rust from https://rustup.rs"
# Rust links with cc; the crate that compares images has a C++ source.
if ! command -v cc >/dev/null || ! command -v c++ >/dev/null; then
  apt_install g++ libc6-dev || die "a C++ compiler is needed: install g++"
fi
if [[ ${1:-} == --redistributable ]]; then
  [[ -d $root/.embree ]] || fetch_redistributable
  exit 0
fi
if ! embree_is_found; then
  install_system_embree || fetch_redistributable
  embree_is_found || die "Embree was installed, but the build does not find it"
fi
