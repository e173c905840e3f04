# SPDX-License-Identifier: Apache-2.0
# What the findings share: a temporary folder that is the working directory and goes away at the end, pinned packages
# unpacked into it (nothing is installed into the system), and the comparison of what was seen with what is stated.
set -euo pipefail

work=$(mktemp -d)
end() {
  for process in $(jobs -p); do kill "$process" 2> /dev/null || true; done
  rm -rf "$work"
}
trap end EXIT
cd "$work"
root=$work/root
libraries=$root/usr/lib/x86_64-linux-gnu:$root/usr/lib
for folder in blas lapack pulseaudio; do libraries+=:$root/usr/lib/x86_64-linux-gnu/$folder; done

unpack() {
  mkdir -p "$root"
  for package in "$1"/*.deb; do dpkg-deb -x "$package" "$root"; done
}

known_packages() { apt-cache show "$1" > /dev/null 2>&1 || apt-get -qq update; }

# debian_programs PACKAGE=VERSION...: with what they depend on and this machine lacks.
debian_programs() {
  known_packages "$1"
  mkdir -p programs/partial
  apt-get -qq -y install --download-only --reinstall --no-install-recommends --allow-downgrades \
    -o Debug::NoLocking=1 -o APT::Sandbox::User=root -o Dir::Cache::archives="$work/programs" "$@" > apt.log 2>&1 ||
    { cat apt.log >&2; exit 1; }
  unpack programs
}

# debian_files PACKAGE=VERSION...: just these, as headers need no more.
debian_files() {
  known_packages "$1"
  mkdir -p files
  (cd files && apt-get -qq download -o APT::Sandbox::User=root "$@")
  unpack files
}

npm_packages() { npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$work" "$@" > /dev/null; }

# compiled SOURCE [FLAGS...]: makes ./run of a C++ program that runs against what was unpacked.
compiled() {
  g++ -std=c++17 -w -isystem "$root/usr/include" "$1" -L"$root/usr/lib/x86_64-linux-gnu" -L"$root/usr/lib" \
    -Wl,-rpath-link,"$libraries" "${@:2}" -o run
}

with_libraries() { LD_LIBRARY_PATH=$libraries "$@"; }

# stated WHAT EXPECTED SEEN
stated() {
  printf '%s: %s\n' "$1" "$3"
  [[ $3 == "$2" ]] && return
  printf 'not as stated here: %s\n' "$2" >&2
  exit 1
}
