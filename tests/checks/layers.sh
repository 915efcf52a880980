#!/bin/sh
# Every module includes only headers of itself and of the modules it declares in USES.
# "include/" is shaders/include, which C shares with GLSL.
# usage: layers.sh SOURCE_DIR TABLE; lines of TABLE are "module: used used ..."
set -eu
source=$1
table=$2
bad=0
count=0
while IFS=: read -r module uses; do
    dir=$source/src/$module
    [ -d "$dir" ] || dir=$source/$module
    for other in $(cat "$dir"/*.[ch] "$dir"/*.cpp 2>/dev/null |
                   sed -n 's|^ *# *include "\([a-z]*\)/.*|\1|p' | sort -u); do
        count=$((count + 1))
        case " $module $uses include " in
        *" $other "*) ;;
        *)
            echo "$module includes headers of $other, which its USES does not name:"
            grep -n "include \"$other/" "$dir"/*.[ch]* || true
            bad=1
            ;;
        esac
    done
done < "$table"
[ "$count" -gt 10 ] || { echo "found no includes to check below $source"; exit 1; }
exit $bad
