# Functions that the setup scripts of the bindings share; they are sourced, not run.

say() { echo "setup: $*" >&2; }
die() {
  say "$*"
  exit 1
}

# apt_install PACKAGE...: false where that is not possible without asking for a password.
apt_install() {
  command -v apt-get >/dev/null || return 1
  local as_root=()
  if [[ $(id -u) != 0 ]]; then
    sudo -n true 2>/dev/null || return 1
    as_root=(sudo -n)
  fi
  say "installing $*"
  # The lists of a fresh container are empty; of those that fail to load the others may do.
  "${as_root[@]}" apt-get update -qq >&2 || true
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >&2
}

# fetch_wheel NAME REQUIREMENT WHEEL SHA256 FOLDER PIP_OPTION...: unpacks the wheel of a library into FOLDER/wheel.
fetch_wheel() {
  local name=$1 requirement=$2 wheel=$3 sha256=$4 folder=$5
  shift 5
  [[ $(uname -sm) == "Linux x86_64" ]] || die "there is no redistributable $name for $(uname -sm):" \
    "install it, or build it and set the variable that the README names"
  python3 -m pip --version >/dev/null 2>&1 || apt_install python3-pip ||
    die "python3 with pip is needed to fetch $name: install it, or $name"
  say "fetching $requirement"
  # The tags are the wheel's, whatever Python runs pip.
  python3 -m pip download --quiet --no-deps --only-binary=:all: "$@" --dest "$folder" "$requirement" >&2 ||
    die "pip could not fetch $requirement: is the network there?"
  echo "$sha256  $folder/$wheel" | sha256sum --check --status ||
    die "$requirement is not the file that was expected (SHA-256 $sha256)"
  python3 -m zipfile -e "$folder/$wheel" "$folder/wheel"
}
