#!/usr/bin/env bash
# Draws random views of a small scene, and opens and closes it, many times (soak.c).
# usage: soak.sh ORIEL SOURCE SOAK [FRAMES ROUNDS]     for hours: 10000 1000
set -u
soak=$3 frames=${4:-300} rounds=${5:-20}
. "$2/tests/e2e/command_lib"
export ORIEL_CACHE=$work/programs
workspace 4 && square || exit 1
scene train train test train
"$soak" ws "$frames" "$rounds"
