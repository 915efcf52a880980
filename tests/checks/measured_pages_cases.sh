#!/bin/sh
# What measured_pages.sh says of pages in small repositories of its own.
# usage: measured_pages_cases.sh CHECK
set -eu
check=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export GIT_AUTHOR_NAME=test GIT_AUTHOR_EMAIL=test@localhost GIT_COMMITTER_NAME=test \
    GIT_COMMITTER_EMAIL=test@localhost GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_SYSTEM=/dev/null

commit() { # DATE
    GIT_AUTHOR_DATE=$1 GIT_COMMITTER_DATE=$1 git -C repo commit -q --allow-empty -m "at $1"
    git -C repo rev-parse --short=8 HEAD
}
page() { # COMMIT: the only page names it
    rm -f repo/pages/*
    printf '# Page\n\n- Commit: %s; rows of one scene: %s\n- Scenes: one\n- Device: none\n- Date: 2026-01-31\n- Made by: hand\n' \
        "$first" "$1" >repo/pages/page.md
}
failed=0
expect() { # RESULT WORDS: the check passes or fails, and says these words
    result=passes
    sh "$check" "${folder:-repo}" "$PWD/repo/pages" >said 2>&1 || result=fails
    [ $result = "$1" ] && { [ ! "$2" ] || grep -q "$2" said; } || { echo "expected: $1, $2; got: $result"; cat said; failed=1; }
}

mkdir -p repo/pages
git -C repo init -q
first=$(commit 2026-01-01T00:00:00Z)
page "$first"
expect passes ''
sed -i '/^- Device/d' repo/pages/page.md
expect fails "no line '- Device: "
page 0123456
expect fails '0123456 is no commit of this history'
for number in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16; do cp repo/pages/page.md "repo/pages/$number.md"; done
expect fails '17 pages'

# Two months without a release, then releases.
second=$(commit 2026-03-15T00:00:00Z)
page "$second"
expect fails "$first is more than 60 days old"
git -C repo tag v1
expect passes ''
commit 2026-03-16T00:00:00Z >third
git -C repo tag v2
expect fails "$first is older than the release before the last"

git clone -q --depth 1 "file://$work/repo" shallow
folder=shallow
expect passes 'not checked'
mkdir -p repo/inner
folder=repo/inner
expect passes 'not checked'
exit $failed
