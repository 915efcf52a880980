#!/usr/bin/env bash
# What the program says of itself, in all its forms, comes from the tables of its commands.
set -u
. "$2/tests/e2e/command_lib"

runs 0 "$oriel" help
for group in make look measure fit; do
    grep -qx "$group" stdout.txt || fail "there is no group $group"
done
grep -q '^  fuse ' stdout.txt && fail "a command that only jobs call is among the others"
commands=$(grep -oE '^  [a-z]+ ' stdout.txt | grep -v version)
for command in $commands calibrate fuse; do
    job=
    [ "$command" != calibrate ] && [ "$command" != fuse ] || job=job
    runs 0 "$oriel" ${job:+"$job"} "$command" --help
    mv stdout.txt help.txt
    runs 0 "$oriel" help "$command"
    cmp -s stdout.txt help.txt || fail "help $command is not what $command --help says"
    grep -q "^usage: oriel ${job:+job }$command" help.txt || fail "$command has no usage"
done
runs 2 "$oriel" help nonsense
runs 2 "$oriel" nonsense
runs 2 "$oriel" fuse scene
runs 0 "$oriel" help job
for command in calibrate fuse; do
    grep -q "^  $command " stdout.txt || fail "help job does not list $command"
done
grep -q '^  render ' stdout.txt && fail "help job lists what is no job's"
runs 2 "$oriel" job
grep -q '^  fuse ' stderr.txt || fail "job alone does not list its commands"
runs 2 "$oriel" job render

# What another option leaves no meaning is refused, before anything is read.
for words in "info x --json --check" "densify x --pass 1" "eval x --walk 3 --path y" "eval x --walk 3 --views 2" \
    "synth figures --out x --truth y"; do
    # shellcheck disable=SC2086
    runs 2 "$oriel" $words
    grep -q "exclude each other\|is of --part\|is an option of monument" stderr.txt || fail "ignores an option: $words"
done

# Every option is in every form.
options=$("$oriel" render --help | grep -oE '^  --[a-z-]+')
for form in man markdown; do
    runs 0 "$oriel" help --as "$form"
    sed 's/\\-/-/g' stdout.txt >"$form"
    for option in $options; do
        grep -q -- "$option" "$form" || fail "$form has no $option"
    done
done
# What shells complete: they ask the program.
for form in bash zsh fish; do
    runs 0 "$oriel" help --as "$form"
    cp stdout.txt "$form"
done
runs 0 "$oriel" help --complete render --
for option in $options; do
    grep -q -- "^$option	." stdout.txt || fail "$option is not completed"
done
runs 0 "$oriel" help --complete render --textures ""
[ "$(cut -f 1 stdout.txt)" = "$(printf 'auto\nfull\nycc\nbc1')" ] || fail "the values of --textures are others"
for line in "nonsense --" "render pho" "render --out x" "job nonsense --"; do
    # shellcheck disable=SC2086
    runs 0 "$oriel" help --complete $line
    [ ! -s stdout.txt ] || fail "there is something for $line"
done
completes() { # WORD.. of the line : expected words
    line=()
    while [ "$1" != : ]; do line+=("$1"); shift; done
    shift
    got=$(PATH=$(dirname "$oriel"):$PATH bash -c '. ./bash; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _oriel "$1"
                   echo "${COMPREPLY[*]}"' - "${line[@]}")
    [ "$got" = "$*" ] || fail "${line[*]}: completes to \"$got\", not \"$*\""
}
completes oriel ren : render
completes oriel job "" : calibrate fuse
completes oriel render --textures b : bc1
completes oriel eval --method orzan-v : orzan-view
completes oriel job fuse --ph : --photographs
completes oriel help tri : trim
completes oriel help --as z : zsh
completes oriel version-of-tomorrow :
completes oriel render : render
! command -v zsh >/dev/null || zsh -n zsh || fail "zsh refuses its completions"
! command -v fish >/dev/null || fish -n fish || fail "fish refuses its completions"
! command -v groff >/dev/null || [ -z "$("$oriel" help --as man | groff -man -ww -z 2>&1)" ] ||
    fail "groff warns of the man page"
# Whoever reads may leave early.
{ sleep 0.5; "$oriel" help --as markdown 2>stderr.txt; echo $? >status.txt; } | true
[ "$(cat status.txt)" = 0 ] && [ ! -s stderr.txt ] || fail "a pipe that is closed early is an error"
exit $failed
