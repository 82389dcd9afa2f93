#!/usr/bin/env bash
# bare_debian.sh BUILD: do the packages of BUILD work where nothing else is? In a bare Debian 12, made by debootstrap from the
# archive that this machine's apt uses: the tarball runs before anything is installed; boltzmann is installed by apt with what it
# depends on, and runs copper; python3-boltzmann does, too; bzm build without libboltzmann-dev is one line; with it, a user's program is compiled by bzm build,
# by CMake's find_package and with pkg-config, and leaves the same numbers. Times are printed. Needs root.
# BARE=DIR keeps the bare system in DIR.tar and begins with it next time.
set -euo pipefail
build=$(realpath "${1:?the folder with the packages}")
here=$(dirname "$(realpath "$0")")
limit=15  # seconds from installed to the first picture

fail() { echo "FAILED: $*" >&2; exit 1; }
[ "$(id -u)" = 0 ] || fail "a bare Debian is made by root"
command -v debootstrap >/dev/null || fail "debootstrap is not there (apt install debootstrap)"
program=$(echo "$build"/boltzmann_*.deb) library=$(echo "$build"/libboltzmann-dev_*.deb) python=$(echo "$build"/python3-boltzmann_*.deb) tarball=$(echo "$build"/boltzmann-*.tar.gz)
for file in "$program" "$library" "$python" "$tarball"; do [ -f "$file" ] || fail "there is no $file, or there are several"; done

mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
  awk '$2 == "bookworm" && $3 == "main" { print $1; exit }')
[ -n "$mirror" ] || fail "apt on this machine knows no archive of Debian 12 (bookworm), so there is no bare one to be had"

root=$(mktemp -d "${TMPDIR:-/tmp}/bare-debian-XXXXXX")
clean() {
  umount "$root/proc" 2>/dev/null || true
  rm -rf --one-file-system "$root"
}
trap clean EXIT

now() { date +%s.%N; }
since() { awk -v a="$1" -v b="$(now)" 'BEGIN { printf "%.2f", b - a }'; }
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
user() { inside sh -ec "cd /home/user; $1"; }
has() { [ -s "$root/home/user/$1" ] || fail "$1 was not written"; }

start=$(now)
if [ -n "${BARE:-}" ] && [ -f "$BARE.tar" ]; then
  tar -C "$root" -xf "$BARE.tar"
  echo "a bare Debian from $BARE.tar: $(since "$start") s"
else
  debootstrap --variant=minbase --include=ca-certificates bookworm "$root" "$mirror" > "$build/debootstrap.log" 2>&1 ||
    fail "debootstrap: $(tail -n 1 "$build/debootstrap.log") (all of it is in $build/debootstrap.log)"
  [ -z "${BARE:-}" ] || tar -C "$root" -cf "$BARE.tar" .
  echo "a bare Debian: $(since "$start") s"
fi
# How this machine reaches the archive: proxies and certificates.
for file in /etc/apt/apt.conf /etc/apt/apt.conf.d/*; do
  if [ -f "$file" ] && grep -qi proxy "$file"; then cp "$file" "$root/etc/apt/apt.conf.d/"; fi
done
cp -L /etc/resolv.conf /etc/hosts "$root/etc/" 2>/dev/null || true
if [ -f /etc/ssl/certs/ca-certificates.crt ]; then cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"; fi
mount -t proc proc "$root/proc" || fail "/proc can't be mounted in $root"
mkdir -p "$root/home/user" "$root/packages"
apt_in() { inside ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} apt-get -qq "$@" > "$build/apt.log" 2>&1 ||
  fail "apt-get $*: $(tail -n 1 "$build/apt.log")"; }

# 1. The tarball, where nothing is installed: not even fonts.
tar -C "$root/home/user" -xzf "$tarball"
unpacked=$(basename "$tarball" .tar.gz)
! inside sh -c 'command -v bzm g++' >/dev/null || fail "the bare Debian is not bare"
start=$(now)
user "$unpacked/bin/bzm run copper --out from-tarball --quiet"
echo "tarball: copper to picture.png in $(since "$start") s"
has from-tarball/picture.png
user "$unpacked/bin/bzm --version; $unpacked/bin/bzm list --names scenarios | grep -qx copper"
user "$unpacked/bin/bzm doctor" | tail -n 1 | grep -qx 'all is well' || fail "bzm doctor of the tarball"

# 2. boltzmann with what it depends on.
cp "$program" "$library" "$python" "$root/packages/"
apt_in update
start=$(now)
apt_in install -y --no-install-recommends "/packages/$(basename "$program")"
echo "boltzmann installed in $(since "$start") s"
start=$(now)
user "bzm run copper --quiet"
time=$(since "$start")
has results/copper/picture.png
echo "installed to the first picture: $time s (at most $limit)"
awk -v time="$time" -v limit="$limit" 'BEGIN { exit !(time < limit) }' || fail "the first picture took $time s"
cmp -s "$root/home/user/results/copper/diagnoses.csv" "$root/home/user/from-tarball/diagnoses.csv" || fail "tarball and package have other numbers"
[ "$(user 'bzm --version')" = "$(user "$unpacked/bin/bzm --version")" ] || fail "tarball and package have other versions"
user "bzm doctor" | tail -n 1 | grep -qx 'all is well' || fail "bzm doctor"
listed=$(inside dpkg -L boltzmann)
for file in man/man1/bzm.1.gz bash-completion/completions/bzm zsh/vendor-completions/_bzm fish/vendor_completions.d/bzm.fish \
  boltzmann/gallery/copper.png boltzmann/scenarios/copper.toml doc/boltzmann/copyright; do
  [ -s "$root/usr/share/$file" ] || [ -s "$root/usr/share/${file%.gz}" ] || ! grep -q "/$file" <<< "$listed" ||
    fail "/usr/share/$file is missing"
  grep -q "/usr/share/${file%.gz}" <<< "$listed" || fail "/usr/share/$file is not in the package"
done
user 'bash -c "source /usr/share/bash-completion/completions/bzm; COMP_WORDS=(bzm resu); COMP_CWORD=1; _bzm; echo \${COMPREPLY[@]}"' | grep -qx resume ||
  fail "completion of bash"

# 3. Python finds the package, and its scenarios, and has the numbers of bzm.
start=$(now)
apt_in install -y --no-install-recommends "/packages/$(basename "$python")"
echo "python3-boltzmann installed in $(since "$start") s"
user 'python3 -c "import boltzmann; sim = boltzmann.load(\"copper\"); sim.run(out=\"by-python\")"' || fail "import boltzmann"
cmp -s "$root/home/user/by-python/diagnoses.csv" "$root/home/user/from-tarball/diagnoses.csv" || fail "Python and the tarball have other numbers"
has by-python/picture.png
[ -n "$(find "$root/usr/lib/python3/dist-packages/boltzmann" -name '*.pyc')" ] || fail "no bytecode of python3-boltzmann"

# 4. Without the library, one line that names it.
cp "$here/user.cpp" "$here/CMakeLists.txt" "$root/home/user/"
apt_in install -y --no-install-recommends g++
status=0
user "bzm build user.cpp" > "$build/refused" 2>&1 || status=$?
[ $status = 2 ] && [ "$(wc -l < "$build/refused")" = 1 ] && grep -q 'apt install libboltzmann-dev' "$build/refused" ||
  fail "bzm build without libboltzmann-dev, status $status: $(cat "$build/refused")"

# 5. libboltzmann-dev: three ways to one program.
start=$(now)
apt_in install -y --no-install-recommends "/packages/$(basename "$library")"
echo "libboltzmann-dev installed in $(since "$start") s"
built() {  # NAME PROGRAM
  user "rm -rf results; ./$2 > $1.log 2>&1" || fail "the program of $1: $(tail -n 1 "$root/home/user/$1.log")"
  has results/picture.png
  if [ "$1" = "bzm-build" ]; then
    cp "$root/home/user/results/diagnoses.csv" "$root/home/user/wanted.csv"
  else
    cmp -s "$root/home/user/results/diagnoses.csv" "$root/home/user/wanted.csv" || fail "the program of $1 has other numbers than that of bzm build"
  fi
  echo "$1: compiled in $3 s, runs"
}
start=$(now)
user "bzm build user.cpp -o by-bzm" > "$build/built.log" 2>&1 || fail "bzm build: $(cat "$build/built.log")"
built bzm-build by-bzm "$(since "$start")"
apt_in install -y --no-install-recommends pkg-config
start=$(now)
user 'g++ -O3 -DNDEBUG user.cpp -o by-pkg-config $(pkg-config --cflags --libs boltzmann)' 2> "$build/built.log" || fail "pkg-config: $(cat "$build/built.log")"
built pkg-config by-pkg-config "$(since "$start")"
user 'g++ -O3 -DNDEBUG user.cpp -o by-pkg-config $(pkg-config --define-variable=arch=x86-64-v3 --static --cflags --libs boltzmann)' 2> "$build/built.log" ||
  fail "pkg-config --static: $(cat "$build/built.log")"
apt_in install -y --no-install-recommends cmake make
user 'cmake -S . -B build -DCMAKE_BUILD_TYPE=Release' > "$build/built.log" 2>&1 || fail "find_package: $(cat "$build/built.log")"
start=$(now)
user 'cmake --build build' > "$build/built.log" 2>&1 || fail "find_package: $(cat "$build/built.log")"
built find_package build/user "$(since "$start")"

# 6. And away again.
apt_in remove -y boltzmann libboltzmann-dev python3-boltzmann
! [ -e "$root/usr/bin/bzm" ] && ! [ -e "$root/usr/lib/python3/dist-packages/boltzmann" ] && ! [ -e "$root/usr/include/boltzmann" ] || fail "something stays after apt-get remove"
echo "passed"
