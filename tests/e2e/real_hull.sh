#!/usr/bin/env bash
# What every method shows of a real subject with silhouettes at least: Middlebury's temple.
. "$2/tests/e2e/command_lib"
temple=${ORL_DATASETS:-$source/../shared/datasets}/temple-sparse-ring
[ -d "$temple" ] || { echo "skipped: the temple is not here ($temple)"; exit 77; }
runs 0 "$oriel" import "$temple/templeSR_par.txt" --images "$temple/images" --max-size 320 \
    --silhouettes dark=55 --mesh hull=96 --test-every 8 --out temple
# Nothing is painted behind it, where the photographs show velvet.
runs 0 "$oriel" eval temple --method all --set fill=none --json temple.json
while read -r method least; do
    is=$(awk -v method="\"$method\"," '$1 == "\"method\":" { here = $2 == method }
        $1 == "\"mean\":" && here { mean = 1 } $1 == "\"psnr_db\":" && mean { print $2 + 0; exit }' temple.json)
    awk -v is="$is" -v least="$least" 'BEGIN { exit !(is >= least) }' ||
        fail "$method has $is dB of the temple instead of $least"
done <<'END'
oriel 23.5
airieau 23.1
ulr 22.4
orzan-view 22.7
orzan-surface 21.2
orzan-shadow 21.7
princ 21.6
li 21.2
goldluecke 20.0
END
exit $failed
