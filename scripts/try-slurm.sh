#!/bin/bash
# Tries `fathom farm` for real: a Slurm of two nodes on this machine (slurmctld, two slurmd, munge, no
# systemd), then GNU parallel, on a film of 1,000 small frames. In the middle of both a third of the
# workers is killed with SIGKILL, the disk is full for a while, a second controller works on the same
# folder; with Slurm a node is drained and resumed besides. At the end nothing is missing, every frame
# is the one that a single process makes, to the byte, and no more work was repeated than was killed.
# Needs root, and installs Debian's slurm-wlm, munge and parallel. Takes about ten minutes.
#   scripts/try-slurm.sh [slurm|parallel]…   both unless said
#   scripts/try-slurm.sh overhead            what Slurm adds to units of a minute: 5 % at most. For an
#                                            idle machine of two cores; takes six minutes
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
. "$root/scripts/setup.sh"
[ "$(id -u)" = 0 ] || { say "Slurm's daemons and a small disk want root"; exit 3; }
install_packages "slurmctld slurmd slurm-client munge parallel" || exit 3
program=${FATHOM:-$root/build/fathom}
[ -x "$program" ] || { say "build it first: ./fathom help"; exit 3; }
export FATHOM=$program
frames=${FRAMES:-1000}
[ $# -gt 0 ] || set -- slurm parallel

folder=$(mktemp -d) || exit 3
disk=$folder/disk
mkdir "$disk" && mount -t tmpfs -o size=400m tmpfs "$disk" 2>/dev/null || { rm -rf "$disk"; mkdir "$disk"; no_disk=1; }
[ -z "${no_disk:-}" ] || say "no disk of its own can be mounted here: it is not filled"
started=""
stop() {
    [ -z "$started" ] || { kill $started; wait $started; } 2>/dev/null
    [ -n "${no_disk:-}" ] || umount -l "$disk"
    rm -rf "$folder"
}
trap stop EXIT
since() { echo "$1 $(date +%s.%N)" | awk '{ printf "%.1f", $2 - $1 }'; }
fail() { say "FAILED: $*"; failed=1; }

cat >"$folder/film.sdf" <<'SDF'
sphere(0.8 + 0.1 * sin(time)).translate(y: keyframes([[0, 0], [20, 1], [40, -0.5]], time))
box([3, 0.3, 1]).twist(0.02 * time, axis: X).translate(y: -1.2).paint(tomato)
camera(at: [0, 1, 6], look_at: [0, 0, 0])
render(time: 60)
SDF
options="--frames 0..$frames --fps 25 --size ${SIZE:-192x144} --samples 6 --chunk 10"

# setup_slurm CPUS: Slurm on one machine. The nodes are daemons with a port and CPUS processors each.
setup_slurm() {
    local host; host=$(hostname -s)
    pgrep -x munged >/dev/null || {
        [ -e /etc/munge/munge.key ] || mungekey -c
        mkdir -p /run/munge && chown munge /run/munge
        su -s /bin/sh munge -c munged || return 1
        started="$started $(pgrep -x munged)"
    }
    mkdir -p "$folder/ctl" "$folder/n1" "$folder/n2"
    cat >"$folder/slurm.conf" <<CONF
ClusterName=try
SlurmctldHost=$host
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CryptoType=crypto/munge
StateSaveLocation=$folder/ctl
SlurmdSpoolDir=$folder/%n
SlurmctldPidFile=$folder/ctl.pid
SlurmdPidFile=$folder/%n.pid
SlurmctldLogFile=$folder/ctl.log
SlurmdLogFile=$folder/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SlurmdParameters=config_overrides
JobRequeue=1
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0
NodeName=n[1-2] NodeHostname=$host NodeAddr=127.0.0.1 Port=[17001-17002] CPUs=$1 State=UNKNOWN
PartitionName=all Nodes=n[1-2] Default=YES MaxTime=INFINITE State=UP
CONF
    export SLURM_CONF=$folder/slurm.conf
    slurmctld -D >/dev/null 2>&1 & started="$started $!"
    slurmd -D -N n1 >/dev/null 2>&1 & started="$started $!"
    slurmd -D -N n2 >/dev/null 2>&1 & started="$started $!"
    local i
    for i in $(seq 60); do
        [ "$(sinfo -h -N -o %t 2>/dev/null | grep -c idle)" = 2 ] && return 0
        sleep 1
    done
    tail -5 "$folder/ctl.log" "$folder/n1.log" >&2
    return 1
}

done_frames() { find "$1/frames" -name 'frame_*.png' | wc -l; }
until_done() { # until_done DIR SHARE: as many hundredths of the frames are there
    local i
    for i in $(seq 1200); do
        [ "$(done_frames "$1")" -ge $((frames * $2 / 100)) ] && return 0
        sleep 0.2
    done
    fail "the farm stands still at $(done_frames "$1") frames"
}

below() { # below PID: it and all that it started
    local child
    echo "$1"
    for child in $(pgrep -P "$1"); do below "$child"; done
}

# Kills a third of the workers of the job with all that they started, as a machine that goes away. A
# worker is a shell that runs `run` and was not started by another.
workers_of() { # workers_of DIR
    local pid parent
    for pid in $(pgrep -f "^/bin/sh $1/run [0-9]" | sort -R); do
        parent=$(ps -o ppid= -p "$pid") || continue
        tr '\0' ' ' 2>/dev/null <"/proc/${parent// /}/cmdline" | grep -q "^/bin/sh $1/run" || echo "$pid"
    done
}
kill_third() {
    local pid n=0 third try workers=""
    # Between two units there may be few: a moment with three is waited for, then one with any.
    for try in $(seq 200); do
        workers=$(workers_of "$1")
        set -- "$1" $workers
        [ $# -le $((try < 100 ? 3 : 1)) ] || break
        sleep 0.05
    done
    shift
    third=$((($# + 2) / 3))
    for pid in "$@"; do
        [ $n -lt $third ] || break
        kill -9 $(below "$pid") 2>/dev/null
        n=$((n + 1))
    done
    killed=$((killed + n))
    [ $n -gt 0 ] || fail "there was no worker to kill"
    say "killed $n of $# workers, at $(done_frames "$job") frames"
}

fill_disk() { # fill_disk SECONDS
    [ -z "${no_disk:-}" ] || return 0
    dd if=/dev/zero of="$disk/full" bs=1M 2>/dev/null
    say "the disk is full, at $(done_frames "$job") frames"
    sleep "$1"
    rm -f "$disk/full"
}

# Every frame against the one that a single process made; how much was made twice.
check() {
    local number made
    for number in $(seq 0 $((frames - 1))); do
        number=$(printf %04d "$number")
        cmp -s "$1/frames/frame_$number.png" "$folder/whole/frame_$number.png" || fail "frame $number differs"
    done
    made=$(cat "$1"/logs/[0-9]* | grep -c '"made"')
    say "$2: $(cat "$1"/state/[0-9]* | grep -c "^begin") begins of $(wc -l <"$1/units") units, $(cat "$1"/state/[0-9]* | grep -c "^end 3") ended with status 3"
    # A worker that is killed, or whose note of a frame the full disk took, repeats its unit at most.
    say "$2: $made frames made for $frames; $killed workers were killed, with units of 10 frames"
    [ "$made" -le $((frames + 10 * killed)) ] || fail "more was repeated than was killed"
}

# A film of 96 equal frames of some seconds on one core, less the three that the farm makes as a probe:
# by two processes that get half of them each, then by two nodes of a processor each that get two units
# of a minute each.
overhead() {
    local scene=$root/examples/temple.sdf film="--frames 0..96 --size 600x450 --samples 1 --backend cpu --jobs 1"
    local begin hand farm
    setup_slurm 1 || { fail "Slurm does not start"; return; }
    begin=$(date +%s.%N)
    "$program" render "$scene" $film --only 1..48 -o "$folder/hand/f_####.png" & local first=$!
    "$program" render "$scene" $film --only 49..95 -o "$folder/hand/f_####.png"
    wait $first
    hand=$(since "$begin")
    "$program" farm slurm "$scene" $film --chunk 24 --out "$folder/farm" || { fail "not submitted"; return; }
    begin=$(date +%s.%N)
    until [ "$(done_frames "$folder/farm")" = 96 ]; do sleep 0.5; done
    farm=$(since "$begin")
    say "93 frames: $hand s by hand, $farm s by Slurm, in $(wc -l <"$folder/farm/units") units"
    echo "$hand $farm" | awk '{ exit !($2 <= 1.05 * $1) }' || fail "that is more than 5 % over"
    while [ -n "$(squeue -h)" ]; do sleep 1; done
}
if [ "$1" = overhead ]; then
    mkdir "$folder/hand"
    overhead
    exit ${failed:-0}
fi

mkdir "$folder/whole"
begin=$(date +%s.%N)
"$program" render "$folder/film.sdf" ${options% --chunk*} --backend cpu -o "$folder/whole/frame_####.png" || exit 1
say "one process with all cores takes $(since "$begin") s for $frames frames"

for engine in "$@"; do
    job=$disk/$engine
    killed=0
    [ "$engine" != slurm ] || setup_slurm 3 || { fail "Slurm does not start"; continue; }
    begin=$(date +%s.%N)
    if [ "$engine" = slurm ]; then
        "$program" farm slurm "$folder/film.sdf" $options --out "$job" || { fail "not submitted"; continue; }
    else
        "$program" farm parallel "$folder/film.sdf" $options --out "$job" -- -j 6 & controller=$!
    fi
    until_done "$job" 15
    # A second controller on the same folder, while the first is at work.
    "$program" farm collect "$job" >"$folder/second" 2>&1 & second=$!
    until_done "$job" 30
    kill_third "$job"
    until_done "$job" 50
    if [ "$engine" = slurm ]; then
        scontrol update NodeName=n2 State=DRAIN Reason=try && say "node n2 is drained"
        until_done "$job" 60
        scontrol update NodeName=n2 State=RESUME
    fi
    fill_disk 10
    wait $second
    [ "$engine" = slurm ] || wait $controller
    # Slurm's own jobs end, then what is missing is asked for again, as one would by hand.
    for round in $(seq 10); do
        if [ "$engine" = slurm ]; then
            while [ -n "$(squeue -h 2>/dev/null)" ]; do sleep 1; done
        fi
        "$program" farm status "$job" | head -1 | grep -q "^\([0-9]*\) of \1 " && break
        "$program" farm collect "$job" >/dev/null
    done
    say "$engine: done after $(since "$begin") s"
    "$program" farm status "$job" | head -1
    check "$job" "$engine"
    rm -rf "$job"
done
[ -z "${failed:-}" ] && say "all is there, and equal to the last bit"
exit ${failed:-0}
