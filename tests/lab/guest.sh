# What runs the steps of a battery, in the emulated machine (called by init.sh) and on the host alike. Plain
# sh: busybox's and dash. machine.py lays out $LAB:
#
#   steps/01-name    scripts, in their order; each in a shell of its own (sh -eu), with the helpers below
#   in/              what machine.py was given; on PATH, called $IN
#   out/             the working directory of every step, called $OUT; what is left there is brought back
#   result/          name.code, name.out, name.err, name.time of each step

LAB=${LAB:-/lab}
IN=$LAB/in
OUT=$LAB/out
export LAB IN OUT
PATH=$IN:$PATH

# await SECONDS COMMAND...: until COMMAND succeeds; 1 when it has not within SECONDS (a whole number).
await() {
    await_tries=$(($1 * 20))
    shift
    until "$@"; do
        [ $((await_tries -= 1)) -gt 0 ] || { echo "await: never came true: $*" >&2; return 1; }
        sleep 0.05
    done
}

# start NAME COMMAND...: in the background, also beyond this step. Its words go to $OUT/NAME.out and
# $OUT/NAME.err, its exit code, once it has ended, to $OUT/NAME.code.
start() {
    start_name=$1
    shift
    rm -f "$OUT/$start_name.code" "$LAB/$start_name.pid"
    # Twice in the background: as no child of the step's shell, a plain wait there does not wait for it.
    ( (
        set +e
        # The pid is that of COMMAND itself, so that kill -9 hits it and not a shell around it.
        sh -c 'echo $$ >"$0.new" && mv "$0.new" "$0" && exec "$@"' "$LAB/$start_name.pid" "$@" \
            >"$OUT/$start_name.out" 2>"$OUT/$start_name.err" </dev/null
        echo $? >"$LAB/$start_name.ended" && mv "$LAB/$start_name.ended" "$OUT/$start_name.code"
    ) & ) >/dev/null 2>&1
    await 5 test -e "$LAB/$start_name.pid"
}

# signal NAME SIGNAL: to what start started.
signal() {
    kill "-$2" "$(cat "$LAB/$1.pid")"
}

# finish NAME SECONDS: waits for its end; gives its exit code.
finish() {
    await "$2" test -e "$OUT/$1.code" || return
    return "$(cat "$OUT/$1.code")"
}

# stop NAME [SIGNAL]: ends it (TERM), waits; never fails because of its exit code, which is in $OUT/NAME.code.
stop() {
    sleep 0.1 # for what is on its way: candump leaves the frames that wait for it
    [ -e "$OUT/$1.code" ] || signal "$1" "${2:-TERM}" || :
    await 5 test -e "$OUT/$1.code"
}

# record NAME INTERFACE...: candump -L into $OUT/NAME.out; it listens when this returns. stop NAME ends it.
record() {
    record_name=$1
    shift
    record_before=$(listeners "$1")
    start "$record_name" candump -L -r 4000000 "$@" # a buffer that holds what comes while it does not run
    await 5 more_listeners "$1" "$record_before"
}
listeners() {
    cat /proc/net/can/rcvlist_* | grep -c "^ *$1 " || :
}
more_listeners() {
    [ "$(listeners "$1")" -gt "$2" ]
}

# log NAME: prints what record NAME has seen, without its time stamps: "INTERFACE ID#DATA" a line.
log() {
    sed 's/^([^)]*) //' "$OUT/$1.out"
}

# hold INTERFACE, release INTERFACE: the controller of can0 or can1 raises no interrupts, so no frame is ever
# through, as on a bus where nobody acknowledges; the queue fills. After release all goes on.
# Bit 10 of a PCI device's command register at offset 4, both bytes in one write; bits 0 to 2 keep it alive.
hold() {
    pci_command "$1" '\007\004'
}
release() {
    pci_command "$1" '\007\000'
}
pci_command() {
    printf "$2" | dd of="/sys/class/net/$1/device/config" bs=2 seek=2 conv=notrunc 2>/dev/null
}

# counts INTERFACE WHAT: a counter of the kernel, as rx_packets, tx_packets, tx_dropped.
counts() {
    cat "/sys/class/net/$1/statistics/$2"
}

# Runs one step of $LAB/steps; the time limit in seconds is the script's first line: "# limit 20".
run_step() {
    step=$LAB/steps/$1
    name=$LAB/result/${1#*-}
    read -r _ _ limit <"$step"
    read -r begin _ </proc/uptime
    code=0
    # KILL: a step that hangs must not hold up the others.
    timeout -s KILL "$limit" /bin/sh -eu -c '. "$0"; cd "$OUT"; . "$1"' "$LAB/guest.sh" "$step" \
        >"$name.out" 2>"$name.err" </dev/null || code=$?
    read -r end _ </proc/uptime
    echo "$begin $end" >"$name.time"
    echo "$code" >"$name.code"
    echo "lab: ${1#*-}: exit $code"
}
