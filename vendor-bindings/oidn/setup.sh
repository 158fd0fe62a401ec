#!/usr/bin/env bash
# Fetches Open Image Denoise 2, where neither OIDN_DIR nor the system has it, from the redistributable that PyPI
# carries, into .oidn/ of the repository. Quick and without effect when it is there. Nothing needs it but denoising.
# --redistributable fetches it, whatever the system has.
set -euo pipefail

# Built for glibc >= 2.17. The wheel's Python modules are not used, nor its modules for graphics processors.
readonly WHEEL=pyoidn-2.5.1.0-py3-none-manylinux2014_x86_64.whl
readonly REQUIREMENT=pyoidn==2.5.1.0
readonly SHA256=32ad13368f8de1ef63001942ad05b02a00cd732d1206d97f352d3a3f606d823e
readonly LIBRARIES=(
  libOpenImageDenoise.so.2
  libOpenImageDenoise_core.so.2.5.1
  libOpenImageDenoise_device_cpu.so.2.5.1
  libtbb.so.12
)

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
readonly root
# shellcheck source=../fetch.sh
source "$root/vendor-bindings/fetch.sh"

system_has_it() {
  [[ -n ${OIDN_DIR:-} ]] || { command -v ldconfig && ldconfig -p | grep "${LIBRARIES[0]} "; } >/dev/null
}
if [[ -e $root/.oidn/lib/${LIBRARIES[0]} ]] || { [[ ${1:-} != --redistributable ]] && system_has_it; }; then
  exit 0
fi

# Beside its destination, so that the last step is one rename.
work=$(mktemp -d "$root/.oidn.XXXXXX.tmp")
trap 'rm -rf "$work"' EXIT
fetch_wheel "Open Image Denoise 2" "$REQUIREMENT" "$WHEEL" "$SHA256" "$work" \
  --platform manylinux2014_x86_64 --retries 1 --timeout 20
# The libraries look for each other in a folder of this name.
mkdir -p "$work/oidn/lib" "$work/oidn/licenses"
for library in "${LIBRARIES[@]}"; do cp "$work/wheel/pyoidn/oidn/lib/$library" "$work/oidn/lib/"; done
cp "$work"/wheel/pyoidn-*.dist-info/licenses/LICENSE "$work/oidn/licenses/pyoidn"
# The wheel lacks the licence of the libraries themselves, which is one of this repository's.
cp "$root/LICENSE-APACHE" "$work/oidn/licenses/OpenImageDenoise-and-oneTBB"
chmod 755 "$work/oidn"
rm -rf "$root/.oidn"
mv "$work/oidn" "$root/.oidn"
