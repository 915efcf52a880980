#!/usr/bin/env bash
# What cmake --install leaves serves a program outside the tree, by CMake and by pkg-config.
set -eu
build=$(dirname "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cmake --install "$build" --prefix "$work/prefix" >install.log || { cat install.log >&2; exit 1; }
grep -q fsanitize "$build/build.ninja" 2>/dev/null && sanitize=-fsanitize=address,undefined

mkdir user
cat >user/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES C CXX)
find_package(oriel 0.1 REQUIRED)
add_executable(user user.c)
target_link_libraries(user PRIVATE oriel::oriel)
END
cat >user/user.c <<'END'
#include <stdio.h>
#include <oriel/render.h>
#include <oriel/scene.h>
int main(void)
{
    struct orl_scene *scene = NULL;
    for (const struct orl_method *m = orl_methods; m->name; m++)
        puts(m->name);
    return orl_scene_open(NULL, "/not/there", &scene) == ORL_OK;
}
END
cmake -S user -B by-cmake -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" \
    -DCMAKE_C_FLAGS="${sanitize:-}" -DCMAKE_CXX_FLAGS="${sanitize:-}" >cmake.log 2>&1 &&
    cmake --build by-cmake >>cmake.log 2>&1 || { cat cmake.log >&2; exit 1; }
./by-cmake/user | grep -qx airieau

pc=$(dirname "$(find prefix -name oriel.pc)")
# shellcheck disable=SC2046
PKG_CONFIG_PATH=$pc cc ${sanitize:-} user/user.c -o by-pkg-config \
    $(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs --static oriel)
./by-pkg-config | grep -qx airieau
"$work/prefix/bin/oriel" version

for page in man/man1/oriel.1 bash-completion/completions/oriel zsh/site-functions/_oriel \
    fish/vendor_completions.d/oriel.fish; do
    [ -s "$work/prefix/share/$page" ] || { echo "share/$page is missing" >&2; exit 1; }
done
# A report's script is found where it is installed.
PATH=/usr/bin:$PATH "$work/prefix/bin/oriel" plot nowhere.json --out plots 2>plot.log &&
    { echo "a plot of nothing" >&2; exit 1; }
grep -Eq 'nowhere.json|python3' plot.log || { cat plot.log >&2; exit 1; }
