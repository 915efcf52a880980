# shellcheck shell=bash disable=SC2154
# Sourced by demo.sh: writes the demo's page, with everything in it. Its variables are
# those of demo.sh: demo scene title photo_count step_json minutes version invoked method.

# data_uri MIME FILE
data_uri() {
    printf 'data:%s;base64,' "$1"
    base64 -w0 "$2"
}

# Text as it may stand in HTML, attributes included.
escape() {
    sed 's/&/\&amp;/g; s/</\&lt;/g; s/"/\&quot;/g' <<<"$1"
}

# image FILE ALT [ffmpeg filter]: an <img> with the picture as JPEG inside.
image() {
    local small
    small=$(mktemp --suffix=.jpg)
    ffmpeg -v error -y -i "$1" -vf "${3:-null}" -frames:v 1 -q:v 3 "$small" </dev/null &&
        printf '<img loading="lazy" alt="%s" src="%s">' "$(escape "$2")" "$(data_uri image/jpeg "$small")"
    rm -f "$small"
}

# JSON inside a page must not end the script element it lies in.
json_block() {
    printf '<script type="application/json" id="%s">' "$1"
    sed 's|</|<\\/|g'
    printf '</script>\n'
}

page_head() {
    cat <<HTML
<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Oriel: $title</title>
<style>
$(cat "$here/style.css")
</style>
<main>
<h1>$title</h1>
<p class="lead">Oriel turned $photo_count photographs of one place into something you can walk
through. $test_count of them were kept aside and used for comparison only.</p>
<div class="facts">
<div><b>$photo_count</b>photographs</div>
<div><b id="fact-points"></b>points</div>
<div><b id="fact-psnr"></b>close to what a camera saw (PSNR)</div>
<div><b id="fact-ms"></b>to render a picture</div>
<div><b>$minutes min</b>for all of it</div>
</div>
HTML
}

page_walk() {
    cat <<HTML
<h2>A walk</h2>
<p>Nobody photographed these views: every frame is painted from the photographs around it. A film,
and the place itself to walk through: drag to look, W A S D to move, ? for help.
<a href="walk.html">Open it alone</a>.</p>
<div class="two walk">
<video controls autoplay loop muted playsinline src="$(data_uri video/mp4 "$demo/walk.mp4")"></video>
<iframe src="walk.html" title="a walk through the scene" loading="lazy" allow="fullscreen"></iframe>
</div>
HTML
}

page_slider() {
    local first=$1
    cat <<HTML
<h2>Against the camera</h2>
<p>A photograph that Oriel never saw, and the same view rendered from the others.
Move the pointer across to compare.</p>
<div class="compare">
$(image "$demo/eval/$first.photo.png" "photograph $first")
<div class="top">$(image "$demo/eval/$first.$method.png" "rendering of $first")</div>
<div class="bar"></div><span class="left">rendered</span><span class="right">photograph</span>
<input type="range" min="0" max="100" value="50" aria-label="compare">
</div>
HTML
}

page_comparisons() {
    local stem name
    echo '<h2>Every photograph kept aside</h2>'
    echo '<p>The photograph; Oriel; its points alone, for comparison; and how'
    echo 'far Oriel is from the photograph, four times amplified (black: the same).</p>'
    for stem in "${stems[@]}"; do
        name=$(escape "$stem")
        cat <<HTML
<div class="four">
<figure>$(image "$demo/eval/$stem.photo.png" photograph)<figcaption>photograph $name</figcaption></figure>
<figure>$(image "$demo/eval/$stem.$method.png" rendering)
<figcaption data-method="$method" data-stem="$name">$method</figcaption></figure>
<figure>$(image "$demo/eval/$stem.points.png" points)
<figcaption data-method="points" data-stem="$name">points alone</figcaption></figure>
<figure>$(image "$demo/eval/$stem.$method.diff.png" difference crop=iw/3:ih:2*iw/3:0)
<figcaption>difference, four times</figcaption></figure>
</div>
HTML
    done
}

page_depth() {
    [ -f "$demo/view.depth.png" ] || return 0
    cat <<HTML
<h2>Depth</h2>
<p>What lets Oriel ask each photograph whether it saw a surface: the distance of every pixel,
rebuilt from the points for each new view (near is bright).</p>
<div class="two">
<figure>$(image "$demo/view.png" view)<figcaption>rendered view</figcaption></figure>
<figure>$(image "$demo/view.depth.png" depth)<figcaption>its depth</figcaption></figure>
</div>
HTML
}

page_figures() {
    cat <<HTML
<h2>Figures</h2>
<p>Means over the $test_count photographs kept aside, over whole pictures, holes included. PSNR: how
close colours are, in decibels; more is better, and 6 dB more halve the differences. SSIM: how alike
structures are, at most 1. Covered: share of the picture where Oriel found a surface.</p>
<table id="accuracy"><tr><th>method<th>PSNR<th>SSIM<th>covered<th>time a picture</table>
<h2>Time and memory</h2>
<p>On <b id="device"></b>, $(nproc) processor cores.</p>
<table id="stages"><tr><th>step<th>time<th>processor time<th>memory at most</table>
HTML
}

page_sheet() {
    local photo
    echo '<h2>The photographs</h2><div class="sheet">'
    for photo in "${thumbnails[@]}"; do
        image "$photo" '' 'scale=220:-2'
    done
    echo '</div>'
}

page_tail() {
    json_block scene-json <"$scene/scene.json"
    json_block eval-json <"$demo/eval.json"
    json_block run-json <<<"{\"method\": \"$method\", \"steps\": [$step_json]}"
    printf '<p class="soft">Made by oriel %s with %s.</p>\n</main>\n<script>\n' "$version" "$invoked"
    cat "$here/page.js"
    printf '</script>\n</html>\n'
}

write_page() {
    local here stems=() thumbnails=() test_count file
    here=$(dirname "${BASH_SOURCE[0]}")
    for file in "$demo"/eval/*.photo.png; do
        file=${file##*/}
        stems+=("${file%.photo.png}")
    done
    test_count=${#stems[@]}
    mapfile -t thumbnails < <(find "$scene/images" -type f | sort | head -n 96)
    {
        page_head
        page_walk
        page_slider "${stems[$((test_count / 2))]}"
        page_comparisons
        page_depth
        page_figures
        page_sheet
        page_tail
    } >"$demo/index.html.part" && mv "$demo/index.html.part" "$demo/index.html"
}
