#!/usr/bin/env bash
# refusals.sh CMAKE SOURCE COMPILER SYSROOT: what must not be built for an ARM11 is refused when it is configured.
set -uo pipefail
cmake=$1 source=$2 compiler=$3 sysroot=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bad=0

# refused NAME EXPECTED OPTION…: configuring with these options fails, and says EXPECTED.
refused() {
  local name=$1 expected=$2 output
  shift 2
  if output=$("$cmake" -S "$source" -B "$work/$name" -G Ninja -DTANDEM_BOARD=ON \
    --toolchain "$source/cmake/toolchain/armel.cmake" "$@" 2>&1); then
    echo "$name: was not refused"
    bad=1
  elif ! tr -s ' \n' ' ' <<<"$output" | grep -qF -- "$expected"; then
    echo "$name: does not say \"$expected\":"
    echo "$output"
    bad=1
  else
    echo "$name: refused"
  fi
}

# Behaves as Debian's arm-linux-gnueabihf-g++ does, which need not be installed.
cat >"$work/arm-linux-gnueabihf-g++" <<END
#!/bin/sh
exec $compiler -march=armv7-a+fp -mfloat-abi=hard "\$@"
END
chmod +x "$work/arm-linux-gnueabihf-g++"
mkdir -p "$work/armhf/usr/lib/arm-linux-gnueabihf" "$work/empty"

refused hard_float_compiler "die with SIGILL" -DTANDEM_SYSROOT="$sysroot" -DCMAKE_CXX_COMPILER="$work/arm-linux-gnueabihf-g++"
refused armhf_libraries "Debian's armhf libraries are ARMv7 code" -DTANDEM_SYSROOT="$work/armhf"
refused no_sysroot "scripts/sysroot armel" -DTANDEM_SYSROOT="$work/empty"
refused newer_instructions "makes code for ARMv7" -DTANDEM_SYSROOT="$sysroot" -DCMAKE_CXX_FLAGS=-march=armv7-a
refused other_compiler "is not one for armel" -DTANDEM_SYSROOT="$sysroot" -DCMAKE_CXX_COMPILER=/usr/bin/g++
refused loose_arithmetic "-ffast-math" -DTANDEM_SYSROOT="$sysroot" -DCMAKE_CXX_FLAGS=-ffast-math
exit $bad
