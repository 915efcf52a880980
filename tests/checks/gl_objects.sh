#!/bin/sh
# GL objects are created and deleted in src/gpu alone.
# usage: gl_objects.sh SOURCE_DIR [FOLDER_OF_THE_OWNER]
set -eu
owner=${2:-src/gpu}
cd "$1"
[ -d "$owner" ] || { echo "no folder $owner"; exit 1; }
pattern='\<gl(Create|Gen|Delete)[A-Z][A-Za-z]* *\('
grep -Eq "$pattern" src/gpu/*.c || { echo "the pattern matches nothing at all"; exit 1; }
if grep -rnE "$pattern" --include='*.[ch]' --include='*.cpp' src preprocess datasets |
        grep -v "^$owner/"; then
    echo "GL objects are made outside $owner"
    exit 1
fi
