#!/usr/bin/env bash
# tarball.sh BUILD NAME: a folder NAME, and NAME.tar.xz, in BUILD: the program with all shared libraries that it stands on but those
# of the C library, found from its own place. It runs wherever that library is as new as here, without anything installed.
set -euo pipefail
build=${1:?usage: tarball.sh BUILD NAME}
name=${2:?usage: tarball.sh BUILD NAME}
tree=$build/$name
rm -rf "$tree" "$tree.tar.xz" "$tree.stage"
DESTDIR="$tree.stage" cmake --install "$build" --component program >/dev/null
mv "$tree.stage/usr" "$tree"
rm -rf "$tree.stage"
programs=("$tree"/bin/* "$tree"/libexec/hextwist/*)

# What the loader of this machine finds. The C library's parts belong to the machine that the program runs on.
found=$(ldd "${programs[@]}")
if grep 'not found' <<<"$found" >&2; then exit 1; fi
mapfile -t libraries < <(sed -n 's|^\t[^ ]* => \(/[^ ]*\) .*|\1|p' <<<"$found" | sort -u |
  grep -vE '/(ld-linux[^/]*|lib(c|m|dl|rt|pthread|resolv|util|nsl|anl|mvec|nss_[a-z]*|BrokenLocale|thread_db))\.so\.[0-9]+$')
mkdir -p "$tree/lib/hextwist"
cp -Lt "$tree/lib/hextwist" "${libraries[@]}"

strip "${programs[@]}"
for file in "$tree"/lib/hextwist/*; do patchelf --force-rpath --set-rpath '$ORIGIN' "$file"; done
patchelf --force-rpath --set-rpath '$ORIGIN/../lib/hextwist' "$tree"/bin/*
patchelf --force-rpath --set-rpath '$ORIGIN/../../lib/hextwist' "$tree"/libexec/hextwist/*

# Whose work the libraries are, as their packages say.
mkdir -p "$tree/share/doc/hextwist/libraries"
{ dpkg-query -S "${libraries[@]}" $(realpath "${libraries[@]}") 2>/dev/null || true; } | cut -d: -f1 | sort -u |
  while read -r package; do cp -L "/usr/share/doc/$package/copyright" "$tree/share/doc/hextwist/libraries/$package"; done
tar -C "$build" -cJf "$tree.tar.xz" --owner=0 --group=0 --sort=name "$name"
echo "$tree.tar.xz"
