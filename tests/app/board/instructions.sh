#!/usr/bin/env bash
# instructions.sh READELF BUILD SYSROOT: fails when something that a board would get needs more than an ARMv6, or passes
# floating-point numbers in registers.
set -euo pipefail
readelf=$1 build=$2 sysroot=$3
files=("$build"/bin/tandem "$build"/lib/*.so "$sysroot"/usr/lib/arm-linux-gnueabi/{libserial,libtinyxml2,libfmt,libstdc++}.so.* "$sysroot"/lib/arm-linux-gnueabi/{libc,libm,libgcc_s}.so.*)
bad=0
for file in "${files[@]}"; do
  [[ -e $file ]] || { echo "$file is not there"; bad=1; continue; }
  attributes=$("$readelf" --arch-specific "$file")
  architecture=$(sed -n 's/^ *Tag_CPU_arch: //p' <<<"$attributes")
  case $architecture in
    v4 | v4T | v5T | v5TE | v5TEJ | v6) ;;
    *) echo "$file is code for '$architecture'"; bad=1 ;;
  esac
  if grep -q 'Tag_ABI_VFP_args: VFP registers' <<<"$attributes"; then
    echo "$file passes floating-point numbers in registers"
    bad=1
  fi
done
echo "${#files[@]} files looked at"
exit $bad
