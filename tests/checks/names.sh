#!/bin/sh
# No two source files have one name: a reader who looks for NAME finds one file. Private
# headers (internal.h), build files and run.sh are each folder's own; shaders and inputs of fuzzing
# are called by folder and name.
# usage: names.sh SOURCE_DIR
set -eu
cd "$1"
twice=$(find src preprocess datasets tests -type f ! -name CMakeLists.txt \
    ! -name internal.h ! -name run.sh ! -path 'tests/fuzz/inputs/*' 2>/dev/null | sed 's|.*/||' | sort | uniq -d)
[ -z "$twice" ] || { echo "several files are called: $twice"; exit 1; }
