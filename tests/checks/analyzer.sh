#!/bin/bash
# gcc's -fanalyzer finds nothing in Oriel's C. It takes minutes, so that no test runs it.
# Its rule about uninitialized values is left to valgrind: gcc 12 takes arrays that a loop or a callee
# fills for unwritten.
# usage: analyzer.sh SOURCE_DIR BUILD_DIR      BUILD_DIR: a build by gcc, for its generated headers
set -u
cd "$1" || exit 1
generated=$(find "$2" -name '*.h' -printf '-I%h\n' | sort -u)
flags=$(pkg-config --cflags epoxy libpng jansson lcms2 libexif libwebsockets libxxhash OpenEXR stb)
found=$(git ls-files 'src/*.c' 'preprocess/*.c' 'datasets/*.c' | xargs -P "$(nproc)" -I{} \
    gcc -std=gnu11 -O1 -fanalyzer -Wno-analyzer-use-of-uninitialized-value -D_GNU_SOURCE '-DORL_VERSION="0"' $flags \
    -Iinclude -Isrc -I. -Ishaders $generated -S -o /dev/null {} 2>&1)
[ -z "$found" ] || { echo "$found"; exit 1; }
