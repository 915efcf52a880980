#!/usr/bin/env bash
# A stranger's scene, and output to places that are no ordinary files.
set -u
. "$2/tests/e2e/command_lib"
esc=$'\e' latin=$'caf\xe9'

workspace 2 && square || exit 1

# Output that does not arrive is an error, however long it is.
for arguments in 'info ws --json' 'info ws' 'version' '--help' 'render --help'; do
    # shellcheck disable=SC2086
    "$oriel" $arguments >/dev/full 2>stderr.txt
    [ $? -eq 1 ] && grep -q 'cannot write all of it' stderr.txt ||
        fail "lost output of $arguments goes unnoticed"
done
# A reader that has read enough is neither an error nor a death.
exec {gone}> >(exit)
wait $!
"$oriel" info ws >&$gone 2>stderr.txt
[ $? -eq 0 ] && ! grep -q 'cannot write' stderr.txt || fail "a reader that went away ends the program"
exec {gone}>&-
runs 0 "$oriel" info ws --json

# Links and devices are written to, not replaced.
mkdir elsewhere
ln -s elsewhere/view.png link.png
ln -s /dev/null null.png
runs 0 "$oriel" render ws --at 0001 --out link.png
[ -L link.png ] && [ -s elsewhere/view.png ] || fail "a link was replaced"
runs 0 "$oriel" render ws --at 0001 --out null.png
[ -L null.png ] && [ -c /dev/null ] || fail "a device was replaced"
[ -z "$(find . -name '.oriel-part-*')" ] || fail "temporary files stay"

# A folder's name that is not UTF-8, and names of photographs that would steer a terminal.
cp -r ws "$latin"
runs 0 "$oriel" info "$latin" --json
python=$(command -v python3) && { "$python" -c 'import json,sys; json.load(sys.stdin)' <stdout.txt ||
    fail "not JSON"; }
grep -qF 'caf\\xe9' stdout.txt || fail "the folder's name is not in its JSON"
cp -r ws evil
evil="${esc}]0;owned${esc}[2J.jpg"
mv "evil/images/${names[0]}" "evil/images/$evil"
"$oriel" info evil >stdout.txt 2>stderr.txt && fail "the model names another file"
rm -rf evil/sparse/*.bin
mkdir -p evil/sparse
cat >evil/sparse/cameras.txt <<<'1 PINHOLE 96 64 90 90 48 32'
printf '1 1 0 0 0 0 0 9 1 %s\n\n' "$evil" >evil/sparse/images.txt
: >evil/sparse/points3D.txt
runs 0 "$oriel" info evil
grep -qF "$esc" stdout.txt stderr.txt && fail "a name reaches the terminal as it is"
grep -qF '\x1b]0;owned' stdout.txt || fail "the name is not shown"
rm "evil/images/$evil"
runs 2 "$oriel" info evil
grep -qF "$esc" stderr.txt && fail "a name in an error reaches the terminal as it is"

turned=$'\u202egpj.exe' # shown, it would end in "exe.jpg"
sed -i "s|[^ ]*owned.*|$turned.jpg|" evil/sparse/images.txt
cp "ws/images/${names[0]}" "evil/images/$turned.jpg"
for form in '' --json; do
    runs 0 "$oriel" info evil $form
    grep -qF $'\u202e' stdout.txt stderr.txt && fail "a name turns the text of info $form"
done

# Limits of the shell are told of, and leave nothing behind.
(ulimit -f 1 && runs 1 "$oriel" render ws --at 0001 --out large.exr && exit $failed) || failed=1
grep -qi 'large.exr.*too large' stderr.txt || fail "a file beyond ulimit -f is not told of"
[ -z "$(find . -name '.oriel-part-*')" ] && [ ! -e large.exr ] || fail "a cut file stays"
(ulimit -v 400000 && runs 1 "$oriel" render ws --at 0001 --out small.png && exit $failed) || failed=1
grep -q 'ulimit -v' stderr.txt || fail "too little address space is not told of"

# Many photographs that are left out are not told one by one.
{
    comma=
    printf '{"fl_x": 90, "fl_y": 90, "cx": 48, "cy": 32, "w": 96, "h": 64, "frames": ['
    for ((i = 0; i < 300; i++)); do
        file=images/none$i.jpg
        [ $i -lt 2 ] && file=${names[i]}
        printf '%s{"file_path": "%s", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}' \
            "$comma" "$file"
        comma=,
    done
    echo ']}'
} >photos/many.json
runs 0 "$oriel" import photos/many.json --out many --quiet
[ "$(cat stdout.txt stderr.txt | wc -l)" -lt 40 ] || fail "--quiet is not quiet"
grep -q 'and 278 more' stdout.txt || fail "how many are left out is not told"

# No file of this machine is shown through a scene.
cp -r ws linked
mv "linked/images/${names[1]}" secret
ln -s ../../secret "linked/images/${names[1]}"
runs 2 "$oriel" info linked
grep -q 'leads out of the scene' stderr.txt || fail "a link out of the scene is followed"

# Waiting for a writer that never comes is no way to read.
mkfifo fifo.json
runs 1 timeout -s KILL 20 "$oriel" render ws --path fifo.json --out out.dir
exit $failed
