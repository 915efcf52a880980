#!/bin/bash
# Every shader that a test compiled passes the reference compiler (glslang) and, as SPIR-V, its
# validator (spirv-val), and the tests compiled every file below shaders/.
# usage: shaders.sh SOURCE_DIR DUMP_DIR
# DUMP_DIR: where the GPU and golden tests left their programs (ORIEL_SHADER_DUMP). It is emptied, so
# that the next run does not meet programs of an older source.
set -u
source_dir=$1 dump=$2
for tool in glslangValidator spirv-val; do
    command -v "$tool" >/dev/null || { echo "$tool is not installed"; exit 77; }
done
ls "$dump"/*.comp >/dev/null 2>&1 || { echo "no GPU test ran before"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work" "$dump"' EXIT
failed=0
count=0
for file in "$dump"/*.*; do
    name=$(sed -n 's|^// source 0: ||p' "$file" | head -n 1)
    # As OpenGL SPIR-V, which wants an explicit location of everything; GLSL gives them itself.
    if ! glslangValidator -G -l --auto-map-locations -o "$work/spv" "$file" >"$work/log" 2>&1 ||
            grep -q WARNING "$work/log"; then
        echo "glslang: shaders/$name:"
        grep -E 'ERROR|WARNING' "$work/log" | head -n 5
        sed -n 's|^// source|    source|p' "$file" | sort -u
        failed=1
    elif ! spirv-val --target-env opengl4.5 "$work/spv" 2>"$work/log"; then
        echo "spirv-val: shaders/$name:"
        head -n 5 "$work/log"
        failed=1
    fi
    count=$((count + 1))
done
sed -n 's|^// source [0-9]*: ||p' "$dump"/* | sort -u >"$work/compiled"
(cd "$source_dir/shaders" && find . -type f ! -name '*.h' | sed 's|^\./||' | sort) >"$work/all"
if comm -13 "$work/compiled" "$work/all" | grep .; then
    echo "no test compiled these"
    failed=1
fi
# Mesa's Vulkan-backed OpenGL up to 22.3 fails on these: docs/develop/shaders.md.
if grep -rnE '\<bool [a-z_]+(, [a-z_]+)*\[' "$source_dir/shaders"; then
    echo "arrays of bool are not portable"
    failed=1
fi
echo "$count programs"
exit $failed
