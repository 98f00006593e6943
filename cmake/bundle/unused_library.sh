#!/usr/bin/env bash
# unused_library.sh LIBRARY OUT USER...: a library that can stand in for LIBRARY where its functions are
# never called: each function that a USER names ends the program with a message. HDF5 links to a whole
# network stack for files in a cloud, LLVM to a theorem prover and to an XML parser with the world's
# alphabets for Windows' manifests, cairo to a window system: a third of the archive, for nothing. Data that
# a USER names is there and zero.
set -euo pipefail

library=$1 out=$2
shift 2

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# NAME or NAME@VERSION.
for user in "$@"; do nm -D --undefined-only --with-symbol-versions "$user"; done |
  awk '{ print $NF }' | sort -u >"$work/asked"
nm -D --defined-only --with-symbol-versions "$library" |
  awk '{ sub("@@", "@", $3); print $3, $2 }' | sort >"$work/has"
join "$work/asked" "$work/has" >"$work/used"
{
  printf '#include <stdio.h>\n#include <stdlib.h>\n'
  printf 'static void unused(const char* name) {\n'
  printf '    fprintf(stderr, "weft: error: %%s is not in this bundle\\n", name);\n    abort();\n}\n'
  awk '{ split($1, part, "@") }
       $2 ~ /[TtWiI]/ { print "void " part[1] "(void) { unused(\"" part[1] "\"); }" }
       $2 !~ /[TtWiI]/ { print "void* " part[1] "[64];" }' "$work/used"
} >"$work/stand_in.c"
awk '{ split($1, part, "@"); if (part[2] != "") names[part[2]] = names[part[2]] " " part[1] ";" }
     END { for (version in names) print version " { global:" names[version] " };" }' "$work/used" >"$work/versions"

script=""
[ ! -s "$work/versions" ] || script=-Wl,--version-script="$work/versions"
cc -shared -fPIC -Os -w -fno-builtin -s -nodefaultlibs -Wl,-soname,"$(basename "$out")" $script \
  -o "$out" "$work/stand_in.c" -lc
