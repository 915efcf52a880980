#!/bin/bash
# What oriel prepare says of input that it cannot use. No COLMAP is needed.
. "$2/tests/e2e/prepare_lib"
export ORIEL_COLMAP=$source/tests/e2e/colmap_double

run 2 prepare "$work/nowhere" --out "$work/s"
says "$work/nowhere: no such folder or file"
[ -e "$work/s" ] && fail "a scene folder was left behind"

mkdir "$work/empty"
run 2 prepare "$work/empty" --out "$work/s"
says "$work/empty: no photograph here"
[ -e "$work/s" ] && fail "a scene folder was left behind"

photos "$work/one" a.png
run 2 prepare "$work/one" --out "$work/s"
says "$work/one: 1 usable photograph of 1; at least three are needed"

photos "$work/deep/inner" a.png b.png c.png
run 2 prepare "$work/deep" --out "$work/s"
says "name $work/deep/inner instead"
[ -e "$work/s" ] && fail "a scene folder was left behind"

# Videos: what to do with them, wherever they are, and no scene folder.
mkdir -p "$work/film/cam1" "$work/films"
echo x >"$work/film/cam1/a.avi"
echo x >"$work/films/B.MP4"
for given in film film/cam1 films films/B.MP4; do
    run 2 prepare "$work/$given" --out "$work/s"
    says "$work/$given: "
    says "video"
    says "take frames out of one whose camera moved"
    says "ffmpeg -i VIDEO -vf fps=2 FRAMES/%05d.png"
    [ -e "$work/s" ] && fail "a scene folder was left behind"
done

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
run 2 prepare "$work/p" --out "$work/s" --test-list a,zebra
says "--test-list zebra: no usable photograph of this name"
run 2 prepare "$work/p" --out "$work/s" --test-list a,b,c,d
says "at least two must remain"
run 2 prepare "$work/p" --out "$work/s" --masks "$work/empty"
says "no mask for any photograph"
run 2 prepare "$work/p"
says "--out SCENE is missing"

# Damaged ones among good ones are named, skipped and counted; the job goes on.
head -c 100 "$work/p/a.png" >"$work/p/cut.png"
echo text >"$work/p/text.jpg"
echo x >"$work/p/live.mov"
: >"$work/p/nothing.jpg"
run 0 prepare "$work/p" --out "$work/s" --test-list e
for name in cut.png text.jpg nothing.jpg; do
    says "$work/p/$name: "
done
says "$work/p: videos are left out: 1"
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
