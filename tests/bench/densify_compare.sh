#!/usr/bin/env bash
# oriel densify beside whatever other densifier is installed, on the same photographs with
# the same cameras: COLMAP's (with CUDA) and OpenMVS's.
#     tests/bench/densify_compare.sh ORIEL SCENE OUT [TRUTH]
# SCENE is a scene of oriel prepare --keep all, which is only read; workspaces, logs and clouds go to
# OUT. TRUTH is what oriel synth wrote, when SCENE was made of its photographs; then
# CLOUD_TRUTH names the program tests/cloud_truth of the build.
# Depth maps are fused alike (COLMAP, three photographs agreeing); OpenMVS fuses its own.
# ONLY="oriel openmvs" restricts the comparison.
# Held-out photographs take part in nothing but the comparison (oriel eval, airieau with depth guessed in holes).
set -u
[ $# -ge 3 ] || { sed -n '2,11s/^# *//p' "$0"; exit 2; }
oriel=$(realpath "$1") scene=$(realpath "$2") out=$(realpath -m "$3") truth=${4:+$(realpath "$4")}
colmap=${ORIEL_COLMAP:-colmap}
export QT_QPA_PLATFORM=offscreen
mkdir -p "$out"
failed=0

names() { # SPLIT
    sed -n '/"photographs"/,/"left_out"/p' "$scene/scene.json" | awk -v wanted="$1" '
        /"name"/ { name = $0; sub(/.*"name": *"/, "", name); sub(/".*/, "", name) }
        /"split"/ && index($0, "\"" wanted "\"") { print name }'
}

# measure LOG COMMAND...: leaves wall and CPU seconds and peak MiB in $wall, $cpu, $peak.
measure() {
    local log=$1 pid kib line
    shift
    peak=0
    local start=$EPOCHREALTIME
    ( TIMEFORMAT='%U %S'; time "$@" >"$log" 2>&1 ) 2>"$log.time" &
    pid=$!
    # The command is a child of the subshell; its high-water mark only grows.
    while kill -0 $pid 2>/dev/null; do
        for child in $(cat /proc/$pid/task/$pid/children 2>/dev/null); do
            kib=$(awk '/^VmHWM/ { print $2 }' "/proc/$child/status" 2>/dev/null)
            [ "${kib:-0}" -gt "$peak" ] && peak=$kib
        done
        sleep 0.05
    done
    wait $pid
    local status=$?
    wall=$(awk -v a="$start" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.1f", b - a }')
    line=$(tail -n 1 "$log.time")
    cpu=$(echo "$line" | awk '{ printf "%.1f", $1 + $2 }')
    peak=$((peak / 1024))
    return $status
}

# The same files in another folder; links out of a scene are refused.
share() { # FROM TO
    cp -rl "$1" "$2" 2>/dev/null || { rm -rf "$2" && cp -r "$1" "$2"; }
}

# workspace NAME: a fresh one with the scene's photographs and cameras.
workspace() {
    ws=$out/$1
    rm -rf "$ws"
    mkdir -p "$ws/stereo"
    share "$scene/images" "$ws/images"
    share "$scene/sparse" "$ws/sparse"
    cp "$scene/stereo/fusion.cfg" "$ws/stereo/" 2>/dev/null || names train >"$ws/stereo/fusion.cfg"
}

fuse() {
    "$colmap" stereo_fusion --workspace_path "$ws" --output_path "$ws/fused.ply" --input_type \
        geometric --StereoFusion.min_num_pixels 3 --StereoFusion.num_threads 1 \
        >"$ws/fuse.log" 2>&1
}

held_out=$(names test | paste -sd, -)

run_oriel() {
    measure "$ws/densify.log" "$oriel" densify "$ws" ${held_out:+--exclude "$held_out"} && fuse
}

run_colmap() {
    cp "$scene/stereo/patch-match.cfg" "$ws/stereo/" || return
    mkdir -p "$ws/stereo/depth_maps" "$ws/stereo/normal_maps" "$ws/stereo/consistency_graphs"
    measure "$ws/densify.log" "$colmap" patch_match_stereo --workspace_path "$ws" \
        --PatchMatchStereo.geom_consistency 1 && fuse
}

# OpenMVS takes all photographs of the model, so the held-out ones are taken out of it.
run_openmvs() {
    rm -r "$ws/sparse"
    mkdir -p "$ws/sparse" "$ws/mvs"
    if [ -n "$held_out" ]; then
        names test >"$ws/held-out.txt"
        "$colmap" image_deleter --input_path "$scene/sparse" --output_path "$ws/sparse" \
            --image_names_path "$ws/held-out.txt" >"$ws/delete.log" 2>&1 || return
    else
        cp "$scene"/sparse/* "$ws/sparse/"
    fi
    InterfaceCOLMAP -i "$ws" -o "$ws/mvs/scene.mvs" --image-folder "$ws/images" -w "$ws/mvs" \
        >"$ws/interface.log" 2>&1 || return
    measure "$ws/densify.log" DensifyPointCloud -i "$ws/mvs/scene.mvs" \
        -o "$ws/mvs/dense.mvs" -w "$ws/mvs" || return
    cp "$ws/mvs/dense.ply" "$ws/fused.ply"
    rm -r "$ws/sparse"
    share "$scene/sparse" "$ws/sparse"
}

number() { # KEY FILE: in the report's mean
    sed -n '/"mean"/,$p' "$2" | sed -nE "s/.*\"$1\": *([-0-9.e]+).*/\1/p" | head -n 1
}

row() { # NAME
    local name=$1 points accuracy="- - -" psnr=- ssim=-
    printf '%s\n' "$name" >&2
    workspace "$name"
    if ! "run_$name" || [ ! -s "$ws/fused.ply" ]; then
        echo "$name FAILED: see $ws"
        failed=1
        return
    fi
    points=$(head -c 400 "$ws/fused.ply" | LC_ALL=C sed -n 's/^element vertex //p' | tr -d '\r')
    if [ -n "$truth" ]; then
        accuracy=$("${CLOUD_TRUTH:?names the program cloud_truth}" "$ws" "$ws/fused.ply" "$truth" |
            awk '{ print 100 * $4, 100 * $6, 100 * $8 }')
    fi
    if [ -n "$held_out" ]; then
        cp "$scene/scene.json" "$ws/scene.json"
        [ -d "$scene/occluders" ] && share "$scene/occluders" "$ws/occluders"
        cp "$ws/fused.ply" "$ws/points.ply"
        if "$oriel" eval "$ws" --method airieau --set fill=depth --json "$ws/eval.json" >/dev/null 2>"$ws/eval.log"; then
            psnr=$(number psnr_db "$ws/eval.json")
            ssim=$(number ssim "$ws/eval.json")
        else
            failed=1
        fi
    fi
    echo "$name $wall $cpu $peak $points ${accuracy:-- - -} $psnr $ssim"
}

wanted() {
    case " ${ONLY:-$1} " in *" $1 "*) true ;; *) false ;; esac
}
has_cuda() {
    "$colmap" help 2>/dev/null | grep -q "with CUDA"
}
has_openmvs() {
    command -v InterfaceCOLMAP >/dev/null && command -v DensifyPointCloud >/dev/null
}

table=$out/table.txt
{
    echo "densifier wall_s cpu_s peak_MiB points right_% stray_% complete_% psnr_dB ssim"
    wanted oriel && row oriel
    wanted colmap && has_cuda && row colmap
    wanted openmvs && has_openmvs && row openmvs
} >"$table"
awk '$2 == "FAILED:" { print; next } {
    printf "%-10s", $1
    for (i = 2; i <= NF; i++)
        printf " %10s", (i > 5 && $i ~ /^[0-9.]+$/ ? sprintf("%.2f", $i) : $i)
    print ""
}' "$table"
has_cuda || echo "not compared: COLMAP has no CUDA here"
has_openmvs || echo "not compared: OpenMVS (InterfaceCOLMAP, DensifyPointCloud) is not on PATH"
exit $failed
