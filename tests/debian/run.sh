#!/usr/bin/env bash
# Tries this commit as a newcomer would on a fresh Debian, and prints one row of
# docs/measured/platforms.md about it.
# usage: tests/debian/run.sh SUITE [--short]     SUITE: bookworm, trixie, sid
# ./demo.sh and ./test.sh --quick run in a root that debootstrap makes and that is removed at the
# end. --short: in place of both, a build in which a warning is an error and the tests that CI runs
# there. What they say is kept in build-debian-SUITE.log. Exit status 0: all passed; 77: this machine
# cannot make such a root.
set -u
suite=${1:-} mode=${2:-}
case $suite,$mode in
    bookworm, | trixie, | sid, | bookworm,--short | trixie,--short | sid,--short) ;;
    *) sed -n '2,9s/^# *//p' "$0"; exit 2 ;;
esac
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
. "$here/root.sh"
log=$source/build-debian-$suite.log
start=$SECONDS
failed=()

# Runs a script of the clone and adds what it says to the log.
newcomer() {
    root_run bash -c 'cd /root/oriel && exec "$@"' bash "$@" >>"$log" 2>&1 || failed+=("$1")
}

root_make "$suite"
root_run apt-get update -q >"$log" 2>&1 || root_skip "the package archive is not reached from a root"
rm -rf "${root:?}/root/oriel"
git clone -q --depth 1 "file://$source" "$root/root/oriel" || exit 1
commit=$(git -C "$root/root/oriel" rev-parse --short HEAD)
if [ "$mode" ]; then
    newcomer ./test.sh --quick --strict '^(unit|checks|golden)/|^e2e/monument$'
else
    newcomer ./demo.sh
    newcomer ./test.sh --quick
fi

counts=$(grep -E '^[0-9]+ passed, [0-9]+ failed, [0-9]+ skipped$' "$log" | tail -n 1)
read -r passed _ bad _ skipped _ <<<"${counts:-0 - 0 - 0 -}"
demo=$(sed -nE 's/^== done in ([0-9]+ s).*/\1/p' "$log")
echo "| $suite | $commit | $(root_run gcc -dumpfullversion) | $(root_version colmap) |" \
    "$(root_version libgl1-mesa-dri) | $(root_version libopenexr-dev) | ${demo:--} | $passed | $bad |" \
    "$skipped | $((SECONDS - start)) |"
if [ ${#failed[@]} -gt 0 ]; then
    grep -E '\*\*\*(Failed|Timeout|Exception)|^FAILED|failed; what it said| error: | error\b.*:' "$log" | sort -u | head -n 40 >&2
    echo "failed: ${failed[*]}; see $log" >&2
    exit 1
fi
