# Sourced by demo.sh and test.sh: what Oriel needs from Debian, and its build.

oriel_packages() {
    echo build-essential cmake ninja-build pkg-config colmap ffmpeg python3 \
        libegl-dev libegl1 libopengl0 libgl1-mesa-dri libepoxy-dev \
        libopencv-dev libflann-dev libmeshoptimizer-dev libopenexr-dev libjpeg-dev libpng-dev libtiff-dev libraw-dev libheif-dev liblcms2-dev libexif-dev \
        libjansson-dev libsqlite3-dev libwebsockets-dev libxxhash-dev libstb-dev "$@"
}

# Installs the packages that are missing, and those named in the arguments.
install_dependencies() {
    local missing=() package
    for package in $(oriel_packages "$@"); do
        dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
            missing+=("$package")
    done
    [ ${#missing[@]} -eq 0 ] && return 0
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || {
            echo "Please install as root: apt-get install ${missing[*]}" >&2
            return 1
        }
        as_root=(sudo)
    fi
    echo "== installing ${#missing[@]} packages: ${missing[*]}"
    "${as_root[@]}" apt-get update -q >/dev/null &&
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
            apt-get install -q -y --no-install-recommends "${missing[@]}" >/dev/null
}

# build_oriel BUILD_DIR [cmake arguments] [targets]
build_oriel() {
    local dir=$1 options=() targets=() word
    shift
    for word in "$@"; do
        case $word in -*) options+=("$word") ;; *) targets+=("$word") ;; esac
    done
    cmake -S "$(dirname "${BASH_SOURCE[0]}")/.." -B "$dir" -G Ninja "${options[@]}" >"$dir.log" 2>&1 &&
        cmake --build "$dir" ${targets:+--target "${targets[@]}"} >>"$dir.log" 2>&1 || {
        tail -n 30 "$dir.log" >&2
        return 1
    }
}
