#!/usr/bin/env bash
# Calibrates PHOTOS of oriel synth with COLMAP's hierarchical mapper in parts of about LEAF
# photographs, to which OVERLAP of each neighbour are added, and compares the poses with the true
# ones (tests/bench/pose_error.py). Oriel itself asks for parts of 200, COLMAP's overlap is 50.
# usage: parts_of_map.sh ORIEL WORK_DIR PHOTOS LEAF OVERLAP [PREPARE OPTIONS]
#   PHOTOS-truth holds the truth; LEAF 0: COLMAP's mapper, as one part
set -eu
[ $# -ge 5 ] || { sed -n '2,6s/^# *//p' "$0"; exit 2; }
oriel=$(realpath "$1") work=$2 photos=$(realpath "$3") here=$(cd "$(dirname "$0")" && pwd)
export LEAF=$4 OVERLAP=$5
shift 5
mkdir -p "$work"
work=$(realpath "$work") scene=$work/$LEAF-$OVERLAP mapper=hierarchical
[ "$LEAF" != 0 ] || mapper=incremental
cat >"$work/colmap" <<SCRIPT
#!/usr/bin/env bash
[ "\$1" != hierarchical_mapper ] ||
    set -- "\${@:1:\$# - 2}" --leaf_max_num_images "\$LEAF" --image_overlap "\$OVERLAP"
exec "${ORIEL_COLMAP:-colmap}" "\$@"
SCRIPT
chmod +x "$work/colmap"
rm -rf "$scene"
ORIEL_COLMAP=$work/colmap "$oriel" prepare "$photos" --out "$scene" --densifier gl \
    --mapper "$mapper" "$@" >"$scene.log" 2>&1
grep "register\|maps" "$scene.log" || true
echo "parts: $(grep -c '^Loading images\.\.\.' <(sed -n '/ hierarchical_mapper /,/ point_triangulator /p' \
    "$scene/logs/colmap.log")); mapping: $(grep -o '"[a-z_]*\(mapper\|triangulator\|adjuster\)_s": [0-9.]*' \
    "$scene/.oriel/stages.json" | tr '\n' ' ')"
python3 "$here/pose_error.py" "$scene" "$photos-truth"
if [ -e "$scene/scene.json" ]; then
    "$oriel" eval "$scene" --quiet | tail -n 1
fi
