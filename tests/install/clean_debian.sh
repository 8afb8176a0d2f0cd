#!/usr/bin/env bash
# clean_debian.sh FOLDER: do the packages and the tarball in FOLDER work in a Debian that has nothing else? Makes one with debootstrap,
# keeps it as FOLDER/clean, and works in copies. The examples are built there against the packages, and pip installs the Python
# package from the sources, in a virtual environment. Needs root and a network.
set -euo pipefail
folder=$(realpath "${1:?usage: clean_debian.sh FOLDER}")
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
[ "$(id -u)" = 0 ] || { echo "debootstrap needs root" >&2; exit 77; }
command -v debootstrap >/dev/null || { echo "debootstrap is not installed" >&2; exit 77; }

[ -x "$folder/clean/bin/sh" ] || debootstrap --variant=minbase "$suite" "$folder/clean" >"$folder/debootstrap.txt"

# fresh NAME: a copy of the clean system, with the models and the examples.
fresh() {
  root=$folder/root-$1
  rm -rf "$root"
  cp -a "$folder/clean" "$root"
  mkdir "$root/hextwist"
  cp -r "$source/models" "$source/examples" "$root/hextwist"
}
# inside COMMANDS: a shell in the copy. /proc is mounted where nobody else sees it, and gone with the shell.
inside() {
  unshare --mount --propagation private sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" /usr/bin/env -i \
    PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive sh -exc "$1"' "$root" "cd /hextwist; $1"
}
refine='--cad models/bracket.step models/bracket.msh -c "set reading fenced on; refine curve 5; check"'

echo "the tarball, with nothing installed"
fresh tarball
tar -C "$root/opt" -xf "$folder"/hextwist-*-linux-*.tar.xz
inside "mv /opt/hextwist-* /opt/elsewhere
  /opt/elsewhere/bin/hextwist --version
  /opt/elsewhere/bin/hextwist $refine -o /tmp/refined.e
  /opt/elsewhere/bin/hextwist check /tmp/refined.e --cad models/bracket.step"

echo "the packages, one after the other"
fresh packages
mkdir "$root/packages"
cp "$folder"/*.deb "$root/packages"
inside "apt-get -qq update
  apt-get -qq install --no-install-recommends /packages/hextwist_*.deb >/dev/null
  hextwist --version
  hextwist $refine -o /tmp/refined.e
  test -s /usr/share/man/man1/hextwist.1.gz -a -s /usr/share/bash-completion/completions/hextwist"
inside "apt-get -qq install --no-install-recommends /packages/python3-hextwist_*.deb >/dev/null
  cd /tmp && python3 /hextwist/examples/python/convergence.py /hextwist/models/bracket.brep /hextwist/models/bracket.msh /tmp/python.vtu"
inside "apt-get -qq install --no-install-recommends /packages/libhextwist[0-9]*.deb /packages/libhextwist-dev_*.deb g++ cmake ninja-build pkg-config >/dev/null
  for example in minimal c moving_front; do cmake -S examples/\$example -B /tmp/\$example -G Ninja >/dev/null; cmake --build /tmp/\$example; done
  /tmp/minimal/minimal models/bracket.brep models/bracket.msh /tmp/minimal.msh 1 2
  /tmp/c/adapt models/bracket.brep models/bracket.msh /tmp/c.msh
  /tmp/moving_front/moving_front 1 2
  g++ examples/minimal/main.cpp -o /tmp/by_pkg_config \$(pkg-config --cflags --libs hextwist)
  /tmp/by_pkg_config models/bracket.brep models/bracket.msh /tmp/minimal.msh 1 2"
inside "apt-get -qq remove hextwist >/dev/null; ! command -v hextwist"

echo "pip, in a virtual environment, from the sources"
fresh pip
(cd "$source" && git ls-files -z | tar --null --no-recursion -T - -cf -) | tar -xf - -C "$root/hextwist"
inside "apt-get -qq update
  apt-get -qq install --no-install-recommends \$(bash dev packages) >/dev/null
  python3 -m venv --system-site-packages /environment
  /environment/bin/pip --quiet install --no-build-isolation --no-index .
  cd /tmp && /environment/bin/python /hextwist/examples/python/convergence.py /hextwist/models/bracket.brep /hextwist/models/bracket.msh /tmp/python.vtu
  /environment/bin/python -c \"import hextwist; s = hextwist.Session(); s.cmd('set reading fenced on'); s.import_cad('/hextwist/models/bracket.step')\""
rm -rf "$folder"/root-*
echo "all of them work"
