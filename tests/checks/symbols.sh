#!/bin/sh
# Every external symbol of the library is called orl_*. Weak ones are C++ templates and
# type information of the bridge, double underscores the compiler's own.
# usage: symbols.sh LIBRARY [PREFIX]
set -eu
prefix=${2:-orl_}
case $1 in
*.a) symbols=$(nm -g --defined-only "$1") ;;
*) symbols=$(nm -D -g --defined-only "$1") ;;
esac
echo "$symbols" | grep -q " T orl_" || { echo "$1 defines no orl_ function"; exit 1; }
bad=$(echo "$symbols" | awk -v prefix="$prefix" '
    NF == 3 && $2 !~ /[VWwvu]/ && $3 !~ /^__/ && index($3, prefix) != 1 {print $3}')
if [ -n "$bad" ]; then
    echo "external symbols without $prefix:"
    echo "$bad"
    exit 1
fi
