#!/usr/bin/env bash
# The walk shows what cameras write while it runs: oriel synth figures --live plays them.
. "$(dirname "$0")/command_lib"
runs 0 "$oriel" synth figures --out set --cameras 5 --size 96x72
runs 0 "$oriel" import set --background set/background --out still
runs 2 "$oriel" walk still --live nowhere
grep -q 'nowhere: no such folder' stderr.txt || fail "does not name the folder"
mkdir mixed && mkfifo mixed/cam00
runs 2 "$oriel" walk still --live mixed
grep -q 'cam01: some cameras have pipes' stderr.txt || fail "takes pipes and folders"
runs 2 "$oriel" synth monument --out other --live live
[ $failed -eq 0 ] || exit 1
timeout 300 /usr/bin/python3 -B "$source/tests/web/test_live.py" "$oriel" "$work/still" "$work"
