# Sourced by the scripts beside it: fresh roots of Debian's suites, from the machine's own sources.
#   root_make SUITE   makes $root; exits with 77, saying why, where this machine cannot make one
#   root_run COMMAND  runs a command as root of $root
# The root is removed when the script ends, unless ORIEL_DEBIAN_ROOTS names a folder where a root of
# each suite is kept and used again. What is mounted in it is mounted in a mount namespace of its own,
# which ends with the command: the machine's own mounts and devices are never inside a root that is
# removed. debootstrap gives the root device nodes of its own.

root_skip() {
    echo "skipped: $1"
    exit 77
}

# The package archive that this machine's apt uses.
root_archive() {
    apt-get indextargets --format '$(REPO_URI)' 'Identifier: Packages' 'Label: Debian' | sort -u |
        head -n 1
}

root_remove() {
    [ "${root_child:-}" ] && kill -KILL "$root_child" 2>/dev/null && wait "$root_child"
    [ "${root:-}" ] && [ -z "${ORIEL_DEBIAN_ROOTS:-}" ] || return 0
    if grep -qF " $root" /proc/self/mounts; then
        echo "$root: something is mounted there, so it stays" >&2
        return 1
    fi
    rm -rf --one-file-system "$root"
}

root_make() {
    local archive
    command -v debootstrap >/dev/null || root_skip "debootstrap is not installed"
    [ "$(id -u)" -eq 0 ] || root_skip "debootstrap asks for the superuser"
    unshare --mount true 2>/dev/null || root_skip "mount namespaces are not allowed here"
    archive=$(root_archive)
    [ "$archive" ] || root_skip "apt of this machine knows no archive of Debian: run apt-get update"
    trap root_remove EXIT
    trap 'exit 130' INT TERM
    root=${ORIEL_DEBIAN_ROOTS:+$ORIEL_DEBIAN_ROOTS/$1}
    [ -z "$root" ] || [ ! -e "$root/etc/apt/apt.conf.d/90oriel" ] || return 0 # a root that is kept
    root=${root:-$(mktemp -d "${TMPDIR:-/tmp}/oriel-debian.XXXXXX")}
    mkdir -p "$root" && chmod 755 "$root" || exit 1 # apt's user reads it
    debootstrap --variant=minbase "$1" "$root" "$archive" >"$root.log" 2>&1 || {
        tail -n 5 "$root.log"
        rm -f "$root.log"
        root_skip "debootstrap cannot make a root of $1 here"
    }
    rm -f "$root.log"
    cp /etc/resolv.conf /etc/hosts "$root/etc/"
    {
        # A mirror may stand still, and a crash during unpacking costs nothing here.
        echo 'Acquire::Check-Valid-Until "false";'
        echo 'Dpkg::Options { "--force-unsafe-io"; };'
        apt-config dump | sed -nE '/^Acquire::https?::Proxy/Ip'
    } >"$root/etc/apt/apt.conf.d/90oriel"
}

# With a namespace of process ids, so that no process outlives the command; not in the foreground,
# where bash heeds no signal.
root_run() {
    unshare --mount --pid --fork --kill-child bash -c '
        root=$1 && shift &&
        mount -t proc proc "$root/proc" && mount -t tmpfs tmpfs "$root/dev/shm" &&
        exec chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 "$@"' \
        bash "$root" "$@" &
    root_child=$!
    wait "$root_child"
    local status=$?
    root_child= # its number may become another process's
    return $status
}

# The version of a package in the root, without Debian's own part.
root_version() {
    root_run dpkg-query -W -f '${Version}' "$1" 2>/dev/null | sed -E 's/^[0-9]+://; s/[-+~][^-]*$//'
}
