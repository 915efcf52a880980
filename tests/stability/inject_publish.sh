#!/usr/bin/env bash
# Fails and kills oriel publish, which replaces an earlier site, at the renames and removals of files
# and folders in turn, and lets the power fail there and at the end, which takes what was not synced, on a drive that exchanges names and on one that
# does not. After each, the old or the new site is there, whole and under its name; the exit status
# tells; and the next publish makes the new site and leaves nothing beside it.
# usage: inject_publish.sh ORIEL SOURCE LIBRARY [all]     without all: the calls around the exchange
set -u
library=$3 all=${4:-}
. "$2/tests/e2e/command_lib"
. "$2/tests/stability/inject_lib"
export MESA_SHADER_CACHE_DIR=$work/mesa ORIEL_CACHE=$work/programs # filled by the first run
export INJECT_ONLY=web/ # not the files of these caches
declare -A tried

workspace 3 >/dev/null && square || exit 1
scene train test train
cp -r ws base
publish() { "$oriel" publish base --out web/site --title "$1" --quiet >stdout.txt 2>stderr.txt; }

# An earlier site, in which the user keeps a file.
before() {
    cp -r old web/site
    echo mine >web/site/CNAME
}

# whole SITE: says which one it is
whole() {
    local site
    for site in old new; do
        [ "$(cat "$1/CNAME" 2>&1)" = mine ] && diff -rq -x CNAME "$1" "$site" >/dev/null 2>&1 &&
            echo $site && return
    done
    echo "none"
}

# once NUMBER: publishes with that call failing; 1 when there is no such call.
once() {
    local number=$1 status found problems= kind="$call in publish${killed:+, $killed}"
    [ "$drive" ] && kind+=", names not exchanged"
    rm -rf web mark
    mkdir web
    before
    (with_fault web "$oriel" publish base --out web/site --title new --quiet \
        >stdout.txt 2>stderr.txt; exit $?) 2>/dev/null
    status=$?
    [ -e mark ] || return 1
    tried[$kind]=$((${tried[$kind]:-0} + 1))
    if [ "$killed" ]; then
        [ $status -eq 137 ] || problems+=" status $status after a kill;"
    elif [ $status -ge 128 ]; then
        problems+=" crashed ($status);"
    elif [ $status -ne 0 ]; then
        grep -q 'error: ' stderr.txt || problems+=" status $status without a word;"
    fi
    # Without an exchange, a killed program may leave the old site under the name that the next
    # one takes back.
    found=$(whole web/site)
    [ "$drive" ] && [ "$killed" ] && [ ! -e web/site ] && found=$(whole web/.oriel-old-*)
    [ "$found" = none ] && problems+=" no whole site: $(ls web | tr '\n' ' ');"
    [ $status -eq 0 ] && [ "$found" != new ] && problems+=" status 0 without the new site;"
    # The next one begins with what a killed one left.
    if [ "$killed" ]; then
        [ -z "$(ls -A web | grep oriel-)" ] || touch -d @1 web/.oriel-* # sweeping begins after a minute
        publish new || problems+=" the next one fails: $(tail -n 1 stderr.txt);"
        [ "$(whole web/site)" = new ] || problems+=" the next one makes no whole site;"
    fi
    # An earlier site that was moved aside is never removed unasked.
    found=$(ls -A web | grep -v '^.oriel-old-')
    [ "$found" = site ] || [ "$call$killed" = unlink ] || problems+=" left: $(ls -A web | tr '\n' ' ');"
    [ -z "$problems" ] || fail "publish: $kind: call $number: $problems"
}

# calls: how many calls of this kind there are.
calls() {
    rm -rf web
    mkdir web
    before
    killed= number=0 INJECT_COUNT=$work/count with_fault web "$oriel" publish base \
        --out web/site --title new --quiet >stdout.txt 2>stderr.txt
    cat "$work/count"
}

mkdir web
publish old || fail "publish itself"
mv web/site old
publish new || fail "publish itself"
mv web/site new
diff -rq old new >/dev/null && fail "the two sites do not differ"

for drive in '' INJECT_DRIVE=1; do
    for call in rename unlink end; do
        last=$(calls)
        for killed in '' killed "files zeroed"; do
            # Once the new site has its name, a drive that syncs must hold all of it.
            [ "$call-$killed" = "unlink-files zeroed" ] || makes_sense || continue
            [ "$drive" ] && [ "$killed" = "files zeroed" ] && [ "$call" != rename ] && continue
            # The last renames are those of the site, and all removals are of the old one.
            case $all$call in
            rename) numbers="${drive:+$((last - 2)) $((last - 1))}"
                [ "$drive" ] && [ "$killed" = "files zeroed" ] || numbers+=" $last" ;;
            *end) numbers=1 ;;
            unlink) numbers="1 ${killed:+$((last / 2))}" ;;
            *) numbers=$(seq "$last") ;;
            esac
            for number in $numbers; do
                once "$number" || fail "publish: $call: there is no call $number of $last"
            done
        done
    done
done
for kind in "${!tried[@]}"; do echo "injected: $kind ${tried[$kind]}"; done | sort
exit $failed
