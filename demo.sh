#!/usr/bin/env bash
# Installs what is missing, builds Oriel, makes a scene from photographs and leaves
# one page about it: demo/index.html, with a walk through the scene in it.
#   ./demo.sh            photographs of a synthetic monument
#   ./demo.sh PHOTOS     a folder of your own
set -u
cd "$(dirname "$0")" || exit 1
invoked="./demo.sh${1:+ PHOTOS}"
given=${1:+$(cd "$OLDPWD" && realpath -- "$1")}
if [ $# -gt 1 ] || { [ $# -eq 1 ] && [ ! -d "$given" ]; }; then
    echo "usage: ./demo.sh [PHOTOS]    (PHOTOS: a folder of photographs)" >&2
    exit 2
fi
. .ci/deps.sh
. datasets/demo/page.sh

demo=$PWD/demo
scene=$demo/scene
build=$PWD/build-demo
oriel=$build/oriel
start=$SECONDS
current='' current_start=0 step_json=''
# Steps with the seconds they take on two cores without a GPU, for the time left.
names=(dependencies build photographs scene comparison walk site page)
expected=(60 70 40 170 15 90 15 10)
spent=0 planned_spent=0

fail() {
    echo "demo.sh: $1 failed; what it said is above" >&2
    exit 1
}

# Says that a step begins and how long the rest will take, judged by how long the
# steps before it took.
begin() {
    local i left=0 seen=
    finish_step
    current=$1
    current_start=$SECONDS
    for i in "${!names[@]}"; do
        [ "${names[i]}" = "$1" ] && seen=1
        [ "$seen" ] && left=$((left + expected[i]))
    done
    [ "$planned_spent" -gt 60 ] && left=$((left * (spent + 60) / (planned_spent + 60)))
    left=$(((left + 30) / 60))
    [ "$left" -gt 0 ] && left="about $left min" || left="less than a minute"
    echo "== [$((SECONDS - start)) s] $2 ($left left)"
}

finish_step() {
    local took=$((SECONDS - current_start)) i
    [ "$current" ] || return 0
    # Installing and building may find all done, and say nothing about this machine's speed.
    for i in "${!names[@]}"; do
        [ "$i" -gt 1 ] && [ "${names[i]}" = "$current" ] &&
            spent=$((spent + took)) planned_spent=$((planned_spent + expected[i]))
    done
    step_json="$step_json${step_json:+, }{\"name\": \"$current\", \"seconds\": $took}"
    current=
}

take_photographs() {
    if [ "$given" ]; then
        photos=$given title="Your photographs, to walk through" held_out=(--test-every 8)
        return 0
    fi
    photos=$demo/photos title="A monument, to walk through"
    # Between others: a rendering has photographs on both sides.
    held_out=(--test-list "0005.jpg,0012.jpg,0020.jpg")
    "$oriel" synth monument --out "$photos" --size 576x384 --count 24
}

make_scene() {
    export QT_QPA_PLATFORM=offscreen
    "$oriel" prepare "$photos" --out "$scene" --quality draft "${held_out[@]}"
}

compare() {
    "$oriel" eval "$scene" --method all --json "$demo/eval.json" --images "$demo/eval" &&
        grep -q '"views"' "$demo/eval.json"
}

# The method shown: our own, or before there is one the first.
choose_method() {
    local methods
    methods=$(sed -nE 's/.*"method": *"([^"]*)".*/\1/p' "$demo/eval.json")
    if grep -qx oriel <<<"$methods"; then
        echo oriel
    else
        grep -vx points <<<"$methods" | head -n 1
    fi
}

take_walk() {
    local middle
    middle=$(find "$scene/images" -type f -printf '%f\n' | sort | sed -n "$((photo_count / 2))p")
    "$oriel" render "$scene" --path photos --frames 120 --fps 24 --method "$method" \
        --out "$demo/walk.mp4" &&
        "$oriel" render "$scene" --at "$middle" --method "$method" --layers depth \
            --out "$demo/view.png"
}

# The walk to take oneself, as one file, which a browser opens from disk.
publish_walk() {
    "$oriel" publish "$scene" --out "$demo/walk.html" --single-file --title "$title"
}

begin dependencies "looking for what Oriel needs"
install_dependencies || fail "installing what is missing"
begin build "building Oriel"
build_oriel "$build" -DCMAKE_BUILD_TYPE=Release || fail "the build"
version=$("$oriel" version | cut -d' ' -f2)

if [ -d "$demo" ]; then
    [ -f "$demo/.made-by-oriel" ] || { echo "demo.sh: $demo is in the way" >&2; exit 2; }
    rm -rf "$demo"
fi
mkdir -p "$demo" && touch "$demo/.made-by-oriel"

begin photographs "taking photographs${given:+ from $given}"
take_photographs || fail "finding photographs"
begin scene "making a scene: cameras, then depth, then points"
make_scene || fail "making the scene"
photo_count=$(find "$scene/images" -type f | wc -l)
begin comparison "comparing with the photographs kept aside"
compare || fail "the comparison"
method=$(choose_method)
begin walk "rendering a walk"
take_walk || fail "the walk"
begin site "publishing the walk"
publish_walk || fail "publishing the walk"
begin page "writing the page"
minutes=$(((SECONDS - start + 30) / 60))
write_page || fail "writing the page"
cat <<END
== done in $((SECONDS - start)) s: open $demo/index.html
== next: walk through it yourself, drawn by this machine: run
       $oriel walk $scene
   and open http://127.0.0.1:8765/
END
