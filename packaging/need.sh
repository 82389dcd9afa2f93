#!/bin/sh
# need.sh PACKAGE[=SHOWN]...: installs the Debian packages that are missing, but for those whose SHOWN (a command or a file)
# is there. Without root and without a sudo that asks for nothing it prints the line that installs them; the status is 1.
# Where there is no dpkg it does nothing, and the configuration says what is missing.
set -eu
command -v dpkg-query >/dev/null || exit 0
missing=
for word in "$@"; do
  package=${word%%=*} shown=${word#*=}
  if [ "$shown" != "$word" ] && { [ -e "$shown" ] || command -v "$shown" >/dev/null; }; then continue; fi
  dpkg-query -W -f='${Status}\n' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
[ -n "$missing" ] || exit 0
sudo=
if [ "$(id -u)" != 0 ]; then
  if command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
    sudo='sudo -n'
  else
    echo "sudo apt-get install -y --no-install-recommends$missing" >&2
    exit 1
  fi
fi
echo "installing$missing"
$sudo apt-get update -qq
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing
