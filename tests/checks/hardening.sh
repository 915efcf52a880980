#!/bin/sh
# usage: hardening.sh PROGRAM
# Was it built with the flags that keep a mistake in reading a stranger's file small?
failed=0
program=$1
expect() {
    readelf -W "$1" "$program" 2>/dev/null | grep -q "$2" || {
        echo "$program: no $3" >&2
        failed=1
    }
}
expect -h 'DYN (Position-Independent' 'position-independent executable'
expect -l GNU_RELRO 'read-only relocations'
expect -d BIND_NOW 'binding at start'
expect -s __stack_chk_fail 'stack protector'
expect -s '__[a-z]*_chk' 'fortified functions'
exit $failed
