#!/usr/bin/env bash
# Runs a command inside a user-mode-linux guest that has virtual CAN interfaces, on machines whose own kernel has none.
#   in_guest.sh SCRATCH-FOLDER REGISTERS COMMAND [ARGUMENT…]
# REGISTERS is the library made of guest_registers.c. The guest sees this machine's files, read-only, and has vcan0, vcan1 and
# `lo`; /run is its own and writable, and the working directory. No privileges are needed.
# Exits as the command did; 77 where the package user-mode-linux, kmod or iproute2 is missing; 70 where the guest failed.
set -euo pipefail

scratch=$1
registers=$2
shift 2
for program in linux.uml ip insmod candump python3; do
  PATH=$PATH:/sbin:/usr/sbin command -v "$program" >/dev/null || {
    echo "skipped: $program is missing; apt-get install user-mode-linux kmod iproute2 can-utils python3-can"
    exit 77
  }
done
rm -rf "$scratch"
mkdir -p "$scratch/uml"
scratch=$(readlink -f "$scratch")

{
  cat <<'INIT'
#!/bin/bash
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/run TMPDIR=/run
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t tmpfs tmpfs /run
mount -t devtmpfs devtmpfs /dev 2>/dev/null || mount -t tmpfs tmpfs /dev
[ -e /dev/null ] || { mknod -m 666 /dev/null c 1 3; mknod -m 666 /dev/zero c 1 5; mknod -m 666 /dev/urandom c 1 9; mknod -m 666 /dev/ptmx c 5 2; mknod -m 666 /dev/tty c 5 0; }
mkdir -p /dev/pts /dev/shm
[ -e /dev/fd ] || ln -s /proc/self/fd /dev/fd
mount -t devpts -o ptmxmode=666 devpts /dev/pts
mount -t tmpfs tmpfs /dev/shm
modules=$(echo /usr/lib/uml/modules/*/kernel)
for module in net/can/can net/can/can-raw drivers/net/can/dev/can-dev drivers/net/can/vcan drivers/net/can/slcan/slcan; do
  insmod "$modules/$module.ko" 2>/dev/null
done
ip link set lo up
for i in 0 1; do
  ip link add dev vcan$i type vcan && ip link set vcan$i txqueuelen 1000 up
done
cd /run
INIT
  printf '%q ' "$@"
  cat <<'INIT'
</dev/null 2>&1
echo "guest command exited: $?"
echo o >/proc/sysrq-trigger
sleep 10
INIT
} >"$scratch/init"
chmod +x "$scratch/init"

[[ -d /dev/shm && -w /dev/shm ]] && export TMPDIR=/dev/shm
LD_PRELOAD=$registers timeout 300 linux.uml mem=512M rootfstype=hostfs rootflags=/ ro init="$scratch/init" uml_dir="$scratch/uml/" umid=guest \
  con=null con0=null,fd:1 ssl=null quiet loglevel=3 panic=-1 </dev/null >"$scratch/log" 2>"$scratch/errors" || true
tr -d '\r' <"$scratch/log" | grep -v '^sysrq: \|^reboot: ' || true
code=$(sed -n 's/^guest command exited: \([0-9]*\).*/\1/p' "$scratch/log" | tail -n 1)
if [[ -z $code ]]; then
  echo "the guest did not come to its end:"
  cat "$scratch/errors"
  exit 70
fi
exit "$code"
