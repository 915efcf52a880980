#!/bin/sh
# Every module includes only headers of itself and of the modules it declares in USES.
# A module is a folder of src/ or of the root, or a folder below another module; a file
# belongs to the deepest module that holds it, and so does a header.
# "shared/" is shaders/shared, which C shares with GLSL. "oriel/NAME.h" is a public header in
# include/, which belongs to the module that `public` below says.
# usage: layers.sh SOURCE_DIR TABLE; lines of TABLE are "module: used used ..."
set -eu
source=$1
table=$2
cd "$source"
# The uses must not run in a circle.
awk -F: '{ n = split($2, used, " "); for (i = 1; i <= n; i++) print $1, used[i] }' "$table" |
    tsort >/dev/null || { echo "modules use one another in a circle"; exit 1; }
folders=$(sed 's/:.*//' "$table" | while read -r module; do
    if [ -d "src/$module" ]; then echo "src/$module"; else echo "$module"; fi
done)
# shellcheck disable=SC2086
find include $folders -name '*.[ch]' -o -name '*.cpp' | sort -u |
    xargs grep -nE '^ *# *include "[a-z_]+/' /dev/null | awk -v table="$table" '
    function module_of(path, name) {
        for (name = path; sub("/[^/]*$", "", name);)
            if (name in uses)
                return name
        if (path ~ /^oriel\//)
            return public[path]
        return path ~ /^shared\// ? "shared" : ""
    }
    function add_public(module, list, names, n, i) {
        n = split(list, names, " ")
        for (i = 1; i <= n; i++)
            public["oriel/" names[i] ".h"] = module
    }
    BEGIN {
        add_public("core", "common result log progress image names camera option_row")
        add_public("gpu", "gpu")
        add_public("scene", "points scene path")
        add_public("render/frame", "option_list render")
        add_public("render/photos", "radiance")
        add_public("hdr", "hdr")
        add_public("preprocess/job", "prepare_params")
        add_public("preprocess", "prepare")
        while ((getline line < table) > 0) {
            name = line
            sub(":.*", "", name)
            sub("^[^:]*: *", "", line)
            uses[name] = " " name " " line " shared "
        }
    }
    {
        file = $0
        sub(":.*", "", file)
        sub("^(src|include)/", "", file)
        header = $0
        sub(".*# *include \"", "", header)
        sub("\".*", "", header)
        from = module_of(file)
        to = module_of(header)
        count++
        if (to == "" || index(uses[from], " " to " ") == 0) {
            print from " may not include headers of " (to == "" ? "no module" : to) ": " $0
            bad = 1
        }
    }
    END {
        if (count <= 10) {
            print "found no includes to check"
            bad = 1
        }
        exit bad
    }'
