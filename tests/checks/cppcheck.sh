#!/bin/bash
# cppcheck finds nothing in Oriel's C but what cppcheck.txt names.
# usage: cppcheck.sh SOURCE_DIR CACHE_DIR [FOLDER..]
set -u
source_dir=$1 cache=$2
shift 2
command -v cppcheck >/dev/null || { echo "cppcheck is not installed"; exit 77; }
# Each version finds other things, many of them in code that is right: that of Debian 12 decides.
[[ $(cppcheck --version) = *" 2.10"* ]] || { echo "$(cppcheck --version) is not 2.10"; exit 77; }
cd "$source_dir" && mkdir -p "$cache" || exit 1
[ $# -gt 0 ] || set -- src preprocess datasets
# Found faults print and fail; unknown macros are those of jansson.
exec cppcheck --quiet --error-exitcode=1 --std=c11 --language=c --template=gcc -j "$(nproc)" \
    --enable=warning,performance,portability --cppcheck-build-dir="$cache" \
    --suppressions-list=tests/checks/cppcheck.txt --suppress=missingIncludeSystem \
    -D_GNU_SOURCE '-Djson_object_foreach(object,key,value)=while (key = 0, value = 0, object)' \
    '-Djson_array_foreach(array,index,value)=while (index = 0, value = 0, array)' \
    --file-filter='*.c' -I include -I src -I . -I shaders "$@"
