#!/bin/sh
# Makes unit $1, line $1 + 1 of `units`, in this folder, and notes its begins and ends in state/$1.
# One process a unit: with FATHOM_FARM_WAIT it waits for another to end, else it ends with 75.
cd "$(dirname -- "$0")" || exit 3
unit=$1
line=$(sed -n "$((unit + 1))p" units)
[ -n "$line" ] || { echo "there is no unit $unit" >&2; exit 2; }
note() { ( echo "$@" >>"state/$unit" ) 2>/dev/null; }
tries=0
# again STATUS: waits 1, 2, 4 … seconds, or ends with the status after the sixth time.
again() {
    tries=$((tries + 1))
    [ $tries -lt 6 ] || exit "$1"
    sleep $((1 << (tries - 1)))
}
until ( : >>"state/$unit.lock" ) 2>/dev/null; do again 3; done
exec 9>>"state/$unit.lock"
flock -n 9 || { [ -n "${FATHOM_FARM_WAIT:-}" ] && flock 9; } || exit 75
while :; do
    log="logs/$unit"
    ( : >>"$log" ) 2>/dev/null || log=/dev/null
    note "begin $(hostname) $$"
    ( eval "$line" ) 2>>"$log"
    status=$?
    note "end $status"
    # Trying again helps where a disk was full, memory was short or a process was killed. It does not
    # where the scene or the command line is wrong (1, 2), and is not wanted after SIGTERM (4).
    case $status in 0 | 1 | 2 | 4) exit $status ;; esac
    again $status
done
