#!/usr/bin/env bash
# The whole road on a small synthetic monument: photographs, scene, held-out comparison,
# a new view; twice the same file.
set -eu
oriel=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Prints the number that a jansson-written file has for "key", in its "mean".
mean() {
    sed -n '/"mean"/,$p' "$1" | sed -nE "s/.*\"$2\": *([-0-9.e]+).*/\1/p" | head -n 1
}
at_least() {
    awk -v value="$2" -v floor="$3" 'BEGIN { exit !(value >= floor) }' || {
        echo "$1 is $2, should be at least $3" >&2
        exit 1
    }
    echo "$1 $2 (at least $3)"
}

cd "$work"
"$oriel" synth monument --out photos --size 384x256 --count 12
# Retrieval is what larger sets get.
"$oriel" prepare photos --out scene --test-list 0004.jpg,0009.jpg --matching retrieval --mesh poisson
"$oriel" info scene --json >info.json
grep -q '"name": *"0012.jpg"' info.json

"$oriel" eval scene --method airieau --json airieau.json --images pictures
"$oriel" eval scene --method points --json points.json
# The default method, with what COLMAP varies below it.
"$oriel" eval scene --json oriel.json
at_least "oriel psnr_db" "$(mean oriel.json psnr_db)" 22
at_least "oriel ssim" "$(mean oriel.json ssim)" 0.8
for key in scene method device size psnr_db psnr_cc_db psnr_covered_db ssim coverage \
    completeness ncc_error render_ms; do
    grep -q "\"$key\"" airieau.json || { echo "eval's JSON lacks $key" >&2; exit 1; }
done
at_least "airieau psnr_db" "$(mean airieau.json psnr_db)" 16
at_least "airieau coverage" "$(mean airieau.json coverage)" 0.5
at_least "airieau above points, dB on covered pixels" \
    "$(awk -v a="$(mean airieau.json psnr_covered_db)" -v p="$(mean points.json psnr_covered_db)" \
        'BEGIN { print a - p }')" 1

# The mesh of the points is a surface as good as the points, within what a small set allows.
"$oriel" eval scene --method orzan-surface --json splats.json
"$oriel" eval scene --method orzan-surface --set proxy=mesh --json mesh.json
at_least "mesh beside splats, dB on covered pixels" \
    "$(awk -v m="$(mean mesh.json psnr_covered_db)" -v s="$(mean splats.json psnr_covered_db)" \
        'BEGIN { print m - s }')" -2
at_least "mesh coverage" "$(mean mesh.json coverage)" 0.5

"$oriel" eval scene --merge fused --truth photos-truth --json radiance.json
at_least "radiance pu21_psnr_db" "$(mean radiance.json pu21_psnr_db)" 16
at_least "radiance mu_psnr_db" "$(mean radiance.json mu_psnr_db)" 20
at_least "stops below 1" "$(awk -v e="$(mean radiance.json log2_rmse)" 'BEGIN { print 1 - e }')" 0

"$oriel" render scene --at 0004.jpg --out a.exr --layers depth,normal,coverage
"$oriel" render scene --at 0004.jpg --out b.exr --layers depth,normal,coverage
cmp a.exr b.exr
"$oriel" render scene --at 0004.jpg --out a.png --layers depth,normal,coverage
"$oriel" render scene --at 0004.jpg --out b.png
"$oriel" render scene --at 0004.jpg --out c.png --exposure 0 --tone srgb
cmp b.png c.png
"$oriel" render scene --at 0004.jpg --out c.png --exposure 1 --tone filmic
if cmp -s b.png c.png; then
    echo "--exposure and --tone change nothing" >&2
    exit 1
fi
[ -s a.depth.png ] && [ -s a.normal.png ] && [ -s a.coverage.png ]
cat >walk.json <<'END'
{"keyframes": [{"photo": "0003.jpg"}, {"photo": "0005.jpg"}, {"photo": "0006.jpg"}], "frames": 4}
END
"$oriel" render scene --path walk.json --out frames --size 160x120
[ "$(ls frames | wc -l)" -eq 4 ]
if command -v ffmpeg >/dev/null; then
    "$oriel" render scene --path walk.json --out walk.mp4 --size 161x121
    [ -s walk.mp4 ] && [ ! -e walk.mp4.frames ]
fi

"$oriel" eval scene --quiet
