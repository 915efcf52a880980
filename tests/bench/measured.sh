#!/usr/bin/env bash
# Measures Oriel and writes the pages of docs/measured: tables alone, each below the command that
# gave it, with the commit and the device.
#     tests/bench/measured.sh BUILD SCENES DATASETS [SECTION]...
# BUILD is a build folder, which is brought up to date first. SCENES holds prepared scenes, one
# folder each; those in SCENES/unseen are for the section `parts` alone. DATASETS holds the
# photographs; the section `scenes` prepares from them the scenes that are missing. Without SECTION
# all sections are measured, which takes hours on two cores. A section writes the page of its name.
# Work files lie in BUILD/measured. Needs jq.
set -euo pipefail
sections="scenes accuracy charts methods airieau parts stress memory trim radiance web"
[ $# -ge 3 ] || { sed -n '2,9s/^# *//p' "$0"; echo "sections: "$sections; exit 2; }
build=$(realpath "$1") scenes=$(realpath -m "$2") datasets=$(realpath -m "$3")
shift 3
[ $# -gt 0 ] || set -- $sections
source=$(cd "$(dirname "$0")/../.." && pwd)
pages=$source/docs/measured
work=$build/measured
export QT_QPA_PLATFORM=offscreen LC_ALL=C
mkdir -p "$scenes" "$work" "$pages"

# --- commands ---

# run COMMAND [NAME]: runs the command as a page shows it: programs are those of the build, and the
# words BUILD, SCENES, DATASETS, WORK and NAME stand for folders and for a scene.
run() {
    local word words=()
    for word in $1; do
        word=${word//BUILD/$build}
        word=${word//SCENES/$scenes}
        word=${word//DATASETS/$datasets}
        word=${word//WORK/$work}
        [[ $word == tests/* ]] && word=$source/$word
        words+=("${word//NAME/${2:-}}")
    done
    case ${words[0]} in
    oriel) words[0]=$build/oriel ;;
    bench_* | gpu_* | unit_*) words[0]=$build/tests/${words[0]} ;;
    esac
    echo "measuring: ${words[*]}" >&2
    "${words[@]}" </dev/null
}

# Prints the commands for the page.
command_block() {
    printf '\n'
    printf '    %s\n' "$@"
    printf '\n'
}

# Prepared scenes that hold photographs out; with arguments, those of them that are there.
scene_names() {
    local file name
    for file in "$scenes"/*/scene.json; do
        name=$(basename "$(dirname "$file")")
        [ $# -eq 0 ] || [[ " $* " == *" $name "* ]] || continue
        grep -q '"split": "test"' "$file" && echo "$name"
    done
    return 0
}

# for_scenes FILE COMMAND NAME...: one JSON array of what the command gives for each scene.
for_scenes() {
    local file=$1 command=$2 name
    shift 2
    for name in "$@"; do
        run "$command" "$name" >"$work/one.json"
        jq 'if type == "array" then .[] else . end' "$work/one.json"
    done | jq -s . >"$file"
}

# --- tables ---

tables='
def fixed(d): (if . < 0 then "-" else "" end) as $sign
  | (fabs * pow(10; d) | round | tostring) as $t
  | (if ($t | length) <= d then ([range(d + 1 - ($t | length)) | "0"] | add) + $t else $t end) as $u
  | if d == 0 then $sign + $u else $sign + $u[:-d] + "." + $u[-d:] end;
def row: "| " + join(" | ") + " |";
def table(head; rows): (head | row), ([head[] | "---"] | row), (rows | row);
def name: .scene | split("/") | map(select(length > 0)) | last;
def size: map(tostring) | join("x");
# A row for each scene, a column for each method.
def by_method(value; d): group_by(.scene) as $scenes
  | table(["scene"] + [$scenes[0][] | .method + (if (.setting // "") == "" then "" else " " + .setting end)];
          $scenes[] | [(.[0] | name)] + [.[] | value | fixed(d)]);
'
print_table() { # FILE FILTER
    jq -r "$tables $2" "$1"
    printf '\n'
}

# --- pages ---

# head_of TITLE SCENES [JSON]: the page's beginning. JSON: a report, which names the device.
head_of() {
    local device=
    [ $# -lt 3 ] ||
        device=$(jq -r 'if type == "array" then .[0] else . end | .device + "; "' "$3")
    printf '# %s\n\n' "$1"
    printf -- '- Commit: %s\n' "$commit"
    printf -- '- Scenes: %s\n' "$2"
    printf -- '- Device: %s%s, %s cores, load average %s at the start\n' "$device" "$(processor)" "$(nproc)" "$load"
    printf -- '- Date: %s\n' "$(date -u +%F)"
    printf -- '- Made by: `tests/bench/measured.sh BUILD SCENES DATASETS %s`\n' "$section"
}

# Scenes and the larger sides of their photographs, with commas between.
list() {
    local name
    for name in "$@"; do
        jq -r --arg name "$name" '$name + (.stages.undistort.largest // [] | max // "" | if . == "" then "" else " (\(.) px)" end)' "$scenes/$name/scene.json"
    done | paste -sd, | sed 's/,/, /g'
}

processor() {
    sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1
}

# Name and arguments of oriel prepare of each scene.
scene_list() {
    cat <<'END'
fountain DATASETS/fountain-P11/images --test-list 0002.jpg,0005.jpg,0008.jpg
herz DATASETS/Herz-Jesus-P8/images --test-list 0002.jpg,0005.jpg
sceaux DATASETS/sceaux-castle/images --test-list 100_7103.JPG,100_7107.JPG
sakharov DATASETS/sakharov/images --test-every 8
sacre DATASETS/sacre-coeur/images --test-every 8
bronze DATASETS/bronze-head/images --test-every 8 --masks DATASETS/bronze-head/masks
dino DATASETS/dino-sparse-ring/images --test-every 8
temple DATASETS/temple-sparse-ring/images --test-every 8
horns DATASETS/llff-horns/images --test-every 8
dtu DATASETS/dtu-scan24/images --test-every 8
monument WORK/monument --quality draft --test-list 0005.jpg,0012.jpg,0020.jpg
END
}

page_scenes() {
    local name arguments
    while read -r name arguments; do
        [ -e "$scenes/$name/scene.json" ] && continue
        [ "$name" != monument ] || [ -e "$work/monument" ] ||
            run "oriel synth monument --out WORK/monument --size 576x384 --count 24 --quiet" >&2
        run "oriel prepare $arguments --out SCENES/NAME --max-size 512 --quiet" "$name" >&2
    done < <(scene_list)
    for name in $(scene_names); do
        jq --arg scene "$name" '. + {scene: $scene}' "$scenes/$name/scene.json"
    done | jq -s . >"$work/scenes.json"
    head_of "Scenes of the measurements" "$(list $(scene_names))"
    cat <<'END'

Figures of these pages are of these scenes, unless a page names others. `measured.sh` prepares those that are missing; its
function `scene_list` has the arguments of `oriel prepare` for each. *monument* is synthetic (`oriel synth`), the others
are photographs. *Held out* photographs take part in calibration alone. *Spread* is the robust standard deviation of what
photographs show of one point, in stops, before and after their exposures are brought together.

END
    print_table "$work/scenes.json" '
      table(["scene", "prepared by", "photographs", "registered", "held out", "larger side", "points",
             "spread before", "spread after"];
        .[] | [.scene, .made_by, (.counts.given | tostring), (.counts.registered | tostring),
               (.counts.test | tostring), (.stages.undistort.largest | max | tostring),
               (.counts.points | tostring)] +
              [.stages.expose.spread_before_ev, .stages.expose.spread_after_ev
               | if . == null then "-" else fixed(2) end])'
    for name in $(scene_names); do
        jq --arg scene "$name" '[.stages | to_entries[] | . + {scene: $scene}]' "$scenes/$name/scene.json"
    done | jq -s add >"$work/prepare.json"
    cat <<'END'
**Time of `oriel prepare`** for each stage, as `oriel info` prints it: seconds of wall time, seconds of processor time with
COLMAP's, and the largest memory of a process so far in MiB. Other work may have run beside it.

END
    print_table "$work/prepare.json" '
      def cell: if . == null then "-" else [.value | .wall_s, .cpu_s, ([.peak_rss_mib, .child_peak_rss_mib] | max)]
        | map(if . == null then "-" else fixed(0) end) | join(", ") end;
      group_by(.scene) as $s | ([$s[0][].key] - ["collect"]) as $stages
      | table(["scene"] + $stages; $s[] | . as $of
          | [.[0].scene] + [$stages[] as $k | [$of[] | select(.key == $k)][0] | cell])'
}

page_accuracy() {
    local all='oriel eval SCENES/NAME --method paired --quiet --json -'
    for_scenes "$work/accuracy.json" "$all" $(scene_names)
    head_of "Accuracy" "$(list $(scene_names))" "$work/accuracy.json"
    cat <<'END'

Held-out photographs, rendered from the others; means over the photographs of a scene. The
[metrics](../reference/metrics.md) are over the whole picture, holes included, unless they say otherwise. The methods of
papers have two columns: as the paper has them, and *on the proxy of oriel*, with its depth and background. `oriel` and
`oriel-high` alone take the options that `prepare` [found on training photographs](../how/pipeline.md#what-suits-the-scene).
END
    command_block "$all"
    printf '**PSNR in dB, whole pictures**\n\n'
    print_table "$work/accuracy.json" 'by_method(.mean.psnr_db; 2)'
    printf '**SSIM, whole pictures**\n\n'
    print_table "$work/accuracy.json" 'by_method(.mean.ssim; 3)'
    printf '**Crumbs of 10,000 pixels**\n\n'
    print_table "$work/accuracy.json" 'by_method(.mean.crumbs; 1)'
    printf '**PSNR in dB, pixels that geometry and a photograph cover**\n\n'
    print_table "$work/accuracy.json" 'by_method(.mean.psnr_covered_db; 2)'
    printf '**Share of these pixels, in %%**\n\n'
    print_table "$work/accuracy.json" 'by_method(100 * .mean.coverage; 0)'
    printf '**PSNR in dB after an affine fit of colours, whole pictures**\n\n'
    print_table "$work/accuracy.json" 'by_method(.mean.psnr_cc_db; 2)'
}

page_charts() {
    local name chart='oriel chart'
    for name in $(scene_names fountain temple); do
        chart+=" SCENES/$name"
    done
    chart+=' --out WORK/chart --quick --quiet'
    run "$chart" >&2
    cp "$work/chart/chart.svg" "$pages/charts.svg"
    head_of "All methods over two scenes" "$(list $(scene_names fountain temple))" "$work/chart/chart.json"
    cat <<'END'

All methods on two held-out photographs of each of two scenes, at half their size: a wall, and a small subject before
black. What options are worth is on [another page](parts.md). `cpu ms` is the processor time of a frame, the geometric
mean over the scenes; the figure has the wall time, which other work on the machine lengthens. *Front*: no other row is
both faster, by processor time, and better by PSNR. `sd` is the standard deviation over the scenes. A time is of few
frames and scatters by up to 15 % beside other programs. *Completeness* takes every black pixel for a missing one. The two
photographs of *temple* are themselves black in 12 and 35 % of their pixels, so that a method that draws what is behind
the temple right has less than 1, and one that fills it with other colours has 1. `oriel` and `oriel-high` alone take the
options that `prepare` [found on training photographs](../how/pipeline.md#what-suits-the-scene). The views of a quick
walk lie far apart: of *temple* a tenth of the pixels can be compared, so that its flicker is that of a few blocks.
[Columns](../reference/chart.md).
END
    command_block "$chart"
    printf '![PSNR against the time of a frame, means over the scenes](charts.svg)\n\n'
    # Rows over all scenes in the order of their time, with `front` by processor time.
    local overall='.overall | sort_by(.cpu_ms, -.mean.psnr_db) | reduce .[] as $r ({rows: [], best: -1};
        ($r.mean.psnr_db > .best) as $better
        | .rows += [$r + {front: (if $better then "front" else "" end)}]
        | if $better then .best = $r.mean.psnr_db else . end) | .rows'
    printf '**Methods as they are**, and those of papers with the depth and background of `oriel`\n\n'
    print_table "$work/chart/chart.json" "($overall)"' as $rows
      | table(["method", "PSNR, dB", "sd", "colours fitted, dB", "covered, dB", "SSIM", "FLIP", "completeness", "flicker",
               "cpu ms", "device, MiB", ""];
        .overall[] | .method as $m | .setting as $s | select($s == "" or ($s | startswith("on the ")))
          | ["`" + .method + "` " + $s, (.mean.psnr_db | fixed(2)), (.sd.psnr_db | fixed(2)), (.mean.psnr_cc_db | fixed(2)),
             (.mean.psnr_covered_db | fixed(2)), (.mean.ssim | fixed(4)), (.mean.flip | fixed(4)),
             (.mean.completeness | fixed(3)), (.flicker | fixed(2)), (.cpu_ms | fixed(0)),
             (.device_bytes / 1048576 | fixed(0)), ([$rows[] | select(.method == $m and .setting == $s)][0].front)])'
    printf '**PSNR in dB and SSIM of each scene**\n\n'
    print_table "$work/chart/chart.json" '
      [.scenes[].name] as $names | .rows as $rows
      | table(["method"] + $names;
          .overall[] | select(.setting == "") | .method as $m | ["`" + $m + "`"] + [$names[] as $n
            | [$rows[] | select(.scene == $n and .method == $m and .setting == "")][0].mean
            | (.psnr_db | fixed(2)) + ", " + (.ssim | fixed(3))])'
    printf '**Processor time of a frame of each scene**, ms\n\n'
    print_table "$work/chart/chart.json" '
      [.scenes[].name] as $names | .rows as $rows
      | table(["method"] + $names;
          .overall[] | select(.setting == "") | .method as $m | ["`" + $m + "`"] + [$names[] as $n
            | [$rows[] | select(.scene == $n and .method == $m and .setting == "")][0].cpu_ms | fixed(0)])'
}

# A row for each method on a scene, with these options: accuracy from eval, processor time and memory of
# the device from bench, in a process of its own, since what a method asked for stays on the device.
method_rows() {
    local scene=$1 options=$2 method unit=
    "$build/oriel" methods | awk '/^[a-z][a-z-]*  / {print $1}' | while read -r method; do
        run "oriel eval $scene --method $method $options --quiet --json -" \
            >"$work/one.json" 2>>"$work/methods.log" &&
            run "oriel bench $scene --method $method $options $methods_bench --quiet --json -" \
                >"$work/two.json" 2>>"$work/methods.log" || { echo "| \`$method\` | - | - | - | - | - |"; continue; }
        [ -n "$unit" ] || unit=$(jq '.sizes[0].cpu_ms' "$work/two.json")
        jq -rs --arg m "$method" --argjson u "$unit" "$tables"'
            ["`\($m)`", (.[0].mean.psnr_db | fixed(2)),
             (.[0].mean | if .coverage > 0 then .psnr_covered_db | fixed(2) else "-" end), (.[0].mean.ssim | fixed(3)),
             (.[1].sizes[0].cpu_ms / $u | fixed(2)), (.[1].sizes[0].device_bytes / 1048576 | fixed(0))]
            | row' "$work/one.json" "$work/two.json"
    done
}

method_table() { # SCENE OPTIONS
    printf '\n**%s**%s\n\n' "$(basename "$1")" "${2:+, with \`$2\`}"
    printf '| method | PSNR, dB | covered, dB | SSIM | time | memory, MiB |\n|---|---|---|---|---|---|\n'
    method_rows "$1" "$2"
}

page_methods() {
    local synth='oriel synth figures --out WORK/figures --cameras 8 --size 320x240 --quiet'
    local import='oriel import WORK/figures --masks WORK/figures/masks --background WORK/figures/background --mesh hull=64,5000 --test-list cam02,cam05 --out WORK/figure --quiet'
    local methods_bench='--size 512x512 --seconds 1 --frames 8'
    local outlines=(
        'oriel import DATASETS/temple-sparse-ring/templeSR_par.txt --images DATASETS/temple-sparse-ring/images --silhouettes dark=55 --mesh hull --test-every 8 --max-size 400 --out WORK/temple --quiet'
        'oriel import DATASETS/dino-sparse-ring/dinoSR_par.txt --images DATASETS/dino-sparse-ring/images --silhouettes dark=55 --mesh hull --test-every 8 --max-size 400 --out WORK/dino --quiet'
        'oriel import DATASETS/inria-dancer8/cameras.json --images DATASETS/inria-dancer8/images --masks DATASETS/inria-dancer8/masks --mesh hull --test-list cam02_00023_0000008550.png,cam05_00023_0000008550.png --max-size 400 --out WORK/dancer --quiet'
    )
    local scene command
    scene=$(scene_names fountain)
    rm -rf "$work/figures" "$work/figure"
    run "$synth" >&2
    run "$import" >&2
    for command in "${outlines[@]}"; do
        rm -rf "$work/$(sed -E 's/.*--out WORK.([a-z]+).*/\1/' <<<"$command")"
        run "$command" >&2
    done
    run "oriel eval SCENES/NAME --method points --quiet --json -" "$scene" >"$work/methods.json"
    head_of "All methods on five scenes" "$(list "$scene") and four that the commands below make" "$work/methods.json"
    cat <<'END'

Accuracy is that of held-out photographs, over whole pictures; *covered* is that of pixels that geometry and a
photograph cover. Time is processor time of a frame of 512x512 relative to the first row; memory is that of the device with everything that the method asked for. A dash: the method asks
for something that the scene lacks. The figure has silhouettes, a hull as a mesh and no points, so that `points` shows
the background alone; there all methods paint the room behind it, as `li` does. The last three scenes, too, have known
cameras, silhouettes and their hull, and no points; behind temple and dino nothing is painted, though the photographs
show velvet there, which is most of the error. Figures of different scenes are of different things.
END
    command_block "$synth" "$import" "${outlines[@]}" 'oriel eval SCENE --method METHOD --quiet --json -' \
        "oriel bench SCENE --method METHOD $methods_bench --quiet --json -"
    method_table "SCENES/$scene" ""
    method_table WORK/figure "--set fill=room"
    method_table WORK/temple "--set fill=none"
    method_table WORK/dino "--set fill=none"
    method_table WORK/dancer "--set fill=room"
}

page_airieau() {
    local eval='oriel eval SCENES/NAME --method airieau --quiet --json -' own='bench_own_place SCENES/NAME' name
    for name in $(scene_names fountain herz sceaux sakharov sacre bronze dino temple); do
        for command in "$eval" "$own"; do
            run "$command" "$name"
        done | jq -s '{scene: .[0].scene, device: .[0].device, mean: .[0].mean, own: .[1]}'
    done | jq -s . >"$work/airieau.json"
    head_of "Airieau's method as the paper has it" "$(list $(scene_names fountain herz sceaux sakharov sacre bronze dino temple))" "$work/airieau.json"
    cat <<'END'

Method `airieau`: held-out photographs, whole pictures; and views at the places of the training photographs, all
photographs in use, against these, over covered pixels: the paper says that such a view is the photograph. Where that is
not so (*least* of sacre and sceaux), leaves or people stand before the photographer, and are left out on purpose.
END
    command_block "$eval" "$own"
    print_table "$work/airieau.json" '
      table(["scene", "PSNR, dB", "SSIM", "covered PSNR, dB", "own place, dB", "least", "covered, %"];
        .[] | [name, (.mean.psnr_db | fixed(2)), (.mean.ssim | fixed(3)), (.mean.psnr_covered_db | fixed(2)),
               (.own.mean_db | fixed(1)), (.own.min_db | fixed(1)), (100 * .own.coverage | fixed(0))])'
}

page_parts() {
    local part_scenes=($(scene_names)) others=()
    local name
    for name in "$scenes"/unseen/*/scene.json; do
        [ ! -e "$name" ] || others+=("unseen/$(basename "$(dirname "$name")")")
    done
    run "oriel eval SCENES/${part_scenes[0]} --method points --quiet --json -" >"$work/device.json"
    head_of "What each part is worth" "$(list ${part_scenes[*]} ${others[*]})" "$work/device.json"
    cat <<'END'

Held-out photographs by method `oriel`, whole pictures, with one rule left out: how much PSNR in dB and how many
thousandths of SSIM that loses (below 0: gains), the mean over the scenes, how many crumbs of 10,000 pixels it adds, and
the processor time of a frame as a share of that with the rule. [Options](../reference/options.md) says what each rule does.
The last two rows leave out what stages of `oriel prepare` found: `--adapt none`, the `sharpness` of a scene for which
another than the usual one proved better, and `--occluders none`, what single photographs show before the scene.
How many photographs a pixel blends, `sharpness` and the cells of `guess_depths` were chosen on scenes of this table.
Where `alignment` costs, the exposure of the held-out photographs is guessed badly.
END
    command_block "tests/bench/worth.sh oriel SCENES/..."
    run "tests/bench/worth.sh $build/oriel ${part_scenes[*]/#/SCENES/}"
    if [ ${#others[@]} -gt 0 ]; then
        cat <<'END'

## Scenes on which no rule was chosen

No constant in the table was chosen on these photographs: from a drone over a shore (brighton,
pierotofy/drone\_dataset\_brighton\_beach), of a castle's yard with a tractor (castle-P30 and castle-P19) and its gate
(entry-P10, all three Strecha 2008), of a walk along a street (lund, mapillary/OpenSfM) and of a hollow trunk, with a
telephone (monstree, alicevision/dataset\_monstree). Each was prepared with `--max-size 640`, every eighth photograph held
out; brighton and castle-P19 every sixth. The depth range of stereo and the order of soft splats and specks were judged on
castle-P30, the search for the ground on castle-P30 and lund, the choice of photographs for guessed depth on a hollow trunk.
END
        command_block "tests/bench/worth.sh oriel SCENES/unseen/..."
        run "tests/bench/worth.sh $build/oriel ${others[*]/#/SCENES/}"
    fi
    cat <<'END'

## Soft splats

Held-out photographs at half of the scenes' size, PSNR in dB and crumbs per 10,000 pixels: by the points, by `oriel` without
[soft splats](../how/oriel.md#soft-splats), with the shares `soft` and `soft_mix` that `refine` finds, and by the splats alone. MiB: of
the splats' file. Seconds are of the processor; `prepare` is at the scenes' own size, at which `refine` takes up to four times
as long. Frame: its processor time as a share of that without splats.
END
    command_block "tests/bench/soft.sh oriel 2 SCENES/..."
    run "tests/bench/soft.sh $build/oriel 2 ${part_scenes[*]/#/SCENES/} ${others[*]/#/SCENES/}"
}

# The matrix of a report of oriel stress: dB lost at worst, and where 3 dB are lost.
stress_matrix() { # FILE
    print_table "$1" '. as $r
      | def level($axis): if . == null then "never" else "at " + (. * 100 | round / 100 | tostring) end;
      table(["what gets worse", "from", "to"] + [.methods[] | "`" + . + "`"];
        .axes[] | . as $a
        | [.title, (.levels[0] | tostring),
           ([$r.rows[] | select(.axis == $a.name)][-1].level | tostring) + " " + .unit] +
          [$r.methods[] as $m
           | [$r.losses[] | select(.axis == $a.name and .method == $m)][0]
           | if . == null then "-" else (.lost_db | fixed(1)) + ", " + (.at[1] | level($a)) end])'
}

page_stress() {
    local synth='oriel stress synth --out WORK/stress/synth --views 1 --quiet'
    local real='oriel stress SCENES/NAME --out WORK/stress/NAME --axes photographs,angle --views 1 --quiet'
    local pairs='oriel stress synth --out WORK/stress/paired --axes outliers,pose,angle --views 1 --method oriel,airieau,ulr,orzan-view,li,paired --quiet'
    local name report=$work/stress/synth/stress.json
    run "$synth" >&2
    run "$pairs" >&2
    head_of "How much methods lose" "synthetic, $(list $(scene_names fountain sakharov temple))" "$report"
    cat <<'END'

One thing at a time gets worse, in six severities ([axes](../reference/stress.md#axes)). A cell says how many dB of PSNR
the worst severity costs, and where 3 dB are lost. A method that has little to lose loses little: the table below
says where each begins. [Failure modes](../how/failure-modes.md) says why. At 8 px silhouettes have no place in common, and
with fewer than a third of the photographs of a vehicle stereo finds nothing: these rows end at the severity before.
END
    command_block "$synth"
    stress_matrix "$report"
    printf '**Weights of papers on the proxy of `oriel`** (`+oriel`), beside the same methods as they are\n'
    command_block "$pairs"
    stress_matrix "$work/stress/paired/stress.json"
    printf '**The unchanged scene**: PSNR in dB, SSIM, FLIP and flicker\n\n'
    print_table "$report" '
      [.rows[] | select(.axis == "photographs" and .severity == 0)] as $rows
      | table(["method", "PSNR", "SSIM", "FLIP", "flicker"];
          $rows[] | ["`" + .method + "`", (.mean.psnr_db | fixed(2)), (.mean.ssim | fixed(3)),
                     (.mean.flip | fixed(3)), (.flicker | fixed(2))])'
    printf '**Flicker at the worst severity**, mean difference of blocks; none where no block shows one surface in both frames\n\n'
    print_table "$report" '. as $r
      | table(["what gets worse"] + [.methods[] | "`" + . + "`"];
          .axes[] | . as $a
          | [.title] + [$r.methods[] as $m
              | [$r.rows[] | select(.axis == $a.name and .method == $m)][-1]
              | .flicker | if . == null then "-" else fixed(1) end])'
    for name in $(scene_names fountain sakharov temple); do
        run "$real" "$name" >&2
        printf '**Photographs of scene `%s`**\n' "$name"
        command_block "${real//NAME/$name}"
        stress_matrix "$work/stress/$name/stress.json"
    done
}

page_memory() {
    local bench="oriel bench SCENES/NAME --size 768x512 --seconds 1 --textures KIND --quiet --json -"
    local eval="oriel eval SCENES/NAME --textures KIND --quiet --json -"
    local kind name
    name=$(scene_names fountain)
    for kind in full ycc bc1; do
        run "${bench/KIND/$kind}" "$name" >"$work/memory_bench.json"
        run "${eval/KIND/$kind}" "$name" >"$work/memory_eval.json"
        jq -s --arg kind "$kind" '.[0] + {kind: $kind, mean: .[1].mean}' "$work/memory_bench.json" \
            "$work/memory_eval.json"
    done | jq -s . >"$work/memory.json"
    head_of "Memory" "$(list "$name")" "$work/memory.json"
    printf '\nMemory on the device after frames of 768x512 of scene `%s`, in MiB, and what compressed photographs\n' \
        "$name"
    printf 'cost in accuracy and time.\n'
    command_block "$bench" "$eval"
    print_table "$work/memory.json" '
      def owner($o): [.memory[] | select(.owner == $o) | .bytes] | add // 0 | . / 1048576 | fixed(1);
      table(["textures", "points", "photographs", "frame", "whole process", "PSNR, dB", "SSIM", "frame, ms"];
        .[] | [.kind, owner("points"), owner("photographs"), owner("frame"),
               (.host_peak_bytes / 1048576 | fixed(0)), (.mean.psnr_db | fixed(2)),
               (.mean.ssim | fixed(3)), (.sizes[0].frame_ms | fixed(0))])'
}

page_trim() {
    local trim='oriel trim SCENES/NAME --out WORK/trimmed/NAME --views 6 --size-divide 2 --budget 200 --quiet --json WORK/trimmed/NAME.json'
    local name
    mkdir -p "$work/trimmed"
    for name in $(scene_names fountain temple); do
        rm -rf "$work/trimmed/$name"
        run "$trim" "$name" >"$work/trimmed/$name.txt"
        jq --arg scene "$name" '. + {scene: $scene}' "$work/trimmed/$name.json"
    done | jq -s . >"$work/trim.json"
    head_of "Trimming" "$(list $(scene_names fountain temple))" "$work/trim.json"
    cat <<'END'

What `oriel trim` leaves of a scene within 0.1 dB of mean PSNR and 0.01 of SSIM over training photographs, each rendered
without itself, and no photograph worse by more than 0.5 dB; pictures are compared at half their size. *Model*: points
and photographs on the device. The time of a frame is processor time on a software renderer, the whole scene and the
trimmed one drawn in turns. Held-out photographs confirm the result and decide nothing.
END
    command_block "$trim"
    jq -r '.[] | select(.complete | not) | "The time ended the search of *\(.scene)*."' "$work/trim.json"
    printf '\n'
    print_table "$work/trim.json" '
      def mib: . / 1048576 | fixed(2);
      def model: .point_bytes + .photo_bytes;
      table(["scene", "points", "photographs", "model, MiB", "times smaller", "all on the device, MiB", "files, MiB",
             "frame, ms", "training, dB", "SSIM", "worst loss, dB", "held out, dB", "SSIM"];
        .[] | . as $t | (["before", "after"][] | . as $when | $t[$when]
          | [$t.scene + ", " + $when, (.points | tostring), (.photographs | tostring), (model | mib),
             (($t.before | model) / model | fixed(1)), (.device_bytes | mib), (.file_bytes | mib),
             (.frame_ms | fixed(0)), (.psnr_db | fixed(2)), (.ssim | fixed(3)), (.worst_loss_db | fixed(2)),
             (.held_psnr_db | fixed(2)), (.held_ssim | fixed(3))]))'
    printf '**Steps that were taken**: loss of each in dB against MiB of the model after it\n\n'
    print_table "$work/trim.json" '
      table(["scene", "step", "loss, dB", "all, dB", "model, MiB", "frame, ms"];
        .[] | .scene as $scene | .steps[] | select(.taken)
          | [$scene, .what, (.loss_db | fixed(3)), (.total_loss_db | fixed(3)), (.bytes / 1048576 | fixed(2)),
             (.ms | fixed(0))])'
}

# Mean of the views of what bench_radiance_error prints.
radiance_rows() {
    awk '{ m = 2; while ($m != "median") m++
           what = $2; for (i = 3; i < m - 1; i++) what = what " " $i
           if (!(what in count)) order[++kinds] = what
           count[what]++; rmse[what] += $(m - 1); median[what] += $(m + 1); most[what] += $(m + 3)
           away[what] += $(m + 9); dark[what] += $(m + 15) }
         END { for (k = 1; k <= kinds; k++) { w = order[k]; n = count[w]
               printf "| %s | %.2f | %.3f | %.2f | %.2f | %.2f |\n", w, rmse[w] / n, median[w] / n, most[w] / n,
                      away[w] / n, dark[w] / n } }' "$1"
}

page_radiance() {
    local synth='oriel synth monument --out WORK/series --size 384x256 --count 24 --contrast 8 --exposures -3,0,3 --noise 0.01 --quiet'
    local truth='bench_truth_scene WORK/series WORK/series-truth WORK/series-scene 1 5'
    local error='bench_radiance_error WORK/series-scene WORK/series-truth --bound'
    local cost='bench_merge_time WORK/series-scene'
    local again_synth='oriel synth monument --out WORK/found --size 384x256 --count 15 --contrast 3 --exposures -3,0,3 --quiet'
    local prepare='oriel prepare WORK/found --out WORK/found-scene --test-list 0008.jpg --quiet'
    local found='bench_radiance_error WORK/found-scene WORK/found-truth'
    [ -e "$work/series" ] || run "$synth" >&2
    [ -e "$work/series-scene" ] || run "$truth" >&2
    run "$error" >"$work/radiance.txt"
    [ -e "$work/found" ] || run "$again_synth" >&2
    [ -e "$work/found-scene" ] || run "$prepare" >&2
    run "$found" >"$work/radiance_found.txt"
    run "$cost" >"$work/merge_time.txt"
    local scene again
    scene=$(scene_names fountain)
    again='tests/bench/reexpose.sh BUILD/oriel BUILD/tests/bench_reexpose_photos SCENES/NAME WORK/reexposed'
    run "${again//BUILD/$build}" "$scene" >&2
    jq -s '[.[0] + {row: "one exposure, not re-exposed"}, .[1] + {row: "three series, `fused`"},
            .[2] + {row: "three series, `series`"}]' "$work/reexposed/single.json" \
        "$work/reexposed/fused.json" "$work/reexposed/series.json" >"$work/radiance.json"
    head_of "Radiance" "synthetic monument, $scene" "$work/radiance.json"
    cat <<'END'

**Against true radiance.** A synthetic monument in three series, with true cameras and points. Errors are differences
of log2, in stops, over covered pixels; means over the held-out views. Away from edges is more than 2 pixels from a
step of one stop between neighbouring pixels of the truth; the last column has the dark ones of these. The rows that name the truth say how large the error of
the true picture itself is when it is moved by a part of a pixel.
END
    command_block "$synth" "$truth" "$error"
    local head='| picture | RMSE | median | 90 %% below | RMSE away from edges | below 1/64 of white |\n|---|---|---|---|---|---|\n'
    printf "$head"
    radiance_rows "$work/radiance.txt"
    printf '\n**With cameras and points that were found** in the photographs, so that their errors count, too\n'
    command_block "$again_synth" "$prepare" "$found"
    printf "$head"
    radiance_rows "$work/radiance_found.txt"
    printf '\n**Time of both merges**, processor time of a view\n'
    command_block "$cost"
    sed 's/^/    /' "$work/merge_time.txt"
    printf '\n**Real photographs** of scene `%s`, re-exposed by -2, 0 and +2 EV in turn with noise; held-out\n' "$scene"
    printf 'photographs as they were.\n'
    command_block "$again"
    print_table "$work/radiance.json" 'table(["", "PSNR, dB", "covered PSNR, dB", "SSIM"];
        .[] | [.row, (.mean.psnr_db | fixed(2)), (.mean.psnr_covered_db | fixed(2)), (.mean.ssim | fixed(3))])'
}

page_web() {
    local measure='/usr/bin/python3 tests/web/measure.py BUILD SCENES/NAME --views 3 --json WORK/web.json'
    local live='/usr/bin/python3 tests/web/measure_live.py BUILD SCENES/NAME --frames 120 --json WORK/web.json'
    local walk='/usr/bin/python3 tests/web/measure_walk.py BUILD SCENES/NAME --rate 2 --json WORK/web.json'
    local visit='/usr/bin/python3 tests/web/measure_visit.py BUILD SCENES/monument'
    local kind name command names=$(scene_names fountain herz sceaux bronze temple monument dtu)
    for kind in measure live walk; do
        for name in $names; do
            [ $kind = measure ] || [[ " fountain temple monument " == *" $name "* ]] || continue
            command=${!kind}
            run "$command" "$name" >&2
            cat "$work/web.json"
        done | jq -s . >"$work/web_$kind.json"
    done
    head_of "The published page beside the renderer" "$(list $names)"
    cat <<'END'

The page is drawn by headless Chromium on SwiftShader, the server's frames by Mesa's llvmpipe.
END
    command_block "$measure"
    cat <<'END'
publishes a scene, draws up to three held-out cameras and compares the pictures with the photographs and with those of
`oriel render`. Both show the scene's exposure, not that of each photograph, so the figures of both lie below those of
`oriel eval`. *First picture* is what must be loaded before the page shows points: page, poster, manifest, coarse points.
Graphics memory is of a window of 1280x800 pixels. Processor time of a frame of the photograph's size is of all processes
of the browser.

END
    print_table "$work/web_measure.json" '
      table(["scene", "cameras", "page: PSNR, dB, and SSIM", "renderer", "page to renderer", "the worst, dB"];
        .[] | [.scene, (.views | tostring)] + [range(3) as $k | (.mean[2 * $k] | fixed(2)) + ", " + (.mean[2 * $k + 1] | fixed(3))]
          + [.worst_db | fixed(1)])'
    print_table "$work/web_measure.json" '
      table(["scene", "first picture, MB", "whole site, MB", "graphics memory, MB", "frame moving, ms", "at rest, ms",
             "moving to points only"];
        .[] | [.scene, (.first_mb | fixed(2)), (.whole_mb | fixed(1)), (.graphics_mb | fixed(0)), (.moving_ms | fixed(0)),
               (.rest_ms | fixed(0)), (.moving_ms / .points_ms | fixed(2))])'
    cat <<'END'
What remains between page and renderer is in single pixels at outlines, where one or the other comparison falls out
otherwise, and in the JPEG files of the page, of quality 95.

## A visit
END
    command_block "$visit"
    cat <<'END'
opens the published page in windows of three sizes. Times count from the request for the page: when the browser first paints
(the poster), when the graphics have finished the picture that takes the poster's place, and when everything is loaded and
drawn sharply. In brackets: processor time of all processes of the browser. The browser runs already. Bytes are those of
everything; frame time is that of a moving picture to points alone. Below the table: how much longer a frame of `oriel walk`
takes when two clients ask at once, and how soon a page notices that its server was killed and that another one listens.

| window | first paint | first picture | whole | bytes | memory | frame to points only |
|---|---|---|---|---|---|---|
END
    run "$visit" >"$work/web_visit.txt"
    grep '^|' "$work/web_visit.txt"
    printf '\n'
    grep -v '^|\|^load' "$work/web_visit.txt" | sed 's/^/    /'
    printf '\nWithout a graphics chip, what bounds the first picture is that the browser makes each program of the frame anew.\n'
    printf '\n## The server\n'
    command_block "$live"
    cat <<'END'
walks past all photographs of a scene through `oriel walk`, 640x427 pixels a frame, and asks for the next frame when one
has come. Processor time is that of all threads of the server.

END
    print_table "$work/web_live.json" '
      table(["scene", "frames", "median of a frame, processor time, ms", "first frame to median", "longest frame to median",
             "frames above 1.5 times the median"];
        .[] | [.scene, (.frames | tostring), (.processor_median_ms | fixed(0)), (.processor_first_to_median | fixed(2)),
               (.processor_longest_to_median | fixed(2)), (.processor_above_1_5 | tostring)])'
    printf '## A walk of two minutes\n'
    command_block "$walk"
    cat <<'END'
walks past all photographs and back through `oriel walk`, two views for each of 120 seconds, without standing still,
and looks for pops (the change from a frame to the next, as a multiple of the largest of the changes around it), black
frames, and growth of the server's memory. Changes are means of 160x107 grey pixels.

END
    print_table "$work/web_walk.json" '
      table(["scene", "photographs", "frames", "median change, of 255", "largest", "largest to those around it", "black frames",
             "memory there and back, MiB"];
        .[] | [.scene, (.photographs | tostring), (.frames | tostring), (.median | fixed(1)), (.largest | fixed(1)),
               (.pop | fixed(2)), (.black | tostring), ([.there_mib, .back_mib] | map(fixed(0)) | join(", "))])'
}

# --- all that is asked for ---

for section in "$@"; do
    declare -F "page_$section" >/dev/null || { echo "no section $section; there are:" $sections; exit 2; }
done
cmake --build "$build" >"$work/build.log" 2>&1 || { tail -n 20 "$work/build.log"; exit 1; }
# The commit that last changed the program, and a plus if files differ from it.
parts=(src shaders preprocess datasets cmake CMakeLists.txt)
commit=$(git -C "$source" describe --always \
    "$(git -C "$source" log -1 --format=%H -- "${parts[@]}")")
git -C "$source" diff --quiet HEAD -- "${parts[@]}" || commit=$commit+
for section in "$@"; do
    load=$(cut -d ' ' -f 1 /proc/loadavg)
    "page_$section" | cat -s >"$work/$section.md"
    # What a command prints must not get into the page unasked.
    [ "$(head -c 2 "$work/$section.md")" = '# ' ] ||
        { echo "$work/$section.md does not begin with a title" >&2; exit 1; }
    mv "$work/$section.md" "$pages/$section.md"
    echo "wrote docs/measured/$section.md" >&2
done
