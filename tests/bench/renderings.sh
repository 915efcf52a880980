#!/usr/bin/env bash
# Pictures of every method, proxy and pass of small synthetic scenes, to compare two builds bit for bit:
#     tests/bench/renderings.sh BUILD OUT [WITH]
# BUILD renders to OUT, 32-bit floats and all layers, in some minutes. WITH: the OUT of another build;
# its scenes are used, and pictures that differ are named. A change that only moves code changes none.
set -eu
[ $# -ge 2 ] || { sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 2; }
oriel=$(realpath "$1/oriel") truth=$(realpath "$1/tests/bench_truth_scene")
with=${3:+$(realpath "$3")}
mkdir -p "$2"
cd "$2"

if [ "$with" ]; then
    ln -sfnT "$with/scenes" scenes
elif [ ! -e scenes ]; then
    mkdir scenes.part
    (
        cd scenes.part
        "$oriel" synth monument --out photos --size 256x192 --count 14 --quiet
        "$truth" photos photos-truth monument 2 7
        "$oriel" synth monument --out series --size 192x144 --count 12 --exposures=-2,0,2 --quiet
        "$truth" series series-truth exposures 2 0
        "$oriel" synth figures --out set --cameras 6 --frames 3 --size 160x120 --quiet
        "$oriel" import set --masks set/masks --background set/background --mesh hull=48,3000 \
            --test-list cam04 --out figures --quiet
        # One that neither fills the pictures of the place in nor knows its room.
        "$oriel" import set --frames 0:1 --masks set/masks --test-list cam04 --out figure --quiet
    )
    mv scenes.part scenes
fi

# draw NAME COMMAND SCENE ARGUMENTS..
draw() {
    local name=$1 command=$2 scene=$3
    shift 3
    "$oriel" "$command" "scenes/$scene" --out "$name.exr" --float --quiet "$@"
}
view() { draw "$1" render monument --at 0003.jpg --layers depth,normal,coverage "${@:2}"; }
figure() { draw "$1" render "${2%:*}" --frame "${2#*:}" --at cam04 --layers depth,normal,coverage "${@:3}"; }
light() { draw "$1" hdr exposures --at 0004.jpg "${@:2}"; }

for method in $("$oriel" methods | sed -n 's/^\([a-z-]*\) .*/\1/p'); do
    case $method in
    li | goldluecke) figure "$method" figures:0 --method "$method" ;;
    *) view "$method" --method "$method" ;;
    esac
done
for fill in none color depth room; do view "fill-$fill" --method oriel --set fill=$fill; done
view gather-ground --method airieau --set fill=ground --set antialias=on
view median --method airieau --set median=all
view sizes --method oriel --size 301x217 --set guess_depths=0 --set guess_blur=0.2
view princ-few --method princ --exclude 0002.jpg,0004.jpg
for kind in ycc bc1; do view "textures-$kind" --method oriel --textures $kind; done
view few-on-the-device --method airieau --max-vram 16
view tiles-of-few --method oriel --max-vram 16 --set alignment=off
figure mesh figures:1 --method airieau --set proxy=mesh
figure mesh-points figures:0 --method points --set proxy=mesh
figure hull figures:1 --method orzan-shadow --set proxy=hull --set fill=none
figure voxels figure:0 --method goldluecke --set fill=room
figure shell figure:0 --method li
figure room-tiled figures:2 --method oriel --set proxy=hull --set fill=room
light radiance --method oriel
light radiance-airieau --method airieau
light radiance-oriel-high --method oriel-high
light radiance-li --method li --set proxy=splats
light merged-series --merge series
draw lit render exposures --radiance on --light 0002.jpg --at 0005.jpg
# A sequence whose next time step is prepared while one is drawn.
for method in li goldluecke; do
    rm -rf "path-$method"
    "$oriel" render scenes/figures --path circle --frames 3 --size 160x120 --method $method --out "path-$method" --quiet
done

find . -path ./scenes -prune -o \( -name '*.exr' -o -name '*.png' \) -print | sort >pictures.txt
echo "$(wc -l <pictures.txt) pictures"
[ -z "$with" ] || {
    differ=0
    while read -r picture; do cmp "$picture" "$with/$picture" || differ=$((differ + 1)); done <"$with/pictures.txt"
    echo "$differ differ"
    [ $differ = 0 ]
}
