#!/usr/bin/env bash
# bundle.sh SOURCE ARCH BUILD SYSROOT EMULATOR…: the folder for a board runs with nothing but itself.
set -euo pipefail
source=$1 arch=$2 build=$3 sysroot=$4
shift 4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
TANDEM_BUILD=$build TANDEM_SYSROOT=$sysroot "$source/scripts/bundle" "$arch" "$work/tandem"

# The start script names the loader; an emulated processor has to be told to run it.
loader=$(sed -n 's|^exec "$here/libraries/\([^"]*\)".*|\1|p' "$work/tandem/tandem")
cd "$work/tandem"
for file in epuck_robot epuck_robot_lua footbot_robot footbot_map; do
  env -i PATH="$PATH" TANDEM_PLUGIN_PATH="$work/tandem/lib" "$@" "libraries/$loader" --library-path libraries bin/tandem check "configs/$file.xml"
done
