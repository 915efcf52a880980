#!/bin/bash
# What oriel prepare says of input that it cannot use. No COLMAP is needed.
. "$2/tests/e2e/prepare_lib"
export ORIEL_COLMAP=$source/tests/e2e/colmap_double

run 2 prepare "$work/nowhere" --out "$work/s"
says "$work/nowhere: no such folder or file"
[ -e "$work/s" ] && fail "a scene folder was left behind"

# As many as a shell's pattern may give.
run 2 prepare "$work/nowhere" $(seq 5000) --out "$work/s"
says "$work/nowhere: no such folder or file"

mkdir "$work/empty"
run 2 prepare "$work/empty" --out "$work/s"
says "$work/empty: no photograph here"
[ -e "$work/s" ] && fail "a scene folder was left behind"

photos "$work/one" a.png
run 2 prepare "$work/one" --out "$work/s"
says "$work/one: 1 usable photograph of 1; at least three are needed"

# Sub-folders, one of them reached again through a link; not hidden ones, nor scenes.
photos "$work/deep/inner" a.png b.png
photos "$work/deep/.hidden" x.png
photos "$work/deep" a.png
ln -s .. "$work/deep/inner/loop"
for option in "" --resume; do
    run 0 prepare "$work/deep" --out "$work/deep/scene" --test-list inner/b $option
    prints "3 given, 3 used, 3 registered (2 train, 1 held out)"
done
[ -f "$work/deep/scene/images/inner_b.png" ] || fail "no photograph is named after its folder"
run 2 prepare "$work/deep/a.png" "$work/deep/inner" --out "$work/s"
says "have the same name, a.png: rename one, or give the folder that holds both"

# Where the folder that holds both was given, another advice helps.
photos "$work/twins/a" b.png
photos "$work/twins" a_b.png
run 2 prepare "$work/twins" --out "$work/s"
says "have the same name, a_b.png: rename one, or take it out of the folder"

# A scene is no folder of photographs: its own were resampled, and masks and maps are beside them.
run 2 prepare "$work/deep/scene" --out "$work/s"
says "$work/deep/scene: a scene; give the photographs that it was made of"
[ -e "$work/s" ] && fail "a scene folder was left behind"

# Photographs of one picture are named, and left out if that is wanted.
photos "$work/same" a.png b.png c.png
run 2 prepare "$work/same" --out "$work/s" --leave-out duplicates
says "b.png: shows the same as a.png; skipped"
says "1 usable photograph of 3"
run 0 prepare "$work/same" --out "$work/same-s"
says "c.png: shows the same as a.png (see --leave-out)"

# A plan's last job names its folder, even where that is not UTF-8 and it cannot: else it would go on without.
latin=$work/caf$(printf '\351')
photos "$latin" a.png b.png c.png
run 0 prepare "$latin" --out "$work/latin-s" --until collect
run 0 plan "$work/latin-s" --json
prints '/caf\\xe9"'

# HEIC, as phones write it: COLMAP gets JPEG files.
if command -v heif-enc >/dev/null; then
    photos "$work/phone" a.png
    for quality in 50 70 90; do
        heif-enc -q $quality "$work/phone/a.png" -o "$work/phone/$quality.HEIC" >/dev/null 2>&1
    done
    rm "$work/phone/a.png"
    ln "$work/phone/70.HEIC" "$work/phone/80.heif" # the same file
    mv "$work/phone/90.HEIC" "$work/phone/90.HIF" # as cameras name it
    run 0 prepare "$work/phone" --out "$work/phone-s" --max-size 96
    prints "4 given, 3 used, 3 registered"
    [ -f "$work/phone-s/images/70.jpg" ] || fail "no JPEG is made of a HEIC file"
fi

# Videos: frames of those that are named or alone in a folder. What cannot be decoded is named.
mkdir -p "$work/films/cam1"
echo x >"$work/films/broken.MP4"
if command -v ffmpeg >/dev/null; then
    # Three seconds of a camera that moves, then two of one that stands still.
    ffmpeg -loglevel error -f lavfi -i testsrc2=size=96x80:rate=12:duration=3 -c:v ffv1 \
        -vf scroll=horizontal=0.05,tpad=stop_mode=clone:stop_duration=2 "$work/films/cam1/walk.mkv"
    run 0 prepare "$work/films" --out "$work/film-s" --max-size 96
    says "broken.MP4: ffmpeg finds no frames in it; skipped"
    says "the camera stands still in 3 frames"
    prints "8 given, 7 used, 7 registered"
    [ -f "$work/film-s/images/cam1_walk_00001.jpg" ] || fail "no frame is named after its video"
    # Frames are named after the folder, too, which COLMAP's lists must be able to hold.
    mkdir -p "$work/takes/1, hall"
    cp "$work/films/cam1/walk.mkv" "$work/takes/1, hall"
    run 2 prepare "$work/takes" --out "$work/s"
    says "walk.mkv: its name has a comma or a control character: rename it; skipped"
    mkdir "$work/converted"
    cp "$work/films/cam1/walk.mkv" "$work/converted"
    ffmpeg -loglevel error -i "$work/films/cam1/walk.mkv" -c:v ffv1 -vf hflip "$work/converted/walk.avi"
    run 2 prepare "$work/converted" --out "$work/s"
    says "two videos have frames of the same name, walk_00001.jpg: rename one of them"
    # To ffmpeg a name may begin with a protocol, and one of a folder may hold a number's form.
    cp "$work/films/cam1/walk.mkv" "$work/12:30.mkv"
    (cd "$work" && "$oriel" prepare 12:30.mkv --out "100% wool" --frames 5 --until collect >out 2>err) ||
        fail "names with a colon or a per cent sign"
    [ -e "$work/100% wool/.oriel/photos/12:30_00001.jpg" ] || fail "no frames in a folder with a per cent sign"
    run 0 prepare "$work/films" --out "$work/film-s" --max-size 96 --resume
    says "calibrate: done already"
    run 0 prepare "$work/films/cam1/walk.mkv" --out "$work/few-s" --frames 5 --max-size 96
    [ "$(ls "$work/few-s/images" | wc -l)" = 4 ] || fail "not the frames that were asked for"
    # Frames have square pixels.
    ffmpeg -loglevel error -i "$work/films/cam1/walk.mkv" -c:v ffv1 -vf setsar=2/1 "$work/wide.mkv"
    run 0 prepare "$work/wide.mkv" --out "$work/wide-s" --frames 3 --until collect
    ffprobe -v error -show_entries stream=width,height -of csv=p=0 \
        "$work/wide-s/.oriel/photos/wide_00001.jpg" | grep -qx 192,80 || fail "frames are not stretched"
else
    run 2 prepare "$work/films" --out "$work/s"
    says "ffmpeg is needed"
fi
run 2 prepare "$work/films/broken.MP4" --out "$work/s" --fps 1 --frames 5
says "exclude each other"

# Not writable: below a regular file, which stops root too.
photos "$work/p" a.png b.png c.png d.png e.png
echo x >"$work/file"
run 1 prepare "$work/p" --out "$work/file/s"
says "$work/file"

# Somebody else's folder stays as it is.
mkdir "$work/other"
echo precious >"$work/other/thing"
run 2 prepare "$work/p" --out "$work/other"
says "not made by oriel prepare"
run 2 prepare "$work/p" --out "$work/other" --resume
[ "$(ls -A "$work/other")" = thing ] || fail "somebody else's folder was changed"

run 2 prepare "$work/p" --out "$work/s" --quality best
says "must be one of draft, standard, high"
run 2 prepare "$work/p" --out "$work/s" --test-every 2 --test-list a
says "exclude each other"
run 2 prepare "$work/p" --out "$work/s" --test-block 0:1 --test-list a
says "exclude each other"
for block in 2:2 -1:1 1 1:2:3; do
    run 2 prepare "$work/p" --out "$work/s" --test-block "$block"
    says "must be A:B"
done
run 2 prepare "$work/p" --out "$work/s" --test-block 0:99
says "--test-block 0:99: there are "
run 2 prepare "$work/p" --out "$work/s" --test-list a,zebra
says "--test-list zebra: no usable photograph of this name"
run 2 prepare "$work/p" --out "$work/s" --test-list a,b,c,d
says "at least two must remain"
run 2 prepare "$work/p" --out "$work/s" --masks "$work/empty"
says "no mask for any photograph"
mkdir "$work/black"
base64 -d >"$work/black/a.png" <<'PNG'
iVBORw0KGgoAAAANSUhEUgAAAGAAAABQCAAAAADDiS9JAAAAgklEQVRYCbXBAQEAAABAIP6ftkLJTGYyk5nMZCYzmclM
ZjKTmcxkJjOZyUxmMpOZzGQmM5nJTGYyk5nMZCYzmclMZjKTmcxkJjOZyUxmMpOZzGQmM5nJTGYyk5nMZCYzmclMZjKT
mcxkJjOZyUxmMpOZzGQmM5nJTGYyk5nMZCYzmQXqNABRn24ZTwAAAABJRU5ErkJggg==
PNG
for run in first second; do
    run 2 prepare "$work/p" --out "$work/black_scene" --masks "$work/black"
    says "all of its 1 masks are black"
done
run 2 prepare "$work/p"
says "--out SCENE is missing"

# Damaged ones among good ones are named, skipped and counted; the job goes on.
head -c 100 "$work/p/a.png" >"$work/p/cut.png"
echo text >"$work/p/text.jpg"
echo x >"$work/p/live.mov"
: >"$work/p/nothing.jpg"
run 0 prepare "$work/p" --out "$work/s" --test-block 4:5
for name in cut.png text.jpg nothing.jpg; do
    says "$work/p/$name: "
done
says "$work/p: videos beside photographs are left out: 1"
prints "8 given, 5 used, 5 registered (4 train, 1 held out)"
run 0 info "$work/s"
prints "left out     $work/p/cut.png"

# What is no file, one file under two names, and a name that later names would not fit: said at
# once, not after calibration; nothing is waited for.
photos "$work/odd" a.png b.png c.png
long=$(printf 'x%.0s' {1..210}).png
photos "$work/odd" "$long"
mkfifo "$work/odd/pipe.jpg"
ln "$work/odd/a.png" "$work/odd/hard.png"
ln -s b.png "$work/odd/soft.png"
cp "$work/odd/c.png" "$work/odd/copy.png"
timeout 60 "$oriel" prepare "$work/odd" --out "$work/o" >"$work/out" 2>"$work/err" ||
    fail "odd files stop prepare: $?"
says "pipe.jpg: not a regular file"
says "its name is longer than 200 bytes"
says "hard.png: the same file as a.png"
says "soft.png: the same file as b.png"
says "copy.png: the same file as c.png"
prints "8 given, 3 used, 3 registered"
mkfifo "$work/list"
timeout 60 "$oriel" prepare "$work/p" --out "$work/f" --exposures "$work/list" \
    >"$work/out" 2>"$work/err"
[ $? = 124 ] && fail "a FIFO for a list is waited for"
says "$work/list: not a regular file"

finish
