#!/usr/bin/env bash
# Bad input to render and to the device: a clear word, the right status, nothing written.
set -u
. "$2/tests/e2e/command_lib"

# refuses STATUS WORDS command...: exits so, says so on stderr, leaves no out.*
refuses() {
    local status=$1 words=$2 got
    shift 2
    "$@" >stdout.txt 2>stderr.txt
    got=$?
    if [ $got -ne "$status" ] || ! grep -qi -- "$words" stderr.txt || ls out.* >/dev/null 2>&1; then
        echo "FAILED ($got instead of $status, or no \"$words\"): $*" >&2
        cat stderr.txt >&2
        failed=1
    fi
    rm -rf out.*
}

# A plain COLMAP workspace of one photograph and four points.
workspace 2 || exit 1
cat >ws/fused.ply <<'END'
ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
property float nx
property float ny
property float nz
property uchar red
property uchar green
property uchar blue
end_header
0 1 0 0 0 1 200 10 10
0.1 1 0 0 0 1 10 200 10
0 1.1 0 0 0 1 10 10 200
0.1 1.1 0 0 0 1 90 90 90
END
"$oriel" render ws --at 0001 --out good.png || { echo "the workspace itself fails" >&2; exit 1; }

# Parts of a path's frames are the frames of the whole.
path=(render ws --path photos --frames 5 --size 48x32 --quiet)
"$oriel" "${path[@]}" --out whole &&
    "$oriel" "${path[@]}" --out parts --part 2/2 && [ "$(ls parts | head -n 1)" = 00002.png ] &&
    "$oriel" "${path[@]}" --out parts --part 1/2 && diff -r whole parts ||
    { echo "parts of a path are not the whole" >&2; failed=1; }
refuses 2 'must be K/N' "$oriel" "${path[@]}" --out out.d --part 3/2
refuses 2 'have parts' "$oriel" "${path[@]}" --out out.mp4 --part 1/2
refuses 2 'have parts' "$oriel" render ws --at 0001 --out out.png --part 1/2

refuses 2 'one of --at' "$oriel" render ws --out out.png
refuses 2 '\-\-out' "$oriel" render ws --at 0001
refuses 2 'nonsense.*airieau' "$oriel" render ws --at 0001 --out out.png --method nonsense
refuses 2 'nonsense.*splat_scale' "$oriel" render ws --at 0001 --out out.png --set nonsense=1
refuses 2 'from 0.01 to 16' "$oriel" render ws --at 0001 --out out.png --set splat_scale=99
refuses 2 'fill=ground do not go with weight=normal' "$oriel" render ws --at 0001 --out out.png --method orzan-surface \
    --set fill=ground
refuses 2 'fill=ground do not go with weight=princ' "$oriel" render ws --at 0001 --out out.png --method princ --set fill=depth
refuses 2 'fill.*none.*room' "$oriel" render ws --at 0001 --out out.png --set fill=sand
refuses 2 'no photograph 7777' "$oriel" render ws --at 7777 --out out.png
refuses 2 'no photograph 7777' "$oriel" render ws --at 0001 --out out.png --exclude 7777
refuses 2 'light 7777' "$oriel" render ws --at 0001 --out out.png --light 7777
"$oriel" render ws --at 0001 --out light.png --light 0002 --quiet ||
    { echo "--light of a photograph fails" >&2; failed=1; }
refuses 2 'png or .exr' "$oriel" render ws --at 0001 --out out.gif
refuses 2 'depth, normal, coverage' "$oriel" render ws --at 0001 --out out.png --layers smell
refuses 2 'velvia.*reinhard, filmic' "$oriel" render ws --at 0001 --out out.png --tone velvia
refuses 2 'zip, piz' "$oriel" render ws --at 0001 --out out.exr --compression jpeg
refuses 2 'WxH' "$oriel" render ws --at 0001 --out out.png --size 0x9
for extension in png exr webm mov jpg; do
    refuses 2 'folder or an .mp4' "$oriel" "${path[@]}" --out out.$extension
done
refuses 2 'a video has no --layers' "$oriel" "${path[@]}" --out out.mp4 --layers depth
refuses 2 'whole: not empty' "$oriel" "${path[@]}" --out whole
"$oriel" "${path[@]}" --out layered --layers depth && [ "$(ls layered | head -n 1)" = 00000.exr ] ||
    { echo "frames with layers are not .exr" >&2; failed=1; }
# Without ffmpeg not even the scene is opened.
mkdir no-programs
refuses 2 'ffmpeg is needed' env PATH="$work/no-programs" "$oriel" render not-there --path photos --out out.mp4
refuses 2 'missing.json' "$oriel" render ws --camera missing.json --out out.png
echo '{"keyframes": [{"photo": "0001"}, {"photo": ' >cut.json
refuses 2 'cut.json: line' "$oriel" render ws --path cut.json --out out.dir
echo '[{"width": 10, "height": 10, "fx": -1, "fy": 5, "position": [0,0,0], "rotation": [[1,0,0],[0,1,0],[0,0,1]]}]' >bad.json
refuses 2 'camera 0 is not usable' "$oriel" render ws --camera bad.json --out out.png
refuses 2 'not-there' "$oriel" render not-there --at 0001 --out out.png
refuses 1 'out.png' "$oriel" render ws --at 0001 --out nowhere/out.png
refuses 2 'unknown command' "$oriel" nonsense

# No OpenGL at all: what was found, and how to get Mesa's software renderer.
echo '{}' >none.json
refuses 1 'Mesa' env __EGL_VENDOR_LIBRARY_FILENAMES="$work/none.json" \
    "$oriel" render ws --at 0001 --out out.png
# A driver that is too old.
refuses 1 '4\.5' env MESA_GL_VERSION_OVERRIDE=3.3 "$oriel" render ws --at 0001 --out out.png
# A scene larger than device memory: a plan, said aloud, and the picture all the same.
"$oriel" render ws --at 0001 --out planned.png --max-vram 1 2>plan.txt &&
    grep -qi 'MiB' plan.txt && [ -s planned.png ] || { echo "no plan for 1 MiB" >&2; failed=1; }
exit $failed
