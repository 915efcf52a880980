#!/bin/sh
# Every module includes only headers of itself and of the modules it declares in USES.
# "shared/" is shaders/shared, which C shares with GLSL.
# usage: layers.sh SOURCE_DIR TABLE; lines of TABLE are "module: used used ..."
set -eu
source=$1
table=$2
bad=0
count=0
while IFS=: read -r module uses; do
    dir=$source/src/$module
    [ -d "$dir" ] || dir=$source/$module
    # Sub-folders are part of their module.
    includes=$(find "$dir" -name '*.[ch]' -o -name '*.cpp' | sort |
               xargs grep -nE '^ *# *include "[a-z]+/' /dev/null || true)
    for other in $(echo "$includes" | sed -n 's|.*# *include "\([a-z]*\)/.*|\1|p' | sort -u); do
        count=$((count + 1))
        case " $module $uses shared " in
        *" $other "*) ;;
        *)
            echo "$module includes headers of $other, which its USES does not name:"
            echo "$includes" | grep "include \"$other/" || true
            bad=1
            ;;
        esac
    done
done < "$table"
[ "$count" -gt 10 ] || { echo "found no includes to check below $source"; exit 1; }
exit $bad
