#!/bin/sh
# Every page of docs/measured begins with what its figures are of, in lines `- Commit: `, `- Scenes: `,
# `- Device: `, `- Date: ` and `- Made by: `. Its commits belong to this history, and none is older
# than the release before the last or, while there is none, than 60 days. There are at most 16 pages.
# Where the history is not at hand, in a shallow clone or an archive, the lines alone are checked.
# usage: measured_pages.sh SOURCE_DIR [PAGES_DIR]
set -eu
cd "$1"
pages=${2:-docs/measured}
limit=16 days=60
bad=0
complain() {
    echo "$*"
    bad=1
}

git_of() { git -c safe.directory='*' "$@"; }
history=yes
[ "$(git_of rev-parse --is-shallow-repository --show-prefix 2>/dev/null)" = false ] || history=
[ "$history" ] || echo "no whole history here: the commits are not checked"
[ ! "$history" ] || oldest=$(($(git_of log -1 --format=%ct) - days * 86400))

# check_commit PAGE COMMIT
check_commit() {
    if ! git_of merge-base --is-ancestor "$2" HEAD 2>/dev/null; then
        complain "$1: $2 is no commit of this history: measure again"
    elif [ "$(git_of tag --contains "$2" --merged HEAD | wc -l)" -gt 1 ]; then
        complain "$1: $2 is older than the release before the last: measure again"
    elif [ -z "$(git_of tag --merged HEAD)" ] && [ "$(git_of log -1 --format=%ct "$2")" -lt "$oldest" ]; then
        complain "$1: $2 is more than $days days old: measure again"
    fi
}

count=0
for page in "$pages"/*.md; do
    [ -f "$page" ] || continue
    count=$((count + 1))
    for key in Commit Scenes Device Date 'Made by'; do
        head -n 8 "$page" | grep -q "^- $key: ." || complain "$page: no line '- $key: ...' at its beginning"
    done
    head -n 8 "$page" | grep -Eq '^- Date: [0-9]{4}-[0-9]{2}-[0-9]{2}' || complain "$page: no date as 2026-01-31"
    commits=$(sed -n '1,8s/^- Commit: //p' "$page" | grep -owE '[0-9a-f]{7,40}' || true)
    [ "$commits" ] || complain "$page: no commit in the line '- Commit: ...'"
    [ ! "$history" ] || for commit in $commits; do check_commit "$page" "$commit"; done
done
[ $count -gt 0 ] || complain "no pages in $pages"
[ $count -le $limit ] || complain "$count pages in $pages; at most $limit serve a reader"
exit $bad
