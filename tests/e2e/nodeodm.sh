#!/usr/bin/env bash
# contrib/nodeodm: the requests that WebODM and ClusterODM make of a node, with a task that ends, one
# that is cancelled and what is refused.
. "$(dirname "$0")/command_lib"
/usr/bin/python3 -c 'import flask' 2>/dev/null || { echo "python3-flask is not installed"; exit 77; }
command -v curl >/dev/null && command -v colmap >/dev/null || { echo "curl or colmap is missing"; exit 77; }
"$oriel" synth monument --out photos --size 288x192 --count 8 --quiet || exit 1
/usr/bin/python3 -B "$source/contrib/nodeodm/oriel_node.py" --port 0 --data data --oriel "$oriel" \
    --token secret >node.txt 2>&1 &
node=$!
trap 'kill $node; wait $node 2>/dev/null; rm -rf "$work"' EXIT
for ((i = 0; i < 100; i++)); do
    url=$(sed -n 's/.*Running on \(http[^ ]*\).*/\1/p' node.txt)
    [ -z "$url" ] || break
    sleep 0.2
done
[ -n "$url" ] || { fail "the node does not start"; cat node.txt; exit 1; }

# ask PATH [CURL OPTIONS]: the answer is in answer.json.
ask() {
    local path=$1
    shift
    curl -s "$url/$path?token=secret" "$@" >answer.json || fail "no answer to $path"
}
# is JQ-CONDITION
is() {
    jq -e "$1" answer.json >/dev/null || { fail "not so: $1"; cat answer.json >&2; }
}
status() {
    ask "task/$1/info"
    jq -r .status.code answer.json
}

[ "$(curl -s -o /dev/null -w '%{http_code}' "$url/info")" = 401 ] || fail "a request without the token"
ask info
is '.version == "2.2.1" and .engine == "oriel" and .taskQueueCount == 0 and .maxImages == null'
ask options
is 'map(.name) | index("quality")'
is 'all(has("type") and has("value") and has("domain") and has("help"))'

# A task as WebODM sends it: begun, filled in several requests, committed.
ask task/new/init -F name=arch -F 'options=[{"name":"quality","value":"draft"},{"name":"max-size","value":192}]' \
    -H 'set-uuid: 11111111-2222-3333-4444-555555555555'
is '.uuid == "11111111-2222-3333-4444-555555555555"'
uuid=$(jq -r .uuid answer.json)
for photo in photos/*; do
    ask "task/new/upload/$uuid" -F "images=@$photo"
    is .success
done
ask "task/new/commit/$uuid" -X POST
is ".uuid == \"$uuid\""

# Another one in one request, cancelled and removed.
ask task/new -F name=other -F images=@"$(ls photos/* | head -1)" -F "images=@$(ls photos/* | tail -1);filename=../../up.png"
other=$(jq -r .uuid answer.json)
[ -e data/up.png ] || [ -e up.png ] && fail "a file left its task's folder"
ask task/cancel -d "uuid=$other"
is .success
[ "$(status "$other")" = 50 ] || fail "a cancelled task is not cancelled"
ask task/remove -H 'Content-Type: application/json' -d "{\"uuid\": \"$other\"}"
is .success
ask task/list
is 'map(.uuid) == ["11111111-2222-3333-4444-555555555555"]'
[ -e "data/$other" ] && fail "a removed task is still there"

# What is refused.
ask task/new -F 'options=[{"name":"dtm","value":true}]' -F images=@"$(ls photos/* | head -1)"
is '.error | contains("dtm")'
ask task/new -F name=empty
is '.error == "Not enough images"'
ask "task/$other/info"
is '.error | contains("not found")'
ask "task/$uuid/download/orthophoto.tif"
is .error
ask task/cancel -d uuid=nobody
is '.success == false'

for ((i = 0; i < 600; i++)); do
    code=$(status "$uuid")
    [ "$code" = 10 ] || [ "$code" = 20 ] || break
    sleep 1
done
[ "$code" = 40 ] || { fail "the task ends with $code"; curl -s "$url/task/$uuid/output?token=secret" >&2; }
is '.progress == 100 and .imagesCount == 8 and .processingTime > 0 and .name == "arch"'
ask "task/$uuid/output"
is 'any(test("densify +done"))'
ask "task/$uuid/download/all.zip"
mv answer.json all.zip
/usr/bin/python3 -m zipfile -l all.zip >stdout.txt || fail "all.zip is no archive"
for file in oriel/walk/index.html oriel/points.ply oriel/splats.ply; do
    grep -q "^$file " stdout.txt || fail "all.zip lacks $file"
done
[ $failed -eq 0 ]
