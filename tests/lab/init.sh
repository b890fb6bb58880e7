#!/busybox/busybox sh
# Process 1 of the emulated machine: brings up the CAN interfaces, runs the steps, sends what came of them
# through the second serial port, and switches the machine off. machine.py packs it as /init.
PATH=/usr/sbin:/usr/bin:/sbin:/bin:/busybox
export PATH
set -e
trap 'poweroff -f' EXIT # also when something fails here: machine.py misses "lab: end" and shows the console

busybox mkdir -p /proc /sys /dev /tmp /run /lab/out /lab/result
busybox mount -t proc proc /proc # first: busybox finds itself through it
busybox --install -s /busybox
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
mount -t tmpfs tmp /tmp

while read -r module; do
    insmod "/modules/$module.ko"
done </modules/order

# This shell prefers its own small ip, which knows no CAN, to the one on PATH.
ip=/sbin/ip
$ip link set lo up
$ip route add 224.0.0.0/4 dev lo
$ip link add vcan0 type vcan
$ip link set vcan0 up
for can in can0 can1; do
    # 10 frames is the queue that users have, so ENOBUFS is near; one who wants another says so in a step.
    $ip link set $can type can bitrate 1000000 restart-ms 100
    $ip link set $can txqueuelen 10 up
done
. /lab/guest.sh

if [ -e /lab/shell ]; then
    echo "lab: vcan0, can0 and can1 are up; what was brought along is on PATH; exit switches the machine off"
    printf '%s\n' '. /lab/guest.sh' "ip() { $ip \"\$@\"; }" >/lab/env
    cd /lab/out
    export ENV=/lab/env
    setsid cttyhack sh || :
    exit
fi

# A step at a time, so that a machine that hangs has sent the steps before. gzip members may be joined, and so
# may tar archives when their ends are skipped.
cd /lab
stty -F /dev/ttyS1 raw
for step in steps/*; do
    step=${step#steps/}
    run_step "$step"
    tar -c result/"${step#*-}".* | gzip -1 >/dev/ttyS1
done
tar -c out | gzip -1 >/dev/ttyS1
# Data still in the port's buffer would die with the machine: stty waits for them.
stty -F /dev/ttyS1 raw
echo "lab: end"
