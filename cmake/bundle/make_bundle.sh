#!/usr/bin/env bash
# make_bundle.sh BUILD FOLDER VERSION: lays out in FOLDER (made anew) the program of BUILD, its libraries,
# the OpenCL loader and PoCL with a linker, so that it runs on any x86-64 Linux as it is.
#
#   bin/weft          the launcher (launcher.c)
#   libexec/          the programs themselves; `ld` for PoCL, which links what it compiles
#   lib/              libraries; lib/glibc and lib/gcc for machines without, or with older ones
#   share/            PoCL's built-in functions, scenes, a font
#   licenses/         of everything above
set -euo pipefail

build=$1 folder=$2 version=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$here/../..
multiarch=/usr/lib/x86_64-linux-gnu

die() { printf 'bundle: error: %s\n' "$*" >&2; exit 1; }

# What is linked to and never called (unused_library.sh says why).
unused="libcurl.so.4 libcrypto.so.3 libxml2.so.2 libz3.so.4 libedit.so.2
        libbrotlidec.so.1 libzstd.so.1 libjansson.so.4
        libX11.so.6 libXext.so.6 libXrender.so.1 libxcb.so.1 libxcb-shm.so.0 libxcb-render.so.0"
glibc="ld-linux-x86-64.so.2 libc.so.6 libm.so.6 libpthread.so.0 libdl.so.2 librt.so.1"
gcc="libstdc++.so.6 libgcc_s.so.1"
# PoCL's built-in functions come once per family of processors, 9 MB each. This one serves all that have
# AVX2; on older ones the launcher leaves PoCL out.
kernel_library=kernel-x86_64-pc-linux-gnu
family=avx2
same_family=avx512

is_in() { case " $(echo $2) " in *" $1 "*) return 0 ;; *) return 1 ;; esac; }
needs() { patchelf --print-needed "$1"; }

library_file() {  # SONAME: where the loader finds it
  local file
  file=$(ldconfig -p | awk -v name="$1" '$1 == name && /x86-64/ { print $NF; exit }')
  [ -n "$file" ] || die "$1 is not installed"
  readlink -f "$file"
}

original() {  # FILE: kept to say whose licence it is
  printf '%s\n' "$1" >>"$folder/originals"
}

place() {  # FILE TARGET
  install -D -m 755 "$1" "$folder/$2"
  original "$1"
}

place_library() {  # SONAME FOLDER
  local file
  file=$(library_file "$1")
  place "$file" "$2/$1"
}

place_programs() {
  mkdir -p "$folder/bin" "$folder/libexec"
  install -m 755 "$build/bin/weft" "$folder/libexec/weft.bin"
  strip "$folder/libexec/weft.bin"
  place "$(readlink -f /usr/bin/ld)" libexec/ld.bin
  cc -std=gnu11 -Os -Wall -Wextra -Werror -static -s -DBUNDLED_GLIBC_MINOR="$(glibc_minor)" \
    -o "$folder/bin/weft" "$here/launcher.c"
  ln "$folder/bin/weft" "$folder/libexec/ld"
}

glibc_minor() { getconf GNU_LIBC_VERSION | sed 's/.*\.//'; }

# It looks for its drivers in the folder pocl/ beside it, and for its functions in ../../share/pocl.
place_pocl() {
  place_library libpocl.so.2 lib/pocl
  local driver
  for driver in basic pthread; do
    place "$multiarch/pocl/libpocl-devices-$driver.so" "lib/pocl/pocl/libpocl-devices-$driver.so"
  done
  mkdir -p "$folder/share/pocl"
  cp -r /usr/share/pocl/include "$folder/share/pocl/"
  cp "/usr/share/pocl/$kernel_library-$family.bc" "$folder/share/pocl/"
  ln -s "$kernel_library-$family.bc" "$folder/share/pocl/$kernel_library-$same_family.bc"
}

# Everything that anything placed so far needs, until nothing is missing.
place_libraries() {
  local name missing=yes
  while [ -n "$missing" ]; do
    missing=""
    for name in $(programs_and_libraries | while read -r file; do needs "$file"; done | sort -u); do
      is_in "$name" "$unused $glibc $gcc" && continue
      [ -z "$(find "$folder/lib" -name "$name")" ] || continue
      place_library "$name" lib
      missing=yes
    done
  done
  for name in $glibc; do place_library "$name" lib/glibc; done
  for name in $gcc; do place_versioned "$name" lib/gcc; done
}

# The launcher compares versions by the link's target.
place_versioned() {  # SONAME FOLDER
  local file
  file=$(library_file "$1")
  place "$file" "$2/$(basename "$file")"
  [ "$(basename "$file")" = "$1" ] || ln -s "$(basename "$file")" "$folder/$2/$1"
}

programs_and_libraries() {
  find "$folder/libexec" -name '*.bin'
  find "$folder/lib" -path "$folder/lib/glibc" -prune -o -path "$folder/lib/gcc" -prune -o -name '*.so*' -type f -print
}

# Under names of their own, so that a driver of the machine gets the real library.
replace_unused() {
  local name users file stand_in
  for name in $unused; do
    users=$(programs_and_libraries | while read -r file; do
      if needs "$file" | grep -qxF "$name"; then printf '%s\n' "$file"; fi
    done)
    [ -n "$users" ] || continue
    stand_in=libunused-${name#lib}
    "$here/unused_library.sh" "$(library_file "$name")" "$folder/lib/$stand_in" $users
    for file in $users; do patchelf --replace-needed "$name" "$stand_in" "$file"; done
  done
}

# Our libraries find each other beside themselves.
set_search_paths() {
  local file
  programs_and_libraries | while read -r file; do
    case $file in
      */libexec/*) patchelf --set-rpath '$ORIGIN/../lib' "$file" ;;
      */lib/pocl/pocl/*) patchelf --set-rpath '$ORIGIN:$ORIGIN/..:$ORIGIN/../..' "$file" ;;
      */lib/pocl/*) patchelf --set-rpath '$ORIGIN/..' "$file" ;;
      *) patchelf --set-rpath '$ORIGIN' "$file" ;;
    esac
  done
}

# LLVM is compiled without exceptions, and nothing unwinds through it: what its tables for that hold is 3 MB
# of the archive. So are the old hash tables of its symbols, beside which the loader takes the GNU ones.
blank_unused_sections() {
  local file name offset size
  for file in "$folder"/lib/libLLVM-*.so* "$folder"/lib/libclang-cpp.so*; do
    readelf --sections --wide "$file" | sed -n 's/^ *\[ *[0-9]*\] *//p' |
      while read -r name _ _ offset size _; do
        is_in "$name" ".eh_frame .eh_frame_hdr .hash" || continue
        dd if=/dev/zero of="$file" bs=64K oflag=seek_bytes seek=$((0x$offset)) iflag=count_bytes count=$((0x$size)) \
          conv=notrunc status=none
      done
  done
}

# What `-lm -lc -lgcc -lgcc_s` mean on a machine without a compiler: PoCL's programs call the C library
# that is loaded anyway.
place_link_libraries() {
  mkdir -p "$folder/lib/link"
  ln -s ../glibc/libc.so.6 "$folder/lib/link/libc.so"
  ln -s ../glibc/libm.so.6 "$folder/lib/link/libm.so"
  local empty
  for empty in libgcc.a libgcc_s.a; do printf '!<arch>\n' >"$folder/lib/link/$empty"; done
}

place_data() {
  mkdir -p "$folder/share/weft" "$folder/share/fonts"
  cp -r "$root/scenes" "$folder/share/weft/"
  cp /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf "$here/fonts.conf" "$folder/share/fonts/"
  original /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
  printf 'Weft %s: bin/weft --help. Scenes: share/weft/scenes. Licences: licenses/.\n' "$version" >"$folder/README"
}

place_licenses() {
  local package
  sort -u "$folder/originals" | while read -r file; do
    dpkg -S "$file" 2>/dev/null || dpkg -S "${file#/usr}" 2>/dev/null || die "$file is of no package"
  done | sed 's/: .*//; s/:.*//' | sort -u >"$folder/packages"
  while read -r package; do
    install -D -m 644 "/usr/share/doc/$package/copyright" "$folder/licenses/$package"
  done <"$folder/packages"
  install -m 644 "$root/LICENSE" "$folder/licenses/weft"
  rm "$folder/originals" "$folder/packages"
}

[ "$(uname -sm)" = "Linux x86_64" ] || die "bundles are made on x86-64 Linux only"
rm -rf "$folder"
mkdir -p "$folder/lib"
place_programs
place_pocl
place_libraries
replace_unused
set_search_paths
blank_unused_sections
place_link_libraries
place_data
place_licenses
