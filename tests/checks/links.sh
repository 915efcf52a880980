#!/bin/sh
# Every relative link of README.md and docs/**/*.md leads to a file and, with #, to a heading of it;
# every page of docs can be reached from its index, and files that comments and pages name are there.
# Links to other sites are not followed.
# usage: links.sh SOURCE_DIR [INDEX]
set -eu
index=${2:-docs/index.md}
cd "$1"
[ -f "$index" ] || { echo "no page $index"; exit 1; }
table=$(mktemp)
trap 'rm -f "$table"' EXIT
bad=0

# Targets of a page's links, one a line; what stands in code is no link.
targets() {
    awk '/^ *```/ { code = !code; next }
         code || /^    / { next }
         { gsub(/`[^`]*`/, "")
           while (match($0, /\]\([^)]*\)/)) {
               print substr($0, RSTART + 2, RLENGTH - 3)
               $0 = substr($0, RSTART + RLENGTH)
           } }' "$1"
}

# The names by which a page's headings are linked to, one a line.
headings() {
    awk '/^ *```/ { code = !code; next }
         !code && /^#+ / { sub(/^#+ /, ""); $0 = tolower($0); gsub(/[^a-z0-9 _-]/, "")
                           gsub(/ /, "-"); print }' "$1"
}

pages=$(find docs -name '*.md' | sort)
for page in README.md $pages; do
    for target in $(targets "$page"); do
        case $target in
        *://* | mailto:*) continue ;;
        esac
        file=${target%%#*}
        if [ -n "$file" ]; then
            file=$(realpath -m --relative-to=. "$(dirname "$page")/$file")
        else
            file=$page
        fi
        if [ ! -e "$file" ]; then
            echo "$page: $target leads to no file"
            bad=1
        elif [ "${target#*#}" != "$target" ] &&
            ! headings "$file" | grep -qxF -e "${target#*#}"; then
            echo "$page: $target leads to no heading"
            bad=1
        fi
        echo "$page $file" >>"$table"
    done
done
# Files that comments and pages name by their path; COLMAP's are its own.
folders=
for folder in src preprocess include datasets shaders web docs; do
    [ ! -d "$folder" ] || folders="$folders $folder"
done
for mention in $(grep -rhIvE 'COLMAP|^#include|^ *(import|from) ' --exclude-dir=measured $folders |
    grep -owE '(docs|include|preprocess|shaders|src|tests)/[a-z0-9_/]+\.(c|h|comp|frag|glsl|md|sh|vert)' | sort -u); do
    [ -e "$mention" ] || [ -e "web/$mention" ] || [ ! -d src ] || {
        echo "$mention is named and not there: $(grep -rlIF -e "$mention" $folders | tr '\n' ' ')"
        bad=1
    }
done

[ "$(wc -l <"$table")" -gt 10 ] || { echo "found no links to check below $1"; exit 1; }

reached=$(awk -v start="$index" '
    { links[$1] = links[$1] " " $2 }
    END { queue[n = 1] = start; seen[start]
          for (i = 1; i <= n; i++) {
              print queue[i]
              count = split(links[queue[i]], next_pages, " ")
              for (k = 1; k <= count; k++)
                  if (!(next_pages[k] in seen)) { seen[next_pages[k]]; queue[++n] = next_pages[k] }
          } }' "$table")
for page in $pages; do
    if ! echo "$reached" | grep -qxF "$page"; then
        echo "$page cannot be reached from $index"
        bad=1
    fi
done
exit $bad
